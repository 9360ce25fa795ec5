"""What a plan states about the zones of its chart: emission control areas, and margins."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.zones.emission_control_areas import emission_control_areas
from thalweg.core.geodesy import densify
from thalweg.core.units import NAUTICAL_MILE
from thalweg.route import Route

_SPACING: Final = 5.0 * NAUTICAL_MILE  # between positions that are tested


def control_area_notes(chart: Chart, routes: Sequence[Route]) -> list[str]:
    """Return which emission control areas of the chart the routes meet, in one note.

    Returns
    -------
    list of str : Empty where no areas count.
    """
    if not chart.zones.eca:
        return []
    lines = [densify(route.track.lat, route.track.lon, _SPACING)[:2] for route in routes]
    lat, lon = (np.concatenate(values) for values in zip(*lines))
    titles = {area.name: area.title for area in emission_control_areas()}
    met = [
        titles.get(zone.name, zone.name)
        for zone in chart.zones.eca
        if zone.contains(lat, lon).any()
    ]
    if not met:
        return ["The routes pass no emission control area."]
    return [f"Emission control areas on the way: {', '.join(met)}."]


def margin_notes(chart: Chart) -> list[str]:
    """Return by how much routes keep clear of no-go zones, in one note; empty without margins."""
    widths = sorted({margin / NAUTICAL_MILE for margin in chart.zones.margins})
    if not widths:
        return []
    words = " and ".join(f"{width:g}" for width in widths)
    count = len(chart.zones.margins)
    areas = "1 closed area" if count == 1 else f"{count} closed areas"
    return [f"Keeps {words} nm clear of {areas}."]
