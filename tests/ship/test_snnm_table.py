"""Precomputed sums of the SNNM formula for one hull, against its integral over the spectrum."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from thalweg.core.units import GRAVITY
from thalweg.ship.methods.added_resistance.mean_wave_force import (
    LOG_FREQUENCY_STEP,
    REFLECTION_STEP,
    log_spaced_nodes,
)
from thalweg.ship.methods.added_resistance.snnm import frequency_scale, snnm_transfer
from thalweg.ship.methods.added_resistance.snnm_hull import (
    SnnmHull,
)
from thalweg.ship.methods.added_resistance.snnm_table import SnnmTable
from thalweg.ship.methods.seakeeping.wave_spectra import bretschneider

HULLS = {
    "tanker": SnnmHull(320.0, 58.0, 20.8, 20.8, 0.81, 54.0, 70.0),
    "container": SnnmHull(175.0, 25.4, 9.0, 9.6, 0.57, 60.0, 70.0),
    "bulker": SnnmHull(169.0, 32.0, 10.0, 10.0, 0.785, 50.0, 60.0),
}
TABLES = {name: SnnmTable.of(hull, shortest=2.0, longest=30.0) for name, hull in HULLS.items()}


def mean_force(speed, height, period, angle, hull):
    """The integral over the spectrum by the steps of the table, for one condition."""
    reduced = log_spaced_nodes(0.3, 4.0, step=LOG_FREQUENCY_STEP["bretschneider"])
    froude = np.asarray(speed / np.sqrt(GRAVITY * hull.length))
    own = reduced / frequency_scale(np.asarray(angle), froude, hull.arrays(), GRAVITY)
    shortest = np.sqrt(2.0 * np.pi * GRAVITY / (2.5 * hull.length))  # that are reflected
    step = REFLECTION_STEP["bretschneider"]
    parts = (
        (own, LOG_FREQUENCY_STEP["bretschneider"]),
        (shortest * log_spaced_nodes(1.0, 60.0, step=step), step),
    )
    return sum(
        2.0 * width * np.sum(bretschneider(w, height=height, period=period) * w * force[part])
        for part, (w, width) in enumerate(parts)
        for force in [snnm_transfer(w, speed, angle, hull)]
    )


@given(
    st.sampled_from(sorted(HULLS)),
    st.floats(0.0, 0.34),
    st.floats(0.0, 12.0),
    st.floats(2.0, 30.0),
    st.floats(0.0, np.pi),
)
def test_it_gives_the_sums_of_the_formula(name, froude, height, period, angle):
    hull, speed = HULLS[name], froude * np.sqrt(GRAVITY * HULLS[name].length)
    true = float(mean_force(speed, height, period, angle, hull))
    found = float(TABLES[name](speed, height, period, angle))
    usual = 1025 * GRAVITY * height**2 * hull.breadth**2 / hull.length
    assert found == pytest.approx(true, rel=1e-4, abs=2e-5 * usual + 1e-12)


def test_fast_ships_overtake_short_waves():
    """Where every published branch of the following sea is taken."""
    hull = HULLS["container"]
    speed, period = np.meshgrid(np.linspace(6.0, 14.0, 9), np.linspace(2.0, 8.0, 9))
    for angle in (1.7, 2.2, 2.9, np.pi):
        true = np.vectorize(mean_force)(speed, 1.0, period, angle, hull)
        found = TABLES["container"](speed, 1.0, period, angle)
        assert found == pytest.approx(true, rel=1e-4, abs=1e-4 * np.abs(true).max())


def test_unknown_stays_unknown_and_a_flat_sea_has_no_resistance():
    table = TABLES["bulker"]
    for at in ((np.nan, 1.0, 8.0, 0.0), (7.0, np.nan, 8.0, 0.0), (7.0, 1.0, np.nan, 0.0)):
        assert np.isnan(table(*at))
    assert np.isnan(table(7.0, 1.0, 8.0, np.nan))
    assert float(table(7.0, 0.0, 8.0, 2.0)) == 0.0
    assert table(np.full((2, 3), 7.0), 1.0, 8.0, np.zeros(3)).shape == (2, 3)
