"""Open-Meteo: wind, waves and currents at single positions, put together as a grid.

No account is needed. The service is free for non-commercial use within limits of calls
(https://open-meteo.com/en/terms), so the grid is small. Directions of wind and waves are those that
they come from, of currents those that they go to (https://open-meteo.com/en/docs/marine-weather-api).
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final
from urllib.parse import urlencode

import numpy as np

from thalweg.core.errors import DatasetError, InputError
from thalweg.core.time import format_time, to_datetime64
from thalweg.core.units import DAY, HOUR, KNOT
from thalweg.forecasts.box_cut import join_pieces
from thalweg.forecasts.download_client import DownloadClient, DownloadPart
from thalweg.forecasts.download_plan import DownloadPlan
from thalweg.forecasts.forecast_request import ForecastRequest

_MOST_POSITIONS: Final = 900  #: of one request; a day allows 10,000 calls
_PER_CALL: Final = 100
_LONGEST: Final = 16 * DAY
_WEATHER: Final = ("wind_speed_10m", "wind_direction_10m")
_MARINE: Final = {
    "waves": ("wave_height", "wave_direction", "wave_peak_period"),
    "current": ("ocean_current_velocity", "ocean_current_direction"),
}
_RESULTS: Final = {
    "wind": ("eastward_wind", "northward_wind"),
    "waves": (
        "sea_surface_wave_significant_height",
        "sea_surface_wave_from_direction",
        "sea_surface_wave_period_at_variance_spectral_density_maximum",
    ),
    "current": ("eastward_sea_water_velocity", "northward_sea_water_velocity"),
}
#: Factors to SI of the units that the service states; any other is refused.
_FACTORS: Final = {
    "m/s": 1.0,
    "km/h": 1.0 / 3.6,
    "kn": KNOT,
    "m": 1.0,
    "s": 1.0,
    "°": 1.0,
}


@dataclass(frozen=True)
class OpenMeteo:
    """Open-Meteo weather and marine forecasts.

    Parameters
    ----------
    weather, marine : Addresses of the two services.
    """

    weather: str = "https://api.open-meteo.com/v1/forecast"
    marine: str = "https://marine-api.open-meteo.com/v1/marine"
    name: str = "open-meteo"
    title: str = "Open-Meteo weather and marine forecasts"
    licence: str = "CC BY 4.0, non-commercial use"
    attribution: str = "Weather data by Open-Meteo.com"
    quantities: tuple[str, ...] = ("wind", "waves", "current")

    def plan(self, request: ForecastRequest, client: DownloadClient, now: float) -> DownloadPlan:
        """Return what is downloaded; see `ForecastSource.plan`."""
        if request.run is not None or request.members:
            raise InputError(
                "A run or members of an ensemble were requested.",
                f"{self.title} gives its latest forecast only.",
                "Leave them out, or use gfs or ecmwf.",
            )
        if request.end > now + _LONGEST or request.start < now - 90 * DAY:
            raise InputError(
                f"{format_time(request.start)} to {format_time(request.end)} was requested.",
                f"{self.title} covers 90 days back to 16 days ahead.",
                "Choose another period.",
            )
        lat, lon = self._grid(request)
        rows, columns = np.meshgrid(lat, lon, indexing="ij")
        places = np.column_stack([rows.ravel(), columns.ravel()])
        marine = [name for q in request.quantities for name in _MARINE.get(q, ())]
        parts = []
        for service, hourly in ((self.weather, _WEATHER), (self.marine, marine)):
            if (service == self.weather and "wind" not in request.quantities) or not hourly:
                continue
            for first in range(0, len(places), _PER_CALL):
                some = places[first : first + _PER_CALL]
                parts.append(self._part(request, service, tuple(hourly), some, now))
        begin = request.start // HOUR * HOUR
        times = np.arange(begin, request.end + request.step, request.step)
        size = 8.0 * len(places) * len(times) * max(len(marine) + 2, 1)
        variables = tuple(name for q in request.quantities for name in _RESULTS.get(q, ()))
        return DownloadPlan(tuple(parts), size, None, tuple(map(float, times)), variables)

    def read(self, request: ForecastRequest, plan: DownloadPlan, files: list[Path]) -> list[Any]:
        """Return the fields of downloaded files; see `ForecastSource.read`."""
        lat, lon = self._grid(request)
        times = np.array(plan.times)
        fields: dict[str, np.ndarray] = {}
        done: dict[str, int] = {}
        for part, path in zip(plan.parts, files):
            answers = json.loads(path.read_text("utf-8"))
            answers = answers if isinstance(answers, list) else [answers]
            for answer in answers:
                for name, values in _series(answer, times, part).items():
                    field = fields.setdefault(
                        name, np.full((len(lat) * len(lon), len(times)), np.nan)
                    )
                    place = done.get(name, 0)
                    field[place] = values
                    done[name] = place + 1
        return join_pieces([_dataset(lat, lon, times, fields)])

    def _grid(self, request: ForecastRequest) -> tuple[np.ndarray, np.ndarray]:
        """Return the latitudes and longitudes of the grid [deg]; the spacing fits the box."""
        box = request.box
        for spacing in (0.1, 0.2, 0.25, 0.5, 1.0, 2.0, 2.5):
            lat = _axis(box.south, box.north, spacing)
            lon = _axis(box.west, box.west + box.width, spacing)
            if len(lat) * len(lon) <= _MOST_POSITIONS:
                return lat, lon
        raise InputError(
            f"A box of {box.north - box.south:g} by {box.width:g} degrees was requested.",
            f"{self.title} gives at most {_MOST_POSITIONS} positions, 2.5 degrees apart.",
            "Choose a smaller box, or use gfs or ecmwf.",
        )

    def _part(
        self,
        request: ForecastRequest,
        service: str,
        hourly: tuple[str, ...],
        places: np.ndarray,
        now: float,
    ) -> DownloadPart:
        query = {
            "latitude": ",".join(f"{lat:g}" for lat in places[:, 0]),
            "longitude": ",".join(f"{(lon + 180.0) % 360.0 - 180.0:g}" for lon in places[:, 1]),
            "hourly": ",".join(hourly),
            "timeformat": "unixtime",
            "start_date": format_time(request.start)[:10],
            "end_date": format_time(request.end + request.step)[:10],
        }
        if service == self.weather:
            query["wind_speed_unit"] = "ms"
        # the latest forecast changes every hour: the cache must not keep it longer
        query_text = urlencode(query) + f"#{int(now // HOUR)}"
        return DownloadPart(f"{service}?{query_text}", (), f"{len(places)} positions")


def _axis(low: float, high: float, spacing: float) -> np.ndarray:
    first, last = np.floor(low / spacing + 1e-9), np.ceil(high / spacing - 1e-9)
    return np.round(np.arange(first, last + 1) * spacing, 6)


def _series(answer: Any, times: np.ndarray, part: DownloadPart) -> dict[str, np.ndarray]:
    """Return the variables at one position at the given times; NaN where the service has none."""
    try:
        hourly, units = answer["hourly"], answer["hourly_units"]
        given = np.array(hourly["time"], float)
    except (KeyError, TypeError, ValueError) as error:
        reason = answer.get("reason", "") if isinstance(answer, Mapping) else ""
        raise DatasetError(
            f"The answer of {part.url.split('?')[0]} is not a forecast. {reason}".strip(),
            "An answer has 'hourly' and 'hourly_units'.",
            "Try again later, or use another source.",
        ) from error
    found: dict[str, np.ndarray] = {}
    for name, values in hourly.items():
        if name == "time":
            continue
        factor = _FACTORS.get(units.get(name, ""))
        if factor is None:
            raise DatasetError(
                f"{name} is in {units.get(name)!r}.",
                f"Units: {', '.join(_FACTORS)}.",
                "Use another source, and report this.",
            )
        series = np.array([np.nan if v is None else float(v) for v in values]) * factor
        at = np.searchsorted(given, times)
        hit = (at < len(given)) & (given[np.minimum(at, len(given) - 1)] == times)
        found[name] = np.where(hit, series[np.minimum(at, len(given) - 1)], np.nan)
    return _standard(found)


def _standard(series: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return the variables under their standard names; directions become components."""
    result: dict[str, np.ndarray] = {}
    if "wind_speed_10m" in series:
        origin = np.radians(series["wind_direction_10m"])
        speed = series["wind_speed_10m"]
        result["eastward_wind"] = -speed * np.sin(origin)
        result["northward_wind"] = -speed * np.cos(origin)
    if "ocean_current_velocity" in series:
        towards = np.radians(series["ocean_current_direction"])
        speed = series["ocean_current_velocity"]
        result["eastward_sea_water_velocity"] = speed * np.sin(towards)
        result["northward_sea_water_velocity"] = speed * np.cos(towards)
    if "wave_height" in series:
        names = _MARINE["waves"]
        result |= {ours: series[theirs] for ours, theirs in zip(_RESULTS["waves"], names)}
    return result


def _dataset(
    lat: np.ndarray, lon: np.ndarray, times: np.ndarray, fields: Mapping[str, np.ndarray]
) -> Any:
    import xarray as xr

    shape = len(lat), len(lon), len(times)
    units = {"height": "m", "period": "s", "direction": "degree"}
    data = {}
    for name, values in fields.items():
        unit = next((unit for word, unit in units.items() if word in name), "m s-1")
        block = np.moveaxis(values.reshape(shape), 2, 0)
        attributes = {"standard_name": name, "units": unit}
        data[name] = (("time", "latitude", "longitude"), block, attributes)
    return xr.Dataset(data, {"time": to_datetime64(times), "latitude": lat, "longitude": lon})
