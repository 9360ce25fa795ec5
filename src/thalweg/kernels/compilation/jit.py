"""How kernels are compiled: numba, cached on disk, without division checks."""

import numba

from thalweg.kernels.compilation.compiled_code_cache import COMPILED_FOLDER


def jit(function=None, **options):
    """Compile with on-disk caching and NumPy's error model (division checks block SIMD)."""
    if function is None:
        return lambda given: jit(given, **options)
    options = {"cache": True, "error_model": "numpy", "nogil": True, **options}
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(COMPILED_FOLDER)
    try:
        return numba.njit(**options)(function)
    finally:
        numba.config.CACHE_DIR = before


prange = numba.prange
