"""The note of a plan on a shorter way over shoals."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from thalweg import Sea, Ship, Voyage, plan
from thalweg.chart.depth.shoals_of_draught import shoals_of_draught
from thalweg.planning.report.land_report import shoal_detour_notes_of_plan
from thalweg.planning.seaways import world_chart

INDIAN_OCEAN, YELLOW_SEA = (-38.0, 60.0), (36.0, 123.5)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("draught", "via", "miles"),
    [
        (14.1, (), 364),  # by Lombok: 6,236 nm against 5,871 by Sunda (`thalweg.distance`)
        (8.0, (), None),
        (14.1, ((-5.9, 105.9),), None),  # the user chose the way
    ],
)
def test_the_shorter_way_over_shoals_is_stated(draught, via, miles):
    chart = world_chart()
    ends = [INDIAN_OCEAN, YELLOW_SEA]
    shoals = shoals_of_draught(chart, draught, draught, ends)
    chart = replace(chart, zones=replace(chart.zones, shoals=shoals))
    context = SimpleNamespace(chart=chart, voyage=SimpleNamespace(via=via))
    lat, lon = np.array(ends).T
    route = SimpleNamespace(
        legs={"leg_kind": np.zeros(1, int), "length": np.full(1, 5900.0 * 1852.0)},
        track=SimpleNamespace(lat=lat, lon=lon),
        distance_nm=6000.0,
    )
    notes = shoal_detour_notes_of_plan(context, route)
    assert len(notes) == (miles is not None)
    for note in notes:
        assert note.startswith("Keeps off shoal water by the global depth layer")
        assert "over that water, by Sunda" in note and "--ignore-shoals" in note
        assert float(note.split(" nm shorter")[0].split()[-1]) == pytest.approx(miles, rel=0.03)


@pytest.mark.slow
def test_a_shorter_way_over_a_reef_is_stated_without_advice_to_sail_it():
    """Funafuti to Suva led over the Great Sea Reef."""
    coaster = Ship.simple(12.0, 5.5, length_m=88.0)
    found = plan(
        Voyage(start="Funafuti", goal="Suva", depart="2026-06-01"),
        ship=coaster,
        sea=Sea.calm(),
        proof=0.0,
    )
    assert 620.0 < found.best.distance_nm < 680.0
    (note,) = [note for note in found.notes if note.startswith("Keeps off shoal water")]
    assert "but crosses Great Sea Reef" in note and "--ignore-shoals" not in note


@pytest.mark.slow
def test_a_plan_of_150_miles_states_it_too():
    """Exuma to Nassau round Eleuthera, 151 nm, where yachts sail over the bank."""
    yacht = Ship.simple(8.0, 2.0, length_m=15.0)
    found = plan(
        Voyage(start=(24.2, -76.45), goal="Nassau", depart="2026-06-01"),
        ship=yacht,
        sea=Sea.calm(),
    )
    assert found.best.distance_nm > 120.0
    (note,) = [note for note in found.notes if "plan with --ignore-shoals" in note]
    assert 40 < int(note.partition("draught is ")[2].partition(" nm")[0]) < 90
