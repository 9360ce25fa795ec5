"""Upload of the largest sea that the service takes: its memory while the file arrives.

Run with ``python -m tests.campaigns.large_upload`` (``--megabytes 200`` for less). The file is
written with holes, sent from the disk, and inspected like every other; the disk needs as much room.
"""

from __future__ import annotations

import argparse
import re
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import netCDF4
import numpy as np

from tests.service.conftest import TOKEN, ServerProcess

LARGEST = 2 * 2**30  # of one upload [bytes]
MOST_RESIDENT = 200e6  # of the server [bytes]
ROWS, COLUMNS, PIECE = 721, 1440, 2**20
NAMES = ("eastward_wind", "northward_wind")


def write_winds(path: Path, size: int) -> int:
    """Write calm winds of the world in at most so many bytes; return the size."""
    times = max(2, (size - 100_000) // (len(NAMES) * ROWS * COLUMNS * 4))
    with netCDF4.Dataset(path, "w", format="NETCDF3_64BIT_OFFSET") as file:
        file.set_fill_off()
        for name, values, unit in (
            ("time", np.arange(times), "hours since 2026-01-01"),
            ("latitude", np.linspace(-90.0, 90.0, ROWS), "degrees_north"),
            ("longitude", np.arange(COLUMNS) * 0.25, "degrees_east"),
        ):
            file.createDimension(name, len(values))
            variable = file.createVariable(name, "f8", (name,))
            variable.units, variable.standard_name = unit, name
            variable[:] = values
        for name in NAMES:
            variable = file.createVariable(name, "f4", ("time", "latitude", "longitude"))
            variable.units, variable.standard_name = "m s-1", name
            variable[-1, -1, -1] = 0.0  # the file has its full length
    return path.stat().st_size


def pieces_of(path: Path) -> Iterator[bytes]:
    """Yield a file in pieces."""
    with path.open("rb") as file:
        while piece := file.read(PIECE):
            yield piece


def most_resident(process: int) -> int:
    """Return the greatest resident memory of a process [bytes]."""
    text = Path(f"/proc/{process}/status").read_text()
    found = re.search(r"VmHWM:\s+(\d+) kB", text)
    assert found is not None
    return 1024 * int(found[1])


def main() -> int:
    """Upload and print; return 1 if the server needed more than it may."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--megabytes", type=float, default=LARGEST / 1e6)
    size = int(min(1e6 * parser.parse_args().megabytes, LARGEST))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "winds.nc"
        size = write_winds(path, size)
        server = ServerProcess(Path(folder) / "data").start()
        try:
            before = most_resident(server.process.pid)
            began = time.monotonic()
            answer = server.http.post(
                "/api/v1/seas",
                params={"name": "winds.nc"},
                content=pieces_of(path),
                headers={"Authorization": f"Bearer {TOKEN}"},
                timeout=3600.0,
            )
            passed = time.monotonic() - began
            most = most_resident(server.process.pid)
        finally:
            server.stop()
    print(f"uploaded [MB]: {size / 1e6:.0f}, status {answer.status_code}, {passed:.1f} s")
    print(f"resident before [MB]: {before / 1e6:.0f}")
    print(f"greatest resident [MB]: {most / 1e6:.0f}")
    if answer.status_code != 201:
        print(answer.text[:500])
    return int(answer.status_code != 201 or most > MOST_RESIDENT)


if __name__ == "__main__":
    sys.exit(main())
