"""Canonical names of the variables of the sea (CF standard names), and their relations.

Every horizontal vector is stored as two components (east, north) in the direction *towards* which
it points, and the direction of waves as a unit vector towards which they travel. Speeds and
directions in degrees are derived from these, so that a direction is never interpolated as a number.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

from thalweg.kernels import codes

EASTWARD_WIND: Final = "eastward_wind"
NORTHWARD_WIND: Final = "northward_wind"
EASTWARD_CURRENT: Final = "eastward_sea_water_velocity"
NORTHWARD_CURRENT: Final = "northward_sea_water_velocity"
WAVE_HEIGHT: Final = "sea_surface_wave_significant_height"
WAVE_PERIOD: Final = "sea_surface_wave_period_at_variance_spectral_density_maximum"
WAVE_TO_EAST: Final = "sea_surface_wave_to_direction_east"
WAVE_TO_NORTH: Final = "sea_surface_wave_to_direction_north"
WATER_LEVEL: Final = "sea_surface_height_above_geopotential_datum"
BED_DEPTH: Final = "sea_floor_depth_below_geoid"
TOTAL_DEPTH: Final = "sea_floor_depth_below_sea_surface"
PRESSURE: Final = "air_pressure_at_mean_sea_level"
ICE: Final = "sea_ice_area_fraction"


@dataclass(frozen=True)
class VectorNames:
    """Names of a horizontal vector: components, speed and directions.

    Attributes
    ----------
    east, north : Canonical names of the components, pointing towards.
    speed : CF name of its magnitude; empty for a unit vector.
    towards, origin : str
        CF names of its direction [deg] given as towards and as from; empty if CF has none.
    """

    east: str
    north: str
    speed: str
    towards: str
    origin: str

    @property
    def pair(self) -> tuple[str, str]:
        """Both component names."""
        return self.east, self.north


WIND: Final = VectorNames(
    EASTWARD_WIND, NORTHWARD_WIND, "wind_speed", "wind_to_direction", "wind_from_direction"
)
CURRENT: Final = VectorNames(
    EASTWARD_CURRENT,
    NORTHWARD_CURRENT,
    "sea_water_speed",
    "sea_water_velocity_to_direction",
    "sea_water_velocity_from_direction",
)
WAVES: Final = VectorNames(
    WAVE_TO_EAST,
    WAVE_TO_NORTH,
    "",
    "sea_surface_wave_to_direction",
    "sea_surface_wave_from_direction",
)
VECTORS: Final = (WIND, CURRENT, WAVES)
VECTOR_OF: Final[dict[str, VectorNames]] = {name: v for v in VECTORS for name in v.pair}

_PLAIN_NAMES: Final = {
    EASTWARD_WIND: "wind", NORTHWARD_WIND: "wind",
    EASTWARD_CURRENT: "current", NORTHWARD_CURRENT: "current",
    WAVE_HEIGHT: "wave height", WAVE_PERIOD: "wave period",
    WAVE_TO_EAST: "wave direction", WAVE_TO_NORTH: "wave direction",
    WATER_LEVEL: "water level", BED_DEPTH: "depth of the bed", PRESSURE: "air pressure",
    ICE: "sea ice",
}  # fmt: skip


def plain_names(names: Iterable[str]) -> str:
    """Return variables in the words of a mariner, each once, such as "wave height, wind".

    Parameters
    ----------
    names : CF standard names; unknown ones stay as they are.
    """
    words = {_PLAIN_NAMES.get(name, name) for name in names}
    return ", ".join(sorted(words)) or "nothing"


CHANNEL_VARIABLES: Final[dict[int, str]] = {
    codes.CURRENT_EAST: EASTWARD_CURRENT,
    codes.CURRENT_NORTH: NORTHWARD_CURRENT,
    codes.WIND_EAST: EASTWARD_WIND,
    codes.WIND_NORTH: NORTHWARD_WIND,
    codes.WAVE_HEIGHT_CHANNEL: WAVE_HEIGHT,
    codes.WAVE_EAST: WAVE_TO_EAST,
    codes.WAVE_NORTH: WAVE_TO_NORTH,
    codes.WAVE_PERIOD: WAVE_PERIOD,
    codes.WATER_LEVEL: WATER_LEVEL,
    codes.BED_DEPTH: BED_DEPTH,
}

CANONICAL_UNITS: Final[dict[str, str]] = {
    EASTWARD_WIND: "m/s",
    NORTHWARD_WIND: "m/s",
    EASTWARD_CURRENT: "m/s",
    NORTHWARD_CURRENT: "m/s",
    WAVE_HEIGHT: "m",
    WAVE_PERIOD: "s",
    WAVE_TO_EAST: "1",
    WAVE_TO_NORTH: "1",
    WATER_LEVEL: "m",
    BED_DEPTH: "m",
    PRESSURE: "Pa",
    ICE: "1",
    "wind_speed": "m/s",
    "sea_water_speed": "m/s",
}

_LEVEL_PATTERN = re.compile(
    r"^(tidal_)?(sea|water)_surface_(height|elevation)(_above_\w+|_anomaly|_relative_to_\w+)?"
    r"(_due_to_\w+)?$"
)
_DEPTH_PATTERN = re.compile(r"^sea_floor_depth(_below_\w+)?$")
_BED_LEVELS = frozenset(
    {"bed_level", "sea_floor_altitude", "altitude_of_sea_floor", "sea_floor_height"}
    | {f"height_above_{d}" for d in ("mean_sea_level", "geoid", "reference_ellipsoid")}
)


def canonical_name(name: str) -> str:
    """Return the canonical name of a variable: all names of level, depth and pressure become one.

    Parameters
    ----------
    name : CF standard name.

    Examples
    --------
    >>> canonical_name("sea_floor_depth_below_mean_sea_level")
    'sea_floor_depth_below_geoid'
    >>> canonical_name("tidal_sea_surface_height_above_lowest_astronomical_tide")
    'sea_surface_height_above_geopotential_datum'
    """
    if name == TOTAL_DEPTH:
        return name
    if _DEPTH_PATTERN.match(name):
        return BED_DEPTH
    if _LEVEL_PATTERN.match(name):
        return WATER_LEVEL
    if name in ("surface_air_pressure_at_sea_level", "air_pressure_at_sea_level"):
        return PRESSURE
    return name


def is_bed_level(name: str) -> bool:
    """Return whether a name is that of a height of the sea floor, positive up."""
    return name in _BED_LEVELS


def inseparable_variables(name: str) -> tuple[str, ...]:
    """Return the variables that must come from the same layer: both components of a vector."""
    vector = VECTOR_OF.get(name)
    return vector.pair if vector else (name,)


def vector_of_derived_name(name: str) -> tuple[VectorNames, str] | None:
    """Return the vector and part ("speed", "towards", "origin") of a derived name, or None."""
    for vector in VECTORS:
        for part in ("speed", "towards", "origin"):
            if name and name == getattr(vector, part):
                return vector, part
    return None
