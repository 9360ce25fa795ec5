"""Quick evaluation of cost and time of polylines: the population evaluator for single tracks."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from thalweg.core.limits import Limits
from thalweg.core.objective import LegPrices
from thalweg.core.types import FloatArray, IntArray
from thalweg.kernels.leg import population_sailing as columns
from thalweg.kernels.leg.table_lookup import TableArrays
from thalweg.route.canal_legs import canal_legs, canal_rates, canal_setting
from thalweg.route.evaluators.evaluator_inputs import EvaluationResolution, TabulatedShip
from thalweg.route.evaluators.population import Population
from thalweg.route.evaluators.population_evaluator import Evaluator, make_evaluator
from thalweg.route.evaluators.time_evaluator import TrackBatch

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.chart.canals import Canal
    from thalweg.route.track import Track
    from thalweg.sea import GridFields
    from thalweg.ship import PerformanceTable, Ship

_ZONE_RESOLUTION = 0.25  # to which crossings of the borders of control areas are found [m]


@dataclass(frozen=True)
class CostEvaluator:
    """Sails polylines as `TimeEvaluator` does, and returns their cost.

    Attributes
    ----------
    evaluator : Its departure is the origin of times.
    per_second : Additional price of a second of the voyage; compared costs include it.
    holds_settings : Whether legs keep the speed settings that they have.
    """

    evaluator: Evaluator
    per_second: float
    holds_settings: bool = False

    by_length = True  # costs are counted from the start of a track, not from the origin
    chooses_settings = True

    @property
    def chart(self) -> Chart | None:
        """The chart whose land and zones tracks must avoid."""
        return self.evaluator.chart

    @property
    def origin(self) -> float:
        """Where its times count from [s since 1970-01-01T00:00Z]."""
        return self.evaluator.depart

    @property
    def limits(self) -> FloatArray:
        """Required depth, wave height and wind speed."""
        return self.evaluator.world.limits

    @property
    def prices(self) -> LegPrices:
        """Prices of fuel and time."""
        return self.evaluator.prices

    @property
    def settings(self) -> int:
        """Number of speed settings."""
        return self.evaluator.settings

    def with_value_of_time(self, per_second: float) -> CostEvaluator:
        """Return the evaluator with another additional price of a second."""
        return replace(self, per_second=per_second)

    def pieces(self, lat: FloatArray, lon: FloatArray) -> IntArray:
        """Return the number of pieces of each leg of polylines (..., n)."""
        return self.evaluator.time_evaluator.pieces(lat, lon)

    def fixed_points(self, lat: FloatArray, lon: FloatArray) -> NDArray[np.bool_]:
        """Return which points of one polyline may not move: its ends and those of canals."""
        canal = self.canal_legs(lat, lon)
        fixed = self.evaluator.time_evaluator.fixed_points(lat, lon)
        return fixed | np.append(canal, False) | np.append(False, canal)

    def canal_legs(self, lat: FloatArray, lon: FloatArray) -> NDArray[np.bool_]:
        """Return which legs of one polyline run through canals."""
        if not len(self.evaluator.canals):
            return np.zeros(len(lat) - 1, dtype=bool)
        chart: Any = self.chart
        return np.asarray(chart.canal_of_legs(lat[:-1], lon[:-1], lat[1:], lon[1:]) >= 0)

    def sail(
        self, batch: TrackBatch, *, pieces: IntArray | None = None, check: bool = True
    ) -> tuple[FloatArray, FloatArray]:
        """Sail polylines: (arrival at every point [s after the origin], cost), as
        `TimeEvaluator.sail`.

        The cost includes the value of time and is +inf where a track cannot be sailed.
        """
        arrive, cost, time = self.cost_and_time(batch, pieces=pieces, check=check)
        return arrive, cost + self.per_second * time

    def sail_and_wait(
        self, batch: TrackBatch, *, pieces: IntArray | None = None, check: bool = True
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Sail as `sail` does; return (arrive, leave, cost), with the departure from each point."""
        arrive, cost = self.sail(batch, pieces=pieces, check=check)
        return arrive, np.maximum(arrive, batch.leave), cost

    def cost_and_time(
        self, batch: TrackBatch, *, pieces: IntArray | None = None, check: bool = True
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return (arrival at every point, cost without the value of time, passage time)."""
        genes = self._genes(batch, pieces, check)
        score, arrive = self._run(genes, batch.depart, batch.leave)
        bad = score[:, columns.VIOLATION] > 0.0
        cost = np.where(bad, math.inf, score[:, columns.COST])
        arrive[bad, -1] = math.inf
        return arrive, cost, score[:, columns.TIME]

    def infeasible_legs(self, batch: TrackBatch, arrive: FloatArray) -> NDArray[np.bool_]:
        """Return which legs (L, n - 1) of sailed polylines are infeasible, each by itself.

        ``arrive`` is the arrival at every point as `sail` returns it.
        """
        size = batch.lat.shape[1]
        broken = np.zeros((len(batch.lat), size - 1), dtype=bool)
        genes = self._genes(batch, None, True)
        for k in range(size - 1):
            depart = np.where(np.isfinite(arrive[:, k]), arrive[:, k], batch.depart)
            score, _ = self._run(genes[:, k : k + 2], depart, None)
            broken[:, k] = score[:, columns.VIOLATION] > 0.0
        return broken

    def _run(
        self, genes: FloatArray, depart: FloatArray, leave: FloatArray | None
    ) -> tuple[FloatArray, FloatArray]:
        count, size = genes.shape[:2]
        population = Population(np.full(count, size, np.int64), np.ascontiguousarray(genes))
        return self.evaluator.sail(population, depart=depart, leave=leave)

    def _genes(self, batch: TrackBatch, pieces: IntArray | None, check: bool) -> FloatArray:
        """Return polylines as points of a population, every leg looked up."""
        count, size = batch.lat.shape
        genes = np.zeros((count, size, columns.GENE_COLUMNS))
        genes[:, :, columns.LAT], genes[:, :, columns.LON] = batch.lat, batch.lon
        genes[:, :-1, columns.SETTING] = batch.setting
        if pieces is not None:
            genes[:, :-1, columns.PIECES] = np.broadcast_to(pieces, (count, size - 1))
        population = Population(np.full(count, size, np.int64), genes)
        self.evaluator.look_up_legs(population, obstacles=check)
        return genes


def make_cost_evaluator(
    *,
    ship: Ship,
    table: PerformanceTable | TableArrays,
    fuel: PerformanceTable | TableArrays,
    fields: GridFields,
    limits: Limits,
    chart: Chart | None,
    track: Track,
    prices: LegPrices,
) -> CostEvaluator:
    """Return a cost evaluator for a track; times count from its departure.

    Parameters
    ----------
    ship : For the fuel rate in canals.
    table, fuel : PerformanceTable or TableArrays
        Speed through water [m/s], and the rate of consumption that is priced, such as fuel [kg/s].
    fields : The sea frozen around the track.
    limits : Limits along the route (`thalweg.core.limits.Limits`).
    chart : Land, zones, canals and charted depth.

    Raises
    ------
    InputError : If the tables differ in their settings.
    """
    passed = canal_legs(track, chart)  # if there are none, canals are not looked up again

    def rate(canal: Canal) -> float:
        if prices.consumption == "cubed_speed":
            return float(ship.speeds[canal_setting(ship, canal)]) ** 3
        return canal_rates(ship, canal)[1]

    canals = [
        (c.transit_time, rate(c) * c.transit_time, c.fee)
        for c in (passed.canals if passed.any else ())
    ]
    evaluator = make_evaluator(
        TabulatedShip(table, fuel, limits),
        fields,
        depart=track.depart,
        chart=chart,
        prices=prices,
        canals=np.array(canals, float).reshape(-1, 3),
        resolution=EvaluationResolution(
            total=float(track.lengths.sum()), zone_resolution=_ZONE_RESOLUTION
        ),
    )
    return CostEvaluator(evaluator, 0.0)
