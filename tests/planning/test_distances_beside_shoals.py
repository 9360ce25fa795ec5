"""Distances for a draught where the depth layer is coarse, and where a strait is deep in part."""

import pytest

from thalweg.planning.sea_distance import sea_distance

pytestmark = pytest.mark.slow


@pytest.mark.parametrize(
    ("start", "goal", "draught", "nm", "passed"),
    [
        ("Gothenburg", "Copenhagen", 12.5, 134.0, "Oresund: northern part"),
        ("Copenhagen", "Aarhus", 8.0, 107.0, "Oresund: northern part"),
        ("Gdansk", "Copenhagen", 9.0, 465.0, "Great Belt (Route T)"),  # Drogden has 8 m
        ("Riga", "Gdansk", 12.5, 330.0, "Irben Strait"),
    ],
)
def test_the_sound_is_shallow_at_drogden_and_irben_is_deep(start, goal, draught, nm, passed):
    way = sea_distance(start, goal, draught_m=draught)
    assert way.nm == pytest.approx(nm, rel=0.02)
    assert passed in way.straits


@pytest.mark.parametrize(
    ("start", "goal", "draught"),
    [
        ("Bangkok", "Ho Chi Minh City", 8.0),  # the layer has 3 m round Con Son
        ("Jakarta", "Surabaya", 8.0),  # ... and 3 m off Tanjung Karawang
        ("Nuevitas", "Caucedo", 8.0),  # edges of the graph beside the coast of Haiti
    ],
)
def test_a_draught_lengthens_a_way_little_where_ships_sail(start, goal, draught):
    without = sea_distance(start, goal).nm
    assert sea_distance(start, goal, draught_m=draught).nm < 1.05 * without


def test_a_detour_round_shoals_is_stated():
    way = sea_distance("Rio Grande", "Montevideo", draught_m=8.0)
    assert any("31 nm shorter, over that water" in note for note in way.notes)
