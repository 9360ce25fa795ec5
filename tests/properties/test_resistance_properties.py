"""Properties of all resistance, wave, wind and propulsion methods for any input."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from thalweg.ship.methods.added_resistance.snnm_hull import (
    SnnmHull,
)
from thalweg.ship.methods.added_resistance.snnm_table import SnnmTable
from thalweg.ship.methods.added_resistance.stawave import stawave1, stawave2
from thalweg.ship.methods.added_resistance.wind_resistance import (
    BLENDERMANN,
    ITTC_CURVES,
    FujiwaraShip,
    blendermann_1994,
    fujiwara_2006,
    ittc_curve,
    wind_resistance,
    yu_2021_coefficient,
)
from thalweg.ship.methods.propulsion.b_series import (
    Propeller,
    b_series_polynomials,
    largest_advance,
    operating_point,
    solve_advance,
)
from thalweg.ship.methods.propulsion.propulsion_factors import (
    propulsion,
)
from thalweg.ship.methods.relative_angles import relative_wind
from thalweg.ship.methods.resistance.friction_lines import Water
from thalweg.ship.methods.resistance.hollenbach import (
    hollenbach_1998,
    hollenbach_validity,
)
from thalweg.ship.methods.resistance.hollenbach_hull import (
    HollenbachHull,
)
from thalweg.ship.methods.resistance.holtrop_form import hull_form
from thalweg.ship.methods.resistance.holtrop_mennen import BulbTransomAppendages, holtrop
from thalweg.ship.methods.shallow_water.shallow_water_resistance import (
    karpov_speed,
    lackenby_1963_speed_loss,
    zeng_2019_friction,
)

quick = settings(max_examples=40, deadline=None)

HULL = hull_form(
    length_waterline=172.0,
    breadth=32.0,
    draught=10.0,
    displacement=0.73 * 172.0 * 320.0,
    midship_coefficient=0.985,
    waterplane_coefficient=0.83,
    lcb_percent=0.5,
)
ENDS = BulbTransomAppendages(20.0, 4.0, 10.0, 50.0, 1.5, 5.0)
HOLLENBACH = HollenbachHull(
    length_between_perpendiculars=169.0,
    length_waterline=172.0,
    length_over_surface=174.0,
    breadth=32.0,
    draught_fore=10.0,
    draught_aft=10.0,
    block_coefficient=0.73,
    propeller_diameter=6.0,
)
WAVE_SHIP = {
    "length_between_perpendiculars": 169.0,
    "breadth": 32.0,
    "draught": 10.0,
    "block_coefficient": 0.73,
}
SNNM = SnnmTable.of(SnnmHull(169.0, 32.0, 10.0, 10.0, 0.73, 45.0, 50.0), shortest=2.0, longest=30.0)
FUJIWARA = FujiwaraShip(178.0, 32.0, 800.0, 2000.0, 500.0, 28.0, 0.0, 8.0)
PROPELLER = Propeller(6.0, 0.9, 0.6, 4)

CALM = {
    "holtrop_1982": lambda v, rho=1025.0: holtrop(
        v, HULL, bulb_transom_appendages=ENDS, density=rho
    ),
    "holtrop_1984": lambda v, rho=1025.0: holtrop(
        v, HULL, year=1984, bulb_transom_appendages=ENDS, density=rho
    ),
    **{
        f"hollenbach_{variant}": lambda v, rho=1025.0, variant=variant: hollenbach_1998(
            v, HOLLENBACH, wetted_surface=7400.0, variant=variant, water=Water(density=rho)
        )
        for variant in (
            *("single_design", "single_ballast", "single_minimum"),
            *("twin_design", "twin_minimum"),
        )
    },
}
WAVES = {
    "stawave1": lambda v, h, t, a: stawave1(h, a, breadth=32.0, bow_length=30.0),
    "stawave2": lambda v, h, t, a: stawave2(v, h, t, a, **WAVE_SHIP),
    "stawave2_jonswap": lambda v, h, t, a: stawave2(v, h, t, a, spectrum="jonswap", **WAVE_SHIP),
    "snnm": SNNM,
}
WIND = {
    "fujiwara": lambda a: fujiwara_2006(a, FUJIWARA),
    **{f"ittc_{name}": lambda a, name=name: ittc_curve(a, curve=name) for name in ITTC_CURVES},
    "yu": yu_2021_coefficient,
    **{
        f"blendermann_{name}": lambda a, kind=kind: blendermann_1994(
            a, frontal_area=800.0, lateral_area=2000.0, ship_type=kind
        )
        for name, kind in BLENDERMANN.items()
    },
}

speeds = st.floats(0.0, 12.0)
angles = st.floats(-10.0, 10.0)
heights = st.floats(0.0, 12.0)
periods = st.floats(3.0, 20.0)


@pytest.mark.parametrize("name", CALM)
def test_a_ship_at_rest_meets_no_resistance(name):
    parts = CALM[name](0.0)
    assert all(value == 0.0 for value in vars(parts).values())


@pytest.mark.parametrize("name", CALM)
def test_resistance_rises_with_speed_in_the_range_of_the_method(name):
    if name.startswith("hollenbach"):
        fn = np.linspace(0.14, 0.24, 60)
    else:
        # the cosine of the 1982 formula digs a hollow near Fn 0.34 for hulls as full as this
        fn = np.linspace(0.02, 0.30 if name == "holtrop_1982" else 0.60, 200)
    total = CALM[name](fn * np.sqrt(9.80665 * 172.0)).total
    assert np.all(np.diff(total) > 0.0)


@pytest.mark.parametrize("name", CALM)
@quick
@given(speed=speeds, density=st.floats(900.0, 1100.0))
def test_every_component_is_proportional_to_the_density(name, speed, density):
    base, other = CALM[name](speed), CALM[name](speed, density)
    for part, value in vars(base).items():
        np.testing.assert_allclose(
            vars(other)[part], value * density / 1025.0, rtol=1e-9, atol=1e-9
        )


@pytest.mark.parametrize("name", CALM)
@quick
@given(speed=speeds)
def test_components_add_up(name, speed):
    parts = dict(vars(CALM[name](speed)))
    total = parts.pop("total")
    np.testing.assert_allclose(sum(parts.values()), total, rtol=1e-12, atol=1e-9)


@pytest.mark.parametrize("name", CALM)
def test_unknown_speed_gives_unknown_resistance_without_warnings(name):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        total = CALM[name]([np.nan, -1.0, 5.0]).total
    np.testing.assert_array_equal(np.isnan(total), [True, True, False])


@pytest.mark.parametrize("name", CALM)
def test_a_scalar_equals_its_place_in_an_array(name):
    values = np.array([[1.0, 4.0, 7.5], [8.0, 9.9, 12.0]])
    total = CALM[name](values).total
    assert total.shape == values.shape
    for index in np.ndindex(values.shape):
        assert CALM[name](float(values[index])).total == pytest.approx(total[index], rel=1e-13)


def test_particulars_broadcast_with_the_conditions():
    draughts = np.array([[8.0], [9.0], [10.0]])
    hull = hull_form(
        length_waterline=172.0,
        breadth=32.0,
        draught=draughts,
        displacement=0.73 * 172.0 * 32.0 * draughts,
        midship_coefficient=0.985,
        waterplane_coefficient=0.83,
        lcb_percent=0.5,
    )
    total = holtrop(np.array([5.0, 7.0]), hull, year=1984).total
    assert total.shape == (3, 2)
    assert np.all(np.diff(total, axis=0) > 0.0)


@quick
@given(speed=st.floats(0.5, 12.0))
def test_hollenbach_minimum_is_below_the_mean(speed):
    if hollenbach_validity(speed, HOLLENBACH):
        return
    mean = CALM["hollenbach_single_design"](speed).total
    assert CALM["hollenbach_single_minimum"](speed).total < mean


@pytest.mark.parametrize("name", WAVES)
@quick
@given(speed=speeds, height=heights, period=periods, angle=angles)
def test_waves_act_alike_on_port_and_starboard(name, speed, height, period, angle):
    left, right = (WAVES[name](speed, height, period, side) for side in (angle, -angle))
    turned = WAVES[name](speed, height, period, angle + 2.0 * np.pi)
    np.testing.assert_allclose(left, right, rtol=1e-9, atol=1e-6)
    if (
        abs(np.cos(angle) - np.cos(np.pi / 4.0)) > 1e-9
        and abs(angle - np.round(angle / np.pi) * np.pi) > 1e-3
    ):
        np.testing.assert_allclose(left, turned, rtol=1e-6, atol=1e-3)


@pytest.mark.parametrize("name", WAVES)
@quick
@given(speed=speeds, height=st.floats(0.1, 6.0), period=periods, angle=angles)
def test_wave_resistance_goes_with_the_square_of_the_height(name, speed, height, period, angle):
    once, twice = (WAVES[name](speed, factor * height, period, angle) for factor in (1.0, 2.0))
    np.testing.assert_allclose(twice, 4.0 * once, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("name", ["stawave1", "stawave2", "stawave2_jonswap"])
@quick
@given(speed=speeds, height=heights, period=periods, angle=angles)
def test_head_seas_are_the_worst_for_sector_methods(name, speed, height, period, angle):
    head = WAVES[name](speed, height, period, 0.0)
    assert 0.0 <= WAVES[name](speed, height, period, angle) <= head


@pytest.mark.parametrize("name", WAVES)
def test_no_waves_no_resistance_and_unknown_waves_unknown_resistance(name):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        got = WAVES[name](
            np.array([5.0, 5.0, 5.0, 5.0]),
            np.array([0.0, np.nan, 1.0, 1.0]),
            np.array([np.nan, 8.0, 8.0, 8.0]),
            np.array([np.nan, 0.0, np.nan, 0.0]),
        )
    np.testing.assert_array_equal(np.isnan(got), [False, True, True, False])
    assert got[0] == 0.0


@pytest.mark.parametrize("name", WAVES)
def test_wave_methods_treat_a_scalar_as_its_place_in_an_array(name):
    rng = np.random.default_rng(3)
    arguments = [rng.uniform(low, high, 12) for low, high in ((0, 9), (0, 5), (4, 15), (-4, 4))]
    together = WAVES[name](*arguments)
    alone = [float(WAVES[name](*(float(a[i]) for a in arguments))) for i in range(12)]
    np.testing.assert_allclose(together, alone, rtol=1e-12, atol=1e-9)


def test_wave_methods_take_many_conditions_in_small_memory():
    count = 20_000
    rng = np.random.default_rng(4)
    got = SNNM(
        rng.uniform(0, 9, count),
        rng.uniform(0, 5, count),
        rng.uniform(4, 15, count),
        rng.uniform(-3, 3, count),
    )
    assert got.shape == (count,)
    assert np.isfinite(got).all()


@quick
@given(speed=speeds, height=st.floats(0.5, 6.0), period=periods)
def test_snnm_following_seas_are_milder_than_head_seas(speed, height, period):
    head, stern = (SNNM(speed, height, period, angle) for angle in (0.0, np.pi))
    assert stern < head


@pytest.mark.parametrize("name", WIND)
@quick
@given(angle=angles)
def test_wind_coefficients_are_alike_on_port_and_starboard(name, angle):
    both = [float(WIND[name](side)) for side in (angle, -angle, angle + 2.0 * np.pi)]
    np.testing.assert_allclose(both, both[0], rtol=1e-7, atol=1e-7)


@pytest.mark.parametrize("name", WIND)
def test_wind_from_ahead_resists_and_from_astern_pushes(name):
    assert WIND[name](0.0) > 0.3
    assert WIND[name](np.pi) < -0.3
    assert np.isnan(WIND[name](np.nan))
    steps = np.diff(WIND[name](np.linspace(0.0, np.pi, 2001)))
    assert np.abs(steps).max() < 0.01  # no jumps


@quick
@given(wind=st.floats(0.0, 30.0), angle=angles, speed=speeds, area=st.floats(1.0, 2e3))
def test_relative_wind_is_a_vector_sum(wind, angle, speed, area):
    relative, seen = relative_wind(wind, angle, ship_speed=speed)
    np.testing.assert_allclose(relative * np.cos(seen), wind * np.cos(angle) + speed, atol=1e-9)
    assert abs(wind - speed) - 1e-9 <= relative <= wind + speed + 1e-9
    assert 0.0 <= seen <= np.pi
    still = wind_resistance(0.0, 0.8, frontal_area=area)
    assert still == 0.0


def test_calm_air_on_a_moving_ship_comes_from_ahead():
    relative, seen = relative_wind(0.0, 2.0, ship_speed=7.0)
    assert (relative, seen) == (7.0, 0.0)
    got = relative_wind([np.nan, 5.0], [0.0, np.nan], ship_speed=5.0)
    assert np.isnan(got[0]).all()


@quick
@given(speed=st.floats(0.1, 10.0), depth=st.floats(5.5, 300.0), deeper=st.floats(0.01, 100.0))
def test_shallower_water_never_helps(speed, depth, deeper):
    shallow, deep = np.array([depth, depth + deeper])
    hull = {
        "draught": 5.0,
        "length": 95.0,
        "wetted_surface": 2400.0,
        "flat_bottom_area": 1800.0,
    }
    reynolds = speed * 95.0 / 1.19e-6
    friction = zeng_2019_friction(reynolds, depth=[shallow, deep], **hull)
    # the source drops the last 0.1 % of its factor where the clearance passes the length
    assert friction[0] >= friction[1] * (1.0 - 1e-9)
    assert karpov_speed(speed, depth=depth, draught=5.0) >= speed
    loss = lackenby_1963_speed_loss(speed, depth=[shallow, deep], midship_area=90.0)
    assert loss[0] >= loss[1] >= 0.0


@quick
@given(thrust=st.floats(0.0, 2e6), inflow=st.floats(0.0, 12.0), more=st.floats(1.0, 1e5))
def test_more_thrust_needs_more_turns_and_power(thrust, inflow, more):
    first, second = (operating_point(force, inflow, PROPELLER) for force in (thrust, thrust + more))
    assert second.rate > first.rate
    assert second.power > first.power
    assert 0.0 <= first.efficiency < 0.85


@quick
@given(
    force=st.floats(-2.0, 8.0).map(lambda power: 10.0**power),
    inflow=st.floats(-4.0, 1.5).map(lambda power: 10.0**power),
    pitch=st.floats(0.5, 1.4),
    area=st.floats(0.3, 1.05),
    blades=st.integers(2, 7),
)
def test_the_propeller_gives_the_required_thrust(force, inflow, pitch, area, blades):
    screw = Propeller(diameter=5.0, pitch_ratio=pitch, area_ratio=area, blades=blades)
    thrust, _ = b_series_polynomials(screw)
    largest = largest_advance(screw)
    stream = 1025.0 * (inflow * 5.0) ** 2
    found = solve_advance(
        [force, 0.0, -1.0, force],
        [inflow, inflow, inflow, 0.0],
        polynomial=thrust,
        largest=largest,
        diameter=5.0,
        density=1025.0,
    )
    given_ = stream * np.polynomial.polynomial.polyval(found[0], thrust)
    assert 0.0 <= found[0] <= largest
    assert given_ == pytest.approx(force * found[0] ** 2, abs=1e-9 * max(force, stream))
    assert found[1] == pytest.approx(largest) and np.isnan(found[2]) and found[3] == 0.0


@quick
@given(speed=st.floats(0.5, 10.0), drag=st.floats(1e4, 1e6))
def test_brake_power_exceeds_effective_power(speed, drag):
    hull = {"wake_fraction": 0.25, "thrust_deduction": 0.2, "relative_rotative": 1.0}
    state = propulsion(speed, drag, PROPELLER, **hull)
    assert state.brake_power > state.effective_power
    lossless = propulsion(speed, drag, PROPELLER, **hull, shaft_efficiency=1.0)
    assert state.brake_power == pytest.approx(lossless.brake_power / 0.99)
