"""ERA5, the reanalysis of ECMWF from 1940, from the Climate Data Store.

The client ``cdsapi`` is used; it reads the key of the account from its own file ``~/.cdsapirc``.
Requests are split by month, and each month that has arrived is kept. Names of the request are those
of https://cds.climate.copernicus.eu/datasets/reanalysis-era5-single-levels. Not tried against the
live service by the tests.
"""

from __future__ import annotations

import datetime
import hashlib
import os
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from thalweg.core.errors import InputError
from thalweg.core.file_writing import write_bytes
from thalweg.core.time import format_time
from thalweg.core.units import DAY, HOUR
from thalweg.forecasts.box_cut import longitude_spans, read_grib_files
from thalweg.forecasts.download_client import DownloadClient, TransferError
from thalweg.forecasts.download_plan import DownloadPlan
from thalweg.forecasts.forecast_request import ForecastRequest

DATASET: Final = "reanalysis-era5-single-levels"
_DELAY: Final = 6 * DAY  #: of the first release
_VARIABLES: Final = {
    "wind": (("10m_u_component_of_wind", "u10"), ("10m_v_component_of_wind", "v10")),
    "waves": (
        ("significant_height_of_combined_wind_waves_and_swell", "swh"),
        ("mean_wave_direction", "mwd"),
        ("peak_wave_period", "pp1d"),
    ),
    "pressure": (("mean_sea_level_pressure", "msl"),),
    "ice": (("sea_ice_cover", "siconc"),),
}


def _cds_client() -> Any:
    try:
        import cdsapi
    except ImportError as error:
        raise InputError(
            "ERA5 needs the client of the Climate Data Store.",
            "It uses a free account and the key in ~/.cdsapirc.",
            "pip install cdsapi",
        ) from error
    try:
        return cdsapi.Client(quiet=True, progress=False)
    except Exception as error:
        raise InputError(
            f"The client of the Climate Data Store cannot start: {error}.",
            "It reads the key of your account from ~/.cdsapirc.",
            "Write that file as https://cds.climate.copernicus.eu/how-to-api describes.",
        ) from error


@dataclass(frozen=True)
class Era5:
    """ERA5 hourly fields: wind and pressure at 0.25 degrees, waves at 0.5 degrees.

    Parameters
    ----------
    open_client : Returns a client with ``retrieve(dataset, request, target)``.
    """

    open_client: Callable[[], Any] = _cds_client
    name: str = "era5"
    title: str = "ERA5 reanalysis, Copernicus Climate Change Service"
    licence: str = "CC BY 4.0 (licence to use Copernicus products)"
    attribution: str = "Contains modified Copernicus Climate Change Service information"
    quantities: tuple[str, ...] = ("wind", "waves", "pressure", "ice")

    def plan(self, request: ForecastRequest, client: DownloadClient, now: float) -> DownloadPlan:
        """Return what is downloaded; see `ForecastSource.plan`."""
        if request.run is not None:
            raise InputError(
                "A run was requested.", "ERA5 is a reanalysis without runs.", "Leave it out."
            )
        if request.end > now - _DELAY:
            raise InputError(
                f"ERA5 until {format_time(request.end)} was requested.",
                f"It reaches {format_time(now - _DELAY)}, about six days ago.",
                "Choose an earlier period, or a forecast (gfs, ecmwf).",
            )
        step = int(request.step // HOUR)
        first = int(request.start // HOUR) // step * step
        last = -(-int(-(-request.end // HOUR)) // step) * step
        times = tuple(HOUR * float(hour) for hour in range(first, last + 1, step))
        fields = [field for q in request.quantities for field in _VARIABLES[q]]
        size = 2.0 * request.values(0.25, len(fields), len(times))
        return DownloadPlan((), size, None, times, tuple(decoded for _, decoded in fields))

    def read(self, request: ForecastRequest, plan: DownloadPlan, files: list[Path]) -> list[Any]:
        """Return the fields, downloaded month by month; see `ForecastSource.read`."""
        folder = DownloadClient().folder
        folder.mkdir(parents=True, exist_ok=True)
        client: Any = None
        paths = []
        for wanted in self._requests(request, plan):
            key = hashlib.blake2b(repr(sorted(wanted.items())).encode(), digest_size=16).hexdigest()
            path = folder / f"{key}.grib"
            if not path.exists():
                client = client or self.open_client()
                draft = path.with_suffix(".part")
                try:
                    client.retrieve(DATASET, wanted, str(draft))
                except Exception as error:
                    raise TransferError(
                        f"The Climate Data Store did not deliver {wanted['year']}-"
                        f"{wanted['month']}: {str(error)[:300]}.",
                        "Months that have arrived are kept.",
                        "Accept the licence of the dataset on its page, or try again later.",
                    ) from error
                _unpack(draft)
                os.replace(draft, path)
            paths.append(path)
        wanted_times = set(plan.times)
        datasets = read_grib_files(paths, request.box)
        return [_at_times(dataset, wanted_times) for dataset in datasets]

    def _requests(self, request: ForecastRequest, plan: DownloadPlan) -> list[dict[str, Any]]:
        """Return one request per month, and two for a box across the antimeridian."""
        months: dict[tuple[int, int], tuple[set[str], set[str]]] = {}
        for moment in plan.times:
            stamp = datetime.datetime.fromtimestamp(moment, datetime.UTC)
            days, hours = months.setdefault((stamp.year, stamp.month), (set(), set()))
            days.add(f"{stamp:%d}")
            hours.add(f"{stamp:%H}:00")
        box = request.box
        return [
            {
                "product_type": ["reanalysis"],
                "variable": [name for q in request.quantities for name, _ in _VARIABLES[q]],
                "year": f"{year}",
                "month": f"{month:02d}",
                "day": sorted(days),
                "time": sorted(hours),
                "area": [box.north + 0.5, low - 0.5, box.south - 0.5, high + 0.5],
                "data_format": "grib",
                "download_format": "unarchived",
            }
            for (year, month), (days, hours) in sorted(months.items())
            for low, high in longitude_spans(box)
        ]


def _unpack(path: Path) -> None:
    """Put the GRIB files of an archive in its place: the service may send one all the same."""
    if not zipfile.is_zipfile(path):
        return
    with zipfile.ZipFile(path) as archive:
        whole = b"".join(archive.read(name) for name in archive.namelist())
    write_bytes(path, whole)


def _at_times(dataset: Any, wanted: set[float]) -> Any:
    """Return a dataset at the wanted times only; a month holds all hours of all its days."""
    stamps = dataset["time"].values.astype("datetime64[s]").astype(float)
    return dataset.isel(time=[k for k, stamp in enumerate(stamps) if stamp in wanted])
