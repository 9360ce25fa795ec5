"""Scores of a population: the same numbers as those of the referee and of the time evaluator."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from tests.evolution import jet
from thalweg.chart import Chart
from thalweg.core.errors import InputError
from thalweg.core.limits import Limits
from thalweg.core.objective import LegPrices
from thalweg.evolution import Genome, Population
from thalweg.kernels.leg import population_sailing
from thalweg.route.evaluators.population import concatenated_populations
from thalweg.route.evaluators.time_evaluator import TrackBatch
from thalweg.route.track import Track

rng = np.random.default_rng(7)


def wavy(points: int = 14, seed: int = 0) -> Genome:
    random = np.random.default_rng(seed)
    base = jet.straight(6, points)
    lat, lon = np.array(base.lat), np.array(base.lon)
    lat[1:-1] += random.normal(0.0, 0.002, points - 2)
    return Genome(lat, lon, random.integers(5, 12, points - 1))


@pytest.mark.slow
def test_the_referee_agrees():
    evaluator = jet.evaluator()
    genomes = [jet.straight(0), jet.straight(11), wavy(seed=1), wavy(seed=2)]
    time, cost, violation = evaluator(genomes)
    told = np.array([jet.refereed(genome)[:2] for genome in genomes])
    assert jet.objectives(np.column_stack([time, cost])) == pytest.approx(told, rel=3e-4)
    assert (violation == 0.0).all()


def test_the_time_evaluator_agrees_to_rounding():
    evaluator = jet.evaluator()
    genome = wavy(seed=3)
    n = len(genome)
    population = evaluator.population([genome])
    pieces = np.full((1, n - 1), 7)
    population.genes[0, : n - 1, population_sailing.PIECES] = 7
    _, arrive = evaluator.sail(population)
    still = np.full((1, n), -np.inf)
    batch = TrackBatch(
        genome.lat[None], genome.lon[None], still, genome.setting[None], depart=np.zeros(1)
    )
    quick, _ = evaluator.time_evaluator.sail(batch, pieces=pieces)
    assert arrive[0, :n] == pytest.approx(quick[0], rel=1e-12)


def test_earliest_departures_mean_the_same_to_both_evaluators():
    evaluator = jet.evaluator()
    genome = wavy(seed=4)
    n = len(genome)
    population = evaluator.population([genome])
    _, free = evaluator.sail(population)
    leave = np.full((1, n), -np.inf)
    leave[0, 0], leave[0, 3], leave[0, 6] = 30.0, free[0, 3] + 100.0, 0.0  # the last: no wait
    score, arrive = evaluator.sail(population, leave=leave)
    batch = TrackBatch(
        genome.lat[None], genome.lon[None], leave, genome.setting[None], depart=np.zeros(1)
    )
    quick, left, _ = evaluator.time_evaluator.sail_and_wait(batch)
    assert arrive[0, :n] == pytest.approx(quick[0], rel=1e-3)
    assert (left[0, 0], left[0, 3]) == (30.0, free[0, 3] + 100.0)
    waits = np.zeros((1, n))
    waits[0, 0], waits[0, 3] = 30.0, leave[0, 3] - arrive[0, 3]
    population.genes[:, :n, population_sailing.WAITING_TIME] = waits
    again, there = evaluator.sail(population)
    assert there == pytest.approx(arrive, rel=1e-12)
    assert again == pytest.approx(score, rel=1e-12)


def test_a_population_gives_the_results_of_single_tracks_for_any_number_of_threads():
    evaluator = jet.evaluator()
    genomes = [wavy(int(rng.integers(3, 30)), seed) for seed in range(80)]
    together = np.column_stack(evaluator(genomes))
    alone = np.array([np.column_stack(evaluator([genome]))[0] for genome in genomes])
    assert (together == alone).all()


def test_time_waits_and_fees_have_their_price():
    genome = jet.straight(6, 6)
    waiting = Genome(genome.lat, genome.lon, genome.setting, [5.0, 0, 7.0, 0, 0, 0])
    plain = jet.evaluator()
    time, cost, _ = plain([genome, waiting])
    assert time[1] - time[0] == pytest.approx(12.0, abs=2.0)  # the tide turns meanwhile
    priced = jet.evaluator(prices=LegPrices(inside=3.0, outside=2.0, time=0.5, waiting=0.01 * 4.0))
    _, dear, _ = priced([genome, waiting])
    expected = 2.0 * cost + 0.5 * time + np.array([0.0, 12.0]) * 0.01 * 4.0
    assert dear == pytest.approx(expected, rel=1e-12)


def test_what_cannot_be_sailed_is_measured_as_a_share_of_the_length():
    south, west = jet.position(200.0, 150.0)
    north, east = jet.position(260.0, 300.0)
    ring = [[west, south], [east, south], [east, north], [west, north], [west, south]]
    land = {
        "type": "Feature",
        "properties": {},
        "geometry": {"type": "Polygon", "coordinates": [ring]},
    }
    chart = Chart.from_geojson({"type": "FeatureCollection", "features": [land]})
    evaluator = jet.evaluator(chart=chart)
    track = jet.straight(6, 11)  # ten equal legs of 30 nm from x = 100 to 400: 3 touch the land
    _, _, violation = evaluator([track])
    assert violation[0] == pytest.approx(0.3, abs=1e-3)


def test_lateness_and_the_end_of_the_data_are_violations():
    genome = jet.straight(0)
    time = jet.evaluator()([genome])[0][0]
    late = jet.evaluator(latest=jet.T0 + 0.8 * time)([genome])[2][0]
    assert late == pytest.approx(0.25, rel=1e-6)  # a fifth of the passage over four fifths of it
    cut = jet.fields()
    half = int(np.searchsorted(cut.times, jet.T0 + 0.5 * time))
    short = replace(cut, times=cut.times[:half], values=cut.values[:half])
    gone = jet.evaluator(fields=short)([genome])[2][0]
    assert gone == pytest.approx(0.5, abs=0.05)


def test_no_data_is_no_calm():
    cut = jet.fields()
    values = cut.values.copy()
    values[:, :, 100:110] = math.nan
    gone = jet.evaluator(fields=replace(cut, values=values))([jet.straight(6)])[2][0]
    assert gone > 0.05


def test_only_changed_legs_are_looked_up():
    asked = []

    class Counting:
        has_depth = False
        zones = SimpleNamespace(has_penalty=False, penalty=(), price=(), eca=(), lanes=())

        def legs_blocked(self, lat1, lon1, lat2, lon2):
            asked.append(len(lat1))
            return np.zeros(len(lat1), bool)

    evaluator = jet.evaluator(chart=Counting())
    population = evaluator.population([wavy(10), wavy(12, seed=4)])
    evaluator.score(population)
    evaluator.score(population)
    assert asked == [9 + 11]
    population.genes[1, 4:6, population_sailing.IS_LOOKED_UP] = 0.0
    evaluator.score(population)
    assert asked == [20, 2]


def test_charted_depth_limits_legs():
    shoal = jet.chart().with_depth(lambda lat, lon: np.where(lon > 0.05, 5.0, 50.0))
    deep = Limits(required_depth=8.0)
    track = jet.straight(6, 11)
    assert jet.evaluator(chart=shoal)([track])[2][0] == 0.0  # not asked for
    _, _, violation = jet.evaluator(chart=shoal, limits=deep)([track])
    share = (jet.GOAL[1] - 0.05) / (jet.GOAL[1] - jet.START[1])
    assert violation[0] == pytest.approx(share, abs=0.11)  # whole legs


def test_canal_legs_have_fixed_time_and_fee_in_any_sea():
    evaluator = jet.evaluator(prices=LegPrices(outside=2.0))
    genome = jet.straight(6, 4)
    length = 30.0 * jet.NM / jet.SHRINK
    canal = SimpleNamespace(length=length, transit_time=length / (9.0 * jet.KNOT), fee=40.0)

    class WithCanal:
        has_depth = False
        zones = SimpleNamespace(has_penalty=False, penalty=(), price=(), eca=(), lanes=())
        canals = (canal,)

        def legs_blocked(self, lat1, lon1, lat2, lon2):
            return np.zeros(len(lat1), bool)

        def canal_of_legs(self, lat1, lon1, lat2, lon2):
            return np.where(lat1 == genome.lat[1], 0, -1)

    given = {"chart": WithCanal(), "latest": math.inf}
    free, feeless = jet.evaluator(prices=LegPrices(dues=1.0), **given), jet.evaluator(**given)
    population = evaluator.population([genome])
    _, before = jet.evaluator(latest=math.inf).sail(population)
    _, cost, violation = free([genome])
    _, arrive = free.sail(free.population([genome]))
    assert violation[0] == 0.0
    assert arrive[0, 2] - arrive[0, 1] == pytest.approx(canal.transit_time, rel=1e-9)
    assert arrive[0, 1] == before[0, 1]
    assert cost[0] - feeless([genome])[1][0] == pytest.approx(40.0)
    burnt = jet.FUEL_T_DAY[1] / 86.4 * canal.transit_time  # 9 kn needs the setting of 9.5 kn
    sailed = np.diff(arrive[0])[[0, 2]] * jet.FUEL_T_DAY[6] / 86.4
    assert cost[0] == pytest.approx(40.0 + burnt + sailed.sum(), rel=1e-6)


def test_price_and_penalty_zones_and_control_areas():
    class ZonesEverywhere:
        penalty = price = eca = (1,)
        has_penalty = True

        def eca_fraction(self, lat1, lon1, lat2, lon2, *, finest):
            return np.full(len(lat1), 0.25)

        def factors(self, lat1, lon1, lat2, lon2):
            return np.full(len(lat1), 1.1), np.full(len(lat1), 3.0)

    class Zoned:
        has_depth = False
        zones = ZonesEverywhere()

        def legs_blocked(self, lat1, lon1, lat2, lon2):
            return np.zeros(len(lat1), bool)

    genome = jet.straight(6)
    time, cost, _ = jet.evaluator()([genome])
    both = jet.evaluator(chart=Zoned(), prices=LegPrices(inside=2.0, dues=1.0))([genome])
    assert both[0][0] == pytest.approx(1.1 * time[0])
    assert both[1][0] == pytest.approx(1.1 * 3.0 * (0.25 * 2.0 + 0.75) * cost[0])
    mass = jet.evaluator(chart=Zoned())([genome])[1]
    assert mass[0] == pytest.approx(1.1 * cost[0])  # price zones do not change a mass of fuel


def test_genomes_go_to_tracks_and_back():
    track = Track([1.0, 1.5, 2.0], [179.0, -179.5, -178.0], 0.0, [3.0, 4.0, 0.0], [-1, 2])
    genome = Genome.from_track(track, settings=5, via=[(1.5, 180.5)])
    assert genome.setting.tolist() == [4, 2]
    assert genome.via.tolist() == [True, True, True]
    population = concatenated_populations(
        Population.of([genome]), Population.of([wavy(9)], capacity=20)
    )
    assert population.capacity == 20
    back = population.genome(0)
    assert back.to_track(0.0) == track.replaced(setting=[4, 2])
    assert population.take([1]).genome(0).lat.tolist() == wavy(9).lat.tolist()


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: jet.evaluator(latest=jet.T0),
        lambda: jet.evaluator(fuel=jet.constant_table([1.0, 2.0])),
        lambda: jet.evaluator()([jet.straight(12)]),
        lambda: jet.evaluator()([]),
        lambda: Genome([1.0], [2.0], []),
        lambda: Genome([1.0, 2.0], [2.0, 3.0], [1, 2]),
        lambda: Genome.from_track(Track([0.0, 1.0], [0.0, 1.0], 0.0), settings=3, via=[(0.5, 0.5)]),
    ],
)
def test_impossible_values_are_refused(wrong):
    with pytest.raises(InputError) as caught:
        wrong()
    assert caught.value.possible
    assert caught.value.remedy
