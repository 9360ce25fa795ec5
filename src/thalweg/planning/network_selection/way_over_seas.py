"""The shortest way from berth to berth over the seas, with the approaches that suit it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from thalweg.chart.approach_choices import line_between
from thalweg.chart.approaches import PortApproach
from thalweg.core.geodesy import Position, line_length
from thalweg.planning.network_selection.way_choice import with_chosen_ways
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.seaways import Seaways, path_length_and_canals


@dataclass(frozen=True)
class WayOverSeas:
    """A way from berth to berth.

    Attributes
    ----------
    ends : By the ways from their berths that the way takes, with via points between them.
    at_sea : Waypoints between the approaches (lat, lon) [deg]; empty where the approaches meet.
    line : Waypoints of the whole (lat, lon) [deg].
    length : Of the whole [m], canals with their own.
    """

    ends: tuple[Endpoint, ...]
    at_sea: tuple[Position, ...]
    line: tuple[Position, ...]
    length: float

    @property
    def approaches(self) -> list[PortApproach]:
        """The approaches of the first and the last end, where these have one."""
        both = self.ends[0].approach, self.ends[-1].approach
        return [approach for approach in both if approach is not None]


def way_over_seas(
    seas: Seaways, ends: Sequence[Endpoint], *, draught: float | None, offing: float | None
) -> WayOverSeas:
    """Return the shortest way between places, from berth to berth.

    Parameters
    ----------
    seas : The seaways that the ship may use, with their shoals.
    ends : With all ways from their berths, and with via points between them.
    draught : Of the ship [m]; None where it is not known.
    offing : Distance from land that the way keeps [m]; None for the way over the graph alone.

    Raises
    ------
    NoRouteError : If there is no way.
    """
    chosen = tuple(with_chosen_ways(ends, lambda: seas, draught=draught or 0.0))
    first, last = chosen[0].approach, chosen[-1].approach
    if len(chosen) == 2 and first and last:
        along = line_between(first, last, legs_blocked=seas.chart.legs_blocked)
        if along is not None:
            return WayOverSeas(chosen, (), tuple(along), line_length(along))
    parts = [
        seas.graph_path(a, b) if offing is None else seas.path(a, b, offing=offing)
        for a, b in pairwise(chosen)
    ]
    at_sea = (parts[0][0], *(place for part in parts for place in part[1:]))
    line = (
        *(first.line[:-1] if first else ()),
        *at_sea,
        *(last.line[-2::-1] if last else ()),
    )
    length, _ = path_length_and_canals(seas.chart, at_sea)
    near = sum(approach.length for approach in (first, last) if approach)
    return WayOverSeas(chosen, at_sea, line, length + near)
