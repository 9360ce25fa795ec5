"""Notes on water and ports that insurers list for war risk."""

import numpy as np
import pytest
import shapely

from thalweg.chart.ports import PORTS, country_code_of
from thalweg.chart.zones.war_risk_areas import WAR_RISK_AREAS
from thalweg.planning.report.note_order import count_of_dangers
from thalweg.planning.report.zone_report import war_risk_notes
from thalweg.planning.sea_distance import sea_distance


def notes(*ports, between=()):
    ends = [(port.lat, port.lon) for port in map(PORTS.lookup, ports)]
    return war_risk_notes(*np.array([ends[0], *between, ends[-1]]).T)


def test_the_black_sea_off_ukraine_is_named_from_where_the_route_enters_it():
    (note,) = notes("Varna", "Odesa", between=[(44.5, 30.0), (45.3, 30.8)])
    assert note.startswith("Listed for war risk: the Sea of Azov and the Black Sea")
    assert "(from 44 58.0N" in note and "ports of Ukraine" in note and "the list changes" in note
    assert count_of_dangers([note]) == 1
    assert notes("Varna", "Constanta", between=[(43.5, 29.0)]) == []
    assert notes("Istanbul", "Samsun", between=[(42.0, 33.0)]) == []


def test_ports_of_listed_countries_are_named_and_their_neighbours_are_not():
    (note,) = notes("Genoa", "Misratah", between=[(38.0, 9.0)])
    assert note.startswith("Listed for war risk: ports of Libya, as listed")
    assert notes("Genoa", "Tunis", between=[(38.0, 9.0)]) == []
    assert notes("Rotterdam", "New York City", between=[(49.0, -6.0), (42.0, -55.0)]) == []


@pytest.mark.parametrize(
    ("name", "lat", "lon"),
    [
        ("the southern Red Sea", 12.6, 43.3),
        ("the southern Red Sea", 12.0, 48.0),
        ("the southern Red Sea", 2.0, 46.5),
        ("the Persian Gulf", 26.5, 56.6),
        ("the Persian Gulf", 29.5, 48.7),
        ("the Persian Gulf", 24.7, 57.5),
        ("the Gulf of Guinea", 4.0, 6.5),
        ("the Sea of Azov", 46.0, 36.8),
        ("the Sea of Azov", 43.6, 39.6),
        ("the waters off Cabo Delgado", -12.0, 40.6),
    ],
)
def test_listed_waters_contain_their_well_known_places(name, lat, lon):
    assert [a.name.startswith(name) for a in WAR_RISK_AREAS if a.contains(lat, lon)] == [True]


@pytest.mark.parametrize(
    ("lat", "lon"),
    [(22.0, 38.0), (24.0, 60.0), (12.0, 62.0), (-8.0, 45.0), (5.0, -2.0), (42.0, 35.0)],
)
def test_waters_beside_the_listed_ones_are_not_in_them(lat, lon):
    assert not any(area.contains(lat, lon) for area in WAR_RISK_AREAS)


def test_the_table_has_valid_outlines_and_known_countries():
    for area in WAR_RISK_AREAS:
        assert bool(area.outline) != bool(area.country_code)
        assert "JWLA-032" in area.source
        if area.outline:
            assert shapely.Polygon([(x, y) for y, x in area.outline]).is_valid
        else:
            assert country_code_of(area.name) == area.country_code


@pytest.mark.slow
def test_a_distance_through_the_red_sea_states_it():
    found = sea_distance("Suez", "Djibouti")
    (note,) = [note for note in found.notes if note.startswith("Listed for war risk")]
    assert "the southern Red Sea, Gulf of Aden and Somali waters (from 17 5" in note
