"""Evolution runs: repeatable, cancellable, feasible by the referee, and as good as documented."""

import signal
from functools import cache

import numpy as np
import pytest

from tests.evolution import jet
from thalweg.chart import Chart
from thalweg.core.errors import InputError, ThalwegWarning
from thalweg.core.objective import LegPrices
from thalweg.core.pareto_fronts import lower_hull
from thalweg.evolution import (
    EvolutionSettings,
    FrontRefinementSettings,
    Genome,
    StoppingCriteria,
    VariationSettings,
    evolve,
    refine_front,
)
from thalweg.evolution.evolve import METHODS, ConvergenceTest
from thalweg.evolution.indicators import c_metric, hypervolume, non_dominated
from thalweg.evolution.initial_population import least_cost_setting
from thalweg.evolution.nsga2 import Nsga2
from thalweg.route.refinement.scalarised_search import time_prices

ISLANDS = (
    ((200, 180), (240, 160), (260, 240), (250, 320), (215, 330)),
    ((300, 230), (330, 250), (325, 340), (290, 300)),
)
NORTH = ((100, 200), (200, 340), (325, 350), (400, 300))
SOUTH = ((100, 200), (190, 175), (240, 150), (335, 240), (400, 300))
BETWEEN = ((100, 200), (190, 175), (240, 150), (280, 240), (280, 310), (325, 345), (400, 300))


@cache
def islands() -> Chart:
    features = []
    for corners in ISLANDS:
        ring = [list(jet.position(*p))[::-1] for p in (*corners, corners[0])]
        shape = {"type": "Polygon", "coordinates": [ring]}
        features.append({"type": "Feature", "properties": {}, "geometry": shape})
    return Chart.from_geojson({"type": "FeatureCollection", "features": features})


def through(places, setting: int) -> Genome:
    lat, lon = np.array([jet.position(*p) for p in places]).T
    return Genome(lat, lon, np.full(len(places) - 1, setting))


def volume(front) -> float:
    return hypervolume(jet.objectives(front.objectives), jet.REFERENCE)


def same(a, b) -> bool:
    if len(a) != len(b) or not np.array_equal(a.objectives, b.objectives):
        return False
    return all(
        np.array_equal(getattr(g, name), getattr(h, name))
        for g, h in zip(a.genomes, b.genomes)
        for name in ("lat", "lon", "setting", "wait")
    )


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
def test_fronts_are_repeatable_feasible_and_better_than_the_seeds(method):
    evaluator = jet.evaluator(chart=islands())
    seeds = [through(way, s) for way in (NORTH, SOUTH, BETWEEN) for s in (6, 11)]

    def run(seed, evaluations):
        settings = EvolutionSettings(method, 40, seed)
        stopping = StoppingCriteria(evaluations=evaluations, settled=None)
        return evolve(evaluator, seeds, settings=settings, stopping=stopping)

    short = run(3, 600)
    assert same(short, run(3, 600))
    assert not same(short, run(4, 600))
    front = run(3, 4000)
    assert non_dominated(front.objectives).all()
    assert 4 <= len(front) <= 40
    assert front.stopped == "evaluations"
    time, cost, violation = evaluator(seeds)
    start = np.column_stack([time, cost])[violation == 0.0]
    assert c_metric(front.objectives, start) == 1.0
    assert volume(front) > 1.02 * hypervolume(jet.objectives(start), jet.REFERENCE)
    for genome, told in zip(front.genomes[::8], jet.objectives(front.objectives)[::8]):
        hours, tonnes, broken = jet.refereed(genome, islands())
        assert broken == 0
        assert (hours, tonnes) == pytest.approx(tuple(told), rel=5e-4)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("size", "lines", "least"),
    [(100, 16, 162.95), (300, 48, 163.4)],
)
def test_refined_front_of_the_jet_and_eddies(size, lines, least):
    seeds = [jet.straight(s) for s in (0, 5, 6, 11)]
    settings = FrontRefinementSettings(size, lines, seed=1)
    front = refine_front(jet.evaluator(), seeds, settings=settings)
    told = np.array([jet.refereed(genome) for genome in front.genomes])
    assert (told[:, 2] == 0).all()
    assert hypervolume(told[:, :2], jet.REFERENCE) > least  # 336,000 evaluations by NSGA-II: 163.02
    hours = np.array([20.0, 24.0, 28.0])
    best_known = np.array([23.436, 19.870, 17.633])
    order = np.argsort(told[:, 0])
    assert (np.interp(hours, told[order, 0], told[order, 1]) < 1.001 * best_known).all()
    assert {"local search"} <= set(front.origin) <= {"seed", "local search", "nsga2"}


@pytest.mark.slow
def test_refined_front_among_islands_is_feasible_repeatable_and_ahead_of_evolution():
    evaluator = jet.evaluator(chart=islands())
    seeds = [through(way, s) for way in (NORTH, SOUTH, BETWEEN) for s in (6, 11)]
    given = {
        "settings": FrontRefinementSettings(60, 16, seed=5),
        "stopping": StoppingCriteria(generations=20),
    }
    front = refine_front(evaluator, seeds, **given)
    assert same(front, refine_front(evaluator, seeds, **given))
    evolved = evolve(
        evaluator,
        seeds,
        settings=EvolutionSettings(size=60, seed=5),
        stopping=StoppingCriteria(evaluations=10_000),
    )
    assert volume(front) > volume(evolved)
    assert len(front) <= 60
    for genome in front.genomes[::6]:
        assert jet.refereed(genome, islands())[2] == 0


@pytest.mark.slow
def test_without_evolution_the_seeds_alone_are_refined():
    evaluator, seeds = jet.evaluator(), [jet.straight(s) for s in range(0, 12, 3)]
    settings = FrontRefinementSettings(8, 4, exploration=0)
    front = refine_front(evaluator, seeds, settings=settings, stopping=StoppingCriteria(0))
    assert set(front.origin) == {"local search"} and len(front) <= 8
    assert front.objectives[:, 1].min() < 0.98 * evaluator(seeds)[1].min()


@pytest.mark.slow
def test_cancelled_runs_keep_the_best_so_far_and_say_so():
    evaluator, told = jet.evaluator(), []
    calls = iter([False] * 5 + [True] * 100)
    front = evolve(
        evaluator,
        [jet.straight(6)],
        settings=EvolutionSettings(size=20),
        cancel=lambda: next(calls),
        progress=told.append,
    )
    assert front.cancelled
    assert front.generations == 5
    assert [p.generation for p in told] == list(range(6))
    assert told[-1].evaluations == front.evaluations
    assert len(front)
    volumes = [hypervolume(jet.objectives(p.front), jet.REFERENCE) for p in told]
    assert volume(front) == pytest.approx(volumes[-1])
    assert volumes == sorted(volumes)
    for step in (0, 70):
        left = iter([False] * step + [True] * 1000)
        front = refine_front(
            evaluator,
            [jet.straight(6)],
            settings=FrontRefinementSettings(20),
            cancel=lambda: next(left),  # noqa: B023
        )
        assert front.cancelled
        assert len(front)


@pytest.mark.parametrize(
    ("search", "settings"),
    [(evolve, EvolutionSettings(size=20)), (refine_front, FrontRefinementSettings(20))],
)
def test_ctrl_c_keeps_the_best_so_far_and_a_second_one_interrupts(search, settings):
    def press(_):
        signal.raise_signal(signal.SIGINT)

    seeds = [jet.straight(s) for s in (0, 6, 11)]
    with pytest.warns(ThalwegWarning, match="Stopped by Ctrl-C"):
        front = search(
            jet.evaluator(),
            seeds,
            settings=settings,
            progress=lambda told: press(told) if told.generation == 3 else None,
        )
    assert front.cancelled and len(front)
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    with pytest.raises(KeyboardInterrupt):
        search(
            jet.evaluator(),
            seeds,
            settings=settings,
            progress=lambda report: (press(report), press(report)),
        )
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_runs_end_by_what_limits_them():
    evaluator, seeds = jet.evaluator(), [jet.straight(6)]

    def run(**limits):
        stopping = StoppingCriteria(**limits)
        return evolve(evaluator, seeds, settings=EvolutionSettings(size=10), stopping=stopping)

    assert run(generations=3).stopped == "generations"
    assert run(generations=0).generations == 0
    assert run(evaluations=50).evaluations == 55
    quick = run(seconds=0.0)
    assert quick.stopped == "seconds"
    assert len(quick)
    assert run(settled=np.inf).stopped == "settled"


def test_a_front_has_settled_when_its_distances_vary_no_more():
    settling = ConvergenceTest(1e-6)
    front = np.array([[0.0, 1.0], [1.0, 0.0]])
    for _ in range(33):
        assert not settling.settled(front)
    assert settling.settled(front)
    rng, moving = np.random.default_rng(0), ConvergenceTest(1e-6)
    assert not any(moving.settled(rng.random((5, 2))) for _ in range(100))


def test_the_ask_and_tell_interface_suffices():
    evaluator = jet.evaluator()
    rng = np.random.default_rng(0)
    first = evaluator.population([jet.straight(s) for s in range(12)], capacity=40)
    strategy = Nsga2(evaluator, first, size=8, variation_settings=VariationSettings(), rng=rng)
    assert strategy.ask() is first
    for _ in range(3):
        asked = strategy.ask()
        strategy.tell(evaluator.score(asked))
        assert len(strategy.population) == 8
        assert (evaluator.score(strategy.population) == strategy.scores).all()


def test_thriftiest_setting_and_prices_of_time():
    evaluator = jet.evaluator()
    assert least_cost_setting(evaluator) == 0  # 8.8 kn: 0.0677 t/nm
    assert least_cost_setting(jet.evaluator(prices=LegPrices(time=10.0))) == 11
    prices = time_prices(evaluator, 5)
    assert (np.diff(prices) > 0.0).all()
    hull = lower_hull(*np.array([(24 / s, f / s) for s, f in zip(jet.SPEED_KN, jet.FUEL_T_DAY)]).T)
    assert sorted(jet.SPEED_KN[k] for k in hull) == [8.8, 9.5, 9.9, 14.1, 14.3, 14.8, 15.2]


def test_waits_that_help_stay_and_others_go():
    base = jet.straight(6, 8)
    waiting = Genome(base.lat, base.lon, base.setting, [0, 0, 90.0, 0, 0, 0, 0, 0])
    front = evolve(
        jet.evaluator(),
        [waiting],
        settings=EvolutionSettings(size=30, seed=2),
        stopping=StoppingCriteria(generations=40),
    )
    assert front.genomes[0].wait.max() < 20.0  # the fastest has no time to wait


@pytest.mark.parametrize(
    ("wrong", "word"),
    [
        (lambda: EvolutionSettings(size=3), "too small"),
        (lambda: EvolutionSettings(size="many"), "whole number"),
        (lambda: EvolutionSettings(seed=-1), "whole number"),
        (lambda: FrontRefinementSettings(time_prices=-1), "whole number"),
        (lambda: StoppingCriteria(generations="3"), "zero or more"),
        (lambda: EvolutionSettings("nsga"), "nsga2"),
        (lambda: FrontRefinementSettings(2), "too small"),
        (lambda: StoppingCriteria(generations=-1), "zero or more"),
        (lambda: StoppingCriteria(seconds=float("nan")), "zero or more"),
    ],
)
def test_impossible_values_are_refused(wrong, word):
    with pytest.raises(InputError, match=word):
        wrong()


@pytest.mark.parametrize("search", [evolve, refine_front])
def test_refining_needs_seeds(search):
    with pytest.raises(InputError, match="no initial track"):
        search(jet.evaluator(), [])
