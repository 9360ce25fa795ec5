"""Networks of paths over the sea as plain arrays, and their builders."""

from thalweg.lazy_exports import lazy_exports

__getattr__, __all__ = lazy_exports(__name__, __path__[0])
