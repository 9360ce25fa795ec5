"""Checks of the places, canals and passages of a voyage by their names, without a chart."""

from __future__ import annotations

from thalweg.chart.canals import CANALS, exclude_canals
from thalweg.chart.passages import find_passages, split_avoided
from thalweg.chart.ports import PORTS, Port
from thalweg.core.errors import InputError, errors_about
from thalweg.core.geodesy import Position, parse_position
from thalweg.planning.voyage import Voyage
from thalweg.planning.voyage_parts import Place


def check_itinerary(voyage: Voyage) -> None:
    """Check the places, canals and passages of a voyage by their names.

    Raises
    ------
    InputError
        For a port, canal or passage that is not known (with near matches), and for two places in
        succession that are the same; with the entry in ``details["field"]``.
    """
    places = [("start", voyage.start)]
    places += [(f"via.{i}", place) for i, place in enumerate(voyage.via)]
    places += [("goal", voyage.goal)]
    found = [_found_place(place, field) for field, place in places]
    for (field, place), before, here in zip(places[1:], found, found[1:]):
        if before == here:
            raise InputError(
                f"The voyage goes from {place} to {place}: start, via points and goal that follow "
                "each other are the same place.",
                "Two places in succession are at least 1 m apart.",
                "Choose two different places.",
                field=field,
            )
    for field, check in (
        ("forbid", lambda: exclude_canals(CANALS, voyage.forbid)),
        ("open", lambda: find_passages(voyage.open)),
        ("avoid", lambda: split_avoided(voyage.avoid)),
    ):
        with errors_about(field):
            check()


def _found_place(place: Place, field: str) -> Position | Port:
    """Return the position or the port of an entry of a voyage."""
    if not isinstance(place, str):
        return round(place[0], 5), round(place[1], 5)
    with errors_about(field):
        position = parse_position(place)
        if position is None:
            return PORTS.lookup(place)
    return round(position[0], 5), round(position[1], 5)
