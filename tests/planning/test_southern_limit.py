"""How far south voyages go by default."""

import pytest

from thalweg.planning.network_selection.southern_limit import southern_limit
from thalweg.planning.request.voyage_endpoints import resolve_places
from thalweg.planning.sea_distance import sea_distance
from thalweg.planning.seaways import Seaways, world_chart


@pytest.mark.parametrize(
    ("start", "goal", "via", "limit"),
    [
        ("Paranagua", "CNBYQ", (), -50.0),  # 60 S on the great circle to the Sunda Strait
        ("Paranagua", "CNBYQ", ((-55.0, 30.0),), -60.0),  # the wish of the user
        ("Santos", "Valparaiso", (), -60.0),  # round Cape Horn or by Magellan
        ("Lyttelton", "Montevideo", (), -57.5),  # several days along 60 S
        ("Melbourne", "Valparaiso", (), -50.0),
        ("Cape Town", "Durban", (), -60.0),  # never so far south
        ("Rotterdam", "New York", (), -60.0),
    ],
)
def test_the_limit_of_voyages(start, goal, via, limit):
    chart = world_chart()
    ends = resolve_places(start, via, goal, chart)
    found, notes = southern_limit(ends, lambda: Seaways.of_ship_chart(chart), -60.0)
    assert found == limit
    assert len(notes) == (limit > -60.0)
    for note in notes:
        assert note.startswith(f"Water south of {-limit:g} S is left out: the shortest way goes")


def test_seas_are_not_read_for_voyages_in_the_north():
    ends = resolve_places("Rotterdam", (), "Singapore", world_chart())
    assert southern_limit(ends, pytest.fail, -60.0) == (-60.0, [])


@pytest.mark.slow
def test_distances_and_other_ways_of_plans_keep_the_limit():
    way = sea_distance("Melbourne", "Valparaiso")
    assert -50.1 < min(lat for lat, _ in way.line) < -49.0
    (note,) = [note for note in way.notes if note.startswith("Water south of 50 S is left out")]
    assert "about 211 nm shorter" in note
    beyond = sea_distance("Melbourne", "Valparaiso", via=[(-58.0, -130.0)])
    assert not any("left out" in note for note in beyond.notes)
    assert 100 < (way.length - beyond.length) / 1852.0 < 211
    limited = world_chart().within(-50.0, 72.0, -180.0, 180.0)
    assert Seaways.of_ship_chart(limited).south == -50.0
