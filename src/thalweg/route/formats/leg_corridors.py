"""Cross-track limits of route files, and whether the water between them is clear."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from thalweg.chart.canal_parts import part_number_of_legs
from thalweg.core.geodesy import Position, densify, direct, inverse
from thalweg.core.rhumb_lines import rhumb_pieces
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.route.formats.parsed_track import RHUMB_DEVIATION, ParsedTrack

if TYPE_CHECKING:
    from thalweg.chart import Chart

_SPACING: Final = 0.5 * NAUTICAL_MILE  # of the positions from which the limits are set off
_SHOWN: Final = 6


def corridor_notes(parsed: ParsedTrack, chart: Chart) -> list[str]:
    """Return a note where the cross-track limits of a file meet land or a closed zone.

    Parameters
    ----------
    parsed : With ``corridors``; legs along approaches and in canals of the chart are not tested.

    Returns
    -------
    list of str : Empty where the file has no limits.
    """
    if not parsed.corridors:
        return []
    lat, lon = np.array(parsed.positions).T
    approaches = getattr(chart, "approaches", None)
    inside = np.zeros(len(lat) - 1, bool) if approaches is None else approaches.legs(lat, lon)
    if getattr(chart, "canals", ()):
        inside = inside | (chart.canal_of_legs(lat[:-1], lon[:-1], lat[1:], lon[1:]) >= 0)
        inside = inside | (part_number_of_legs(chart.canals, lat, lon) >= 0)
    rhumb = parsed.rhumb or [False] * (len(lat) - 1)
    met, tested = [], 0
    for k, sides in enumerate(parsed.corridors):
        start, end = parsed.positions[k : k + 2]
        if inside[k] or start == end:
            continue
        line = _line(start, end, rhumb[k])
        for side, width in zip(("port", "starboard"), sides):
            if not width > 0.0:
                continue
            tested += 1
            y, x = _set_off(*line, -width if side == "port" else width)
            if np.any(chart.legs_blocked(y[:-1], x[:-1], y[1:], x[1:])):
                met.append(f"leg {k + 1} to {side} ({width / NAUTICAL_MILE:.2f} nm)")
    if not tested:
        return []
    if not met:
        outside = ", outside canals and approaches of ports" if inside.any() else ""
        return [
            "The cross-track limits of the file keep clear of charted land and closed zones"
            f"{outside}."
        ]
    more = f" and {len(met) - _SHOWN} more" if len(met) > _SHOWN else ""
    shown = ", ".join(met[:_SHOWN])
    return [f"The cross-track limits of the file meet land or closed zones: {shown}{more}."]


def _line(start: Position, end: Position, rhumb: bool) -> tuple[FloatArray, FloatArray]:
    """Return close positions on a leg."""
    lat, lon = np.array([start, end]).T
    if rhumb:
        lat, lon, _ = rhumb_pieces(lat, lon, RHUMB_DEVIATION)
    return densify(lat, lon, _SPACING)[:2]


def _set_off(lat: FloatArray, lon: FloatArray, width: float) -> tuple[FloatArray, FloatArray]:
    """Return the line at a distance [m] to starboard (to port if negative)."""
    course = np.asarray(inverse(lat[:-1], lon[:-1], lat[1:], lon[1:])[1])
    course = np.append(course, course[-1]) + np.copysign(0.5 * np.pi, width)
    found = direct(lat, lon, course, np.full(len(lat), abs(width)))
    return np.asarray(found[0]), np.asarray(found[1])
