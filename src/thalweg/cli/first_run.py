"""A message on the first run, which compiles the numerical kernels for this computer."""

from __future__ import annotations

import sys

from thalweg.kernels.compilation.compiled_code_cache import COMPILED_FOLDER
from thalweg.planning.compile_kernels import search_is_compiled


def announce_compilation(*, search: bool = False, quiet: bool = False) -> None:
    """Print one line on stderr if kernels will be compiled in this run.

    Parameters
    ----------
    search : Whether the command needs the search, the largest part of the kernels.
    quiet : Whether to print nothing.
    """
    if quiet or search_is_compiled():
        return
    if search or not any(COMPILED_FOLDER.rglob("*.nbc")):
        print(
            "First run: compiling the numerical kernels for this computer, once (1 to 3 minutes). "
            f"They are stored in {COMPILED_FOLDER.parent}; later runs start at once.",
            file=sys.stderr,
            flush=True,
        )
