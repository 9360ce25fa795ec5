"""Work on a population of tracks, divided over all cores."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from functools import cache

import numpy as np

_MIN_TRACKS_PER_THREAD = 16


def run_in_threads(work, count: int) -> None:  # type: ignore[no-untyped-def]
    """Call ``work(slice)`` for parts of ``range(count)`` on all cores."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    parts = min(max(1, count // _MIN_TRACKS_PER_THREAD), 4 * (cores or 1))
    if parts == 1 or cores == 1:
        work(slice(0, count))
        return
    edges = np.linspace(0, count, parts + 1).astype(int)
    list(_threads(cores or 1).map(work, map(slice, edges[:-1], edges[1:])))


@cache
def _threads(cores: int) -> ThreadPoolExecutor:
    return ThreadPoolExecutor(cores, thread_name_prefix="thalweg-evolution")
