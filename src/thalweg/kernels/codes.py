"""Status codes of the kernels: the reasons why a leg or an edge cannot be sailed.

Kernels never raise; they return one of these. `REASONS` is the only table from code to text.
"""

from typing import Final

OK: Final = 0
LAND: Final = 1
NO_DATA: Final = 2
OUTSIDE_PERIOD: Final = 3
DEPTH: Final = 4
WAVE_HEIGHT: Final = 5
WIND_SPEED: Final = 6
CURRENT: Final = 7
SHIP_RANGE: Final = 8
NO_GO: Final = 9
ARRIVE_BY: Final = 10
SAFETY: Final = 11
OFFING: Final = 12
STATUS_COUNT: Final = 13

REASONS: Final[dict[int, str]] = {
    LAND: "land",
    NO_DATA: "no data",
    OUTSIDE_PERIOD: "outside the period of the data",
    DEPTH: "under-keel clearance",
    WAVE_HEIGHT: "wave height above the limit",
    WIND_SPEED: "wind speed above the limit",
    CURRENT: "current too strong to hold the course",
    SHIP_RANGE: "weather in which the ship's speed is not known",
    NO_GO: "no-go zone",
    ARRIVE_BY: "arrives too late",
    SAFETY: "safety or comfort limit of the ship",
    OFFING: "nearer to land than the offing",
}

# Channels of frozen sea fields, in the order kernels know them.
CURRENT_EAST: Final = 0
CURRENT_NORTH: Final = 1
WIND_EAST: Final = 2
WIND_NORTH: Final = 3
WAVE_HEIGHT_CHANNEL: Final = 4
WAVE_EAST: Final = 5
WAVE_NORTH: Final = 6
WAVE_PERIOD: Final = 7
WATER_LEVEL: Final = 8
BED_DEPTH: Final = 9
SPEED_FIELD: Final = 10
CHANNEL_COUNT: Final = 11

# Axes of performance tables.
AXIS_WIND_SPEED: Final = 0
AXIS_WIND_ANGLE: Final = 1
AXIS_WAVE_HEIGHT: Final = 2
AXIS_WAVE_ANGLE: Final = 3
AXIS_WAVE_PERIOD: Final = 4
AXIS_DEPTH: Final = 5
AXIS_COUNT: Final = 6

# Entries of the array of limits.
LIMIT_REQUIRED_DEPTH: Final = 0  # draught + under-keel clearance [m]; -inf when not checked
LIMIT_WAVE_HEIGHT: Final = 1  # [m]; +inf when there is none
LIMIT_WIND_SPEED: Final = 2  # [m/s]; +inf when there is none
LIMIT_COUNT: Final = 3
