"""Decorators that compile kernels without reference counts.

Taking an array out of a named tuple costs two atomic counts; in the land test of a leg they were
more than half of the time, in the leg formula nine tenths. numba has an option without them, not
part of its public interface, so it is left out where numba does not know it.
"""

from thalweg.kernels.compilation.jit import jit
from thalweg.kernels.compilation.kernel_libraries import inner_compiler

_INNER = {
    "no_cpython_wrapper": True,
    "no_cfunc_wrapper": True,
    "pipeline_class": inner_compiler(),
}


def _compile(function, **options):
    try:
        return jit(_nrt=False, **options)(function)
    except (KeyError, TypeError):
        return jit(**options)(function)


def allocation_free(function):
    """Compile a kernel without reference counting; it must not create or return arrays."""
    return _compile(function)


def kernel_only(function):
    """Compile as `allocation_free` does, for callers in kernels only: without an entry from
    Python.
    """
    return _compile(function, **_INNER)


def inlined(function):
    """Compile as `kernel_only` does, into the caller: for small functions and those called in one
    place.

    Tuples of arrays are handed over by value, some hundred machine words at every call.
    """
    return _compile(function, forceinline=True, **_INNER)


def inlined_by_numba(function):
    """Compile as part of the caller from the start: for thin layers over large inlined functions.

    Each level of `inlined` functions is optimised again; functions inlined here take no extra time.
    Use it for small functions only: the time of type inference grows fast.
    """
    return _compile(function, inline="always", **_INNER)
