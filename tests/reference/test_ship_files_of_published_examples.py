"""Published examples as ship files: Yu (2021) by Hollenbach, Holtrop and Mennen (1982)."""

import pytest

from thalweg.core.units import KNOT
from thalweg.ship import Conditions, Ship

DEEP = Conditions(
    depth=float("inf"), wind_speed=0, wind_angle=0, wave_height=0, wave_angle=0, wave_period=10
)
YU = {
    "name": "Yu (2021), table 3",
    "hull": {
        "length_between_perpendiculars_m": 162.45,
        "length_waterline_m": 172.42,
        "length_over_surface_m": 172.42,
        "breadth_m": 32.0,
        "draught_fore_m": 10.0,
        "draught_aft_m": 10.0,
        "block_coefficient": 0.728,
        "wetted_surface_m2": 8263.5,
    },
    "propulsion": {"propeller_diameter_m": 4.0},
    "water": {"density_kg_m3": 1025.0, "kinematic_viscosity_m2_s": 1.1395e-6},
    "speeds_kn": [14.0],
    "models": {"calm_water": "hollenbach_1998_mean"},
}
HOLTROP = {
    "name": "Holtrop and Mennen (1982), section 3",
    "hull": {
        "length_waterline_m": 205.0,
        "length_between_perpendiculars_m": 200.0,
        "breadth_m": 32.0,
        "draught_fore_m": 10.0,
        "draught_aft_m": 10.0,
        "displacement_m3": 37500.0,
        "lcb_percent": -0.75,
        "bulb_area_m2": 20.0,
        "bulb_centre_height_m": 4.0,
        "midship_coefficient": 0.98,
        "waterplane_coefficient": 0.75,
        "transom_area_m2": 16.0,
        "appendage_area_m2": 50.0,
        "appendage_factor": 1.5,
        "stern_shape": "u",
    },
    "speeds_kn": [25.0],
    "models": {"calm_water": "holtrop_mennen_1982"},
}


@pytest.mark.parametrize(
    ("knots", "kilonewtons"), [(12, 377.726), (14, 531.146), (15, 631.118), (17, 895.140)]
)
def test_yu_2021_table_3(knots, kilonewtons):
    found = Ship.from_dict(YU).resistance(DEEP, 0.5144 * knots)["total"]
    assert float(found) / 1e3 == pytest.approx(kilonewtons, rel=5e-4)
    exact = Ship.from_dict(YU).resistance(DEEP, KNOT * knots)["total"]
    assert float(exact) / 1e3 == pytest.approx(kilonewtons, rel=5e-4)


def test_holtrop_mennen_1982_example():
    parts = Ship.from_dict(HOLTROP).resistance(DEEP, 25 * KNOT)
    printed = {"friction": 869.63, "appendage": 8.83, "wave_making": 557.11, "correlation": 221.98}
    for name, value in printed.items():
        assert float(parts[name]) / 1e3 == pytest.approx(value, rel=0.007)
    assert float(parts["bulb"]) / 1e3 == pytest.approx(0.049, abs=5e-4)
    assert float(parts["transom"]) == 0.0
    assert float(parts["total"]) / 1e3 == pytest.approx(1793.26, rel=1e-3)


def test_warmer_water_rubs_less():
    cold = Ship.from_dict(HOLTROP).resistance(DEEP, 10.0)
    warm = {**HOLTROP, "water": {"kinematic_viscosity_m2_s": 0.85e-6}}
    other = Ship.from_dict(warm).resistance(DEEP, 10.0)
    assert 0.9 < float(other["friction"] / cold["friction"]) < 0.98
    assert float(other["wave_making"]) == pytest.approx(float(cold["wave_making"]))
