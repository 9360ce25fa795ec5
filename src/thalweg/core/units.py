"""Units: the one place where boundary units become SI and back."""

from __future__ import annotations

from typing import Final

NAUTICAL_MILE: Final = 1852.0  #: metres
MINUTE: Final = 60.0  #: seconds
HOUR: Final = 3600.0  #: seconds
KNOT: Final = NAUTICAL_MILE / HOUR  #: metres per second in a knot
DAY: Final = 86400.0  #: seconds
TONNE: Final = 1000.0  #: kilograms
MEGAWATT_HOUR: Final = 3.6e9  #: joules
GRAVITY: Final = 9.80665  #: standard gravity [m/s2]
SEA_WATER_DENSITY: Final = 1025.0  #: [kg/m3]
FOOT: Final = 0.3048  #: metres
