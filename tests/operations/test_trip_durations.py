"""Tables of one trip over all departures."""

from copy import deepcopy

import numpy as np
import pytest

from thalweg.chart import Chart
from thalweg.core.errors import CoverageError, InputError, MissingVariableError
from thalweg.core.geodesy import distance
from thalweg.operations.waiting import Departures, TripTable, trip_table
from thalweg.route import evaluate
from thalweg.sea import Sea
from thalweg.ship import Ship

EAST, NORTH = "eastward_sea_water_velocity", "northward_sea_water_velocity"
DEPTH = "sea_floor_depth_below_geoid"
WEST_END, EAST_END = (52.0, 3.0), (52.0, 3.3)
TIDE = 44700.0


def sea_of(east=0.0, north=0.0, depth=20.0, **more):
    def field(value):
        return value if callable(value) else (lambda t, la, lo: value + 0.0 * la)

    named = {EAST: field(east), NORTH: field(north), DEPTH: field(depth)}
    return Sea.from_functions({**named, **more}).filled(wind=0.0, waves=0.0)


def rising_waves(height, *, from_deg, period):
    """Return a sea without wind and current, 20 m deep, its waves a function of time."""
    waves = {
        "sea_surface_wave_significant_height": lambda t, la, lo: height(t) + 0.0 * la,
        "sea_surface_wave_from_direction": lambda t, la, lo: from_deg + 0.0 * la,
        "sea_surface_wave_period_at_variance_spectral_density_maximum": lambda t, la, lo: (
            period + 0.0 * la
        ),
    }
    still = {name: lambda t, la, lo: 0.0 * la for name in (EAST, NORTH)}
    deep = {DEPTH: lambda t, la, lo: 20.0 + 0.0 * la}
    return Sea.from_functions({**waves, **still, **deep}).filled(wind=0.0)


def vox():
    return Ship.load("vox-olympia")


def test_still_water_takes_length_over_speed():
    ship = vox()
    table = trip_table(
        [WEST_END, EAST_END],
        ship=ship,
        sea=sea_of(depth=1e4),
        departures=Departures(0.0, period=TIDE, step=TIDE / 4),
    )
    length = float(distance(*WEST_END, *EAST_END))
    assert table.duration == pytest.approx(length / ship.speeds[-1], rel=1e-4)
    assert table.energy == pytest.approx(3500e3 * table.duration, rel=2e-3)
    assert table.current == pytest.approx(0.0, abs=1e-15)


@pytest.mark.slow
def test_a_tide_is_met_as_the_referee_meets_it():
    ship = vox()
    sea = sea_of(
        lambda t, la, lo: 0.6 * np.sin(2 * np.pi * t / TIDE) + 0.0 * la,
        lambda t, la, lo: 0.8 * np.cos(2 * np.pi * t / TIDE) + 0.0 * la,
        depth=lambda t, la, lo: 20.0 - 30.0 * (lo - 3.0),
    )
    table = trip_table(
        [WEST_END, EAST_END],
        ship=ship,
        sea=sea,
        departures=Departures(0.0, period=TIDE, step=TIDE / 12),
    )
    for depart, took in zip(table.times, table.duration):
        route = evaluate([WEST_END, EAST_END], ship=ship, sea=sea, depart=depart)
        assert took == pytest.approx(route.arrive - depart, abs=0.5)
    sent = table.current
    assert sent == pytest.approx(0.6 * np.sin(2 * np.pi * table.times / TIDE), abs=0.01)


def test_a_bar_at_low_water_closes_departures():
    level = {
        "sea_surface_height_above_geopotential_datum": lambda t, la, lo: (
            1.5 * np.sin(2 * np.pi * t / TIDE) + 0.0 * la
        )
    }
    sea = sea_of(depth=6.0, **level)
    table = trip_table(
        [WEST_END, EAST_END],
        ship=vox(),
        sea=sea,
        departures=Departures(0.0, period=TIDE, step=TIDE / 60),
        min_ukc=1.5,
    )
    start, end = table.times, table.times + np.where(np.isfinite(table.duration), table.duration, 0)
    inside = [np.sin(2 * np.pi * t / TIDE) * 1.5 - 0.5 for t in (start, end)]
    open_ = np.isfinite(table.duration)
    assert open_.any() and not open_.all()
    assert min(inside[0][open_].min(), inside[1][open_].min()) > -0.02
    assert (table.steps[~open_] == -1).all() and (table.steps[open_] > 0).all()
    finer = table.refined(3)
    assert np.isfinite(finer.duration[::3]).tolist() == open_.tolist()


def test_a_current_that_is_too_strong_is_no_departure_and_no_data_is_an_error():
    ahead = trip_table(
        [WEST_END, EAST_END],
        ship=vox(),
        sea=sea_of(east=-9.0),
        departures=Departures(0.0, period=TIDE, step=TIDE),
    )
    assert np.isposinf(ahead.duration).all() and np.isposinf(ahead.energy).all()
    short = (
        Sea.from_functions(
            {n: (lambda t, la, lo: 0.0 * la) for n in (EAST, NORTH)}, period=(0.0, 3600.0)
        )
        + sea_of()
    )
    both = Sea.layered(
        Sea.from_functions({DEPTH: lambda t, la, lo: 20.0 + 0.0 * la}, period=(0.0, 3600.0)),
        Sea.from_functions({n: (lambda t, la, lo: 0.0 * la) for n in (EAST, NORTH)}),
    ).filled(wind=0.0, waves=0.0)
    assert short.sample([EAST], 1e6, *WEST_END)[EAST] == 0.0
    with pytest.raises(CoverageError, match="not known"):
        trip_table(
            [WEST_END, EAST_END],
            ship=vox(),
            sea=both,
            departures=Departures(0.0, end=7200.0, step=600.0),
        )


def test_charted_depth_counts():
    chart = Chart.open_water(51.0, 53.0, 2.0, 5.0).with_depth(
        lambda lat, lon: np.where(lon > 3.1, 5.5, 20.0)
    )
    sea = Sea.calm()
    departures = Departures(0.0, period=TIDE, step=TIDE)
    asked = {"ship": vox(), "sea": sea, "departures": departures, "chart": chart}
    assert np.isfinite(trip_table([WEST_END, EAST_END], **asked, min_ukc=0.4).duration).all()
    assert np.isinf(trip_table([WEST_END, EAST_END], **asked, min_ukc=0.6).duration).all()


def with_rudder_drag():
    text = dict(vox().data)
    return Ship.from_dict({**text, "models": {**text["models"], "rudder": "schless_2023"}})


def test_rudder_drag_is_that_of_the_referee():
    ship, ends, sea = with_rudder_drag(), [WEST_END, EAST_END], sea_of(0.4, 1.5)
    asked = {"ship": ship, "sea": sea}
    table = trip_table(ends, departures=Departures(0.0, period=TIDE, step=TIDE), **asked)
    route = evaluate(ends, depart=0.0, **asked)
    assert table.duration[0] == pytest.approx(route.arrive - route.depart, rel=1e-5)


@pytest.mark.parametrize("ship", [vox, with_rudder_drag])
def test_a_current_across_that_is_too_strong_is_no_departure(ship):
    departures = Departures(0.0, period=TIDE, step=TIDE)
    table = trip_table(
        [WEST_END, EAST_END], ship=ship(), sea=sea_of(north=9.0), departures=departures
    )
    assert np.isposinf(table.duration).all()


def test_rudder_drag_slows_a_ship_that_crabs_and_only_then():
    dragged = with_rudder_drag()
    for north, slower in ((0.0, False), (1.0, True)):
        plain, drag = (
            trip_table(
                [WEST_END, EAST_END],
                ship=s,
                sea=sea_of(north=north),
                departures=Departures(0.0, period=TIDE, step=TIDE),
            ).duration[0]
            for s in (vox(), dragged)
        )
        assert bool(drag > plain * 1.005) is slower
        assert drag < plain * 1.03


@pytest.mark.parametrize(
    "window",
    [
        {},
        {"end": 3600.0, "period": TIDE},
        {"end": -5.0},
        {"end": 3600.0, "step": 0.0},
        {"end": 3600.0, "step": float("nan")},
        {"period": 1e9, "step": 1.0},
    ],
)
def test_windows_that_make_no_table_are_refused(window):
    with pytest.raises(InputError):
        Departures(0.0, **window)


def test_a_ship_without_power_is_refused():
    with pytest.raises(InputError, match="power"):
        trip_table(
            [WEST_END, EAST_END],
            ship=Ship.simple(8.0),
            sea=Sea.calm(),
            departures=Departures(0.0, period=TIDE),
        )


def test_a_ship_that_feels_the_bed_needs_its_depth():
    asked = {"ship": vox(), "departures": Departures(0.0, period=TIDE, step=TIDE)}
    with pytest.raises(MissingVariableError, match="depends on the depth"):
        trip_table([WEST_END, EAST_END], sea=Sea.calm(), **asked)


def test_refinement_reuses_sailed_departures_and_is_smooth_between():
    at = np.arange(100) / 100
    wave = 1000.0 + 50.0 * np.sin(2 * np.pi * at)
    table = TripTable("a", 0.0, 447.0, wave, 3.0 * wave, wave, periodic=True)
    finer = table.refined(10)
    assert len(finer) == 1000 and finer.step == pytest.approx(44.7)
    assert finer.duration[::10] == pytest.approx(wave, rel=1e-12)
    exact = 1000.0 + 50.0 * np.sin(2 * np.pi * np.arange(1000) / 1000)
    assert np.abs(finer.duration - exact).max() < 1e-4
    with pytest.raises(InputError):
        table.refined(0)


def test_what_a_ship_must_not_do_in_waves_closes_a_departure():
    """Accelerations are limited; the referee objects to what the table leaves out."""
    data = deepcopy(dict(vox().data))
    data["limits"] = {"max_vertical_acceleration_m_s2": 0.4}
    ship = Ship.from_dict(data)
    sea = rising_waves(lambda t: t / 4000.0, from_deg=90.0, period=7.0)
    table = trip_table(
        [WEST_END, EAST_END],
        ship=ship,
        sea=sea,
        departures=Departures(0.0, end=16_000.0, step=2000.0),
    )
    allowed = [
        evaluate([WEST_END, EAST_END], ship=ship, sea=sea, depart=float(t)).feasible
        for t in table.times
    ]
    assert np.isfinite(table.duration).tolist() == allowed
    assert any(allowed) and not all(allowed)


def test_departures_that_meet_a_limit_have_no_arrival():
    """Waves exceed 4 m from a known time on; trips that are not finished by then fail."""
    closes = 20_000.0
    sea = rising_waves(lambda t: 4.0 + (t - closes) / 1e4, from_deg=270.0, period=8.0)
    table = trip_table(
        [WEST_END, EAST_END],
        ship=vox(),
        sea=sea,
        departures=Departures(0.0, end=25_000.0, step=50.0),
    )
    took = table.duration[0]
    sure = table.times + took < closes - 60.0
    late = table.times + took > closes + 60.0
    assert np.isfinite(table.duration[sure]).all() and np.isinf(table.duration[late]).all()
    assert sure.sum() > 250 and late.sum() > 150


def test_a_ship_without_power_is_refused_with_what_to_add():
    """The hopper dredger of van Halem has no power, and the message did not say what it lacks."""

    def table(ship):
        departures = Departures(0.0, period=TIDE, step=TIDE / 4)
        return trip_table([WEST_END, EAST_END], ship=ship, sea=sea_of(), departures=departures)

    dredger = Ship.load("hopper-dredger")
    with pytest.raises(InputError) as found:
        table(dredger.with_load_factor(0.0))
    asked = "add engine: {reference_speed_kn: 10, reference_power_kw: ...}"
    assert asked in str(found.value) and "set models: {calm_water: cubic}" in str(found.value)
    engine = {"reference_speed_kn": 10, "reference_power_kw": 2400}
    models = {**dredger.data["models"], "calm_water": "cubic"}
    with_power = Ship.from_dict({**dredger.data, "engine": engine, "models": models})
    found = table(with_power)
    assert found.energy == pytest.approx(2400e3 * found.duration)
    rows = Ship.from_dict(
        {
            "name": "rows",
            "hull": {"draught_m": 5.0},
            "table": {"speed_kn": [8, 10], "fuel_t_per_day": [3.0, 6.0]},
        }
    )
    with pytest.raises(InputError, match="add a column power_kw to its table"):
        table(rows)
