"""Waits for a storm over the goal: one wait and the direct way, where the ship arrives as early."""

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from thalweg import Chart, Sea, Ship, Track, Voyage, evaluate, plan
from thalweg.core.errors import NoRouteError
from thalweg.core.units import HOUR, KNOT
from thalweg.planning.report.note_order import danger_first
from thalweg.planning.report.waiting_report import PASSES_TIME, stemming_warnings
from thalweg.planning.single.fewer_waits import _how_early, with_fewer_waits
from thalweg.planning.single.late_paths import LatePaths
from thalweg.planning.single.waits_above_limits import without_waits_above_limits

GOAL, DIRECT_NM, LIMIT = 3.24, 194.8, 4.0
MINUTE_H = 1.0 / 60.0


def storm_round(x, y, lon, lat, radius):
    """Return the share of the greatest wave height round the middle (x, y) of a storm."""
    return np.exp(-((((lon - x) / radius) ** 2) + ((lat - y) / radius) ** 2))


def leaves_slowly(t, lat, lon):
    """Return waves of a storm that moves off eastwards from hour 50 on, at 3 kn [m]."""
    return 1.0 + 8.0 * storm_round(GOAL + 0.05 * np.maximum(t - 50.0, 0.0), 0.0, lon, lat, 1.0)


def ends_at_once(t, lat, lon):
    """Return waves of a storm that is over between hour 63 and 66 [m]."""
    return 1.0 + 7.0 * storm_round(GOAL, 0.0, lon, lat, 0.8) * (t < 66.0)


def moves_and_fades(t, lat, lon):
    """Return waves of a storm that moves north-west from hour 11 on, and fades by hour 71 [m]."""
    moved = np.maximum(t - 11.27, 0.0)
    height = 8.0 * storm_round(GOAL - 0.027 * moved, 0.034 * moved, lon, lat, 1.23)
    return 1.0 + height * np.clip((71.4 - t) / 12.0, 0.0, 1.0)


@pytest.fixture
def planned(tmp_path):
    """Plan the least time past waves given every 3 h, as a function of hours and degrees."""

    def of(waves, box=(-2.0, 2.0, -1.0, 5.0), **conditions):
        hours = np.arange(0.0, 145.0, 3.0)
        lat, lon = np.arange(box[0], box[1] + 0.01, 0.1), np.arange(box[2], box[3] + 0.01, 0.1)
        height = waves(*np.meshgrid(hours, lat, lon, indexing="ij"))
        name = "sea_surface_wave_significant_height"
        axes = {
            "time": np.datetime64("2026-05-01", "ns") + hours.astype(int) * np.timedelta64(1, "h"),
            "lat": ("lat", lat, {"units": "degrees_north"}),
            "lon": ("lon", lon, {"units": "degrees_east"}),
        }
        field = (("time", "lat", "lon"), height, {"standard_name": name, "units": "m"})
        xr.Dataset({"hs": field}, axes).to_netcdf(tmp_path / "waves.nc")
        return plan(
            Voyage(start=(0.0, 0.0), goal=(0.0, GOAL), depart="2026-05-01T00:00Z", **conditions),
            ship=Ship.simple(speed_kn=12.0, draught_m=5.0, max_wave_height_m=LIMIT),
            sea=Sea.open(tmp_path / "waves.nc"),
            chart=Chart.open_water(*box),
        )

    return of


@pytest.mark.slow
@pytest.mark.parametrize(
    ("waves", "longer", "later"),
    [(leaves_slowly, 1.003, 0.02 * MINUTE_H), (ends_at_once, 1.06, MINUTE_H)],
    ids=["slowly", "at once"],
)
def test_a_ship_waits_once_at_her_berth_and_sails_on(planned, waves, longer, later):
    """The first path found waits ten times, and is 8 % longer, or 25 % and a minute earlier."""
    found = planned(waves)
    best, wait = found.best, np.asarray(found.best.track.wait)
    assert best.feasible
    assert np.flatnonzero(wait).tolist() == [0]
    assert best.distance_nm < longer * DIRECT_NM
    assert best.time_h <= found.proof.solver_total + later
    assert found.lower_bound <= best.time_h
    assert (best.samples["sea_surface_wave_significant_height"] <= LIMIT * (1.0 + 1e-9)).all()


@pytest.mark.slow
def test_a_ship_that_may_not_wait_is_shown_what_it_costs(planned):
    """She sails to and fro for a day behind the storm; leaving 22.5 h later is as good."""
    found = planned(moves_and_fades, box=(-5.0, 5.0, -5.0, 9.0), wait=False)
    assert found.best.distance_nm > 2.0 * DIRECT_NM
    note = danger_first(found.notes)[0]
    assert note.startswith(PASSES_TIME)
    assert f"sails {found.best.distance_nm:.0f} nm" in note and "2.3 times what she needs" in note
    assert "at 2026-05-01T22:" in note and "depart then, or permit waits." in note


def test_a_ship_that_may_not_wait_and_need_not_has_no_such_note(planned):
    found = planned(lambda t, lat, lon: 1.0 + 0.0 * t, wait=False)
    assert not any(note.startswith(PASSES_TIME) for note in found.notes)


def test_a_refusal_of_a_ship_that_may_not_wait_names_waits(planned):
    def closes_the_goal(t, lat, lon):
        return 1.0 + 8.0 * (lon > 2.0) * (t < 60.0) + 0.0 * lat

    with pytest.raises(NoRouteError, match="short") as refusal:
        planned(closes_the_goal, wait=False)
    assert "permit waits where --no-wait forbids them" in str(refusal.value)
    assert "--depart-window" in str(refusal.value)


def context_in_wind(closed):
    """Return a context with a limit of 20 kn, in wind of 30 m/s where (hours, lon) is closed."""

    def wind(time, lat, lon):
        return np.where(closed(time / HOUR, lon), 30.0, 1.0) + 0.0 * lat

    names = ("eastward_wind", "northward_wind")
    sea = Sea.from_functions({names[0]: wind, names[1]: lambda time, lat, lon: 0.0 * time * lat})
    ship = Ship.simple(speed_kn=10.0, draught_m=5.0, max_wind_speed_kn=20.0)
    chart = Chart.open_water(-1.0, 1.0, -1.0, 2.0)
    return SimpleNamespace(
        ship=ship, chart=chart, latest_arrival=np.inf,
        voyage=SimpleNamespace(objective="distance"),
        evaluate=lambda track: evaluate(track, ship=ship, sea=sea, chart=chart, strict=False),
    )  # fmt: skip


def sailed_with(context, wait_h):
    """Return a route along the equator with waits [h] at waypoints every 0.2 degrees (1.2 h)."""
    lon = 0.2 * np.arange(len(wait_h))
    wait = HOUR * np.asarray(wait_h, float)
    route = context.evaluate(Track(0.0 * lon, lon, depart=0.0, wait=wait))
    assert route.feasible
    return route


NO_PATHS = LatePaths(None, None, np.inf, None, None, lambda time: None)


def test_waits_are_joined_as_far_as_the_limits_allow():
    """The third leg is open from hour 5 to 7, the last from hour 12 on: it takes two waits."""

    def closed(hour, lon):
        third = (np.abs(lon - 0.5) < 0.05) & ((hour < 5.0) | (hour > 7.0))
        return third | ((np.abs(lon - 1.1) < 0.05) & (hour < 12.0))

    context = context_in_wind(closed)
    route = sailed_with(context, [0.0, 1.5, 1.2, 2.0, 1.1, 0.0, 0.0])
    found = with_fewer_waits(context, route, NO_PATHS, last_departure=0.0)
    assert found.feasible
    assert np.flatnonzero(found.track.wait).tolist() == [1, 3]
    assert found.arrive == pytest.approx(route.arrive, abs=1.0)


def test_waits_are_joined_at_the_berth_where_all_can_be():
    context = context_in_wind(lambda hour, lon: (np.abs(lon - 0.7) < 0.05) & (hour < 9.0))
    route = sailed_with(context, [0.0, 3.0, 1.0, 1.1, 0.0])
    found = with_fewer_waits(context, route, NO_PATHS, last_departure=0.0)
    assert found.feasible
    assert np.flatnonzero(found.track.wait).tolist() == [0]
    assert found.arrive == pytest.approx(route.arrive, abs=1.0)


@pytest.mark.parametrize("wait_h", [[5.1, 0.0, 0.0, 0.0, 0.0], [0.05, 0.04, 0.0, 0.0, 0.0]])
def test_one_wait_at_the_berth_and_short_ones_on_the_direct_way_stay(wait_h):
    context = context_in_wind(lambda hour, lon: (np.abs(lon - 0.7) < 0.05) & (hour < 0.0))
    context.voyage.objective = "time"
    route = sailed_with(context, wait_h)
    assert with_fewer_waits(context, route, NO_PATHS, last_departure=0.0) is route


def test_one_wait_under_way_is_moved_to_the_berth():
    context = context_in_wind(lambda hour, lon: (np.abs(lon - 0.7) < 0.05) & (hour < 0.0))
    context.voyage.objective = "time"
    route = sailed_with(context, [0.0, 5.1, 0.0, 0.0, 0.0])
    found = with_fewer_waits(context, route, NO_PATHS, last_departure=0.0)
    assert np.asarray(found.track.wait).tolist() == [5.1 * HOUR, 0.0, 0.0, 0.0, 0.0]
    assert found.arrive == pytest.approx(route.arrive)


LON = 0.2 * np.arange(9)  # 1.2 h between two of them at 10 kn


def blows(hour, lon):
    """It blows at 0.6E from hour 4.5 to 6.4, and behind it until hour 8."""
    at_wait = (np.abs(lon - 0.6) < 0.05) & (hour > 4.5) & (hour < 6.4)
    return at_wait | ((np.abs(lon - 0.9) < 0.05) & (hour < 8.0))


def route_of(context, wait_h):
    wait = np.zeros(len(LON))
    wait[: len(wait_h)] = HOUR * np.asarray(wait_h, float)
    return context.evaluate(Track(0.0 * LON, LON, depart=0.0, wait=wait))


@pytest.fixture
def context():
    made = context_in_wind(blows)
    made.voyage.objective = "time"
    return made


def paths_with(early, *routes):
    """Return late paths that are found as these routes, without waits."""
    paths = SimpleNamespace(
        arrive=early.arrive,
        lasting=lambda time: paths,
        search_without_waits=lambda by: [one for one in routes if one.arrive <= by],
        search=lambda by: None,
        sail=lambda one: one,
        refine=lambda one: one,
    )
    return paths


def test_a_ship_arrives_later_where_she_would_wait_in_wind_above_her_limit(context):
    early = route_of(context, [0.0, 0.0, 0.0, 3.0])
    assert early.feasible
    late = context.evaluate(early.track.replaced(depart=3.3 * HOUR, wait=0.0 * LON))
    assert late.feasible and late.arrive > early.arrive
    found, notes = without_waits_above_limits(
        context, early, paths_with(early, late), last_departure=0.0
    )
    assert found.feasible and found.depart == 0.0
    assert np.flatnonzero(found.track.wait).tolist() == [0]
    assert early.arrive < found.arrive <= late.arrive
    (note,) = notes
    assert note.startswith("Arrives ") and "later than is possible" in note
    assert "wait at sea 3.0 h at 0.0000N 0.6000E in wind of up to 58.3 kn" in note


def test_a_route_stays_where_no_other_one_arrives_in_time(context):
    early = route_of(context, [0.0, 0.0, 0.0, 3.0])
    late = context.evaluate(early.track.replaced(depart=9.0 * HOUR, wait=0.0 * LON))
    assert without_waits_above_limits(context, early, paths_with(early), last_departure=0.0) == (
        early,
        [],
    )
    assert (
        without_waits_above_limits(context, early, paths_with(early, late), last_departure=0.0)[1]
        == []
    )
    context.voyage.objective = "distance"
    near = context.evaluate(early.track.replaced(depart=3.3 * HOUR, wait=0.0 * LON))
    assert (
        without_waits_above_limits(context, early, paths_with(early, near), last_departure=0.0)[1]
        == []
    )


def test_a_deadline_that_is_missed_by_far_is_refused_before_refinement(planned, monkeypatch):
    """It took 281 s to refuse a winter voyage that arrives a day late."""

    def refined(*arguments, **options):
        raise AssertionError("refined")

    monkeypatch.setattr("thalweg.planning.single.stretch.refine_track", refined)
    with pytest.raises(NoRouteError, match="No route arrives by 2026-05-01T12:00") as refusal:
        planned(lambda t, lat, lon: 1.0 + 0.0 * t, arrive_by="2026-05-01T12:00Z")
    assert "The earliest arrival is about 2026-05-01T16:1" in str(refusal.value)


@pytest.mark.slow
@pytest.mark.parametrize("wait", [True, False])
def test_a_ship_leaves_later_rather_than_stem_a_current(wait):
    """From hour 5.4 to hour 8 a ship of 10 kn would make 0.3 kn over ground in a strait."""
    sea = Sea.from_functions(
        {
            "eastward_sea_water_velocity": lambda t, y, x: np.where(
                (x > 0.9) & (x < 1.1) & (t < 8.0 * HOUR), -9.7 * KNOT, 0.0
            ),
            "northward_sea_water_velocity": lambda t, y, x: 0.0 * t,
        },
        period=(0.0, 40.0 * HOUR),
    )
    found = plan(
        Voyage(start=(0.0, 0.0), goal=(0.0, 2.0), depart="1970-01-01T00:00Z", wait=wait),
        ship=Ship.simple(speed_kn=10.0, draught_m=5.0),
        sea=sea,
        chart=Chart.open_water(-0.3, 0.3, -0.2, 2.2),
        resolution=8_000.0,
        proof=0.0,
    )
    assert found.best.time_h == pytest.approx(14.5, abs=0.3)
    assert bool(stemming_warnings(found.best)) != wait
    if wait:
        assert np.flatnonzero(found.best.track.wait).tolist() == [0]
        assert 1.5 < found.best.waiting_h < 2.7
        (note,) = (note for note in found.notes if "would stem the current" in note)
        assert note.startswith("Arrives ") and "less than 1 kn over ground for 2 h 3" in note


@pytest.mark.parametrize(("arrive", "words"), [
    (100.0 * 3600.0, "as early"), (99.95 * 3600.0, "as early"),
    (98.0 * 3600.0, "2 h 0 min earlier"),
])  # fmt: skip
def test_a_note_on_time_passed_states_how_much_earlier_a_later_departure_arrives(arrive, words):
    route, other = (SimpleNamespace(arrive=time) for time in (100.0 * 3600.0, arrive))
    assert _how_early(route, other) == words
