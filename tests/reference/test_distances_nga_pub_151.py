"""Distances by sea against NGA Publication 151, Distances Between Ports, 11th edition (2001).

The publication was not seen itself. The miles below are those of its tables as two public sources
quote them: the 44 port pairs of ``benchmarks/route_accuracy/data/reference_distances.csv`` in the
repository frogiraffe/harborly ("each hand-verified against the source text"), and a course of
sailing (Recife, Natal, Mindelo) and tests of the repository dogadurak/FreightPrint (Istanbul).
Positions of the publication are used where a place is no port of ours. Its distances are between
central positions of ports, "generally over routes that afford the safest passage".
"""

import numpy as np
import pytest

from thalweg.planning.sea_distance import SMALL_CANALS, sea_distance

SAN_FRANCISCO = "San Francisco, US"

#: (from, to, nautical miles in the publication)
PUBLISHED = [
    ("Los Angeles", "Hong Kong", 6380),
    (SAN_FRANCISCO, "Hong Kong", 6044),
    ("Cape Town", "New York", 6786),
    ("Durban", "Mumbai", 3829),
    ("Mumbai", "Colombo", 895),
    ("Colombo", "Singapore", 1581),
    ("Gibraltar", "Port Said", 1925),
    ("Alexandria, EG", "Gibraltar", 1805),
    ("Port Said", "Mumbai", 3046),
    ("Balboa", "Los Angeles", 2913),
    ("Kobe", "Los Angeles", 5185),
    (SAN_FRANCISCO, "Dutch Harbor", 2051),
    (SAN_FRANCISCO, (21.2808, -158.1), 2100),  # Barbers Point
    ("Pago Pago", SAN_FRANCISCO, 4130),
    ("Yokohama", SAN_FRANCISCO, 4536),
    ((1.9667, -157.4667), SAN_FRANCISCO, 2895),  # Christmas Island, Line Islands
    ("Apra", SAN_FRANCISCO, 5053),
    ((28.2167, -177.3667), SAN_FRANCISCO, 2792),  # Midway Island
    ((19.3, 166.5833), SAN_FRANCISCO, 3821),  # Wake Island
    ("Papeete", SAN_FRANCISCO, 3663),
    ("Auckland", SAN_FRANCISCO, 5680),
    ("Noumea", SAN_FRANCISCO, 5410),
    ("Qingdao", SAN_FRANCISCO, 5403),
    ("Darwin", SAN_FRANCISCO, 6984),
    ("Brisbane", SAN_FRANCISCO, 6193),
    ("Newcastle, AU", "Los Angeles", 6456),
    ((-39.1667, 146.4333), SAN_FRANCISCO, 6820),  # Wilson Promontory
    ("New Orleans", "Balboa", 1433),
    ("Valparaiso, CL", "Balboa", 2616),
    ("Manila", "Singapore", 1330),
    ("Manila", "Hong Kong", 631),
    ("Jakarta", "Singapore", 525),
    ("Dakar", "New York", 3335),
    ("Mombasa", "Mumbai", 2404),
    ("Vladivostok", "Yokohama", 952),
    ("Rio de Janeiro", "New York", 4762),
    ("Buenos Aires", "New York", 5871),
    ("Venice, IT", "Port Said", 1317),
    ("Trieste", "Port Said", 1310),
    ("Natal, BR", "Dakar", 1620),
    ("Recife", "Dakar", 1717),
    ("Recife", "Bridgetown", 2054),
    ("Recife", "Las Palmas", 2453),
    ("Mindelo", "Santa Cruz de Tenerife", 849),
    ("New York", "Colombo", 8604),
    ("Istanbul", "Trieste", 1162),
    ("Valparaiso, CL", "Yokohama", 9280),
    ("Shanghai", "Kobe", 789),  # by the Osumi Strait; by Kanmon and the Inland Sea 752 nm here
]
ROUND_KYUSHU = (*SMALL_CANALS, "Kanmon")


@pytest.fixture(scope="module")
def errors():
    """Excess of our distances over the published ones [%]."""
    ours = [
        sea_distance(start, goal, avoid=ROUND_KYUSHU if goal == "Kobe" else SMALL_CANALS).nm
        for start, goal, _ in PUBLISHED
    ]
    return 100.0 * (np.array(ours) / np.array([nm for *_, nm in PUBLISHED]) - 1.0)


@pytest.mark.slow
def test_median_and_spread(errors):
    assert len(errors) >= 45
    assert np.median(np.abs(errors)) < 0.5
    assert abs(np.median(errors)) < 0.25
    assert np.percentile(np.abs(errors), 95) < 2.5


@pytest.mark.slow
def test_largest_error_and_its_cause(errors):
    """Recife to Bridgetown and Vladivostok to Yokohama are quoted longer than 2 nm off land.

    Shanghai to Kobe and Manila to Hong Kong keep 2 nm off I-shima and the Dangan islands here.
    """
    assert np.abs(errors).max() < 3.0
    worst = {PUBLISHED[k][:2] for k in np.flatnonzero(np.abs(errors) > 2.1)}
    round_islands = {("Shanghai", "Kobe"), ("Manila", "Hong Kong")}
    assert worst <= {("Recife", "Bridgetown"), ("Vladivostok", "Yokohama")} | round_islands


@pytest.mark.slow
def test_guayaquil_is_its_maritime_port():
    """The publication has 824 nm to Balboa from the docks of the city, by the Guayas and Jambeli.

    Ships berth in the Estero Salado, which meets the sea on the other side of Puna.
    """
    assert sea_distance("Guayaquil", "Balboa").nm == pytest.approx(778, rel=0.01)


@pytest.mark.slow
def test_both_ways_round_greece_are_those_published():
    """The publication has 1,162 nm south of Greece and 1,063 nm by the Corinth Canal."""
    south = sea_distance("Istanbul", "Trieste", avoid=SMALL_CANALS)
    canal = sea_distance("Istanbul", "Trieste", avoid=())
    assert south.nm == pytest.approx(1162, rel=0.02)
    assert canal.nm == pytest.approx(1063, rel=0.02)
    assert canal.canals == ("Corinth Canal",)
