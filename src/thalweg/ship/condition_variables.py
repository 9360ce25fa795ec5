"""Names of sea variables (CF standard names) and of the conditions a ship model may read."""

from __future__ import annotations

from typing import Final

from thalweg.kernels import codes

EASTWARD_WIND: Final = "eastward_wind"
NORTHWARD_WIND: Final = "northward_wind"
EASTWARD_CURRENT: Final = "eastward_sea_water_velocity"
NORTHWARD_CURRENT: Final = "northward_sea_water_velocity"
WAVE_HEIGHT: Final = "sea_surface_wave_significant_height"
WAVE_EAST: Final = "sea_surface_wave_to_direction_east"
WAVE_NORTH: Final = "sea_surface_wave_to_direction_north"
WAVE_FROM: Final = "sea_surface_wave_from_direction"
WAVE_TO: Final = "sea_surface_wave_to_direction"
WAVE_PERIOD: Final = "sea_surface_wave_period_at_variance_spectral_density_maximum"
WATER_LEVEL: Final = "sea_surface_height_above_geopotential_datum"
BED_DEPTH: Final = "sea_floor_depth_below_geoid"

#: Height, period and direction of the waves
WAVES: Final = frozenset({WAVE_HEIGHT, WAVE_EAST, WAVE_NORTH, WAVE_PERIOD})

#: conditions that are axes of performance tables, with the axis id the kernels know them by
AXIS_OF_CONDITION: Final[dict[str, int]] = {
    "wind_speed": codes.AXIS_WIND_SPEED,
    "wind_angle": codes.AXIS_WIND_ANGLE,
    "wave_height": codes.AXIS_WAVE_HEIGHT,
    "wave_angle": codes.AXIS_WAVE_ANGLE,
    "wave_period": codes.AXIS_WAVE_PERIOD,
    "depth": codes.AXIS_DEPTH,
}
CONDITION_OF_AXIS: Final[dict[int, str]] = {axis: name for name, axis in AXIS_OF_CONDITION.items()}

#: conditions that depend on the ship's heading
HEADING_DEPENDENT: Final = frozenset({"wind_angle", "wave_angle", "heading"})

#: the sea variables each condition is made from (depth may come from a chart instead)
SEA_VARIABLES_OF: Final[dict[str, frozenset[str]]] = {
    "wind_speed": frozenset({EASTWARD_WIND, NORTHWARD_WIND}),
    "wind_angle": frozenset({EASTWARD_WIND, NORTHWARD_WIND}),
    "wave_height": frozenset({WAVE_HEIGHT}),
    "wave_angle": frozenset({WAVE_EAST, WAVE_NORTH, WAVE_HEIGHT}),  # no direction without waves
    "wave_period": frozenset({WAVE_PERIOD}),
    "current_east": frozenset({EASTWARD_CURRENT}),
    "current_north": frozenset({NORTHWARD_CURRENT}),
    "depth": frozenset(),
    "lat": frozenset(),
    "lon": frozenset(),
    "time": frozenset(),
    "heading": frozenset(),
    "load_factor": frozenset(),
}


def needed_variables(conditions: frozenset[str]) -> frozenset[str]:
    """Return the sea variables that the named conditions are made from."""
    return frozenset().union(
        *(SEA_VARIABLES_OF.get(name, frozenset({name})) for name in conditions)
    )
