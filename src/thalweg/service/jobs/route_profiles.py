"""Routes along time, for charts in the browser."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from thalweg.core.time import format_time
from thalweg.core.types import FloatArray
from thalweg.core.units import KNOT, NAUTICAL_MILE
from thalweg.route.route_tables import vector_direction
from thalweg.sea import standard_names as nm

if TYPE_CHECKING:
    from thalweg.route import Route

MOST_POINTS: Final = 600  #: points of a profile
_COMFORT: Final = "weighted_acceleration:"  # and the name of a place
#: Columns of a profile: source in the samples of a route, factor, decimals.
_COLUMNS: Final[Mapping[str, tuple[str, float, int]]] = {
    "lat": ("lat", 1.0, 5),
    "lon": ("lon", 1.0, 5),
    "distance_nm": ("distance", 1.0 / NAUTICAL_MILE, 2),
    "course_deg": ("course", 180.0 / math.pi, 1),
    "speed_over_ground_kn": ("speed_over_ground", 1.0 / KNOT, 2),
    "speed_through_water_kn": ("speed_through_water", 1.0 / KNOT, 2),
    "depth_m": ("depth", 1.0, 1),
    "under_keel_clearance_m": ("under_keel_clearance", 1.0, 2),
    "power_kw": ("power", 1e-3, 0),
    "fuel_t_per_day": ("fuel_rate", 86.4, 2),
    "wave_height_m": (nm.WAVE_HEIGHT, 1.0, 2),
    "wave_period_s": (nm.WAVE_PERIOD, 1.0, 1),
    "ice_fraction": (nm.ICE, 1.0, 2),
}


def route_profile(route: Route) -> dict[str, Any]:
    """Return a route along time, thinned to at most `MOST_POINTS` points.

    Returns
    -------
    dict
        ``time`` [s since 1970], with begin and end of each wait under way, and columns of equal
        length whose names end with their unit; None where a value is unknown, and for the direction
        of a wind or current of no speed. Columns without any known value are left out.
    """
    samples, still = _with_waits(route)
    time = np.asarray(samples["time"], float)
    take = np.union1d(_thinned(time), still)
    columns: dict[str, Any] = {"time": [round(float(t), 1) for t in time[take]]}
    for name, (source, factor, decimals) in _COLUMNS.items():
        if source in samples:
            _add(columns, name, np.asarray(samples[source], float)[take] * factor, decimals)
    for name, pair in (("wind", nm.WIND.pair), ("current", nm.CURRENT.pair)):
        if all(part in samples for part in pair):
            east, north = (np.asarray(samples[part], float)[take] for part in pair)
            _add(columns, f"{name}_speed_kn", np.hypot(east, north) / KNOT, 2)
            if name == "wind":
                _add(columns, "wind_from_deg", vector_direction(-east, -north), 0)
            else:
                _add(columns, "current_to_deg", vector_direction(east, north), 0)
    if all(part in samples for part in nm.WAVES.pair):
        east, north = (np.asarray(samples[part], float)[take] for part in nm.WAVES.pair)
        _add(columns, "waves_from_deg", vector_direction(-east, -north), 0)
    motion = next((name for name in samples if name.startswith(_COMFORT)), None)
    if motion is not None:  # of the first place of the ship file
        felt = np.asarray(samples[motion], float)[take]
        if nm.WAVE_HEIGHT in samples:  # sheltered legs count as calm, but their waves are unknown
            felt = np.where(np.isfinite(samples[nm.WAVE_HEIGHT][take]), felt, np.nan)
        _add(columns, "weighted_acceleration_m_s2", felt, 3)
    return columns


def _with_waits(route: Route) -> tuple[dict[str, FloatArray], NDArray[np.int64]]:
    """Return the samples with those of waits under way, and the indices of begin and end of each.

    A wait at the first waypoint is left out, as there the ship is not under way yet.
    """
    samples = route.samples_with_waits()
    waits = np.asarray(route.wait_samples.get("leg", ()), np.int64)
    first = int(np.count_nonzero(waits == 0))
    samples = {name: np.asarray(values, float)[first:] for name, values in samples.items()}
    legs, count = np.unique(waits[waits > 0], return_counts=True)
    begin = np.searchsorted(samples["leg"], legs)  # the samples of a wait come before its leg
    return samples, np.concatenate([begin, begin + count - 1]).astype(np.int64)


def _thinned(time: FloatArray) -> Any:
    known = np.flatnonzero(np.isfinite(time))
    if len(known) <= MOST_POINTS:
        return known
    return known[np.unique(np.linspace(0, len(known) - 1, MOST_POINTS).round().astype(int))]


def _add(columns: dict[str, Any], name: str, values: FloatArray, decimals: int) -> None:
    if np.isfinite(values).any():
        columns[name] = [round(float(v), decimals) if math.isfinite(v) else None for v in values]


def first_look(route: Route) -> dict[str, Any]:
    """Return a route with few points and its totals, to be shown while planning goes on."""
    samples = route.samples
    take = _thinned(np.asarray(samples["time"], float))[::4]
    points = np.column_stack([samples["lon"], samples["lat"]])[take]
    return {
        "points": np.round(points, 4).tolist(),
        "depart": format_time(route.depart),
        "arrive": format_time(route.arrive),
        "time_h": route.time_h,
        "distance_nm": route.distance_nm,
        "fuel_t": route.fuel_t,
        "cost": route.cost,
        "currency": route.currency,
    }
