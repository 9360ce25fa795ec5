"""Ports of both indexes, by name and UN/LOCODE."""

import numpy as np
import pytest

from thalweg.chart.ports import PORTS
from thalweg.core.errors import InputError
from thalweg.core.geodesy import distance


@pytest.mark.parametrize(
    ("text", "locode", "lat", "lon"),
    [
        ("SGSIN", "SGSIN", 1.26, 103.84),
        ("Singapore", "SGSIN", 1.26, 103.84),
        ("Sydney, AU", "AUSYD", -33.86, 151.2),
        ("Oslo", "NOOSL", 59.9, 10.74),
        ("Florø", "NOFRO", 61.6, 5.03),
        ("Tromsø", "NOTOS", 69.65, 18.96),
        ("Göteborg", "SEGOT", 57.7, 11.95),
        ("gothenburg", "SEGOT", 57.7, 11.95),
        ("Rotterdam", "NLRTM", 51.9, 4.48),
    ],
)
def test_ports_lie_where_they_are(text, locode, lat, lon):
    port = PORTS.lookup(text)
    assert port.locode == locode
    assert distance(port.lat, port.lon, lat, lon) < 10_000.0


def test_no_locode_occurs_twice():
    assert not {port.locode for port in PORTS.others} & {port.locode for port in PORTS.all}
    assert len({port.locode for port in PORTS.others}) == len(PORTS.others)


def test_places_of_the_others_can_be():
    lat = np.array([port.lat for port in PORTS.others])
    lon = np.array([port.lon for port in PORTS.others])
    assert (np.abs(lat) < 75.0).all()
    assert (np.abs(lon) <= 180.0).all()
    assert all(len(port.locode) == 5 for port in PORTS.others)


def test_the_index_goes_before_the_others():
    assert PORTS.lookup("Hamilton, CA").country_code == "CA"
    assert PORTS.lookup("NLRTM") in PORTS.all


def test_a_slip_finds_the_others_too():
    with pytest.raises(InputError, match="Singapore"):
        PORTS.lookup("Singapour")
