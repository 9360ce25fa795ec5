"""A study on a Dask scheduler with two worker processes: kills, resume, and a serial run's bits.

``python -m tests.campaigns.cluster_study`` starts a scheduler and two workers on this computer. The
driver is killed (SIGKILL) after its first parts, one worker is killed during the second run, and
the rows are compared with those of a serial run. It takes about a minute of processor time.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import yaml

from tests.studies.test_studies import comparable, months_file
from thalweg.studies import run_study
from thalweg.studies.study import load_study
from thalweg.studies.study_parts import read_parts

ADDRESS = "tcp://127.0.0.1:18786"
CODE = """from thalweg.studies import run_study
from thalweg.studies.study import load_study
run_study(load_study({study!r}), {out!r}, {rest})"""
DATA = {
    "ship": "hopper-dredger", "sea": ["year.nc"], "coast": "none", "resolution_nm": 10.0,
    "voyage": {"start": [0.0, 0.0], "goal": [0.0, 2.0], "offing_nm": 0.0},
    "axes": {"depart": {"from": "2026-02-05", "to": "2026-12-15", "step_h": 360}},
}  # fmt: skip


def started(*words: str) -> subprocess.Popen[bytes]:
    return subprocess.Popen([sys.executable, *words], stderr=subprocess.DEVNULL)


def driver(folder: Path) -> subprocess.Popen[bytes]:
    """Start a driver on the cluster in a process of its own, with chunks of one voyage."""
    rest = f"scheduler={ADDRESS!r}, chunk=1"
    given = {"study": str(folder / "study.yaml"), "out": str(folder / "cluster"), "rest": rest}
    return started("-c", CODE.format(**given))


def wait_for_parts(folder: Path, count: int, process: subprocess.Popen[bytes]) -> int:
    """Wait until so many parts are written or the driver ends; return how many there are."""
    while True:
        parts = len(list((folder / "cluster" / "parts").glob("part-*")))
        if parts >= count or process.poll() is not None:
            return parts
        time.sleep(0.05)


def main() -> None:
    children: list[subprocess.Popen[bytes]] = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        months_file(folder / "year.nc")
        (folder / "study.yaml").write_text(yaml.safe_dump(DATA))
        study = load_study(folder / "study.yaml")
        dask = ("-m", "dask")
        try:
            children.append(
                started(*dask, "scheduler", "--host", "127.0.0.1", "--port", "18786",
                        "--no-dashboard")
            )  # fmt: skip
            for _ in range(2):
                children.append(
                    started(*dask, "worker", ADDRESS, "--nthreads", "1", "--no-nanny",
                            "--no-dashboard")
                )  # fmt: skip
            time.sleep(15.0)
            first = driver(folder)
            children.append(first)
            print("parts when the driver is killed:", wait_for_parts(folder, 3, first))
            first.kill()
            first.wait()
            second = driver(folder)
            children.append(second)
            print("parts when a worker is killed:", wait_for_parts(folder, 8, second))
            children[1].kill()
            print("exit code of the second driver:", second.wait())
        finally:
            for child in children:
                child.kill()
        run_study(study, folder / "serial")
        rows, serial = read_parts(folder / "cluster"), read_parts(folder / "serial")
        print("rows:", len(rows), "of", study.size, "| bit for bit:",
              comparable(rows) == comparable(serial))  # fmt: skip
        print("half-written files:", len(list((folder / "cluster").rglob("*.tmp"))))


if __name__ == "__main__":
    main()
