"""Evolution of tracks: populations scored by the shared kernel, their operators and fronts."""

from thalweg.evolution.evaluator import Evaluator, Prices, make_evaluator
from thalweg.evolution.evolve import Evolution, Progress, evolve
from thalweg.evolution.genome import Genome, Population
from thalweg.evolution.operators import Habits, Mix
from thalweg.evolution.refine import refine_front

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
