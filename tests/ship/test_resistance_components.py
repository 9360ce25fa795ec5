"""Inputs of the methods that a ship file chooses."""

import numpy as np
import pytest

from thalweg.core.units import KNOT
from thalweg.ship import Conditions, Ship
from thalweg.ship.hull.hull import complete_hull
from thalweg.ship.methods.resistance.hollenbach import (
    hollenbach_wetted_surface,
)
from thalweg.ship.methods.resistance.hollenbach_hull import (
    HollenbachHull,
)
from thalweg.ship.methods.shallow_water.shallow_water_resistance import lackenby_1963_deep_speed
from thalweg.ship.performance_sheet import performance_sheet

HULL = {
    "length_between_perpendiculars_m": 120.0,
    "length_waterline_m": 122.0,
    "breadth_m": 18.0,
    "draught_m": 7.0,
    "block_coefficient": 0.72,
}
CALM = {
    **{"wind_speed": 0.0, "wind_angle": 0.0, "wave_height": 0.0, "wave_angle": 0.0},
    **{"wave_period": 9.0, "depth": np.inf},
}


def _ship(models=None, hull=None, **sections):
    models = {"calm_water": "holtrop_1984", **(models or {})}
    return Ship.from_dict(
        {"name": "x", "hull": {**HULL, **(hull or {})}, "models": models, **sections}
    )


def _estimates(ship):
    return {one.key: one.value for one in ship.estimated}


@pytest.mark.parametrize(("bulb", "variant"), [(0.0, "twin_no_bulb"), (8.0, "twin_bulb")])
def test_the_wetted_surface_of_twin_screws_includes_the_bulb(bulb, variant):
    screws = {"propellers": 2, "propeller_diameter_m": 4.0}
    hull = {"bulb_area_m2": bulb, "length_over_surface_m": 123.0}
    ship = _ship({"calm_water": "hollenbach_1998_mean"}, hull, propulsion=screws)
    wanted = hollenbach_wetted_surface(
        HollenbachHull(
            length_between_perpendiculars=120.0,
            length_waterline=122.0,
            length_over_surface=123.0,
            breadth=18.0,
            draught_fore=7.0,
            draught_aft=7.0,
            block_coefficient=0.72,
            propeller_diameter=4.0,
        ),
        variant=variant,
    )
    assert _estimates(ship)["wetted_surface_m2"] == pytest.approx(float(wanted))


def test_lackenby_takes_the_power_of_the_deep_water_speed():
    ship = _ship({"shallow_water": "lackenby_1963"}, {"midship_coefficient": 0.98})
    deep = float(lackenby_1963_deep_speed(6.0, depth=12.0, midship_area=18.0 * 7.0 * 0.98))
    assert deep > 6.1
    shallow = ship.power_at_speed(Conditions({**CALM, "depth": 12.0}), 6.0)
    assert float(shallow) == pytest.approx(float(ship.power_at_speed(Conditions(CALM), deep)))


def test_particulars_for_the_wind_are_estimated_and_reported():
    hull = {"length_overall_m": 126.0, "frontal_area_m2": 300.0, "lateral_area_m2": 1500.0}
    hull |= {"superstructure_lateral_area_m2": 300.0, "superstructure_height_m": 20.0}
    ship = _ship({"wind": "fujiwara_2006"}, hull)
    assert _estimates(ship)["lateral_centre_height_m"] == pytest.approx(0.5 * 1500.0 / 126.0)


def test_lengths_follow_from_the_length_overall():
    values = complete_hull({"length_overall_m": 100.0}).values
    assert values["length_between_perpendiculars_m"] == pytest.approx(96.0)
    assert values["length_waterline_m"] == pytest.approx(98.0)


def test_a_ships_own_carbon_is_that_of_the_fuel_outside():
    own = {"type": "hfo", "carbon_factor": 2.5}
    switched = _ship(fuel={**own, "eca_type": "mgo"}).fuel_terms
    assert (switched.carbon_outside, switched.carbon_inside) == pytest.approx((2.5, 3.206))
    assert _ship(fuel=own).fuel_terms.carbon_inside == pytest.approx(2.5)


def test_fuel_per_mile_and_co2_follow_from_fuel_per_hour():
    ship = _ship(engine={"power_kw": 5000, "type": "medium_speed_diesel"}, fuel={"type": "mdo"})
    for row in performance_sheet(ship, speeds_kn=[9.0, 12.0])["conditions"]:
        assert row["fuel_kg_per_nm"] * row["speed_kn"] == pytest.approx(row["fuel_kg_per_h"])
        assert row["co2_kg_per_h"] == pytest.approx(3.206 * row["fuel_kg_per_h"])


def test_waves_given_by_where_they_go_come_from_the_opposite_direction():
    north = {"sea_surface_wave_to_direction": 0.0}
    assert float(Conditions.from_sea(north, heading=np.pi).wave_angle) == pytest.approx(0.0)
    assert float(Conditions.from_sea(north, heading=0.0).wave_angle) == pytest.approx(np.pi)


def test_a_stopped_ship_uses_no_more_than_its_ordered_power():
    engine = {"power_kw": 1200, "type": "medium_speed_diesel"}
    hull = {"frontal_area_m2": 900.0, "lateral_area_m2": 2500.0}
    screw = {"propeller_diameter_m": 4.5, "propeller_pitch_ratio": 0.8}
    screw |= {"propeller_blades": 4, "propeller_area_ratio": 0.6}
    storm = Conditions({**CALM, "wind_speed": 60.0, "wave_height": 9.0})
    models = {"wind": "blendermann_1994", "waves": "stawave_1", "propulsion": "wageningen_b"}
    ship = _ship(models, hull, engine=engine, propulsion=screw, powers_kw=[600, 1000])
    assert ship.speed_through_water(storm, 1) == 0.0
    assert float(ship.power(storm, 1)) == pytest.approx(1e6)


def test_a_second_engine_starts_where_the_first_may_give_no_more():
    engine = {"power_kw": 3000, "count": 2, "sfoc_g_per_kwh": 180}
    fuels = [
        float(_ship(engine={**engine, **most}).model.plant.fuel(2.5e6))
        for most in ({}, {"largest_load": 0.8})
    ]
    shapes = [0.455 * load**2 - 0.71 * load + 1.28 for load in (2.5 / 3.0, 2.5 / 6.0)]
    assert fuels == pytest.approx([2500 * 180 * shape / 3.6e6 for shape in shapes])


def test_acceleration_is_felt_at_the_bow():
    ship = _ship(speeds_kn=[12.0])
    weather = {"wave_height": 3.0, "wave_angle": 0.0}
    at_bow = performance_sheet(ship, weather, speeds_kn=[12.0])["conditions"][0]["motions"]
    limit = at_bow["bow_acceleration_rms_m_s2"]
    hull = {"length_between_perpendiculars_m": 120.0, "length_waterline_m": 122.0}
    for most, forbidden in ((0.98 * limit, True), (1.02 * limit, False)):
        careful = _ship(
            hull=hull, speeds_kn=[12.0], limits={"max_vertical_acceleration_m_s2": most}
        )
        found = careful.limits.safety.forbids(
            12.0 * KNOT, wave_angle=0.0, wave_height=3.0, wave_period=8.66
        )
        assert bool(found) is forbidden
