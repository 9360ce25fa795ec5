"""RWS Matroos: currents, water levels and waves of the North Sea by Rijkswaterstaat.

The server interpolates a model to a grid of latitude and longitude and sends NetCDF
(https://noos.matroos.rws.nl/direct/). No account is needed. Currents of the model DCSM-FM are to
the east and north, near the surface; water levels are above its datum, about mean sea level.
"""

from __future__ import annotations

import datetime
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final
from urllib.parse import urlencode

import numpy as np

from thalweg.core.bounding_box import BoundingBox
from thalweg.core.errors import DatasetError, InputError
from thalweg.core.time import format_time, parse_time, to_datetime64
from thalweg.core.units import HOUR
from thalweg.forecasts.box_cut import cut_to_box, join_pieces
from thalweg.forecasts.download_client import DownloadClient, DownloadPart
from thalweg.forecasts.download_plan import DownloadPlan
from thalweg.forecasts.forecast_request import ForecastRequest
from thalweg.sea.standard_names import WAVE_PERIOD

_SPACING: Final = 0.05  # of the grid that is asked for [deg]
_REACH: Final = 48  # of a run [h]
_SEARCHED: Final = 5 * 24 * HOUR  # period before the start in which a run is looked for [s]
_MOST_VALUES: Final = 2_000_000  # of one request: larger ones fail on the server
_PEAK: Final = 1.1  # peak period over Tm-1,0 of a usual spectrum (EurOtop manual, 2018)
_NOTES: Final = {
    "current": "Water levels are above the datum of the model, about mean sea level.",
    "waves": f"Peak periods are {_PEAK} times the mean periods (Tm-1,0) that the model has.",
}
_MINUTE: Final = 60.0
_EPOCH_UNITS: Final = "minutes since 1970-01-01"


@dataclass(frozen=True)
class MatroosModel:
    """A model of the server: its name, area, and variables by their names there.

    Attributes
    ----------
    box : South, north, west, east [deg].
    fields : The standard name and the greatest possible size of each variable [SI].
    """

    source: str
    box: tuple[float, float, float, float]
    fields: dict[str, tuple[str, float]]


MODELS: Final = {
    "current": MatroosModel(
        "dcsm7_harmonie_bf_f2w",
        (43.0, 64.0, -12.0, 13.0),
        {
            "velu": ("eastward_sea_water_velocity", 15.0),
            "velv": ("northward_sea_water_velocity", 15.0),
            "sep": ("sea_surface_height_above_geopotential_datum", 20.0),
        },
    ),
    "waves": MatroosModel(
        "swan_dcsm_harmonie",
        (48.0, 64.0, -12.0, 9.0),
        {
            "wave_height_hm0": ("sea_surface_wave_significant_height", 40.0),
            "wave_period_tm10": (WAVE_PERIOD, 60.0),
            "wave_dir_th0": ("sea_surface_wave_from_direction", 360.0),
        },
    ),
}


@dataclass(frozen=True)
class Matroos:
    """Models of Rijkswaterstaat on the server NOOS-Matroos.

    Parameters
    ----------
    root : Address of its direct interface.
    """

    root: str = "https://noos.matroos.rws.nl/direct"
    name: str = "matroos"
    title: str = "Rijkswaterstaat Matroos, DCSM and SWAN"
    licence: str = "CC0 1.0 (open data of Rijkswaterstaat); no guarantee"
    attribution: str = "Contains data of Rijkswaterstaat"
    quantities: tuple[str, ...] = ("current", "waves")

    def plan(self, request: ForecastRequest, client: DownloadClient, now: float) -> DownloadPlan:
        """Return what is downloaded; see `ForecastSource.plan`."""
        models = [MODELS[name] for name in request.quantities]
        for model in models:
            self._check_area(request.box, model)
        run = self._run(request, client, now, models)
        hours = request.steps(run, range(_REACH + 1))
        parts = [
            part
            for model in models
            for part in self._parts(request.box, model, run, hours)
        ]  # fmt: skip
        values = request.values(_SPACING, sum(len(model.fields) for model in models), len(hours))
        return DownloadPlan(
            tuple(parts),
            4.0 * values,
            run,
            tuple(run + hour * HOUR for hour in hours),
            tuple(name for model in models for name, _ in model.fields.values()),
            tuple(_NOTES[name] for name in request.quantities),
        )

    def read(self, request: ForecastRequest, plan: DownloadPlan, files: list[Path]) -> list[Any]:
        """Return the fields of downloaded files; see `ForecastSource.read`."""
        pieces = [
            cut_to_box(_fields(path, part.url), request.box)
            for part, path in zip(plan.parts, files)
        ]
        wanted = to_datetime64(np.array(plan.times))
        return [
            piece.sel(time=np.isin(piece["time"].values, wanted)) for piece in join_pieces(pieces)
        ]

    def _check_area(self, box: BoundingBox, model: MatroosModel) -> None:
        south, north, west, east = model.box
        inside = south <= box.south and box.north <= north
        if not (inside and west <= box.west and box.west + box.width <= east):
            raise InputError(
                f"The box {box.south:g} to {box.north:g} N, {box.west:g} to "
                f"{box.west + box.width:g} E was requested.",
                f"The model {model.source} covers {south:g} to {north:g} N, {west:g} to {east:g} "
                "E.",
                "Choose a box inside it, or another source.",
            )

    def _run(
        self,
        request: ForecastRequest,
        client: DownloadClient,
        now: float,
        models: list[MatroosModel],
    ) -> float:
        """Return the latest run of all models that is not after the start of the period."""
        if request.run is not None:
            return request.run
        last = min(now, request.start)
        runs = [set(self._runs(client, model, last)) for model in models]
        common = set.intersection(*runs)
        if not common:
            raise InputError(
                f"No run of {self.title} was found for {format_time(request.start)}.",
                "The server keeps the runs of some days, and names those that are complete.",
                "Choose another period, or give a run.",
            )
        return max(common)

    def _runs(self, client: DownloadClient, model: MatroosModel, last: float) -> Iterator[float]:
        text = client.text(
            f"{self.root}/get_anal_times.php",
            database="maps2d",
            source=model.source,
            tstart=_stamp(last - _SEARCHED),
            tstop=_stamp(last),
        )
        for word in (text or "").split():
            if len(word) == 12 and word.isdigit():
                run = parse_time(f"{word[:4]}-{word[4:6]}-{word[6:8]}T{word[8:10]}:{word[10:]}Z")
                if run <= last:
                    yield run

    def _parts(
        self, box: BoundingBox, model: MatroosModel, run: float, hours: list[int]
    ) -> Iterator[DownloadPart]:
        """Yield the requests of a model: as many hours in each as the server can give at once."""
        low, high, left, right = model.box
        south, north = _edges(box.south, box.north, low, high)
        west, east = _edges(box.west, box.west + box.width, left, right)
        rows, columns = (round((b - a) / _SPACING) + 1 for a, b in ((south, north), (west, east)))
        together = max(1, _MOST_VALUES // (rows * columns * len(model.fields)))
        for first in range(hours[0], hours[-1] + 1, together):
            last = min(first + together - 1, hours[-1])
            query = {
                "source": model.source, "anal": _stamp(run), "color": ",".join(model.fields),
                "coords": "WGS84", "xmin": f"{west:g}", "xmax": f"{east:g}", "ymin": f"{south:g}",
                "ymax": f"{north:g}", "xn": columns, "yn": rows,
                "from": _stamp(run + first * HOUR), "to": _stamp(run + last * HOUR),
                "dtmin": 60, "format": "nc",
            }  # fmt: skip
            label = f"{model.source} at {format_time(run + first * HOUR)}"
            yield DownloadPart(f"{self.root}/get_matroos.php?{urlencode(query)}", (), label)


def _edges(low: float, high: float, least: float, most: float) -> tuple[float, float]:
    """Return edges on multiples of the spacing around a range, within the area of a model."""
    first = np.floor(low / _SPACING + 1e-9) * _SPACING
    last = np.ceil(high / _SPACING - 1e-9) * _SPACING
    return round(max(float(first), least), 6), round(min(float(last), most), 6)


def _stamp(moment: float) -> str:
    return f"{datetime.datetime.fromtimestamp(moment, datetime.UTC):%Y%m%d%H%M}"


def _fields(path: Path, url: str) -> Any:
    """Return the fields of an answer under their standard names; NaN where unknown."""
    import xarray as xr

    start = path.read_bytes()[:300]
    if start[:3] != b"CDF" and start[:4] != b"\x89HDF":
        path.unlink()  # the cache must not keep it
        said = " ".join(start.decode("utf-8", "replace").split())
        raise DatasetError(
            f"The answer of {url.split('?')[0]} is not NetCDF: {said[:160]!r}.",
            "The server answers so when it has no data, or is busy.",
            "Try again later, or choose another period or a smaller box.",
        )
    with xr.open_dataset(path, decode_times=False, engine="netcdf4") as found:
        found = found.load()
    known = {name: field for model in MODELS.values() for name, field in model.fields.items()}
    axes = {"x": "longitude", "y": "latitude", "lon": "longitude", "lat": "latitude"}
    names = {old: new for old, new in axes.items() if old in found.dims}
    data = {}
    for name, (standard, most) in known.items():
        if name in found:
            field = found[name].rename({k: v for k, v in names.items() if k in found[name].dims})
            field = field.where(np.abs(field) <= most)  # dry cells are 999 or 1e30 there
            field = field * (_PEAK if standard == WAVE_PERIOD else 1.0)
            data[standard] = field.assign_attrs(standard_name=standard, units=_unit(standard))
    units = str(found["time"].attrs.get("units") or _EPOCH_UNITS).lower()
    if not units.startswith(_EPOCH_UNITS):
        raise DatasetError(
            f"The times of {url.split('?')[0]} are in {units[:60]!r}.",
            f"Known: {_EPOCH_UNITS}.",
            "Use another source, and report this.",
        )
    seconds = np.asarray(found["time"].values, float) * _MINUTE
    return xr.Dataset(data).assign_coords(time=to_datetime64(np.round(seconds)))


def _unit(standard: str) -> str:
    units = {"velocity": "m s-1", "height": "m", "period": "s", "direction": "degree"}
    return next(unit for word, unit in units.items() if word in standard)
