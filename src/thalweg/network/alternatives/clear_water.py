"""Water off land and off shoals, and ways that are moved into it."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.depth.shoals import Shoals
from thalweg.chart.offing import required_offing
from thalweg.core.arrays.numbered_parts import numbered_parts
from thalweg.core.geodesy import (
    Position,
    densify,
    distance,
    geocentric_positions,
    geocentric_unit_vectors,
    line_length,
)
from thalweg.core.types import FloatArray, IntArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.alternatives.lattice_detour import lattice_detour
from thalweg.network.alternatives.leg_rules import (
    LegRules,
    PolylineCoordinates,
    leg_lengths,
    total_cost,
)
from thalweg.network.alternatives.path_shortening import string_pull_path
from thalweg.network.alternatives.waypoint_moves import move_waypoints

_ROUNDS: Final = 2  # passes of string pulling; each may double the waypoints of a corner
_NEAR_LAND: Final = 3.0  # what a mile nearer to land than required counts more, beside the graph
_NEAREST: Final = 4.0  # times as much as just inside the offing, at a quarter of it and nearer
_USUAL: Final = 2.0 * NAUTICAL_MILE  # offings over this are tested as finely as it
_AROUND: Final = 30  # miles before and after land that a detour may begin and end
_NEAR_END: Final = 10.0 * NAUTICAL_MILE  # of a way, where no detour is searched
_LONGEST_STRETCH: Final = 150  # miles of a way that a detour may replace
_LEAST_SAVED: Final = 2.0 * NAUTICAL_MILE  # detours that can save less are not searched
_REACH: Final = 25.0 * NAUTICAL_MILE  # of detours beside the way
_FINE_LEG: Final = 12.0 * NAUTICAL_MILE  # of ways moved off capes
_MOST_PLACES: Final = 64  # of a leg, where its distance from land is looked up


@dataclass(frozen=True)
class ClearWater:
    """Water off land and off shoals, and what a way costs that leaves it.

    Attributes
    ----------
    off_land : With an offing.
    shoals : Shoal water, in which a mile counts more; None for none.
    """

    off_land: Chart
    shoals: Shoals | None
    _known: dict[tuple[float, ...], float] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )

    def pulled(
        self,
        chart: Chart,
        line: PolylineCoordinates,
        *,
        rounds: int = _ROUNDS,
        least_gain: float = 0.0,
    ) -> PolylineCoordinates:
        """Return a way after string pulling by what it costs: `string_pull_path`."""
        return string_pull_path(
            chart,
            *line,
            leg_cost=self.cost,
            rounds=rounds,
            least_gain=least_gain,
            least_cost=leg_lengths,
        )

    def moved(self, chart: Chart, line: PolylineCoordinates) -> PolylineCoordinates:
        """Return a way whose legs near land are moved as far as costs fall."""
        lat, lon = line
        blocked = self.off_land.legs_blocked
        near = np.asarray(blocked(lat[:-1], lon[:-1], lat[1:], lon[1:]))
        edges = np.flatnonzero(np.diff(np.concatenate([[0], near.astype(int), [0]]))).reshape(-1, 2)
        first = np.maximum(edges[:, 0] - 1, np.append(0, edges[:-1, 1]))  # with the leg before ...
        last = np.minimum(edges[:, 1] + 1, np.append(first[1:], len(lat) - 1))  # ... and after it
        found = positions_of(lat, lon)
        for begin, end in reversed(list(zip(first.tolist(), last.tolist()))):
            part = slice(begin, end + 1)
            y, x = self.pulled(chart, (lat[part], lon[part]))
            if np.any(blocked(y[:-1], x[:-1], y[1:], x[1:])):
                rules = LegRules(chart, self.cost, None, leg_lengths)
                y, x = move_waypoints(rules, (y, x), longest_leg=_FINE_LEG)
            found[part] = positions_of(*self.pulled(chart, (y, x), rounds=0))
        lat, lon = np.array(found).T
        return lat, lon

    def round_land(self, chart: Chart, line: PolylineCoordinates) -> PolylineCoordinates:
        """Return a way whose stretches near land lead round it where that costs less.

        Moves of single waypoints do not find ways on the other side of islands.
        """
        lat, lon = line
        if not np.any(self.off_land.legs_blocked(lat[:-1], lon[:-1], lat[1:], lon[1:])):
            return line
        lat, lon, leg = densify(lat, lon, NAUTICAL_MILE)
        near = np.asarray(self.off_land.legs_blocked(lat[:-1], lon[:-1], lat[1:], lon[1:]))
        for end in (0, -1):  # ships leave and enter ports near land
            near &= distance(lat[:-1], lon[:-1], lat[end], lon[end]) > _NEAR_END
        corner = np.diff(leg, prepend=-1, append=-1) != 0
        found = positions_of(lat, lon)
        deep = replace(self, shoals=None)
        spacing = 0.5 * max(min(self.off_land.offing.distance, _USUAL), NAUTICAL_MILE)
        for begin, end in reversed(_stretches(np.flatnonzero(near), len(lat) - 1)):
            if end - begin > _LONGEST_STRETCH:
                continue
            part = lat[begin : end + 1], lon[begin : end + 1]
            most = deep.cost_of(part) - length_of_line(part)  # that a detour can save
            if most < _LEAST_SAVED:
                continue
            half = _AROUND * NAUTICAL_MILE
            reach = min(float(np.sqrt((half + 0.5 * most) ** 2 - half**2)), _REACH)
            way = lattice_detour(chart, part, leg_cost=self.cost, spacing=spacing, reach=reach)
            way = self.pulled(chart, way)
            if self.cost_of(way) < self.cost_of(part):
                found[begin : end + 1] = positions_of(*way)
                kept = np.ones(len(way[0]), bool)
                corner = np.concatenate([corner[:begin], kept, corner[end + 1 :]])
        y, x = np.array(found)[corner].T
        return self.pulled(chart, (y, x), rounds=0)

    def cost_of(self, line: PolylineCoordinates) -> float:
        """Return the cost of a way."""
        return total_cost(line, self.cost)

    def cost(
        self, lat1: FloatArray, lon1: FloatArray, lat2: FloatArray, lon2: FloatArray
    ) -> FloatArray:
        """Return the length of legs [m], more near land and over shoals."""
        legs = list(zip(lat1.tolist(), lon1.tolist(), lat2.tolist(), lon2.tolist()))
        new = np.flatnonzero([leg not in self._known for leg in legs])
        if len(new):  # string pulling asks for nearly half of the legs again
            costs = self._cost(lat1[new], lon1[new], lat2[new], lon2[new])
            self._known.update(zip([legs[k] for k in new.tolist()], costs.tolist()))
        return np.array([self._known[leg] for leg in legs], float)

    def _cost(
        self, lat1: FloatArray, lon1: FloatArray, lat2: FloatArray, lon2: FloatArray
    ) -> FloatArray:
        length = leg_lengths(lat1, lon1, lat2, lon2)
        cost = length.copy()
        near = np.flatnonzero(self.off_land.legs_blocked(lat1, lon1, lat2, lon2))
        ends = (x[near] for x in (lat1, lon1, lat2, lon2))
        cost[near] += _NEAR_LAND * self._near_land(length[near], *ends)
        if self.shoals is not None:
            cost += length * self.shoals.excess(lat1, lon1, lat2, lon2)
        return np.asarray(cost)

    def _near_land(
        self,
        length: FloatArray,
        lat1: FloatArray,
        lon1: FloatArray,
        lat2: FloatArray,
        lon2: FloatArray,
    ) -> FloatArray:
        """Return for how long [m] legs are nearer to land than required, those that are so."""
        offing = self.off_land.offing.distance
        count = np.clip(np.ceil(2.0 * length / np.clip(offing, 1.0, _USUAL)), 1, _MOST_PLACES)
        leg, part = numbered_parts(count)
        share = (part + 0.5) / count[leg]
        one, other = (
            geocentric_unit_vectors(lat1, lon1)[leg],
            geocentric_unit_vectors(lat2, lon2)[leg],
        )
        lat, lon = geocentric_positions(one + share[:, None] * (other - one))  # on the chord
        shore = np.asarray(self.off_land.coastline.shore_distance(lat, lon, cap=offing))
        required = required_offing(self.off_land.offing_arrays, lat, lon)
        weight = np.minimum(required / np.maximum(shore, 1.0), _NEAREST) * (shore < required)
        beside = np.bincount(leg, weight, minlength=len(length)) / count * length
        # a leg past a cape between two places is near it for so long at least
        return np.asarray(np.maximum(beside, np.minimum(offing, length)))


def positions_of(lat: FloatArray, lon: FloatArray) -> list[Position]:
    """Return the positions of a line."""
    return list(zip(lat.tolist(), lon.tolist()))


def length_of_line(line: PolylineCoordinates) -> float:
    """Return the length of a line [m]."""
    return line_length(positions_of(*line))


def _stretches(near: IntArray, last: int) -> list[tuple[int, int]]:
    """Return the first and last positions of stretches of a way of miles around those near land."""
    if not len(near):
        return []
    runs = np.split(near, np.flatnonzero(np.diff(near) > 2 * _AROUND) + 1)
    return [(max(int(r[0]) - _AROUND, 0), min(int(r[-1]) + 1 + _AROUND, last)) for r in runs]
