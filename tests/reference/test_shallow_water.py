"""Zeng et al. (2019), Karpov as printed by Schless (2023), and Lackenby (1963)."""

import warnings

import numpy as np
import pytest

from thalweg.ship.methods.resistance.friction_lines import ittc_1957, reynolds_number
from thalweg.ship.methods.shallow_water.shallow_water_resistance import (
    bottom_speed_ratio,
    karpov,
    karpov_speed,
    karpov_validity,
    lackenby_1963_deep_speed,
    lackenby_1963_speed_loss,
    lackenby_1963_validity,
    zeng_2019_friction,
)

HULL = {"draught": 5.0, "length": 95.57, "wetted_surface": 2402.0, "flat_bottom_area": 1904.7}
REYNOLDS = 5.7797 * 95.57 / 1e-6


@pytest.mark.parametrize(
    ("depth", "expected"),
    [(8.0, 0.00170319), (12.0, 0.00166361), (20.0, 0.00164994), (150.0, 0.00164097)],
)
def test_zeng_friction_against_an_independent_calculation(depth, expected):
    assert zeng_2019_friction(REYNOLDS, depth=depth, **HULL) == pytest.approx(expected, abs=6e-9)


def test_bottom_speed_as_printed_and_continuous():
    got = bottom_speed_ratio([1.2, 1.5, 2.0, 3.0, 4.0])
    np.testing.assert_allclose(got, [1.1467, 1.1277, 1.1042, 1.0727, 1.0515], atol=5e-5)
    ratio = np.linspace(1.01, 20.0, 4000)
    assert np.all(np.diff(bottom_speed_ratio(ratio)) <= 0.0)
    assert np.abs(np.diff(bottom_speed_ratio(ratio))).max() < 1e-3
    assert bottom_speed_ratio(np.inf) == 1.0


def test_zeng_friction_of_deep_water_is_near_the_ittc_line():
    deep = zeng_2019_friction(REYNOLDS, depth=np.inf, **HULL)
    assert deep == pytest.approx(ittc_1957(REYNOLDS), rel=0.05)


def test_friction_grows_towards_the_bottom_and_ends_there():
    depths = np.array([300.0, 90.0, 40.0, 20.0, 10.0, 6.0, 5.2])
    assert np.all(np.diff(zeng_2019_friction(REYNOLDS, depth=depths, **HULL)) > 0.0)
    assert np.isnan(zeng_2019_friction(REYNOLDS, depth=[5.0, 4.0, np.nan], **HULL)).all()


PRINTED = {
    1.5: (0.961123, 0.91925, 0.62962269, 0.39612261),
    2.0: (0.9949909, 0.95725, 0.75024132, 0.54607552),
    2.5: (0.9990091, 0.97647344, 0.79827737, 0.63894095),
    3.0: (1.0, 0.99566719, 0.84800746, 0.72560171),
    3.5: (1.0, 0.99647813, 0.86864401, 0.75530521),
    4.0: (1.0, 1.00261094, 0.88914881, 0.78656145),
    5.0: (1.0, 1.01419687, 0.92326619, 0.8369833),
    6.0: (1.0, 1.01270625, 0.93637587, 0.86301132),
    7.0: (1.0, 1.0125125, 0.94964256, 0.8881738),
    8.0: (1.0, 1.01470469, 0.95476019, 0.90404057),
    9.0: (1.0, 1.0, 0.97528718, 0.90790858),
    10.0: (1.0, 1.0, 0.97812982, 0.91954254),
}


@pytest.mark.parametrize("ratio", PRINTED)
def test_karpov_bands(ratio):
    froude = np.array([0.3, 0.5, 0.7, 0.9])
    np.testing.assert_allclose(karpov(froude, ratio, raw_bands=True), PRINTED[ratio], atol=6e-9)
    smooth = karpov(froude, ratio)
    np.testing.assert_allclose(smooth, np.minimum(PRINTED[ratio], 1.0), atol=6e-9)


def test_karpov_raw_bands_jump_and_interpolated_ones_do_not():
    edge = np.array([1.75 - 1e-9, 1.75 + 1e-9])
    assert np.diff(karpov(0.8, edge, raw_bands=True))[0] > 0.1
    assert np.diff(karpov(0.8, edge))[0] == pytest.approx(0.0, abs=1e-7)
    assert karpov(0.7, 1.75) == pytest.approx(0.5 * (0.62962269 + 0.75024132), abs=1e-8)
    assert karpov(0.7, 9.5, raw_bands=True) == pytest.approx(PRINTED[10.0][2], abs=6e-9)


def test_karpov_is_capped_and_never_pushes():
    froude = np.linspace(0.0, 3.0, 301)[:, None]
    alpha = karpov(froude, np.linspace(1.01, 15.0, 50))
    assert np.all((alpha > 0.0) & (alpha <= 1.0))
    np.testing.assert_array_equal(alpha[100:], np.broadcast_to(alpha[100], (201, 50)))
    speed = froude / alpha
    assert np.all(np.diff(speed, axis=0) > 0.0)  # more speed, more of it for the waves
    assert np.isnan(karpov([0.5, 0.5, np.nan], [1.0, np.nan, 3.0])).all()


def test_karpov_speed_in_deep_water_is_the_speed():
    assert karpov_speed(8.0, depth=np.inf, draught=5.0) == 8.0
    assert karpov_speed(6.0, depth=8.0, draught=5.0) > 6.0
    (note,) = karpov_validity([5.0, 12.0], depth=10.0)
    assert note.quantity == "depth Froude number"


def test_lackenby_written_out():
    loss = lackenby_1963_speed_loss(8.0, depth=20.0, midship_area=400.0, gravity=9.81)
    expected = 0.1242 * (1.0 - 0.05) + 1.0 - np.sqrt(np.tanh(9.81 * 20.0 / 64.0))
    assert loss == pytest.approx(expected, rel=1e-12)
    deep = lackenby_1963_deep_speed(8.0, depth=20.0, midship_area=400.0, gravity=9.81)
    assert deep == pytest.approx(8.0 * (1.0 + expected))


def test_lackenby_limits():
    assert lackenby_1963_speed_loss(0.0, depth=20.0, midship_area=10.0) == 0.0
    assert lackenby_1963_speed_loss(8.0, depth=np.inf, midship_area=400.0) == pytest.approx(0.0)
    losses = lackenby_1963_speed_loss(8.0, depth=[100.0, 50.0, 25.0, 15.0], midship_area=300.0)
    assert np.all(np.diff(losses) > 0.0)
    assert np.isnan(lackenby_1963_speed_loss(8.0, depth=np.nan, midship_area=300.0))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        dry = {"depth": [0.0, -5.0]}
        assert np.isnan(lackenby_1963_speed_loss(8.0, midship_area=300.0, **dry)).all()
        assert np.isnan(karpov_speed(8.0, draught=5.0, **dry)).all()
        assert karpov_validity(8.0, **dry) == []
    assert lackenby_1963_validity(8.0, depth=20.0, midship_area=300.0) == []
    assert lackenby_1963_validity(8.0, depth=8.0, midship_area=300.0)[0].high == 0.30


def test_reynolds_number_is_bounded_below():
    got = reynolds_number([0.0, 1e-9, 5.0], length=100.0, viscosity=1e-6)
    np.testing.assert_allclose(got, [1e5, 1e5, 5e8])
