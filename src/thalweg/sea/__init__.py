"""The sea: met-ocean fields from files and formulas, sampled and frozen for kernels."""

from thalweg.lazy_exports import lazy_exports

__getattr__, __all__ = lazy_exports(__name__, __path__[0])
