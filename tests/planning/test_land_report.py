"""Notes on passages that are closed to a ship."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from thalweg import Sea, Ship, evaluate
from thalweg.chart.passages import find_passages
from thalweg.planning.report.land_report import closed_passage_notes
from thalweg.planning.report.note_order import count_of_dangers

SHIP = Ship.simple(speed_kn=12.0, draught_m=9.5, length_m=190.0)
ALONG_NORWAY = [(58.0, 5.0), (62.5, 4.5), (67.0, 11.0), (70.0, 17.5), (71.3, 25.0), (70.8, 29.0)]


def notes_with_closed(*names: str) -> list[str]:
    route = evaluate(ALONG_NORWAY, ship=SHIP, sea=Sea.calm(), depart="2026-01-01T00:00Z")
    chart = SimpleNamespace(closed_passages=find_passages(names))
    context: Any = SimpleNamespace(voyage=SimpleNamespace(avoid=()), ship=SHIP, chart=chart)
    return closed_passage_notes(context, route)


def test_passages_closed_for_one_reason_share_a_note():
    """Hammerfest to Ventspils had 16 lines on leads for ships below 120 m."""
    (note,) = notes_with_closed("Naeroysund", "Stokksund", "Tjeldsund")
    assert note == (
        "Passages closed: Naeroysund, Stokksund and Tjeldsund: they are for ships below 120 m "
        "(--open NAME opens one)."
    )
    assert count_of_dangers([note]) == 1


def test_a_single_closed_passage_says_how_to_open_it():
    assert notes_with_closed("Tjeldsund") == [
        "Passage closed: Tjeldsund: it is for ships below 120 m (--open 'Tjeldsund' opens it)."
    ]
