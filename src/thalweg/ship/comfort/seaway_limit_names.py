"""Names of limits of safety and comfort in waves, and the units in which values are written."""

from __future__ import annotations

from types import MappingProxyType
from typing import Final

from thalweg.core.units import KNOT

SICKNESS_NAME: Final = "motion sickness"
ACCELERATION_NAME: Final = "vertical acceleration"
SURF_RIDING_NAME: Final = "surf-riding"
HIGH_WAVES_NAME: Final = "successive high waves"
SYNCHRONOUS_ROLL_NAME: Final = "synchronous roll"
PARAMETRIC_ROLL_NAME: Final = "parametric roll"
#: Value and name of the unit in which values are written, by the start of the limit's name.
SEAWAY_UNITS: Final = MappingProxyType(
    {
        SICKNESS_NAME: (1.0, " %"),
        ACCELERATION_NAME: (1.0, " m/s2"),
        SURF_RIDING_NAME: (KNOT, " kn"),
        HIGH_WAVES_NAME: (1.0, " m"),
        SYNCHRONOUS_ROLL_NAME: (1.0, " s"),
        PARAMETRIC_ROLL_NAME: (1.0, " s"),
    }
)
