"""Key performance indicators of a route from the columns of its legs and samples.

Columns of legs, per place NAME of the ship file, in SI and NaN where unknown:
``squared_dose:NAME`` [m2/s3] (of sailing the leg and of waiting before it), the greatest root mean
squares ``weighted_acceleration:NAME``, ``acceleration:NAME`` [m/s2], ``velocity:NAME`` [m/s] and
``displacement:NAME`` [m]; ``heave`` [m], ``pitch`` and ``roll`` [rad] (greatest root mean squares);
``workable_time:TASK`` [s]; ``inshore_length`` [m] and ``inshore_time`` [s] (land nearer than
`INSHORE_DISTANCE`); ``land_distance`` [m] (least, at most `LAND_DISTANCE_CAP`) and
``contour_distance`` [m] (least, from charted water shallower than draught and under-keel clearance,
at most 5 nautical miles); ``near_ground_time`` [s] (land or such water nearer than
`GROUNDING_MARGIN`); ``shallow_time`` [s] (water less than twice as deep as the draught);
``encounters`` (expected, with other ships) and ``dense_traffic_time`` [s] (inside traffic zones).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Final, Protocol

import numpy as np

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.errors import unknown_name_error
from thalweg.core.given_numbers import finite_or_none
from thalweg.core.types import FloatArray
from thalweg.core.units import GRAVITY, HOUR, NAUTICAL_MILE

INSHORE_DISTANCE: Final = 3.0 * NAUTICAL_MILE  #: nearer to land than this is inshore [m]
LAND_DISTANCE_CAP: Final = 12.0 * NAUTICAL_MILE  #: larger distances to land count as this [m]
GROUNDING_MARGIN: Final = 1.0 * NAUTICAL_MILE  #: nearer to the ground than this is close [m]
#: Per cent of people sick per dose (ISO 2631-1, annex D: mixed adults not used to the sea).
PERCENT_PER_DOSE: Final = 1.0 / 3.0
#: Root mean square of vertical acceleration for passengers in transit [m/s2]: 0.05 g (Nordforsk
#: 1987; from the secondary literature, not seen in print).
PASSENGER_ACCELERATION: Final = 0.05 * GRAVITY

#: Indicators of a route: unit, and whether they add up over legs.
INDICATORS: Final[dict[str, tuple[str, bool]]] = {
    "time": ("h", True),
    "distance": ("nm", True),
    "fuel": ("t", True),
    "energy": ("MWh", True),
    "co2": ("t", True),
    "cost": ("", True),
    "comfort": ("m2/s3", True),
    "sick_percent": ("%", False),
    "worst_hour_percent": ("%", False),
    "max_acceleration": ("m/s2", False),
    "uncomfortable_percent": ("%", False),
    "inshore_nm": ("nm", True),
    "inshore_percent": ("%", False),
    "land_distance_nm": ("nm", False),
    "inshore_h": ("h", True),
    "contour_distance_nm": ("nm", False),
    "near_ground_h": ("h", True),
    "shallow_h": ("h", True),
    "min_ukc": ("m", False),
    "encounters": ("", True),
    "dense_traffic_h": ("h", True),
    "workable_percent": ("%", False),
}
#: Indicators in words, where the name does not say enough.
INDICATOR_WORDS: Final[dict[str, str]] = {
    "comfort": "dose of vertical motion",
    "sick_percent": "people sick at the end",
    "worst_hour_percent": "people sick, worst hour",
    "max_acceleration": "greatest acceleration",
    "uncomfortable_percent": "time above 0.05 g",
    "inshore_nm": "length within 3 nm of land",
    "inshore_percent": "share within 3 nm of land",
    "land_distance_nm": "least distance from land at sea",
    "inshore_h": "time within 3 nm of land",
    "contour_distance_nm": "least distance from shoals",
    "near_ground_h": "time within 1 nm of the ground",
    "shallow_h": "time in shallow water",
    "min_ukc": "least under-keel clearance",
    "encounters": "encounters with other ships",
    "dense_traffic_h": "time in dense traffic",
    "workable_percent": "time in which people can work",
}
#: Indicators of surroundings: column of the legs, and what one unit of the indicator is in SI.
_WATER_COLUMNS: Final = {
    "inshore_nm": ("inshore_length", NAUTICAL_MILE),
    "inshore_percent": ("inshore_length", 0.01),
    "inshore_h": ("inshore_time", HOUR),
    "land_distance_nm": ("land_distance", NAUTICAL_MILE),
    "contour_distance_nm": ("contour_distance", NAUTICAL_MILE),
    "near_ground_h": ("near_ground_time", HOUR),
    "shallow_h": ("shallow_time", HOUR),
    "encounters": ("encounters", 1.0),
    "dense_traffic_h": ("dense_traffic_time", HOUR),
}
#: Columns of tables: name with unit, and what one unit is in SI.
_TABLE_COLUMNS: Final = {
    "squared_dose": ("squared_dose_m2_s3", 1.0),
    "weighted_acceleration": ("weighted_acceleration_m_s2", 1.0),
    "acceleration": ("acceleration_m_s2", 1.0),
    "velocity": ("velocity_m_s", 1.0),
    "displacement": ("displacement_m", 1.0),
    "heave": ("heave_m", 1.0),
    "pitch": ("pitch_deg", math.radians(1.0)),
    "roll": ("roll_deg", math.radians(1.0)),
    "workable_time": ("workable_h", HOUR),
    **{
        column: (name, unit)
        for name, (column, unit) in _WATER_COLUMNS.items()
        if name != "inshore_percent"
    },
}
#: Columns of legs (before ":") that hold the greatest or least value on them, not a sum.
GREATEST_ON_LEGS: Final = (
    "weighted_acceleration", "acceleration", "velocity", "displacement", "heave", "pitch", "roll"
)  # fmt: skip
LEAST_ON_LEGS: Final = ("land_distance", "contour_distance")
_LEAST: Final = ("land_distance_nm", "contour_distance_nm")
_ATTRIBUTES: Final = {
    "time": "time_h",
    "distance": "distance_nm",
    "fuel": "fuel_t",
    "energy": "energy_mwh",
    "co2": "co2_t",
    "cost": "cost",
    "min_ukc": "min_ukc_m",
}


class RefereedRoute(Protocol):
    """What indicators are computed from; see `thalweg.route.Route`."""

    @property
    def legs(self) -> Mapping[str, FloatArray]:
        """Results per leg."""

    @property
    def samples(self) -> Mapping[str, FloatArray]:
        """Results at the fine samples."""

    @property
    def time_h(self) -> float:
        """Time from departure to arrival [h]."""


def named_columns(legs: Mapping[str, Any], kind: str) -> dict[str, Any]:
    """Return the columns ``kind:NAME`` by name.

    Parameters
    ----------
    kind : Such as ``squared_dose``.
    """
    return {
        key.partition(":")[2]: values for key, values in legs.items() if key.startswith(kind + ":")
    }


def indicator_value(route: RefereedRoute, name: str, at: str | None = None) -> float:
    """Return one indicator of a route; NaN where it is not known.

    Parameters
    ----------
    route : Scored by the referee.
    name : Among `INDICATORS`; ``comfort`` is the squared dose [m2/s3].
    at : Place or task, for those that have one; by default the first of the ship file.

    Returns
    -------
    float : In the unit of `INDICATORS`.

    Raises
    ------
    InputError : If there is no such indicator, place or task.
    """
    if name not in INDICATORS:
        raise unknown_name_error("indicator", name, INDICATORS)
    if name in _ATTRIBUTES:
        value = getattr(route, _ATTRIBUTES[name])
        return math.nan if value is None else float(value)
    if name in _WATER_COLUMNS:
        return _water_indicator(route, name)
    if name == "workable_percent":
        times = named_columns(route.legs, "workable_time")
        task = _chosen("task", at, times)
        return math.nan if task is None else 100.0 * _total(times[task]) / _time_in_legs(route)
    doses = named_columns(route.legs, "squared_dose")
    place = _chosen("place", at, doses)
    if place is None:
        return math.nan
    return _place_indicator(route, name, place, _total(doses[place]))


def _place_indicator(route: RefereedRoute, name: str, place: str, squared: float) -> float:
    if name == "comfort":
        return squared
    if name == "sick_percent":
        return min(PERCENT_PER_DOSE * math.sqrt(squared), 100.0) if squared >= 0 else math.nan
    if name == "max_acceleration":
        return _largest(route.legs[f"acceleration:{place}"])
    weighted = route.samples.get(f"weighted_acceleration:{place}")
    time, leg = route.samples["time"], route.samples["leg"]
    if weighted is None or not np.isfinite(weighted[np.isfinite(time)]).all():
        return math.nan
    if name == "worst_hour_percent":
        return PERCENT_PER_DOSE * math.sqrt(_greatest_in_an_hour(weighted**2, time))
    return _share_of_time(route, place, leg, time)


def _share_of_time(route: RefereedRoute, place: str, leg: FloatArray, time: FloatArray) -> float:
    rough = route.samples.get(f"acceleration:{place}")
    if rough is None:
        return math.nan
    step = np.where(np.diff(leg) == 0, np.diff(time), 0.0)
    step = np.where(np.isfinite(step), step, 0.0)
    above = (rough > PASSENGER_ACCELERATION).astype(float)
    total = float(step.sum())
    return 100.0 * float((step * 0.5 * (above[1:] + above[:-1])).sum()) / total if total else 0.0


def _greatest_in_an_hour(rate: FloatArray, time: FloatArray) -> float:
    """Return the greatest integral of a rate over an hour (over all, where that is less)."""
    known = np.isfinite(time)
    t, r = time[known], rate[known]
    total = cumulative_sums(0.5 * (r[1:] + r[:-1]) * np.diff(t))
    starts = np.concatenate([t, t - HOUR])
    starts = np.clip(starts, t[0], max(t[-1] - HOUR, t[0]))
    ends = np.minimum(starts + HOUR, t[-1])
    return float(np.max(np.interp(ends, t, total) - np.interp(starts, t, total)))


def _water_indicator(route: RefereedRoute, name: str) -> float:
    column, unit = _WATER_COLUMNS[name]
    if column not in route.legs:
        return math.nan
    values = route.legs[column]
    if name in _LEAST:
        return float(np.min(_at_sea(route, values))) / unit
    whole = float(route.legs["length"].sum()) if name == "inshore_percent" else 1.0
    return _total(values) / (unit * whole)


def _at_sea(route: RefereedRoute, values: FloatArray) -> FloatArray:
    """Return the values of the legs outside canals and approaches; of all legs without such."""
    at_sea = np.asarray(route.legs.get("leg_kind", np.zeros(len(values)))) == 0
    return values[at_sea] if at_sea.any() else values


def _chosen(kind: str, at: str | None, known: Mapping[str, Any]) -> str | None:
    if at is None or not known:
        return next(iter(known), None)
    if at not in known:
        raise unknown_name_error(kind, at, known)
    return at


def _total(values: FloatArray) -> float:
    return math.fsum(values.tolist()) if np.isfinite(values).all() else math.nan


def _largest(values: FloatArray) -> float:
    return float(np.max(values))


def _time_in_legs(route: RefereedRoute) -> float:
    return float((route.legs["arrive"] - route.legs["depart"]).sum())


def indicator_table(route: RefereedRoute) -> dict[str, Any]:
    """Return all indicators of motions, land and depth as plain data, for JSON.

    Parameters
    ----------
    route : Scored by the referee.

    Returns
    -------
    dict : ``places`` and ``tasks`` by name; None where a value is not known.
    """

    def plain(name: str, at: str | None = None) -> float | None:
        return finite_or_none(indicator_value(route, name, at))

    legs = route.legs
    places = {}
    for name, doses in named_columns(legs, "squared_dose").items():
        row = {"dose_m_s1_5": finite_or_none(math.sqrt(_total(doses)))}
        row |= {
            key: plain(key, name)
            for key in ("sick_percent", "worst_hour_percent", "uncomfortable_percent")
        }
        for key, unit in (
            ("weighted_acceleration", "m_s2"),
            ("acceleration", "m_s2"),
            ("velocity", "m_s"),
            ("displacement", "m"),
        ):
            row[f"max_{key}_rms_{unit}"] = finite_or_none(_largest(legs[f"{key}:{name}"]))
        places[name] = row
    tasks = {
        name: {"workable_percent": plain("workable_percent", name)}
        for name in named_columns(legs, "workable_time")
    }
    ship = {}
    if "heave" in legs:
        largest = {
            "max_heave_rms_m": _largest(legs["heave"]),
            "max_pitch_rms_deg": math.degrees(_largest(legs["pitch"])),
            "max_roll_rms_deg": math.degrees(_largest(legs["roll"])),
        }
        ship = {name: finite_or_none(value) for name, value in largest.items()}
    around = {name: plain(name) for name in _WATER_COLUMNS}
    fuel = {"fuel_t_per_nm": _per_mile(route)}
    return {**around, **fuel, **ship, "places": places, "tasks": tasks}


def _per_mile(route: RefereedRoute) -> float | None:
    fuel, length = indicator_value(route, "fuel"), indicator_value(route, "distance")
    return fuel / length if math.isfinite(fuel) and length > 0.0 else None


def leg_indicators(legs: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
    """Return the indicators of every leg as columns of tables, with units in their names.

    Parameters
    ----------
    legs : mapping of str to array (legs,)
        Columns in SI.

    Returns
    -------
    dict of str to float64 array (legs,)
        Sums and greatest or least values of the leg alone (with the wait before it); NaN unknown.
    """
    found: dict[str, FloatArray] = {}
    for key, values in legs.items():
        kind, _, name = key.partition(":")
        if kind in _TABLE_COLUMNS:
            column, unit = _TABLE_COLUMNS[kind]
            found[f"{column}:{name}" if name else column] = np.asarray(values) / unit
    return found
