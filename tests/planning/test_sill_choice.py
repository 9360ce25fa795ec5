"""Sills of the coarse depth layer do not close the straits that deep ships use."""

from pathlib import Path

import pytest

from tests.planning.distances import sea_distance
from thalweg import Sea, Ship, Voyage, plan
from thalweg.chart.depth import shoals_of_draught

pytestmark = pytest.mark.slow

SHIP = """
name: deep ship
hull: {length_overall_m: 225, breadth_m: 32.2, draught_m: 14.0}
speeds_kn: [10, 12, 14]
engine: {reference_speed_kn: 14, reference_power_kw: 9000, power_kw: 9500, sfoc_g_per_kwh: 170}
fuel: {type: hfo, price_per_t: 500}
models: {calm_water: cubic}
"""


def planned(folder: Path):
    (folder / "deep.yaml").write_text(SHIP)
    voyage = Voyage(start="Singapore", goal="Colombo", depart="2026-06-01T00:00Z")
    return plan(voyage, ship=Ship.load(folder / "deep.yaml"), sea=Sea.calm())


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    return planned(tmp_path_factory.mktemp("ship"))


def test_a_ship_of_14_m_sails_through_the_malacca_strait(found):
    """ETOPO1 has 9 m near Batu Pahat: she was sent round Java, 3,371 nm."""
    assert found.routes[0].distance_nm == pytest.approx(1_575.0, rel=0.03)
    assert not any("crosses water" in note for note in found.notes)  # a channel of the table


def test_a_sill_that_no_table_knows_is_crossed_with_a_note(tmp_path, monkeypatch):
    monkeypatch.setattr(shoals_of_draught, "deep_channels", tuple)
    found = planned(tmp_path)
    assert found.routes[0].distance_nm < 1_650.0
    note = next(note for note in found.notes if "was opened to the search" in note)
    assert note.startswith("Check the depth") and "nm longer" in note


def test_a_ship_of_14_m_keeps_to_the_north_west_bound_lane(found):
    """The lane counted as shoal: 11 nm were against the traffic."""
    against = [note for note in found.notes if note.startswith("Runs against")]
    assert not any("Malacca" in note for note in against)


@pytest.mark.parametrize(("draught", "longest"), [(12.0, 1_650.0), (20.0, 1_650.0)])
def test_distances_of_deep_ships_lead_through_it(draught, longest):
    assert sea_distance("Singapore", "Colombo", draught_m=draught).nm < longest


def test_a_port_that_is_too_shallow_is_the_first_note():
    way = sea_distance("Singapore", "Kolkata", draught_m=14.0)
    assert any(note.startswith("The port is too shallow") and "6.8 m" in note for note in way.notes)
