"""Plans keep off the land: by the size of the ship, through named passages, and say so."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.chart.offing import OffingDisc
from thalweg.chart.passages import Passage
from thalweg.core.errors import InputError
from thalweg.core.geodesy import densify, distance
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.global_grid.grid import GridResolution, globe_grid
from thalweg.planning.report.land_report import saved_length
from thalweg.planning.request.offing_choice import (
    chart_off_land,
    default_offing,
    restrict_passages,
)
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.seaways import world_chart

pytestmark = pytest.mark.usefixtures("coarse_networks")

NM = 1852.0
DEPART = "2026-01-01T00:00Z"
BASINS = {
    "Black Sea": (43.3, 33.0),
    "Sea of Azov": (46.0, 36.3),
    "Sea of Marmara": (40.75, 28.2),
    "Baltic Sea": (57.0, 19.5),
    "Seto Inland Sea, west": (33.85, 131.6),
    "Seto Inland Sea, middle": (34.1, 133.4),
    "Seto Inland Sea, east": (34.55, 134.5),
    "Gulf of Aqaba": (29.0, 34.8),
    "Tokyo Bay": (35.45, 139.85),
    "Osaka Bay": (34.5, 135.2),
    "Strait of Georgia": (49.3, -123.8),
    "Puget Sound": (47.65, -122.43),
    "Port Phillip": (-38.05, 144.9),
    "Lake Maracaibo": (9.8, -71.5),
    "Gulf of Corinth": (38.25, 22.4),
    "Long Island Sound": (41.05, -72.9),
}


@pytest.fixture(scope="module")
def world():
    return Chart.gshhg("i")


@pytest.mark.slow
def test_every_basin_is_reached_two_miles_off_land(world):
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    grid = globe_grid(world.with_offing(2.0 * NM), GridResolution(4, 6, 0, 6))
    count = len(grid.lat)
    joined = (np.ones(len(grid.pairs.first), bool), (grid.pairs.first, grid.pairs.second))
    water = connected_components(coo_array(joined, shape=(count, count)), directed=False)[1]
    ocean = water == np.bincount(water).argmax()
    for name, place in BASINS.items():
        away = distance(*place, grid.lat, grid.lon)
        assert away[ocean].min() == away.min() < 15.0 * NM, name
    lat, lon = grid.lat[grid.pairs.first], grid.lon[grid.pairs.first]
    shore = world.coastline.shore_distance(lat, lon, cap=3.0 * NM)
    assert (shore < 2.0 * NM).mean() < 0.05  # only along passages


@pytest.mark.parametrize(
    ("length", "draught", "miles"),
    [(40.0, 3.0, 0.5), (45.0, 6.0, 0.5), (90.0, 6.0, 1.0), (90.0, 8.0, 2.0), (180.0, 9.5, 2.0)],
)
def test_the_default_is_by_the_size_of_the_ship(length, draught, miles):
    class Sized:
        pass

    ship = Sized()
    ship.length, ship.draught = length, draught
    assert default_offing(ship) == pytest.approx(miles * NM)


def test_a_voyage_keeps_its_offing_in_its_file(tmp_path):
    voyage = Voyage(
        start=(50, 1), goal=(51, 2), depart=DEPART, offing_nm=1.5, open="Beagle", avoid=["Dover"]
    )
    voyage.save(tmp_path / "voyage.yaml")
    again = Voyage.load(tmp_path / "voyage.yaml")
    assert (again.offing_nm, again.open, again.avoid) == (1.5, ("Beagle",), ("Dover",))
    for wrong in (-1.0, 60.0, True, "2"):
        with pytest.raises(InputError):
            Voyage(start=(50, 1), goal=(51, 2), depart=DEPART, offing_nm=wrong)


def restricted(world, offing=2.0 * NM, **request):
    ship = Ship.load("handysize-bulker")
    voyage = Voyage(start=(50, 1), goal=(51, 2), depart=DEPART, **request)
    return restrict_passages(world, voyage, ship, offing)


def test_passages_are_closed_by_limits_and_opened_or_avoided_by_name(world):
    names = {passage.name for passage in restricted(world).passages}
    assert {"Bosporus", "Magellan"} < names
    assert not {"Oresund", "Raftsund", "Little Belt"} & names
    assert "Oresund" in {p.name for p in restricted(world, open=["oresund"]).passages}
    avoided = restricted(world, avoid=["Magellan", "Suez"])
    assert "Magellan" not in {p.name for p in avoided.passages}
    assert "suez" not in {canal.name for canal in avoided.canals}
    assert restricted(world, 0.0).passages == world.passages
    opened = restricted(world, open=["all"], avoid=["Raftsund"])
    every = {passage.name for passage in opened.passages}
    assert "Raftsund" not in every
    small = {p.name for p in world.passages if p.use == "small_or_local"}
    wide = {p.name for p in world.passages if p.name in small and p.max_draught >= 12.0}
    assert wide & every and names < every
    assert not {p.name for p in world.passages if p.name in small and p.max_draught < 9.0} & every
    with pytest.raises(InputError, match="Bosporus"):
        restricted(world, avoid=["Bosphorus"])
    with pytest.raises(InputError, match="cannot be opened"):
        restricted(world, open=["Menai"])
    with pytest.raises(InputError, match="cannot be opened"):
        restricted(world, open=["Dover"], avoid=["Dover"])


def off_land(chart, route):
    """Return the least distance to land [m] of a route and where it is."""
    lat, lon, _ = densify(route.track.lat, route.track.lon, 50.0)
    shore = chart.coastline.shore_distance(lat, lon)
    k = int(np.argmin(shore))
    return float(shore[k]), (float(lat[k]), float(lon[k]))


@pytest.fixture(scope="module")
def ship():
    return Ship.simple(speed_kn=12.0, draught_m=9.0)


@pytest.mark.slow
def test_a_plan_keeps_two_miles_off_a_cape_and_says_so(world, ship):
    # past Cape Tourinan and Cape Finisterre
    voyage = Voyage(start=(43.35, -9.30), goal=(42.75, -9.30), depart=DEPART)
    free = plan(
        Voyage(start=(43.35, -9.30), goal=(42.75, -9.30), depart=DEPART, offing_nm=0),
        ship=ship, sea=Sea.calm(), chart=world,
    )  # fmt: skip
    kept = plan(voyage, ship=ship, sea=Sea.calm(), chart=world)
    assert off_land(world, free.best)[0] < 1.5 * NM
    assert off_land(world, kept.best)[0] >= 0.985 * 2.0 * NM
    assert any(note.startswith("Keeps 2 nm off land") for note in kept.notes)
    assert any(note.startswith("Nearest land: 2.0 nm") for note in kept.notes)
    assert kept.best.feasible
    assert kept.lower_bound <= kept.objective_value


def test_the_referee_names_a_leg_that_is_too_near(world, ship):
    from thalweg import evaluate

    near = evaluate(
        [(43.35, -9.32), (42.75, -9.32)], depart=DEPART, ship=ship, sea=Sea.calm(),
        chart=world.with_offing(2.0 * NM),
    )  # fmt: skip
    (first, *_) = near.violations
    assert first.reason.startswith("nearer to land than the offing")
    assert first.value < first.limit == pytest.approx(2.0 * NM)
    shore = float(world.coastline.shore_distance(first.lat, first.lon))
    assert shore == pytest.approx(first.value, rel=0.01)


@pytest.mark.slow
def test_where_no_route_exists_a_smaller_offing_is_used_and_stated(ship):
    # two lands 1.6 nm apart, without a named passage
    wall = [[[-1.0, -0.2], [-0.8 / 60, -0.2], [-0.8 / 60, 0.2], [-1.0, 0.2], [-1.0, -0.2]]]
    other = [[[-x, y] for x, y in wall[0]]]
    land = {"type": "MultiPolygon", "coordinates": [wall, other]}
    chart = Chart.from_geojson(land).within(-0.6, 0.6, -0.9, 0.9)
    voyage = Voyage(start=(-0.5, 0.0), goal=(0.5, 0.0), depart=DEPART)
    found = plan(voyage, ship=ship, sea=Sea.calm(), chart=chart)
    assert any("No route exists 2 nm off land: keeps 0.5 nm" in note for note in found.notes)
    assert any(note.startswith("Nearest land: 0.8 nm") for note in found.notes)
    assert found.best.distance_nm == pytest.approx(59.7, abs=0.3)


@pytest.mark.slow
def test_an_end_near_land_is_relaxed_there_only(world, ship):
    voyage = Voyage(start=(43.05, -9.33), goal=(42.4, -9.35), depart=DEPART)
    found = plan(voyage, ship=ship, sea=Sea.calm(), chart=world)
    assert any("less near 43.05" in note for note in found.notes)
    lat, lon, _ = densify(found.best.track.lat, found.best.track.lon, 100.0)
    away = distance(43.05, -9.33, lat, lon)
    shore = world.coastline.shore_distance(lat, lon)
    assert (shore[away > 4.0 * NM] >= 0.985 * 2.0 * NM).all()
    assert OffingDisc(43.05, -9.33, 1.0).radius == 0.0


@pytest.mark.slow
def test_a_route_through_narrows_lists_them(world, ship):
    voyage = Voyage(start=(40.3, 25.5), goal=(41.6, 29.4), depart=DEPART, objective="distance")
    found = plan(voyage, ship=ship, sea=Sea.calm(), chart=world)
    text = " ".join(found.notes)
    assert "Passes Dardanelles" in text
    assert "Passes Bosporus (line at least" in text
    assert "air draught 58 m" in text
    assert found.best.feasible
    assert found.best.distance_nm == pytest.approx(229.0, abs=5.0)  # by the lines of the table 232


def test_only_closed_passages_that_would_shorten_the_route_are_mentioned():
    """Round a cape: 60 nm to it and 60 back; by a passage near its root 75 nm in all."""

    def route(*places):
        lat, lon = np.array(places, float).T
        return SimpleNamespace(track=SimpleNamespace(lat=lat, lon=lon))

    round_cape = route((0.0, 0.0), (1.0, 0.25), (0.0, 0.5))
    root = Passage("Root", "trade", ((0.1, 0.1), (0.1, 0.4)))
    by_cape = 2.0 * distance(0.0, 0.0, 1.0, 0.25)
    short = 2.0 * distance(0.0, 0.0, 0.1, 0.1) + root.length
    assert saved_length(round_cape, root) == pytest.approx(by_cape - short, rel=0.02)
    assert saved_length(route((0.0, 0.5), (1.0, 0.25), (0.0, 0.0)), root) > 60.0 * NM
    away = Passage("Away", "trade", ((5.0, 0.1), (5.0, 0.4)))
    assert saved_length(round_cape, away) < 0.0


# The old network left Recife by one leg of 118 nm to a node beyond it and came back.
@pytest.mark.slow
def test_no_route_passes_its_goal_and_returns(world, ship):
    voyage = Voyage(start=(-6.5, -34.5), goal=(-8.05, -34.8707), depart=DEPART, offing_nm=0)
    found = plan(voyage, ship=ship, sea=Sea.calm(), chart=world)
    assert found.best.track.lat.min() > -8.1
    assert found.lower_bound <= found.objective_value


@pytest.mark.slow
def test_liverpool_is_not_left_by_the_menai_strait(world, ship):
    for offing in (0.0, None):
        voyage = Voyage(start=(53.45, -3.3), goal=(52.3, -4.9), depart=DEPART, offing_nm=offing)
        found = plan(voyage, ship=ship, sea=Sea.calm(), chart=world)
        lat, lon, _ = densify(found.best.track.lat, found.best.track.lon, 500.0)
        inside = (np.abs(lat - 53.18) < 0.08) & (np.abs(lon + 4.2) < 0.12)
        assert not inside.any()


@pytest.mark.slow
def test_new_york_is_left_by_the_narrows(world):
    bulker = Ship.load("handysize-bulker")
    voyage = Voyage(start=(40.70, -74.02), goal=(38.5, -73.0), depart=DEPART, objective="distance")
    found = plan(voyage, ship=bulker, sea=Sea.calm(), chart=world)
    lat, lon, _ = densify(found.best.track.lat, found.best.track.lon, 200.0)
    narrows = (np.abs(lat - 40.606) < 0.01) & (np.abs(lon + 74.045) < 0.015)
    assert narrows.any()
    assert found.best.track.lon.max() < -72.9  # not by Long Island Sound
    assert found.lower_bound <= found.best.distance_nm < 150.0


@pytest.mark.parametrize("share", [0.9999, 0.9991, 0.99, 0.5])
def test_an_end_a_little_nearer_to_land_than_the_offing_can_be_reached(share):
    """The sea end of the approach of Balboa is 2 m nearer to land than two miles."""
    chart = Chart.gshhg("i")
    place = 8.8733, -79.5313
    offing = float(chart.coastline.shore_distance(*place)) / share
    off_land = chart_off_land(chart, [Endpoint("Balboa, PA", *place, 0.0)], offing)
    assert off_land.is_navigable(*place)


@pytest.mark.parametrize(
    ("place", "least", "within"),
    [
        ((-33.8517, 151.2250), 0.1, 5.0),  # Sydney: the harbour is 0.3 nm wide
        ((50.15, -5.0333), 0.25, 3.0),  # Carrick Roads
        ((-34.0467, 18.3533), 0.5, 3.0),  # Hout Bay
    ],
)
def test_as_much_distance_from_land_as_possible_is_kept_on_the_way_out_of_a_harbour(
    place, least, within
):
    """Routes touched headlands up to 7 nm from such a place."""
    chart = chart_off_land(world_chart(), [Endpoint("", *place, 0.0)], 2.0 * NAUTICAL_MILE)
    at_end, round_it = (d for d in chart.offing.discs if (d.lat, d.lon) == place)
    assert (round_it.least, round_it.radius) == (least * NAUTICAL_MILE, within * NAUTICAL_MILE)
    assert at_end.radius == 0.0


def test_an_end_in_a_sound_that_is_nowhere_wide_keeps_a_quarter_of_a_mile(world):
    """Puget Sound: no water there is as far from land as the offing, and none was kept."""
    end = Endpoint("", 47.30, -122.45, 0.0)
    discs = chart_off_land(world, [end, end], 3704.0).offing.discs
    own = [disc for disc in discs if (disc.lat, disc.lon) == (end.lat, end.lon)]
    assert max(disc.radius for disc in own) == pytest.approx(40.0 * NAUTICAL_MILE)
    widest = max(own, key=lambda disc: disc.radius)
    assert widest.least == pytest.approx(0.25 * NAUTICAL_MILE)
