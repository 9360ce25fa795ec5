"""Choices of a ship file that reach into several parts: squat, Kwon's loss, rudder, Hollenbach."""

import math

import numpy as np
import pytest

from thalweg.core.errors import InputError
from thalweg.core.units import KNOT
from thalweg.route import evaluate
from thalweg.sea import Sea
from thalweg.ship import Conditions, Ship
from thalweg.ship.methods.added_resistance.snnm_hull import (
    SnnmHull,
)
from thalweg.ship.methods.added_resistance.snnm_table import SnnmTable
from thalweg.ship.methods.shallow_water.barrass_squat import barrass_2004_speed, barrass_2004_squat
from thalweg.ship.methods.shallow_water.squat import shallow_water_speed
from thalweg.ship.methods.speed_loss import kwon_speed_loss
from thalweg.ship.model_check import check_ship_model
from thalweg.ship.performance_sheet import performance_sheet

HULL = {
    "length_waterline_m": 172.42,
    "length_between_perpendiculars_m": 169.0,
    "breadth_m": 32.0,
    "draught_m": 10.0,
    "block_coefficient": 0.785,
    "displacement_m3": 42450.0,
}
POWERED = {
    "name": "powered",
    "hull": HULL,
    "engine": {"power_kw": 9000, "type": "slow_speed_diesel"},
    "fuel": {"type": "hfo"},
    "powers_kw": [3600, 7650],
    "models": {"calm_water": "holtrop_1984", "speed_loss": "kwon_2008"},
}


def test_squat_by_barrass_2004_limits_the_speed_in_shallow_water():
    data = {
        "name": "shallow",
        "hull": HULL,
        "speeds_kn": [16],
        "limits": {"min_under_keel_clearance_m": 0.5},
        "models": {"squat": "barrass_2004"},
    }
    ship, depth = Ship.from_dict(data), np.array([10.4, 11.0, 12.0, 14.0, 60.0])
    speed = ship.speed_through_water(Conditions(depth=depth), 0)
    sizes = {"draught": 10.0, "breadth": 32.0, "block_coefficient": 42450 / (169 * 32 * 10)}
    left = barrass_2004_speed(depth - 10.5, depth, **sizes)
    slow = shallow_water_speed(16 * KNOT, depth, draught=10.0, breadth=32.0)
    assert speed == pytest.approx(np.minimum(np.minimum(left, slow), 16 * KNOT))
    assert speed[0] == 0.0 and (np.diff(speed) > 0).all()
    sunk = barrass_2004_squat(speed[1:3], depth[1:3], **sizes)
    assert (depth[1:3] - 10.0 - sunk == pytest.approx(0.5)) or (sunk < depth[1:3] - 10.5).all()
    other = Ship.from_dict({**data, "models": {"squat": "van_halem_2019"}})
    assert not np.allclose(speed, other.speed_through_water(Conditions(depth=depth), 0))
    assert ship.fingerprint() != other.fingerprint()
    check_ship_model(ship)


def test_the_speed_for_a_squat_is_its_inverse():
    sizes = {"draught": 10.0, "breadth": 32.0, "block_coefficient": 0.8}
    speed = barrass_2004_speed([0.0, 0.3, 1.2], 14.0, **sizes)
    assert barrass_2004_squat(speed, 14.0, **sizes) == pytest.approx([0.0, 0.3, 1.2])


def test_kwon_takes_speed_from_a_ship_with_a_resistance():
    ship = Ship.from_dict(POWERED)
    bare = Ship.from_dict({**POWERED, "models": {"calm_water": "holtrop_1984"}})
    c = Conditions(wind_speed=[0.0, 10.0, 18.0], wind_angle=[0.0, 0.5, 2.0])
    assert ship.needs == {"eastward_wind", "northward_wind"}
    for setting in (0, 1):
        calm = bare.speeds[setting]
        lost = kwon_speed_loss(
            c.wind_speed,
            c.wind_angle,
            speed=calm,
            length=169.0,
            block_coefficient=0.785,
            displacement_volume=42450.0,
            hold=True,
        )
        assert ship.speed_through_water(c, setting) == pytest.approx(calm * (1 - lost), rel=1e-5)
        assert ship.power(c, setting) == pytest.approx([3.6e6, 7.65e6][setting], rel=1e-4)
        assert ship.fuel_rate(c, setting) == pytest.approx(bare.fuel_rate(c, setting))
    assert ship.tabulate_fuel().axes == frozenset()
    check_ship_model(ship)


def test_the_power_at_an_attained_speed_is_that_of_the_calm_speed_behind_it():
    ship = Ship.from_dict(POWERED)
    c = Conditions(wind_speed=14.0, wind_angle=0.3)
    attained = ship.speed_through_water(c, 1)
    assert float(ship.power_at_speed(c, attained)) == pytest.approx(7.65e6, rel=1e-3)
    weather = {"wind_speed": 14.0, "wind_angle": 0.3}
    sheet = performance_sheet(ship, weather, speeds_kn=[float(attained) / KNOT])
    assert sheet["conditions"][0]["brake_power_kw"] == pytest.approx(7650, rel=1e-3)


def test_kwon_with_wind_or_wave_resistance_is_refused():
    models = {**POWERED["models"], "waves": "stawave_1"}
    with pytest.raises(InputError, match=r"together with models\.waves.*twice"):
        Ship.from_dict({**POWERED, "models": models})


@pytest.mark.parametrize("method", ["hollenbach_1998_mean", "hollenbach_1998_min", "holtrop_1984"])
def test_the_components_of_the_sheet_add_up_under_their_stable_names(method):
    data = {
        **POWERED,
        "propulsion": {"propeller_diameter_m": 6.0},
        "hull": {**HULL, "length_over_surface_m": 172.42, "appendage_area_m2": 60.0},
        "models": {"calm_water": method, "waves": "stawave_1"},
    }
    weather = {"wave_height": 2.0, "wave_period": 8.0}
    sheet = performance_sheet(Ship.from_dict(data), weather, speeds_kn=[10, 14])
    names = {
        *("friction", "form_factor", "appendage", "wave_making", "bulb", "transom"),
        *("correlation", "waves", "wind", "shallow", "rudder"),
    }
    for row in sheet["conditions"]:
        parts = row["resistance_n"]
        assert parts.keys() == names | {"total"}
        assert sum(parts[name] for name in names) == pytest.approx(parts["total"], rel=1e-12)
        assert parts["wave_making"] > 0 and parts["friction"] > 0


def test_the_rudder_drags_in_the_referee_where_the_current_is_across():
    def sea(across):
        still = {"northward_sea_water_velocity": lambda t, lat, lon: 0.0 * lat}
        east = {"eastward_sea_water_velocity": lambda t, lat, lon: across + 0.0 * lat}
        return Sea.from_functions({**still, **east})

    models = {"calm_water": "holtrop_1984"}
    hull = {**HULL, "rudder_area_m2": 40.0}
    plain = Ship.from_dict({**POWERED, "hull": hull, "models": models})
    steered = Ship.from_dict(
        {**POWERED, "hull": hull, "models": {**models, "rudder": "schless_2023"}}
    )
    assert steered.heading_matters and not plain.heading_matters
    north = [(50.0, -20.0), (50.5, -20.0)]
    for across, slower in ((0.0, False), (1.5, True)):
        times = [
            evaluate(north, ship=ship, sea=sea(across), depart="2026-01-01T00:00Z").time_h
            for ship in (plain, steered)
        ]
        assert (times[1] > times[0] * 1.0005) is slower
        if not slower:
            assert times[1] == pytest.approx(times[0], rel=1e-6)
    crab = math.asin(1.5 / 7.5)
    drag = [
        steered.resistance(Conditions(crab_angle=sign * crab), 7.5)["rudder"] for sign in (-1, 1)
    ]
    assert drag[0] == drag[1] > 0.0


def test_the_snnm_formula_jumps_at_the_angle_of_entrance_only():
    hull = SnnmHull(320.0, 58.0, 20.8, 20.8, 0.81, 56.0, 96.0)
    entrance = math.degrees(math.atan(0.495 * 58.0 / 56.0))
    angles = np.arange(20.0, 45.0, 0.1)
    table = SnnmTable.of(hull, shortest=7.9, longest=8.1)
    force = table(7.9, 3.0, 8.0, np.radians(angles))
    step = np.abs(np.diff(force))
    assert np.flatnonzero(step > 20 * np.median(step)).size == 1
    assert abs(angles[np.argmax(step)] - entrance) < 0.1


ENGINE = {"power_kw": 9000, "type": "slow_speed_diesel"}
BARE = {**POWERED, "models": {"calm_water": "holtrop_1984"}}


def test_a_sea_margin_raises_the_power_of_every_speed():
    plain = Ship.from_dict(BARE)
    ship = Ship.from_dict({**BARE, "engine": {**ENGINE, "sea_margin_percent": 15}})
    speed = [5.0, 6.0, 7.0]
    more = ship.power_at_speed(Conditions(), speed) / plain.power_at_speed(Conditions(), speed)
    assert more == pytest.approx(1.15)
    assert (ship.speeds < plain.speeds).all()
    known = {"name": "x", "hull": {"draught_m": 5.0}, "speeds_kn": [10]}
    with pytest.raises(InputError, match="sea_margin_percent is given for a ship with known"):
        Ship.from_dict({**known, "engine": {"sea_margin_percent": 15}})


def test_loads_of_the_engine_bound_its_power():
    with pytest.raises(InputError, match="engines give 7200 kW"):
        Ship.from_dict({**BARE, "engine": {**ENGINE, "largest_load": 0.8}})
    with pytest.raises(InputError, match="no less than 4050 kW"):
        Ship.from_dict({**BARE, "engine": {**ENGINE, "least_load": 0.45}})
    ship = Ship.from_dict(
        {**BARE, "powers_kw": [3600], "engine": {**ENGINE, "least_load": 0.3, "largest_load": 0.8}}
    )
    sheet = performance_sheet(ship, speeds_kn=[6, 16])
    slow, fast = (" ".join(row["warnings"]) for row in sheet["conditions"])
    assert "load of one engine is" in slow and "outside 0.3" in slow
    assert "the engines give 7200 kW: not reached" in fast
    x = 3600 / 9000
    expected = 3600 * 175 * (0.455 * x**2 - 0.710 * x + 1.280) / 3.6e6
    assert float(ship.fuel_rate(Conditions(), 0)) == pytest.approx(expected, rel=1e-3)
