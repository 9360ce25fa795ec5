"""Evolution of tracks: populations scored by the shared kernel, their operators and fronts."""

from thalweg.evolution.evaluator import Evaluator, Prices, make_evaluator
from thalweg.evolution.genome import Genome, Population

__all__ = ["Evaluator", "Genome", "Population", "Prices", "make_evaluator"]
