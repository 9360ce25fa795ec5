"""Multi-objective evolution of tracks: algorithms, variation operators and quality indicators."""

from thalweg.lazy_exports import lazy_exports

__getattr__, __all__ = lazy_exports(__name__, __path__[0])
