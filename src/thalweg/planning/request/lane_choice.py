"""Traffic separation schemes of a voyage: on which side of a separation line a mile counts more."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from thalweg.chart import Chart
from thalweg.chart.zones.traffic_schemes import SMALL, lanes_of_schemes
from thalweg.core.geodesy import Position
from thalweg.planning.request.offing_choice import chosen_offing
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.voyage import Voyage
from thalweg.ship import Ship


def add_traffic_schemes(
    chart: Chart, voyage: Voyage, ship: Ship, ends: Sequence[Endpoint]
) -> Chart:
    """Return the chart with the lanes of the traffic separation schemes that a voyage may meet.

    Charts of the world's coasts without lanes of their own get them, for voyages that keep an
    offing.

    Parameters
    ----------
    ends : Round them the lanes do not count.
    """
    near_land = chosen_offing(voyage, ship) <= 0.0
    if voyage.ignore_lanes or near_land or chart.approaches is None or chart.zones.lanes:
        return chart
    return chart_with_schemes(chart, ship, [(float(end.lat), float(end.lon)) for end in ends])


def chart_with_schemes(chart: Chart, ship: Ship, places: Sequence[Position]) -> Chart:
    """Return the chart with the lanes of traffic separation schemes that bind a ship.

    Parameters
    ----------
    places : (lat, lon) of the ends of a way [deg]; round them the lanes do not count.
    """
    lanes = lanes_of_schemes(places, inshore=ship.length is None or ship.length >= SMALL)
    return replace(chart, zones=replace(chart.zones, lanes=lanes)) if lanes else chart
