"""Dimensions of the Earth: the WGS 84 ellipsoid and its mean sphere.

Kernels use these too. The folder of compiled kernels is named after the text of this module as
well (`thalweg.kernels.compilation.compiled_code_cache`); it imports nothing of the package.
"""

from typing import Final

EQUATORIAL_RADIUS: Final = 6378137.0  #: semi-major axis of WGS 84 [m]
FLATTENING: Final = 1.0 / 298.257223563  #: of WGS 84 [-]
ECCENTRICITY_SQUARED: Final = FLATTENING * (2.0 - FLATTENING)  #: of the meridians [-]
AXIS_RATIO_SQUARED: Final = (1.0 - FLATTENING) ** 2  #: tan(geocentric latitude) / tan(latitude)
MEAN_RADIUS: Final = 6371008.8  #: mean radius of the ellipsoid [m] (IUGG)
