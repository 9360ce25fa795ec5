"""``thalweg plan`` across the North Atlantic as a whole process: first run and later runs."""

from __future__ import annotations

import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

COMMAND = [
    sys.executable, "-m", "thalweg.cli.main", "plan", "40.4N 73.8W", "49.7N 6.5W",
    "--ship", "handysize-bulker", "--sea", "storm", "--depart", "1998-08-30T00:00Z", "--json",
]  # fmt: skip


def run(environment):
    first = time.perf_counter()
    subprocess.run(COMMAND, env=environment, check=True, stdout=subprocess.DEVNULL)
    return time.perf_counter() - first


def main():
    folder = Path(tempfile.mkdtemp(prefix="thalweg-cold-"))
    caches = {"THALWEG_CACHE": str(folder / "data"), "NUMBA_CACHE_DIR": str(folder / "numba")}
    environment = {**os.environ, **caches}
    cold = run(environment)
    warm = [run(environment) for _ in range(5)]
    print(f"first run (compiles the kernels): {cold:.2f} s")
    print(f"later runs: {statistics.median(warm):.2f} s (median of 5, from {min(warm):.2f} s)")
    shutil.rmtree(folder)


if __name__ == "__main__":
    main()
