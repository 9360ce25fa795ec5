"""The seaways of a distance: what its options close and open, and its shoals."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

from thalweg.chart import Chart
from thalweg.chart.depth.shoals import DRAUGHTS, Shoals
from thalweg.chart.depth.shoals_of_draught import shoals_of_draught
from thalweg.chart.passages import find_passages
from thalweg.core.errors import InputError
from thalweg.core.given_numbers import is_number, shortened_repr
from thalweg.core.limits import DEEPEST_DRAUGHT
from thalweg.planning.network_selection.closed_to_draught import shoals_open_beside
from thalweg.planning.network_selection.sea_distance_data import USUAL_DEPTH
from thalweg.planning.report.distance_report import LEAST_DEPTH
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.seaways import Seaways, small_passages


def seas_and_every(
    chart: Chart,
    ends: Sequence[Endpoint],
    closed: Sequence[str],
    opened: Sequence[str],
    draught: float | None,
) -> tuple[Seaways, Seaways]:
    """Return the seaways for a draught [m], and those of which it closes nothing.

    Parameters
    ----------
    ends : Places of the way.
    closed, opened : Names of canals and passages; no draught closes an opened passage that is
        not for small ships alone.
    draught : None: not known.
    """
    every = Seaways.of_chart(chart, closed, opened=opened)
    if draught is None:
        return replace(every, shoals=_usual_shoals(chart, ends)), every
    return _seas_for_draught(every, draught, ends, opened), every


def opened_names(chart: Chart, names: Sequence[str]) -> tuple[str, ...]:
    """Return the names of passages to open.

    Parameters
    ----------
    names : As given; "all" stands for all that are for small or local ships.
    """
    given = (names,) if isinstance(names, str) else tuple(names)
    if not any(name.strip().casefold() == "all" for name in given):
        return given
    return tuple(sorted(small_passages(chart)))


def _seas_for_draught(
    seas: Seaways, draught: float, ends: Sequence[Endpoint], opened: Collection[str]
) -> Seaways:
    """Return the seaways for a draught [m]: what plans close and where a mile counts more."""
    if not (is_number(draught) and 0.0 < draught <= DEEPEST_DRAUGHT):
        raise InputError(
            f"The draught is {shortened_repr(draught)} m.",
            f"Draughts are above 0 and at most {DEEPEST_DRAUGHT:g} m.",
            "Correct it, or leave it out.",
            field="draught_m",
        )
    for canal in seas.chart.canals:
        if canal.name not in seas.canals and canal.transit_restriction(draught=draught, beam=None):
            seas = seas.without(canal.name)
    in_spite = [one for one in find_passages(opened) if one.use == "trade"]
    for passage in seas.chart.passages:
        if passage.name in {*seas.passages, *(one.name for one in in_spite)}:
            continue
        if passage.max_draught < draught:
            seas = seas.without(passage.name)
    shoals = shoals_of_draught(
        seas.chart, float(draught), float(draught), [(e.lat, e.lon) for e in ends]
    )
    lines = [one.line for one in in_spite]
    return replace(seas, shoals=shoals_open_beside(shoals, lines, draught))


def _usual_shoals(chart: Chart, ends: Sequence[Endpoint]) -> Shoals:
    """Return reefs and flats that ways keep off where no draught is given."""
    harbours = [(end.lat, end.lon) for end in ends]
    return shoals_of_draught(chart, USUAL_DEPTH / DRAUGHTS, LEAST_DEPTH, harbours)
