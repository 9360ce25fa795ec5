"""The one way kernels are compiled: numba, cached on disk, without division checks."""

import os
import tempfile
from pathlib import Path


def _use_writable_cache() -> None:
    """Send compiled code to the user's cache folder when the package folder is read-only."""
    if "NUMBA_CACHE_DIR" in os.environ or os.access(Path(__file__).parent, os.W_OK):
        return
    base = Path(os.environ.get("THALWEG_CACHE") or Path.home() / ".cache" / "thalweg")
    folder = base / "numba"
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        folder = Path(tempfile.mkdtemp(prefix="thalweg-numba-"))
    os.environ["NUMBA_CACHE_DIR"] = str(folder)


_use_writable_cache()

import numba  # noqa: E402  # the cache folder must be settled before numba is imported


def jit(*args, **options):
    """Compile with on-disk caching and NumPy's error model (division checks block SIMD)."""
    options.setdefault("cache", True)
    options.setdefault("error_model", "numpy")
    options.setdefault("nogil", True)
    return numba.njit(*args, **options)


prange = numba.prange
