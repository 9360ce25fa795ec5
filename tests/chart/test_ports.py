"""Ports by name and UN/LOCODE."""

import csv
import re
from importlib import resources

import numpy as np
import pytest

from thalweg.chart.port_names import normalised_port_name, place_name, written_names
from thalweg.chart.ports import PORTS, country_code_of
from thalweg.core.errors import InputError
from thalweg.core.geodesy import distance, parse_position
from thalweg.core.units import NAUTICAL_MILE

#: Position and country of ports whose names went to another continent or were not found.
EXPECTED_PORTS = [
    ("Sydney", "AU", -33.86, 151.19),
    ("Hull", "GB", 53.74, -0.29),
    ("Dunkirk", "FR", 51.05, 2.37),
    ("Panama City", "PA", 8.95, -79.56),
    ("Alexandria", "EG", 31.18, 29.87),
    ("Colon", "PA", 9.36, -79.90),
    ("Tripoli, Libya", "LY", 32.90, 13.19),
    ("Tripoli, LB", "LB", 34.45, 35.83),
    ("Perth", "AU", -32.05, 115.74),
    ("Perth, Scotland", "GB", 56.39, -3.43),
    ("Portland, GB", "GB", 50.57, -2.43),
    ("Hook of Holland", "NL", 51.97, 4.13),
    ("Port Said", "EG", 31.26, 32.30),
    ("Kiel", "DE", 54.32, 10.14),
    ("Odessa", "UA", 46.49, 30.74),
    ("Kolkata", "IN", 22.55, 88.33),
    ("Calcutta", "IN", 22.55, 88.33),
    ("Mumbai", "IN", 18.95, 72.85),
    ("Bombay", "IN", 18.95, 72.85),
    ("Kaohsiung", "TW", 22.61, 120.27),
    ("Ras Tanura", "SA", 26.64, 50.16),
    ("Fujairah", "AE", 25.18, 56.36),
    ("Ceyhan", "TR", 36.88, 35.93),
    ("Ho Chi Minh City", "VN", 10.77, 106.71),
    ("Saigon", "VN", 10.77, 106.71),
    ("St. Petersburg", "RU", 59.93, 30.27),
    ("Saint Petersburg", "RU", 59.93, 30.27),
    ("Newcastle, AU", "AU", -32.92, 151.78),
    ("Newcastle, England", "GB", 54.99, -1.46),
    ("Maasvlakte", "NL", 51.95, 4.03),
    ("Dampier", "AU", -20.66, 116.71),
]


@pytest.mark.parametrize(("text", "country", "lat", "lon"), EXPECTED_PORTS)
def test_names_give_the_port_that_is_meant(text, country, lat, lon):
    port = PORTS.lookup(text)
    assert port.country_code == country
    assert distance(port.lat, port.lon, lat, lon) < 5.0 * NAUTICAL_MILE


@pytest.mark.parametrize(
    ("text", "locode", "lat", "lon"),
    [
        ("SGSIN", "SGSIN", 1.26, 103.84),
        ("Singapore", "SGSIN", 1.26, 103.84),
        ("Sydney, AU", "AUSYD", -33.86, 151.2),
        ("Sydney, Australia", "AUSYD", -33.86, 151.2),
        ("sydney, cape breton island", "CASYD", 46.15, -60.2),
        ("Oslo", "NOOSL", 59.9, 10.74),
        ("Florø", "NOFRO", 61.6, 5.03),
        ("Tromsø", "NOTOS", 69.65, 18.96),
        ("Göteborg", "SEGOT", 57.7, 11.95),
        ("gothenburg", "SEGOT", 57.7, 11.95),
        ("Rotterdam", "NLRTM", 51.9, 4.48),
        ("Port of Rotterdam", "NLRTM", 51.9, 4.48),
        ("NL RTM", "NLRTM", 51.9, 4.48),
        ("Shanghai", "CNSHA", 31.4, 121.5),
        ("Saint John", "CASJB", 45.27, -66.05),
        ("Cherbourg", "FRCER", 49.65, -1.63),
        ("Rijeka", "HRRJK", 45.33, 14.43),
        ("Dover", "GBDVR", 51.12, 1.33),
    ],
)
def test_ports_have_their_locode_and_position(text, locode, lat, lon):
    port = PORTS.lookup(text)
    assert port.locode == locode
    assert distance(port.lat, port.lon, lat, lon) < 10_000.0


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("Newcastle", ["Newcastle, AU", "Newcastle, GB"]),
        ("Portland", ["USPDX", "USPWM", "Portland, GB", "Portland, AU"]),
        ("Portland, US", ["USPDX", "USPWM"]),
        ("Tripoli", ["Tripoli, LB", "Tripoli, LY"]),
        ("Cartagena", ["Cartagena, CO", "Cartagena, ES"]),
        ("Wilmington", ["USLAX", "USILG", "USILM"]),
    ],
)
def test_a_name_of_several_comparable_ports_is_an_error_that_lists_them(text, written):
    with pytest.raises(InputError, match="comparable size") as caught:
        PORTS.lookup(text)
    assert re.findall(r"'([^']*)'", caught.value.remedy) == written


def test_every_way_to_write_a_port_in_an_error_gives_that_port():
    names = {name for name, ports in PORTS._by_name.items() if len(ports) > 1}
    errors = 0
    for name in sorted(names):
        try:
            PORTS.lookup(name)
        except InputError as error:
            errors += 1
            ways = re.findall(r"(?:^Write | or )(['\"])(.*?)\1(?=\.$| or )", error.remedy)
            near = error.details["near"]
            assert len(ways) == len(near), error
            for (_, way), locode in zip(ways, near, strict=True):
                if parse_position(way) is None:
                    port = PORTS.lookup(way)
                    assert locode in (port.locode, port.label), (name, way)
    assert errors > 50


def test_a_former_name_does_not_outvote_a_port_of_that_name():
    assert PORTS.lookup("Mejillones").locode == "CLMJS"
    assert PORTS.lookup("Port Arthur").locode == "USPOA"
    with pytest.raises(InputError, match="USLAX"):
        PORTS.lookup("San Pedro")


@pytest.mark.parametrize(
    ("text", "locode"),
    [
        ("Aberdeen", "GBABD"),  # medium against small
        ("Port Stanley", "FKPSY"),  # not the one on Lake Erie
        ("Port Stanley, CA", "CAPST"),
        ("Hamilton", "BMBDA"),  # the larger one on Lake Ontario cannot be reached
        ("Hamilton, Canada", "CAHAM"),
        ("Windsor", "CAWDR"),
        ("Windsor, Lake Erie", "CAWND"),
    ],
)
def test_ports_that_are_reached_from_the_sea_and_larger_ones_come_first(text, locode):
    assert PORTS.lookup(text).locode == locode


def test_a_country_is_not_a_port():
    with pytest.raises(InputError, match="it is a country") as caught:
        PORTS.lookup("Panama")
    assert "Balboa, PA" in str(caught.value)
    assert "US" not in {near[:2] for near in caught.value.details["near"]}


def test_a_name_in_the_wrong_country_lists_the_right_ones():
    with pytest.raises(InputError, match="no port named 'Sydney' in 'NL'") as caught:
        PORTS.lookup("Sydney, NL")
    assert caught.value.details["near"] == ["AUSYD", "CASYD"]


def test_every_locode_gives_its_own_port():
    coded = [port for port in PORTS.all if port.locode]
    assert len(coded) > 3_300
    assert all(PORTS.lookup(port.locode) is port for port in coded)


def test_a_name_that_looks_like_a_locode_is_a_name_in_small_letters():
    assert PORTS.lookup("Gaeta").country_code == "IT"
    assert PORTS.lookup("GAETA").country_code == "GA"


@pytest.mark.parametrize("size", ["large", "medium"])
def test_large_ports_are_found_by_name_and_country(size):
    ports = [port for port in PORTS.all if port.size == size]
    assert len(ports) > {"large": 165, "medium": 355}[size]
    ambiguous = []
    for port in ports:
        try:
            found = PORTS.lookup(port.label)
        except InputError:
            ambiguous.append(port.locode)
        else:
            assert found is port or found.is_part_of(port), port
    expected = {"large": {"USPDX"}, "medium": {"USPWM", "USILG", "USILM"}}
    assert set(ambiguous) == expected[size]


def test_the_table_has_plausible_positions_and_countries():
    lat = np.array([port.lat for port in PORTS.all])
    lon = np.array([port.lon for port in PORTS.all])
    assert len(PORTS.all) > 3_950
    assert (np.abs(lat) < 81.0).all()
    assert (np.abs(lon) <= 180.0).all()
    assert all(country_code_of(port.country_code) for port in PORTS.all)
    assert all(len(port.locode) in (0, 5) for port in PORTS.all)


def test_a_typing_error_finds_similar_names():
    with pytest.raises(InputError, match="Singapore"):
        PORTS.lookup("Singapour")
    with pytest.raises(InputError, match="Check the spelling"):
        PORTS.lookup("Xyzzyq")


def test_names_are_compared_without_accents_and_words_for_port():
    assert normalised_port_name("St. Nazaire") == normalised_port_name("SAINT  NAZAIRE")
    assert place_name("puerto colon") == "colon"
    assert place_name("new harbor") == "new harbor"
    assert written_names("Mumbai (Bombay)") == ("Mumbai (Bombay)", "Mumbai", "Bombay")


@pytest.mark.parametrize(
    ("text", "code"), [("nl", "NL"), ("Holland", "NL"), ("Côte d'Ivoire", "CI"), ("Oz", "")]
)
def test_countries_have_codes_and_names(text, code):
    assert country_code_of(text) == code


def test_ports_have_the_names_that_people_write_and_are_found_by_them():
    table = resources.files("thalweg.chart").joinpath("data/port_display_names.csv")
    rows = list(csv.DictReader(table.read_text(encoding="utf-8").splitlines()))
    for row in rows:
        port = PORTS.lookup(row["unlocode"])
        assert port.display_name == row["name"] != port.name
        assert (
            PORTS.lookup(port.label) == PORTS.lookup(port.name + f", {port.country_code}") == port
        )
    assert PORTS.lookup("ESBIO").label == "Bilbao, ES"
    assert PORTS.lookup("NLRTM").display_name == PORTS.lookup("NLRTM").name
