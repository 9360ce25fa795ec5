"""Wind of which only the speed is known, for ships that need only its speed."""

from __future__ import annotations

import numpy as np

from thalweg.core.types import FloatArray
from thalweg.sea import Sea
from thalweg.ship import Ship
from thalweg.ship.condition_variables import EASTWARD_WIND, NORTHWARD_WIND

WIND_SPEED_NAME = "wind_speed"
#: The assumption that a sea then states.
WIND_ASSUMPTION = (
    "wind: only its speed is known, and only its speed is used; taken as from the west"
)


def with_wind_speed(ship: Ship, sea: Sea) -> Sea:
    """Return the sea with a wind vector, where a plain wind speed is enough for the ship.

    Parameters
    ----------
    ship : Ship
    sea : Sea
        If it has ``wind_speed`` without a direction, and the ship needs wind but no angle of it,
        the wind blows from the west at that speed; otherwise it is returned unchanged.

    Returns
    -------
    Sea
        Its ``assumptions`` state the direction where it was assumed.
    """
    wind = {EASTWARD_WIND, NORTHWARD_WIND}
    needed = bool(wind & set(ship.needs)) and "wind_angle" not in ship.reads
    if not needed or wind & sea.variables or WIND_SPEED_NAME not in sea.variables:
        return sea

    def eastward(time: FloatArray, lat: FloatArray, lon: FloatArray) -> FloatArray:
        return np.asarray(sea.sample([WIND_SPEED_NAME], time, lat, lon)[WIND_SPEED_NAME])

    def northward(time: FloatArray, lat: FloatArray, lon: FloatArray) -> FloatArray:
        return 0.0 * eastward(time, lat, lon)

    directed = Sea.from_functions({EASTWARD_WIND: eastward, NORTHWARD_WIND: northward})
    both = Sea.layered(sea, directed)
    return Sea(both.layers, (*both.assumptions, WIND_ASSUMPTION))
