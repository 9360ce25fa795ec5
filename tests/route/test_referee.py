"""The referee against closed forms, its order of convergence, limits and gaps."""

import itertools
import math

import numpy as np
import pytest
import xarray as xr

from tests.route.planar import EAST, NORTH, Plane, ship
from thalweg.chart import Chart
from thalweg.core.errors import CoverageError, InputError, MissingVariableError, OutsidePeriodError
from thalweg.core.geodesy import distance
from thalweg.core.units import KNOT
from thalweg.route import Track, evaluate
from thalweg.sea import Sea
from thalweg.ship import Ship

LEVEL = "sea_surface_height_above_geopotential_datum"
BED = "sea_floor_depth_below_geoid"
UE, UN = "eastward_sea_water_velocity", "northward_sea_water_velocity"


@pytest.mark.parametrize(
    ("speed", "current", "goal_km", "seconds"),
    [
        (5.0, (1.0, 2.0), (100, 50), 16925.824036),
        (5.0, (-2.0, 1.5), (60, 80), 23094.010768),
        (10.0, (0.0, 4.0), (0, -100), 16666.666667),
        (3.0, (2.9, 0.0), (0, 30), 39056.673294),
    ],
)
def test_constant_current_matches_the_closed_form(speed, current, goal_km, seconds):
    plane = Plane(unit=10.0)  # a kilometre shrunk to ten metres
    sea = plane.sea(lambda t, x, y: current[0], lambda t, x, y: current[1])
    route = evaluate([(0, 0), plane.place(*goal_km)], ship=ship(speed), sea=sea, depart=0)
    assert route.time_h * 3600 * 100 == pytest.approx(seconds, rel=1e-7)
    assert route.tolerance_s < 1e-6
    assert route.feasible


def test_heading_crabs_against_the_current():
    # MOSWR eq. 3.26: 12 kn, current 1.5 kn east 0.8 kn south, course 40 degrees
    sea = Sea.from_functions(
        {UE: lambda t, a, o: 1.5 * KNOT + 0 * a, UN: lambda t, a, o: -0.8 * KNOT + 0 * a}
    )
    goal = (math.cos(math.radians(40)) / NORTH, math.sin(math.radians(40)) / EAST)
    route = evaluate([(0, 0), goal], ship=Ship.simple(12.0, 5.0), sea=sea, depart=0)
    row = route.waypoints()[0]
    assert row["speed_over_ground_kn"] == pytest.approx(12.23551364, rel=1e-6)
    assert row["heading_deg"] == pytest.approx(32.032691, abs=1e-4)


@pytest.mark.filterwarnings("error::RuntimeWarning")
@pytest.mark.parametrize("lat", [0.0, -3e-16])
def test_two_waypoints_at_one_place_take_no_time(lat):
    """Refined tracks may have them: a leg of no length."""
    sea = Sea.from_functions(
        {UE: lambda t, a, o: 0.5 * np.sin(t / 5000.0) + 0 * a, UN: lambda t, a, o: 0.2 + 0 * a}
    )
    once, twice = (
        evaluate(Track(*places, 0), ship=Ship.simple(10.0), sea=sea)
        for places in (([0, 0.5], [0, 1.0]), ([0, lat, 0.5], [0, 0, 1.0]))
    )
    assert twice.time_h == pytest.approx(once.time_h, rel=1e-9)


def test_mean_speed_over_equal_lengths_is_harmonic():
    route = evaluate(
        Track([0, 0, 0], [0, 1, 2], 0, setting=[0, 1]),
        ship=Ship.simple(speed_kn=10, draught_m=5, speeds_kn=[10, 14]),
        sea=Sea.calm(),
    )
    assert route.distance_nm / route.time_h == pytest.approx(11.6667, abs=1e-4)


def test_linear_shear_along_a_known_line():
    # u = g y, straight leg from (0,0) to (10,5), V 1: integrate 1/SOG by fine quadrature here
    g, plane = 0.1, Plane(unit=100.0)
    sea = plane.sea(lambda t, x, y: g * y, lambda t, x, y: 0.0)
    route = evaluate([(0, 0), plane.place(10, 5)], ship=ship(1.0), sea=sea, depart=0)
    length, east, north = math.hypot(10, 5), 10 / math.hypot(10, 5), 5 / math.hypot(10, 5)
    s = (np.arange(200_000) + 0.5) / 200_000
    u = g * 5 * s
    expected = length * np.mean(1 / (u * east + np.sqrt(1 - (u * north) ** 2)))
    assert route.time_h * 3600 / plane.unit == pytest.approx(expected, rel=1e-7)


def test_converges_with_order_four_and_reports_its_error():
    sea = Sea.from_functions(
        {
            UE: lambda t, a, o: np.cos(t / 7000 + 3 * a),
            UN: lambda t, a, o: np.sin(t / 9000 - 2 * o),
        }
    )
    track = [(40, -10), (41, -12), (40.5, -14)]
    told = [
        evaluate(track, ship=ship(5.0), sea=sea, depart=0, step=step)
        for step in (12000.0, 6000.0, 3000.0)
    ]
    errors = [route.tolerance_s for route in told]
    orders = [math.log2(a / b) for a, b in itertools.pairwise(errors)]
    assert min(orders) > 3.7
    best = evaluate(track, ship=ship(5.0), sea=sea, depart=0, step=500.0)
    for route in told:
        assert abs(route.arrive - best.arrive) < route.tolerance_s + best.tolerance_s


def test_strong_tides_settle_over_a_long_voyage():
    sea = Sea.from_functions(
        {
            UE: lambda t, a, o: 2 * np.cos(2 * np.pi * t / 44714 + a),
            UN: lambda t, a, o: 2 * np.sin(2 * np.pi * t / 44714 + o),
        }
    )
    route = evaluate([(0, 0), (0, 20)], ship=ship(4.0), sea=sea, depart=0)
    assert route.tolerance_s < 0.05
    time = route.samples["time"]
    assert np.all(np.diff(time) >= 0)
    # an independent small-step march with the midpoint rule
    t, pieces = 0.0, 20_000
    step = float(distance(0, 0, 0, 20)) / pieces
    for i in range(pieces):
        lon = 20 * (i + 0.5) / pieces
        u = lambda at: 2 * math.cos(2 * math.pi * at / 44714)  # noqa: E731
        v = lambda at: 2 * math.sin(2 * math.pi * at / 44714 + lon)  # noqa: E731, B023
        first = step / (u(t) + math.sqrt(16 - v(t) ** 2))
        middle = t + first / 2
        t += step / (u(middle) + math.sqrt(16 - v(middle) ** 2))
    assert route.arrive == pytest.approx(t, abs=0.5)


def test_a_jump_of_a_field_in_time_is_resolved():
    sea = Sea.from_functions(
        {UE: lambda t, a, o: np.where(t < 5000.0, 0.0, 1.0), UN: lambda t, a, o: 0.0 * a}
    )
    length = float(distance(0, 0, 0, 0.5))
    route = evaluate([(0, 0), (0, 0.5)], ship=ship(5.0), sea=sea, depart=0)
    expected = 5000.0 + (length - 25000.0) / 6.0
    assert route.arrive == pytest.approx(expected, abs=5.0)  # one piece takes 93 s


def test_waiting_passes_time_and_the_bar_is_judged_when_it_is_met():
    sea = Sea.from_functions(
        {BED: lambda t, a, o: np.where((o > 0.1) & (o < 0.2) & (t < 10000.0), 2.0, 20.0)}
    )
    boat = ship(5.0, draught=4.0)
    at_bar = float(distance(0, 0, 0, 0.1)) / 5.0
    straight = evaluate([(0, 0), (0, 0.3)], ship=boat, sea=sea, depart=0, min_ukc=1.0)
    assert [v.reason for v in straight.violations] == ["under-keel clearance"]
    assert straight.violations[0].value == pytest.approx(-2.0)
    assert straight.violations[0].limit == 1.0
    assert straight.violations[0].time == pytest.approx(at_bar, rel=0.02)
    assert straight.min_ukc_m == pytest.approx(-2.0)
    wait = 10000.0 - at_bar
    for extra, fine in ((0.5, True), (-20.0, False)):
        track = Track([0, 0, 0], [0, 0.1, 0.3], 0, [0, wait + extra, 0])
        route = evaluate(track, ship=boat, sea=sea, min_ukc=1.0)
        assert route.feasible is fine
        assert route.waiting_h == pytest.approx((wait + extra) / 3600)


def test_the_clearance_of_the_ship_file_is_required_unless_another_is_given():
    sea = Sea.from_functions({BED: lambda t, a, o: 6.0 + 0.0 * a})
    given = {
        "name": "tender",
        "speeds_kn": [10],
        "hull": {"draught_m": 4.0},
        "limits": {"min_under_keel_clearance_m": 2.5},
        "models": {"calm_water": "none"},
    }
    boat, ends = Ship.from_dict(given), [(0, 0), (0, 0.3)]
    (found,) = evaluate(ends, ship=boat, sea=sea, depart=0).violations
    assert (found.reason, found.limit) == ("under-keel clearance", 2.5)
    assert found.value == pytest.approx(2.0)
    assert evaluate(ends, ship=boat, sea=sea, depart=0, min_ukc=1.5).feasible
    assert evaluate(ends, ship=ship(5.0, draught=4.0), sea=sea, depart=0).feasible


def test_waiting_where_the_tide_falls_away_is_a_grounding():
    sea = Sea.from_functions(
        {BED: lambda t, a, o: 6.0 + 0 * a, LEVEL: lambda t, a, o: -t / 1000 + 0 * a}
    )
    track = Track([0, 0, 0], [0, 0.001, 0.002], 0, [0, 3000.0, 0])
    reasons = [v.reason for v in evaluate(track, ship=ship(5.0, 4.0), sea=sea).violations]
    assert "under-keel clearance (waiting)" in reasons


def test_the_least_clearance_is_that_of_a_wait_over_low_water():
    """The tide falls by 1 m while the ship waits, and has risen again when it continues."""
    low = 2000.0

    def level(t, a, o):
        return -np.clip(1.0 - np.abs(t - low) / 1000.0, 0.0, 1.0) + 0.0 * a

    sea = Sea.from_functions({BED: lambda t, a, o: 6.0 + 0 * a, LEVEL: level})
    track = Track([0, 0, 0], [0, 0.001, 0.002], 0, [0, 4000.0, 0])
    route = evaluate(track, ship=ship(5.0, 4.0), sea=sea, min_ukc=0.5)
    assert route.feasible
    assert route.legs["under_keel_clearance"][0] == pytest.approx(2.0)
    assert route.min_ukc_m == pytest.approx(1.0, abs=0.15)  # sampled every five minutes


@pytest.mark.parametrize(
    ("wait", "allowed", "tolerance"),
    [(8281.0, False, 0.1), (8325.0, False, 0.003), (8381.0, True, 0.0)],
)
def test_waves_above_the_limit_for_less_than_a_minute_are_found(wait, allowed, tolerance):
    """Waves of 6 m end between 5 and 6 h at 0.40E and east of it; the limit opens at 5.3333 h.

    Of the ship's wait of 8,356 s, 75 or 31 are missing: it meets 4.125 or 4.052 m at 0.40E, since
    the waves fall by a metre in 600 s. Points an eighth of a cell apart once allowed the second.
    """
    lat, lon, time = np.arange(-3, 4) * 0.02, np.arange(-10, 61) * 0.02, np.arange(25) * 3600.0
    height = np.interp(time, [5 * 3600.0, 6 * 3600.0], [6.0, 0.0])[:, None, None]
    height = height * ((lon > 0.39) & (lon < 0.61)) * np.ones((1, lat.size, 1))
    name = "sea_surface_wave_significant_height"
    fields = {name: (("time", "latitude", "longitude"), height, {"standard_name": name})}
    units = {"units": "seconds since 1970-01-01"}
    places = {"latitude": lat, "longitude": lon, "time": ("time", time, units)}
    sea = Sea.open(xr.decode_cf(xr.Dataset(fields, places)))
    boat = Ship.simple(speed_kn=8.0, draught_m=5.0, max_wave_height_m=4.0)
    there = float(distance(0.0, 0.0, 0.0, 0.4)) / (8.0 * KNOT)
    start = 5.3333 * 3600.0 - there - 8356.0  # a wait of 8356 s reaches 0.40E as the limit opens
    track = Track([0, 0, 0], [0, 0.2, 1.0], start, [0, wait, 0])
    route = evaluate(track, ship=boat, sea=sea)
    assert route.feasible is allowed
    if not allowed:
        (found,) = route.violations
        assert found.value == pytest.approx(4.0 + (8356.0 - wait) / 600.0, abs=tolerance)


@pytest.mark.parametrize(("peak", "allowed"), [(5.15, False), (5.02, False), (4.99, True)])
def test_waves_above_the_limit_are_found_between_near_points_of_a_slow_ship(peak, allowed):
    """A ship of 0.1 kn over ground takes a day between two points an eighth of a cell apart."""
    lat, lon, hour = np.arange(-3, 4) * 0.25, np.arange(-3, 4) * 0.25, np.arange(0, 49, 3.0)
    height = np.interp(hour, [9.0, 12.0, 15.0], [4.2, peak, 4.2])
    ones = np.ones((hour.size, lat.size, lon.size))
    values = {
        "sea_surface_wave_significant_height": height[:, None, None] * ones,
        UE: -4.9 * KNOT * ones,
        UN: 0.0 * ones,
    }
    dims = ("time", "latitude", "longitude")
    fields = {name: (dims, array, {"standard_name": name}) for name, array in values.items()}
    time = ("time", hour * 3600.0, {"units": "seconds since 1970-01-01"})
    places = {"latitude": lat, "longitude": lon, "time": time}
    sea = Sea.open(xr.decode_cf(xr.Dataset(fields, places)))
    boat = Ship.simple(speed_kn=5.0, draught_m=5.0, max_wave_height_m=5.0)
    goal = 2.4 / 60.0  # degrees east: 24 h
    route = evaluate([(0, 0), (0, goal)], ship=boat, sea=sea, depart=4 * 3600.0)
    assert route.time_h == pytest.approx(24.0, rel=0.01)
    assert route.feasible is allowed
    if not allowed:
        (found,) = route.violations
        assert found.value == pytest.approx(peak, abs=0.06)


@pytest.mark.filterwarnings("error")
def test_water_without_a_bed_is_deep_enough():
    """The differences of its depths were once of infinities, with a warning of numpy."""
    sea = Sea.from_functions({"sea_floor_depth_below_geoid": lambda t, a, o: np.inf + 0.0 * a})
    route = evaluate(
        Track([0, 0], [0, 0.5], 0.0), ship=Ship.simple(speed_kn=8.0, draught_m=5.0), sea=sea
    )
    assert route.feasible


def test_a_gap_is_reported_with_its_position():
    sea = Sea.from_functions(
        {UE: lambda t, a, o: np.where(o > 0.2, np.nan, 0.5), UN: lambda t, a, o: 0.0 * a}
    )
    with pytest.raises(CoverageError, match=r"0\.20\d\dE.*current \(eastward_sea"):
        evaluate([(0, 0), (0, 0.4)], ship=ship(5.0), sea=sea, depart=0, step=200.0)
    route = evaluate([(0, 0), (0, 0.1), (0, 0.4)], ship=ship(5.0), sea=sea, depart=0, strict=False)
    assert not route.feasible
    assert math.isnan(route.time_h)
    assert route.fuel_t is None
    assert math.isfinite(route.legs["arrive"][0])
    assert math.isnan(route.legs["arrive"][1])
    first = route.violations[0]
    assert first.reason.startswith("no data: eastward")
    assert first.lon == pytest.approx(0.2, abs=3e-3)
    assert route.waypoints()[-1]["time"] is None


def test_sailing_beyond_the_end_of_the_data_is_reported():
    sea = Sea.from_functions(
        {UE: lambda t, a, o: 0.5 + 0 * a, UN: lambda t, a, o: 0.0 * a}, period=(0.0, 3600.0)
    )
    with pytest.raises(OutsidePeriodError, match="1970-01-01T01:0") as found:
        evaluate([(0, 0), (0, 1)], ship=ship(5.0), sea=sea, depart=0)
    words = str(found.value)  # they named one component, and strict=False as if on every interface
    assert f"the data have no current ({UE}, {UN})." in words
    assert "outside the period of the data" in words
    assert "In Python, evaluate(..., strict=False) returns" in words


def test_a_ship_that_needs_what_the_sea_lacks_is_refused():
    with pytest.raises(MissingVariableError, match=r"does not have: .*wind") as found:
        evaluate(
            [(0, 0), (0, 1)],
            ship=Ship.simple(10, 5, max_wind_speed_kn=30),
            sea=Sea.from_functions({}),
            depart=0,
        )
    assert "--fill wind=0 (in Python, Sea.filled)" in str(found.value)


def test_missing_currents_are_a_stated_assumption():
    route = evaluate([(0, 0), (0, 1)], ship=ship(5.0), sea=Sea.from_functions({}), depart=0)
    assert any("still water is assumed" in text for text in route.assumptions)
    assert route.time_h == pytest.approx(float(distance(0, 0, 0, 1)) / 5.0 / 3600, rel=1e-12)


def test_current_too_strong_stops_the_ship():
    sea = Sea.from_functions(
        {UE: lambda t, a, o: np.where(o > 0.1, -6.0, 0.0), UN: lambda t, a, o: 0.0 * a}
    )
    route = evaluate([(0, 0), (0, 0.2)], ship=ship(5.0), sea=sea, depart=0)
    assert route.violations[0].reason == "current too strong to hold the course"
    assert route.violations[0].lon == pytest.approx(0.1, abs=3e-3)
    assert not route.feasible


@pytest.mark.parametrize(("wind", "current", "allowed"), [(19.0, -2.0, True), (21.0, 2.0, False)])
def test_wind_limit_is_for_the_wind_over_the_ground(wind, current, allowed):
    """As forecasts and masters state it; the wind over the moving water is 21 and 19 m/s here."""
    boat = Ship.simple(10, 5, max_wind_speed_kn=20 / KNOT)
    sea = Sea.from_functions(
        {
            "eastward_wind": lambda t, a, o: wind + 0 * a,
            "northward_wind": lambda t, a, o: 0.0 * a,
            UE: lambda t, a, o: current + 0 * a,
            UN: lambda t, a, o: 0.0 * a,
        }
    )
    route = evaluate([(0, 0), (0, 1)], ship=boat, sea=sea, depart=0)
    assert route.feasible is allowed
    if not allowed:
        assert route.violations[0].reason == "wind speed above the limit"
        assert route.violations[0].value == pytest.approx(21.0)


def test_departure_and_settings_are_checked():
    with pytest.raises(InputError, match="departure"):
        evaluate([(0, 0), (0, 1)], ship=ship(5.0), sea=Sea.calm())
    with pytest.raises(InputError, match="setting"):
        evaluate(Track([0, 0], [0, 1], 0, setting=[3]), ship=ship(5.0), sea=Sea.calm())
    with pytest.raises(InputError, match="step"):
        evaluate([(0, 0), (0, 1)], ship=ship(5.0), sea=Sea.calm(), depart=0, step=-1.0)


def test_fuel_is_rate_times_time_and_none_without_a_model():
    burner = Ship.simple(10, 5, fuel_t_per_day=24.0)
    route = evaluate([(0, 0), (0, 1)], ship=burner, sea=Sea.calm(), depart=0)
    assert route.fuel_t == pytest.approx(route.time_h, rel=1e-9)
    waited = evaluate(Track([0, 0, 0], [0, 0.5, 1], 0, [0, 7200, 0]), ship=burner, sea=Sea.calm())
    assert waited.fuel_t == pytest.approx(route.fuel_t, rel=1e-9)
    assert waited.time_h == pytest.approx(route.time_h + 2.0)
    assert evaluate([(0, 0), (0, 1)], ship=ship(5.0), sea=Sea.calm(), depart=0).fuel_t is None


def test_a_route_can_be_judged_again_and_agrees():
    first = evaluate([(0, 0), (5, 5)], ship=ship(5.0), sea=Sea.calm(), depart="2026-01-01T00:00Z")
    again = evaluate(first, ship=ship(5.0), sea=Sea.calm())
    assert again.arrive == first.arrive
    slower = evaluate(first, ship=Ship.simple(10, 5, speeds_kn=[5, 10]), sea=Sea.calm())
    assert slower.track.setting.tolist() == [0]


def test_table_has_the_promised_columns():
    route = evaluate([(0, 0), (0, 1)], ship=ship(5.0), sea=Sea.calm(), depart=0)
    frame = route.to_frame()
    for name in [
        "lat",
        "lon",
        "time",
        "course_deg",
        "heading_deg",
        "speed_through_water_kn",
        "speed_over_ground_kn",
        "waiting_h",
        "depth_m",
        "ukc_m",
        "current_speed_kn",
    ]:
        assert name in frame.columns
    assert frame["time"].iloc[-1].isoformat()[:16] == "1970-01-01T06:11"
    assert frame["speed_over_ground_kn"].iloc[0] == pytest.approx(5.0 / KNOT, rel=1e-9)


@pytest.mark.parametrize(
    "wrong", [{"ship": "handysize-bulker"}, {"sea": None}, {"min_ukc": -1.0}, {"min_ukc": math.nan}]
)
def test_invalid_arguments_are_refused(wrong):
    given = {"ship": Ship.simple(speed_kn=8.0, draught_m=5.0), "sea": Sea.calm(), "depart": 0.0}
    with pytest.raises(InputError):
        evaluate([(51.0, 1.0), (51.5, 2.0)], **{**given, **wrong})


@pytest.mark.parametrize(("low", "feasible"), [(2.0, True), (1.5, False)])
def test_a_bar_of_the_chart_counts_under_a_coarse_sea(low, feasible):
    """Levels at nodes 0.6 degrees apart had two points of check on a leg: none was on the bar."""
    named = {"standard_name": "sea_floor_depth_below_geopotential_datum", "units": "m"}
    bed = np.full((31, 201), 20.0)
    bed[:, 95:106] = 5.0
    axes = {"lat": 51.3 + 0.02 * np.arange(31), "lon": 3.0 + 0.005 * np.arange(201)}
    chart = Chart.open_water().with_depth(xr.Dataset({"bed": (("lat", "lon"), bed, named)}, axes))
    levels = ("time", "lat", "lon"), np.full((2, 2, 2), low), {"standard_name": LEVEL, "units": "m"}
    days = np.array(["2026-06-01", "2026-06-03"], "datetime64[ns]")
    level = xr.Dataset({"zos": levels}, {"time": days, "lat": [51.3, 51.9], "lon": [3.0, 4.0]})
    coaster = Ship.simple(10.0, 5.0)
    track = [(51.6, 3.1), (51.6, 3.9)]
    sea, depart = Sea.open(level), "2026-06-01T06:00Z"
    route = evaluate(track, ship=coaster, sea=sea, chart=chart, depart=depart, min_ukc=2.0)
    assert route.min_ukc_m == pytest.approx(low, abs=1e-3)
    assert route.feasible is feasible
