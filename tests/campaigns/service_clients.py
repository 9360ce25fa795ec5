"""Many clients at once: no accepted job is lost or run twice; the times of reading requests.

Run with ``python -m tests.campaigns.service_clients --clients 50 --streams 20 --seconds 60``.
"""

from __future__ import annotations

import argparse
import asyncio
import itertools
import json
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import httpx

from tests.service.conftest import ENDED, SHORT, TOKEN, ServerProcess

PAUSE_S = 1.0  # of a client between two requests
READ = ("/api/v1/health", "/api/v1/plans?size=20", "/api/v1/ships", "/api/v1/plans/{job}")


@dataclass
class Campaign:
    """What the clients saw."""

    http: httpx.AsyncClient
    ends: float
    goals: dict[str, int] = field(default_factory=dict)  # of each job
    times_s: list[float] = field(default_factory=list)
    refused: int = 0
    wrong: list[str] = field(default_factory=list)

    async def client(self, number: int) -> None:
        """Start jobs, each twice with one key, and read until the time is over."""
        reads = itertools.cycle(READ)
        for turn in itertools.count():
            job = await self.started(number % 5, f"client {number} job {turn}")
            state = "queued"
            while time.monotonic() < self.ends and state not in ENDED:
                await asyncio.sleep(PAUSE_S)
                path = next(reads)
                if job or "{job}" not in path:
                    answer = await self.read(path.format(job=job))
                    state = answer.get("state", state) if "{job}" in path else state
            if time.monotonic() >= self.ends:
                return

    async def started(self, goal: int, key: str) -> str | None:
        """Return the job of a request that is sent twice; None where the queue is full."""
        voyage = {**SHORT["voyage"], "goal": f"47.{3 + goal}N 5.3W"}
        request = {**SHORT, "title": key, "voyage": voyage}
        found = set()
        for _ in range(2):
            answer = await self.http.post(
                "/api/v1/plans", json=request, headers={"Idempotency-Key": key}
            )
            if answer.status_code == 429:
                self.refused += 1
                return None
            found.add(answer.raise_for_status().json()["id"])
        if len(found) != 1:
            self.wrong.append(f"{key}: two jobs")
        job: str = found.pop()
        self.goals[job] = goal
        return job

    async def read(self, path: str) -> Any:
        """Return what a path has, and keep the time that it takes."""
        began = time.perf_counter()
        answer = await self.http.get(path)
        self.times_s.append(time.perf_counter() - began)
        if answer.status_code != 200:
            self.wrong.append(f"{path}: status {answer.status_code}")
        return answer.json()

    async def stream(self) -> None:
        """Follow the events of the newest jobs, one after the other."""
        while time.monotonic() < self.ends:
            await asyncio.sleep(PAUSE_S)  # the stream of a job that has ended ends at once
            if not self.goals:
                continue
            async with self.http.stream(
                "GET", f"/api/v1/plans/{[*self.goals][-1]}/events"
            ) as answer:
                async for _ in answer.aiter_lines():
                    if time.monotonic() >= self.ends:
                        break

    async def check(self) -> tuple[int, int]:
        """Stop what still waits, and return how many jobs are done and how many are stopped."""
        states, results = [], {}
        for job in self.goals:
            await self.http.delete(f"/api/v1/plans/{job}")
        for job, goal in self.goals.items():
            found = (await self.http.get(f"/api/v1/plans/{job}")).json()
            while found.get("state") in ("queued", "running"):
                await asyncio.sleep(0.3)
                found = (await self.http.get(f"/api/v1/plans/{job}")).json()
            states.append(found.get("state"))
            if states[-1] not in ("done", "cancelled"):
                self.wrong.append(f"{job}: {states[-1] or 'lost'}, {found.get('problem')}")
            elif states[-1] == "done":
                result = (await self.http.get(f"/api/v1/plans/{job}/result")).json()
                routes = json.dumps(result["routes"], sort_keys=True)
                results.setdefault(goal, set()).add(routes)
        self.wrong += [
            f"goal {goal}: {len(found)} results"
            for goal, found in results.items()
            if len(found) > 1
        ]
        return states.count("done"), states.count("cancelled")


async def campaign(address: str, clients: int, streams: int, seconds: float) -> int:
    """Run the clients, and print and return how many things are wrong."""
    headers = {"Authorization": f"Bearer {TOKEN}"}
    limits = httpx.Limits(max_connections=None, max_keepalive_connections=clients + streams)
    async with httpx.AsyncClient(
        base_url=address, headers=headers, timeout=120.0, limits=limits
    ) as http:
        found = Campaign(http, time.monotonic() + seconds)
        followed = [asyncio.create_task(found.stream()) for _ in range(streams)]
        await asyncio.gather(*(found.client(number) for number in range(clients)))
        for task in followed:
            task.cancel()
        await asyncio.gather(*followed, return_exceptions=True)
        done, stopped = await found.check()
    times_ms = sorted(1000.0 * one for one in found.times_s)
    median, late = (times_ms[int(share * len(times_ms))] for share in (0.5, 0.95))
    print(f"{clients} clients, {streams} event streams, {seconds:.0f} s")
    print(f"{len(times_ms)} GET: median {median:.1f} ms, 95 % within {late:.1f} ms")
    print(f"{len(found.goals)} jobs: {done} done, {stopped} stopped, {found.refused} refused")
    print(f"wrong: {found.wrong}")
    return len(found.wrong)


def main() -> int:
    """Start a service and let the clients use it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--clients", type=int, default=50)
    parser.add_argument("--streams", type=int, default=20)
    parser.add_argument("--seconds", type=float, default=300.0)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        server = ServerProcess(Path(folder) / "data").start()
        try:
            return asyncio.run(
                campaign(server.address, given.clients, given.streams, given.seconds)
            )
        finally:
            server.stop()


if __name__ == "__main__":
    sys.exit(main())
