"""The Pareto front on a network: points that are real paths, and a lower front below them."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import InputError
from thalweg.core.pareto_fronts import evenly_spaced_subset
from thalweg.core.types import FloatArray


@dataclass(frozen=True, eq=False)
class FrontPoint:
    """One path over the network, edge by edge, with its settings and times.

    Attributes
    ----------
    time : float
        From the departure of the request to the arrival [s].
    cost : float
        Fuel times weight, fees, waiting and time, as priced in the search.
    path : int64[P]
        Nodes from start to goal.
    path_arrive, path_depart : float64[P]
        Arrival at and departure from each node [s]; a later departure is waiting. The two are
        equal at the goal.
    setting : int64[P - 1]
        Setting of the ship's table on each edge.
    """

    time: float
    cost: float
    path: NDArray[np.int64]
    path_arrive: FloatArray
    path_depart: FloatArray
    setting: NDArray[np.int64]

    @property
    def arrive(self) -> float:
        """Arrival at the goal [s]."""
        return float(self.path_arrive[-1])

    @property
    def waiting(self) -> float:
        """Total time waited [s]."""
        return float(np.sum(self.path_depart - self.path_arrive))


@dataclass(frozen=True)
class FrontWork:
    """How much work a front was.

    Attributes
    ----------
    labels : int
        Labels that were sailed on from.
    relaxed : int
        Edges relaxed at a setting, from labels of the front and of the lower front.
    sailed : int
        Edges sailed at a setting through the fields, for the tables that relaxations read.
    pruned : int
        Labels dropped because they could not lead to the front.
    slices : int
        Times at which edges are tabulated.
    table_error : float
        Difference between these tables and the legs themselves, as a share, met on a sample of
        edges at times between slices (95th percentile).
    dropped : int
        Paths of the front that turned out closed when sailed exactly.
    memory : int
        Memory planned for [bytes].
    """

    labels: int
    relaxed: int
    sailed: int
    pruned: int
    slices: int
    table_error: float
    dropped: int
    memory: int


@dataclass(frozen=True, eq=False)
class NetworkFront:
    """Paths that are not dominated in time and cost, and a lower bound of any path.

    Attributes
    ----------
    points : tuple of FrontPoint
        By ascending time and falling cost.
    lower_time, lower_cost : float64[L]
        The lower front: no path on the network that takes at most a time costs less than the
        last value up to that time. Empty if it was not requested.
    bin_s : float
        Width of the bins of time [s].
    work : FrontWork
    refused : dict of str to int
        How many sails of edges were refused, by reason.
    """

    points: tuple[FrontPoint, ...]
    lower_time: FloatArray
    lower_cost: FloatArray
    bin_s: float
    work: FrontWork
    refused: dict[str, int] = field(default_factory=dict)

    @property
    def time(self) -> FloatArray:
        """Times of the points [s after departure]."""
        return np.array([point.time for point in self.points])

    @property
    def cost(self) -> FloatArray:
        """Costs of the points."""
        return np.array([point.cost for point in self.points])

    @property
    def fastest(self) -> FrontPoint:
        """The point of least time."""
        return self.points[0]

    @property
    def cheapest(self) -> FrontPoint:
        """The point of least cost."""
        return self.points[-1]

    def lower_at(self, time: float) -> float:
        """Return a lower bound of the cost of all paths that take at most a time.

        Parameters
        ----------
        time : float
            Passage time [s].

        Returns
        -------
        float
            Cost, in the unit of the front; NaN if unknown.
        """
        n = int(np.searchsorted(self.lower_time, time, side="right"))
        return float(self.lower_cost[n - 1]) if n else float("nan")

    @property
    def gap(self) -> FloatArray:
        """How far each point may be above the best path of its time, as a share of its cost.

        NaN without a lower front; 0 where the cost is 0.
        """
        below = np.array([self.lower_at(time) for time in self.time])
        cost = self.cost
        share = np.divide(cost - below, cost, out=np.zeros(len(cost)), where=cost != 0.0)
        return np.where(np.isnan(below), np.nan, np.maximum(share, 0.0))

    def knee(self) -> FrontPoint:
        """Return the point that is farthest below the line between the ends of the front.

        Returns
        -------
        FrontPoint
            The first point if the front has no extent in time or cost.
        """
        time, cost = self.time, self.cost
        spans = np.ptp(time), np.ptp(cost)
        if min(spans) <= 0.0:
            return self.points[0]
        below = (time - time[0]) / spans[0] + (cost - cost[-1]) / spans[1]
        return self.points[int(np.argmin(below))]

    def spread(self, count: int) -> tuple[FrontPoint, ...]:
        """Return points that are evenly spaced along the front, the ends among them.

        Parameters
        ----------
        count : int
            Greatest number of points; below 2 all are returned.

        Returns
        -------
        tuple of FrontPoint
            By rising time.
        """
        if count < 2:
            return self.points
        return tuple(self.points[i] for i in evenly_spaced_subset(self.time, self.cost, count))


def cheapest(front: NetworkFront, arrive_by: float | None = None) -> FrontPoint:
    """Return the point of least cost among those that arrive in time.

    Parameters
    ----------
    front : Front
    arrive_by : float, optional
        Latest arrival [s since epoch]; without it the cheap end of the front.

    Returns
    -------
    FrontPoint
        The point.

    Raises
    ------
    InputError
        If no point arrives in time; it says the earliest arrival (``details["earliest"]``).
    """
    if arrive_by is None:
        return front.cheapest
    in_time = [point for point in front.points if point.arrive <= arrive_by]
    if not in_time:
        earliest = front.fastest.arrive
        raise InputError(
            f"No path arrives by {arrive_by:.0f} s.",
            f"The earliest arrival is {earliest:.0f} s, "
            f"{(earliest - arrive_by) / 3600.0:.2f} h later.",
            "Allow a later arrival, or depart earlier.",
            earliest=earliest,
        )
    return in_time[-1]
