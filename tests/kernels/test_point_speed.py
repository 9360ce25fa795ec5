"""The leg formula at a point: current triangle, angles from the heading, limits, missing data."""

import math

import numpy as np
import pytest

from tests.search.small import limits, make_table, steady
from tests.search.small import point_speed_at as at
from thalweg.kernels import codes


@pytest.mark.parametrize(
    ("speed", "current", "way", "seconds"),
    [  # T = L / (W.e + sqrt(V^2 - (e x W)^2))
        (5.0, (1.0, 2.0), (100e3, 50e3), 16925.824036),
        (5.0, (-2.0, 1.5), (60e3, 80e3), 23094.010768),
        (10.0, (0.0, 4.0), (0.0, -100e3), 16666.666667),
        (3.0, (2.9, 0.0), (0.0, 30e3), 39056.673294),
    ],
)
def test_constant_current_closed_forms(speed, current, way, seconds):
    sog, status = at(
        steady(speed),
        course=math.atan2(*way),
        current_east=current[0],
        current_north=current[1],
    )
    assert status == codes.OK
    assert math.hypot(*way) / sog == pytest.approx(seconds, rel=1e-9)


def test_a_current_across_or_against_as_strong_as_the_ship_is_refused():
    assert at(course=0.0, current_east=5.0, current_north=0.0) == (0.0, codes.CURRENT)
    assert at(course=0.0, current_east=0.0, current_north=-5.0) == (0.0, codes.CURRENT)
    assert at(course=0.0, current_east=0.0, current_north=-4.9)[1] == codes.OK


def test_no_current_channel_is_no_current_but_nan_is_no_data():
    assert at() == (5.0, codes.OK)
    assert at(current_east=np.nan, current_north=0.0) == (0.0, codes.NO_DATA)


def wind_table():
    """Speed 6 - 0.1 * wind * (1 + cos angle): exactly linear on both axes at the grid points."""
    wind, angle = np.linspace(0.0, 30.0, 61), np.linspace(0.0, np.pi, 721)
    values = 6.0 - 0.1 * wind[:, None] * (1.0 + np.cos(angle))[None]
    return make_table(
        ((codes.AXIS_WIND_SPEED, codes.AXIS_WIND_ANGLE), (wind, angle), values[..., None])
    )


@pytest.mark.parametrize("course", np.radians([0.0, 37.0, 90.0, 181.0, 275.0, 359.0]))
def test_wind_counts_from_the_bow_and_relative_to_the_water(course):
    # wind of 10 m/s towards the south: from ahead on a northerly course
    sog, _ = at(wind_table(), course=course, wind_east=0.0, wind_north=-10.0)
    assert sog == pytest.approx(6.0 - 1.0 * (1.0 + math.cos(course)), abs=2e-4)
    # water that moves with the wind feels none of it
    moving, _ = at(
        wind_table(), course=0.0, wind_east=0.0, wind_north=-2.0, current_east=0.0,
        current_north=-2.0,
    )  # fmt: skip
    assert moving == pytest.approx(6.0 - 2.0, abs=1e-5)


def test_the_heading_is_corrected_for_drift():
    across, wind = 2.0, (0.0, -10.0)  # current to the east, wind from the north, course north
    sog, status = at(
        wind_table(), course=0.0, current_east=across, current_north=0.0, wind_east=wind[0],
        wind_north=wind[1],
    )  # fmt: skip
    relative = np.array([wind[0] - across, wind[1]])
    speed = 5.0
    for _ in range(100):  # fixed point of speed and heading, to rounding
        heading = np.array([-across / speed, math.sqrt(1.0 - (across / speed) ** 2)])
        cosine = -heading @ relative / np.linalg.norm(relative)
        speed = 6.0 - 0.1 * np.linalg.norm(relative) * (1.0 + cosine)
    assert status == codes.OK
    assert sog == pytest.approx(math.sqrt(speed**2 - across**2), rel=3e-4)


def test_waves_count_from_where_they_come():
    angle = np.linspace(0.0, np.pi, 181)
    table = make_table(((codes.AXIS_WAVE_ANGLE,), (angle,), (3.0 + angle)[:, None]))
    for course, expected in ((0.0, math.pi), (math.pi, 0.0), (math.pi / 2, math.pi / 2)):
        sog, _ = at(table, course=course, wave_height_channel=1.0, wave_east=0.0, wave_north=1.0)
        assert sog == pytest.approx(3.0 + expected, abs=1e-5)


def test_waves_without_height_need_no_direction_but_others_do():
    table = make_table(((codes.AXIS_WAVE_ANGLE,), (np.linspace(0, np.pi, 3),), np.ones((3, 1))))
    unknown = {"wave_east": np.nan, "wave_north": np.nan}
    assert at(table, wave_height_channel=0.0, **unknown)[1] == codes.OK
    assert at(table, wave_height_channel=1.0, **unknown)[1] == codes.NO_DATA


#: 5 m/s over the ground: the limit is for that, whatever the current
_FIVE = {"wind_east": 3.0, "wind_north": 4.0, "current_north": 0.0}


@pytest.mark.parametrize(
    ("options", "status"),
    [
        ({"bounds": limits(depth=6.0), "depth": 6.0}, codes.OK),
        ({"bounds": limits(depth=6.0), "depth": 5.9}, codes.DEPTH),
        ({"bounds": limits(depth=6.0), "depth": np.inf}, codes.OK),
        ({"bounds": limits(depth=6.0), "depth": np.nan}, codes.NO_DATA),
        ({"depth": np.nan}, codes.OK),
        ({"bounds": limits(depth=6.0), "depth": 5.0, "water_level": 1.5}, codes.OK),
        ({"bounds": limits(depth=6.0), "depth": 7.0, "water_level": -1.5}, codes.DEPTH),
        ({"bounds": limits(depth=6.0), "depth": 9.0, "bed_depth": 5.0}, codes.DEPTH),
        ({"bounds": limits(depth=6.0), "depth": 5.0, "bed_depth": 9.0}, codes.DEPTH),
        ({"bounds": limits(depth=6.0), "depth": 9.0, "bed_depth": np.nan}, codes.NO_DATA),
        ({"bounds": limits(depth=6.0), "depth": 9.0, "water_level": np.nan}, codes.NO_DATA),
        ({"bounds": limits(wave=2.0), "wave_height_channel": 2.0}, codes.OK),
        ({"bounds": limits(wave=2.0), "wave_height_channel": 2.1}, codes.WAVE_HEIGHT),
        ({"bounds": limits(wave=2.0), "wave_height_channel": np.nan}, codes.NO_DATA),
        ({"bounds": limits(wave=2.0)}, codes.NO_DATA),
        ({"bounds": limits(wind=5.0), "wind_east": 3.0, "wind_north": 4.0}, codes.OK),
        ({"bounds": limits(wind=4.9), "wind_east": 3.0, "wind_north": 4.0}, codes.WIND_SPEED),
        ({"bounds": limits(wind=4.9)}, codes.NO_DATA),
        ({"bounds": limits(wind=4.9), **_FIVE, "current_east": 3.0}, codes.WIND_SPEED),
        ({"bounds": limits(wind=5.0), **_FIVE, "current_east": -0.5}, codes.OK),
        ({"wave_height_channel": np.nan, "wind_east": np.nan, "wind_north": 1.0}, codes.OK),
        ({"speed_field": np.nan}, codes.NO_DATA),
    ],
)
def test_limits_and_missing_data(options, status):
    assert at(**options)[1] == status


def test_beyond_the_table_is_refused():
    assert at(wind_table(), wind_east=0.0, wind_north=-31.0) == (0.0, codes.SHIP_RANGE)


def test_a_speed_field_replaces_the_table():
    assert at(speed_field=3.5) == (3.5, codes.OK)
    sog, _ = at(speed_field=3.5, course=0.0, current_east=0.0, current_north=1.0)
    assert sog == pytest.approx(4.5)


def test_settings_choose_the_speed():
    table = make_table(((), (), np.array([4.0, 6.0])))
    assert at(table, setting=1) == (6.0, codes.OK)
