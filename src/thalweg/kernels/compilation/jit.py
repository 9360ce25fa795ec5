"""How kernels are compiled: numba, cached on disk, without division checks."""

import contextlib

import numba

from thalweg.kernels.compilation.checked_code_cache import CheckedFunctionCache
from thalweg.kernels.compilation.compiled_code_cache import COMPILED_FOLDER
from thalweg.kernels.compilation.kernel_libraries import entry_compiler
from thalweg.kernels.compilation.whole_compilation import compiled_whole


def jit(function=None, **options):
    """Compile with on-disk caching and NumPy's error model (division checks block SIMD)."""
    if function is None:
        return lambda given: jit(given, **options)
    usual = {"error_model": "numpy", "nogil": True, "pipeline_class": entry_compiler()}
    kernel = numba.njit(**{**usual, **options})(function)
    kernel.compile = compiled_whole(kernel.compile)
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(COMPILED_FOLDER)
    try:
        # numba raises RuntimeError where no folder can be written: then nothing is kept
        with contextlib.suppress(RuntimeError):
            kernel._cache = CheckedFunctionCache(function)
    finally:
        numba.config.CACHE_DIR = before
    return kernel


prange = numba.prange
