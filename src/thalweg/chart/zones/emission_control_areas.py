"""The emission control areas of MARPOL Annex VI, with their dates and the sources of their limits.

The file ``data/eca.geojson`` holds the published points where the regulation lists points,
parallels and meridians where it describes them, and own lines over land to close the outlines.
"""

from __future__ import annotations

import json
import math
import warnings
from collections.abc import Iterable
from dataclasses import dataclass
from datetime import date as Date
from datetime import datetime
from functools import cache
from importlib import resources
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.chart.rings import Rings
from thalweg.core.errors import InputError, ThalwegWarning, unknown_name_error
from thalweg.core.geodesy import densify
from thalweg.core.time import TimeLike, parse_time

_POSITIONS_AT_A_TIME: Final = 256  # tested against the edges near their latitudes

DATA_DATE: Final = "2026-11-21"  #: date on which the dates of the areas were checked
MAX_EDGE_LENGTH: Final = (
    10_000.0  # edges that are geodesics are split into pieces no longer than this [m]
)


@dataclass(frozen=True)
class EmissionControlArea:
    """An emission control area of MARPOL Annex VI.

    Attributes
    ----------
    name : Short name, such as ``"north-sea"``.
    title : Its full name.
    adopted, in_force, sulphur_from : ISO dates: when it was adopted, when the amendment came into
        force, and from when its limit on sulphur (and so the higher fuel price) applies.
    source : The regulation or resolution.
    limits : {"points", "text", "unknown"}
        ``points``: the published list of points; ``text``: parallels, meridians and capes named
        in the regulation; ``unknown``: none are published, so this area can only be used
        with an outline given by the user. Lines over land are not part of the regulation.
    note : Sources of the limits, as text.
    """

    name: str
    title: str
    adopted: str
    in_force: str
    sulphur_from: str
    source: str
    limits: str
    note: str

    def sulphur_limit_applies_on(self, date: str) -> bool:
        """Return whether its limit on sulphur counts on an ISO date."""
        return self.sulphur_from <= date

    @property
    def rings(self) -> Rings:
        """The outline [deg]; edges straight in longitude and latitude.

        Geodesics of the regulation are split into pieces of at most 10 km, at most 4 m from the
        geodesic.

        Raises
        ------
        InputError : If the limits are unknown.
        """
        return _outline(self.name)


@dataclass(frozen=True)
class EcaZone:
    """One emission control area on a chart: its name and its rings (holes included)."""

    name: str
    rings: Rings

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, EcaZone):
            return NotImplemented
        return self.name == other.name and self.rings.fingerprint() == other.rings.fingerprint()

    __hash__ = None  # type: ignore[assignment]

    def contains(self, lat: ArrayLike, lon: ArrayLike) -> NDArray[np.bool_]:
        """Return which positions [deg] lie inside; by counting edges east of them.

        Edges are straight in longitude and latitude. For many positions in many areas at once
        the chart's index is quicker (`Zones.in_eca`).
        """
        a, b = np.broadcast_arrays(np.asarray(lat, float), np.asarray(lon, float))
        y, x = a.ravel(), b.ravel()
        rings = self.rings
        keep = np.ones(len(rings.lat) - 1, bool)
        keep[rings.start[1:-1] - 1] = False
        y0, y1 = rings.lat[:-1][keep], rings.lat[1:][keep]
        x0, x1 = rings.lon[:-1][keep], rings.lon[1:][keep]
        low, high = np.minimum(y0, y1), np.maximum(y0, y1)
        inside = np.zeros(len(y), bool)
        for turn in (-360.0, 0.0, 360.0):
            k = np.flatnonzero(
                (y >= y0.min(initial=90.0))
                & (y <= y1.max(initial=-90.0))
                & (x + turn >= x0.min(initial=720.0))
                & (x + turn <= x0.max(initial=-720.0))
            )
            k = k[np.argsort(y[k])]  # positions of similar latitude meet few edges
            for part in np.array_split(k, len(k) // _POSITIONS_AT_A_TIME + 1):
                if not len(part):
                    continue
                yy, xx = y[part, None], x[part, None] + turn
                near = np.flatnonzero((low <= yy[-1]) & (high > yy[0]))
                a0, a1, o0, o1 = y0[near], y1[near], x0[near], x1[near]
                with np.errstate(divide="ignore", invalid="ignore"):
                    cross = o0 + (yy - a0) / (a1 - a0) * (o1 - o0) > xx
                inside[part] |= (((a0 <= yy) != (a1 <= yy)) & cross).sum(axis=1) % 2 == 1
        return inside.reshape(a.shape)


@cache
def _features() -> dict[str, dict[str, Any]]:
    text = resources.files("thalweg.chart").joinpath("data", "eca.geojson").read_text("utf-8")
    return {f["properties"]["name"]: f for f in json.loads(text)["features"]}


@cache
def emission_control_areas() -> tuple[EmissionControlArea, ...]:
    """Return all emission control areas, those still to come and those without limits included.

    Returns
    -------
    tuple of EmissionControlArea
        With names, dates and outlines.
    """
    fields = EmissionControlArea.__dataclass_fields__
    return tuple(
        EmissionControlArea(**{name: f["properties"][name] for name in fields})
        for f in _features().values()
    )


@cache
def _outline(name: str) -> Rings:
    feature = _features()[name]
    if feature["geometry"] is None:
        raise InputError(
            f"The limits of the emission control area {name!r} are not in this package.",
            feature["properties"]["note"],
            "Give its outline as GeoJSON with the kind 'eca' (Chart.with_zones).",
            value=name,
        )
    lon, lat = np.array(feature["geometry"]["coordinates"][0]).T
    if feature["properties"]["lines"] == "geodesic":
        lat, lon, _ = densify(lat, lon, MAX_EDGE_LENGTH)
    return Rings.from_lists([(list(zip(lat, lon)), False)])


def select_emission_control_areas(
    names: str | Iterable[str] | None = None, *, date: TimeLike | None = None
) -> list[EmissionControlArea]:
    """Return the areas with given names, or all whose sulphur limit applies on a date.

    Parameters
    ----------
    names : By default all that count at ``date``; "north-america" means its three parts.
    date : By default `DATA_DATE`. Given with names, those must count then.

    Raises
    ------
    InputError : If the area is unknown, its limits are unknown, or it is not yet in force.

    Warns
    -----
    ThalwegWarning : If an area counts on the date but its limits are unknown, or the date is later
        than what was looked up.
    """
    day = DATA_DATE if date is None else _iso_date(date)
    known = {area.name: area for area in emission_control_areas()}
    if names is not None:
        found = [area for name in _full_area_names(names, known) for area in [known[name]]]
        for area in found:
            _outline(area.name)  # refuses those without limits
            if date is not None and not area.sulphur_limit_applies_on(day):
                raise InputError(
                    f"The emission control area {area.name!r} does not count on {day}.",
                    f"Its limit on sulphur counts from {area.sulphur_from}.",
                    "Leave the date out, or the name.",
                    value=area.name,
                )
        return found
    counting = [area for area in known.values() if area.sulphur_limit_applies_on(day)]
    without = [area.name for area in counting if area.limits == "unknown"]
    if without:
        message = f"On {day} {', '.join(without)} count, too, but their limits are unknown here."
        warnings.warn(ThalwegWarning(message), stacklevel=3)
    return [area for area in counting if area.limits != "unknown"]


def _full_area_names(
    names: str | Iterable[str], known: dict[str, EmissionControlArea]
) -> list[str]:
    """Return full names, each once; a shortened one means all that begin with it."""
    found: list[str] = []
    for written in [names] if isinstance(names, str) else list(names):
        plain = str(written).strip().casefold().replace(" ", "-").replace("_", "-")
        fits = [plain] if plain in known else [n for n in known if n.startswith(plain + "-")]
        if not fits:
            raise unknown_name_error("emission control area", str(written), known)
        found += [name for name in fits if name not in found]
    return found


def _iso_date(date: TimeLike) -> str:
    """Return an ISO date (UTC)."""
    if isinstance(date, Date) and not isinstance(date, datetime):
        return date.isoformat()
    seconds = parse_time(date)
    days = np.datetime64(0, "D") + np.timedelta64(math.floor(seconds / 86400.0), "D")
    return str(days)
