"""Ship physics and performance: speed, power and fuel of a ship in given conditions.

In: ship files (YAML), functions, conditions as arrays in SI. Out: speeds, powers, fuel rates, and a
`PerformanceTable` with a measured error for the kernels. Knows no maps, no weather files, no clock.
"""

from thalweg.lazy_exports import lazy_exports

__getattr__, __all__ = lazy_exports(__name__, __path__[0])
