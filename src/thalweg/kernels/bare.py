"""Compiling functions that make no arrays: without reference counting."""

from thalweg.kernels.jit import jit


def bare(function):
    """Compile a function that neither allocates nor returns an array.

    Numba counts references to every array of every tuple handed to a function, with atomic
    operations: for the leg formula that costs twenty times the formula. A function that only reads
    and writes arrays of its caller needs no counting.
    """
    return jit(function, _nrt=False)


def inner(function):
    """Compile as `bare` does, for callers in kernels only: without the door to Python."""
    return jit(function, _nrt=False, no_cpython_wrapper=True, no_cfunc_wrapper=True)


def inlined(function):
    """Compile as `inner` does, into the caller: for small functions and those called in one place.

    Tuples of arrays are handed over by value, some hundred machine words at every call.
    """
    return jit(
        function, _nrt=False, forceinline=True, no_cpython_wrapper=True, no_cfunc_wrapper=True
    )
