"""Reefs and banks beside channels, closed to ships of any draught; the channels stay open."""

from __future__ import annotations

import numpy as np
import pytest

from thalweg.chart.approaches import PORT_APPROACHES
from thalweg.chart.depth.closed_shoals import ClosedShoals, closing_depth_of_areas
from thalweg.chart.depth.shoal_areas import SHOAL_AREAS
from thalweg.chart.depth.shoals import Shoals
from thalweg.chart.passages import PASSAGES, find_passages
from thalweg.chart.ports import PORTS
from thalweg.core.geodesy import densify, distance
from thalweg.core.units import KNOT, NAUTICAL_MILE

#: General knowledge, unchecked: positions on reefs and banks, and beside them in channels.
REEFS = {
    "Violet Bank": [
        (49.158, -2.006),
        (49.149, -2.043),
        (49.160, -2.070),
    ],  # Seymour, Icho, Green I.
    "Ecrehous": [(49.289, -1.927)],
    "Shingles": [(50.680, -1.602), (50.695, -1.580)],
    "Anchor Cay": [(-9.36, 144.12), (-9.39, 144.22)],
    "Bajo Serpiente": [(21.43, -90.47)],
    "Banco Chinchorro": [(18.58, -87.33)],
}
CHANNELS = [
    (49.150, -2.106),  # Demie de Pas
    (49.130, -1.951),  # Violet Channel
    (49.160, -1.960),
    (50.660, -1.615),  # Bridge
    (50.673, -1.600),  # Shingles Elbow
    (50.687, -1.578),  # Mid Shingles
    (50.699, -1.557),  # NE Shingles
    (50.712, -1.592),  # North Head
    (-9.20, 144.05),  # Bligh Entrance
    (-9.14, 143.87),  # Bramble Cay
]


def columns(places):
    return np.array(places, float).T


def area_named(name):
    (area,) = (area for area in SHOAL_AREAS if area.name.startswith(name))
    return area


def sampled(line):
    return densify(*columns(line), 0.05 * NAUTICAL_MILE)[:2]


@pytest.mark.parametrize("name", REEFS)
def test_reefs_are_named_areas(name):
    """Small craft and deep ships were led over them."""
    assert area_named(name).contains(*columns(REEFS[name])).all()


def test_buoys_and_marks_of_channels_are_outside_the_areas():
    """The areas leave the channels beside them open."""
    for name in REEFS:
        assert not area_named(name).contains(*columns(CHANNELS)).any(), name


@pytest.mark.parametrize(
    ("required", "depth"), [(2.0, 1.0), (1.0, 0.5), (3.0, 1.5), (9.5, 7.5), (20.0, 16.0)]
)
def test_named_areas_close_below_half_of_what_is_required(required, depth):
    """Drying areas were open to ships that require 2 m or less."""
    assert closing_depth_of_areas(required) == pytest.approx(depth)


def test_drying_areas_are_closed_to_yachts_where_the_layer_closes_nothing():
    """A depth of 0 gave no shapes."""
    yacht = ClosedShoals(0.0, area_depth=1.0)
    assert yacht.contains(*columns(REEFS["Ecrehous"])).all()
    # outlines that are not exact have the inshore ways of small craft inside, as the Chenal du Four
    assert not yacht.contains(*columns([(14.35, -80.275), (48.40, -4.80)])).any()
    there = ClosedShoals(0.0, area_depth=1.0, box=(45.0, 55.0, -6.0, 2.0))
    elsewhere = ClosedShoals(0.0, area_depth=1.0, box=(-40.0, -30.0, 150.0, 160.0))
    assert there.contains(*columns(REEFS["Ecrehous"])).all() and not elsewhere.shapes
    assert not yacht.contains(*columns([(41.45, -70.3)])).any()  # Nantucket Sound, 6 m
    assert not yacht.contains(*columns([(53.0, 2.0)])).any()  # Norfolk banks, 4 m
    assert not ClosedShoals(0.0).shapes
    assert yacht.text() != ClosedShoals(0.0).text()


def test_areas_of_exact_outline_stay_closed_beside_channels_and_round_ports():
    """A channel opened a mile and a half on both sides, which is all of the Shingles."""
    (needles,) = find_passages(["Solent (Needles)"])
    disc = (50.758, -1.53, 8.0 * NAUTICAL_MILE)  # Lymington
    closed = ClosedShoals(0.0, (needles.line,), (disc,), area_depth=1.0)
    assert closed.contains(*columns(REEFS["Shingles"])).all()
    assert not closed.contains(*sampled(needles.line)).any()
    other = ClosedShoals(0.0, (), ((18.58, -87.15, 20.0 * NAUTICAL_MILE),), area_depth=1.0)
    assert not other.contains(*columns(REEFS["Banco Chinchorro"])).any()  # not exact
    inside = ClosedShoals(0.0, (), ((50.680, -1.602, 100.0),), area_depth=1.0)
    assert not inside.contains(*columns(REEFS["Shingles"])).any()


def test_the_needles_channel_is_between_the_bridge_and_the_shingles():
    """The line of the passage crossed the bank."""
    (needles,) = find_passages(["Solent (Needles)"])
    lat, lon = sampled(needles.line)
    assert not area_named("Shingles").contains(lat, lon).any()
    for mark in ((50.660, -1.615), (50.673, -1.600), (50.687, -1.578), (50.699, -1.557)):
        assert 0.05 < distance(*mark, lat, lon).min() / NAUTICAL_MILE < 0.35


@pytest.mark.parametrize("port", ["GBYMO", "GBLYM", "JESTH"])
def test_ports_behind_reefs_are_reached_by_their_channels(port):
    """The line of Yarmouth crossed the Shingles; Lymington was not known."""
    lat, lon = sampled(PORT_APPROACHES.of(PORTS.lookup(port)).line)
    for name in REEFS:
        assert not area_named(name).contains(lat, lon).any()
    assert distance(49.150, -2.103, lat, lon).min() > 0.4 * NAUTICAL_MILE  # Demie de Pas


# General knowledge, unchecked.
ROCKS = {
    "La Hague lighthouse": (49.7217, -1.9550),
    "Lismore light": (56.4556, -5.6069),
    "Seymour Tower": (49.158, -2.006),
    "Icho Tower": (49.149, -2.043),
    "Demie de Pas": (49.150, -2.103),
    "Ortac": (49.723, -2.291),
    "Les Hanois": (49.435, -2.7025),
}


@pytest.mark.parametrize("name", ROCKS)
def test_lighthouses_on_rocks_are_land(world, name):
    """Ships passed over them: no land within 0.2 to 1.3 nm."""
    assert world.coastline.shore_distance(*ROCKS[name]) < 100.0


@pytest.mark.slow
def test_the_great_north_east_channel_ends_in_bligh_entrance():
    """The line ended in the middle of the strait; ships left between Anchor Cay and East Cay."""
    (channel,) = find_passages(["Torres: Great North"])
    lat, lon = sampled(channel.line)
    assert lon[-1] == pytest.approx(144.05)
    for cay in ((-9.14, 143.87), (-9.36, 144.12)):  # Bramble Cay, Anchor Cay
        assert distance(*cay, lat, lon).min() > 6.0 * NAUTICAL_MILE
    assert ClosedShoals(9.0, (channel.line,)).contains(*columns([(-9.37, 144.17)])).all()


def test_the_sound_of_mull_is_entered_west_of_ladys_rock():
    """The line passed 0.1 nm from the rock, which the chart lacked."""
    (sound,) = find_passages(["Sound of Mull"])
    assert distance(56.4483, -5.6163, *sampled(sound.line)).min() > 0.4 * NAUTICAL_MILE


@pytest.mark.parametrize(
    ("name", "code"), [("Sorong", "IDSOQ"), ("Lymington", "GBLYM"), ("Norderney", "DENRD")]
)
def test_ports_that_were_unknown_are_found(name, code):
    """Only "Tg. Sorong" was in the table, and not the other two."""
    port = PORTS.lookup(name)
    assert port.locode == code
    line = PORT_APPROACHES.of(port)
    assert 4.0 < line.length / NAUTICAL_MILE < 11.0


def test_lagos_in_portugal_is_a_small_harbour():
    """The World Port Index calls it large, so that "Lagos" named two ports of one rank."""
    assert PORTS.lookup("PTLOS").size == "small"
    assert PORTS.lookup("Lagos").locode == "NGLOS"


def test_speed_limits_of_passages_are_in_the_table():
    """There was no column for them."""
    limits = {one.name: one.max_speed for one in PASSAGES if one.max_speed is not None}
    knots = {name: round(limit / KNOT, 6) for name, limit in limits.items()}
    assert knots == {
        "Bosporus": 10.0,
        "Dardanelles": 10.0,
        "Bisan Seto": 12.0,
        "Uraga (Tokyo Bay)": 12.0,
    }


def test_areas_of_exact_outline_do_not_make_the_channels_beside_them_shoal():
    """A point of the depth layer stands for six miles: yachts to Granville went round Minquiers."""
    shoals = Shoals(5.0, 1.6)
    assert shoals.excess(49.15, -1.96, 49.20, -1.96) < 1.0  # Violet Channel
    assert shoals.excess(50.64, -1.645, 50.70, -1.55) < 1.0  # Needles Channel
    assert shoals.excess(14.35, -80.30, 14.35, -80.25) > 5.0  # Serrana bank
