"""The first run ever compiles the kernels; two processes halve the wait.

A child compiles what the search and the refinement need and leaves it in the cache on disk, while
the parent imports, reads the coast and builds its network. This module imports nothing heavy, so
that the child can be started first of all.
"""

from __future__ import annotations

import gc
import importlib
import subprocess
import sys

from thalweg.kernels.compilation.compiled_code_cache import COMPILED

_DONE, _BUSY = COMPILED / "warm", COMPILED / "warming"
_PATIENCE = 120.0  # seconds the parent waits for the child at most
_MANY = 200_000  # objects made before rubbish is looked for: compiling makes millions that stay
_children: list[subprocess.Popen[bytes]] = []


def begin(module: str) -> None:
    """Start a child that calls ``compile_search`` of a module, unless that has been done."""
    if _DONE.exists():
        return
    gc.set_threshold(_MANY)
    if not sys.executable or getattr(sys, "frozen", False):
        return
    try:
        _BUSY.touch(exist_ok=False)
        command = [sys.executable, "-c", f"from {__name__} import work; work({module!r})"]
        quiet = subprocess.DEVNULL
        _children.append(subprocess.Popen(command, stdin=quiet, stdout=quiet, stderr=quiet))
    except OSError:
        return


def finish() -> None:
    """Wait for the child, if there is one."""
    while _children:
        child = _children.pop()
        try:
            child.wait(timeout=_PATIENCE)
        except subprocess.TimeoutExpired:
            child.kill()


def work(module: str) -> None:
    """Do the child's work."""
    gc.set_threshold(_MANY)
    try:
        importlib.import_module(module).compile_search()
        _DONE.touch()
    finally:
        _BUSY.unlink(missing_ok=True)
