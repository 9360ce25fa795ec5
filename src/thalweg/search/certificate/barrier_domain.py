"""Where the routes of a stretch may lie that are faster than a known one, and the sea there."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final
from weakref import WeakKeyDictionary

import numpy as np

from thalweg.core.geodesy import MEAN_RADIUS, direct, distance, longitude_difference
from thalweg.core.types import FloatArray
from thalweg.kernels.codes import CURRENT_EAST, CURRENT_NORTH, SPEED_FIELD
from thalweg.kernels.leg.raster_sampling import RasterArrays
from thalweg.search.certificate.barrier_mesh import ShipInBarrier
from thalweg.search.certificate.barrier_raster import (
    BarrierRaster,
    RasterRequest,
    freeze_barrier_raster,
    greatest_value,
    is_uniform,
)
from thalweg.search.certificate.closed_water import cells_inside

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.chart.zones.zone_set import Zones
    from thalweg.sea import Sea

_MARGIN: Final = 1.02
_MARGIN_OF_HALVES: Final = 1.1  # of a search that reads much of the sea: one is mostly enough
_ATTEMPTS: Final = 8  # to find the greatest speed in the domain of that speed
_CELLS_FOR_SPEED: Final = 60  # of functions, while the greatest speed over ground is sought
_STEPS_ROUND_ELLIPSE: Final = 73
_HALVINGS: Final = 24  # of the way to the ellipse, which leave a metre or two, outside of it
_LARGEST_LATITUDE: Final = 86.0  # of a mesh [deg]
_BEYOND_GLOBE: Final = 5.0  # of the area of a chart, for a mesh round the globe [deg]
_GLOBE: Final = (-89.0, 89.0, -180.0, 180.0)  # south, north, west and east [deg]


@dataclass(frozen=True, eq=False)
class StretchToBound:
    """A stretch whose time is bounded from below.

    Attributes
    ----------
    chart : Land, offing, zones and canals; None for open water.
    channels : Channels of the sea that count.
    start, goal : (lat, lon) [deg].
    depart : Departure, or the first one of a window [s since 1970-01-01T00:00Z].
    known : Time of a route that exists [s].
    latest : Last departure of a window [s since 1970-01-01T00:00Z].
    kept_out : Polygons (x longitude, y latitude [deg]) that the routes of the bound keep out of.
    """

    sea: Sea
    chart: Chart | None
    ship: ShipInBarrier
    channels: Sequence[int]
    start: tuple[float, float]
    goal: tuple[float, float]
    depart: float
    known: float
    latest: float | None = None
    kept_out: tuple[Any, ...] = ()

    @property
    def length(self) -> float:
        """Length of the geodesic [m]."""
        return float(distance(*self.start, *self.goal))

    @property
    def departures(self) -> float:
        """From the first to the last departure [s]."""
        return 0.0 if self.latest is None else max(self.latest - self.depart, 0.0)

    @property
    def period(self) -> tuple[float, float]:
        """From the first departure to the arrival of the known route after the last one [s]."""
        return self.depart, self.depart + self.departures + self.known

    @property
    def currents(self) -> tuple[int, ...]:
        """Channels of currents that count."""
        return tuple(c for c in self.channels if c in (CURRENT_EAST, CURRENT_NORTH))

    def canal_speed(self, fastest: float) -> float:
        """Return the greatest speed [m/s] along the geodesic at which a canal joins its ends.

        Of those that a ship may pass in the known time with a greatest speed elsewhere; 0 without.
        """
        speeds = [0.0]
        for canal in () if self.chart is None else self.chart.canals:
            for one, other in (canal.ends, canal.ends[::-1]):
                rest = float(distance(*self.start, *one) + distance(*other, *self.goal))
                if rest / fastest + canal.transit_time < self.known:
                    speeds.append(float(distance(*one, *other)) / canal.transit_time)
        return max(speeds)


@dataclass(frozen=True, eq=False)
class BarrierDomain:
    """The raster of the sea round the routes that may be faster than the known one.

    Attributes
    ----------
    raster : Times since the first departure [s].
    sampling : How the sea of the raster differs from the data; "" where it does not.
    fastest : Upper bound of the speed over ground [m/s].
    ship : With an upper bound of the speed through water, also where that is a field.
    margins : By how much the sea may differ from the raster (`BarrierRaster`).
    strongest_current : No current in the domain is stronger [m/s]; 0 without currents.
    """

    raster: RasterArrays
    sampling: str
    fastest: float
    ship: ShipInBarrier
    margins: FloatArray
    strongest_current: float

    @classmethod
    def around(
        cls, stretch: StretchToBound, cells: int, *, fastest: float = 0.0
    ) -> BarrierDomain | None:
        """Return the domain of a stretch: round the globe where need be, in a uniform sea.

        None near a pole and across half of the globe in other seas.

        Parameters
        ----------
        cells : Cells of the raster along its longer side where the data are no finer.
        fastest : Speed over ground [m/s] that is known to be reached in the data.
        """
        mean = stretch.length / stretch.known  # the known route is as fast somewhere
        first = max(mean, stretch.ship.top_speed if math.isfinite(stretch.ship.top_speed) else 0.0)
        first = max(first, fastest, stretch.canal_speed(max(first, fastest)))
        unsurpassed = _unsurpassed_speed(stretch, min(cells, _CELLS_FOR_SPEED), first)
        if unsurpassed is None:
            return None
        (enough, sampling), found = unsurpassed, None
        for wanted in sorted({min(cells, _CELLS_FOR_SPEED), cells}):
            found = None  # its memory is free before the next is read
            found = cls._within_reach(stretch, wanted, enough, first)
            if found is None:
                return None
            if not found.has_cells(wanted):
                break
            first = max(mean, found.fastest)
            enough = max(enough, first)
        return found if found is None or found.sampling else replace(found, sampling=sampling)

    @classmethod
    def of_globe(cls, stretch: StretchToBound, cells: int) -> BarrierDomain:
        """Return the domain of all seas, for the bound of the geodesic alone: it has no mesh.

        Parameters
        ----------
        cells : Cells of the raster along the equator where the data are no finer.
        """
        ship, flows = stretch.ship, stretch.currents
        frozen = _frozen(stretch, flows, _GLOBE, cells)
        top, speed = _greatest_speeds(stretch, frozen)
        sampling = frozen.sampling if flows or ship.speed_field is not None else ""
        ship = replace(ship, top_speed=top)
        return cls._of(replace(frozen, sampling=sampling), speed, ship)

    @classmethod
    def _within_reach(
        cls, stretch: StretchToBound, cells: int, fastest: float, least: float
    ) -> BarrierDomain | None:
        """Return the domain that a ship can reach by its greatest speed over ground in it.

        Parameters
        ----------
        fastest : Speed over ground [m/s] that no route surpasses. Where the data say that it is
            less in the whole domain, the domain of that speed is looked at in turn.
        least : Speed over ground [m/s] below which the domain is not made smaller.
        """
        ship = stretch.ship
        for attempt in range(_ATTEMPTS):
            box = _box_of_routes(stretch, fastest * _MARGIN)
            if box is None and is_uniform(stretch.sea):
                box = _round_box(stretch)
            if box is None:
                return None
            frozen = _frozen(stretch, stretch.channels, box, cells)
            top, speed = _greatest_speeds(stretch, frozen)
            # samples may miss what others have seen
            certain = not frozen.sampling or bool(frozen.margins.any())
            is_least = fastest <= max(speed, least) * _MARGIN or attempt >= _ATTEMPTS // 2
            if speed <= fastest * _MARGIN and (is_least or not certain):
                return cls._of(frozen, speed, replace(ship, top_speed=top))
            fastest = max(speed, least)
            del frozen  # its memory is free before the next is read
        return None

    @classmethod
    def _of(cls, frozen: BarrierRaster, fastest: float, ship: ShipInBarrier) -> BarrierDomain:
        strongest = frozen.strongest_current
        return cls(frozen.arrays, frozen.sampling, fastest, ship, frozen.margins, strongest)

    def has_cells(self, wanted: int) -> bool:
        """Return whether the raster has the cells wanted; else the data decide on them."""
        return abs(max(self.raster.values.shape[1:3]) - 1 - wanted) <= 1

    @property
    def axes(self) -> tuple[FloatArray, FloatArray]:
        """Latitudes and longitudes of the nodes of the raster [deg]."""
        _, rows, columns, _ = self.raster.values.shape
        lat0, dlat, lon0, dlon = self.raster.corner
        return lat0 + dlat * np.arange(rows), lon0 + dlon * np.arange(columns)

    @property
    def cell_height(self) -> float:
        """Height of a cell of the raster [m]."""
        return float(self.raster.corner[1]) * 111_132.0

    def from_departure(self, later: float) -> BarrierDomain:
        """Return the domain with times since a departure later than the first by so much [s]."""
        if later == 0.0:
            return self
        return replace(self, raster=self.raster._replace(times=self.raster.times - later))

    def slower_inside(self, zones: Zones, factor: float) -> BarrierDomain:
        """Return the domain with speeds times a factor, 1 or less, inside the control areas.

        Cells of the raster that are not inside all over keep their speed all over.
        """
        lat, lon = self.axes
        inside = np.pad(cells_inside(zones, lat, lon), 1, constant_values=True)
        nodes = inside[1:, 1:] & inside[1:, :-1] & inside[:-1, 1:] & inside[:-1, :-1]
        values, channel = self.raster.values.copy(), self.raster.channel_index[SPEED_FIELD]
        values[..., channel] *= np.where(nodes, factor, 1.0)
        return replace(self, raster=self.raster._replace(values=values))


def _frozen(
    stretch: StretchToBound,
    channels: Sequence[int],
    box: tuple[float, float, float, float],
    cells: int,
) -> BarrierRaster:
    """Return the raster of some channels of the sea of a stretch in a box."""
    field = stretch.ship.speed_field
    request = RasterRequest(stretch.sea, channels, box, stretch.period, cells, field)
    return freeze_barrier_raster(request)


def _greatest_speeds(stretch: StretchToBound, frozen: BarrierRaster) -> tuple[float, float]:
    """Return the greatest speeds through water and over ground on a raster [m/s]."""
    top = stretch.ship.top_speed
    if stretch.ship.speed_field is not None:
        top = greatest_value(frozen.arrays, SPEED_FIELD)
    speed = top + frozen.strongest_current
    return top, max(speed, stretch.canal_speed(speed))


@dataclass(frozen=True)
class _FoundSpeed:
    """A speed over ground that no route of a stretch surpasses, and for which stretch it is."""

    stretch: tuple[object, ...]
    cells: int
    known: float
    speed: float
    sampling: str


#: the last one found in each sea: one plan asks several times
_FOUND_SPEEDS: WeakKeyDictionary[Sea, _FoundSpeed] = WeakKeyDictionary()


def _unsurpassed_speed(
    stretch: StretchToBound, cells: int, fastest: float
) -> tuple[float, str] | None:
    """Return what `_speed_within_half` finds, once for a stretch and all shorter known times."""
    ship, chart = stretch.ship, stretch.chart
    water = None if chart is None else (tuple(chart.area.array()), tuple(chart.canals))
    key = (
        stretch.start, stretch.goal, stretch.depart, stretch.departures, water, ship.top_speed,
        ship.speed_field, stretch.currents,
    )  # fmt: skip
    last = _FOUND_SPEEDS.get(stretch.sea)
    holds = last is not None and last.stretch == key and last.known >= stretch.known
    if last is not None and holds and last.cells >= cells:
        return max(last.speed, fastest), last.sampling
    found = _speed_within_half(stretch, cells, fastest)
    if found is not None:
        _FOUND_SPEEDS[stretch.sea] = _FoundSpeed(key, cells, stretch.known, *found)
    return found


def _speed_within_half(
    stretch: StretchToBound, cells: int, fastest: float
) -> tuple[float, str] | None:
    """Return a speed over ground [m/s] that no route surpasses, and how the sea was sampled for it.

    None where none is found.

    At every moment a ship is within half of the known time of the start or of the goal. So it is
    never faster than a speed that is nowhere surpassed as far from them as that speed leads in half
    of the known time. The greatest speed in the ellipse of `_box_of_routes` alone would not do: a
    ship may leave it for a current outside.

    Parameters
    ----------
    cells : Cells of the raster along the longer side of that box where the data are no finer.
    fastest : Speed over ground [m/s] from which it is sought upwards.
    """
    if is_uniform(stretch.sea) or not (stretch.currents or stretch.ship.speed_field):
        return fastest, ""
    for _ in range(_ATTEMPTS):
        box = _box_of_halves(stretch, fastest * _MARGIN_OF_HALVES)
        inner = _box_of_routes(stretch, fastest)
        if inner is None:
            return None
        larger = max(box[1] - box[0], box[3] - box[2]) / max(
            inner[1] - inner[0], inner[3] - inner[2]
        )
        frozen = _frozen(stretch, stretch.currents, box, math.ceil(cells * larger))
        speed = _greatest_speeds(stretch, frozen)[1]
        if speed <= fastest * _MARGIN_OF_HALVES:
            return max(fastest, speed), frozen.sampling
        fastest = speed
    return None


def _box_of_halves(stretch: StretchToBound, speed: float) -> tuple[float, float, float, float]:
    """Return a box round the positions within half of the known time of an end at a speed [m/s].

    South, north, west and east [deg], not beyond the area of the chart.
    """
    radius = math.degrees(1.01 * 0.5 * speed * stretch.known / MEAN_RADIUS)
    south, north, _, _ = _GLOBE if stretch.chart is None else stretch.chart.area.array()
    ends = [lat for lat, _ in (stretch.start, stretch.goal)]
    south = max(min(ends) - radius, south, _GLOBE[0])
    north = min(max(ends) + radius, north, _GLOBE[1])
    beyond = 180.0
    if radius + max(np.abs(ends)) < _GLOBE[1]:
        shrink = math.cos(math.radians(max(np.abs(ends))))
        beyond = math.degrees(math.asin(math.sin(math.radians(radius)) / shrink))
    east = longitude_difference(stretch.goal[1], stretch.start[1])
    half = min(0.5 * abs(east) + beyond, 180.0)
    middle = stretch.start[1] + 0.5 * east
    return south, north, middle - half, middle + half


def _round_box(stretch: StretchToBound) -> tuple[float, float, float, float]:
    """Return a box all round the globe, but for the poles; its seam is far from the stretch."""
    south, north = -_LARGEST_LATITUDE, _LARGEST_LATITUDE
    if stretch.chart is not None:  # with some cells beyond, which are closed
        south = max(south, stretch.chart.area.south - _BEYOND_GLOBE)
        north = min(north, stretch.chart.area.north + _BEYOND_GLOBE)
    start, goal = stretch.start[1], stretch.goal[1]
    seam = start + 0.5 * longitude_difference(goal, start) - 180.0
    return south, north, seam, seam + 360.0


def _box_of_routes(
    stretch: StretchToBound, speed: float
) -> tuple[float, float, float, float] | None:
    """Return a box round all positions from which start and goal are reached in the known time.

    South, north, west and east [deg], not beyond the area of the chart. None where it holds a pole
    or more than 350 degrees of longitude.
    """
    start, goal, total = stretch.start, stretch.goal, speed * stretch.known
    length = float(distance(*start, *goal))
    total = max(total, length * (1.0 + 1e-6) + 1.0)
    if total > 1.8e7:
        return None
    # every such position is on a geodesic from the start, no farther than the ellipse that way
    courses = np.linspace(0.0, 2.0 * math.pi, _STEPS_ROUND_ELLIPSE)
    near, far = np.zeros(courses.size), np.full(courses.size, total)
    for _ in range(_HALVINGS):
        middle = 0.5 * (near + far)
        lat, lon = direct(start[0], start[1], courses, middle)[:2]
        inside = middle + np.asarray(distance(lat, lon, *goal)) < total
        near, far = np.where(inside, middle, near), np.where(inside, far, middle)
    lat, lon = direct(start[0], start[1], courses, far)[:2]
    turned = longitude_difference(np.asarray(lon), start[1])
    toward_goal = longitude_difference(goal[1], start[1])
    height = max(float(lat.max()), start[0], goal[0]) - min(float(lat.min()), start[0], goal[0])
    width = max(float(turned.max()), toward_goal, 0.0) - min(float(turned.min()), toward_goal, 0.0)
    margin = 0.04 * max(height, width) + 1e-3
    south = min(float(lat.min()), start[0], goal[0]) - margin
    north = max(float(lat.max()), start[0], goal[0]) + margin
    west = start[1] + min(float(turned.min()), toward_goal, 0.0) - margin
    east = start[1] + max(float(turned.max()), toward_goal, 0.0) + margin
    if stretch.chart is not None:  # with some cells beyond, which are closed
        area, beyond = stretch.chart.area, 0.03 * (north - south) + 0.01
        south, north = max(south, area.south - beyond), min(north, area.north + beyond)
    if south < -_LARGEST_LATITUDE or north > _LARGEST_LATITUDE or east - west > 350.0:
        return None
    return south, north, west, east
