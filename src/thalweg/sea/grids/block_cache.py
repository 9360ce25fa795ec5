"""A cache of the values read from files: one block per quantity.

A request outside the cached block reads a block that holds both, with a margin that grows so that
many small requests do not become many small reads.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

from thalweg.sea.grids.source_variables import GridWindow, Quantity, RawArray

MAX_UNION_BYTES = 80_000_000  #: larger blocks are not extended to hold the previous block too


class CachedBlock(NamedTuple):
    """Values (times, points) by name, read for a window."""

    window: GridWindow
    values: dict[str, RawArray]


@dataclass
class BlockCache:
    """The last block read of each quantity.

    Attributes
    ----------
    shape : Times, rows and columns of the whole grid.
    wraps : Whether columns wrap around the globe.
    blocks : Block by names of the quantity.
    misses : Number of reads after the first, by names of the quantity.
    """

    shape: tuple[int, int, int]
    wraps: bool
    blocks: dict[tuple[str, ...], CachedBlock] = field(default_factory=dict)
    misses: dict[tuple[str, ...], int] = field(default_factory=dict)

    def block(self, quantity: Quantity, wanted: GridWindow) -> CachedBlock:
        """Return a block that contains a window, reading it if necessary."""
        key = quantity.names
        cached = self.blocks.get(key)
        columns = self.shape[2]
        if cached is not None and cached.window.contains(wanted, columns):
            return cached
        misses = self.misses[key] = self.misses.get(key, -1) + 1
        most = MAX_UNION_BYTES // quantity.bytes_per_value
        small = misses > 0 and wanted.size <= most
        window = self._window_with_margin(wanted) if small else wanted
        if cached is not None:
            both = self._union(window, cached.window)
            window = both if both.size <= most else window
        self.blocks.pop(key, None)
        del cached  # the old values and the new ones are not held together
        found = CachedBlock(window, quantity.read(window, columns))
        self.blocks[key] = found
        return found

    def _window_with_margin(self, window: GridWindow) -> GridWindow:
        """Return a window with a margin, a quarter of its size."""
        nt, ny, nx = self.shape
        dt = 1 + (window.t1 - window.t0) // 4
        dy = 2 + (window.y1 - window.y0) // 4
        dx = 2 + window.width // 4
        x0, width = _columns_in_grid(window.x0 - dx, window.width + 2 * dx, nx, self.wraps)
        return GridWindow(
            max(0, window.t0 - dt),
            min(nt, window.t1 + dt),
            max(0, window.y0 - dy),
            min(ny, window.y1 + dy),
            x0,
            width,
        )

    def _union(self, a: GridWindow, b: GridWindow) -> GridWindow:
        """Return the smallest window that contains both."""
        nx = self.shape[2]
        x0, width = _column_union((a.x0, a.width), (b.x0, b.width), nx, self.wraps)
        return GridWindow(
            min(a.t0, b.t0), max(a.t1, b.t1), min(a.y0, b.y0), max(a.y1, b.y1), x0, width
        )


def _columns_in_grid(x0: int, width: int, columns: int, wraps: bool) -> tuple[int, int]:
    """Return a range of columns limited to the grid."""
    if wraps:
        return (0, columns) if width >= columns else (x0 % columns, width)
    end = min(columns, x0 + width)
    return max(0, x0), end - max(0, x0)


def _column_union(
    a: tuple[int, int], b: tuple[int, int], columns: int, wraps: bool
) -> tuple[int, int]:
    """Return the shortest range of columns that contains two ranges."""
    if not wraps:
        x0 = min(a[0], b[0])
        return x0, max(a[0] + a[1], b[0] + b[1]) - x0
    best = (0, columns)
    for first, second in ((a, b), (b, a)):
        offset = (second[0] - first[0]) % columns
        width = max(first[1], offset + second[1])
        if width < best[1]:
            best = (first[0], width)
    return best
