"""Compile the kernels in a second process on first use, to halve the wait.

The child process compiles the kernels of the search and the refinement into the cache on disk,
while the parent imports modules, reads the coast and builds its network. This module imports only
small modules, so that the child process starts early.
"""

from __future__ import annotations

import gc
import importlib
import subprocess
import sys

from thalweg.kernels.compilation.compiled_code_cache import COMPILED_FOLDER

_COMPILED_MARKER, _COMPILING_MARKER = COMPILED_FOLDER / "warm", COMPILED_FOLDER / "warming"
_CHILD_TIMEOUT = 120.0  # seconds the parent waits for the child at most
_GARBAGE_COLLECTION_THRESHOLD = (
    200_000  # objects between garbage collections: compiling makes millions that stay in use
)
_children: list[subprocess.Popen[bytes]] = []


def start_compiling(module: str) -> None:
    """Start a child that calls ``compile_search`` of a module, unless that has been done."""
    if _COMPILED_MARKER.exists():
        return
    gc.set_threshold(_GARBAGE_COLLECTION_THRESHOLD)
    if not sys.executable or getattr(sys, "frozen", False):
        return
    try:
        _COMPILING_MARKER.touch(exist_ok=False)
        command = [sys.executable, "-c", f"import {__name__} as w; w.compile_in_child({module!r})"]
        quiet = subprocess.DEVNULL
        _children.append(subprocess.Popen(command, stdin=quiet, stdout=quiet, stderr=quiet))
    except OSError:
        return


def wait_until_compiled() -> None:
    """Wait for the child, if there is one."""
    while _children:
        child = _children.pop()
        try:
            child.wait(timeout=_CHILD_TIMEOUT)
        except subprocess.TimeoutExpired:
            child.kill()


def compile_in_child(module: str) -> None:
    """Do the child's work."""
    gc.set_threshold(_GARBAGE_COLLECTION_THRESHOLD)
    try:
        importlib.import_module(module).compile_search()
        _COMPILED_MARKER.touch()
    finally:
        _COMPILING_MARKER.unlink(missing_ok=True)
