"""Where wind and waves leave a ship little of her speed: the cause of a voyage without a route."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from thalweg.core.geodesy import format_position, inverse
from thalweg.core.types import FloatArray
from thalweg.core.units import KNOT
from thalweg.network import Network
from thalweg.sea import StationFields, standard_names
from thalweg.ship import Conditions
from thalweg.ship.condition_variables import EASTWARD_WIND, NORTHWARD_WIND, WAVE_HEIGHT
from thalweg.ship.tables.performance_table import PerformanceTable

_LEFT: Final = 0.5  # of the speed in calm water; a ship with more is not held by the weather
_DEEP: Final = 1e4  # [m], where the sea has no depth
_CALM: Final = {"wind_speed": 0.0, "wave_height": 0.0}


@dataclass(frozen=True, eq=False)
class SearchedWater:
    """What a search knew of the sea and the ship.

    Attributes
    ----------
    fields : The sea at the stations of its network.
    required : Required water depth [m].
    table : Speed through water of the ship.
    setting : The speed setting, of the search.
    """

    fields: StationFields
    required: float
    table: PerformanceTable
    setting: int


class WeatherStall(NamedTuple):
    """Wind and waves at a place, and the speed that they leave.

    Attributes
    ----------
    lat, lon : [deg].
    speed, calm : Through water, there and in calm water [m/s]; NaN where none is predicted.
    wind : [m/s]; NaN where the ship does not need it.
    height : Of the waves [m]; NaN likewise.
    """

    lat: float
    lon: float
    speed: float
    calm: float
    wind: float
    height: float

    def __str__(self) -> str:
        parts = [f"wind of {self.wind / KNOT:.0f} kn"] if math.isfinite(self.wind) else []
        parts += [f"waves of {self.height:.1f} m"] if math.isfinite(self.height) else []
        place = f"Near {format_position(self.lat, self.lon)}"
        if math.isnan(self.speed):
            return (
                f"{place} the speed loss leaves less than half of {self.calm / KNOT:.1f} kn, in "
                f"{' and '.join(parts)}: it is not made for such weather and gives no speed."
            )
        return (
            f"{place} the ship makes {self.speed / KNOT:.1f} kn "
            f"of {self.calm / KNOT:.1f} kn through the water, in {' and '.join(parts)}."
        )


def weather_stall(
    network: Network, water: SearchedWater, node: int, time: float
) -> WeatherStall | None:
    """Return what the weather leaves of the speed at a node towards the goal.

    Parameters
    ----------
    node : Where the search came nearest to the goal.
    time : When [s since 1970].

    Returns
    -------
    WeatherStall or None : None where it leaves half of the speed or more, or is not known.
    """
    goal = network.meta.goal
    if node < 0 or goal < 0 or node == goal:
        return None
    sampled = _fields_at(water.fields, node, time)
    lat, lon = (np.asarray(values, float) for values in (network.lat, network.lon))
    course = inverse(lat[node], lon[node], lat[goal], lon[goal])[1]
    conditions = Conditions.from_sea(sampled, heading=np.array([float(course)]))
    conditions = Conditions({"depth": _DEEP, **conditions})
    if not water.table.axes <= set(conditions) or not water.table.axes & set(_CALM):
        return None
    calm = conditions.with_values(**{k: v for k, v in _CALM.items() if k in conditions})
    speed, still = (
        float(np.ravel(water.table.lookup(one, water.setting))[0]) for one in (conditions, calm)
    )
    if not (speed < _LEFT * still or (math.isnan(speed) and math.isfinite(still))):
        return None
    wind = math.nan
    if "wind_speed" in water.table.axes and EASTWARD_WIND in sampled:
        wind = float(np.hypot(sampled[EASTWARD_WIND], sampled[NORTHWARD_WIND])[0])
    height = float(sampled[WAVE_HEIGHT][0]) if WAVE_HEIGHT in sampled else math.nan
    return WeatherStall(float(lat[node]), float(lon[node]), speed, still, wind, height)


def _fields_at(fields: StationFields, node: int, time: float) -> dict[str, FloatArray]:
    """Return the sea at a station and a time within the data, by variable."""
    when = min(max(time, float(fields.times[0])), float(fields.times[-1]))
    found = {}
    for channel, column in enumerate(fields.channel_index):
        if column < 0 or channel not in standard_names.CHANNEL_VARIABLES:
            continue
        series = np.asarray(fields.values[node, :, column], float)
        value = float(np.interp(when, fields.times, series))
        found[standard_names.CHANNEL_VARIABLES[channel]] = np.array([value])
    return found
