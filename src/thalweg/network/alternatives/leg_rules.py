"""Tests and costs of legs, for searches along a line."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.network.assembly import measured_pairs

if TYPE_CHECKING:
    from thalweg.chart.canals import Canal

#: Cost of legs (lat1, lon1, lat2, lon2) [deg]; by default their length [m].
LegCost: TypeAlias = Callable[[FloatArray, FloatArray, FloatArray, FloatArray], FloatArray]
#: Meridian crossings (n, K) of legs [deg]; paths with equal sums pass islands on the same sides.
PassingSides: TypeAlias = Callable[
    [FloatArray, FloatArray, FloatArray, FloatArray], NDArray[np.int8]
]
PolylineCoordinates: TypeAlias = tuple[FloatArray, FloatArray]


class LegTests(Protocol):
    """What string pulling asks of a chart."""

    @property
    def canals(self) -> Sequence[Canal]:
        """The canals, whose legs are not changed."""

    def canal_of_legs(self, *ends: Any) -> Any:
        """Return the number of the canal that each leg leads through, -1 at sea."""

    def legs_blocked(self, *ends: Any) -> Any:
        """Return which legs may not be sailed."""


@dataclass(frozen=True)
class LegRules:
    """Tests and costs of legs.

    Attributes
    ----------
    chart : Tests legs.
    cost : Of legs.
    sides : Meridian crossings of legs; None where islands may be passed on another side.
    least_cost : That legs have at least, quick to compute.
    """

    chart: LegTests
    cost: LegCost
    sides: PassingSides | None
    least_cost: LegCost | None = None

    def allowed(self, start: PolylineCoordinates, end: PolylineCoordinates) -> BoolArray:
        """Return which legs touch neither land nor no-go zones."""
        return ~np.asarray(self.chart.legs_blocked(*start, *end))

    def both_allowed(
        self, start: PolylineCoordinates, by: PolylineCoordinates, end: PolylineCoordinates
    ) -> BoolArray:
        """Return where both legs, to a position and on from it, are allowed."""
        first, second = self.allowed(*_two_legs(start, by, end)).reshape(2, -1)
        return np.asarray(first & second)

    def cost_by(
        self, start: PolylineCoordinates, by: PolylineCoordinates, end: PolylineCoordinates
    ) -> FloatArray:
        """Return the cost of both legs, to a position and on from it."""
        return _cost_by(self.cost, start, by, end)

    def cost_below(
        self,
        most: FloatArray,
        start: PolylineCoordinates,
        by: PolylineCoordinates,
        end: PolylineCoordinates,
    ) -> tuple[IntArray, FloatArray]:
        """Return where both legs cost less than ``most``, and what they cost there."""
        which = np.arange(len(most))
        if self.least_cost is not None:
            which = np.flatnonzero(_cost_by(self.least_cost, start, by, end) < most)
        price = self.cost_by(*(select_points(points, which) for points in (start, by, end)))
        less = price < most[which]
        return which[less], price[less]

    def same_side(
        self, start: PolylineCoordinates, by: PolylineCoordinates, end: PolylineCoordinates
    ) -> BoolArray:
        """Return which legs pass islands on the same side as the path through a third position."""
        if self.sides is None:
            return np.ones(len(start[0]), bool)
        round_it = self.sides(*start, *by) + self.sides(*by, *end)
        return np.asarray((self.sides(*start, *end) == round_it).all(axis=1))


def total_cost(line: PolylineCoordinates, leg_cost: LegCost | None = None) -> float:
    """Return the cost of a path; by default its length [m].

    Parameters
    ----------
    line : Latitudes and longitudes of the waypoints [deg].
    leg_cost : Cost of legs (lat1, lon1, lat2, lon2) [deg].

    Returns
    -------
    float : Sum over all legs.
    """
    lat, lon = line
    return float(np.sum((leg_cost or leg_lengths)(lat[:-1], lon[:-1], lat[1:], lon[1:])))


def leg_lengths(
    lat1: FloatArray, lon1: FloatArray, lat2: FloatArray, lon2: FloatArray
) -> FloatArray:
    """Return the lengths [m] of legs [deg]."""
    count = len(lat1)
    ends = np.arange(2 * count, dtype=np.int32)
    lat, lon = np.concatenate([lat1, lat2]), np.concatenate([lon1, lon2])
    return measured_pairs(lat, lon, ends[:count], ends[count:]).length


def _cost_by(
    cost: LegCost, start: PolylineCoordinates, by: PolylineCoordinates, end: PolylineCoordinates
) -> FloatArray:
    """Return the cost of both legs, to a position and on from it."""
    first, second = _two_legs(start, by, end)
    return np.asarray(cost(*first, *second).reshape(2, -1).sum(axis=0))


def _two_legs(
    start: PolylineCoordinates, by: PolylineCoordinates, end: PolylineCoordinates
) -> tuple[PolylineCoordinates, PolylineCoordinates]:
    """Return starts and ends of the legs to positions, followed by those of the legs from them."""
    lat, lon = (np.concatenate([start[k], by[k], end[k]]) for k in (0, 1))
    count = len(start[0])
    return (lat[: 2 * count], lon[: 2 * count]), (lat[count:], lon[count:])


def select_points(line: PolylineCoordinates, index: IntArray) -> PolylineCoordinates:
    """Return some points of a line, by number."""
    return line[0][index], line[1][index]
