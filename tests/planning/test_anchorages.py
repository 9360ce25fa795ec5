"""Waiting only where the chart allows it: in anchorages, or outside what is barred."""

from __future__ import annotations

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, Track, Voyage, evaluate, lattice, plan
from thalweg.core.errors import InputError, NoRouteError

LOW, M2 = 1767236400.0, 44714.0
AREA = (51.6, 51.9, 3.40, 3.75)
SHIP = Ship.simple(speed_kn=10.0, draught_m=6.5)
BAR = (3.55, 3.60)


def depth(time, lat, lon):
    return np.where((lon > BAR[0]) & (lon < BAR[1]), 7.0, 15.0) + 0.0 * lat


def level(time, lat, lon):
    return -1.5 * np.cos(2 * np.pi * (time - LOW) / M2) + 0.0 * lat


SEA = Sea.from_functions(
    {
        "sea_floor_depth_below_geoid": depth,
        "sea_surface_height_above_geopotential_datum": level,
    }
)


def zone(kind, south, north, west, east):
    ring = [[west, south], [east, south], [east, north], [west, north], [west, south]]
    return {
        "type": "Feature",
        "properties": {"kind": kind, "name": kind},
        "geometry": {"type": "Polygon", "coordinates": [ring]},
    }


def chart(*zones) -> Chart:
    return Chart.open_water(*AREA).with_zones(
        {"type": "FeatureCollection", "features": list(zones)}
    )


ANCHORAGE = zone("anchorage", 51.62, 51.68, 3.46, 3.52)
BARRED = zone("no-waiting", 51.6, 51.9, 3.46, 3.6)


def test_positions_where_a_ship_may_wait() -> None:
    free = Chart.open_water(*AREA)
    assert free.may_wait([51.7, 51.65], [3.5, 3.5]).tolist() == [True, True]
    assert chart(ANCHORAGE).may_wait([51.7, 51.65], [3.5, 3.5]).tolist() == [False, True]
    assert chart(BARRED).may_wait([51.7, 51.7], [3.5, 3.45]).tolist() == [False, True]
    both = chart(ANCHORAGE, zone("no-waiting", 51.62, 51.65, 3.46, 3.52))
    assert both.may_wait([51.66, 51.64, 51.7], 3.5).tolist() == [True, False, False]
    assert bool(chart(ANCHORAGE).may_wait(51.65, 3.5 - 360.0))
    assert chart(ANCHORAGE).fingerprint() != free.fingerprint() != chart(BARRED).fingerprint()


def test_nodes_of_a_network_know_it() -> None:
    network = lattice(chart(ANCHORAGE), (51.7, 3.45), (51.7, 3.7), spacing=1000.0)
    n = network.n_nodes
    inside = (
        (network.stations.lat[:n] >= 51.62) & (network.stations.lat[:n] <= 51.68)
        & (network.stations.lon[:n] >= 3.46) & (network.stations.lon[:n] <= 3.52)
    )  # fmt: skip
    inside[[network.meta.start, network.meta.goal]] = True  # berths
    assert np.array_equal(network.can_wait, inside)
    assert 10 < network.can_wait.sum() < 0.2 * n


def sail(zones, **more):
    voyage = Voyage(
        offing_nm=0.0, start=(51.71, 3.45), goal=(51.77, 3.70), depart=LOW, min_ukc_m=1.0, **more
    )
    return plan(voyage, ship=SHIP, sea=SEA, chart=zones, resolution=1500.0).best


def waits(route):
    """Return (lat, lon) of the waits of a route."""
    at = np.flatnonzero(route.track.wait > 0.0)
    return [(float(route.track.lat[k]), float(route.track.lon[k])) for k in at]


@pytest.mark.slow
def test_the_ship_waits_in_the_anchorage_or_at_the_start() -> None:
    free = sail(Chart.open_water(*AREA))
    route = sail(chart(ANCHORAGE))
    assert route.feasible and route.waiting_h > 1.0
    for lat, lon in waits(route):
        berth = abs(lat - 51.71) < 1e-6 and abs(lon - 3.45) < 1e-6
        assert berth or (51.62 <= lat <= 51.68 and 3.46 <= lon <= 3.52)
    assert free.time_h - 1e-3 <= route.time_h < free.time_h + 0.2


@pytest.mark.slow
def test_the_ship_does_not_wait_before_the_bar_where_that_is_barred() -> None:
    route = sail(chart(BARRED))
    assert route.feasible and route.waiting_h > 1.0
    assert all(lon < 3.46 or lon > 3.6 for _, lon in waits(route))


def test_the_referee_finds_waits_where_there_should_be_none() -> None:
    lat, lon = [51.75, 51.75, 51.75], [3.45, 3.5, 3.53]
    track = Track(lat, lon, LOW, [0.0, 3600.0, 0.0], [0, 0])
    found = evaluate(track, ship=SHIP, sea=SEA, chart=chart(BARRED))
    (violation,) = found.violations
    assert violation.reason == "waiting not allowed"
    assert (violation.lat, violation.lon) == (51.75, 3.5)
    assert violation.time == pytest.approx(found.legs["arrive"][0])
    assert evaluate(track, ship=SHIP, sea=SEA, chart=Chart.open_water(*AREA)).feasible
    at_berth = Track(lat, lon, LOW, [3600.0, 0.0, 0.0], [0, 0])
    assert evaluate(at_berth, ship=SHIP, sea=SEA, chart=chart(BARRED)).feasible


@pytest.mark.slow
def test_without_anchorages_the_ship_waits_at_the_berth_for_a_closed_bar() -> None:
    everywhere = chart(zone("no-waiting", *AREA))
    route = sail(everywhere)
    assert waits(route) == [(51.71, 3.45)]
    with pytest.raises(NoRouteError):
        sail(everywhere, wait=False)


def test_a_kind_that_does_not_exist_names_those_that_do() -> None:
    with pytest.raises(InputError, match="anchorage"):
        chart(zone("mooring", *AREA))
