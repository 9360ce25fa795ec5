"""A sailor that prices fuel: cost and time of many tracks at once, for polishing to compare."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.errors import InputError
from thalweg.core.objective import LegPrices
from thalweg.core.types import FloatArray, IntArray
from thalweg.kernels.leg import population_sailing as columns
from thalweg.kernels.leg.population_sailing import FitnessArrays, sail_population
from thalweg.kernels.leg.table_lookup import TableArrays
from thalweg.route.canal_legs import canal_legs, canal_rates, canal_setting
from thalweg.route.refinement.time_evaluator import TimeEvaluator, TrackBatch, make_time_evaluator

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.chart.canals import Canal
    from thalweg.route.track import Track
    from thalweg.sea import GridFields
    from thalweg.ship import PerformanceTable, Ship


@dataclass(frozen=True)
class CostEvaluator:
    """Sails polylines as `TimeEvaluator` does, and tells what they cost.

    Attributes
    ----------
    time_evaluator : Sailor
        Looks up land and charted depth.
    world : FitnessWorld
        Sea, ship, limits and terms as the kernel takes them; times from ``sailor.origin``.
    prices : LegPrices
    per_second : float
        What a second of the passage is worth besides; costs that are compared have it in them.
    canals : float64 array (C, 3)
        Time [s], fuel [kg] and dues of each canal of the chart; empty if the track has none.
    """

    time_evaluator: TimeEvaluator
    world: FitnessArrays
    prices: LegPrices
    per_second: float
    canals: FloatArray

    by_length = True  # costs are counted from the start of a track, not from the origin
    chooses_settings = True

    @property
    def chart(self) -> Chart | None:
        """The chart that tracks keep clear of."""
        return self.time_evaluator.chart

    @property
    def origin(self) -> float:
        """Where its times count from [s since 1970-01-01T00:00Z]."""
        return self.time_evaluator.origin

    @property
    def limits(self) -> FloatArray:
        """Required depth, wave height and wind speed."""
        return self.time_evaluator.limits

    @property
    def waiting_parameters(self) -> FloatArray:
        """How it waits of itself: it does not."""
        return np.zeros(3)

    @property
    def settings(self) -> int:
        """Number of speed settings."""
        return int(self.world.table.n_settings)

    def value_of_time(self, per_second: float) -> CostEvaluator:
        """Return the purse with another worth of a second."""
        return replace(self, per_second=per_second)

    def pieces(self, lat: FloatArray, lon: FloatArray) -> IntArray:
        """Return how many pieces each leg of polylines (..., n) is cut into."""
        return self.time_evaluator.pieces(lat, lon)

    def look_up_legs(
        self, lat: FloatArray, lon: FloatArray
    ) -> tuple[NDArray[np.bool_] | None, FloatArray | None]:
        """Return (blocked, least charted depth) of the legs of polylines; None: not known."""
        return self.time_evaluator.look_up_legs(lat, lon)

    def fixed_points(self, lat: FloatArray, lon: FloatArray) -> NDArray[np.bool_]:
        """Return which points of one polyline may not move: its ends and those of canals."""
        canal = self.canal_legs(lat, lon)
        fixed = self.time_evaluator.fixed_points(lat, lon)
        return fixed | np.append(canal, False) | np.append(False, canal)

    def canal_legs(self, lat: FloatArray, lon: FloatArray) -> NDArray[np.bool_]:
        """Return which legs of one polyline run through canals."""
        if not len(self.canals):
            return np.zeros(len(lat) - 1, dtype=bool)
        chart: Any = self.chart
        return np.asarray(chart.canal_of_legs(lat[:-1], lon[:-1], lat[1:], lon[1:]) >= 0)

    def sail(
        self, batch: TrackBatch, *, pieces: IntArray | None = None, check: bool = True
    ) -> tuple[FloatArray, FloatArray]:
        """Sail polylines: (arrival at every point [s after the origin], cost), as
        `TimeEvaluator.sail`.

        The cost has the worth of time in it and is +inf where a track cannot be sailed.
        """
        arrive, cost, time = self.cost_and_time(batch, pieces=pieces, check=check)
        return arrive, cost + self.per_second * time

    def sail_and_wait(
        self, batch: TrackBatch, *, pieces: IntArray | None = None, check: bool = True
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Do as `sail` does, and return (arrive, leave, cost): when each point is left, too."""
        arrive, cost = self.sail(batch, pieces=pieces, check=check)
        return arrive, np.maximum(arrive, batch.leave), cost

    def cost_and_time(
        self, batch: TrackBatch, *, pieces: IntArray | None = None, check: bool = True
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return (arrival at every point, cost without the worth of time, passage time)."""
        count, size = batch.lat.shape
        genes = self._genes(batch, pieces, check)
        waits = np.isfinite(batch.leave[:, :-1])
        if not waits.any():
            score, arrive = self._run(genes, batch.depart)
        else:  # moments of leaving become waits leg by leg
            arrive = np.empty((count, size))
            arrive[:, 0] = batch.depart
            score = np.zeros((count, columns.SCORE_COUNT))
            for k in range(size - 1):
                pair = genes[:, k : k + 2].copy()
                late = batch.leave[:, k] - arrive[:, k]
                pair[:, 0, columns.WAITING_TIME] = np.where(late > 0.0, late, 0.0)
                part, there = self._run(pair, arrive[:, k])
                score, arrive[:, k + 1] = score + part, there[:, 1]
        bad = score[:, columns.VIOLATION] > 0.0
        cost = np.where(bad, math.inf, score[:, columns.COST])
        arrive[bad, -1] = math.inf
        return arrive, cost, score[:, columns.TIME]

    def infeasible_legs(self, batch: TrackBatch) -> NDArray[np.bool_]:
        """Return which legs of polylines (L, n - 1) cannot be sailed, each by itself."""
        arrive, _, _ = self.cost_and_time(batch, check=False)
        size = batch.lat.shape[1]
        broken = np.zeros((len(batch.lat), size - 1), dtype=bool)
        genes = self._genes(batch, None, True)
        for k in range(size - 1):
            depart = np.where(np.isfinite(arrive[:, k]), arrive[:, k], batch.depart)
            score, _ = self._run(genes[:, k : k + 2], depart)
            broken[:, k] = score[:, columns.VIOLATION] > 0.0
        return broken

    def _run(self, genes: FloatArray, depart: FloatArray) -> tuple[FloatArray, FloatArray]:
        count, size = genes.shape[:2]
        score, arrive = np.empty((count, columns.SCORE_COUNT)), np.empty((count, size))
        sail_population(
            np.full(count, size, dtype=np.int64),
            np.ascontiguousarray(genes),
            np.array(depart, dtype=float),
            self.world,
            score,
            arrive,
            np.empty((count, columns.SCRATCH_SIZE)),
        )
        return score, arrive

    def _genes(self, batch: TrackBatch, pieces: IntArray | None, check: bool) -> FloatArray:
        """Return polylines as the kernel takes them, every leg looked up."""
        count, size = batch.lat.shape
        genes = np.zeros((count, size, columns.GENE_COLUMNS))
        genes[:, :, columns.LAT], genes[:, :, columns.LON] = batch.lat, batch.lon
        legs = genes[:, :-1]
        legs[:, :, columns.SETTING] = batch.setting
        if pieces is not None:
            legs[:, :, columns.PIECES] = np.broadcast_to(pieces, (count, size - 1))
        legs[:, :, columns.CHARTED_DEPTH] = math.inf
        if check:
            blocked, charted = self.look_up_legs(batch.lat, batch.lon)
            legs[:, :, columns.IS_BLOCKED] = 0.0 if blocked is None else blocked
            legs[:, :, columns.CHARTED_DEPTH] = math.inf if charted is None else charted
        lat, lon = batch.lat, batch.lon
        self._price(legs, (lat[:, :-1], lon[:, :-1], lat[:, 1:], lon[:, 1:]))
        return genes

    def _price(self, legs: FloatArray, ends: tuple[FloatArray, ...]) -> None:
        """Write prices, penalties and canals of legs in place."""
        chart: Any = self.chart
        prices = self.prices
        legs[:, :, columns.FUEL_PRICE], legs[:, :, columns.PENALTY_FACTOR] = prices.outside, 1.0
        legs[:, :, columns.FIXED_TIME] = math.nan
        if chart is None:
            return
        inside, zone_factor = np.zeros(ends[0].shape), np.ones(ends[0].shape)
        if chart.zones.eca and prices.differs_in_control_areas:
            inside = chart.eca_fraction(*ends)
        if chart.zones.penalty or (chart.zones.price and prices.dues > 0.0):
            penalty, zone_factor = chart.zone_factor(*ends)
            legs[:, :, columns.PENALTY_FACTOR] = penalty
        legs[:, :, columns.FUEL_PRICE] = prices.of_legs(inside, zone_factor)
        if len(self.canals):
            number = chart.canal_of_legs(*ends)
            on = number >= 0
            time, burnt, dues = self.canals[number[on]].T
            legs[on, columns.FIXED_TIME] = time
            legs[on, columns.FIXED_COST] = burnt * legs[on, columns.FUEL_PRICE] + dues


def make_cost_evaluator(
    *,
    ship: Ship,
    table: PerformanceTable | TableArrays,
    fuel: PerformanceTable | TableArrays,
    fields: GridFields,
    limits: ArrayLike,
    chart: Chart | None,
    track: Track,
    prices: LegPrices,
) -> CostEvaluator:
    """Put a purse together for polishing a track; times count from its departure.

    Raises
    ------
    InputError
        If the tables differ in their settings.
    """
    time_evaluator = make_time_evaluator(
        table=table,
        chart=chart,
        fields=fields,
        limits=limits,
        origin=track.depart,
        by_length=False,
        total=float(track.lengths.sum()),
    )
    rates = fuel if isinstance(fuel, TableArrays) else fuel.kernel_arrays()
    if rates.n_settings != time_evaluator.table.n_settings:
        raise InputError(
            f"The table of fuel has {rates.n_settings} settings, that of speed "
            f"{time_evaluator.table.n_settings}.",
            "Both are of one ship.",
            "Tabulate both for the same speeds.",
        )
    terms = np.zeros(columns.TERM_COUNT)
    terms[columns.TIME_PRICE] = prices.time
    terms[columns.WAITING_PRICE] = prices.waiting
    terms[columns.LATEST_ARRIVAL], terms[columns.PIECE_SPACING] = math.inf, time_evaluator.spacing
    index = time_evaluator.raster.channel_index
    channels = np.zeros(time_evaluator.raster.values.shape[3], dtype=np.int64)
    channels[index[index >= 0]] = np.flatnonzero(index >= 0)
    world = FitnessArrays(
        time_evaluator.raster, channels, time_evaluator.table, rates, time_evaluator.limits, terms
    )
    passed = canal_legs(track, chart)  # none: canals need not be looked for again and again

    def rate(canal: Canal) -> float:
        if prices.consumption == "cubed_speed":
            return float(ship.speeds[canal_setting(ship, canal)]) ** 3
        return canal_rates(ship, canal)[1]

    canals = [
        (c.transit_time, rate(c) * c.transit_time, c.fee * prices.dues)
        for c in (passed.canals if passed.any else ())
    ]
    return CostEvaluator(time_evaluator, world, prices, 0.0, np.array(canals, float).reshape(-1, 3))
