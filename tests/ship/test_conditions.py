"""Conditions: names, shapes, and relative angles from sea variables."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from thalweg.core.errors import InputError
from thalweg.ship import Conditions
from thalweg.ship.methods.relative_angles import relative_angle


def test_values_are_read_by_attribute_and_by_key():
    c = Conditions({"sea_ice_area_fraction": 0.2}, wind_speed=[1.0, 2.0])
    assert c.shape == (2,)
    assert c.wind_speed.tolist() == [1.0, 2.0]
    assert float(c["sea_ice_area_fraction"]) == 0.2
    assert "wave_height" not in c and c.get("wave_height") is None
    assert dict(c).keys() == {"sea_ice_area_fraction", "wind_speed"}


def test_a_missing_condition_is_named_with_what_there_is():
    with pytest.raises(InputError, match=r"'wave_hight'.*There are: wave_height.*Did you mean"):
        Conditions(wave_height=1.0).wave_hight  # noqa: B018


def test_shapes_that_do_not_broadcast_are_refused():
    with pytest.raises(InputError, match="do not broadcast"):
        Conditions(wind_speed=[1.0, 2.0], wind_angle=[0.0, 1.0, 2.0])


def test_text_is_refused_as_a_condition():
    with pytest.raises(InputError, match="wind_speed"):
        Conditions(wind_speed="strong")


def test_conditions_are_frozen():
    c = Conditions(wind_speed=[1.0])
    with pytest.raises(AttributeError):
        c.wind_speed = 3.0
    with pytest.raises(ValueError, match="read-only"):
        c.wind_speed[0] = 3.0


@pytest.mark.parametrize(
    ("heading_deg", "angle_deg"), [(0, 0), (90, 90), (180, 180), (270, 90), (45, 45), (300, 60)]
)
def test_a_north_wind_comes_from_the_bow_of_a_ship_heading_north(heading_deg, angle_deg):
    sampled = {"eastward_wind": 0.0, "northward_wind": -10.0}
    c = Conditions.from_sea(sampled, heading=np.radians(heading_deg))
    assert float(c.wind_speed) == pytest.approx(10.0)
    assert np.degrees(float(c.wind_angle)) == pytest.approx(angle_deg, abs=1e-9)


def test_wind_is_taken_relative_to_the_moving_water():
    sampled = {
        "eastward_wind": 10.0,
        "northward_wind": 0.0,
        "eastward_sea_water_velocity": 2.0,
        "northward_sea_water_velocity": 0.0,
    }
    c = Conditions.from_sea(sampled, heading=np.radians(270.0))
    assert float(c.wind_speed) == pytest.approx(8.0)
    assert float(c.wind_angle) == pytest.approx(0.0, abs=1e-12)
    assert float(c.current_east) == 2.0


def test_wave_angle_is_the_same_from_components_and_from_degrees():
    angle = np.radians(30.0)
    towards = {
        "sea_surface_wave_to_direction_east": np.sin(angle),
        "sea_surface_wave_to_direction_north": np.cos(angle),
    }
    by_components = Conditions.from_sea(towards, heading=1.0).wave_angle
    by_degrees = Conditions.from_sea({"sea_surface_wave_from_direction": 210.0}, heading=1.0)
    assert float(by_components) == pytest.approx(float(by_degrees.wave_angle), abs=1e-12)


def test_depth_is_bed_depth_plus_water_level():
    sampled = {
        "sea_floor_depth_below_geoid": np.array([10.0, np.nan]),
        "sea_surface_height_above_geopotential_datum": np.array([1.5, 1.5]),
    }
    depth = Conditions.from_sea(sampled).depth
    assert depth[0] == 11.5
    assert np.isnan(depth[1])


def test_unknown_wind_stays_unknown():
    c = Conditions.from_sea({"eastward_wind": np.nan, "northward_wind": 3.0}, heading=0.0)
    assert np.isnan(c.wind_speed) and np.isnan(c.wind_angle)


@given(st.floats(-7.0, 7.0), st.floats(-7.0, 7.0), st.floats(0.1, 50.0))
def test_relative_angle_is_the_wrapped_difference(source, heading, strength):
    found = relative_angle(strength * np.sin(source), strength * np.cos(source), heading)
    expected = abs((source - heading + np.pi) % (2 * np.pi) - np.pi)
    assert float(found) == pytest.approx(expected, abs=1e-9)
