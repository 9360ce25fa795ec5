"""Check that a classic NetCDF file is complete.

The NetCDF library reads the missing end of a truncated classic file as zeros, which would be calm
weather. So the header is read here (CDF-1, CDF-2 and CDF-5, as specified in the NetCDF User's
Guide, "NetCDF Classic Format Specification") and the length it gives is compared with the file's.
"""

from __future__ import annotations

import struct
from pathlib import Path
from typing import BinaryIO, Final

from thalweg.core.errors import DatasetError

TYPE_SIZES: Final = {1: 1, 2: 1, 3: 2, 4: 4, 5: 4, 6: 8, 7: 1, 8: 2, 9: 4, 10: 8, 11: 8}
STREAMING_COUNTS: Final = {4: 0xFFFFFFFF, 8: 0xFFFFFFFFFFFFFFFF}


class _Header:
    """Reads the fields of a classic header in sequence."""

    def __init__(self, stream: BinaryIO) -> None:
        self.stream = stream
        self.version = stream.read(4)[3]
        self.width = 8 if self.version == 5 else 4

    def whole(self, width: int) -> int:
        data = self.stream.read(width)
        if len(data) < width:
            raise EOFError("the header ends early")
        return int(struct.unpack(">Q" if width == 8 else ">I", data)[0])

    def count(self) -> int:
        return self.whole(self.width)

    def skip(self, length: int) -> None:
        padded = -(-length // 4) * 4
        if len(self.stream.read(padded)) < padded:
            raise EOFError("the header ends early")

    def list_length(self) -> int:
        self.whole(4)  # the tag of the list, or 0 if it is absent
        return self.count()

    def skip_attributes(self) -> None:
        for _ in range(self.list_length()):
            self.skip(self.count())
            kind = self.whole(4)
            self.skip(self.count() * TYPE_SIZES[kind])


def expected_length(path: Path) -> int:
    """Return the shortest length [bytes] of a classic NetCDF file with all its data.

    Raises
    ------
    EOFError, KeyError : If the header itself is truncated or damaged.
    """
    with path.open("rb") as stream:
        header = _Header(stream)
        records = header.count()
        if records == STREAMING_COUNTS[header.width]:
            records = 0
        lengths = []
        for _ in range(header.list_length()):
            header.skip(header.count())
            lengths.append(header.count())
        header.skip_attributes()
        return _end_of_data(header, records, lengths)


def _end_of_data(header: _Header, records: int, lengths: list[int]) -> int:
    """Return the position after the last value of all variables [bytes]."""
    fixed, moving = [0], []
    for _ in range(header.list_length()):
        header.skip(header.count())
        dims = [header.count() for _ in range(header.count())]
        header.skip_attributes()
        kind = header.whole(4)
        header.count()  # the size in the file may overflow; it is computed instead
        begin = header.whole(4 if header.version == 1 else 8)
        size = TYPE_SIZES[kind]
        is_record = bool(dims) and lengths[dims[0]] == 0
        for dim in dims[1:] if is_record else dims:
            size *= lengths[dim]
        if is_record:
            moving.append((begin, size))
        else:
            fixed.append(begin + size)
    if not moving or records == 0:
        return max(fixed)
    padded = [-(-size // 4) * 4 for _, size in moving]
    step = moving[0][1] if len(moving) == 1 else sum(padded)
    last = max(begin + (records - 1) * step + size for begin, size in moving)
    return max(max(fixed), last)


def check_complete(path: Path) -> None:
    """Raise `DatasetError` if a classic NetCDF file is shorter than its header states."""
    size = path.stat().st_size
    try:
        expected = expected_length(path)
    except (EOFError, KeyError, IndexError) as error:
        raise _truncated_file_error(
            path, f"its header is truncated or damaged ({error})"
        ) from error
    if size < expected:
        raise _truncated_file_error(path, f"it has {size} of {expected} bytes")


def _truncated_file_error(path: Path, fault: str) -> DatasetError:
    return DatasetError(
        f"{path.name} is incomplete: {fault}.",
        "Only complete files are read; the missing part would be read as a calm sea.",
        "Download the file again.",
        file=str(path),
    )
