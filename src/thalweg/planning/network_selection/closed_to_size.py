"""Notes on canals and passages that the size of a ship closes on a shorter way."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from thalweg.chart.passages import Passage
from thalweg.core.errors import NoRouteError
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.network_selection.closed_to_draught import LEAST_SAVED, LEAST_SHARE
from thalweg.planning.network_selection.way_over_seas import WayOverSeas, way_over_seas
from thalweg.planning.report.closed_way_report import (
    NarrowWay,
    notes_by_reason,
    title_of_way,
    ways_on_line,
)
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.seaways import Seaways


def closed_to_size_notes(
    seas: Seaways,
    sizes: Mapping[str, float | None],
    ends: Sequence[Endpoint],
    way: WayOverSeas,
    *,
    offing: float,
) -> tuple[str, ...]:
    """Return a note on what beam, length or air draught close that would make a way shorter.

    A draught that is too great for the length counts as well; one that is too great for all ships
    has its own note.

    Parameters
    ----------
    seas : The seaways that the ship may use.
    sizes : Draught, beam, length and air draught [m], None where unknown.
    ends : With all ways from their berths, and with via points between them.
    way : The shortest way that is open; what its approaches lead through has notes of its own.
    offing : Distance from land that ways keep [m].

    Returns
    -------
    tuple of str : One or none.
    """
    draught = sizes["draught"]
    alone = {**dict.fromkeys(sizes, None), "draught": draught}  # what closes has its own note
    reasons = {
        one: _restriction(one, sizes) for one in _closed_ways(seas) if not _restriction(one, alone)
    }
    too_small = [one for one, reason in reasons.items() if reason]
    if not too_small:
        return ()
    names = {one.name for one in too_small}
    opened = replace(
        seas,
        canals=tuple(name for name in seas.canals if name not in names),
        passages=tuple(name for name in seas.passages if name not in names),
    )
    least = max(LEAST_SAVED, LEAST_SHARE * way.length)
    try:
        rough = [way_over_seas(one, ends, draught=draught, offing=None) for one in (seas, opened)]
        if rough[0].length - rough[1].length < least:
            return ()
        through = way_over_seas(opened, ends, draught=draught, offing=offing)
    except NoRouteError:
        return ()
    saved = way.length - through.length
    if saved < least:
        return ()
    passed = ways_on_line(seas, too_small, way.line)
    used = {
        title_of_way(one): reasons[one]
        for one in ways_on_line(seas, too_small, through.line)
        if one not in passed
    }
    if not used:
        return ()
    about = ". ".join(note for _, note in notes_by_reason(used))
    return (f"{about}. The way through is about {saved / NAUTICAL_MILE:,.0f} nm shorter.",)


def _closed_ways(seas: Seaways) -> list[NarrowWay]:
    """Return the canals and passages for ships in trade that are closed."""
    canals: list[NarrowWay] = [one for one in seas.chart.canals if one.name in seas.canals]
    return canals + [
        one for one in seas.chart.passages if one.name in seas.passages and one.use == "trade"
    ]


def _restriction(one: NarrowWay, sizes: Mapping[str, float | None]) -> str:
    if isinstance(one, Passage):
        return one.ship_restriction(**sizes)
    return one.transit_restriction(**sizes)
