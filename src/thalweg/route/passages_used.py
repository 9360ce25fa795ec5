"""The named passages that a route leads through."""

from __future__ import annotations

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.passage_crossings import passages_crossed
from thalweg.chart.passages import Passage
from thalweg.route.route import Route


def passages_used(chart: Chart, route: Route) -> list[Passage]:
    """Return the passages of a chart that a route leads through, in their order on the route."""
    lat, lon = np.asarray(route.track.lat), np.asarray(route.track.lon)
    return [p for _, p in passages_crossed(chart.coastline, chart.passages, lat, lon)]
