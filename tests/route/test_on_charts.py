"""The referee and the smoothing on charts: land, depth and level; never for the worse."""

import math

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.route.planar import Plane, ship
from thalweg.chart import Chart
from thalweg.core.limits import Limits
from thalweg.route import RefinementConditions, Track, better_route, evaluate, read_track
from thalweg.sea import Sea

NO_LIMITS = Limits()
LEVEL = "sea_surface_height_above_geopotential_datum"


def test_legs_on_land_are_named():
    chart = Chart.gshhg("c")
    route = evaluate(
        [(48.0, -10.0), (50.0, -10.0), (50.0, 20.0)],
        ship=ship(5.0),
        sea=Sea.calm(),
        chart=chart,
        depart=0,
    )
    assert [v.reason for v in route.violations] == ["land: leg 2"]
    # where the leg first meets land: the north coast of Cornwall, long before its middle
    found = route.violations[0]
    assert 50.0 < found.lat < 50.8 and -6.0 < found.lon < -4.9
    leg = route.legs["depart"][1], route.legs["arrive"][1]
    share = (found.lon + 10.0) / 30.0
    assert found.time == pytest.approx(leg[0] + share * (leg[1] - leg[0]), abs=3600.0)
    assert not route.feasible
    assert math.isfinite(route.time_h)


def test_charted_depth_and_level_make_the_clearance():
    def bank(lat, lon):
        return np.where(np.abs(np.asarray(lon) - 0.5) < 0.05, 6.0, 30.0) + 0.0 * np.asarray(lat)

    chart = Chart.open_water(-1, 1, -1, 2).with_depth(bank)
    boat = ship(5.0, 5.0)
    sea = Sea.from_functions({LEVEL: lambda t, a, o: 0.5 + 0.0 * a})
    route = evaluate([(0, 0), (0, 1)], ship=boat, sea=sea, chart=chart, depart=0, min_ukc=1.0)
    assert route.min_ukc_m == pytest.approx(1.5, abs=1e-6)
    assert route.feasible
    tight = evaluate([(0, 0), (0, 1)], ship=boat, sea=sea, chart=chart, depart=0, min_ukc=2.0)
    assert [v.reason for v in tight.violations] == ["under-keel clearance"]
    assert tight.violations[0].value == pytest.approx(1.5, abs=1e-6)
    assert abs(tight.violations[0].lon - 0.5) < 0.06
    told = evaluate([(0, 0), (0, 1)], ship=boat, sea=Sea.calm(), chart=chart, depart=0)
    assert told.min_ukc_m == pytest.approx(1.0, abs=1e-6)
    assert any("chart datum" in text for text in told.assumptions)


@pytest.mark.slow
def test_smoothing_keeps_charted_depth():
    # a shoal of a grid, 4 m deep, that the pulled line passes at its northern edge
    lat, lon = np.arange(-30, 31) / 50.0, np.arange(-10, 71) / 50.0
    shoal = (np.abs(lon - 0.5) < 0.11) & (lat[:, None] < 0.09)
    grid = xr.DataArray(
        np.where(shoal, 4.0, 30.0),
        coords={"lat": lat, "lon": lon},
        dims=("lat", "lon"),
        name="depth",
        attrs={"units": "m", "positive": "down"},
    )
    chart = Chart.open_water(-0.5, 0.5, -0.1, 1.2).with_depth(grid, positive="down")
    boat = ship(5.0, 5.0)
    points = [(0, 0), (0.2, 0.3), (0.25, 0.6), (0, 1)]
    scored = evaluate(points, ship=boat, sea=Sea.calm(), chart=chart, depart=0)
    assert scored.feasible
    better = better_route(
        scored,
        RefinementConditions(
            ship=boat,
            sea=Sea.calm(),
            chart=chart,
            table=boat.tabulate(),
            limits=Limits(required_depth=5.0),
        ),
    )
    assert better.feasible
    assert better.min_ukc_m >= 0.0
    assert better.distance_nm <= scored.distance_nm
    assert better.distance_nm / 60.1 > 2 * math.hypot(0.4, 0.08) + 0.2


@pytest.mark.slow
@settings(max_examples=20)
@given(
    st.integers(0, 10_000),
    st.floats(-0.9, 0.9),
    st.floats(-0.9, 0.9),
    st.sampled_from(["time", "distance"]),
)
def test_smoothing_is_never_for_the_worse(seed, east, north, objective):
    plane, boat = Plane(unit=1000.0), ship(1.5)
    sea = plane.sea(
        lambda t, x, y: east * np.cos(0.7 * y + 0.3 * t),
        lambda t, x, y: north * np.sin(0.5 * x - 0.2 * t),
    )
    rng = np.random.default_rng(seed)
    points = [(0, 0), *zip(np.arange(1, 8), rng.normal(0, 1, 7)), (8, 1)]
    track = Track.from_positions([plane.place(*p) for p in points], depart=0)
    scored = evaluate(track, ship=boat, sea=sea)
    better = better_route(
        scored,
        RefinementConditions(
            ship=boat, sea=sea, chart=None, table=boat.tabulate(), limits=NO_LIMITS
        ),
        objective=objective,
    )
    assert better.feasible
    if objective == "time":
        assert better.arrive <= scored.arrive
    else:
        assert better.distance_nm <= scored.distance_nm
        assert better.distance_nm * 1.852 == pytest.approx(math.hypot(8, 1), rel=1e-5)
    assert better.track.positions[0] == scored.track.positions[0]
    assert better.track.positions[-1] == scored.track.positions[-1]


def test_violations_name_the_legs_of_the_given_file(tmp_path):
    """Rhumb lines are broken into geodesics; a leg that crosses land in several parts is one."""
    island = [[10.0, 49.0], [30.0, 49.0], [30.0, 51.0], [10.0, 51.0], [10.0, 49.0]]
    chart = Chart.from_geojson({"type": "Polygon", "coordinates": [island]})
    path = tmp_path / "route.csv"
    path.write_text("lat,lon,geometry\n55,0,RL\n53,1,RL\n52,5,RL\n50,35,RL\n40,40,RL\n")
    track = read_track(path, depart="2026-01-01T00:00Z")
    assert len(track) > 12 and track.leg_numbers.tolist() == sorted(track.leg_numbers.tolist())
    assert set(track.leg_numbers.tolist()) == {1, 2, 3, 4}
    route = evaluate(track, ship=ship(5.0), sea=Sea.calm(), chart=chart, strict=False)
    assert [one.reason for one in route.violations] == ["land: leg 3"]
    own = track.replaced(given_leg=None)
    assert own.leg_numbers.tolist() == list(range(1, len(track)))
    assert len(evaluate(own, ship=ship(5.0), sea=Sea.calm(), chart=chart).violations) > 3
    assert track.kept([0, len(track) - 1]).leg_numbers.tolist() == [1]
