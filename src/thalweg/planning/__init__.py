"""Planning: the request, the result, and the steps from one to the other."""

from thalweg.lazy_exports import lazy_exports

__getattr__, __all__ = lazy_exports(__name__, __path__[0])
