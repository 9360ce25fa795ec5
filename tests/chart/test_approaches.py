"""The table of port approaches: every port of size has one, through the right water."""

import functools
import gzip
import itertools
from importlib import resources

import numpy as np
import pytest

from thalweg.chart import Chart
from thalweg.chart.approach_choices import line_between
from thalweg.chart.approaches import (
    LONGEST_JOINT,
    ON_LINE,
    PORT_APPROACHES,
    dense_line,
)
from thalweg.chart.ports import PORTS
from thalweg.core.geodesy import distance, line_length, positions_along
from thalweg.core.units import NAUTICAL_MILE

SIZED = [port for port in PORTS.all if port.size in ("large", "medium")]
#: Words of the reasons for which a large or medium port may lack an approach.
REASONS = ("Great Lakes", "above the head of navigation")
#: Longest leg: straight reaches of the Amazon and of the St Lawrence.
LONGEST_LEG = 60.0 * NAUTICAL_MILE

# Port, position that its line passes, and within how many miles. The positions are of entrances,
# narrows and reaches as named in the comment, read from charts and gazetteers.
GATES = [
    ("Rotterdam", 51.98, 4.10, 1.0),  # Maas entrance
    ("Rotterdam", 51.955, 4.164, 0.5),  # Maeslant barrier
    ("Amsterdam", 52.465, 4.58, 0.5),  # locks of IJmuiden
    ("Antwerp, BE", 51.41, 3.60, 1.5),  # Vlissingen roads
    ("Antwerp, BE", 51.29, 4.30, 1.0),  # Lillo
    ("Ghent", 51.34, 3.82, 1.0),  # locks of Terneuzen
    ("Hamburg", 53.83, 9.35, 1.5),  # Elbe off Glückstadt and Brunsbüttel
    ("Hamburg", 53.88, 9.20, 2.0),  # Brunsbüttel
    ("Bremen", 53.54, 8.55, 1.0),  # Bremerhaven
    ("Lubeck", 53.96, 10.88, 0.7),  # Travemünde
    ("Gdansk", 54.41, 18.66, 0.7),  # Nowy Port
    ("Szczecin", 53.92, 14.27, 1.5),  # Swinoujscie
    ("Riga", 57.06, 24.01, 1.0),  # mouth of the Daugava
    ("Stockholm", 59.37, 18.35, 2.5),  # Vaxholm waters
    ("Göteborg", 57.69, 11.80, 1.5),  # Rivöfjorden
    ("London", 51.45, 0.37, 1.0),  # Gravesend
    ("London", 51.497, 0.037, 0.3),  # Thames barrier
    ("London", 51.49, 0.60, 1.5),  # Sea Reach
    ("Liverpool", 53.45, -3.03, 1.0),  # the Mersey at New Brighton
    ("Manchester", 53.325, -2.95, 1.0),  # Eastham locks
    ("Southampton", 50.82, -1.30, 1.2),  # Calshot
    ("Hull", 53.60, 0.05, 2.5),  # Humber between Grimsby and Spurn
    ("Immingham", 53.60, 0.05, 2.5),
    ("Bristol", 51.50, -2.71, 0.7),  # Avonmouth
    ("Glasgow", 55.96, -4.80, 1.5),  # Greenock
    ("Le Havre", 49.48, 0.08, 1.5),  # entrance
    ("Rouen", 49.47, 0.45, 0.7),  # Tancarville
    ("Rouen", 49.52, 0.73, 0.7),  # Caudebec
    ("Nantes", 47.28, -2.17, 0.7),  # bridge of Saint-Nazaire
    ("Bordeaux", 45.55, -1.05, 2.0),  # mouth of the Gironde
    ("Lisbon", 38.66, -9.30, 1.5),  # mouth of the Tagus
    ("Sevilla", 36.80, -6.34, 0.7),  # Bonanza
    ("Brest", 48.34, -4.57, 1.0),  # Goulet
    ("Venice", 45.335, 12.31, 1.0),  # Malamocco
    ("Izmir", 38.42, 26.95, 1.5),  # Yenikale
    ("Istanbul", 41.01, 28.98, 1.5),  # southern end of the Bosporus
    ("Oslo", 59.67, 10.60, 1.0),  # Drøbak
    ("Drammen", 59.61, 10.42, 0.7),  # Svelvik
    ("New York", 40.61, -74.05, 1.0),  # Narrows
    ("Newark", 40.645, -74.09, 0.7),  # Kill van Kull
    ("Newark", 40.61, -74.05, 1.0),  # Narrows
    ("USALB", 41.395, -73.955, 0.7),  # West Point
    ("USALB", 40.61, -74.05, 1.0),
    ("Philadelphia", 39.845, -75.36, 0.5),  # Chester
    ("Philadelphia", 39.50, -75.56, 1.5),  # Reedy Island
    ("Baltimore", 39.20, -76.45, 2.0),  # Patapsco mouth
    ("Norfolk", 37.00, -76.30, 1.5),  # Hampton Roads
    ("Savannah", 32.03, -80.87, 1.0),  # Tybee
    ("Charleston", 32.755, -79.87, 1.0),  # Fort Sumter
    ("USILM", 33.90, -78.01, 1.0),  # mouth of the Cape Fear
    ("Jacksonville", 30.40, -81.40, 0.7),  # jetties of the St Johns
    ("Tampa", 27.62, -82.66, 1.5),  # Sunshine Skyway
    ("Mobile", 30.23, -88.03, 1.5),  # Mobile Point
    ("New Orleans", 29.15, -89.25, 0.7),  # Head of Passes
    ("New Orleans", 28.93, -89.40, 0.7),  # Southwest Pass
    ("Baton Rouge", 29.95, -90.06, 0.7),  # New Orleans
    ("Convent, US", 28.93, -89.40, 0.7),  # Southwest Pass
    ("Houston", 29.68, -94.985, 0.5),  # Morgans Point
    ("Houston", 29.36, -94.76, 1.5),  # Bolivar Roads
    ("Beaumont", 29.70, -93.85, 1.0),  # Sabine Pass
    ("USPDX", 46.25, -124.06, 0.7),  # bar of the Columbia
    ("San Francisco", 37.82, -122.48, 0.7),  # Golden Gate
    ("Oakland", 37.82, -122.48, 0.7),
    ("San Diego", 32.68, -117.23, 0.7),  # Ballast Point
    ("Seattle", 48.16, -122.70, 3.0),  # Admiralty Inlet
    ("Vancouver, CA", 49.315, -123.14, 0.7),  # First Narrows
    ("Montreal", 46.045, -73.115, 0.5),  # Sorel
    ("Montreal", 46.742, -71.287, 0.5),  # bridge of Quebec
    ("Quebec", 46.83, -71.17, 1.0),
    ("Havana", 23.15, -82.36, 0.6),  # Morro
    ("Santiago de Cuba", 19.97, -75.87, 0.7),
    ("Cienfuegos", 22.04, -80.45, 1.0),
    ("Maracaibo", 10.98, -71.60, 1.0),  # bar of Maracaibo
    ("Barranquilla", 11.10, -74.85, 0.7),  # Bocas de Ceniza
    ("Rio de Janeiro", -22.93, -43.14, 1.0),  # Santa Cruz
    ("Santos", -24.00, -46.31, 0.7),
    ("Manaus", -1.92, -55.51, 1.0),  # Óbidos
    ("Rosario", -34.09, -59.03, 1.0),  # Zárate
    ("Buenos Aires", -34.58, -58.30, 2.5),
    ("Matadi", -5.90, 13.05, 2.5),  # Boma
    ("Durban", -29.87, 31.07, 0.7),
    ("NGLOS", 6.40, 3.40, 1.0),  # moles of Lagos
    ("IQBSR", 30.43, 48.17, 0.7),  # Khorramshahr
    ("Kolkata", 22.19, 88.18, 0.7),  # Diamond Harbour
    ("Mumbai", 18.88, 72.86, 1.5),
    ("Yangon", 16.75, 96.20, 2.0),  # Monkey Point
    ("Bangkok", 13.55, 100.59, 0.7),  # mouth of the Chao Phraya
    ("Ho Chi Minh City", 10.32, 107.03, 0.7),  # Ganh Rai Bay
    ("Haiphong", 20.795, 106.915, 1.0),  # Lach Huyen
    ("Chiwan", 22.471, 113.876, 0.5),
    ("Hong Kong", 22.29, 114.104, 0.5),  # west of Green Island
    ("Guangzhou", 22.80, 113.62, 1.5),  # Bocca Tigris
    ("Shanghai", 31.40, 121.51, 0.7),  # Wusong
    ("Nantong", 31.39, 121.56, 1.0),
    ("Tianjin Xin Gang", 38.96, 117.85, 2.5),
    ("Tokyo", 35.30, 139.76, 3.0),  # Uraga Channel
    ("Yokohama", 35.30, 139.76, 3.0),
    ("Kobe", 34.28, 135.00, 1.5),  # Tomogashima Channel
    ("Osaka", 34.28, 135.00, 1.5),
    ("Nagasaki", 32.72, 129.83, 1.0),
    ("Melbourne", -38.30, 144.61, 1.5),  # the Rip
    ("Geelong", -38.30, 144.61, 1.5),
    ("Sydney, AU", -33.83, 151.28, 1.0),  # the Heads
    ("Brisbane", -27.05, 153.20, 2.0),  # Caloundra channel
    ("Auckland", -36.83, 174.82, 1.0),  # Rangitoto
    ("Wellington", -41.35, 174.83, 1.0),
    ("Aqaba", 29.41, 34.91, 1.5),  # Gulf of Aqaba; the rest is sailed as sea
    ("Elat", 29.41, 34.91, 1.5),
    ("Saint Petersburg", 59.923, 29.993, 0.5),
]


@functools.cache
def chart():
    return Chart.gshhg("i")


def dense(line, spacing=0.2 * NAUTICAL_MILE):
    places = [line[0]]
    for a, b in itertools.pairwise(line):
        count = int(distance(*a, *b) / spacing) + 2
        lat, lon = positions_along(*a, *b, np.linspace(0.0, 1.0, count)[1:])
        places += list(zip(lat, lon))
    return np.array(places)


def approach_of(name):
    found = PORT_APPROACHES.of(PORTS.lookup(name))
    assert found is not None, name
    return found


def test_every_large_and_medium_port_has_an_approach_or_a_reason():
    without = [port for port in SIZED if PORT_APPROACHES.of(port) is None]
    assert len(SIZED) > 500
    assert len(without) < 25
    for port in without:
        assert any(word in PORT_APPROACHES.reason(port) for word in REASONS), port


def test_sea_ends_are_two_miles_from_land_on_the_usual_chart():
    every = PORT_APPROACHES.all
    lat, lon = np.array([approach.sea_end for approach in every]).T
    assert len(every) > 3600
    assert chart().is_navigable(lat, lon).all()
    assert (chart().coastline.shore_distance(lat, lon) > 1.9 * NAUTICAL_MILE).all()


def test_lines_are_continuous_and_of_moderate_length():
    for approach in PORT_APPROACHES.all:
        line = np.array(approach.line)
        legs = distance(line[:-1, 0], line[:-1, 1], line[1:, 0], line[1:, 1])
        assert legs.max(initial=0.0) < LONGEST_LEG, approach.port
        assert legs.min(initial=100.0) > 10.0, approach.port  # no position twice
        assert approach.length < 750.0 * NAUTICAL_MILE, approach.port  # Manaus
    sized = [PORT_APPROACHES.of(port) for port in SIZED]
    lengths = [approach.length / NAUTICAL_MILE for approach in sized if approach]
    assert np.median(lengths) < 6.5
    assert np.percentile(lengths, 95) < 80.0


def test_lines_begin_at_their_ports():
    far = [
        approach.port.label
        for approach in PORT_APPROACHES.all
        if distance(approach.port.lat, approach.port.lon, *approach.berth) > 5.0 * NAUTICAL_MILE
    ]
    assert far == []


@pytest.mark.parametrize(("name", "lat", "lon", "within"), GATES)
def test_approaches_pass_known_places(name, lat, lon, within):
    places = dense(approach_of(name).line)
    assert distance(lat, lon, places[:, 0], places[:, 1]).min() <= within * NAUTICAL_MILE


@pytest.mark.slow
def test_ports_of_one_river_share_its_line():
    pairs = [
        ("Rotterdam", "Hook of Holland", 14.0),  # km 1000 to km 1030 of the Rhine: 16.5 nm
        ("Antwerp, BE", "Vlissingen", 38.0),
        ("London", "Tilbury", 22.0),
        ("New Orleans", "Baton Rouge", 117.0),  # miles 95 to 230 of the Mississippi
        ("New Orleans", "Convent, US", 56.5),  # miles 95 to 160
        ("Montreal", "Trois Rivieres", 66.0),
    ]
    for first, second, miles in pairs:
        start, goal = approach_of(first), approach_of(second)
        line = line_between(start, goal, legs_blocked=chart().legs_blocked)
        assert line is not None, (first, second)
        assert line[0] == start.berth
        assert line[-1] == goal.berth
        length = line_length(line) / NAUTICAL_MILE
        assert length < (start.length + goal.length) / NAUTICAL_MILE
        assert length == pytest.approx(miles, rel=0.12), (first, second)
    far = line_between(
        approach_of("Hamburg"), approach_of("Rotterdam"), legs_blocked=chart().legs_blocked
    )
    assert far is None


def test_two_lines_are_joined_where_that_is_shortest():
    """The joint found in blocks of places is the one that all pairs of places have."""
    start, goal = approach_of("San Francisco"), approach_of("Oakland, US")
    found = line_between(start, goal, legs_blocked=chart().legs_blocked)
    first, second = dense_line(start.line), dense_line(goal.line)
    i, j = (k.ravel() for k in np.indices((len(first), len(second))))
    apart = distance(first[i, 0], first[i, 1], second[j, 0], second[j, 1])
    near = apart <= LONGEST_JOINT
    i, j, apart = i[near], j[near], apart[near]
    blocked = chart().legs_blocked(*first[i, :2].T, *second[j, :2].T)
    free = ~blocked | (apart <= 0.15 * NAUTICAL_MILE)
    least = (first[i, 2] + apart + second[j, 2])[free].min()
    assert line_length(found) == pytest.approx(least, rel=1e-3)


def test_legs_along_a_line_are_recognised_and_others_are_not():
    line = np.array(approach_of("Hamburg").line)
    rounded = np.round(line, 3)  # up to 65 m off
    assert PORT_APPROACHES.legs(rounded[:, 0], rounded[:, 1]).all()
    assert PORT_APPROACHES.legs(line[::-1, 0], line[::-1, 1]).all()
    seaward = np.vstack([line[-1], line[-1] + [0.05, -0.3], line[-1] + [0.1, -0.6]])
    assert not PORT_APPROACHES.legs(seaward[:, 0], seaward[:, 1]).any()
    shortcut = line[[0, len(line) - 1]]  # not along the river
    assert not PORT_APPROACHES.legs(shortcut[:, 0], shortcut[:, 1]).any()
    assert ON_LINE < 0.1 * NAUTICAL_MILE


def test_nearest_port_with_an_approach():
    port, apart = PORT_APPROACHES.nearest(53.54, 9.95, within=10.0 * NAUTICAL_MILE)
    assert port.label == "Hamburg, DE"
    assert apart < 2.0 * NAUTICAL_MILE
    assert PORT_APPROACHES.nearest(50.0, 14.4, within=10.0 * NAUTICAL_MILE) is None  # Prague


def test_the_table_is_small():
    packed = resources.files("thalweg.chart").joinpath("data/port_approaches.csv.gz").read_bytes()
    assert len(packed) < 300_000
    assert gzip.decompress(packed).startswith(b"unlocode,name,")
