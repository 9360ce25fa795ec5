"""Notes on the nearest land, at sea and in approaches, and on passages closed to a ship."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, Voyage, evaluate
from thalweg.chart.passages import Passage
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.report.distance_report import offing_detour_notes
from thalweg.planning.report.land_report import (
    closed_passage_notes,
    coasting_notes,
    nearest_land_notes,
    unknown_stream_notes,
)
from thalweg.planning.report.note_order import count_of_dangers
from thalweg.planning.request.chart_restrictions import exclude_closed_canals
from thalweg.planning.request.offing_choice import restrict_passages
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.seaways import path_length_and_canals
from thalweg.route.indicator_columns import indicator_value
from thalweg.route.route_tables import LEG_KINDS
from thalweg.sea.standard_names import CURRENT

TANKER = Ship.load("kvlcc2")  # draught 20.8 m
BULKER = Ship.simple(speed_kn=12.0, draught_m=9.5, length_m=190.0)
CAPESIZE = Ship.simple(speed_kn=13.0, draught_m=15.5, length_m=230.0)
BY_GOOD_HOPE = [
    (34.9, 139.8), (-8.0, 105.0), (-35.5, 20.0), (10.0, -40.0), (40.4, -73.7)
]  # fmt: skip
BY_LOMBOK = [
    (26.8, 50.3), (25.0, 57.0), (5.5, 80.0), (-9.5, 115.7), (1.0, 119.0), (5.0, 119.5),
    (13.0, 120.0), (30.3, 122.5),
]  # fmt: skip
ROUND_VANCOUVER_ISLAND = [(49.3, -123.6), (48.3, -124.8), (51.0, -130.0), (54.3, -133.0)]
ALONG_NORWAY = [(58.0, 5.0), (62.5, 4.5), (67.0, 11.0), (70.0, 17.5), (71.3, 25.0), (70.8, 29.0)]


@pytest.fixture(scope="module")
def world():
    return Chart.gshhg("i")


def notes_on(
    chart: Chart, ship: Ship, places: list[tuple[float, float]], avoid: tuple[str, ...] = ()
) -> list[str]:
    voyage = Voyage(start=places[0], goal=places[-1], depart=0.0, avoid=avoid)
    lat, lon = zip(*places)
    route: Any = SimpleNamespace(track=SimpleNamespace(lat=lat, lon=lon))
    ends = [Endpoint("", *place, 0.0) for place in (places[0], places[-1])]
    closed = restrict_passages(chart, voyage, ship, offing=3704.0)
    closed, canals = exclude_closed_canals(closed, voyage, ship, ends)
    context: Any = SimpleNamespace(
        voyage=voyage, ship=ship, chart=closed, needs=SimpleNamespace(notes=canals)
    )
    return closed_passage_notes(context, route)


@pytest.mark.slow
def test_passages_of_the_way_that_a_draught_closes_share_a_note(world):
    """Surabaya, Badung Strait and Alas were named, beside the route by Lombok, and not Malacca."""
    (note,) = notes_on(world, TANKER, BY_LOMBOK)
    assert note == (
        "Passages closed: Malacca: One Fathom Bank, Malacca-Singapore west, Singapore Main Strait "
        "and Horsburgh (Middle Channel): the draught of 20.8 m is over the 20.5 m allowed (--open "
        "NAME opens one). The way through is about 1,171 nm shorter."
    )
    assert count_of_dangers([note]) == 1


def test_passages_that_the_voyage_avoids_are_not_named(world):
    avoid = ("Malacca: One Fathom Bank", "Malacca-Singapore west", "Singapore Main Strait")
    assert not any("Malacca" in note for note in notes_on(world, TANKER, BY_LOMBOK, avoid))


def test_a_single_closed_passage_says_how_to_open_it(world):
    assert notes_on(world, BULKER, ROUND_VANCOUVER_ISLAND) == [
        "Passage closed: Johnstone and Seymour Narrows: it is for ships below 120 m (--open "
        "'Johnstone and Seymour Narrows' opens it). The way through is about 129 nm shorter."
    ]


@pytest.mark.slow
def test_a_canal_that_is_far_from_the_straight_line_is_named(world):
    """Nothing said why Yokohama to New York led by Good Hope, as only straight lines counted."""
    (note,) = notes_on(world, CAPESIZE, BY_GOOD_HOPE)
    words, _, miles = note.removesuffix(" nm shorter.").rpartition(" ")
    assert words == (
        "Passage closed: Panama Canal: the draught of 15.5 m is over the 15.24 m allowed. The way "
        "through is about"
    )
    assert float(miles.replace(",", "")) == pytest.approx(3306.0, abs=5.0)
    assert notes_on(world, CAPESIZE, BY_GOOD_HOPE, avoid=("panama",)) == []


def test_a_canal_of_which_the_request_has_a_note_has_no_second_one(world):
    by_the_skaw = [(54.0, 8.0), (57.9, 10.7), (54.7, 18.8)]
    assert not any("Kiel" in note for note in notes_on(world, CAPESIZE, by_the_skaw))


def test_closed_passages_beside_a_way_that_is_as_short_are_not_named(world):
    """Straight lines from an outer route through the leads of Norway cross land."""
    assert notes_on(world, BULKER, ALONG_NORWAY) == []


def test_the_nearest_land_at_sea_is_the_figure_of_the_table():
    """Rotterdam to Gdynia was 0.5 nm off land in the table and 0.0 nm in a note on the approach."""
    ring = [[0.0, 0.02], [0.1, 0.02], [0.1, 0.1], [0.0, 0.1], [0.0, 0.02]]
    islet = [[0.5, 0.05], [0.6, 0.05], [0.6, 0.1], [0.5, 0.1], [0.5, 0.05]]
    land = {"type": "MultiPolygon", "coordinates": [[ring], [islet]]}
    chart = Chart.from_geojson(land)
    places = [(0.017, -0.1), (0.017, 0.2), (0.0, 0.4), (0.0, 0.8)]
    plain = evaluate(places, ship=BULKER, sea=Sea.calm(), chart=chart, depart="2026-01-01T00:00Z")
    (note,) = nearest_land_notes(chart, plain)
    assert note.startswith("Close to land: 0.2 nm off at sea, from 0.0170N")
    kind = np.array([LEG_KINDS.index("approach"), 0, 0], float)
    route = replace(plain, legs={**plain.legs, "leg_kind": kind})
    near, at_sea = nearest_land_notes(chart, route)
    assert near.startswith("Close to land: 0.2 nm off in the approach of a port, from 0.0170N")
    assert at_sea.startswith("Nearest land: 3.0 nm off at sea, from 0.0000N")
    assert indicator_value(route, "land_distance_nm") == pytest.approx(3.0, abs=0.05)
    line = ((0.017, -0.1), (0.017, 0.2))
    strait = Passage(
        "Narrow Strait", "trade", line, 370.0, closing_line=((0.02, 0.05), (0.01, 0.05))
    )
    (inside,) = nearest_land_notes(replace(chart, passages=(strait,)), plain)
    assert inside.startswith("Close to land: 0.2 nm off in a passage (Narrow Strait), from 0.0170N")
    farther = replace(plain, legs={**plain.legs, "leg_kind": kind[::-1]})
    assert "approach" not in nearest_land_notes(chart, farther)[0]


PONDOLAND_TO_AGULHAS = [(-29.0, 32.4), (-31.31, 30.08), (-32.8, 28.6), (-35.3, 20.0), (-36.0, 15.0)]


@pytest.mark.parametrize(("ship", "stated"), [(TANKER, True), (BULKER, False)])
def test_a_large_ship_along_an_open_coast_is_stated(world, ship, stated):
    route = evaluate(
        PONDOLAND_TO_AGULHAS, ship=ship, sea=Sea.calm(), chart=world, depart="2026-01-01"
    )
    notes = coasting_notes(world, route, ship)
    assert len(notes) == stated
    for note in notes:
        assert note.startswith("Runs along a coast for ")
        assert "--offing" in note and count_of_dangers([note]) == 1


def test_a_large_ship_off_the_coast_has_no_such_note(world):
    off = [(-29.0, 34.0), (-33.0, 31.0), (-36.0, 22.0), (-36.0, 15.0)]
    route = evaluate(off, ship=TANKER, sea=Sea.calm(), chart=world, depart="2026-01-01")
    assert coasting_notes(world, route, TANKER) == []


@pytest.mark.parametrize(("currents", "stated"), [(False, True), (True, False)])
def test_a_passage_with_strong_streams_is_stated_where_no_current_is_known(world, currents, stated):
    functions = {name: lambda t, y, x: 0.1 + 0.0 * t for name in CURRENT.pair}
    sea = Sea.from_functions(functions) if currents else Sea.calm()
    route = evaluate(
        [(58.66, -2.7), (58.70, -3.1), (58.69, -3.6)],
        ship=BULKER, sea=sea, chart=world, depart="2026-01-01",
    )  # fmt: skip
    notes = unknown_stream_notes(world, route, sea)
    assert len(notes) == stated
    for note in notes:
        assert "Pentland Firth has tidal streams to 12 kn" in note
        assert count_of_dangers([note]) == 1


def test_a_way_that_the_offing_closes_is_stated_with_its_place():
    """Massawa to Hodeidah for a large ship was led 54 nm round, and the plan gave no reason."""
    chart = replace(Chart.gshhg("l"), passages=())
    ends = Endpoint("", 15.62, 39.56, 0.0), Endpoint("", 14.95, 42.88, 0.0)
    by_channel = [(15.62, 39.56), (15.606, 39.775), (15.3, 40.21), (15.07, 41.87), (14.95, 42.88)]
    north_about = [(15.62, 39.56), (16.39, 40.0), (16.4, 40.42), (14.95, 42.88)]
    asked = []

    def path(*_ends, offing):
        asked.append(offing)
        return by_channel if offing < 1.6 * NAUTICAL_MILE else north_about

    seas = SimpleNamespace(chart=chart, graph_path=lambda *_ends: by_channel, path=path)
    length = path_length_and_canals(chart, north_about)[0]
    offing = 2.0 * NAUTICAL_MILE
    (note,) = offing_detour_notes(seas, ends, length, offing)
    assert asked == [1.5 * NAUTICAL_MILE]
    shorter = (length - path_length_and_canals(chart, by_channel)[0]) / NAUTICAL_MILE
    assert (
        f"Keeps off land: a way about {shorter:.0f} nm shorter leads through water 1.4 nm" in note
    )
    assert "at 15 31.7N 039 53.2E" in note and "--offing 1.5" in note
    assert offing_detour_notes(seas, ends, length, 0.0) == []
    assert offing_detour_notes(seas, ends, 1.02 * length - 50.0 * NAUTICAL_MILE, offing) == []
