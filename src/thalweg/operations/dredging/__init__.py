"""Dredging projects: load, sail full, unload, sail empty, until a volume is moved."""

from thalweg.lazy_exports import lazy_exports

__getattr__, __all__ = lazy_exports(__name__, __path__[0])
