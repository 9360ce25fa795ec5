"""Tables of routes: one row per waypoint, units in the names of columns."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Final, Protocol

import numpy as np

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.time import format_time, to_datetime64
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR, KNOT, MEGAWATT_HOUR, NAUTICAL_MILE, TONNE
from thalweg.route.indicator_columns import leg_indicators
from thalweg.route.track import Track

if TYPE_CHECKING:
    import pandas as pd


#: Kinds of legs; ``legs["leg_kind"]`` of a route is an index into these names.
LEG_KINDS: Final = ("sea", "canal", "approach")


class SailedRoute(Protocol):
    """The results of a route that tables are made of; see `thalweg.route.Route`."""

    @property
    def track(self) -> Track:
        """The track that was sailed."""

    @property
    def legs(self) -> Mapping[str, FloatArray]:
        """Results per leg."""

    @property
    def samples(self) -> Mapping[str, FloatArray]:
        """Results at the fine samples."""

    @property
    def engine_order(self) -> str:
        """What is held on the legs at sea."""

    @property
    def cost_name(self) -> str:
        """Name of the column of costs."""


def waypoint_rows(route: SailedRoute) -> list[dict[str, Any]]:
    """Return one plain dictionary per waypoint; None where a value is unknown.

    ``time`` is the arrival at the waypoint; a ship leaves it ``waiting_h`` later. Courses, headings
    and conditions are those on leaving (at the last waypoint: on arriving); speeds are means over
    the time of the leg that begins there, ``ukc_m`` the least clearance on it. Distance, fuel,
    energy, CO2 and cost are sums up to the waypoint; those of each leg are in ``route.legs``.
    Indicators (`thalweg.route.indicator_columns.leg_indicators`) are those of the leg that begins.
    ``leg_kind`` is the kind of the leg that begins there: sea, canal or approach (of a port), and
    ``held`` what is constant on it: the power, the speed through water or that over ground.
    """
    columns = waypoint_columns(route)
    times = columns.pop("time")
    given: dict[str, Iterable[Any]] = {
        "lat": columns.pop("lat").tolist(),
        "lon": columns.pop("lon").tolist(),
        "time": (format_time(time) if math.isfinite(time) else None for time in times.tolist()),
    }
    for name, values in columns.items():
        given[name] = [x if math.isfinite(x) else None for x in values.tolist()]
    given |= {"leg_kind": _leg_kind_names(route), "held": _held_names(route)}
    return [dict(zip(given, row)) for row in zip(*given.values())]


def waypoint_frame(route: SailedRoute) -> pd.DataFrame:
    """Return a pandas table with one row per waypoint; see `waypoint_rows`."""
    import pandas as pd

    columns = waypoint_columns(route)
    time = columns.pop("time")
    known = np.isfinite(time)
    stamps = np.where(known, to_datetime64(np.where(known, time, 0.0)), np.datetime64("NaT", "ns"))
    first = {"lat": columns["lat"], "lon": columns["lon"], "time": stamps}
    names = {"leg_kind": _leg_kind_names(route), "held": _held_names(route)}
    return pd.DataFrame(first | columns | names)


def _held_names(route: SailedRoute) -> list[str | None]:
    """Return what is constant on the leg that begins at each waypoint; None at the last one."""
    at_sea = route.engine_order or None
    words = {"constant speed": "constant speed through water"}
    at_sea = words.get(at_sea, at_sea) if at_sea else None
    kinds = _leg_kind_names(route)[:-1]
    return [*(at_sea if kind == "sea" else "constant speed over ground" for kind in kinds), None]


def _leg_kind_names(route: SailedRoute) -> list[str | None]:
    """Return the kind of the leg that begins at each waypoint; None at the last one."""
    count = len(route.legs["length"])
    kinds = route.legs.get("leg_kind", np.zeros(count))
    return [*(LEG_KINDS[int(kind)] for kind in kinds), None]


def waypoint_columns(route: SailedRoute) -> dict[str, FloatArray]:
    """Return the columns of the table of waypoints; ``time`` in seconds since 1970."""
    track, legs, samples = route.track, route.legs, route.samples
    at = _sample_of_waypoint(samples["leg"])
    length, sailing = legs["length"], legs["arrive"] - legs["depart"]
    with np.errstate(invalid="ignore", divide="ignore"):
        over_ground = np.where(sailing > 0.0, length / sailing, math.nan)
    fuel = legs["fuel"] + legs["waiting_fuel"]
    return {
        "lat": track.lat,
        "lon": track.lon,
        "time": np.concatenate([[track.depart], legs["arrive"]]),
        "waiting_h": track.wait / HOUR,
        "distance_nm": cumulative_sums(length) / NAUTICAL_MILE,
        "course_deg": np.degrees(samples["course"][at]),
        "heading_deg": np.degrees(samples["heading"][at]),
        "ordered_speed_kn": np.append(legs["ordered_speed"], math.nan) / KNOT,
        "speed_through_water_kn": np.append(_mean_over_time(route), math.nan) / KNOT,
        "speed_over_ground_kn": np.append(over_ground, math.nan) / KNOT,
        "fuel_t": cumulative_sums(fuel) / TONNE,
        "energy_mwh": cumulative_sums(legs["energy"] + legs["waiting_energy"]) / MEGAWATT_HOUR,
        "co2_t": cumulative_sums(legs["co2"]) / TONNE,
        route.cost_name: cumulative_sums(legs["cost"]),
        **_conditions(route, at),
        "ukc_m": np.append(legs["under_keel_clearance"], math.nan),
        **{name: np.append(values, math.nan) for name, values in leg_indicators(legs).items()},
    }


def _sample_of_waypoint(leg: FloatArray) -> np.ndarray:
    """Return the first sample of every leg and the last sample of all."""
    first = np.flatnonzero(np.concatenate([[True], leg[1:] != leg[:-1]]))
    return np.append(first, len(leg) - 1)


def _mean_over_time(route: SailedRoute) -> FloatArray:
    """Return the mean speed through water of every leg, weighted by time [m/s]."""
    samples, count = route.samples, len(route.legs["length"])
    time, leg, speed = samples["time"], samples["leg"], samples["speed_through_water"]
    same = leg[1:] == leg[:-1]
    span = np.where(same, np.diff(time), 0.0)
    sailed = np.where(same, 0.5 * (speed[1:] + speed[:-1]) * span, 0.0)
    which = leg[:-1].astype(np.int64)
    total = np.bincount(which, weights=span, minlength=count)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.bincount(which, weights=sailed, minlength=count) / total


def _conditions(route: SailedRoute, at: np.ndarray) -> dict[str, FloatArray]:
    samples = {name: values[at] for name, values in route.samples.items()}
    found: dict[str, FloatArray] = {}
    for name, east, north, origin in (
        ("current", "eastward_sea_water_velocity", "northward_sea_water_velocity", False),
        ("wind", "eastward_wind", "northward_wind", True),
    ):
        if east in samples and north in samples:
            u, v = samples[east], samples[north]
            found[f"{name}_speed_kn"] = np.hypot(u, v) / KNOT
            sense = "from" if origin else "towards"
            found[f"{name}_{sense}_deg"] = (
                vector_direction(-u, -v) if origin else vector_direction(u, v)
            )
    height, period = "sea_surface_wave_significant_height", "sea_surface_wave_period"
    for name, values in samples.items():
        if name == height:
            found["wave_height_m"] = values
        elif name.startswith(period):
            found["wave_period_s"] = values
    found["depth_m"] = samples["depth"]
    return found


def vector_direction(east: FloatArray, north: FloatArray) -> FloatArray:
    """Return the directions in which vectors point.

    Parameters
    ----------
    east, north : ndarray
        Components of one shape, in one unit.

    Returns
    -------
    ndarray : Clockwise from north [deg], 0 to 360; NaN for a vector of no length.
    """
    still = (east == 0.0) & (north == 0.0)
    return np.where(still, math.nan, np.degrees(np.arctan2(east, north)) % 360.0)
