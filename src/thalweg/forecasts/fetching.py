"""`fetch_forecast`: from a request to one file that a sea opens."""

from __future__ import annotations

import os
import secrets
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final
from urllib.parse import urlsplit

import numpy as np

from thalweg.core.errors import CoverageError, DatasetError, InputError
from thalweg.core.file_writing import make_folder, unwritable_error
from thalweg.core.time import format_time
from thalweg.forecasts.download_client import DownloadClient
from thalweg.forecasts.download_plan import DownloadPlan, ForecastSource, Progress
from thalweg.forecasts.forecast_request import ForecastRequest
from thalweg.forecasts.source_table import SOURCES

MOST_BYTES: Final = 2_000_000_000  #: of one request unless the user allows more


@dataclass(frozen=True)
class FetchedForecast:
    """A forecast on disk.

    Attributes
    ----------
    files : tuple of Path
        One per grid; a sea opens them together.
    run : float or None
        Start of the forecast run [s since 1970].
    first, last : float
        Times covered [s since 1970].
    variables : tuple of str
    bytes : int
        Size of what was downloaded, or taken from the cache [bytes].
    notes : tuple of str
    """

    files: tuple[Path, ...]
    run: float | None
    first: float
    last: float
    variables: tuple[str, ...]
    bytes: int
    notes: tuple[str, ...] = ()


def source_named(source: str | ForecastSource) -> ForecastSource:
    """Return a source by its name.

    Raises
    ------
    InputError : If there is no such source.
    """
    if not isinstance(source, str):
        return source
    if source not in SOURCES:
        raise InputError(
            f"The source {source!r} is not known.",
            f"Sources: {', '.join(SOURCES)}.",
            "Give one of them.",
            field="source",
        )
    return SOURCES[source]


def estimate_forecast(
    request: ForecastRequest,
    source: str | ForecastSource,
    *,
    client: DownloadClient | None = None,
    now: float | None = None,
) -> DownloadPlan:
    """Return what would be downloaded for a request, with its size.

    Parameters
    ----------
    request : ForecastRequest
    source : str or ForecastSource
        A name of `thalweg.forecasts.source_table.SOURCES`, or a source.
    client : DownloadClient, optional
    now : float, optional
        The present [s since 1970].

    Returns
    -------
    DownloadPlan

    Raises
    ------
    InputError
        If the source does not have what is requested.
    TransferError
        If a server cannot be reached.
    """
    chosen = source_named(source)
    missing = [name for name in request.quantities if name not in chosen.quantities]
    if missing:
        raise InputError(
            f"{chosen.title} has no {' or '.join(missing)}.",
            f"It has {', '.join(chosen.quantities)}.",
            "Request these, or fetch the others from another source into a second file.",
            field="quantities",
        )
    if request.members and chosen.name != "ecmwf":
        raise InputError(
            f"{chosen.title} has no ensemble here.",
            "ecmwf has one of 50 members.",
            "Leave the members out, or use ecmwf.",
            field="members",
        )
    return chosen.plan(request, client or DownloadClient(), time.time() if now is None else now)


def fetch_forecast(
    request: ForecastRequest,
    source: str | ForecastSource,
    out: str | Path,
    *,
    client: DownloadClient | None = None,
    now: float | None = None,
    most_bytes: float = MOST_BYTES,
    progress: Progress | None = None,
) -> FetchedForecast:
    """Download a forecast and write it as NetCDF with the names of the CF conventions.

    Parameters
    ----------
    request : ForecastRequest
    source : str or ForecastSource
        A name of `thalweg.forecasts.source_table.SOURCES`, or a source.
    out : path
        NetCDF file to write, whole or not at all. Fields on a second grid go to ``NAME_2.nc``.
    client : DownloadClient, optional
    now : float, optional
        The present [s since 1970].
    most_bytes : float
        Largest download [bytes].
    progress : callable, optional
        Called with a line before each step.

    Returns
    -------
    FetchedForecast

    Raises
    ------
    InputError
        If the source does not have what is requested, or the download is too large.
    TransferError
        If a server cannot be reached or does not deliver.
    CoverageError
        If what arrived lacks times or quantities.
    """
    report = progress or (lambda text: None)
    out = Path(out)
    make_folder(out.parent)
    chosen, client = source_named(source), client or DownloadClient()
    report(f"asking {chosen.title} what it has")
    plan = estimate_forecast(request, chosen, client=client, now=now)
    if plan.bytes > most_bytes:
        raise InputError(
            f"The download is about {plan.bytes / 1e6:.0f} MB.",
            f"At most {most_bytes / 1e6:.0f} MB are downloaded.",
            "Choose a smaller box, a shorter period, a larger step or fewer quantities, or allow "
            "more (--max-mb).",
        )
    files, size = [], 0
    for number, part in enumerate(plan.parts, start=1):
        report(f"downloading {number} of {len(plan.parts)}, {size / 1e6:.1f} MB so far")
        files.append(client.file(part))
        size += files[-1].stat().st_size
    report("writing the file")
    datasets = chosen.read(request, plan, files)
    _check_complete(chosen, plan, datasets)
    written = []
    for number, dataset in enumerate(datasets, start=1):
        path = out if number == 1 else out.with_name(f"{out.stem}_{number}{out.suffix}")
        _write(_described(dataset, chosen, plan), path)
        written.append(path)
    client.prune()
    return FetchedForecast(
        tuple(written), plan.run, plan.times[0], plan.times[-1], plan.variables, size, plan.notes
    )


def _check_complete(source: ForecastSource, plan: DownloadPlan, datasets: Sequence[Any]) -> None:
    """Raise `CoverageError` if a variable or a time is missing."""
    for name in plan.variables:
        holder = next((dataset for dataset in datasets if name in dataset), None)
        present = np.array([])
        if holder is not None:
            dims = [dim for dim in holder[name].dims if dim != "time"]
            known = np.asarray(holder[name].notnull().any(dims).values)
            stamps = holder["time"].values.astype("datetime64[ns]").astype(np.int64)
            present = stamps[known] / 1e9
        missing = [t for t in plan.times if not (np.abs(present - t) < 1.0).any()]
        if missing:
            raise CoverageError(
                f"{source.title} did not deliver {name} at {len(missing)} of {len(plan.times)} "
                f"times, the first {format_time(missing[0])}, the last {format_time(missing[-1])}.",
                "Nothing was written: a file with gaps would hide weather.",
                "Try again later, or choose another run, period or box.",
                variable=name,
            )


def _described(dataset: Any, source: ForecastSource, plan: DownloadPlan) -> Any:
    """Return a dataset with its origin in the attributes."""
    hosts = sorted({urlsplit(part.url).hostname or "" for part in plan.parts} - {""})
    facts = {
        "Conventions": "CF-1.8",
        "title": source.title,
        "license": source.licence,
        "attribution": source.attribution,
        "history": f"{format_time(time.time())} fetched from {', '.join(hosts)} by thalweg fetch",
    }
    if plan.run is not None:
        facts["forecast_reference_time"] = format_time(plan.run)
    described = dataset.assign_attrs(facts)
    described["latitude"].attrs = {"standard_name": "latitude", "units": "degrees_north"}
    described["longitude"].attrs = {"standard_name": "longitude", "units": "degrees_east"}
    return described


def _write(dataset: Any, path: Path) -> None:
    """Write a dataset whole or not at all."""
    draft = path.with_name(f".{secrets.token_hex(8)}.part")
    packed = {"dtype": "float32", "zlib": True, "complevel": 4, "shuffle": True}
    try:
        encoding = {str(name): packed for name in dataset.data_vars}
        dataset.to_netcdf(draft, engine="netcdf4", encoding=encoding)
        os.replace(draft, path)
    except OSError as error:
        raise unwritable_error("file", path, error) from error
    except (ValueError, TypeError) as error:
        raise DatasetError(
            f"The fields that arrived cannot be written as NetCDF: {error}.",
            "Fields on one grid with times can be written.",
            "Report this with the request.",
        ) from error
    finally:
        draft.unlink(missing_ok=True)
