"""Traffic separation schemes of large straits and capes, by approximate separation lines.

The table is ``data/traffic_schemes.csv``, one row a scheme. Ships keep a separation line or zone to
port (the general direction of traffic of all schemes in the table; Rule 10 (b) of the Collision
Regulations, 1972). The lines are rounded to about half a mile and are not charted: they decide on
which side of a strait a plan passes, not where the lanes are. Beyond the lane on a landward side
lies the inshore traffic zone, which ships of 20 m and more do not use unless their port is there
(Rule 10 (d)); voyages from, to or by a place inside it may use all of it. Ships cross lanes, and
the zones beside them, on courses of about a right angle to the traffic (Rule 10 (c)).
Lanes among the zones of a user (`thalweg.chart.zones.traffic_lanes`) take their
place. Schemes that are not in the table are not known.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Final

import numpy as np

from thalweg.chart.rings import disc_shape
from thalweg.chart.zones.traffic_lanes import TrafficLane
from thalweg.core.file_reading import table_rows
from thalweg.core.geodesy import Position, distance, inverse
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE

#: What a mile against the traffic of a scheme, or in its inshore traffic zone, counts: far more
#: than the detour to the lane, so that no ocean passage gains by it.
AGAINST_FACTOR: Final = 10.0
#: Round the ends of a voyage ships use the inshore traffic zones of ports [m].
PORT_RADIUS: Final = 12.0 * NAUTICAL_MILE
INSHORE: Final = "inshore traffic zone"
SMALL: Final = 20.0  #: length [m] below which ships may use inshore traffic zones
_NEAR_PORT: Final = 30.0 * NAUTICAL_MILE  # ends so near a port behind an inshore zone go to it
_CLEAR: Final = 0.25  # of the width of a lane that plans keep off the separation zone
_ANY_COURSE: Final = -1.0  # tolerance of an area in which every course is against
#: From a right angle to the traffic, at which ships cross lanes and inshore traffic zones [deg].
_CROSSING: Final = 20.0
_LONGEST_DETOUR: Final = 4.0  # times the geodesic: farther schemes are left out
_LEAST_DETOUR: Final = 600.0 * NAUTICAL_MILE
_DEGREE: Final = 60.0 * NAUTICAL_MILE  # of latitude [m], to a third of a percent
_POINTS: Final = ("N", "NE", "E", "SE", "S", "SW", "W", "NW")


@dataclass(frozen=True)
class TrafficScheme:
    """A traffic separation scheme.

    Parameters
    ----------
    line : tuple of (lat, lon)
        Middle of the separation zone [deg], in the direction of the traffic on its starboard side.
    zone : Half the width of the separation zone [m].
    lane : Width of each lane [m].
    starboard, port : float
        Distance from the line within which it counts [m], on the side of the traffic along the
        line and on that of the traffic against it.
    inshore : "starboard", "port", "both" or "": sides where an inshore zone follows the lane.
    ports : Ports behind the inshore zones, which ships reach through them (Rule 10 (d) (ii)):
        Brest through the Chenal du Four (general knowledge, unchecked).
    """

    name: str
    line: tuple[Position, ...]
    zone: float
    lane: float
    starboard: float
    port: float
    inshore: str = ""
    ports: tuple[Position, ...] = ()
    source: str = ""

    @property
    def lanes(self) -> tuple[TrafficLane, ...]:
        """A lane for each side and part of the line, and the inshore traffic zones.

        The separation zone and `_CLEAR` of the other lane beside it belong to the lanes of both
        sides, so that plans keep clear of it (Rule 10 (b)).
        """
        return tuple(lane for _, lane in self._lanes_and_zones)

    def lanes_of_voyage(
        self, ends: Sequence[Position], *, inshore: bool = True
    ) -> list[TrafficLane]:
        """Return the lanes, and the inshore traffic zones without an end (lat, lon) inside.

        An end near a port behind the zones, which ships reach through them, opens them as well. A
        voyage from one side of the separation line to the other may cross the zones at about a
        right angle; others would get along them by tacking at such angles.
        """
        import shapely

        places = shapely.points([(lon, lat) for lat, lon in ends])
        line = shapely.LineString([(lon, lat) for lat, lon in self.line])
        crosses = len(ends) > 1 and shapely.LineString(places).crosses(line)
        behind = any(
            float(distance(*end, *port)) < _NEAR_PORT for end in ends for port in self.ports
        )
        opened = {
            side
            for side, lane in self._lanes_and_zones
            if side and (behind or lane.shape.covers(places).any())
        }
        return [
            replace(lane, crossing=_CROSSING) if side and crosses else lane
            for side, lane in self._lanes_and_zones
            if not side or (inshore and side not in opened)
        ]

    @cached_property
    def _lanes_and_zones(self) -> tuple[tuple[str, TrafficLane], ...]:
        """The side of each inshore traffic zone, "" for lanes, and its area."""
        lat, lon = np.array(self.line, float).T
        course = np.degrees(np.asarray(inverse(lat[:-1], lon[:-1], lat[1:], lon[1:])[1]))
        lanes: list[tuple[str, TrafficLane]] = []
        inner = self.zone + _CLEAR * self.lane
        for side, reach, sign, turn in (
            ("starboard", self.starboard, 1.0, 0.0),
            ("port", self.port, -1.0, 180.0),
        ):
            has_zone = self.inshore in (side, "both")
            edge = min(self.zone + self.lane, reach) if has_zone else reach
            for k, heading in enumerate((course + turn) % 360.0):
                name = f"{self.name}, {_POINTS[round(heading / 45.0) % 8]}-bound"
                shape = self._part(k, -sign * inner, sign * edge)
                lane = TrafficLane(
                    name, shape, float(heading), factor=AGAINST_FACTOR, crossing=_CROSSING
                )
                lanes.append(("", lane))
                if edge < reach:
                    shape = self._part(k, sign * edge, sign * reach)
                    name = f"{self.name}, {INSHORE}"
                    zone = TrafficLane(name, shape, float(heading), _ANY_COURSE, AGAINST_FACTOR)
                    lanes.append((side, zone))
        return tuple(lanes)

    @cached_property
    def separation(self) -> Any:
        """The separation zone as a shapely polygon of longitude and latitude."""
        return _quadrangle(*self.shifted(-self.zone), *self.shifted(self.zone)[::-1])

    @cached_property
    def arrows(self) -> tuple[tuple[Position, Position], ...]:
        """For drawing: the middle of each lane along each part, from start to end (lat, lon)."""
        sides = (
            self.shifted(self.zone + 0.5 * self.lane),
            self.shifted(-self.zone - 0.5 * self.lane)[::-1],
        )
        return tuple(
            ((float(a[1]), float(a[0])), (float(b[1]), float(b[0])))
            for side in sides
            for a, b in itertools.pairwise(side)
        )

    def _part(self, k: int, inner: float, outer: float) -> Any:
        """Return the area between two distances [m] to starboard, along one part of the line."""
        near, far = self.shifted(inner), self.shifted(outer)
        shape = _quadrangle(near[k], near[k + 1], far[k + 1], far[k])
        return shape if shape.is_valid else shape.convex_hull  # where the line turns sharply

    def shifted(self, metres: float) -> FloatArray:
        """Return the separation line moved to starboard.

        Parameters
        ----------
        metres : float
            Distance [m]; negative to port.

        Returns
        -------
        float64 array (n, 2)
            Longitude and latitude [deg].
        """
        lat, lon = np.array(self.line, float).T
        stretch = np.cos(np.radians(lat.mean()))
        xy = np.stack([lon * stretch, lat], axis=-1)
        along = np.diff(xy, axis=0)
        along /= np.linalg.norm(along, axis=1)[:, None]
        right = np.stack([along[:, 1], -along[:, 0]], axis=-1)
        first, last = np.vstack([right[:1], right]), np.vstack([right, right[-1:]])
        mitre = (first + last) / (1.0 + np.sum(first * last, axis=1))[:, None]
        return np.asarray((xy + mitre * (metres / _DEGREE)) / [stretch, 1.0])


def _quadrangle(*corners: FloatArray) -> Any:
    import shapely

    return shapely.Polygon([tuple(corner) for corner in corners])


def lanes_of_schemes(ends: Sequence[Position], *, inshore: bool = True) -> tuple[TrafficLane, ...]:
    """Return the lanes of the schemes that a voyage may meet, without the water near its ends.

    An inshore traffic zone with one of the ends inside does not count (Rule 10 (d) (ii)).

    Parameters
    ----------
    ends : sequence of (lat, lon)
        Start, via points and goal [deg].
    inshore : bool
        Whether the inshore traffic zones count.
    """
    import shapely

    near = shapely.union_all([disc_shape(*end, PORT_RADIUS, quad_segs=4) for end in ends])
    lanes = []
    for scheme in TRAFFIC_SCHEMES:
        if not any(_may_meet(scheme, *pair) for pair in itertools.pairwise(ends)):
            continue
        for lane in scheme.lanes_of_voyage(ends, inshore=inshore):
            shape = lane.shape.difference(near) if lane.shape.intersects(near) else lane.shape
            lanes += [replace(lane, shape=part) for part in shapely.get_parts(shape)]
    return tuple(lane for lane in lanes if not lane.shape.is_empty)


def _may_meet(scheme: TrafficScheme, start: Position, goal: Position) -> bool:
    """Return whether a detour by a scheme is not out of the question."""
    middle = scheme.line[len(scheme.line) // 2]
    by_way = float(distance(*start, *middle)) + float(distance(*middle, *goal))
    straight = float(distance(*start, *goal))
    return by_way <= max(_LONGEST_DETOUR * straight, straight + _LEAST_DETOUR)


def _read_schemes() -> tuple[TrafficScheme, ...]:
    schemes = []
    for row in table_rows("thalweg.chart", "traffic_schemes.csv"):
        points = [point.split(",") for point in row["line"].split()]
        line = tuple((float(lat), float(lon)) for lat, lon in points)
        zone, lane, starboard, port = (
            float(row[f"{part}_nm"]) * NAUTICAL_MILE
            for part in ("zone", "lane", "starboard", "port")
        )
        ports = tuple(
            (float(lat), float(lon))
            for lat, lon in (place.split(",") for place in row["ports"].split())
        )
        more = row["inshore"], ports, row["source"]
        schemes.append(TrafficScheme(row["name"], line, zone, lane, starboard, port, *more))
    return tuple(schemes)


TRAFFIC_SCHEMES: Final = _read_schemes()  #: of `thalweg/chart/data/traffic_schemes.csv`
