"""Loading and estimated particulars against definitions and real ships."""

from __future__ import annotations

import numpy as np
import pytest

from thalweg.core.errors import InputError
from thalweg.ship.hull import particulars_regressions as hydro
from thalweg.ship.methods import displacement
from thalweg.ship.methods import hull_coefficients as coefficients
from thalweg.ship.methods import hull_regressions as reg


def test_load_factor_runs_from_empty_to_full():
    got = displacement.interpolate_loading([0.0, 0.25, 1.0], empty=4.0, full=8.0)
    assert got.tolist() == [4.0, 5.0, 8.0]


def test_load_factor_outside_is_unknown():
    assert np.isnan(
        displacement.interpolate_loading([-0.01, 1.01, np.nan], empty=4.0, full=8.0)
    ).all()


def test_a_full_ship_may_be_slower():
    assert displacement.interpolate_loading(0.5, empty=14.0, full=12.0) == 13.0


def test_volume_and_block_are_inverse():
    volume = displacement.displacement_volume(200.0, 32.0, draught=10.0, block_coefficient=0.8)
    assert volume == pytest.approx(51_200.0)
    back = displacement.block_coefficient_of(volume, length=200.0, breadth=32.0, draught=10.0)
    assert back == pytest.approx(0.8)


def test_denny_mumford_of_yus_ship():
    """172.42 x 32 x 10 m, volume .785 x 169 x 32 x 10: 7176 m2."""
    volume = 0.785 * 169.0 * 32.0 * 10.0
    got = reg.wetted_surface_denny_mumford(172.42, draught=10.0, displacement=volume)
    assert got == pytest.approx(2931.14 + 4245.28, abs=0.01)


def test_denny_mumford_of_a_tanker_within_its_error():
    """KVLCC2: 320 m, 20.8 m, 312 622 m3, wetted surface 27 194 m2 (published)."""
    got = reg.wetted_surface_denny_mumford(325.5, draught=20.8, displacement=312_622.0)
    assert got == pytest.approx(27_194.0, rel=0.04)


@pytest.mark.parametrize(
    ("block", "midship", "waterplane"), [(0.8098, 0.998, 0.90), (0.651, 0.985, 0.82)]
)
def test_coefficients_of_kvlcc2_and_kcs(block, midship, waterplane):
    """Published forms: KVLCC2 C_B .8098, C_M .998; KCS C_B .651, C_M .985."""
    assert coefficients.midship_from_block(block) == pytest.approx(midship, abs=0.012)
    assert coefficients.waterplane_from_block(block) == pytest.approx(waterplane, abs=0.06)


def test_lcb_of_kvlcc2_and_kcs():
    """KVLCC2 +3.48 %, KCS -1.48 % of L_PP (published)."""
    assert coefficients.lcb_from_prismatic(0.8098 / 0.998) == pytest.approx(3.48, abs=1.5)
    assert coefficients.lcb_from_prismatic(0.651 / 0.985) == pytest.approx(-1.48, abs=1.5)


def test_regressions_written_out():
    """Values calculated by hand from the printed formulas."""
    assert coefficients.block_from_froude(0.25) == pytest.approx(0.633125, abs=1e-9)
    assert coefficients.midship_from_block(0.6) == pytest.approx(1.0 / (1.0 + 0.4**3.5))
    assert coefficients.waterplane_from_block(0.7) == pytest.approx(0.8)
    assert coefficients.lcb_from_prismatic(0.7) == pytest.approx(0.08)
    assert coefficients.lcb_from_froude(0.2) == pytest.approx(1.02)
    block = displacement.block_at_draught(10.0, design_draught=8.0, design_block=0.7)
    assert block == pytest.approx(1.0 - 0.3 * 0.8 ** (1.0 / 3.0))


def test_block_from_froude():
    """KCS at Fn .26 has .651; KVLCC2 at .142 is outside."""
    assert coefficients.block_from_froude(0.26) == pytest.approx(0.651, abs=0.05)
    assert np.isnan(coefficients.block_from_froude([0.142, 0.33])).all()


def test_block_grows_with_draught_and_meets_the_design():
    blocks = displacement.block_at_draught([6.0, 8.0, 10.0], design_draught=10.0, design_block=0.8)
    assert np.all(np.diff(blocks) > 0.0)
    assert blocks[-1] == pytest.approx(0.8)


SHIP = {
    "length_between_perpendiculars_m": 169.0,
    "length_waterline_m": 172.42,
    "breadth_m": 32.0,
    "draught_m": 10.0,
    "displacement_m3": 42_453.0,
    "block_coefficient": 0.785,
    "midship_coefficient": 0.995,
    "design_froude": 0.2,
}


@pytest.mark.parametrize("quantity", sorted({**hydro.ESTIMATORS, **hydro.ESTIMATORS_IF_FITTED}))
def test_every_estimator_runs_on_a_ship_and_names_its_source(quantity):
    for estimator in {**hydro.ESTIMATORS, **hydro.ESTIMATORS_IF_FITTED}[quantity]:
        value = estimator.function(*(SHIP[name] for name in estimator.inputs))
        assert np.isfinite(value)
        assert estimator.source
        if quantity in SHIP:
            error = estimator.typical_error if quantity != "block_coefficient" else 0.06
            assert value == pytest.approx(SHIP[quantity], rel=max(2 * error, 0.01))


def test_arrays_equal_scalars():
    blocks = np.array([0.6, 0.7, np.nan, 0.85])
    got = coefficients.midship_from_block(blocks)
    assert np.isnan(got[2])
    assert got[3] == coefficients.midship_from_block(0.85)


def test_kristensen_by_kind_of_ship():
    """Factors and lines as printed: 1.02, 1.01, 1.035; 0.395 T + 1.30 and so on."""
    assert reg.waterline_from_perpendiculars(100.0) == pytest.approx(102.0)
    assert reg.waterline_from_perpendiculars(100.0, kind="container") == pytest.approx(101.0)
    assert reg.waterline_from_perpendiculars(100.0, kind="ro_ro") == pytest.approx(103.5)
    assert reg.perpendiculars_from_waterline(103.5, kind="ro_ro") == pytest.approx(100.0)
    assert reg.propeller_diameter_from_draught(10.0) == pytest.approx(5.25)
    assert reg.propeller_diameter_from_draught(10.0, kind="container") == pytest.approx(6.07)
    assert reg.propeller_diameter_from_draught(10.0, kind="ro_ro") == pytest.approx(7.05)
    with pytest.raises(InputError, match="container"):
        reg.waterline_from_perpendiculars(100.0, kind="contaner")


def test_no_bulb_is_invented():
    assert not set(hydro.ESTIMATORS) & set(hydro.ESTIMATORS_IF_FITTED)
    assert "bulb_area_m2" in hydro.ESTIMATORS_IF_FITTED


def test_rakke():
    assert reg.bulb_area_rakke(0.98, breadth=32.0, draught=10.0) == pytest.approx(25.088)
    assert reg.bulb_height_rakke(10.0) == pytest.approx(4.0)
    assert reg.transom_area_rakke(0.98, breadth=32.0, draught=10.0) == pytest.approx(15.9936)
