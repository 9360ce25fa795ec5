"""Read GRIB files; they are decoded in a separate process.

The decoder (eccodes) includes its own PROJ library, which can crash a process that also uses
pyproj; a corrupt message can crash it too. So a worker process decodes the file into arrays in a
temporary folder, which are memory-mapped here. If the worker crashes, a `DatasetError` is raised.
No file is written in the folder of the data.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
import weakref
from pathlib import Path
from typing import Any, Final

import numpy as np

from thalweg.core.errors import DatasetError

WORKER: Final = Path(__file__).with_name("grib_worker.py")
_MIN_MESSAGE_LENGTH: Final = 12  #: [bytes] shortest possible message
TIME_LIMIT: Final = 1800.0  #: [s] after which a worker is stopped


def open_grib(path: Path) -> list[Any]:
    """Return one xarray dataset for each kind of level in a GRIB file.

    Returns
    -------
    list of xarray.Dataset : Memory-mapped, not loaded.

    Raises
    ------
    DatasetError : If the file is truncated, damaged, or cfgrib is not installed.
    """
    check_messages(path)
    folder = Path(tempfile.mkdtemp(prefix="thalweg-grib-"))
    try:
        listing = _decode(path, folder)
        keeper = _TemporaryFolder(folder)
        return [_dataset(folder, part, keeper) for part in listing]
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise


class _TemporaryFolder:
    """Removes the temporary folder when the last array mapped from it is gone."""

    def __init__(self, folder: Path) -> None:
        self.users = 0
        self._remove = weakref.finalize(self, shutil.rmtree, str(folder), ignore_errors=True)

    def load(self, path: Path) -> Any:
        """Return an array mapped from a file of the folder."""
        array = np.load(path, mmap_mode="r")
        self.users += 1
        weakref.finalize(array, self._release)
        return array

    def _release(self) -> None:
        self.users -= 1
        if self.users == 0:
            self._remove()


def check_messages(path: Path) -> int:
    """Return the number of messages; raise `DatasetError` if one is truncated or damaged."""
    size, place, count = path.stat().st_size, 0, 0
    with path.open("rb") as stream:
        while place < size:
            stream.seek(place)
            head = stream.read(16)
            if head[:4] != b"GRIB":
                skipped = (head + stream.read(65536)).find(b"GRIB", 1)
                if skipped < 0:
                    break
                place += skipped
                continue
            length = _message_length(head)
            if length is None:
                return count + 1
            whole = _MIN_MESSAGE_LENGTH <= length <= size - place
            stream.seek(place + length - 4 if whole else size)
            if stream.read(4) != b"7777":
                raise _damaged_file_error(path, f"message {count + 1} is truncated or damaged")
            place, count = place + length, count + 1
    if count == 0:
        raise _damaged_file_error(path, "it holds no complete message")
    return count


def _message_length(head: bytes) -> int | None:
    """Return the length of a message; None for the over-long edition 1 messages of ECMWF."""
    if len(head) < 16:
        return 1 << 62
    if head[7] == 2:
        return int.from_bytes(head[8:16], "big")
    length = int.from_bytes(head[4:7], "big")
    return None if length & 0x800000 else length


def _decode(path: Path, folder: Path) -> list[dict[str, Any]]:
    # -P removes this folder from the module path, where its modules could hide other packages
    command = [sys.executable, "-P", str(WORKER), str(path.resolve()), str(folder)]
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=TIME_LIMIT, check=False, cwd=folder
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise _damaged_file_error(path, f"the decoder did not finish ({error})") from error
    answer = folder / "listing.json"
    if answer.exists():  # written last; a crash during exit of the worker has no effect
        listing: list[dict[str, Any]] = json.loads(answer.read_text("utf-8"))
        return listing
    message = (done.stderr.strip().splitlines() or ["no message"])[-1][:300]
    if "No module named" in message:
        raise DatasetError(
            f"{path.name} is a GRIB file, and the GRIB decoder is not installed.",
            "NetCDF and Zarr can be read without it.",
            "pip install 'thalweg[grib]'",
            file=str(path),
        )
    raise _damaged_file_error(path, f"the decoder failed (exit {done.returncode}: {message})")


def _damaged_file_error(path: Path, fault: str) -> DatasetError:
    return DatasetError(
        f"{path.name} cannot be decoded: {fault}.",
        "Complete GRIB 1 and GRIB 2 files can be read.",
        "Download the file again.",
        file=str(path),
    )


def _dataset(folder: Path, part: dict[str, Any], keeper: _TemporaryFolder) -> Any:
    """Return a dataset of the arrays that the worker wrote, memory-mapped."""
    import xarray as xr

    def variable(entry: dict[str, Any]) -> Any:
        file = folder / entry["file"]
        data = keeper.load(file) if len(entry["dims"]) > 1 else np.load(file)
        if entry["is_time"]:
            data = data.astype("datetime64[ns]")
        return xr.Variable(entry["dims"], data, entry["attrs"])

    return xr.Dataset(
        {n: variable(v) for n, v in part["fields"].items()},
        coords={n: variable(v) for n, v in part["coords"].items()},
        attrs=part["attrs"],
    )
