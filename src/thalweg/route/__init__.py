"""Routes: tracks, the referee that evaluates them, their refinement and file formats."""

from thalweg.lazy_exports import lazy_exports

__getattr__, __all__ = lazy_exports(__name__, __path__[0])
