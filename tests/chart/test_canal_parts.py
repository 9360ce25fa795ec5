"""Ports on canals enter them on the way; legs along canals are recognised."""

from dataclasses import replace

import numpy as np
import pytest

from thalweg.chart.approaches import PORT_APPROACHES, place_along_line
from thalweg.chart.canal_parts import (
    canal_part,
    first_legs_of_transits,
    joints_to_canals,
    part_number_of_legs,
    ways_through_canals,
)
from thalweg.chart.canals import CANALS, KIEL, PANAMA, SUEZ
from thalweg.chart.ports import PORTS
from thalweg.core.geodesy import distance
from thalweg.core.units import NAUTICAL_MILE


def ways(name):
    return ways_through_canals(PORT_APPROACHES.of(PORTS.lookup(name)), CANALS)


@pytest.mark.parametrize(
    ("name", "canal", "end"),
    [
        ("Port Said", SUEZ, SUEZ.ends[1]),
        ("Suez", SUEZ, SUEZ.ends[0]),
        ("Balboa", PANAMA, PANAMA.ends[0]),
        ("Cristobal", PANAMA, PANAMA.ends[1]),
        ("Kiel", KIEL, KIEL.ends[0]),
        ("Brunsbuttel Canal Terminals", KIEL, KIEL.ends[1]),
    ],
)
def test_a_port_at_a_gate_has_a_way_through_the_canal(name, canal, end):
    (way,) = ways(name)
    assert way.through == canal.name
    assert way.sea_end == end
    assert way.way == f"through the {canal.title}"
    assert 0.7 * canal.length < way.through_length < canal.length
    assert way.through_time == pytest.approx(canal.transit_time * way.through_length / canal.length)
    assert way.duration(5.0) == pytest.approx(
        (way.length - way.through_length) / 5.0 + way.through_time
    )
    lat, lon = np.array(way.line, float).T
    number = part_number_of_legs(CANALS, lat, lon)
    assert first_legs_of_transits(number).sum() == 1
    length = distance(lat[:-1], lon[:-1], lat[1:], lon[1:])
    assert length[number >= 0].sum() == pytest.approx(way.through_length)
    joints = joints_to_canals(CANALS, PORT_APPROACHES, number, np.stack([lat, lon], axis=1))
    known = PORT_APPROACHES.legs(lat, lon) | (number >= 0)
    known[list(joints)] = True
    assert known.all()


def test_a_port_in_the_middle_leaves_by_both_ends_and_others_by_none():
    assert {way.sea_end for way in ways("Rendsburg")} == set(KIEL.ends)
    for name in ("Hamburg", "Alexandria, EG", "Santos"):
        assert ways(name) == ()


def test_a_whole_canal_is_no_part_and_places_off_its_line_are_on_none():
    lat, lon = np.array(SUEZ.ends).T
    assert part_number_of_legs(CANALS, lat, lon).tolist() == [-1]
    assert part_number_of_legs(CANALS, lat + 1.0, lon).tolist() == [-1]
    assert place_along_line(SUEZ.path, (30.0, 33.0)) is None
    first = distance(*SUEZ.path[0], *SUEZ.path[1])
    assert place_along_line(SUEZ.path, SUEZ.path[1]) == pytest.approx(first)


def test_a_part_has_its_share_of_the_time_and_the_dues_once():
    canal = replace(SUEZ, fee=1000.0, fee_basis="tons")
    first, second = (canal_part(canal, *canal.path[k : k + 2], pays=k == 1) for k in (1, 2))
    assert (first.fee, second.fee, second.fee_basis) == (1000.0, 0.0, "")
    assert first.length / first.transit_time == pytest.approx(canal.length / canal.transit_time)
    assert first.length / NAUTICAL_MILE == pytest.approx(22.9, abs=0.1)
    assert part_number_of_legs((canal,), *np.array(canal.path[1:4]).T).tolist() == [0, 0]
    assert first_legs_of_transits(np.array([-1, 0, 0, -1, 0])).tolist() == [
        False,
        True,
        False,
        False,
        True,
    ]
