"""Random kills of the service and of its jobs: no job is lost, no result differs or is half.

Run with ``python -m tests.campaigns.service_kills --count 20 --seed 1``.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import signal
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import httpx

from tests.service.conftest import SHORT, ServerProcess


def main() -> int:
    """Start jobs, kill at random moments, and check every job at the end."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=20, help="kills")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    chance = random.Random(arguments.seed)
    with tempfile.TemporaryDirectory() as folder:
        server = ServerProcess(Path(folder) / "data").start()
        try:
            return check(server, killed(server, chance, arguments.count))
        finally:
            server.stop()


def killed(server: ServerProcess, chance: random.Random, count: int) -> dict[str, dict[str, Any]]:
    """Return the requests of all jobs, after the kills."""
    jobs: dict[str, dict[str, Any]] = {}
    for number in range(count):
        request = {**SHORT, "title": f"job {number % 3}"}
        request["voyage"] = {**request["voyage"], "goal": f"47.{3 + number % 3}N 5.3W"}
        answer = server.http.post(
            "/api/v1/plans", json=request, headers={"Idempotency-Key": f"key {number}"}
        )
        jobs[answer.json()["id"]] = request
        time.sleep(chance.uniform(0.0, 4.0))
        children = server.children()
        if chance.random() < 0.5 and children:
            os.kill(chance.choice(children), signal.SIGKILL)
            print(f"kill {number + 1}: a child", flush=True)
        else:
            server.kill()
            server.start()
            print(f"kill {number + 1}: the service", flush=True)
    return jobs


def check(server: ServerProcess, jobs: dict[str, dict[str, Any]]) -> int:
    """Wait for all jobs, and count what is wrong."""
    results: dict[str, set[str]] = {}
    wrong = []
    for job, request in jobs.items():
        try:
            found = server.http.get(f"/api/v1/plans/{job}").json()
            while found["state"] in ("queued", "running"):
                time.sleep(0.3)
                found = server.http.get(f"/api/v1/plans/{job}").json()
            if found["state"] == "failed" and found["attempt"] >= 5:
                print(f"{job}: given up after five kills", flush=True)
                continue
            result = server.http.get(f"/api/v1/plans/{job}/result").json()
            results.setdefault(request["title"], set()).add(json.dumps(result, sort_keys=True))
        except (httpx.HTTPError, KeyError, ValueError) as error:
            wrong.append(f"{job}: {error!r}")
    wrong += [
        f"{title}: {len(found)} results" for title, found in results.items() if len(found) > 1
    ]
    whole = [(path / "end.json").exists() for path in (server.folder / "results").iterdir()]
    if not all(whole):
        wrong.append("a result is half")
    print(f"{len(jobs)} jobs, {len(whole)} results, wrong: {wrong}", flush=True)
    return len(wrong)


if __name__ == "__main__":
    sys.exit(main())
