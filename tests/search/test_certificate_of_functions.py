"""Bounds for functions by their Lipschitz bounds: true where those of samples alone are not."""

import math
from dataclasses import replace

import numpy as np
import pytest

from tests.search.test_time_certificate import CURRENTS, EAST, NORTH, SPEED, ship_of_one_speed
from thalweg.core.errors import InputError
from thalweg.core.geodesy import distance
from thalweg.core.limits import Limits
from thalweg.kernels import codes
from thalweg.kernels.certificate.barrier_check import closed_throughout
from thalweg.kernels.certificate.cell_conditions import TimeWindows
from thalweg.kernels.certificate.speed_ranges import widened_directions
from thalweg.sea import Sea
from thalweg.search.certificate.barrier_domain import BarrierDomain, StretchToBound
from thalweg.search.certificate.barrier_mesh import build_mesh
from thalweg.search.certificate.time_certificate import BarrierSearch, free_space_time

START, GOAL = (10.003, 20.0), (10.003, 20.6)
LENGTH = float(distance(*START, *GOAL))
JET, WIDTH = 1.0, 400.0  # [m/s], [m]
DEGREE = 110_608.0  # of latitude at 10 N [m]


def jet(t, y, x):
    """A jet along the way, narrower than cells: none of their nodes is in it."""
    return JET * np.maximum(0.0, 1.0 - np.abs(y - START[0]) * DEGREE / WIDTH) + 0.0 * x


def stretch(lipschitz=None, known=LENGTH / (SPEED + JET), **more) -> StretchToBound:
    sea = Sea.from_functions(
        {EAST: jet, NORTH: lambda t, y, x: 0.0 * x}, time_step=0.0, lipschitz=lipschitz
    )
    ship = ship_of_one_speed(SPEED)
    return StretchToBound(sea, None, ship, CURRENTS, START, GOAL, 1e9, 1.1 * known, **more)


RATES = {EAST: (1.02 * JET / WIDTH, 0.0), NORTH: (0.0, 0.0)}


def shifted(domain: BarrierDomain) -> float:
    """Return how far the nearest row of samples is from the axis of the jet [m]."""
    _, rows, _, _ = domain.raster.values.shape
    lat = domain.raster.corner[0] + domain.raster.corner[1] * np.arange(rows)
    return float(np.abs(lat - START[0]).min() * DEGREE)


@pytest.mark.parametrize("cells", [58, 72])
def test_a_jet_between_the_samples_is_in_the_bound_by_its_lipschitz_bound(cells):
    truth = LENGTH / (SPEED + JET)
    values = []
    for rates in (None, RATES):
        where = stretch(rates)
        domain = BarrierDomain.around(where, cells)
        free = free_space_time(where, domain)
        found = BarrierSearch(where, domain, cells, 3e-4).refine()
        assert ("Lipschitz" in domain.sampling) == (rates is not None)
        values.append(max(free.reached, 0.0 if found is None else found.reached))
        assert rates is not None or shifted(domain) > WIDTH  # no sample is in the jet
    sampled, certain = values
    assert sampled > 1.05 * truth
    assert 0.6 * truth < certain <= truth


def test_margins_are_half_a_diagonal_and_half_a_step_times_the_rates():
    where = stretch(RATES)
    domain = BarrierDomain.around(where, 60)
    _, dlat, _, dlon = domain.raster.corner
    half = 0.5 * 111_700.0 * math.hypot(dlat, dlon)
    margin = domain.margins[0, 0, codes.CURRENT_EAST]
    assert margin == domain.margins[0, 0, codes.CURRENT_NORTH]
    assert 0.97 * half * RATES[EAST][0] < margin <= half * RATES[EAST][0] * (1 + 1e-5)
    assert domain.strongest_current >= margin
    changing = Sea.from_functions(
        {EAST: lambda t, y, x: 0 * t, NORTH: lambda t, y, x: 0 * t},
        time_step=1200.0,
        lipschitz={EAST: (0.0, 3e-4), NORTH: (0.0, 4e-4)},
    )
    domain = BarrierDomain.around(replace(where, sea=changing), 60)
    step = float(np.diff(domain.raster.times).max())
    assert domain.margins[0, 0, codes.CURRENT_EAST] == pytest.approx(0.5 * step * 5e-4)


def test_without_bounds_of_all_functions_or_with_an_area_samples_are_what_is_stated():
    for rates, area in (({EAST: (1e-3, 0.0)}, None), (RATES, (9.0, 11.0, 19.0, 21.6))):
        sea = Sea.from_functions(
            {EAST: jet, NORTH: lambda t, y, x: 0.0 * x}, time_step=0.0, area=area, lipschitz=rates
        )
        domain = BarrierDomain.around(replace(stretch(), sea=sea), 40)
        assert "Lipschitz" not in domain.sampling and "sampled" in domain.sampling
        assert not domain.margins.any()


def test_a_limit_counts_with_the_margin_of_its_samples():
    """Waves of 4 m are above the limit of 3.5 m, but may be 0.8 m lower between the samples."""
    waves = {"sea_surface_wave_significant_height": lambda t, y, x: 4.0 + 0 * x}
    ship = ship_of_one_speed(SPEED, Limits(wave_height=3.5))
    channels = (codes.WAVE_HEIGHT_CHANNEL,)
    for low, is_open in ((0.3, False), (0.8, True)):
        sea = Sea.from_functions(waves, time_step=0.0)
        where = StretchToBound(sea, None, ship, channels, START, GOAL, 1e9, LENGTH / SPEED)
        domain = BarrierDomain.around(where, 24)
        margins = np.zeros((1, 1, codes.CHANNEL_COUNT))
        margins[..., codes.WAVE_HEIGHT_CHANNEL] = low
        mesh = build_mesh(domain.raster, 1, domain.ship, None, margins=margins)
        shape = mesh.shape[0] - 1, mesh.shape[1] - 1
        closed, may_close = np.ones(shape, bool), np.zeros(shape, bool)
        window = TimeWindows(np.zeros(shape), np.full(shape, 60.0))
        closed_throughout(mesh.world, window, closed, may_close)
        assert (closed != is_open).all()


def test_directions_are_those_of_vectors_within_a_distance():
    rng = np.random.default_rng(3)
    least, greatest, shortest, longest = widened_directions.py_func((0.4, 0.9, 2.0, 3.0), 0.7)
    for _ in range(500):
        size, at = rng.uniform(2.0, 3.0), rng.uniform(0.4, 0.9)
        turn = rng.uniform(-math.pi, math.pi)
        east = size * math.sin(at) + 0.7 * math.sin(turn)
        north = size * math.cos(at) + 0.7 * math.cos(turn)
        assert least <= math.atan2(east, north) <= greatest
        assert shortest <= math.hypot(east, north) <= longest
    around = widened_directions.py_func((0.4, 0.9, 0.5, 3.0), 0.7)
    assert around == (-math.pi, math.pi, 0.0, 3.7)


@pytest.mark.parametrize(
    ("given", "text"),
    [
        ([1.0], "is not a mapping"),
        ({"wind_speed": (1.0, 1.0)}, "no function of that name"),
        ({EAST: 1.0}, "two numbers of 0 or more"),
        ({EAST: (1.0, -1.0)}, "two numbers of 0 or more"),
    ],
)
def test_lipschitz_bounds_that_are_none_are_refused(given, text):
    functions = {EAST: jet, NORTH: jet}
    with pytest.raises(InputError, match="Lipschitz") as error:
        Sea.from_functions(functions, lipschitz=given)
    assert text in str(error.value)


def test_of_wind_the_bounds_are_those_of_its_components():
    functions = {"wind_speed": jet, "wind_from_direction": jet}
    with pytest.raises(InputError, match="eastward and northward"):
        Sea.from_functions(functions, lipschitz={"wind_speed": (1e-5, 0.0)})
    waves = Sea.from_functions(
        {"sea_surface_wave_from_direction": jet},
        lipschitz={"sea_surface_wave_from_direction": (180.0, 0.0)},
    )
    (layer,) = waves.layers
    assert sum(rates[0] for rates in layer.lipschitz.values()) == pytest.approx(math.pi)
