"""The offing: no point of an allowed leg is nearer to land than required."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from thalweg.chart import Chart
from thalweg.chart.offing import OffingDisc, chart_with_offing, disc_at
from thalweg.chart.passages import PASSAGES, Passage, find_passages
from thalweg.core.errors import InputError
from thalweg.core.geodesy import densify, direct, distance
from thalweg.kernels.codes import LAND, NO_GO, OFFING, OK

NM = 1852.0
SQUARE = {
    "type": "Polygon",
    "coordinates": [[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]]],
}


@pytest.fixture(scope="module")
def island():
    return Chart.from_geojson(SQUARE)


def legs_around(count, seed=3):
    rng = np.random.default_rng(seed)
    return rng.uniform(-0.5, 1.5, (4, count))


def least_distance(chart, leg, offing):
    """Return the distance of a leg from land [m], to 10 m where it is not far above the offing."""
    for step in (400.0, 20.0):
        lat, lon, _ = densify([leg[0], leg[2]], [leg[1], leg[3]], step)
        least = float(chart.coastline.shore_distance(lat, lon).min())
        if least == 0.0 or least > 1.2 * offing:
            break
    return least


@pytest.mark.slow
def test_legs_keep_the_offing_to_one_per_cent(island):
    offing = 2.0 * NM
    legs = legs_around(3000)
    status = island.with_offing(offing).leg_status(*legs)
    least = np.array([least_distance(island, leg, offing) for leg in legs.T])
    assert least[status == OK].min() >= 0.99 * offing
    assert least[status == OFFING].max() <= 1.01 * offing
    assert set(np.unique(status)) == {OK, OFFING, LAND}
    assert least[status == LAND].max() == 0.0
    near = np.abs(least - offing) < 0.1 * offing
    assert near.sum() > 10  # the test has legs near the limit


def test_no_offing_changes_nothing(island):
    legs = legs_around(500)
    assert (island.with_offing(0.0).leg_status(*legs) == island.leg_status(*legs)).all()
    assert LAND in island.leg_status(*legs)


def test_positions_near_land_are_closed(island):
    off = island.with_offing(2.0 * NM)
    lat, lon = direct(0.5, 0.0, -np.pi / 2.0, np.array([1.9, 2.1]) * NM)
    assert off.is_navigable(lat, lon).tolist() == [False, True]
    assert off.sea_room(lat, lon, cap=5e3) == pytest.approx([0.0, 0.1 * NM], abs=30.0)


def test_long_legs_past_a_coast(world):
    off = world.with_offing(2.0 * NM)
    # 1.2 nm and 3 nm south of Dondra Head, along the parallel by short legs
    south = 5.9167 - np.array([1.2, 3.0]) / 60.0
    lon = np.linspace(80.3, 80.9, 7)
    for lat, open_ in zip(south, (False, True)):
        free = ~off.legs_blocked(lat, lon[:-1], lat, lon[1:])
        assert free.all() == open_


def test_a_disc_allows_an_end_near_land(island):
    end = (0.5, -0.5 / 60.0)
    out = (0.5, -10.0 / 60.0)
    off = island.with_offing(2.0 * NM)
    assert off.legs_blocked(*end, *out)
    eased = island.with_offing(2.0 * NM, discs=[OffingDisc(*end, 0.45 * NM)])
    assert not eased.legs_blocked(*end, *out)
    along = direct(*end, 0.0, 8.0 * NM)  # along the shore: the disc is left too near to land
    assert eased.legs_blocked(*end, *along)


STRAIT = [
    {
        "type": "Polygon",
        "coordinates": [[[x, -1.0], [x + 1.0, -1.0], [x + 1.0, 1.0], [x, 1.0], [x, -1.0]]],
    }
    for x in (-1.0 - 0.8 / 60.0, 0.8 / 60.0)
]


@pytest.fixture(scope="module")
def strait():
    land = {
        "type": "FeatureCollection",
        "features": [{"type": "Feature", "properties": {}, "geometry": g} for g in STRAIT],
    }
    return Chart.from_geojson(land)


def test_only_a_named_passage_leads_through_a_narrow(strait):
    from dataclasses import replace

    line = Passage("Test Narrows", "trade", ((1.2, 0.0), (-1.2, 0.0)), 0.8 * NM)
    off = strait.with_offing(2.0 * NM)
    named = replace(strait, passages=(line,)).with_offing(2.0 * NM)
    middle = (1.1, 0.0, -1.1, 0.0)
    assert off.legs_blocked(*middle)
    assert not named.legs_blocked(*middle)
    # nine tenths of the distance of the line from land are required inside
    side = 0.3 / 60.0
    assert named.legs_blocked(1.1, side, -1.1, side)
    assert not named.legs_blocked(1.1, 0.05 / 60.0, -1.1, 0.05 / 60.0)


def test_a_closed_passage_is_not_crossed_at_any_offing(world):
    west, east = (35.95, -6.2), (36.05, -4.9)
    through = [(35.95, -6.2), (35.93, -5.6), (36.05, -4.9)]
    legs = np.array([[*a, *b] for a, b in itertools.pairwise(through)]).T
    for offing in (0.0, 1.0 * NM):
        free = world.with_offing(offing)
        assert not free.legs_blocked(*legs).any()
        closed = free.without_passages("Gibraltar")
        assert NO_GO in closed.leg_status(*legs)
    assert float(distance(*west, *east)) > 0.0


def test_a_closed_narrow_passage_is_not_crossed_where_a_voyage_ends_beside_it(world):
    """A disc round the end lets ships come nearer to land; the line across stays closed."""
    leg = (1.1842, 103.9741, 1.2743, 104.1666)
    disc = disc_at(world.coastline, leg[:2], radius=20.0 * NM)
    near = chart_with_offing(world, 2.0 * NM, discs=(disc,))
    assert not near.legs_blocked(*leg)
    closed = near.without_passages("Singapore Main Strait")
    assert closed.leg_status(*leg) == NO_GO


def test_closing_lines_run_from_land_to_land(world):
    from thalweg.chart.offing import closing_line

    for name in ("Bosporus", "Dover", "Gibraltar", "Great Belt", "Hormuz", "Magellan", "Oresund"):
        passage = find_passages([name])[0]
        ends = np.array(closing_line(world.coastline, passage))
        assert (world.coastline.shore_distance(*ends.T) == 0.0).all(), name
        assert float(distance(*ends[0], *ends[1])) < 130e3


def test_lines_of_passages_are_water_in_the_usual_chart(world):
    for passage in world.passages:
        lat, lon = np.array(passage.line).T
        status = world.leg_status(lat[:-1], lon[:-1], lat[1:], lon[1:])
        assert (status == OK).all(), passage.name


@pytest.mark.parametrize("offing_nm", [0.5, 2.0])
def test_lines_of_passages_are_open_at_an_offing(world, offing_nm):
    """The line of Ramsund is 0.01 nm off land: between samples it may be nearer than at them."""
    off_land = world.with_offing(offing_nm * NM)
    for passage in world.passages:
        lat, lon = np.array(passage.line).T
        assert not off_land.legs_blocked(lat[:-1], lon[:-1], lat[1:], lon[1:]).any(), passage.name


def test_narrows_that_no_ship_passes_are_closed(world):
    legs = {
        "Menai": (53.2300, -4.1500, 53.2100, -4.2000),
        "Haringvliet": (51.8550, 3.9500, 51.8150, 4.1500),
        "Skye Bridge": (57.2830, -5.7800, 57.2770, -5.6900),
        "Afsluitdijk": (53.0200, 5.0800, 52.9500, 5.2500),
        "Naruto": (34.3000, 134.6300, 34.2000, 134.7000),
        "Johor": (1.4700, 103.7300, 1.4400, 103.8000),
    }
    for name, leg in legs.items():
        assert world.legs_blocked(*leg), name


def test_passages_have_limits_and_uses():
    oresund, raftsund, menai = find_passages(["oresund", "Raftsund", "Menai Strait"])
    assert oresund.ship_restriction(draught=7.5, length=200.0) == ""
    assert "draught of 9.5 m" in oresund.ship_restriction(draught=9.5, length=200.0)
    assert "below 120 m" in raftsund.ship_restriction(length=180.0)
    assert raftsund.ship_restriction(length=80.0) == ""
    assert "closed to ships" in menai.ship_restriction(length=10.0)
    assert oresund.limits == "draught 7.7 m"
    assert len({passage.name for passage in PASSAGES}) == len(PASSAGES) >= 121


def test_names_of_passages_are_found_or_similar_ones_named():
    assert find_passages(["great belt"])[0].name == "Great Belt (Route T)"
    assert find_passages(["strait of hormuz", "Dover Strait"])[1].name == "Dover"
    with pytest.raises(InputError, match="Bosporus"):
        find_passages(["Bosphorus"])
    with pytest.raises(InputError):
        find_passages(["torres"])  # two


def test_an_offing_that_is_not_possible_is_refused(island):
    for value in (-1.0, float("nan"), 200e3):
        with pytest.raises(InputError, match="not possible"):
            island.with_offing(value)
