"""Propulsion factors and propeller of the worked example of Holtrop and Mennen (1982)."""

import numpy as np
import pytest

from thalweg.core.errors import InputError
from thalweg.core.units import KNOT
from thalweg.ship.methods.propulsion.b_series import (
    Propeller,
    b_series,
    b_series_polynomials,
    b_series_validity,
    largest_advance,
    operating_point,
)
from thalweg.ship.methods.propulsion.hull_propeller_interaction import (
    hull_efficiency,
    relative_rotative_single,
    relative_rotative_twin,
    thrust_deduction_single,
    thrust_deduction_twin,
    viscous_coefficient,
    wake_fraction_single,
    wake_fraction_twin,
)
from thalweg.ship.methods.propulsion.propulsion_factors import (
    Efficiencies,
    constant_efficiency_power,
    propulsion,
)
from thalweg.ship.methods.resistance.holtrop_form import hull_form

SHIP = hull_form(
    length_waterline=205.0,
    breadth=32.0,
    draught=10.0,
    displacement=37500.0,
    midship_coefficient=0.98,
    waterplane_coefficient=0.75,
    lcb_percent=-0.75,
)
SPEED = 25.0 * KNOT
AREA_RATIO, RATE, DIAMETER = 0.7393, 1.6594, 8.0


def _wake(viscous=0.001963):
    return wake_fraction_single(
        SHIP,
        draught_aft=10.0,
        propeller_diameter=DIAMETER,
        wetted_surface_area=7381.45 + 50.0,
        viscous=viscous,
        stern_shape=10.0,
    )


def test_propulsion_factors_as_printed():
    assert _wake() == pytest.approx(0.2584, abs=5e-5)
    viscous = viscous_coefficient(0.0013898, form_factor=1.15644, correlation=0.000352)
    assert viscous == pytest.approx(0.001963, abs=4e-6)  # printed with a rounded C_F
    assert _wake(viscous) == pytest.approx(0.2584, abs=5e-4)
    deduction = thrust_deduction_single(SHIP, propeller_diameter=DIAMETER, stern_shape=10.0)
    assert deduction == pytest.approx(0.1747, abs=5e-5)
    rotative = relative_rotative_single(SHIP, area_ratio=AREA_RATIO)
    assert rotative == pytest.approx(0.9931, abs=5e-5)
    assert hull_efficiency(0.2584, 0.1747) == pytest.approx(0.8253 / 0.7416)


def test_open_water_efficiency_and_shaft_power_as_printed():
    """Thrust 2172.75 kN at 1.6594 rev/s: eta_0 0.6461 and 32621 kW.

    The paper corrects the polynomials for the roughness of the blades, which is left out here,
    so the tolerance is half a percent.
    """
    thrust, inflow = 2172.75e3, SPEED * (1.0 - 0.2584)
    advance = inflow / (RATE * DIAMETER)
    wanted = thrust / (1025.0 * RATE**2 * DIAMETER**4)
    pitches = np.linspace(0.8, 1.3, 2001)
    values = [b_series(advance, Propeller(DIAMETER, p, AREA_RATIO, 4))[0] for p in pitches]
    pitch = float(np.interp(wanted, np.array(values), pitches))
    propeller = Propeller(DIAMETER, pitch, AREA_RATIO, 4)
    assert b_series(advance, propeller)[2] == pytest.approx(0.6461, rel=6e-3)
    state = propulsion(
        SPEED,
        1793.26e3,
        propeller,
        wake_fraction=0.2584,
        thrust_deduction=0.1747,
        relative_rotative=0.9931,
        shaft_efficiency=0.99,
    )
    assert state.thrust == pytest.approx(thrust, rel=1e-4)
    assert state.rate == pytest.approx(RATE, rel=1e-3)
    assert state.brake_power / 1000.0 == pytest.approx(32621.0, rel=6e-3)
    assert state.effective_power / 1000.0 == pytest.approx(1793.26 * SPEED)


def test_1984_and_twin_screw_factors_have_the_usual_size():
    wake = wake_fraction_single(
        SHIP,
        draught_aft=10.0,
        propeller_diameter=DIAMETER,
        wetted_surface_area=7381.45 + 50.0,
        viscous=0.001963,
        stern_shape=10.0,
        year=1984,
    )
    assert wake == pytest.approx(_wake(), abs=0.03)
    deduction = thrust_deduction_single(
        SHIP, propeller_diameter=DIAMETER, stern_shape=10.0, year=1984
    )
    assert deduction == pytest.approx(0.1747, abs=0.03)
    block, root = 0.57164634, np.sqrt(320.0)
    assert wake_fraction_twin(SHIP, propeller_diameter=5.0, viscous=0.002) == pytest.approx(
        0.3095 * block + 0.02 * block - 0.23 * 5.0 / root, rel=1e-7
    )
    assert thrust_deduction_twin(SHIP, propeller_diameter=5.0) == pytest.approx(
        0.325 * block - 0.1885 * 5.0 / root, rel=1e-7
    )
    assert relative_rotative_twin(SHIP, pitch_ratio=1.0) == pytest.approx(
        0.9737 + 0.111 * (0.58331259 + 0.016875) - 0.06325, rel=1e-7
    )


FULL = hull_form(
    length_waterline=200.0,
    breadth=40.0,
    draught=9.0,
    displacement=56_000.0,
    midship_coefficient=0.99,
    waterplane_coefficient=0.88,
    lcb_percent=2.0,
)


def _wake_of(hull, **more):
    options = {"draught_aft": 9.0, "propeller_diameter": 6.0, "wetted_surface_area": 9000.0}
    return wake_fraction_single(hull, **{**options, **more}, viscous=0.0022)


def test_wake_of_a_full_hull_written_out():
    """C_P above 0.7 (c19), T_A/D below and above 2 (c11), B/T_A above 5 (c8), c8 above 28 (c9)."""
    prismatic = 56_000.0 / (200.0 * 40.0 * 9.0) / 0.99
    slim = 1.0 - (1.45 * prismatic - 0.315 - 0.0225 * 2.0)
    c19 = 0.18567 / (1.3571 - 0.99) - 0.71276 + 0.38648 * prismatic
    root = 0.27915 * np.sqrt(40.0 / (200.0 * slim)) + c19

    def flow(c9, c11, aft, viscous=0.0022):
        return c9 * viscous * 200.0 / aft * (0.050776 + 0.93405 * c11 * viscous / slim)

    c8 = 40.0 * 9000.0 / (200.0 * 6.0 * 9.0)  # 33.3
    c9 = 32.0 - 16.0 / (c8 - 24.0)
    assert _wake_of(FULL, year=1984) == pytest.approx(flow(c9, 1.5, 9.0) + root, rel=1e-12)
    c11 = 0.0833333 * 2.25**3 + 1.33333  # T_A / D = 2.25
    c8 = 40.0 * 6000.0 / (200.0 * 4.0 * 9.0)
    c9 = 32.0 - 16.0 / (c8 - 24.0)
    got = _wake_of(FULL, year=1984, propeller_diameter=4.0, wetted_surface_area=6000.0)
    assert got == pytest.approx(flow(c9, c11, 9.0) + root, rel=1e-12)
    c9 = 4000.0 * (7.0 * 40.0 / 6.0 - 25.0) / (200.0 * 6.0 * (40.0 / 6.0 - 3.0))  # 19.7
    got = _wake_of(FULL, year=1984, draught_aft=6.0, wetted_surface_area=4000.0)
    assert got == pytest.approx(flow(c9, 1.0, 6.0) + root, rel=1e-12)
    stern = _wake_of(FULL, year=1984, stern_shape=10.0)
    assert stern == pytest.approx(1.15 * _wake_of(FULL, year=1984), rel=1e-12)


def test_wake_of_a_fine_hull_written_out():
    """C_P below 0.7: the other c19 of 1984, on the ship of the worked example."""
    prismatic, block = 0.58331259, 0.57164634
    slim = 1.0 - (1.45 * prismatic - 0.315 + 0.0225 * 0.75)
    c8 = 32.0 * 7431.45 / (205.0 * 8.0 * 10.0)  # 14.5
    wake = c8 * 0.002 * 20.5 * (0.050776 + 0.93405 * 1.25 * 0.002 / slim)
    wake += 0.27915 * np.sqrt(32.0 / (205.0 * slim))
    wake += 0.12997 / (0.95 - block) - 0.11056 / (0.95 - prismatic)
    got = wake_fraction_single(
        SHIP,
        draught_aft=10.0,
        propeller_diameter=8.0,
        wetted_surface_area=7431.45,
        viscous=0.002,
        year=1984,
    )
    assert got == pytest.approx(wake, rel=1e-6)


def test_thrust_deduction_written_out():
    prismatic = 56_000.0 / (200.0 * 40.0 * 9.0) / 0.99
    late = 0.25014 * 0.2**0.28956 * (np.sqrt(360.0) / 6.0) ** 0.2624
    late /= (1.0 - prismatic + 0.0225 * 2.0) ** 0.01762
    got = thrust_deduction_single(FULL, propeller_diameter=6.0, stern_shape=-10.0, year=1984)
    assert got == pytest.approx(late - 0.015, rel=1e-12)
    slim = 1.0 - (1.45 * prismatic - 0.315 - 0.0225 * 2.0)
    c10 = 0.25 - 0.003328402 / (0.2 - 0.134615385)  # L/B = 5, below 5.2
    early = 0.001979 * 5.0 / slim + 1.0585 * c10 - 0.00524 - 0.1418 * 36.0 / 360.0
    assert thrust_deduction_single(FULL, propeller_diameter=6.0) == pytest.approx(early, rel=1e-12)


B_SERIES_4_70 = Propeller(5.0, 1.0, 0.70, 4)


def test_reynolds_correction_is_small_at_the_number_of_the_series():
    advance = np.linspace(0.0, 0.9, 10)
    plain = b_series(advance, B_SERIES_4_70)
    same = b_series(advance, B_SERIES_4_70, reynolds=2e6)
    np.testing.assert_allclose(same[0], plain[0], atol=6e-4)
    np.testing.assert_allclose(same[1], plain[1], atol=1e-4)
    higher = b_series(advance, B_SERIES_4_70, reynolds=5e7)
    assert np.all(higher[1] < same[1])
    assert np.all(higher[2][1:] > same[2][1:])


def test_polynomials_in_the_advance_are_cubics():
    thrust, torque = b_series_polynomials(B_SERIES_4_70)
    kt, kq, efficiency = b_series(0.6, B_SERIES_4_70)
    powers = 0.6 ** np.arange(4)
    assert kt == pytest.approx(thrust @ powers)
    assert kq == pytest.approx(torque @ powers)
    assert efficiency == pytest.approx(0.6 * kt / (2.0 * np.pi * kq))
    assert b_series(largest_advance(B_SERIES_4_70), B_SERIES_4_70)[0] == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize(
    "propeller",
    [Propeller(5.0, 1.9, 0.8, 6), Propeller(5.0, 1.8, 0.6, 7), Propeller(5.0, 0.1, 1.2, 2)],
)
def test_a_propeller_the_series_cannot_describe_is_refused(propeller):
    with pytest.raises(InputError, match=r"no propeller of P/D .* blades") as caught:
        operating_point(1e5, 5.0, propeller)
    assert "pitch ratio" in str(caught.value)


def test_operating_point_gives_the_required_thrust():
    thrust = np.array([0.0, 1e3, 2e5, 5e5, 4e5, 1e5])
    inflow = np.array([5.0, 8.0, 6.0, 0.0, 1e-4, 3.0])
    state = operating_point(thrust, inflow, B_SERIES_4_70)
    kt, kq, _ = b_series(state.advance, B_SERIES_4_70)
    np.testing.assert_allclose(1025.0 * state.rate**2 * 5.0**4 * kt, thrust, rtol=1e-9, atol=1e-6)
    np.testing.assert_allclose(1025.0 * state.rate**2 * 5.0**5 * kq, state.torque, rtol=1e-12)
    np.testing.assert_allclose(state.advance * state.rate * 5.0, inflow, rtol=1e-9, atol=1e-9)
    assert state.efficiency[3] == 0.0
    assert state.power[3] > 0.0  # at the bollard


def test_operating_point_outside_its_domain_is_unknown():
    state = operating_point([-1.0, np.nan, 1e5, 1e5], [5.0, 5.0, np.nan, -1.0], B_SERIES_4_70)
    assert np.isnan(state.rate).all()
    assert np.isnan(state.power).all()


def test_a_ship_at_rest_needs_no_power():
    state = propulsion(0.0, 0.0, B_SERIES_4_70, wake_fraction=0.3, thrust_deduction=0.2)
    assert state.brake_power == 0.0
    assert state.rate == 0.0


def test_two_propellers_share_the_thrust():
    one = propulsion(7.0, 2e5, B_SERIES_4_70, wake_fraction=0.1, thrust_deduction=0.1)
    two = propulsion(7.0, 4e5, B_SERIES_4_70, wake_fraction=0.1, thrust_deduction=0.1, propellers=2)
    assert two.brake_power == pytest.approx(2.0 * one.brake_power)
    assert two.rate == pytest.approx(one.rate)


def test_constant_efficiencies_of_schless():
    assert Efficiencies().total == pytest.approx(0.5532, abs=5e-5)
    power = constant_efficiency_power([6.0, 6.0], [3e5, -1e4])
    np.testing.assert_allclose(power, [6.0 * 3e5 / Efficiencies().total, 0.0])


def test_validity_of_the_series():
    assert b_series_validity(B_SERIES_4_70) == []
    notes = b_series_validity(Propeller(5.0, 1.6, 0.2, 4))
    assert [note.quantity for note in notes] == ["blade area ratio", "pitch ratio"]
