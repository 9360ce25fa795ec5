"""What a nautical chart holds: coastline, depth, zones and ports."""

from thalweg.lazy_exports import lazy_exports

__getattr__, __all__ = lazy_exports(__name__, __path__[0])
