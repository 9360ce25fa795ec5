from thalweg.evolution.evolve import (
    EvolutionProgress,
    EvolutionResult,
    EvolutionSettings,
    StoppingCriteria,
    evolve,
)
from thalweg.evolution.memetic import FrontRefinementSettings, refine_front
from thalweg.evolution.variation import OperatorWeights, VariationSettings
from thalweg.route.evaluators.evaluator_inputs import EvaluationResolution, TabulatedShip
from thalweg.route.evaluators.population import Genome, Population
from thalweg.route.evaluators.population_evaluator import Evaluator, make_evaluator

__all__ = [
    "EvaluationResolution",
    "Evaluator",
    "EvolutionProgress",
    "EvolutionResult",
    "EvolutionSettings",
    "FrontRefinementSettings",
    "Genome",
    "OperatorWeights",
    "Population",
    "StoppingCriteria",
    "TabulatedShip",
    "VariationSettings",
    "evolve",
    "make_evaluator",
    "refine_front",
]
