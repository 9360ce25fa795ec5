"""A service in this process for fast tests, and one in a process of its own for kills."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

httpx = pytest.importorskip("httpx")
pytest.importorskip("fastapi", reason='the extra "serve" is not installed')
pytest.importorskip("uvicorn", reason='the extra "serve" is not installed')

TOKEN = "0123456789abcdef0123"
#: A voyage of 20 nm in calm water on the crude coastline: planned in about a second.
SHORT = {
    "title": "Across the bay",
    "voyage": {"start": "47.0N 5.0W", "goal": "47.3N 5.3W", "depart": "2026-01-01T00:00Z"},
    "ship": "handysize-bulker",
    "seas": ["calm"],
    "coast": "c",
    "resolution_nm": 4.0,
    "proof_s": 0.0,
}
#: A proxy on a port where nothing listens: the service reaches nothing outside.
NO_NETWORK = {f"{kind}_proxy": "http://127.0.0.1:1" for kind in ("http", "https", "all")}
ENDED = ("done", "failed", "cancelled")
#: Time after which a test gives up waiting, also on a loaded machine [s].
LONG_S = 600.0


def settings(folder: Path, **limits: Any) -> Any:
    from thalweg.service.service_settings import ServiceLimits, ServiceSettings

    return ServiceSettings(folder=folder, token=TOKEN, limits=ServiceLimits(**limits))


@pytest.fixture(scope="session")
def client(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """A client of a service in this process, whose children are real."""
    from starlette.testclient import TestClient

    from thalweg.service.application import create_application

    application = create_application(
        settings(tmp_path_factory.mktemp("service"), workers=1, small_upload_bytes=1_000_000)
    )
    with TestClient(
        application,
        base_url="http://127.0.0.1:8765",
        headers={"Authorization": f"Bearer {TOKEN}"},
    ) as found:
        yield found


def ended(get: Any, job: str, seconds: float = LONG_S) -> dict[str, Any]:
    """Return a job when it has its final state."""
    limit = time.monotonic() + seconds
    while time.monotonic() < limit:
        found: dict[str, Any] = get(f"/api/v1/plans/{job}").json()
        if found["state"] in ENDED:
            return found
        time.sleep(0.1)
    raise AssertionError(f"the job is still {found['state']}")


def result_of_stop_after_kill(server: Any, job: str) -> dict[str, Any]:
    """Kill the service, start it, and stop a job before its next child calculates."""
    server.kill()
    server.start()
    server.http.delete(f"/api/v1/plans/{job}")  # its child still loads, or is not started
    found = ended(server.http.get, job)
    assert found["state"] == "cancelled" and found["result"]
    result: dict[str, Any] = server.http.get(f"/api/v1/plans/{job}/result").json()
    return result


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


class ServerProcess:
    """``thalweg serve`` in a process, to be killed and started again on the same data."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.port = free_port()
        self.address = f"http://127.0.0.1:{self.port}"
        self.http = httpx.Client(
            base_url=self.address, headers={"Authorization": f"Bearer {TOKEN}"}, timeout=LONG_S
        )
        self.process: subprocess.Popen[bytes] | None = None

    def start(self) -> ServerProcess:
        command = [sys.executable, "-m", "thalweg.cli.main", "serve", "--quiet"]
        command += ["--port", str(self.port), "--data", str(self.folder), "--token", TOKEN]
        self.process = subprocess.Popen(
            command, stderr=subprocess.DEVNULL, env={**os.environ, **NO_NETWORK}
        )
        limit = time.monotonic() + LONG_S
        while time.monotonic() < limit:
            try:
                if self.http.get("/api/v1/health").status_code == 200:
                    return self
            except httpx.TransportError:
                time.sleep(0.1)
        raise AssertionError("the service does not start")

    def kill(self) -> None:
        assert self.process is not None
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()

    def stop(self) -> None:
        if self.process is not None and self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
            try:
                self.process.wait(20)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()
        self.http.close()

    def children(self) -> list[int]:
        """Return the processes of jobs, by the list of the system."""
        assert self.process is not None
        listed = Path(f"/proc/{self.process.pid}/task/{self.process.pid}/children")
        if not listed.exists():
            pytest.skip("this system does not list the children of a process")
        found = []
        for task in Path(f"/proc/{self.process.pid}/task").iterdir():
            found += [int(name) for name in (task / "children").read_text().split()]
        return [pid for pid in found if b"job_child" in Path(f"/proc/{pid}/cmdline").read_bytes()]


@pytest.fixture
def server(tmp_path: Path) -> Iterator[ServerProcess]:
    if os.name == "nt":
        pytest.skip("signals of POSIX")
    found = ServerProcess(tmp_path / "data").start()
    try:
        yield found
    finally:
        found.stop()
