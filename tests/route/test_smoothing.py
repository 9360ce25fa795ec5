"""Smoothing against analytic optima, from crude first tracks; all scores are the referee's."""

import math

import numpy as np
import pytest

from tests.route.planar import Islands, Plane, rectangle, ship
from thalweg.chart import Chart
from thalweg.core.limits import Limits
from thalweg.route import RefinementConditions, Track, better_route, evaluate
from thalweg.route.evaluators.polyline import polyline_of_track
from thalweg.route.evaluators.time_evaluator import make_time_evaluator
from thalweg.route.refinement.string_pulling import string_pull
from thalweg.sea import Sea
from thalweg.ship import Ship

NO_LIMITS = Limits()
BED = "sea_floor_depth_below_geoid"
HALEM_DEGREE = 6372800 * math.pi / 180  # metres per degree of van Halem's sphere


def zero(t, x, y):
    return 0.0 * x


def improved(track, boat, sea, *, chart=None, limits=NO_LIMITS, **options):
    scored = evaluate(track, ship=boat, sea=sea, chart=chart, strict=False)
    table = ship(1.0).tabulate() if boat.speed_field is not None else boat.tabulate()
    better = better_route(
        scored,
        RefinementConditions(ship=boat, sea=sea, chart=chart, table=table, limits=limits),
        **options,
    )
    assert better.feasible
    return scored, better


def optimum_is_met(route, seconds, largest=1e-3):
    """Within 0.1 % of the optimum, and never below it by more than the plane's own flatness."""
    excess = route.time_h * 3600 / seconds - 1
    assert -5e-6 - route.tolerance_s / seconds < excess < largest


WORLDS = {
    # name: (flow, speed, crude points, optimum); van Halem-style units of length and speed
    "shear (10, 1, .1)": (
        (lambda t, x, y: 0.1 * y, zero),
        1.0,
        [(0, 0), (3, 2), (6, -1), (10, 0)],
        9.63889113,
    ),
    "shear (20, 2, .15)": (
        (lambda t, x, y: 0.15 * y, zero),
        2.0,
        [(0, 0), (10, 1), (20, 0)],
        9.29439062,
    ),
    "shear oblique": (
        (lambda t, x, y: 0.1 * y, zero),
        1.0,
        [(0, 0), (4, 3.5), (10, 5)],
        9.06234438,
    ),
    "vortex .5": (
        (lambda t, x, y: -0.5 * y, lambda t, x, y: 0.5 * x),
        1.0,
        [(1, 0), (0.5, 0.3), (-0.5, 0.1), (-1, 0)],
        1.80073445,
    ),
    "vortex .3": (
        (lambda t, x, y: -0.3 * y, lambda t, x, y: 0.3 * x),
        1.0,
        [(1, 0), (0.8, -0.8), (0, -1)],
        1.72970196,
    ),
    "moving vortex": (
        (lambda t, x, y: -0.2 * y, lambda t, x, y: 0.2 * (x - 0.3 * t)),
        1.0,
        [(-3, 0), (0, 0.5), (3, 0)],
        5.36960792,
    ),
    "constant": (
        (lambda t, x, y: 1.0 + 0 * x, lambda t, x, y: 2.0 + 0 * x),
        5.0,
        [(0, 0), (2, 4), (7, 2), (10, 5)],
        1.6925824036,
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", WORLDS)
def test_reaches_the_optimum_of_a_known_flow(name):
    flow, speed, points, seconds = WORLDS[name]
    plane = Plane(unit=1000.0)
    track = Track.from_positions([plane.place(*p) for p in points], depart=0)
    scored, better = improved(track, ship(speed), plane.sea(*flow))
    optimum_is_met(better, seconds * plane.unit, 3e-4)
    assert better.arrive < scored.arrive


@pytest.mark.slow
@pytest.mark.parametrize(("swing", "seconds"), [(False, 26240.4617), (True, 31512.4115)])
def test_halem_rotating_flow(swing, seconds):
    # van Halem (2019) trivial cases 1 and 2, certified by extremals; shrunk a hundred times
    plane = Plane(unit=HALEM_DEGREE / 100)

    def turn(t):
        return np.cos(2 * np.pi * t * HALEM_DEGREE / 24000.0) if swing else 1.0

    sea = plane.sea(
        lambda t, x, y: 2 * np.cos(np.pi * y) * turn(t),
        lambda t, x, y: -2 * np.cos(np.pi * x) * turn(t),
    )
    points = (
        [(0.1, 0.1), (0.3, 0.3), (0.5, 0.5), (0.5, 0.7), (0.9, 0.9)]
        if swing
        else [(0.1, 0.1), (0.3, 0.1), (0.4, 0.2), (0.6, 0.4), (0.8, 0.6), (0.9, 0.8), (0.9, 0.9)]
    )
    track = Track.from_positions([plane.place(*p) for p in points], depart=0)
    _, better = improved(track, ship(4.0), sea)
    optimum_is_met(better, seconds / 100)


@pytest.mark.slow
def test_halem_bar_waits_no_second_too_long():
    # trivial case 3: a bar dry until 18000 s; waiting is faster than the detour
    plane = Plane(unit=HALEM_DEGREE / 100)

    def bed(t, lat, lon):
        x, y = plane.xy(lat, lon)
        return np.where((x > 0.1) & (x < 0.9) & (y > 0.4) & (y < 0.6) & (t < 180.0), 0.0, 20.0)

    sea = Sea.from_functions({BED: bed}, time_step=6.0)
    points = [(0.5, 0.1), (0.45, 0.2), (0.5, 0.35), (0.5, 0.5), (0.55, 0.7), (0.5, 0.9)]
    lat, lon = np.array([plane.place(*p) for p in points]).T
    track = Track(lat, lon, 0, [0, 0, 150.0, 0, 0, 0])
    scored, better = improved(track, ship(4.0, 5.0), sea, limits=Limits(required_depth=5.0))
    assert scored.feasible
    optimum_is_met(better, 319.0329)
    assert better.waiting_h * 3600 == pytest.approx(319.0329 - 0.8 * plane.unit / 4.0, abs=0.5)


def test_cycloid_of_a_speed_field():
    # v = sqrt(2 g y), g = 1: the part of the cycloid (0,0) -> (10,2) from angle 0.6 on
    from scipy.optimize import brentq

    s = brentq(lambda s: (s - np.sin(s)) / (1 - np.cos(s)) - 5.0, 0.1, 6.2)
    r = 2.0 / (1 - np.cos(s))
    assert s * np.sqrt(r) == pytest.approx(6.14655212, rel=1e-8)
    first = (r * (0.6 - np.sin(0.6)), r * (1 - np.cos(0.6)))
    plane = Plane(unit=10.0)
    boat = Ship.from_speed_function(
        lambda c: np.sqrt(2 * np.maximum(plane.xy(c.lat, c.lon)[1], 1e-9)), top_speed=3.0
    )
    track = Track.from_positions([plane.place(*p) for p in (first, (5, 1), (10, 2))], depart=0)
    _, better = improved(track, boat, Sea.calm())
    optimum_is_met(better, (s - 0.6) * np.sqrt(r) * plane.unit)


@pytest.mark.slow
@pytest.mark.parametrize("objective", ["distance", "time"])
@pytest.mark.parametrize(
    "points",
    [
        [(-3, 0), (-2.5, 1.5), (-1.5, 1.5), (-0.5, 2), (0.5, 1.5), (1.5, 2), (2, 1), (3, 0.3)],
        [(-3, 0), (0, 5), (3, 0.3)],
    ],
)
def test_the_route_around_a_square_island_is_shortest(points, objective):
    plane, boat = Plane(unit=1000.0), ship(5.0)
    chart = Islands(rectangle(plane, -1, -1, 1, 1))
    track = Track.from_positions([plane.place(*p) for p in points], depart=0)
    _, better = improved(track, boat, Sea.calm(), chart=chart, objective=objective)
    shortest = math.hypot(2, 1) + 2 + math.hypot(2, 0.7)
    assert better.distance_nm * 1852 == pytest.approx(shortest * plane.unit, rel=3e-6)
    assert len(better.track) <= 6


@pytest.mark.slow
def test_smoothing_passes_land_on_the_given_side():
    plane, boat = Plane(unit=1000.0), ship(5.0)
    chart = Islands(rectangle(plane, -1, -1, 1, 3))
    track = Track.from_positions([plane.place(*p) for p in [(-3, 0), (0, 7), (3, 0)]], depart=0)
    _, better = improved(track, boat, Sea.calm(), chart=chart)
    assert better.distance_nm * 1852 / 1000 == pytest.approx(2 * math.hypot(2, 3) + 2, rel=1e-5)


def test_string_pulling_never_costs_more_and_removes_useless_waypoints():
    plane, boat = Plane(unit=1000.0), ship(5.0)
    rng = np.random.default_rng(5)
    points = [(0, 0), *((x, rng.uniform(-1, 1)) for x in range(1, 60)), (60, 0)]
    track = Track.from_positions([plane.place(*p) for p in points], depart=0)
    fields = Sea.calm().freeze_grid(-1, 1, -1, 1, 0, 1e5, [0, 1], spacing_deg=0.2)
    evaluator = make_time_evaluator(
        table=boat.tabulate(),
        chart=None,
        fields=fields,
        limits=NO_LIMITS,
        origin=0.0,
        by_length=False,
        total=6e4,
    )
    assert len(string_pull(polyline_of_track(track, evaluator), evaluator)) == 2
    behind = Islands(rectangle(plane, 10, -5, 11, 0.9))
    wall = make_time_evaluator(
        table=boat.tabulate(),
        chart=behind,
        fields=fields,
        limits=NO_LIMITS,
        origin=0.0,
        by_length=False,
        total=6e4,
    )
    detour = [(0, 0), (5, 0.5), (10.5, 1.0), (20, 0.5), (60, 0)]
    line = polyline_of_track(
        Track.from_positions([plane.place(*p) for p in detour], depart=0), wall
    )
    pulled = string_pull(line, wall)
    assert len(pulled) == 3
    assert wall.sail(pulled.batch())[1][0] <= wall.sail(line.batch())[1][0]


def test_string_pulling_looks_up_land_for_all_shortcuts_at_once():
    plane, boat = Plane(unit=1000.0), ship(5.0)
    chart = Islands(rectangle(plane, 10, -5, 11, 0.9))
    asked, tests = [], chart.legs_blocked
    chart.legs_blocked = lambda *ends: (asked.append(len(ends[0])), tests(*ends))[1]
    fields = Sea.calm().freeze_grid(-1, 1, -1, 1, 0, 1e5, [0, 1], spacing_deg=0.2)
    evaluator = make_time_evaluator(
        table=boat.tabulate(), chart=chart, fields=fields, limits=NO_LIMITS, origin=0.0,
        by_length=False, total=6e4,
    )  # fmt: skip
    points = [plane.place(x, 1.5 + 0.1 * x) for x in range(7)]
    line = polyline_of_track(Track.from_positions(points, depart=0), evaluator)
    assert len(string_pull(line, evaluator)) == 2
    assert asked == [21]  # of seven points


def test_smoothing_violates_no_limit_of_a_field():
    # waves too high in the middle of the way: the route must bend round, and does so closely
    plane = Plane(unit=1000.0)

    def waves(t, lat, lon):
        x, y = plane.xy(lat, lon)
        return 6.0 * np.exp(-((x - 5) ** 2 + y**2) / 2)

    sea = Sea.from_functions({"sea_surface_wave_significant_height": waves}, time_step=0.0)
    boat = Ship.simple(10, 5, max_wave_height_m=3.0)
    track = Track.from_positions([plane.place(*p) for p in [(0, 0), (5, 3), (10, 0)]], depart=0)
    scored, better = improved(track, boat, sea, limits=Limits(wave_height=3.0))
    radius = math.sqrt(2 * math.log(2))  # where the height is 3 m
    shortest = 2 * math.sqrt(25 - radius**2) + radius * (math.pi - 2 * math.acos(radius / 5))
    assert scored.distance_nm > better.distance_nm
    assert better.distance_nm * 1.852 == pytest.approx(shortest, rel=2e-3)
    assert max(better.samples["sea_surface_wave_significant_height"]) <= 3.0 + 1e-6


def test_the_time_evaluator_measures_like_the_geodesic():
    from thalweg.core.geodesy import distance
    from thalweg.route.evaluators.time_evaluator import TrackBatch

    fields = Sea.calm().freeze_grid(-85, 85, -100, 100, 0, 1e7, [0, 1], spacing_deg=5.0)
    evaluator = make_time_evaluator(
        table=ship(5.0).tabulate(),
        chart=None,
        fields=fields,
        limits=NO_LIMITS,
        origin=0.0,
        by_length=True,
        total=1e7,
    )
    rng = np.random.default_rng(2)
    lat, lon = rng.uniform(-70, 70, (200, 2)), rng.uniform(-90, 90, (200, 2))
    lat[:, 1] = lat[:, 0] + rng.uniform(-8, 8, 200)
    lon[:, 1] = lon[:, 0] + rng.uniform(-9, 9, 200)
    batch = TrackBatch(
        lat, lon, np.full(lat.shape, -math.inf), np.zeros((200, 1), int), np.zeros(200)
    )
    arrive, length = evaluator.sail(batch)
    exact = distance(lat[:, 0], lon[:, 0], lat[:, 1], lon[:, 1])
    assert np.max(np.abs(length / exact - 1)) < 1e-6
    assert np.max(np.abs(arrive[:, 1] * 5.0 / exact - 1)) < 1e-6


def test_the_time_evaluator_respects_the_edges_of_its_raster():
    from thalweg.route.evaluators.time_evaluator import TrackBatch

    fields = Sea.calm().freeze_grid(-1, 1, -1, 1, 0, 1e4, [0, 1], spacing_deg=0.5)
    evaluator = make_time_evaluator(
        table=ship(5.0).tabulate(),
        chart=None,
        fields=fields,
        limits=NO_LIMITS,
        origin=0.0,
        by_length=False,
        total=1e5,
    )
    lat, lon = np.zeros((3, 2)), np.array([[0.0, 0.5], [0.0, 1.5], [-0.9, 0.9]])
    batch = TrackBatch(lat, lon, np.full(lat.shape, -math.inf), np.zeros((3, 1), int), np.zeros(3))
    arrive, cost = evaluator.sail(batch)
    assert np.isfinite(cost).tolist() == [True, False, False]  # the last runs out of time
    assert arrive[0, 1] == pytest.approx(0.5 * 111319.49 / 5.0, rel=1e-6)


@pytest.mark.slow
def test_penalty_zones_are_avoided_when_that_is_cheaper():
    plane, boat = Plane(unit=1000.0), ship(5.0)
    ring = np.array([plane.place(*p) for p in [(-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1)]])
    zone = {
        "type": "Feature",
        "properties": {"kind": "penalty", "factor": 3.0},
        "geometry": {"type": "Polygon", "coordinates": [ring[:, ::-1].tolist()]},
    }
    chart = Chart.open_water(-1, 1, -1, 1).with_zones(
        {"type": "FeatureCollection", "features": [zone]}
    )
    track = Track.from_positions([plane.place(*p) for p in [(-3, 0), (0, 2.5), (3, 0)]], depart=0)
    _, better = improved(track, boat, Sea.calm(), chart=chart)
    round_it = 2 * math.hypot(2, 1) + 2  # straight through costs 4 + 3 * 2
    assert better.distance_nm * 1.852 == pytest.approx(round_it, rel=2e-3)
    assert better.distance_nm * 1.852 > round_it * 0.999


@pytest.mark.slow
def test_waits_for_the_tide_are_found_and_cut_to_what_they_must_be():
    # two bars, 4 m at datum; the tide gives the metre that is needed from 26585 s on
    def bed(t, lat, lon):
        return np.where(((lon > 0.2) & (lon < 0.25)) | ((lon > 0.6) & (lon < 0.65)), 4.0, 20.0)

    def level(t, lat, lon):
        return 2.0 * np.cos(2 * np.pi * t / 44714.0 + 1.5) + 0.0 * lat

    sea = Sea.from_functions({BED: bed, "sea_surface_height_above_geopotential_datum": level})
    boat = ship(5.0, 4.5)
    opens = (2 * math.pi - math.pi / 3 - 1.5) / (2 * math.pi) * 44714.0
    for wait in ([0, 30000, 0, 0, 0], [0, 30000, 0, 10000, 0]):
        track = Track([0, 0, 0.05, 0, 0], [0, 0.1, 0.4, 0.5, 0.8], 0, wait)
        scored = evaluate(track, ship=boat, sea=sea, min_ukc=0.5)
        assert not scored.feasible
        better = better_route(
            scored,
            RefinementConditions(
                ship=boat,
                sea=sea,
                chart=None,
                table=boat.tabulate(),
                limits=Limits(required_depth=5.0),
                min_ukc=0.5,
            ),
        )
        assert better.feasible
        assert better.time_h * 3600 == pytest.approx(opens + 0.6 * 111319.49 / 5.0, abs=2.0)
