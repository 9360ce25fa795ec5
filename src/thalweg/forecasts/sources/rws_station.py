"""RWS Waterwebservices: the water level at one station of Rijkswaterstaat.

The service gives series of single stations, as JSON after a POST
(https://rijkswaterstaatdata.nl/waterdata/). No account is needed. The level of the station nearest
to the middle of the box holds in the whole box, which is small for this reason. Measured levels are
followed by expected ones, and these by the astronomical tide.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from thalweg.core.bounding_box import BoundingBox
from thalweg.core.errors import DatasetError, InputError
from thalweg.core.geodesy import distance
from thalweg.core.time import format_time, parse_time, to_datetime64
from thalweg.core.units import HOUR, NAUTICAL_MILE
from thalweg.forecasts.download_client import DownloadClient, DownloadPart
from thalweg.forecasts.download_plan import DownloadPlan
from thalweg.forecasts.forecast_request import ForecastRequest
from thalweg.sea.standard_names import WATER_LEVEL

_LARGEST_BOX: Final = 60.0 * NAUTICAL_MILE  # diagonal, in which one level may stand for all water
_LONGEST_PART: Final = 31 * 24 * HOUR  # of one request: longer ones are refused or time out
_LEVEL: Final = "WATHTE"  # the code of water levels
_PROCESSES: Final = ("meting", "verwachting", "astronomisch")  # each follows where the last ends
_DATUMS: Final = ("NAP", "MSL")
_UNITS: Final = {"cm": 0.01, "m": 1.0}
_UNKNOWN: Final = "99"  # the quality code of a missing value
_HIGHEST: Final = 20.0  # levels beyond this are no levels [m]
_BYTES_PER_HOUR: Final = 3 * 6 * 400.0  # of three series with values every ten minutes


class LevelStation(NamedTuple):
    """A station that has water levels."""

    code: str
    name: str
    lat: float
    lon: float


class LevelSeries(NamedTuple):
    """Levels [m] at times [s since 1970], with the datum and the process they come from."""

    process: str
    datum: str
    times: np.ndarray
    levels: np.ndarray


@dataclass(frozen=True)
class RwsStation:
    """Water levels of single stations of Rijkswaterstaat.

    Parameters
    ----------
    root : Address of the service.
    """

    root: str = "https://ddapi20-waterwebservices.rijkswaterstaat.nl"
    name: str = "rws"
    title: str = "Rijkswaterstaat Waterwebservices, water level at one station"
    licence: str = "CC0 1.0 (open data of Rijkswaterstaat); no guarantee"
    attribution: str = "Contains data of Rijkswaterstaat"
    quantities: tuple[str, ...] = ("level",)

    def plan(self, request: ForecastRequest, client: DownloadClient, now: float) -> DownloadPlan:
        """Return what is downloaded; see `ForecastSource.plan`."""
        station, away = self._station(request.box, client)
        first, last = np.floor(request.start / HOUR) * HOUR, np.ceil(request.end / HOUR) * HOUR
        times = np.arange(first, last + 1.0, HOUR)
        note = (
            f"The level of {station.name} ({station.lat:.3f}, {station.lon:.3f}), "
            f"{away / NAUTICAL_MILE:.1f} nm from the middle of the box, holds in the whole box: "
            "measured as far as there are measurements, then expected, then the astronomical tide."
        )
        return DownloadPlan(
            tuple(self._parts(station, first, last, now)),
            _BYTES_PER_HOUR * len(times),
            None,
            tuple(times.tolist()),
            (WATER_LEVEL,),
            (note,),
        )

    def read(self, request: ForecastRequest, plan: DownloadPlan, files: list[Path]) -> list[Any]:
        """Return the fields of downloaded files; see `ForecastSource.read`."""
        import xarray as xr

        found = [
            series
            for part, path in zip(plan.parts, files)
            for series in _series_of(_json_of(path.read_text("utf-8"), part.url, path))
        ]
        times, levels, words = _joined(found, plan.times[0], plan.times[-1])
        box = request.box
        field = np.broadcast_to(levels[:, None, None], (len(levels), 2, 2)).copy()
        attributes = {"standard_name": WATER_LEVEL, "units": "m", "comment": words}
        dataset = xr.Dataset(
            {WATER_LEVEL: (("time", "latitude", "longitude"), field, attributes)},
            coords={
                "time": to_datetime64(np.round(times)),
                "latitude": [box.south, box.north],
                "longitude": [box.west, box.west + box.width],
            },
        )
        return [dataset]

    def _station(self, box: BoundingBox, client: DownloadClient) -> tuple[LevelStation, float]:
        """Return the station nearest to the middle of a box, and how far it is from there [m]."""
        east = box.west + box.width
        diagonal = float(distance(box.south, box.west, box.north, east))
        if diagonal > _LARGEST_BOX or box.south == box.north:
            raise InputError(
                f"The box from {box.south:g}, {box.west:g} to {box.north:g}, {east:g} was "
                "requested.",
                "The level of one station stands for water near it: the diagonal of the box is at "
                f"most {_LARGEST_BOX / NAUTICAL_MILE:.0f} nm, and more than 0.",
                "Choose a small box around the station; matroos has levels of whole seas.",
                field="box",
            )
        body = json.dumps({"CatalogusFilter": {"Grootheden": True}}, allow_nan=False)
        url = f"{self.root}/METADATASERVICES/OphalenCatalogus"
        stations = list(_stations_of(_json_of(client.text(url, body=body) or "", url)))
        inside = [
            one for one in stations
            if box.covers(np.array([one.lat]), np.array([one.lon]))[0]
        ]  # fmt: skip
        middle = 0.5 * (box.south + box.north), box.west + 0.5 * box.width
        if not inside:
            near = min(
                stations, key=lambda one: float(distance(*middle, one.lat, one.lon)), default=None
            )
            raise InputError(
                "There is no station with water levels in the box.",
                "Stations are on the coast, in the estuaries and on platforms of the Netherlands."
                if near is None
                else f"The nearest one is {near.name} at {near.lat:.3f}, {near.lon:.3f}.",
                "Choose a box around a station.",
                field="box",
            )
        away = [float(distance(*middle, one.lat, one.lon)) for one in inside]
        best = int(np.argmin(away))
        return inside[best], away[best]

    def _parts(
        self, station: LevelStation, first: float, last: float, now: float
    ) -> Iterator[DownloadPart]:
        """Yield the requests, each for a month at most."""
        # new values arrive all the time: the cache must not keep an answer for more than an hour
        url = f"{self.root}/ONLINEWAARNEMINGENSERVICES/OphalenWaarnemingen#{int(now // HOUR)}"
        for begin in np.arange(first, last, _LONGEST_PART):
            end = min(float(begin) + _LONGEST_PART, last)
            quantity = {"Compartiment": {"Code": "OW"}, "Grootheid": {"Code": _LEVEL}}
            body = {
                "Locatie": {"Code": station.code},
                "AquoPlusWaarnemingMetadata": {"AquoMetadata": quantity},
                "Periode": {
                    "Begindatumtijd": _stamp(float(begin)),
                    "Einddatumtijd": _stamp(end),
                },
            }
            label = f"{station.name} from {format_time(float(begin))}"
            yield DownloadPart(url, (), label, json.dumps(body, allow_nan=False))


def _stamp(moment: float) -> str:
    return format_time(moment).replace("Z", ".000+00:00")


def _json_of(text: str, url: str, path: Path | None = None) -> Mapping[str, Any]:
    """Return an answer of the service.

    Raises
    ------
    DatasetError : If it is none, or states an error; the file is removed from the cache.
    """
    try:
        data = json.loads(text)
    except ValueError:
        data = None
    if isinstance(data, Mapping) and data.get("Succesvol", True):
        return data
    if path is not None:
        path.unlink(missing_ok=True)
    said = data.get("Foutmelding") if isinstance(data, Mapping) else " ".join(text.split())[:160]
    raise DatasetError(
        f"The answer of {url.partition('#')[0]} is not data: {said or 'it is empty'!r}.",
        "The service answers so when it is busy, or has nothing for the period.",
        "Try again later, or choose another period or station.",
    )


def _stations_of(catalogue: Mapping[str, Any]) -> Iterator[LevelStation]:
    """Yield the stations of a catalogue that have water levels."""
    lists = {str(key).casefold(): value or () for key, value in catalogue.items()}
    level_ids = {
        _entry(row, "aquometadata_messageid")
        for row in lists.get("aquometadatalijst", ())
        if _code(row, "Grootheid") == _LEVEL
    }
    with_levels = {
        _entry(row, "locatie_messageid")
        for row in lists.get("aquometadatalocatielijst", ())
        if _entry(row, "aquometadata_messageid") in level_ids
    }
    for row in lists.get("locatielijst", ()):
        lat, lon = _entry(row, "lat"), _entry(row, "lon")
        if _entry(row, "locatie_messageid") in with_levels and lat is not None and lon is not None:
            code = str(row.get("Code"))
            yield LevelStation(code, str(row.get("Naam") or code), float(lat), float(lon))


def _entry(row: Mapping[str, Any], name: str) -> Any:
    """Return an entry whatever the case of its name: the service spells one in two ways."""
    return next((value for key, value in row.items() if key.casefold() == name), None)


def _code(row: Mapping[str, Any], name: str) -> str:
    return str((row.get(name) or {}).get("Code") or "")


def _series_of(answer: Mapping[str, Any]) -> Iterator[LevelSeries]:
    """Yield the series of levels of an answer; groups (high and low waters) are left out.

    Raises
    ------
    DatasetError : If a unit is not known.
    """
    for row in answer.get("WaarnemingenLijst") or ():
        about = row.get("AquoMetadata") or {}
        process = str(about.get("ProcesType") or "")
        if _code(about, "Grootheid") != _LEVEL or _code(about, "Groepering"):
            continue
        if process not in _PROCESSES:
            continue
        unit = _code(about, "Eenheid")
        if unit not in _UNITS:
            raise DatasetError(
                f"Water levels have the unit {unit!r}.", f"Known: {', '.join(_UNITS)}.",
                "Use another source, and report this.",
            )  # fmt: skip
        values = {
            parse_time(one["Tijdstip"]): _UNITS[unit] * float(level)
            for one in row.get("MetingenLijst") or ()
            if (level := (one.get("Meetwaarde") or {}).get("Waarde_Numeriek")) is not None
            and str((one.get("WaarnemingMetadata") or {}).get("Kwaliteitswaardecode")) != _UNKNOWN
        }
        kept = sorted((t, level) for t, level in values.items() if abs(level) <= _HIGHEST)
        if kept:
            times, levels = np.array(kept).T
            yield LevelSeries(process, _code(about, "Hoedanigheid"), times, levels)


def _joined(
    series: list[LevelSeries], first: float, last: float
) -> tuple[np.ndarray, np.ndarray, str]:
    """Return times [s since 1970] and levels [m] of a period, and what they are in words."""
    datums = [name for name in _DATUMS if any(one.datum == name for one in series)]
    same = [one for one in series if one.datum == datums[0]] if datums else []
    until, times, levels, words = first - 1.0, [], [], []
    for process, name in zip(_PROCESSES, ("measured", "expected", "astronomical")):
        values = dict(
            pair
            for one in same if one.process == process
            for pair in zip(one.times.tolist(), one.levels.tolist())
            if until < pair[0] <= last
        )  # fmt: skip
        if values:
            times += sorted(values)
            levels += [values[t] for t in sorted(values)]
            until = times[-1]
            words.append(f"{name} to {format_time(until)}")
    about = f"above {datums[0] if datums else 'an unknown datum'}; {', '.join(words)}"
    return np.array(times), np.array(levels), about
