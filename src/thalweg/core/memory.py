"""The memory of the machine or container, to refuse what would not fit before it is built."""

from __future__ import annotations

import os
from functools import cache
from pathlib import Path
from typing import Final

ASSUMED_MEMORY: Final = 8_000_000_000  #: [bytes] where the system does not state it
_CONTAINER_LIMITS: Final = (
    "/sys/fs/cgroup/memory.max",
    "/sys/fs/cgroup/memory/memory.limit_in_bytes",
)


@cache
def machine_memory() -> int:
    """Return the memory of the machine, or of its container where that is less [bytes]."""
    try:
        size = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError, OSError):
        size = ASSUMED_MEMORY
    for name in _CONTAINER_LIMITS:
        try:
            size = min(size, int(Path(name).read_text()))
        except (OSError, ValueError):  # no container, or "max"
            continue
    return size if size > 0 else ASSUMED_MEMORY
