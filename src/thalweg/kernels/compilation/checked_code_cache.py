"""Compiled code on disk with a checksum: a damaged file is compiled again, never loaded.

numba reads its cache files unchecked, and a file cut short by a full disk or a stopped process
ends every later run. Here each file ends with a checksum of its content.
"""

import contextlib
import hashlib
import inspect
import io
from pathlib import Path

from numba.core.caching import FunctionCache, IndexDataCacheFile

from thalweg.kernels.compilation.compiled_code_cache import COMPILED_FOLDER, PACKAGE

_CHECKSUM_BYTES = 16


def _checksum(content):
    return hashlib.blake2b(content, digest_size=_CHECKSUM_BYTES).digest()


def is_intact(path):
    """Return whether a file ends with the checksum of the rest of its content."""
    try:
        data = memoryview(Path(path).read_bytes())
    except OSError:
        return False
    content, checksum = data[:-_CHECKSUM_BYTES], data[-_CHECKSUM_BYTES:]
    return len(content) > 0 and _checksum(content) == checksum


class CheckedCacheFile(IndexDataCacheFile):
    """The files of one kernel; damaged ones count as missing and are written again."""

    def _load_index(self):
        return super()._load_index() if is_intact(self._index_path) else {}

    def _load_data(self, name):
        if not is_intact(self._data_path(name)):
            raise OSError(f"the compiled code {name} is damaged")  # numba compiles it again
        return super()._load_data(name)

    @contextlib.contextmanager
    def _open_for_write(self, filepath):
        content = io.BytesIO()
        yield content
        with super()._open_for_write(filepath) as file:
            file.write(content.getvalue() + _checksum(content.getvalue()))


class CheckedFunctionCache(FunctionCache):
    """The cache of one kernel. Code that cannot be kept, on a full disk, is used all the same."""

    def __init__(self, function):
        super().__init__(function)
        stamp = self._impl.locator.get_source_stamp()
        source = Path(inspect.getfile(function)).resolve()
        if source.is_relative_to(PACKAGE):
            # the folder stands for the text of all kernels: neither place nor time of a file counts
            place = COMPILED_FOLDER / source.relative_to(PACKAGE).with_suffix("")
            self._cache_path, stamp = str(place), "text of the package"
        self._cache_file = CheckedCacheFile(
            cache_path=self._cache_path,
            filename_base=self._impl.filename_base,
            source_stamp=stamp,
        )

    def _save_overload(self, sig, data):
        Path(self._cache_path).mkdir(parents=True, exist_ok=True)
        super()._save_overload(sig, data)

    def save_overload(self, sig, data):
        """Keep compiled code if that is possible."""
        with contextlib.suppress(OSError):
            super().save_overload(sig, data)
