"""Work on many things of a kind, divided over all cores."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache

import numpy as np

_NAME = "thalweg-work"


def run_in_threads(work: Callable[[slice], object], count: int, *, least: int = 16) -> None:
    """Call ``work(slice)`` for parts of ``range(count)`` on all cores.

    Parameters
    ----------
    work : Releases the lock of the interpreter, as kernels do.
    count : 0 or more.
    least : Size from which a part is worth a thread.
    """
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    parts = min(max(1, count // least), 4 * (cores or 1))
    # a part that waited for others of its own pool could wait for ever
    if parts == 1 or cores == 1 or threading.current_thread().name.startswith(_NAME):
        work(slice(0, count))
        return
    edges = np.linspace(0, count, parts + 1).astype(int)
    list(_threads(cores or 1).map(work, map(slice, edges[:-1], edges[1:])))


@cache
def _threads(cores: int) -> ThreadPoolExecutor:
    return ThreadPoolExecutor(cores, thread_name_prefix=_NAME)


if hasattr(os, "register_at_fork"):  # a child has none of its parent's threads
    os.register_at_fork(after_in_child=_threads.cache_clear)
