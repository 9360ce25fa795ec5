"""Lines of approaches that crossed land, took a closed channel or doubled back."""

from __future__ import annotations

import numpy as np
import pytest

from thalweg.chart.approaches import PORT_APPROACHES
from thalweg.chart.ports import PORTS
from thalweg.core.geodesy import densify, distance, longitude_difference
from thalweg.core.units import NAUTICAL_MILE


def line_of(name):
    return np.array(PORT_APPROACHES.of(PORTS.lookup(name)).line, float)


def least_miles(line, place):
    lat, lon, _ = densify(*line.T, 0.1 * NAUTICAL_MILE)
    return float(distance(*place, lat, lon).min()) / NAUTICAL_MILE


def alterations(line):
    """Return the alterations of course [deg] at the inner vertices, and the legs [nm]."""
    lat, lon = line.T
    east = longitude_difference(lon[1:], lon[:-1]) * np.cos(np.radians(lat[:-1]))
    course = np.degrees(np.arctan2(east, np.diff(lat)))
    turns = np.abs((np.diff(course) + 180.0) % 360.0 - 180.0)
    return turns, np.asarray(distance(lat[:-1], lon[:-1], lat[1:], lon[1:])) / NAUTICAL_MILE


@pytest.mark.parametrize("port", ["COCTG", "COEBQ"])
def test_cartagena_is_reached_by_boca_chica(port):
    """The lines crossed the peninsula of Bocagrande and its closed entrance."""
    line = line_of(port)
    assert least_miles(line, (10.320, -75.582)) < 0.2  # between Tierra Bomba and Baru
    assert least_miles(line, (10.4167, -75.5536)) > 0.9  # Bocagrande
    length = PORT_APPROACHES.of(PORTS.lookup(port)).length / NAUTICAL_MILE
    assert length == pytest.approx(10.3, abs=0.5)


@pytest.mark.parametrize(("port", "miles"), [("CNTXG", 18.2), ("CNTSN", 22.4)])
def test_tianjin_is_left_by_its_dredged_channel(port, miles):
    """The lines were 0 and 3 nm long; ships came ashore beside the channel."""
    line = line_of(port)
    assert least_miles(line, (38.9165, 118.025)) < 0.2  # middle of the channel
    length = PORT_APPROACHES.of(PORTS.lookup(port)).length / NAUTICAL_MILE
    assert length == pytest.approx(miles, abs=0.3)


@pytest.mark.parametrize("port", ["Manaus", "BRIAR", "Santarem, BR", "VEPZO", "RUIAA", "IRKHO"])
def test_lines_along_rivers_do_not_double_back(port):
    """On the Amazon courses of 038, 222, 033, 253 and 073 followed each other within a mile."""
    turns, legs = alterations(line_of(port))
    assert turns[np.minimum(legs[:-1], legs[1:]) < 1.5].max() <= 120.0


def test_no_line_alters_twice_by_more_than_120_degrees_within_a_mile_and_a_half():
    """Lines of three ports on the Amazon did."""
    found = []
    for approach in PORT_APPROACHES.all:
        if len(approach.line) > 3:
            turns, legs = alterations(np.array(approach.line, float))
            twice = (turns[:-1] > 120.0) & (turns[1:] > 120.0) & (legs[1:-1] < 1.5)
            found += [approach.port.label] * int(twice.any())
    assert not found


@pytest.mark.parametrize("port", ["JPNGO", "JPYKK", "JPKNU"])
def test_ise_bay_is_left_through_irago_suido(port):
    """Lines passed west of Kami-shima; that of Nagoya began with 2 nm of land."""
    line = line_of(port)
    assert least_miles(line, (34.570, 136.997)) < 0.5
    assert least_miles(line, (34.549, 136.985)) > 1.0  # Kami-shima


def test_nagoya_passes_the_gap_of_its_breakwater():
    """The line began at the town."""
    assert least_miles(line_of("JPNGO"), (34.99, 136.79)) < 0.2
    assert least_miles(line_of("JPNGO"), (35.0667, 136.8667)) > 2.0


@pytest.mark.parametrize(
    ("port", "gate", "land"),
    [
        ("IDCXP", (-7.755, 109.030), (-7.737, 109.012)),  # east end of Nusakambangan; the town
        ("TWKEL", (25.156, 121.7493), (25.145, 121.775)),  # harbour mouth; the hills east of it
        ("JPWAM", (33.936, 130.860), (33.917, 130.805)),  # Tobata; Wakamatsu
        ("CNTAO", (36.032, 120.280), (36.060, 120.384)),  # mouth of Jiaozhou Bay; the town
    ],
)
def test_harbours_are_left_by_their_mouth(port, gate, land):
    """The lines went over land to the nearest water in the sea."""
    assert least_miles(line_of(port), gate) < 0.5
    assert least_miles(line_of(port), land) > 0.8


@pytest.mark.parametrize(
    ("port", "town"),
    [
        ("SESTO", (59.3383, 18.0925)),
        ("DERSK", (54.1133, 12.1134)),
        ("AUMEL", (-37.8333, 144.9667)),
        ("JPYOK", (35.4500, 139.5833)),
        ("ZACPT", (-33.9167, 18.4167)),
        ("UAODS", (46.4833, 30.7333)),
    ],
)
def test_lines_begin_in_the_harbour_and_not_in_the_town(port, town):
    """Their first 0.9 to 2.5 nm were land."""
    assert least_miles(line_of(port), town) > 0.7


#: General knowledge, unchecked: places of the channels, and shoal water that lines crossed.
CHANNELS = [
    ("USEYW", (24.470, -81.802), None),  # Main Ship Channel through the reef
    ("AUMEL", (-38.320, 144.880), (-38.200, 144.800)),  # Hovell Pile; Great Sands
    ("AUGEX", (-38.320, 144.880), (-38.260, 144.730)),  # not the West Channel
    ("USOAK", (37.798, -122.378), (37.840, -122.370)),  # west span; north of Treasure Island
    ("GBSOU", (50.787, -1.318), (50.797, -1.255)),  # West Bramble; Bramble Bank
    ("GBFAW", (50.787, -1.318), (50.797, -1.255)),
    ("FRDKK", (51.043, 2.000), (51.085, 2.260)),  # Chenal de l'Ouest; Breedt Bank
    ("KRPUS", (35.080, 129.108), (35.060, 129.040)),  # east of Yeongdo, not west of it
    ("Busan New Port", (35.010, 128.793), None),
    ("CNSZX", (22.557, 114.361), (22.440, 113.900)),  # Mirs Bay, not Deep Bay
    ("AUFRE", (-31.950, 115.660), None),  # Deep Water Channel
    ("NLHAR", (53.240, 5.200), (53.255, 5.280)),  # Blauwe Slenk; Griend flats
]


@pytest.mark.parametrize(("port", "channel", "shoal"), CHANNELS)
def test_lines_follow_the_ship_channels(port, channel, shoal):
    """They ended inside reefs or led over banks."""
    line = line_of(port)
    assert least_miles(line, channel) < 0.4
    assert shoal is None or least_miles(line, shoal) > 0.6
