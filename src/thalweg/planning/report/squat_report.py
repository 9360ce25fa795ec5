"""What a route says about squat where the required clearance does not count it."""

from __future__ import annotations

from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from thalweg.core.geodesy import format_position_minutes
from thalweg.core.time import format_time
from thalweg.core.units import KNOT
from thalweg.kernels.codes import DEPTH, REASONS
from thalweg.route import Route, Violation
from thalweg.ship import Ship
from thalweg.ship.methods.shallow_water.squat import dynamic_under_keel_clearance
from thalweg.ship.models.squat_model import SQUAT_METHODS
from thalweg.ship.performance_sheet_seaway import squat_of_sheet

SQUAT_UNCOUNTED: Final = "The clearance is that at rest"  #: a note on squat begins so
_TOUCHES: Final = 0.05  # clearance with squat that is none [m]
_WITH_SQUAT: Final = f"{REASONS[DEPTH]}: with squat"  # reason of a violation
_ROUNDING: Final = 0.005  # clearances are written to so much [m]


class LeastWaterWithSquat(NamedTuple):
    """The place of a route with the least water under the keel, squat taken off.

    Attributes
    ----------
    clearance, squat : [m]; the clearance is negative where the ship is too deep.
    sample : Its number among the samples of the route.
    """

    clearance: float
    squat: float
    sample: int


def least_water_with_squat(route: Route, ship: Ship) -> LeastWaterWithSquat | None:
    """Return where squat leaves the least water under the keel.

    Squat is that of `thalweg ship --water-depth`, at the speed through water of each sample.

    Returns
    -------
    LeastWaterWithSquat or None : None for ships whose squat limits their speed (``models.squat``),
        for those of which draught or dimensions are not known, and where no depth is known.
    """
    draught = float(ship.draught)
    if ship.file.models.squat != SQUAT_METHODS[0] or not draught > 0.0:
        return None
    depth = np.asarray(route.samples["depth"], float)
    speed = np.asarray(route.samples["speed_through_water"], float)
    known = np.flatnonzero((depth > draught) & np.isfinite(speed))  # aground is stated elsewhere
    model = squat_of_sheet(ship) if len(known) else None
    if model is None:
        return None
    squat = model.sinkage(speed[known], depth[known], ship.loading.load_factor)
    left = dynamic_under_keel_clearance(depth[known], draught, squat=squat)
    worst = int(np.argmin(left))
    return LeastWaterWithSquat(float(left[worst]), float(squat[worst]), int(known[worst]))


def with_squat_violation(route: Route, ship: Ship) -> Route:
    """Return a route that violates a limit where squat puts the ship on the bottom."""
    least = least_water_with_squat(route, ship)
    if least is None or not least.clearance < -_TOUCHES:
        return route
    time, lat, lon = (float(route.samples[name][least.sample]) for name in ("time", "lat", "lon"))
    found = Violation(_WITH_SQUAT, time, lat, lon, least.clearance, 0.0)
    return replace(route, violations=(*route.violations, found))


def keeps_limits_at_rest(route: Route) -> bool:
    """Return whether a route keeps all limits but for squat (`with_squat_violation`)."""
    squat_alone = all(one.reason == _WITH_SQUAT for one in route.violations)
    return squat_alone and bool(np.isfinite(route.arrive))


def squat_notes(route: Route, ship: Ship, min_ukc: float) -> list[str]:
    """Return a note where squat takes the clearance below the required one.

    Parameters
    ----------
    route, ship : As of `least_water_with_squat`.
    min_ukc : Required under the keel at rest [m].

    Returns
    -------
    list of str : A sentence on the place with the least water under the keel, or none.
    """
    least = least_water_with_squat(route, ship)
    if least is None or not least.clearance < min_ukc - _ROUNDING:
        return []
    samples, at = route.samples, least.sample
    place = format_position_minutes(float(samples["lat"][at]), float(samples["lon"][at]))
    when = format_time(float(samples["time"][at]))
    required = f", less than the {min_ukc:g} m required" if min_ukc > 0.0 else ""
    return [
        f"{SQUAT_UNCOUNTED}: with a squat of about {least.squat:.1f} m at "
        f"{float(samples['speed_through_water'][at]) / KNOT:.1f} kn through the water, "
        f"{water_left_text(least.clearance)} at {place}, {when}{required}. "
        "Go slower there, or ask for more clearance (--ukc)."
    ]


def water_left_text(clearance: float) -> str:
    """Return how much water is left under the keel [m], in words."""
    if clearance < -_TOUCHES:
        return f"the ship is {-clearance:.1f} m too deep"
    if clearance < _TOUCHES:
        return "no water is left under the keel: she may touch the bottom"
    return f"{clearance:.1f} m are left under the keel"
