"""Seas given by formulas: names, vectors, shapes, areas, periods, layers and policies."""

from __future__ import annotations

import numpy as np
import pytest

from thalweg.core.errors import DatasetError, InputError, OutsidePeriodError
from thalweg.kernels import codes
from thalweg.sea import Sea


def affine(a: float, b: float, c: float, d: float):
    return lambda t, lat, lon: a + b * t + c * lat + d * lon


def test_scalar_results_are_broadcast_to_the_points() -> None:
    sea = Sea.from_functions({"sea_surface_wave_significant_height": lambda t, lat, lon: 2.0})
    got = sea.sample(["sea_surface_wave_significant_height"], 0.0, [1.0, 2.0], [[3.0], [4.0]])
    assert got["sea_surface_wave_significant_height"].tolist() == [[2.0, 2.0], [2.0, 2.0]]


def test_functions_receive_seconds_and_degrees_at_the_sampled_points() -> None:
    sea = Sea.from_functions({"salinity": affine(1.0, 2.0, 30.0, 500.0)})
    got = sea.sample(["salinity"], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0])
    assert got["salinity"].tolist() == [1.0, 3.0, 31.0, 501.0]


@pytest.mark.parametrize(
    ("name", "angle", "east", "north"),
    [
        ("wind_from_direction", 270.0, 10.0, 0.0),
        ("wind_from_direction", 0.0, 0.0, -10.0),
        ("wind_to_direction", 90.0, 10.0, 0.0),
    ],
)
def test_wind_speed_and_direction_become_components(name, angle, east, north) -> None:
    sea = Sea.from_functions({"wind_speed": lambda t, y, x: 10.0, name: lambda t, y, x: angle})
    got = sea.sample(["eastward_wind", "northward_wind", "wind_speed", name], 0.0, 0.0, 0.0)
    assert got["eastward_wind"] == pytest.approx(east, abs=1e-12)
    assert got["northward_wind"] == pytest.approx(north, abs=1e-12)
    assert got["wind_speed"] == pytest.approx(10.0)
    assert np.cos(np.radians(got[name] - angle)) == pytest.approx(1.0)


def test_wave_direction_is_stored_as_a_unit_vector_towards() -> None:
    sea = Sea.from_functions({"sea_surface_wave_from_direction": lambda t, y, x: 315.0})
    fields = sea.freeze_stations([0.0], [0.0], 0.0, 100.0, [codes.WAVE_EAST, codes.WAVE_NORTH])
    assert fields.values[0, 0] == pytest.approx([np.sqrt(0.5), -np.sqrt(0.5)], abs=1e-6)


def test_half_a_vector_is_refused() -> None:
    with pytest.raises(InputError, match="northward_wind"):
        Sea.from_functions({"eastward_wind": lambda t, y, x: 1.0})
    with pytest.raises(InputError, match="sea_water_speed"):
        Sea.from_functions({"sea_water_velocity_to_direction": lambda t, y, x: 1.0})


def test_the_same_variable_twice_is_refused() -> None:
    one = {"sea_floor_depth_below_geoid": lambda t, y, x: 1.0}
    with pytest.raises(InputError, match="twice"):
        Sea.from_functions({**one, "sea_floor_depth_below_mean_sea_level": lambda t, y, x: 1.0})
    wind = dict.fromkeys(
        ("eastward_wind", "northward_wind", "wind_speed"), lambda t, y, x: 0.0 * t + 9.0
    )
    with pytest.raises(InputError, match="'wind_speed' is another name"):
        Sea.from_functions(wind)


@pytest.mark.parametrize(
    "given",
    [
        {"area": "abc"},
        {"area": (1, 2, 3)},
        {"area": (1, 2, float("nan"), 4)},
        {"area": (2, 1, 0, 4)},
        {"period": (1.0,)},
        {"period": "2026-01-01"},
        {"period": (2.0, 1.0)},
        {"time_step": -1.0},
    ],
)
def test_invalid_areas_periods_and_steps_are_refused(given) -> None:
    with pytest.raises(InputError):
        Sea.from_functions({"eastness": lambda t, y, x: 1.0}, **given)


@pytest.mark.parametrize(
    "name",
    ["sea_floor_depth_below_mean_sea_level", "sea_floor_depth", "sea_floor_depth_below_geoid"],
)
def test_every_spelling_of_bed_depth_is_one_channel(name: str) -> None:
    sea = Sea.from_functions({name: lambda t, y, x: 7.0})
    fields = sea.freeze_stations([0.0], [0.0], 0.0, 100.0, [codes.BED_DEPTH])
    assert fields.channel_index[codes.BED_DEPTH] == 0
    assert fields.values[0, 0, 0] == 7.0


def test_bed_level_is_negated_and_the_water_level_is_subtracted_from_depth_below_the_surface() -> (
    None
):
    bed = Sea.from_functions({"bed_level": lambda t, y, x: -12.0})
    assert bed.sample(["sea_floor_depth_below_geoid"], 0, 0, 0)["sea_floor_depth_below_geoid"] == 12
    moving = Sea.from_functions(
        {
            "sea_floor_depth_below_sea_surface": lambda t, y, x: 10.0 + t,
            "sea_surface_height_above_mean_sea_level": lambda t, y, x: t,
        }
    )
    got = moving.sample(["sea_floor_depth_below_geoid"], [0.0, 3.0], 0.0, 0.0)
    assert got["sea_floor_depth_below_geoid"].tolist() == [10.0, 10.0]


def test_wrong_shape_names_the_function() -> None:
    sea = Sea.from_functions({"air_pressure_at_mean_sea_level": lambda t, y, x: np.zeros(7)})
    with pytest.raises(InputError, match=r"air_pressure.*shape \(7,\)"):
        sea.sample(["air_pressure_at_mean_sea_level"], 0.0, [1.0, 2.0], 0.0)
    text = Sea.from_functions({"x": lambda t, y, x: "calm"})
    with pytest.raises(InputError, match="'x' returned a str"):
        text.sample(["x"], 0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        ("eastward_current", "eastward_sea_water_velocity"),
        ("curent_speed", "sea_water_speed"),
        ("wave_height", "sea_surface_wave_significant_height"),
        ("wind_from", "wind_from_direction"),
        ("water_depth", "sea_floor_depth_below_geoid"),
    ],
)
def test_a_name_that_only_looks_like_a_variable_is_refused(name: str, meant: str) -> None:
    with pytest.raises(InputError, match=f"no variable of the sea named '{name}'.*{meant}"):
        Sea.from_functions({name: lambda t, y, x: 1.0})


def test_names_of_the_user_are_accepted_and_complex_numbers_are_not() -> None:
    sea = Sea.from_functions({"salinity": lambda t, y, x: 1.0j + t, "eastness": lambda t, y, x: t})
    assert sea.sample(["eastness"], 3.0, 0.0, 0.0)["eastness"] == 3.0
    with pytest.raises(InputError, match="must return real numbers"):
        sea.sample(["salinity"], 0.0, 0.0, 0.0)


def test_nan_is_preserved_and_its_reason_reported() -> None:
    sea = Sea.from_functions(
        {"x": lambda t, y, x: np.where(y > 0.5, np.nan, 1.0)},
        area=(0.0, 1.0, 179.0, -179.0),
        period=(0.0, 100.0),
    )
    got = sea.sample(["x"], [0, 0, 0, 101, 0], [0, 0.6, 0, 0, 0], [180, 180, -179.5, 180, 178.0])[
        "x"
    ]
    assert np.isnan(got).tolist() == [False, True, False, True, True]
    assert sea.why_missing("x", 0.0, 0.6, 180.0) == "gap"
    assert sea.why_missing("x", 101.0, 0.0, 180.0) == "period"
    assert sea.why_missing("x", 0.0, 0.0, 178.0) == "area"
    assert sea.why_missing("wind_speed", 0.0, 0.0, 180.0) == "variable"


def test_unknown_names_are_nan_not_zero() -> None:
    assert np.isnan(Sea.calm().sample(["sea_ice_area_fraction"], 0, 0, 0)["sea_ice_area_fraction"])


def test_automatic_steps() -> None:
    sea = Sea.from_functions({"x": lambda t, y, x: t})
    assert np.diff(sea.times(0.0, 20000.0)) == pytest.approx(100.0)
    assert np.diff(sea.times(0.0, 600.0 * 1000)) == pytest.approx(600.0)
    assert sea.times(0.0, 1e8).size == 2001
    assert sea.times(5.0, 5.0).size == 2
    stepped = Sea.from_functions({"x": lambda t, y, x: t}, time_step=10.0)
    assert stepped.times(0.0, 95.0).tolist()[-1] == 95.0
    assert stepped.times(0.0, 95.0).size == 11


def test_frozen_stations_hold_what_is_sampled() -> None:
    sea = Sea.from_functions(
        {
            "eastward_sea_water_velocity": affine(0.0, 1e-4, 0.1, 0.01),
            "northward_sea_water_velocity": affine(1.0, -1e-4, 0.2, 0.02),
            "x": affine(0.0, 0.0, 1.0, 0.0),
        }
    )
    lat, lon = np.array([0.0, 1.0, 2.0]), np.array([5.0, 6.0, 7.0])
    fields = sea.freeze_stations(
        lat,
        lon,
        0.0,
        2000.0,
        [codes.CURRENT_NORTH, codes.CURRENT_EAST, codes.WIND_EAST],
        extra={codes.SPEED_FIELD: lambda s, t, y, x: s["x"] * 2.0 + t},
    )
    assert fields.values.shape == (3, 201, 3)
    assert fields.values.dtype == np.float32
    assert fields.values.flags.c_contiguous
    assert fields.channel_index[codes.WIND_EAST] == -1
    east = fields.values[:, :, fields.channel_index[codes.CURRENT_EAST]]
    expected = 1e-4 * fields.times[None] + 0.1 * lat[:, None] + 0.01 * lon[:, None]
    assert east == pytest.approx(expected, rel=1e-6)
    speed = fields.values[:, :, fields.channel_index[codes.SPEED_FIELD]]
    assert speed == pytest.approx(2.0 * lat[:, None] + fields.times[None], rel=1e-6)


def test_frozen_grid_across_the_antimeridian_has_unwrap_longitude() -> None:
    sea = Sea.from_functions(
        {"sea_surface_wave_significant_height": lambda t, y, x: np.where(x > 0, x, x + 360.0)}
    )
    grid = sea.freeze_grid(
        -1.0, 1.0, 179.0, -179.0, 0.0, 10.0, [codes.WAVE_HEIGHT_CHANNEL], spacing_deg=0.5
    )
    columns = grid.lon0 + grid.dlon * np.arange(grid.values.shape[2])
    assert grid.values.shape[1:] == (5, 5, 1)
    assert columns.tolist() == [179.0, 179.5, 180.0, 180.5, 181.0]
    assert grid.values[0, 0, :, 0] == pytest.approx(columns)


def test_the_first_layer_with_a_value_has_priority_and_vectors_stay_together() -> None:
    def hole(t, y, x):
        return np.where(y > 0.5, np.nan, 1.0)

    coastal = Sea.from_functions({"eastward_wind": hole, "northward_wind": lambda t, y, x: 2.0})
    world = Sea.from_functions(
        {
            "eastward_wind": lambda t, y, x: 10.0,
            "northward_wind": lambda t, y, x: 20.0,
            "air_pressure_at_mean_sea_level": lambda t, y, x: 1e5,
        }
    )
    sea = coastal + world
    names = ["eastward_wind", "northward_wind", "air_pressure_at_mean_sea_level"]
    got = sea.sample(names, 0.0, [0.0, 1.0], 0.0)
    assert got["eastward_wind"].tolist() == [1.0, 10.0]
    assert got["northward_wind"].tolist() == [2.0, 20.0]
    assert got["air_pressure_at_mean_sea_level"].tolist() == [1e5, 1e5]
    series = sea.series(names, np.array([0.0, 9.0]), np.array([0.0, 1.0]), np.zeros(2))
    assert series["northward_wind"].tolist() == [[2.0, 2.0], [20.0, 20.0]]
    assert Sea.layered(world, coastal).sample(names, 0, 0, 0)["eastward_wind"] == 10.0


def test_values_are_filled_only_on_request_and_stated() -> None:
    sea = Sea.from_functions(
        {
            "eastward_sea_water_velocity": lambda t, y, x: 1.0,
            "northward_sea_water_velocity": lambda t, y, x: 1.0,
        },
        period=(0.0, 100.0),
    )
    name = "eastward_sea_water_velocity"
    assert np.isnan(sea.sample([name], 200.0, 0.0, 0.0)[name])
    filled = sea.filled(currents=0.0)
    assert filled.sample([name], [50.0, 200.0], 0.0, 0.0)[name].tolist() == [1.0, 0.0]
    assert filled.assumptions == ("where unknown, currents = 0.0",)
    assert filled.fingerprint() != sea.fingerprint()
    frozen = filled.freeze_stations([0.0], [0.0], 0.0, 1000.0, [codes.CURRENT_EAST])
    values = np.interp([99.0, 102.0, 900.0], frozen.times, frozen.values[0, :, 0])
    assert values == pytest.approx([1.0, 0.0, 0.0])
    with pytest.raises(InputError, match="currents"):
        sea.filled(current=0.0)
    with pytest.raises(InputError, match="no direction"):
        sea.filled(wind=5.0)
    for wrong in ({"waves": "wnd"}, {"currents": "x"}, {"wind": None}, {"currents": (1, 2, 3)}):
        with pytest.raises(InputError, match="cannot be filled"):
            sea.filled(**wrong)
    for wrong in ({"waves": -3.0}, {"waves": 100.0}, {"ice": 7.0}):
        with pytest.raises(InputError, match="between 0 and"):
            sea.filled(**wrong)


def test_a_speed_without_direction_that_filling_replaces_is_stated() -> None:
    sea = Sea.from_functions({"wind_speed": lambda t, y, x: 26.0})
    assumptions = sea.filled(wind=0.0).assumptions
    assert assumptions == (
        "where unknown, wind = 0.0",
        "the data's wind_speed, without direction, is not used",
    )
    assert len(sea.filled(currents=0.0).assumptions) == 1
    assert len(Sea.calm().filled(wind=0.0).assumptions) == 2


def test_freezing_outside_the_period_reports_the_period_of_the_data() -> None:
    sea = Sea.from_functions(
        {"sea_surface_wave_significant_height": lambda t, y, x: 1.0}, period=(0, 9)
    )
    with pytest.raises(OutsidePeriodError, match="1970-01-01T00:00:09Z"):
        sea.freeze_stations([0.0], [0.0], 100.0, 200.0, [codes.WAVE_HEIGHT_CHANNEL])


def test_calm_is_steady_and_stated_as_an_assumption() -> None:
    calm = Sea.calm()
    assert calm.times(0.0, 1e6).tolist() == [0.0, 1e6]
    assert calm.assumptions
    got = calm.sample(
        ["wind_speed", "sea_water_speed", "sea_surface_wave_significant_height"], 0, 0, 0
    )
    assert all(value == 0.0 for value in got.values())
    assert calm.coverage()[0].start is None


def test_fingerprint_is_stable() -> None:
    assert Sea.calm().fingerprint() == Sea.calm().fingerprint()
    assert Sea.calm().provenance()["layers"][0]["label"] == "calm"


@pytest.mark.parametrize("step", [None, 600.0])
def test_frozen_times_begin_and_end_at_the_window_to_the_bit(step) -> None:
    start, end = 1767240664.4288292, 1767280664.1234567
    sea = Sea.from_functions({"salinity": lambda t, lat, lon: 1.0}, time_step=step)
    times = Sea.layered(sea, Sea.calm()).times(start, end)
    assert times[0] <= start and times[-1] >= end
    assert np.diff(times).min() > 1e-3


def test_a_negative_wave_height_is_refused_where_it_is_read():
    """It made ships faster than in calm water."""
    name = "sea_surface_wave_significant_height"
    sea = Sea.from_functions({name: lambda t, y, x: -3.0 + 0.0 * y})
    with pytest.raises(DatasetError, match="wave_significant_height returns -3"):
        sea.sample([name], 0.0, 50.0, 0.0)
    unknown = Sea.from_functions({name: lambda t, y, x: np.nan + 0.0 * y})
    assert np.isnan(unknown.sample([name], 0.0, 50.0, 0.0)[name]).all()


def test_a_negative_wind_speed_is_refused_and_turns_no_wind_round():
    sea = Sea.from_functions(
        {
            "wind_speed": lambda t, y, x: -5.0 + 0.0 * y,
            "wind_from_direction": lambda t, y, x: 90.0 + 0.0 * y,
        }
    )
    with pytest.raises(DatasetError, match="wind_speed returns -5"):
        sea.sample(["eastward_wind"], 0.0, 50.0, 0.0)
