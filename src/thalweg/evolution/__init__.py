"""Evolution of tracks: populations scored by the shared kernel, their operators and fronts."""

from thalweg.deprecated_names import renamed
from thalweg.evolution.evolve import EvolutionProgress, EvolutionResult, evolve
from thalweg.evolution.memetic import refine_front
from thalweg.evolution.variation import OperatorWeights, VariationSettings
from thalweg.route.refinement.population import Genome, Population
from thalweg.route.refinement.population_evaluator import Evaluator, make_evaluator

__all__ = [
    "Evaluator",
    "EvolutionProgress",
    "EvolutionResult",
    "Genome",
    "OperatorWeights",
    "Population",
    "VariationSettings",
    "evolve",
    "make_evaluator",
    "refine_front",
]

__getattr__ = renamed("thalweg.evolution")
