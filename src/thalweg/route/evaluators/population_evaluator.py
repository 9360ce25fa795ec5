"""Quick evaluation of time and cost: a whole population of tracks at once, on all cores."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.objective import FUEL_MASS, LegPrices
from thalweg.core.time import format_time
from thalweg.core.types import FloatArray
from thalweg.kernels import codes
from thalweg.kernels.kernel_threads import run_in_threads
from thalweg.kernels.leg import population_sailing as columns
from thalweg.kernels.leg.population_sailing import FitnessArrays, TrackGenes, sail_population
from thalweg.kernels.leg.table_lookup import TableArrays
from thalweg.route.evaluators.calm_water_rates import calm_water_value, calm_water_values
from thalweg.route.evaluators.evaluator_inputs import EvaluationResolution, TabulatedShip
from thalweg.route.evaluators.population import Genome, Population
from thalweg.route.evaluators.time_evaluator import TimeEvaluator, make_time_evaluator, unique_legs

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.sea import GridFields


@dataclass(frozen=True)
class Evaluator:
    """Scores tracks by time, cost and violations; make one with `make_evaluator`.

    Attributes
    ----------
    world : FitnessArrays
        Sea, ship, limits and terms, as the kernel takes them; times are seconds after ``depart``.
    time_evaluator : TimeEvaluator
        Looks up land and charted depth.
    prices : LegPrices
    depart, latest : float
        [s since 1970-01-01T00:00Z]; ``latest`` may be +inf.
    canals : float64 array (C, 3)
        Time [s], fuel [kg] and dues of each canal of the chart.
    zone_resolution : float
        To which crossings of the borders of control areas are found [m].
    """

    world: FitnessArrays
    time_evaluator: TimeEvaluator
    prices: LegPrices
    depart: float
    latest: float
    canals: FloatArray
    zone_resolution: float

    @property
    def settings(self) -> int:
        """Number of speed settings."""
        return int(self.world.table.n_settings)

    @property
    def chart(self) -> Chart | None:
        """The chart whose land and zones tracks must avoid."""
        return self.time_evaluator.chart

    @property
    def varies(self) -> bool:
        """Whether zones or charted depth make legs differ, beside the sea."""
        chart: Any = self.chart
        if chart is None:
            return False
        zones = chart.zones
        priced = self.prices.differs_in_control_areas and len(getattr(zones, "eca", ()))
        return bool(chart.has_depth or zones.has_penalty or zones.price or priced)

    def __call__(
        self, genomes: Sequence[Genome] | Population
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return (time, cost, violation) of every track.

        Returns
        -------
        time : float64 array (N,)
            Passage time [s], with the additions of penalty zones.
        cost : float64 array (N,)
            In the unit of the prices, with the additions of penalty zones.
        violation : float64 array (N,)
            0: feasible. Else the share of the length that cannot be sailed (land, no-go zones,
            limits, no data) plus the lateness as a share of the available time.
        """
        population = genomes if isinstance(genomes, Population) else self.population(genomes)
        score = self.score(population)
        return score[:, 0].copy(), score[:, 1].copy(), score[:, 2].copy()

    def population(self, genomes: Sequence[Genome], *, capacity: int = 0) -> Population:
        """Return genomes as a population, checked against the ship's settings.

        Parameters
        ----------
        genomes : sequence of Genome
            One or more tracks.
        capacity : int, optional
            Least number of points for which each track has space.

        Returns
        -------
        Population
            Its legs are not looked up on the chart yet.

        Raises
        ------
        InputError
            If a track has a speed setting that the ship does not have, or no track is
            given.
        """
        population = Population.of(genomes, capacity=capacity)
        for number, genome in enumerate(genomes, start=1):
            if genome.setting.min() < 0 or genome.setting.max() >= self.settings:
                raise InputError(
                    f"Track {number} has a speed setting that the ship does not have.",
                    f"It has {self.settings} settings, 0 to {self.settings - 1}.",
                    "Use the settings of this ship.",
                )
        return population

    def score(self, population: Population) -> FloatArray:
        """Return the scores of tracks; legs that are new are looked up on the chart first.

        Parameters
        ----------
        population : Population
            N tracks; results of the look-up are stored in it.

        Returns
        -------
        float64 array (N, 3)
            Passage time [s], cost in the unit of ``prices``, and violation (0 for a
            feasible track).
        """
        return self.sail(population)[0]

    def sail(
        self,
        population: Population,
        *,
        depart: FloatArray | None = None,
        leave: FloatArray | None = None,
    ) -> tuple[FloatArray, FloatArray]:
        """Return the scores of tracks and the arrival at every point.

        Parameters
        ----------
        population : Population
            N tracks with space for M points.
        depart : float64 array (N,), optional
            Departure of each track [s after ``self.depart``]; by default 0.
        leave : float64 array (N, M), optional
            The ship leaves a point no earlier than this [s after ``self.depart``]; by default it
            waits as the points say only.

        Returns
        -------
        score : float64 array (N, 3)
            As `score` returns it.
        arrive : float64 array (N, M)
            Arrival at every point [s after ``self.depart``]; NaN beyond the last point.
        """
        self.look_up_legs(population)
        n, capacity = len(population), population.capacity
        start = np.zeros(n) if depart is None else np.ascontiguousarray(depart, float)
        earliest = np.full((n, capacity), -math.inf)
        if leave is not None:
            earliest[:] = leave
        score, arrive = np.empty((n, columns.SCORE_COUNT)), np.full((n, capacity), math.nan)
        scratch = np.empty((n, columns.SCRATCH_SIZE))
        tracks = TrackGenes(np.ascontiguousarray(population.count), population.genes)

        def part(piece: slice) -> None:
            sail_population(
                TrackGenes(tracks.count[piece], tracks.genes[piece]),
                earliest[piece],
                start[piece],
                self.world,
                score[piece],
                arrive[piece],
                scratch[piece],
            )

        run_in_threads(part, n)
        return score, arrive

    def look_up_legs(self, population: Population, *, obstacles: bool = True) -> None:
        """Look up land, depth, zones and canals of the legs that are not known yet, in place.

        Parameters
        ----------
        population : Population
            Tracks; the properties of their legs are written into ``genes``.
        obstacles : bool
            Whether land, no-go zones and charted depth count.
        """
        legs = np.arange(population.capacity) < (population.count - 1)[:, None]
        row, place = np.nonzero(legs & (population.genes[:, :, columns.IS_LOOKED_UP] == 0.0))
        if not len(row):
            return
        genes = population.genes
        ends = [genes[row, place + k, c] for k in (0, 1) for c in (columns.LAT, columns.LON)]
        first, back = unique_legs(ends)
        facts = self._leg_properties(*(end[first] for end in ends), obstacles=obstacles)
        blocked, charted, weight, penalty = (fact[back] for fact in facts)
        genes[row, place, columns.IS_BLOCKED] = blocked
        genes[row, place, columns.CHARTED_DEPTH] = charted
        genes[row, place, columns.FUEL_PRICE] = weight
        genes[row, place, columns.PENALTY_FACTOR] = penalty
        genes[row, place, columns.FIXED_TIME] = math.nan
        self._set_canals(genes, row, place, ends)
        genes[row, place, columns.IS_LOOKED_UP] = 1.0

    def _leg_properties(
        self,
        lat1: FloatArray,
        lon1: FloatArray,
        lat2: FloatArray,
        lon2: FloatArray,
        *,
        obstacles: bool,
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Return (blocked, charted depth, price of fuel, penalty factor) of legs."""
        n, prices = len(lat1), self.prices
        chart: Any = self.chart
        blocked, charted = np.zeros(n), np.full(n, math.inf)
        inside, zone_factor, penalty = np.zeros(n), np.ones(n), np.ones(n)
        if chart is None:
            return blocked, charted, prices.of_legs(inside, zone_factor), penalty
        ends = (lat1, lon1, lat2, lon2)
        required = self.world.limits[codes.LIMIT_REQUIRED_DEPTH]
        if obstacles and chart.has_depth and math.isfinite(required):
            lines = np.stack([lat1, lat2], axis=1), np.stack([lon1, lon2], axis=1)
            closed_legs, depth = self.time_evaluator.look_up_legs(*lines)
            if closed_legs is not None and depth is not None:
                blocked, charted = closed_legs[:, 0].astype(float), depth[:, 0]
        elif obstacles:
            blocked = _on_all_cores(chart.legs_blocked, ends)
        zones: Any = chart.zones
        if prices.differs_in_control_areas and len(getattr(zones, "eca", ())):
            fraction = partial(zones.eca_fraction, finest=self.zone_resolution)
            inside = _on_all_cores(fraction, ends)
        if chart.zones.has_penalty or chart.zones.price:
            penalty, zone_factor = (np.asarray(factor) for factor in chart.zones.factors(*ends))
        return blocked, charted, prices.of_legs(inside, zone_factor), penalty

    def _set_canals(
        self, genes: FloatArray, row: np.ndarray, place: np.ndarray, ends: list[FloatArray]
    ) -> None:
        """Set time and cost of the legs that are canals."""
        if not len(self.canals):
            return
        chart: Any = self.chart
        index = np.asarray(chart.canal_of_legs(*ends))
        on = np.flatnonzero(index >= 0)
        time, burnt, dues = self.canals[index[on]].T
        legs = row[on], place[on]
        genes[*legs, columns.IS_BLOCKED], genes[*legs, columns.FIXED_TIME] = 0.0, time
        price = genes[*legs, columns.FUEL_PRICE]
        genes[*legs, columns.FIXED_COST] = burnt * price + dues * self.prices.dues

    def finer(self, times: float) -> Evaluator:
        """Return an evaluator that divides legs more finely.

        Parameters
        ----------
        times : float
            Factor by which pieces are shorter, above 0.

        Returns
        -------
        Evaluator
            Otherwise unchanged.
        """
        terms = self.world.terms.copy()
        terms[columns.PIECE_SPACING] /= times
        return replace(self, world=self.world._replace(terms=terms))


def _on_all_cores(function: Callable[..., FloatArray], ends: tuple[FloatArray, ...]) -> FloatArray:
    """Return what a function gives for legs, one by one; its kernels run on all cores."""
    found = np.empty(len(ends[0]))

    def part(legs: slice) -> None:
        found[legs] = function(*(end[legs] for end in ends))

    run_in_threads(part, len(found))
    return found


_DEFAULT_RESOLUTION = EvaluationResolution()


def make_evaluator(
    ship: TabulatedShip,
    fields: GridFields,
    *,
    depart: float,
    chart: Chart | None = None,
    latest: float = math.inf,
    prices: LegPrices = FUEL_MASS,
    canals: FloatArray | None = None,
    resolution: EvaluationResolution = _DEFAULT_RESOLUTION,
) -> Evaluator:
    """Return an evaluator of time and cost.

    Parameters
    ----------
    ship : TabulatedShip
        Tables of the ship and its limits.
    fields : GridFields
        The sea frozen around the tracks.
    depart : float [s since 1970-01-01T00:00Z]
    chart : Chart, optional
        Land, zones, emission control areas, canals and charted depth.
    latest : float
        Latest arrival [s since 1970-01-01T00:00Z].
    prices : LegPrices, optional
        Prices of fuel, time, waiting and canal dues; by default 1 per kilogram of fuel.
    canals : float64 array (C, 3), optional
        Time [s], fuel [kg] and dues of each canal of the chart; by default with the fuel rate of
        the slowest setting that reaches the mean speed of the canal in calm water. Empty: the
        tracks pass no canal.
    resolution : EvaluationResolution
        How finely tracks are divided.

    Returns
    -------
    Evaluator
        Of the ship in this sea, for tracks that depart at ``depart`` or later.

    Raises
    ------
    InputError
        If the latest arrival does not follow the departure, or the tables differ in their
        settings.
    """
    _check_latest_arrival(depart, latest)
    time_evaluator = make_time_evaluator(
        table=ship.table,
        chart=chart,
        fields=fields,
        limits=ship.limits,
        origin=depart,
        by_length=False,
        total=resolution.total,
    )
    fuel, spacing = ship.fuel, resolution.spacing
    rates = fuel if isinstance(fuel, TableArrays) else fuel.kernel_arrays()
    if rates.n_settings != time_evaluator.table.n_settings:
        raise InputError(
            f"The table of fuel has {rates.n_settings} settings, that of speed "
            f"{time_evaluator.table.n_settings}.",
            "Both must be of one ship.",
            "Tabulate both for the same speeds.",
        )
    terms = np.empty(columns.TERM_COUNT)
    terms[columns.TIME_PRICE] = prices.time
    terms[columns.WAITING_PRICE] = prices.waiting
    terms[columns.LATEST_ARRIVAL] = latest - depart
    terms[columns.PIECE_SPACING] = time_evaluator.spacing if spacing is None else spacing
    world = FitnessArrays(
        time_evaluator.raster, time_evaluator.table, rates, time_evaluator.limits, terms
    )
    passed = _canal_table(chart, world) if canals is None else canals
    finest = resolution.zone_resolution
    return Evaluator(world, time_evaluator, prices, depart, latest, passed, finest)


def _canal_table(chart: Any, world: FitnessArrays) -> FloatArray:
    """Return time [s], fuel [kg] and dues (C, 3) of the canals of a chart, by calm-water rates."""
    canals = getattr(chart, "canals", ())
    speeds = calm_water_values(world.table)
    out = np.empty((len(canals), 3))
    for k, canal in enumerate(canals):
        enough = np.flatnonzero(speeds >= canal.length / canal.transit_time)
        setting = int(enough[0]) if len(enough) else len(speeds) - 1
        burnt = calm_water_value(world.fuel, setting) * canal.transit_time
        out[k] = canal.transit_time, burnt, canal.fee
    return out


def _check_latest_arrival(depart: float, latest: float) -> None:
    if not latest > depart:
        raise InputError(
            f"The latest arrival {format_time(latest)} is not after the departure.",
            f"The departure is {format_time(depart)}.",
            "Give a later arrival.",
        )
