"""Evolution of tracks: populations scored by the shared kernel, their operators and fronts."""

from thalweg.evolution.evolve import Evolution, Progress, evolve
from thalweg.evolution.memetic import refine_front
from thalweg.evolution.variation import Habits, Mix
from thalweg.route.refinement.population import Genome, Population
from thalweg.route.refinement.population_evaluator import Evaluator, Prices, make_evaluator

__all__ = [
    "Evaluator",
    "Evolution",
    "Genome",
    "Habits",
    "Mix",
    "Population",
    "Prices",
    "Progress",
    "evolve",
    "make_evaluator",
    "refine_front",
]
