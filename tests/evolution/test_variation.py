"""Variation: unbiased draws, shapes with the variances of their formulas, valid tracks."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.evolution import jet
from thalweg.chart import Chart
from thalweg.core.errors import InputError
from thalweg.core.geodesy import inverse
from thalweg.evolution import Genome, OperatorWeights, VariationSettings
from thalweg.evolution.variation import reproduce
from thalweg.kernels.evolution import random_numbers
from thalweg.kernels.leg import population_sailing

DRAWS = 4000
NONE = dict.fromkeys(("insert", "translate", "delete", "speed", "split", "merge", "pause"), 0.0)


def only(name: str, **more) -> VariationSettings:
    return VariationSettings(mix=OperatorWeights(**{**NONE, name: 1.0}), crossover=0.0, **more)


def offspring_of(genomes, variation_settings, count, *, capacity=64, seed=0, chart=None):
    """Return ``count`` children of each pair of neighbours in a list of genomes."""
    evaluator = jet.evaluator(chart=chart)
    population = evaluator.population(genomes, capacity=capacity)
    pairs = np.tile([[0, len(genomes) - 1]], (count // 2, 1))
    rng = np.random.default_rng(seed)
    return reproduce(
        population, pairs, evaluator=evaluator, variation_settings=variation_settings, rng=rng
    ).genomes()


@pytest.mark.parametrize(
    ("shape", "share"), [("rhombus", 1 / 6), ("ellipse", 1 / 4), ("gaussian", 1 / 5.99146)]
)
@pytest.mark.parametrize("lat", [0.0, 60.0])
def test_inserted_points_have_the_spread_of_their_shape(shape, share, lat):
    leg = Genome([lat, lat + 0.2], [10.0, 10.3], [3])  # a slanting leg of some 25 km
    length, course, _ = (float(x) for x in inverse(lat, 10.0, lat + 0.2, 10.3))
    a, b = 0.5 * length, 0.5 * length * 0.4
    offspring = offspring_of(
        [leg], only("insert", shape=shape, insert_width=0.4, changes=1e-6), DRAWS
    )
    assert all(len(g) == 3 and g.setting.tolist() == [3, 3] for g in offspring)
    far, bearing, _ = inverse(
        lat, 10.0, [g.lat[1] for g in offspring], [g.lon[1] for g in offspring]
    )
    x, y = far * np.cos(bearing - course) - a, far * np.sin(bearing - course)
    tolerance = 5.0 * math.sqrt(2.0 / DRAWS)
    assert np.var(x) == pytest.approx(a * a * share, rel=tolerance)
    assert np.var(y) == pytest.approx(b * b * share, rel=tolerance)
    assert abs(np.mean(x)) < 5.0 * a * math.sqrt(share / DRAWS) + 0.005 * a
    assert abs(np.mean(y)) < 5.0 * b * math.sqrt(share / DRAWS) + 0.005 * b


def test_translations_are_even_in_a_disc():
    track = Genome([50.0, 50.1, 50.0], [0.0, 0.2, 0.4], [1, 2])
    offspring = offspring_of([track], only("translate", radius=(0.3, 0.3)), DRAWS)
    legs, _, _ = inverse(track.lat[:-1], track.lon[:-1], track.lat[1:], track.lon[1:])
    radius = 0.3 * float(legs.mean())
    far, bearing, _ = inverse(
        50.1, 0.2, [g.lat[1] for g in offspring], [g.lon[1] for g in offspring]
    )
    assert far.max() < radius * 1.005
    assert np.mean((far / radius) ** 2) == pytest.approx(0.5, abs=5 * math.sqrt(1 / 12 / DRAWS))
    assert abs(np.mean(np.exp(1j * bearing))) < 5.0 / math.sqrt(DRAWS)
    assert all(g.setting.tolist() == [1, 2] for g in offspring)


@pytest.mark.parametrize("scale", [0.25, 2.0])
def test_number_of_changes_falls_off_exponentially(scale):
    points = 41
    offspring = offspring_of(
        [jet.straight(2, points)], only("insert", changes=scale * (points - 1)), DRAWS, capacity=99
    )
    told = np.bincount([len(g) - points for g in offspring], minlength=points)[1:] / DRAWS
    expected = np.exp(-np.arange(1, points) / scale)
    expected /= expected.sum()
    assert told == pytest.approx(expected, abs=5.0 * math.sqrt(0.25 / DRAWS))
    assert told[0] == pytest.approx(0.982 if scale == 0.25 else 0.393, abs=0.04)


def test_legs_are_drawn_by_length():
    lat, lon = np.zeros(4), np.array([0.0, 0.1, 0.4, 1.0])
    offspring = offspring_of([Genome(lat, lon, [0, 1, 2])], only("insert", changes=1e-6), DRAWS)
    where = [int(g.setting[np.flatnonzero(np.diff(g.setting) == 0)[0]]) for g in offspring]
    assert np.bincount(where) / DRAWS == pytest.approx([0.1, 0.3, 0.6], abs=0.04)


def test_turning_points_move_more():
    track = Genome([0.0, 0.0, 0.0, 0.3], [0.0, 0.1, 0.2, 0.2], [0, 0, 0])  # a right angle at 2
    offspring = offspring_of([track], only("translate", changes=1e-6), DRAWS)
    moved = np.array([[g.lat[k] != track.lat[k] for k in (1, 2)] for g in offspring]).mean(axis=0)
    weight = np.array([0.05, math.pi / 2 + 0.05])
    assert moved == pytest.approx(weight / weight.sum(), abs=0.03)


def test_deleting_keeps_the_setting_before_merging_either():
    track = Genome([0.0, 0.1, 0.0], [0.0, 0.1, 0.2], [4, 9])
    assert {tuple(g.setting) for g in offspring_of([track], only("delete"), 50)} == {(4,)}
    kept = [int(g.setting[0]) for g in offspring_of([track], only("merge"), 1000)]
    assert set(kept) == {4, 9}
    assert 0.4 < np.mean(np.array(kept) == 4) < 0.6


def test_runs_of_legs_get_one_other_speed():
    track = jet.straight(5, 9)
    offspring = offspring_of([track], only("speed"), DRAWS)
    changed = [np.flatnonzero(g.setting != 5) for g in offspring]
    assert all(len(c) and len(c) == c[-1] - c[0] + 1 for c in changed)
    assert all(len(set(g.setting[c])) == 1 for g, c in zip(offspring, changed))
    runs = np.bincount([len(c) for c in changed], minlength=9)[1:] / DRAWS
    assert runs == pytest.approx(np.full(8, 1 / 8), abs=0.03)
    new = np.bincount([g.setting[c[0]] for g, c in zip(offspring, changed)], minlength=12) / DRAWS
    expected = np.full(12, 0.5 / 11)  # half of the draws are the next up or down
    expected[[4, 6]] += 0.25
    expected[5] = 0.0
    assert new == pytest.approx(expected, abs=0.04)


def test_splitting_cuts_a_leg_on_its_great_circle():
    track = Genome([40.0, 45.0], [-70.0, -20.0], [5])
    for g in offspring_of([track], only("split"), 100):
        assert sorted(g.setting.tolist())[0] != sorted(g.setting.tolist())[1]
        assert 5 in g.setting
        via = inverse(g.lat[:-1], g.lon[:-1], g.lat[1:], g.lon[1:])[0].sum()
        assert via == pytest.approx(float(inverse(40.0, -70.0, 45.0, -20.0)[0]), rel=1e-5)


def test_pauses_change_waits_only():
    track = Genome([0.0, 0.1, 0.0], [0.0, 0.1, 0.2], [4, 9], [0.0, 100.0, 0.0])
    offspring = offspring_of([track], only("pause"), DRAWS)
    waits = np.array([g.wait[1] for g in offspring])
    assert waits.min() == 0.0
    assert np.mean(waits == 0.0) == pytest.approx(0.2, abs=0.03)
    assert waits.mean() == pytest.approx(80.0, rel=0.05)
    assert all((g.lat == track.lat).all() for g in offspring)


@settings(max_examples=25)
@given(st.integers(2, 30), st.integers(2, 30), st.integers(0, 10**6))
def test_offspring_are_tracks_from_start_to_goal(first, second, seed):
    random = np.random.default_rng(seed)
    parents = []
    for points in (first, second):
        base = jet.straight(0, points)
        lat = np.array(base.lat)
        lat[1:-1] += random.normal(0.0, 0.003, points - 2)
        parents.append(Genome(lat, base.lon, random.integers(0, 12, points - 1)))
    for g in offspring_of(parents, VariationSettings(crossover=0.7), 16, seed=seed, capacity=40):
        assert (g.lat[0], g.lon[0]) == (parents[0].lat[0], parents[0].lon[0])
        assert (g.lat[-1], g.lon[-1]) == (parents[0].lat[-1], parents[0].lon[-1])
        assert 2 <= len(g) <= 40
        assert ((g.setting >= 0) & (g.setting < 12)).all()
        assert np.isfinite(g.lat).all()
        assert (np.abs(g.lon) <= 180.0).all()


def test_crossover_joins_neighbouring_points_and_keeps_via_points():
    straight = jet.straight(3, 9)
    via = np.zeros(9, bool)
    via[4] = True
    a = Genome(straight.lat, straight.lon, straight.setting, via=via)
    bent = np.array(straight.lat)
    bent[1:4] += 0.002
    bent[5:8] -= 0.002
    b = Genome(bent, straight.lon, np.full(8, 7), via=via)
    offspring = offspring_of([a, b], VariationSettings(crossover=1.0, mutation=0.0), 200)
    kinds = {tuple(g.setting) for g in offspring}
    assert len(kinds) > 2
    for g in offspring:
        assert (g.lat[g.via] == a.lat[via | (np.arange(9) % 8 == 0)]).all()
        assert set(np.round(g.lat, 12)) <= set(np.round(np.append(a.lat, b.lat), 12))


def test_new_legs_keep_clear_of_land_and_canals_stay():
    south, west = jet.position(220.0, 150.0)
    north, east = jet.position(260.0, 262.0)
    ring = [[west, south], [east, south], [east, north], [west, north], [west, south]]
    shape = {"type": "Polygon", "coordinates": [ring]}
    land = {"type": "Feature", "properties": {}, "geometry": shape}
    chart = Chart.from_geojson({"type": "FeatureCollection", "features": [land]})
    places = [jet.position(*p) for p in ((100, 200), (215, 270), (265, 270), (400, 300))]
    lat, lon = np.array(places).T
    evaluator = jet.evaluator(chart=chart)
    population = evaluator.population([Genome(lat, lon, [6, 6, 6])], capacity=32)
    evaluator.look_up_legs(population)
    population.genes[0, 1, population_sailing.FIXED_TIME] = 50.0
    pairs = np.zeros((200, 2), dtype=np.int64)
    variation_settings = VariationSettings(crossover=0.0, radius=(0.05, 0.5))
    rng = np.random.default_rng(1)
    offspring = reproduce(
        population, pairs, evaluator=evaluator, variation_settings=variation_settings, rng=rng
    )
    for g in offspring.genomes():  # both ends of the canal are still there, next to each other
        k = np.flatnonzero(g.lat == lat[1])[0]
        assert g.lat[k + 1] == lat[2]
    blocked = evaluator(offspring)[2] > 0.0
    assert blocked.mean() < 0.1  # some tries fail


def test_random_numbers_are_those_of_splitmix():
    from thalweg.kernels.compilation.jit import jit

    draw = jit(lambda state: random_numbers.random_uniform(state))
    state = np.array([1234567], dtype=np.uint64)
    known = (6457827717110365317, 3203168211198807973, 9817491932198370423)  # published for 1234567
    assert [draw(state) for _ in known] == [(x >> 11) / 2.0**53 for x in known]


@pytest.mark.parametrize(
    "wrong",
    [
        {"shape": "star"},
        {"mix": OperatorWeights(**NONE)},
        {"radius": (0.0, 1.0)},
        {"crossover": 1.5},
        {"changes": 0.0},
    ],
)
def test_invalid_variation_settings_are_refused(wrong):
    with pytest.raises(InputError):
        VariationSettings(**wrong)
