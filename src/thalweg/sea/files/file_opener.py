"""Open files: detect their format, check that they are complete, and make layers of them."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, Final

from thalweg.core.errors import DatasetError, InputError
from thalweg.core.given_numbers import is_number, shortened_repr
from thalweg.sea.files import grib, netcdf3_check, time_concatenation
from thalweg.sea.files.ensemble_members import check_member_counts, combine_members, ensemble_file
from thalweg.sea.files.file_contents import NothingRecognised, layer_candidates
from thalweg.sea.files.layer_candidate import FileContents, LayerCandidate, OpenedFile
from thalweg.sea.files.variable_recognition import IgnoredVariable, check_mapping
from thalweg.sea.grids.gridded_layer import GridLayer
from thalweg.sea.grids.source_variables import READ_ERRORS, GridWindow
from thalweg.sea.layer import Layer

HDF5_MAGIC: Final = b"\x89HDF\r\n\x1a\n"
COMPRESSED_FORMATS: Final = {
    b"PK\x03\x04": "zip",
    b"\x1f\x8b": "gzip",
    b"BZh": "bzip2",
    b"\xfd7zXZ": "xz",
}
WITHOUT_TIME_DECODING: Final[dict[str, Any]] = {"decode_times": False, "decode_timedelta": False}
ZARR_METADATA_FILES: Final = (".zgroup", ".zmetadata", "zarr.json", ".zattrs")
READABLE_FORMATS: Final = "NetCDF (classic and netCDF-4), GRIB 1 and 2, and Zarr can be read."
FIRST_ROWS: Final = 5  #: rows of a large grid that are read on opening, to check their values
SMALL_LEVEL: Final = 200_000  #: grids with up to this many points are read whole on opening


def open_layers(
    sources: Sequence[Any], mapping: Mapping[str, str] | None, draught: float | None = None
) -> list[Layer]:
    """Return the layers of files, in order of priority (see `thalweg.sea.Sea.open`).

    Parameters
    ----------
    mapping : Canonical name to name in the file.
    draught : Draught [m] over which currents in layers are averaged.

    Raises
    ------
    InputError : If no file is given, or the mapping names variables that are in none of the files.
    DatasetError : If a file is missing, damaged, ambiguous, or holds no usable variable.
    """
    if not sources:
        raise InputError(
            "No file was given.", "Sea.open takes one or more paths.", "For a calm sea: Sea.calm()."
        )
    mapping = dict(mapping or {})
    files = [part for source in sources for part in open_file(source)]
    if draught is not None:
        files = [_with_draught(file, _checked_draught(draught)) for file in files]
    check_mapping(mapping, frozenset(str(n) for f in files for n in f.dataset.variables))
    ensembles = {k: found for k, f in enumerate(files) if (found := ensemble_file(f)) is not None}
    if not ensembles:
        return list(
            _checked_layers(_layers_of_files(files, lambda k: layer_candidates(files[k], mapping)))
        )
    plain: dict[int, FileContents] = {}

    def draft(k: int, index: int) -> FileContents:
        if k in ensembles:
            return ensembles[k].candidates(index, mapping)
        if k not in plain:
            plain[k] = layer_candidates(files[k], mapping)
        return plain[k]

    count = check_member_counts(list(ensembles.values()))
    return combine_members(
        [_checked_layers(_layers_of_files(files, partial(draft, index=i))) for i in range(count)]
    )


def _with_draught(file: OpenedFile, draught: float) -> OpenedFile:
    return replace(file, draught=draught, facts={**file.facts, "draught_m": draught})


def _checked_draught(draught: float) -> float:
    if not (is_number(draught) and 0.0 < float(draught) < 100.0):
        raise InputError(
            f"Currents cannot be averaged over a draught of {draught!r} m.",
            "The draught must be between 0 and 100 m.",
            "Correct it, or omit it to use the surface layer.",
            field="draught_m",
        )
    return float(draught)


def _layers_of_files(
    files: Sequence[OpenedFile], draft: Callable[[int], FileContents]
) -> list[GridLayer]:
    """Return the layers of files; a part of a file may be empty if another part is not."""
    candidates: list[LayerCandidate] = []
    ignored: dict[str, list[IgnoredVariable]] = {}
    faults: dict[str, DatasetError] = {}
    useful: set[str] = set()
    for k, file in enumerate(files):
        try:
            found, left = draft(k)
        except NothingRecognised as fault:
            faults.setdefault(file.source, fault)
            continue
        useful.add(file.source)
        candidates += found
        for source in {file.source, *(d.file.source for d in found)}:
            ignored.setdefault(source, []).extend(left)
    for source, nothing in faults.items():
        if source not in useful:
            raise nothing
    return time_concatenation.join_in_time(candidates, ignored)


def _checked_layers(layers: list[GridLayer]) -> list[GridLayer]:
    for layer in layers:
        check_readable(layer)
    return layers


def check_readable(layer: GridLayer) -> None:
    """Read some rows of each quantity at the middle time, to detect damage and wrong units."""
    rows, columns = layer.grid.shape
    middle = layer.axis.times.size // 2
    count = rows if rows * columns <= SMALL_LEVEL else min(rows, FIRST_ROWS)
    y0 = (rows - count) // 2
    for quantity in layer.quantities:
        quantity.read(GridWindow(middle, middle + 1, y0, y0 + count, 0, columns), columns)


def open_file(source: Any) -> list[OpenedFile]:
    """Return the datasets in a file (one, except for GRIB with several kinds of levels).

    Parameters
    ----------
    source : A file, a Zarr folder or a dataset.

    Raises
    ------
    InputError : If the file does not exist or the source is of another type.
    DatasetError : If the file is empty, damaged, compressed or in an unknown format.
    """
    if hasattr(source, "data_vars"):
        return [
            OpenedFile(
                source,
                "dataset",
                {"name": "dataset", "variables": sorted(map(str, source.data_vars))},
            )
        ]
    if not isinstance(source, (str, os.PathLike)):
        raise InputError(
            f"A sea cannot be opened from {type(source).__name__!r}.",
            "Paths of files or Zarr folders, and xarray datasets, can be opened.",
            "Give one of these.",
        )
    path = Path(source).expanduser()
    try:
        found = path.exists()
    except (OSError, ValueError):  # a name that no file can have
        found = False
    if not found:
        raise _missing_file_error(path)
    _check_name(path)
    if path.is_dir():
        return [_open_zarr(path)]
    facts = _file_facts(path)
    if facts["size"] == 0:
        raise not_data_error(path, "is empty")
    with _dataset_errors(path), path.open("rb") as stream:
        head = stream.read(1024)
    if head[:8] == HDF5_MAGIC:
        return [OpenedFile(_open_netcdf(path, ("netcdf4", "h5netcdf")), path.name, facts)]
    if head[:3] == b"CDF" and head[3:4] in (b"\x01", b"\x02", b"\x05"):
        netcdf3_check.check_complete(path)
        return [OpenedFile(_open_netcdf(path, ("netcdf4", "scipy")), path.name, facts)]
    if b"GRIB" in head:
        return [OpenedFile(d, path.name, facts) for d in grib.open_grib(path)]
    packed = next(
        (kind for mark, kind in COMPRESSED_FORMATS.items() if head.startswith(mark)), None
    )
    if packed is not None:
        raise not_data_error(path, f"is compressed ({packed})", "Decompress it first.")
    raise not_data_error(path, "is not in a known format of met-ocean data")


def _check_name(path: Path) -> None:
    """Refuse names that the libraries for NetCDF and GRIB cannot open."""
    try:
        str(path).encode("utf-8")
    except UnicodeEncodeError:
        raise InputError(
            f"The name of the file {str(path)!r} is not text in UTF-8.",
            "The libraries that read met-ocean data open names in UTF-8 only.",
            "Rename the file.",
            file=str(path),
        ) from None


def _file_facts(path: Path) -> dict[str, Any]:
    status = path.stat()
    return {"name": path.name, "size": status.st_size, "mtime_ns": status.st_mtime_ns}


def _missing_file_error(path: Path) -> InputError:
    folder = path.parent
    from thalweg.core.errors import close_matches

    files = [p.name for p in folder.iterdir() if not p.is_dir()] if folder.is_dir() else []
    near = close_matches(path.name, files)
    return InputError(
        f"There is no file {shortened_repr(str(path), 200)}.",
        f"The folder {'exists' if folder.is_dir() else 'does not exist either'}.",
        f"Did you mean {' or '.join(near)}?" if near else "Check the path.",
        file=str(path),
    )


def not_data_error(path: Path, fault: str, remedy: str = "Check the file.") -> DatasetError:
    """Return the error for a file that is not in a readable format."""
    return DatasetError(f"{path.name} {fault}.", READABLE_FORMATS, remedy, file=str(path))


@contextmanager
def _dataset_errors(path: Path) -> Iterator[None]:
    """Convert system errors on reading a path to `DatasetError`."""
    try:
        yield
    except OSError as error:
        raise DatasetError(
            f"{path.name} cannot be read ({error.strerror or error}).",
            READABLE_FORMATS,
            "Check the permissions of the file.",
            file=str(path),
        ) from error


def _open_netcdf(path: Path, engines: Sequence[str]) -> Any:
    import xarray as xr

    def opener(engine: str) -> Any:
        return xr.open_dataset(path, engine=engine, **WITHOUT_TIME_DECODING)

    return _open_with_engine(path, engines, opener)


def _open_zarr(path: Path) -> OpenedFile:
    if not any((path / mark).exists() for mark in ZARR_METADATA_FILES):
        raise not_data_error(path, "is a folder, but not a Zarr store")
    import xarray as xr

    def opener(engine: str) -> Any:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", "Failed to open Zarr store with consolidated")
            return xr.open_dataset(path, engine=engine, chunks=None, **WITHOUT_TIME_DECODING)

    dataset = _open_with_engine(path, ("zarr",), opener)
    stamps = [p.stat() for p in path.rglob("*") if p.is_file()]
    facts = {
        "name": path.name,
        "size": sum(s.st_size for s in stamps),
        "mtime_ns": max(s.st_mtime_ns for s in stamps),
    }
    return OpenedFile(dataset, path.name, facts)


def _open_with_engine(path: Path, engines: Sequence[str], opener: Callable[[str], Any]) -> Any:
    """Return the dataset from the first engine that is installed."""
    missing: list[str] = []
    for engine in engines:
        try:
            return opener(engine)
        except (ImportError, ModuleNotFoundError):
            missing.append(engine)
        except READ_ERRORS as error:
            if isinstance(error, ValueError) and "unrecognized engine" in str(error):
                missing.append(engine)
                continue
            raise DatasetError(
                f"{path.name} is damaged or incomplete ({str(error).splitlines()[0][:200]}).",
                READABLE_FORMATS,
                "Download the file again.",
                file=str(path),
            ) from error
    raise DatasetError(
        f"{path.name} needs a package that is not installed ({' or '.join(missing)}).",
        READABLE_FORMATS,
        f"pip install {'thalweg[zarr]' if 'zarr' in missing else missing[0]}",
        file=os.fspath(path),
    )
