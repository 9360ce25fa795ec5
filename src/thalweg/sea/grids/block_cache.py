"""A cache of the values read from files: one block per quantity.

A request outside the cached block reads a block that holds both, with a margin that grows so that
many small requests do not become many small reads. Blocks begin and end where chunks of the file do
as far as memory allows, since a part of a compressed chunk takes as long to read as all of it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from thalweg.sea.grids.source_variables import ChunkSizes, GridWindow, Quantity, RawArray

MAX_UNION_BYTES = 80_000_000  #: larger blocks are not extended to hold the previous block too
MAX_CHUNKED_BYTES = 240_000_000  #: larger blocks are not extended to whole chunks


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
        in_chunks = self._in_whole_chunks(window, quantity.chunks)
        if in_chunks.size * quantity.bytes_per_value <= MAX_CHUNKED_BYTES:
            window = in_chunks
        earlier = None if cached is None else _levels_held(cached, window)
        self.blocks.pop(key, None)
        del cached  # the old values and the new ones are not held together
        found = CachedBlock(window, _read_after(earlier, quantity, window, columns))
        self.blocks[key] = found
        return found

    def _in_whole_chunks(self, window: GridWindow, chunks: ChunkSizes) -> GridWindow:
        """Return a window extended to whole chunks."""
        nt, ny, nx = self.shape
        t0, t1 = _whole(window.t0, window.t1, chunks.levels, nt)
        y0, y1 = _whole(window.y0, window.y1, chunks.rows, ny)
        x0, x1 = window.x0, window.x0 + window.width
        if x1 <= nx:
            x0, x1 = _whole(x0, x1, chunks.columns, nx)
        return GridWindow(t0, t1, y0, y1, x0, x1 - x0)

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


def _whole(first: int, last: int, chunk: int, size: int) -> tuple[int, int]:
    """Return a range that begins and ends where chunks do."""
    return first - first % chunk, min(size, last + -last % chunk)


def _levels_held(cached: CachedBlock, window: GridWindow) -> CachedBlock | None:
    """Return the first levels of a window as far as a block of the same positions holds them."""
    held = cached.window
    if held[2:] != window[2:] or not held.t0 <= window.t0 < held.t1 < window.t1:
        return None
    if any(v.shape[0] != held.t1 - held.t0 for v in cached.values.values()):
        return None  # variables without times
    values = {name: v[window.t0 - held.t0 :].copy() for name, v in cached.values.items()}
    return CachedBlock(window._replace(t1=held.t1), values)


def _read_after(
    earlier: CachedBlock | None, quantity: Quantity, window: GridWindow, columns: int
) -> dict[str, RawArray]:
    """Return the values of a window, of which only levels after those held are read."""
    if earlier is None:
        return quantity.read(window, columns)
    later = quantity.read(window._replace(t0=earlier.window.t1), columns)
    return {name: np.concatenate([v, later[name]]) for name, v in earlier.values.items()}


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
