"""What a route says about squat where the required clearance does not count it."""

from __future__ import annotations

from typing import Final

import numpy as np

from thalweg.core.geodesy import format_position_minutes
from thalweg.core.time import format_time
from thalweg.core.units import KNOT
from thalweg.route import Route
from thalweg.ship import Ship
from thalweg.ship.methods.shallow_water.squat import dynamic_under_keel_clearance
from thalweg.ship.models.squat_model import SQUAT_METHODS
from thalweg.ship.performance_sheet_seaway import squat_of_sheet

SQUAT_UNCOUNTED: Final = "The clearance is that at rest"  #: a note on squat begins so
_TOUCHES: Final = 0.05  # clearance with squat that is none [m]
_ROUNDING: Final = 0.005  # clearances are written to so much [m]


def squat_notes(route: Route, ship: Ship, min_ukc: float) -> list[str]:
    """Return a note where squat takes the clearance below the required one.

    Squat is that of `thalweg ship --water-depth`, at the speed through water of each sample.

    Parameters
    ----------
    route : The evaluated route.
    ship : Without a note are ships whose squat limits their speed (``models.squat``), and those of
        which draught or dimensions are not known.
    min_ukc : Required under the keel at rest [m].

    Returns
    -------
    list of str : A sentence on the place with the least water under the keel, or none.
    """
    draught = float(ship.draught)
    if ship.file.models.squat != SQUAT_METHODS[0] or not draught > 0.0:
        return []
    depth = np.asarray(route.samples["depth"], float)
    speed = np.asarray(route.samples["speed_through_water"], float)
    known = np.flatnonzero(np.isfinite(depth) & np.isfinite(speed))
    model = squat_of_sheet(ship) if len(known) else None
    if model is None:
        return []
    squat = model.sinkage(speed[known], depth[known], ship.loading.load_factor)
    left = dynamic_under_keel_clearance(depth[known], draught, squat=squat)
    worst = int(np.argmin(left))
    if not left[worst] < min_ukc - _ROUNDING:
        return []
    at = known[worst]
    place = format_position_minutes(
        float(route.samples["lat"][at]), float(route.samples["lon"][at])
    )
    when = format_time(float(route.samples["time"][at]))
    metres = f"{left[worst]:.1f} m are left under the keel"
    if left[worst] < _TOUCHES:
        metres = "no water is left under the keel: she may touch the bottom"
    if left[worst] < -_TOUCHES:
        metres = f"the ship is {-left[worst]:.1f} m too deep"
    required = f", less than the {min_ukc:g} m required" if min_ukc > 0.0 else ""
    return [
        f"{SQUAT_UNCOUNTED}: with a squat of about {squat[worst]:.1f} m at "
        f"{speed[at] / KNOT:.1f} kn through the water, {metres} at {place}, {when}{required}. "
        "Go slower there, or ask for more clearance (--ukc)."
    ]
