"""Traffic separation schemes of large straits and capes, by approximate separation lines.

The table is ``data/traffic_schemes.csv``, one row a scheme. Ships keep a separation line or zone to
port (the general direction of traffic of all schemes in the table; Rule 10 (b) of the Collision
Regulations, 1972). The lines are rounded to about half a mile and are not charted: they decide on
which side of a strait a plan passes, not where the lanes are. Lanes among the zones of
a user (`thalweg.chart.zones.traffic_lanes`) take their
place.
"""

from __future__ import annotations

import csv
import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from importlib import resources
from typing import Any, Final

import numpy as np

from thalweg.chart.zones.traffic_lanes import TrafficLane
from thalweg.core.geodesy import Position, distance, inverse
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE

#: What a mile against the traffic of a scheme counts: more than the detour to its other side.
AGAINST_FACTOR: Final = 3.0
#: Round the ends of a voyage ships use the inshore traffic zones of ports [m].
PORT_RADIUS: Final = 12.0 * NAUTICAL_MILE
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
    starboard, port : float
        Distance from the line within which its direction counts [m], on the side of the traffic
        along the line and on that of the traffic against it: the lane and the inshore traffic zone.
    """

    name: str
    line: tuple[Position, ...]
    zone: float
    starboard: float
    port: float
    source: str = ""

    @cached_property
    def lanes(self) -> tuple[TrafficLane, ...]:
        """A lane for each side and each part of the line; the separation zone belongs to both."""
        lat, lon = np.array(self.line, float).T
        course = np.degrees(np.asarray(inverse(lat[:-1], lon[:-1], lat[1:], lon[1:])[1]))
        lanes = []
        for inner, outer, turn in (
            (-self.zone, self.starboard, 0.0),
            (self.zone, -self.port, 180.0),
        ):
            near, far = self._shifted(inner), self._shifted(outer)
            for k, heading in enumerate((course + turn) % 360.0):
                shape = _quadrangle(near[k], near[k + 1], far[k + 1], far[k])
                name = f"{self.name}, {_POINTS[round(heading / 45.0) % 8]}-bound"
                lanes.append(TrafficLane(name, shape, float(heading), factor=AGAINST_FACTOR))
        return tuple(lanes)

    def _shifted(self, metres: float) -> FloatArray:
        """Return the line (n, 2) as (lon, lat) [deg], so far to starboard."""
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


def lanes_of_schemes(ends: Sequence[Position]) -> tuple[TrafficLane, ...]:
    """Return the lanes of the schemes that a voyage may meet, without the water near its ends.

    Parameters
    ----------
    ends : sequence of (lat, lon)
        Start, via points and goal [deg].
    """
    import shapely

    near = shapely.union_all([_disc(*end) for end in ends])
    lanes = []
    for scheme in TRAFFIC_SCHEMES:
        if not any(_may_meet(scheme, *pair) for pair in itertools.pairwise(ends)):
            continue
        for lane in scheme.lanes:
            shape = lane.shape.difference(near) if lane.shape.intersects(near) else lane.shape
            lanes += [replace(lane, shape=part) for part in shapely.get_parts(shape)]
    return tuple(lane for lane in lanes if not lane.shape.is_empty)


def _may_meet(scheme: TrafficScheme, start: Position, goal: Position) -> bool:
    """Return whether a detour by a scheme is not out of the question."""
    middle = scheme.line[len(scheme.line) // 2]
    by_way = float(distance(*start, *middle)) + float(distance(*middle, *goal))
    straight = float(distance(*start, *goal))
    return by_way <= max(_LONGEST_DETOUR * straight, straight + _LEAST_DETOUR)


def _disc(lat: float, lon: float) -> Any:
    import shapely
    import shapely.affinity

    disc = shapely.Point(lon, lat).buffer(PORT_RADIUS / _DEGREE, quad_segs=4)
    return shapely.affinity.scale(disc, 1.0 / max(np.cos(np.radians(lat)), 0.01), 1.0)


def _read_schemes() -> tuple[TrafficScheme, ...]:
    text = resources.files("thalweg.chart").joinpath("data/traffic_schemes.csv").read_text("utf-8")
    schemes = []
    for row in csv.DictReader(text.splitlines()):
        points = [point.split(",") for point in row["line"].split()]
        line = tuple((float(lat), float(lon)) for lat, lon in points)
        zone, starboard, port = (
            float(row[f"{part}_nm"]) * NAUTICAL_MILE for part in ("zone", "starboard", "port")
        )
        schemes.append(TrafficScheme(row["name"], line, zone, starboard, port, row["source"]))
    return tuple(schemes)


TRAFFIC_SCHEMES: Final = _read_schemes()  #: of `thalweg/chart/data/traffic_schemes.csv`
