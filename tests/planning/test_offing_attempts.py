"""What plans open where no route exists, and round which end."""

from __future__ import annotations

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.core.errors import NoPathError
from thalweg.core.limits import Limits
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.offing_attempts import plan_off_land
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.request.offing_choice import chart_off_land
from thalweg.planning.request.requirements import Requirements
from thalweg.planning.request.shoal_choice import SHOALS_OPENED, add_shoals, close_shoals
from thalweg.planning.request.voyage_endpoints import Endpoint

SHIP = Ship.simple(14.0, 9.0, length_m=180.0, breadth_m=30.0)
COLOMBO = Endpoint("Colombo", 6.97, 79.82, 0.0)
CHITTAGONG = Endpoint("Chittagong", 22.20, 91.70, 0.0)
INCHEON = Endpoint("Incheon", 37.4317, 126.5495, 0.0)
BUSAN = Endpoint("Busan", 35.0283, 129.0516, 0.0)
OFFING = 2.0 * NAUTICAL_MILE


@pytest.fixture(scope="module")
def world():
    return Chart.gshhg("i")


def voyage(ends):
    start, goal = ((end.lat, end.lon) for end in ends)
    return Voyage(start=start, goal=goal, depart="2026-06-01")


def attempts(world, ends, *errors, lengths=()):
    """Return the shoals that are open and the offing that is enough round ends, per attempt.

    ``lengths`` [nm] are of the first plans; those of others are 0.
    """
    chart, _ = add_shoals(world, voyage(ends), SHIP, Sea.calm(), ends)
    tries, left = [], list(errors)

    def run(tried):
        closed = tried.chart.zones.closed_shoals
        opened = {}
        for end in ends:
            place = end.lat, end.lon
            discs = () if closed is None else closed.discs
            near = [
                disc.radius for disc in tried.chart.offing.discs if (disc.lat, disc.lon) == place
            ]
            opened[end.name] = (
                next((disc[2] / NAUTICAL_MILE for disc in discs if disc[:2] == place), np.inf),
                max(near, default=0.0) / NAUTICAL_MILE,
            )
        tries.append(opened)
        if left:
            raise NoPathError("No way.", nearest=left.pop(0))
        return tried

    needs = Requirements((), Limits(), (), np.inf)
    context = PlanningContext(voyage(ends), SHIP, Sea.calm(), chart, needs, None, None)
    by_plan, left_lengths = {}, list(lengths)

    def length_of(planned):
        if id(planned) not in by_plan:
            by_plan[id(planned)] = left_lengths.pop(0) if left_lengths else 0.0
        return by_plan[id(planned)] * NAUTICAL_MILE

    return tries, plan_off_land(context, ends, OFFING, run, length_of=length_of).needs.notes


@pytest.mark.slow
def test_shoals_open_round_the_end_that_no_water_leads_to(world):
    """The bar off Chittagong opened the reefs of the Red Sea and of Ceylon as well."""
    tries, notes = attempts(world, [COLOMBO, CHITTAGONG], (20.9, 91.5), (20.0, 91.5))
    assert [one["Colombo"][0] for one in tries] == [8.0, 8.0, 8.0]
    assert [one["Chittagong"][0] for one in tries][1:] == [100.0, 250.0]
    (note,) = [note for note in notes if note.startswith(SHOALS_OPENED)]
    assert "within 250 nm of Chittagong:" in note
    assert any(note.startswith("Closed: named shoal areas, and water") for note in notes)


def test_shoals_open_everywhere_where_the_way_ends_between(world):
    tries, notes = attempts(world, [COLOMBO, CHITTAGONG], (14.0, 86.0))
    assert [one["Colombo"][0] for one in tries] == [8.0, 0.0]
    assert any(note.startswith(f"{SHOALS_OPENED}, but for named areas of exact") for note in notes)


@pytest.mark.slow
def test_named_areas_of_exact_outline_open_last(world):
    tries, notes = attempts(world, [COLOMBO, CHITTAGONG], *10 * [(14.0, 86.0)])
    radii = [one["Colombo"][0] for one in tries]
    assert radii[:2] == [8.0, 0.0] and radii[-1] == np.inf
    assert set(radii[1:-1]) == {0.0}  # nearer and nearer to land
    assert any(note.startswith(f"{SHOALS_OPENED}: with that water") for note in notes)


@pytest.mark.slow
def test_the_distance_from_land_is_smaller_only_round_the_end_that_needs_it(world):
    """Busan was left at half a mile, at 20 kn, and shoals were open, because of Incheon."""
    ends = [INCHEON, BUSAN]
    chart, _ = add_shoals(world, voyage(ends), SHIP, Sea.calm(), ends)
    _, note, enclosed = close_shoals(chart_off_land(chart, ends, OFFING), ends)
    assert (note, enclosed) == ("", (0,))
    tries, notes = attempts(world, ends)
    (opened,) = tries
    assert opened["Incheon"][1] == 15.0 and opened["Busan"][1] < 15.0
    assert all(np.isfinite(shoals) for shoals, _ in opened.values())
    assert not any(note.startswith(SHOALS_OPENED) for note in notes)


@pytest.mark.parametrize(("second", "opened"), [(1900.0, True), (9500.0, False)])
def test_a_way_far_round_the_shoals_gives_way_to_a_shorter_one_over_them(world, second, opened):
    """Jakarta - Panjang was planned by Lombok, 1,342 nm for 136: flats near both ends."""
    tries, notes = attempts(world, [COLOMBO, CHITTAGONG], lengths=(9000.0, second))
    assert [one["Colombo"][0] for one in tries] == [8.0, 0.0]
    found = [note for note in notes if note.startswith(SHOALS_OPENED)]
    assert bool(found) == opened
    assert all("with that water closed the route is 7" in note for note in found)


@pytest.mark.slow
def test_a_plan_much_longer_than_the_straight_line_states_that_narrow_channels_are_closed(world):
    """Hanko - Rauma was 219 nm for 90 without a word, where the sea distance had a note."""
    found = plan(
        Voyage(start=(25.30, 56.60), goal=(25.42, 55.35), depart="2026-06-01"),
        ship=SHIP,
        sea=Sea.calm(),
        chart=world,
        resolution=10_000.0,
        proof=0.0,
    )
    (note,) = [one for one in found.notes if "in a straight line" in one]
    assert note.startswith(f"{found.best.distance_nm:.0f} nm by sea for 68 nm in a straight line")
