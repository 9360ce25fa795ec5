"""Variation of tracks: settings of crossover and mutation, and the offspring of a population."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cache

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray, IntArray
from thalweg.kernels.evolution import mutation, random_numbers
from thalweg.kernels.evolution.crossover import VariationWorkspace, make_offspring
from thalweg.kernels.geometry.coast_index import CoastArrays
from thalweg.kernels.kernel_threads import run_in_threads
from thalweg.kernels.leg.population_sailing import GENE_COLUMNS, TrackGenes
from thalweg.route.evaluators.population import Population
from thalweg.route.evaluators.population_evaluator import Evaluator

INSERTION_SHAPES = {
    "rhombus": random_numbers.RHOMBUS,
    "ellipse": random_numbers.ELLIPSE,
    "gaussian": random_numbers.GAUSSIAN,
}


@dataclass(frozen=True)
class OperatorWeights:
    """Weights of the operators that change a track.

    Attributes
    ----------
    insert, translate, delete, speed, split, merge : float
        Relative probability of each. ``insert`` adds a point beside a leg drawn by length;
        ``translate`` moves a point drawn by how much the track turns there; ``delete`` removes a
        point; ``speed`` gives several consecutive legs a new setting; ``split`` divides a leg into
        two with different settings; ``merge`` removes a point where the track turns little.
    pause : float
        Of changing one of the waits; only for tracks with waits.
    """

    insert: float = 1.0
    translate: float = 1.0
    delete: float = 0.5
    speed: float = 1.0
    split: float = 0.5
    merge: float = 0.5
    pause: float = 0.0


#: For the initial population (Seuren 2020): tracks from networks have too many points.
INITIAL_OPERATOR_WEIGHTS = OperatorWeights(
    insert=1.0, translate=1.0, delete=3.0, speed=1.0, split=0.0, merge=0.0
)


@dataclass(frozen=True)
class VariationSettings:
    """Parameters of crossover and mutation.

    Attributes
    ----------
    mix : OperatorWeights
    changes : float
        The number k of changed places of a mutation has P(k) ~ exp(-k / scale), with the scale
        ``changes`` divided by the number of legs.
    shape : {"ellipse", "rhombus", "gaussian"}
        Region of inserted points, as long as the leg.
    insert_width : float
        Its width over its length.
    radius : (float, float)
        Smallest and largest radius of translations, as a share of the mean length of the two
        adjacent legs; drawn between them evenly in the logarithm.
    crossover, mutation : float
        Probabilities of a crossover and of a mutation after it; a child without crossover is
        always mutated.
    """

    mix: OperatorWeights = OperatorWeights()
    changes: float = 10.0
    shape: str = "ellipse"
    insert_width: float = 0.1
    radius: tuple[float, float] = (0.002, 0.5)
    crossover: float = 0.3
    mutation: float = 0.5

    def __post_init__(self) -> None:
        if self.shape not in INSERTION_SHAPES:
            raise InputError(
                f"Points cannot be inserted in a {self.shape!r}.",
                f"Shapes: {', '.join(INSERTION_SHAPES)}.",
                "Choose one.",
                field="shape",
            )
        weights = [getattr(self.mix, field.name) for field in fields(OperatorWeights)]
        low, high = self.radius
        chances = all(0.0 <= chance <= 1.0 for chance in (self.crossover, self.mutation))
        right = min(weights) >= 0.0 and sum(weights) > 0.0 and 0.0 < low <= high and chances
        if not (right and self.changes > 0.0 and self.insert_width >= 0.0):
            raise InputError(
                f"These variation settings are not valid: {self}.",
                "Weights are zero or more and not all zero, radii ascend and are above zero, "
                "probabilities are between 0 and 1.",
                "Correct them.",
            )

    def array(self) -> FloatArray:
        """Return the settings as the kernel takes them.

        Returns
        -------
        float64 array
            In the order of the constants in `thalweg.kernels.evolution.mutation`.
        """
        out = np.empty(mutation.VARIATION_SETTING_COUNT)
        weights = [getattr(self.mix, field.name) for field in fields(OperatorWeights)]
        out[: mutation.OPERATOR_COUNT] = weights
        out[mutation.CHANGE_SCALE] = self.changes
        out[mutation.OFFSET_SHAPE] = INSERTION_SHAPES[self.shape]
        out[mutation.INSERT_WIDTH] = self.insert_width
        out[mutation.RADIUS_MIN], out[mutation.RADIUS_MAX] = self.radius
        out[mutation.CROSSOVER_PROBABILITY] = self.crossover
        out[mutation.MUTATION_PROBABILITY] = self.mutation
        return out


def reproduce(
    population: Population,
    pairs: IntArray,
    *,
    evaluator: Evaluator,
    variation_settings: VariationSettings,
    rng: np.random.Generator,
) -> Population:
    """Return two children of each pair of parents, without scores.

    Parameters
    ----------
    pairs : Indices of the parents, (K, 2).
    evaluator : For its chart and number of settings.
    rng : Gives each pair its own seed, so that results do not depend on threads.
    """
    n, capacity = len(pairs), population.capacity
    states: NDArray[np.uint64] = rng.integers(0, 2**64, size=(n, 1), dtype=np.uint64)
    child_counts = np.empty((n, 2), dtype=np.int64)
    offspring = np.zeros((n, 2, capacity, GENE_COLUMNS))
    work, weights = np.empty((n, capacity, GENE_COLUMNS)), np.empty((n, 2 * capacity))
    given = (evaluator.settings, variation_settings.array())
    parents = TrackGenes(
        np.ascontiguousarray(population.count), np.ascontiguousarray(population.genes)
    )
    coast = evaluator.chart.arrays if evaluator.chart is not None else coast_without_land()
    chosen = np.ascontiguousarray(pairs, dtype=np.int64)

    def part(piece: slice) -> None:
        make_offspring(
            parents,
            chosen[piece],
            coast,
            *given,
            states[piece],
            TrackGenes(child_counts[piece], offspring[piece]),
            VariationWorkspace(work[piece], weights[piece]),
        )

    run_in_threads(part, n)
    return Population(child_counts.reshape(-1), offspring.reshape(2 * n, capacity, GENE_COLUMNS))


@cache
def coast_without_land() -> CoastArrays:
    """Return the coast of a world without land."""
    from thalweg.chart import Chart

    return Chart.open_water().arrays
