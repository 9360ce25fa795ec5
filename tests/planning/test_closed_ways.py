"""Refusals that name the passage or canal that is closed on the only way."""

import pytest

from thalweg import Sea, Ship, Voyage, plan
from thalweg.core.errors import NoPathError
from thalweg.planning.network_selection.closed_ways import closed_way_error
from thalweg.planning.request.voyage_endpoints import resolve_places
from thalweg.planning.sea_distance import sea_distance
from thalweg.planning.seaways import Seaways, world_chart

pytestmark = pytest.mark.slow


def test_a_distance_names_the_passage_that_is_too_shallow():
    with pytest.raises(NoPathError, match=r"Kerch Strait: the draught of 9.5 m is over the 8 m"):
        sea_distance("Istanbul", "Mariupol", draught_m=9.5)
    assert sea_distance("Istanbul", "Mariupol", draught_m=7.5).nm == pytest.approx(545.0, rel=0.02)


def test_a_port_between_closed_passages_has_no_way_out():
    with pytest.raises(NoPathError, match=r"Malacca-Singapore west: the draught of 20.8 m is over"):
        sea_distance("Singapore", "Ras Tanura", draught_m=20.8)


def test_what_has_a_way_round_it_is_not_named():
    """The Alderney Race and Suez are closed on the shortest way, but not the reason.

    With Malacca-Singapore west alone the way would lead over shoals from the south.
    """
    with pytest.raises(NoPathError, match="Malacca-Singapore west: the draught") as refused:
        sea_distance("Rotterdam", "Singapore", draught_m=20.8)
    assert refused.value.details["closed"] == [
        "Malacca: One Fathom Bank",
        "Malacca-Singapore west",
    ]


def test_the_way_that_closes_last_is_named():
    """The shortest way is by the Sound, of 7.7 m; the way by the Belts takes ships of 15 m."""
    with pytest.raises(NoPathError, match=r"the draught of 20 m is over the 15 m") as refused:
        sea_distance("Gdansk", "Gothenburg", draught_m=20.0)
    assert refused.value.details["closed"] == [
        "Kadet Trench",
        "Fehmarn Belt",
        "Great Belt (Route T)",
    ]


def test_a_passage_too_small_at_any_draught_is_not_named_where_less_draught_is_enough():
    """The Little Belt has no largest draught; it was named for its bridge."""
    hull = {
        "length_overall_m": 292.0, "breadth_m": 45.0, "draught_m": 18.2, "air_draught_m": 50.0,
    }  # fmt: skip
    large = Ship.from_dict({"name": "cape size", "hull": hull, "speeds_kn": [12.0]})
    with pytest.raises(NoPathError, match=r"the draught of 18.2 m is over the 15 m") as refused:
        sea_distance("Skagen", "Rostock", ship=large)
    assert refused.value.details["closed"] == ["Great Belt (Route T)", "Fehmarn Belt"]


def test_a_distance_advises_what_it_can_do():
    """It advised --open, which no distance takes for a draught."""
    with pytest.raises(NoPathError) as refused:
        sea_distance("Istanbul", "Mariupol", draught_m=9.5)
    assert refused.value.remedy == "Load less, send a smaller ship or choose another port."


def test_a_passage_that_was_avoided_is_named_as_closed():
    with pytest.raises(NoPathError, match="Kerch Strait, which is closed here") as refused:
        sea_distance("Istanbul", "Mariupol", avoid=["Kerch"])
    assert refused.value.details["closed"] == ["Kerch Strait"]
    assert refused.value.remedy == "Do not avoid it."


def test_a_plan_names_it_before_other_distances_from_land_are_tried():
    voyage = Voyage(start="Istanbul", goal="Mariupol", depart="2026-06-01T00:00Z")
    with pytest.raises(NoPathError, match=r"Kerch Strait: the draught of 9.5 m"):
        plan(voyage, ship=Ship.load("handysize-bulker"), sea=Sea.calm())


def test_where_there_is_a_way_nothing_is_named():
    ends = resolve_places("Istanbul", (), "Odesa", world_chart())
    assert closed_way_error(Seaways.of_chart(world_chart(), ()), ends, {}) is None


def test_a_canal_that_is_too_shallow_for_the_length_is_named():
    reefer = Ship.simple(speed_kn=18.0, draught_m=8.5, length_m=200.0, breadth_m=24.0)
    way = sea_distance("Hamburg", "Kotka", ship=reefer)
    assert any("8.18 m allowed for 200 m of length" in note for note in way.notes)
    shorter = Ship.simple(speed_kn=18.0, draught_m=8.5, length_m=164.0, breadth_m=24.0)
    assert sea_distance("Hamburg", "Kotka", ship=shorter).canals == ("Kiel Canal",)
