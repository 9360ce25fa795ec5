"""Labels of a map that do not lie on top of each other, and the times along a route."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from thalweg.core.time import format_time
from thalweg.core.types import BoolArray, FloatArray
from thalweg.core.units import DAY, HOUR

_INK = "#22303c"
_OFFSETS = [(0, 9), (0, -9), (9, 0), (-9, 0), (8, 7), (-8, 7), (8, -7), (-8, -7), (0, 18), (0, -18)]
_SAME_PLACE = 1e-6  # [deg]
_CLEAR = 4.0  # room between labels and lines [display units]
_STEPS_H = (0.25, 0.5, 1.0, 2.0, 3.0, 6.0, 12.0, 24.0, 48.0, 96.0, 240.0)
_MONTHS = ("Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec")


@dataclass
class LabelPlacer:
    """Places labels beside their positions, where they cover neither each other nor the lines.

    The layout of the figure must be final.

    Attributes
    ----------
    lines : Points [display units] that labels should not cover, (n, 2).
    """

    axes: Any
    lines: np.ndarray
    taken: list[Any] = field(default_factory=list)

    def place(
        self, text: str, lon: float, lat: float, *, needed: bool = False, **style: Any
    ) -> bool:
        """Draw a label where it covers least; return whether it was drawn.

        Parameters
        ----------
        lon, lat : Its position, in the coordinates of the axes.
        needed : Whether it is drawn even where it covers another label or leaves the axes.
        **style : Of `matplotlib.text.Text`.
        """
        from matplotlib.patheffects import withStroke

        halo = [withStroke(linewidth=2.2, foreground="white")]
        label = self.axes.annotate(
            text, (lon, lat), xytext=(0, 0), textcoords="offset points", zorder=10,
            annotation_clip=True, path_effects=halo, **{"color": _INK, **style},
        )  # fmt: skip
        label.set_in_layout(False)
        costs = []
        for dx, dy in _OFFSETS:
            _set_offset(label, dx, dy)
            costs.append(self._cost(label.get_window_extent(), needed))
        best = int(np.argmin(costs))
        if costs[best] >= 1e3 and not needed:
            label.remove()
            return False
        _set_offset(label, *_OFFSETS[best])
        self.taken.append(label.get_window_extent())
        return True

    def _cost(self, box: Any, needed: bool) -> float:
        inside = self.axes.get_window_extent()
        outside = max(0.0, inside.x0 - box.x0, box.x1 - inside.x1) + max(
            0.0, inside.y0 - box.y0, box.y1 - inside.y1
        )
        x, y = self.lines.T if len(self.lines) else (np.zeros(0), np.zeros(0))
        wide = box.padded(_CLEAR)
        covered = (x > wide.x0) & (x < wide.x1) & (y > wide.y0) & (y < wide.y1)
        overlaps = sum(bool(box.overlaps(other)) for other in self.taken)
        leaves = (500.0 if needed else 1e3) + outside if outside > 0.0 else 0.0
        return 1e3 * overlaps + leaves + float(covered.sum())


def drawn_texts(axes: Any) -> list[Any]:
    """Return the boxes of the words on axes [display units], such as of a scale or of contours."""
    return [text.get_window_extent() for text in axes.texts if text.get_text()]


def _set_offset(label: Any, dx: float, dy: float) -> None:
    label.set_position((dx, dy))
    label.set_ha("center" if dx == 0 else "left" if dx > 0 else "right")
    label.set_va("center" if dy == 0 else "bottom" if dy > 0 else "top")


def marked_times(start: float, end: float, most: int = 9) -> tuple[np.ndarray, float]:
    """Return round times in UTC between two times, at most so many, and their step [s]."""
    span = max(end - start, 1.0)
    step = next((HOUR * s for s in _STEPS_H if span / (HOUR * s) <= most), HOUR * _STEPS_H[-1])
    return np.arange(math.ceil(start / step), math.floor(end / step) + 1) * step, step


def at_other_places(lon: FloatArray, lat: FloatArray) -> BoolArray:
    """Return which marks along a route (n,) [deg] are not where the one before is: a ship waits."""
    away = np.hypot(np.diff(lon), np.diff(lat)) > _SAME_PLACE
    return np.append(True, away)[: len(lon)]


def time_label(time: float, step: float) -> str:
    """Return a time in UTC as ``26 Aug``, or with the hour where steps are below a day."""
    text = format_time(time)
    day = f"{int(text[8:10])} {_MONTHS[int(text[5:7]) - 1]}"
    return day if step >= DAY else f"{day} {text[11:16]}"
