"""Evolution: evaluations of an ocean route, a run of NSGA-II, and fronts of the jet and eddies.

Seuren (2020) reports 146.9 s for about 21,000 evaluations of a route. Here the route runs from the
English Channel to New York through wind and currents on a raster of half a degree every three
hours, with the table of a bulk carrier with Kwon's speed loss. The targets are 1.5 s for the
evaluations of a route of about 200 points and 4 s for a whole run of NSGA-II, on two cores, warm.

Sea and ship are sampled at the middle of every segment of a leg. Two routes are evaluated: one of
201 waypoints, whose 200 legs have two segments each (the minimum), and one of 41 waypoints, as
evolution uses, with about as many segments as the other has legs. The numbers of waypoints and
segments are printed. NSGA-II starts with the route of 41 waypoints.

The fronts of the case "jet and eddies" are evaluated by the referee: hypervolume to (32 h, 32 t),
target 162.85 in one minute.

    python benchmarks/evolution.py [--skip-fronts]
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from tests.evolution import jet

from thalweg import Chart, Ship
from thalweg.core.geodesy import positions_along, rough_lengths
from thalweg.core.limits import Limits
from thalweg.evolution import (
    EvaluationResolution,
    Evaluator,
    EvolutionResult,
    EvolutionSettings,
    Genome,
    StoppingCriteria,
    TabulatedShip,
    evolve,
    make_evaluator,
    refine_front,
)
from thalweg.evolution.indicators import hypervolume
from thalweg.kernels import codes
from thalweg.kernels.leg import great_circle_sailing, population_sailing
from thalweg.sea.frozen_fields import GridFields

EVALUATIONS = 21_000
POPULATION = 336
START, BANKS, GOAL = (49.0, -6.0), (42.5, -50.0), (40.3, -73.0)


def weather() -> GridFields:
    """Return ten days of wind and currents over the North Atlantic."""
    times = np.arange(0, 241, 3) * 3600.0
    lat, lon = np.arange(30, 60.5, 0.5), np.arange(-80, 0.5, 0.5)
    t, y, x = np.meshgrid(times / 86400.0, lat, lon, indexing="ij")
    low = np.exp(-(((x + 60 - 8 * t) / 9) ** 2 + ((y - 46) / 6) ** 2) / 2)
    stream = np.exp(-(((y - 40 - 0.15 * (x + 60)) / 1.5) ** 2) / 2)
    values = np.empty((*t.shape, 4), np.float32)
    values[..., 0] = 1.2 * stream + 0.1 * np.sin(x + t)
    values[..., 1] = 0.3 * stream + 0.1 * np.cos(y - t)
    values[..., 2] = 6.0 - 2.5 * low * (y - 46)
    values[..., 3] = 2.0 + 2.5 * low * (x + 60 - 8 * t)
    index = np.full(codes.CHANNEL_COUNT, -1, np.int64)
    wanted = (codes.CURRENT_EAST, codes.CURRENT_NORTH, codes.WIND_EAST, codes.WIND_NORTH)
    index[list(wanted)] = range(4)
    return GridFields(times, 30.0, 0.5, -80.0, 0.5, values, index)


def ocean() -> Evaluator:
    """Return an evaluator for the North Atlantic."""
    ship = Ship.load("handysize-bulker")
    return make_evaluator(
        TabulatedShip(ship.tabulate(), ship.tabulate_fuel(), Limits()),
        weather(),
        depart=0.0,
        chart=Chart.gshhg("i"),
        resolution=EvaluationResolution(spacing=25_500.0),
    )


def crossing(legs: int) -> Genome:
    """Return two great circles with waypoints evenly along them, at the highest setting."""
    share = np.linspace(0.0, 1.0, legs // 2 + 1)
    east, west = positions_along(*START, *BANKS, share), positions_along(*BANKS, *GOAL, share)
    lat, lon = (np.concatenate([a, b[1:]]) for a, b in zip(east, west))
    return Genome(lat, lon, np.full(legs, OCEAN.settings - 1))


def pieces_of(route: Genome) -> int:
    """Return how many pieces the legs of a route are cut into, as the kernel cuts them."""
    lengths = rough_lengths(route.lat[None], route.lon[None])
    cut = np.ceil(lengths / OCEAN.world.terms[population_sailing.PIECE_SPACING])
    return int(np.maximum(cut, great_circle_sailing.MIN_PIECES).sum())


def timed(label: str, target: float, work, *, runs: int = 3) -> None:
    """Print the best and the median wall time of a work, and the processor time."""
    wall, cpu = [], []
    for run in range(runs + 1):
        begun, spent = time.perf_counter(), time.process_time()
        what = work(run)
        if run:  # the first one compiles or loads
            wall.append(time.perf_counter() - begun)
            cpu.append(time.process_time() - spent)
    print(
        f"{label}: best {min(wall):.2f} s, median {sorted(wall)[runs // 2]:.2f} s "
        f"({min(cpu):.2f} s of CPU time), target {target:g} s; {what}"
    )


def evaluations(run: int, route: Genome) -> str:
    """Evaluate fresh populations, all of their legs new."""
    evaluator = OCEAN
    rng = np.random.default_rng(run)
    rounds = math.ceil(EVALUATIONS / POPULATION)
    population = evaluator.population([route] * POPULATION)
    places = population.genes[:, 1:-1, : population_sailing.LON + 1].copy()
    away = 2.0 / (len(route) - 1)  # degrees, a tenth of a leg or so
    points = 0
    for _ in range(rounds):
        moved = places + rng.normal(0.0, away, places.shape)
        population.genes[:, 1:-1, : population_sailing.LON + 1] = moved
        population.genes[:, :, population_sailing.IS_LOOKED_UP] = (
            0.0  # every leg is looked up again
        )
        evaluator.score(population)
        points += POPULATION
    return (
        f"{points} routes of {len(route)} waypoints in {pieces_of(route)} pieces, every leg tested "
        "against GSHHG i"
    )


def nsga2(run: int) -> str:
    """Run NSGA-II of that size."""
    front = evolve(
        OCEAN,
        [crossing(40)],
        settings=EvolutionSettings(size=POPULATION, seed=run),
        stopping=StoppingCriteria(evaluations=EVALUATIONS, settled=None),
    )
    points = np.mean([len(genome) for genome in front.genomes])
    return f"{front.evaluations} evaluations, {len(front)} on the front, {points:.0f} waypoints"


def fronts() -> None:
    """Print the refereed hypervolume of every method on the jet and eddies."""
    evaluator, seeds = jet.evaluator(), [jet.straight(s) for s in (0, 5, 6, 11)]

    def evolved(method: str, size: int, evaluations: int) -> EvolutionResult:
        stopping = StoppingCriteria(evaluations=evaluations, settled=None)
        return evolve(evaluator, seeds, settings=EvolutionSettings(method, size), stopping=stopping)

    runs = {
        "nsga2, 84,000 evaluations": lambda: evolved("nsga2", 336, 84_000),
        "spea2, 42,000": lambda: evolved("spea2", 200, 42_000),
        "mpaes, 42,000": lambda: evolved("mpaes", 200, 42_000),
        "refined front": lambda: refine_front(evaluator, seeds),
    }
    for name, work in runs.items():
        spent, begun = time.process_time(), time.perf_counter()
        front = work()
        wall, cpu = time.perf_counter() - begun, time.process_time() - spent
        scores = np.array([jet.refereed(genome) for genome in front.genomes])
        good = scores[scores[:, 2] == 0.0]
        volume = hypervolume(good[:, :2], jet.REFERENCE)
        print(
            f"{name}: hypervolume {volume:.2f} by the referee, {len(front)} tracks "
            f"({len(scores) - len(good)} rejected), {wall:.1f} s ({cpu:.1f} s of CPU time)",
            flush=True,
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--skip-fronts", action="store_true")
    options = parser.parse_args()
    timed("evaluations", 1.5, lambda run: evaluations(run, crossing(200)))
    timed("evaluations of fewer waypoints", 1.5, lambda run: evaluations(run, crossing(40)))
    timed("NSGA-II", 4.0, nsga2)
    if not options.skip_fronts:
        fronts()


if __name__ == "__main__":
    OCEAN = ocean()
    main()
