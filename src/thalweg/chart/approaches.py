"""Port approaches: the line from the berth of a port to open sea.

Harbours and rivers are land on most coastlines, or water that leads nowhere. The table
``data/port_approaches.csv.gz`` has a line for each port from its berth to its sea end, the first
place two nautical miles from land in the open sea. A ship sails this line at no more than
her speed in approaches, `MAX_APPROACH_SPEED` if she gives none; voyages are optimised from sea end
to sea end. The lines are made by ``tools/make_port_approaches.py``: the best way in the coastline
GSHHG h, or by hand where that coastline does not show the water. They are for planning and are not
surveyed.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray

from thalweg.chart.approach_branches import approach_branches
from thalweg.chart.port_limits.port_draughts import port_draughts
from thalweg.chart.ports import PORTS, Port
from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.arrays.numbered_parts import numbered_parts
from thalweg.core.file_reading import table_rows
from thalweg.core.geodesy import (
    METRES_PER_DEGREE,
    Position,
    distance,
    line_length,
    longitude_difference,
)
from thalweg.core.types import FloatArray
from thalweg.core.units import KNOT, NAUTICAL_MILE

MAX_APPROACH_SPEED: Final = 10.0 * KNOT  #: speed over ground in approaches [m/s]
ON_LINE: Final = 100.0  #: a position within this distance of a line is on it [m]
_CELL: Final = 0.25  # side of the cells by which segments are found [deg]
_TURN: Final = round(360.0 / _CELL)
_LENGTH_TOLERANCE: Final = 0.02  # of a leg that follows a line, relative
#: Lines are joined where they are this close with only water between them [m].
LONGEST_JOINT: Final = 1.0 * NAUTICAL_MILE
JOINED_WITHIN: Final = 2.0 * NAUTICAL_MILE  #: a position in a harbour joins a line so near [m]
JOINT_SPACING: Final = 0.1 * NAUTICAL_MILE  #: of the places of dense lines [m]


@dataclass(frozen=True)
class PortApproach:
    """The approach of one port.

    Attributes
    ----------
    line : tuple of (lat, lon)
        From the berth to the sea end [deg].
    half_width : float
        Least distance from the charted part of the line to land [m]; NaN if none is charted.
    quality : "computed", "by hand" or "checked" (by hand and compared with a source).
    max_draught, max_length : Of ships, in the World Port Index [m]; NaN where unknown.
    draught_source : Of the draught, where `port_limits.port_draughts` replaces the index.
    way : By which channel or to which canal, where it is not the main way ("by Fedjeosen").
    canal : Name of the canal that the line leads to, or empty.
    way_draught, way_length : Of the largest ships that use this way [m]; inf without a limit.
    through : Name of the canal that the line leads through, or empty.
    through_length, through_time : Of the part in that canal [m, s].
    """

    port: Port
    line: tuple[Position, ...]
    half_width: float
    quality: str
    source: str
    max_draught: float = float("nan")
    max_length: float = float("nan")
    draught_source: str = ""
    way: str = ""
    canal: str = ""
    way_draught: float = math.inf
    way_length: float = math.inf
    through: str = ""
    through_length: float = 0.0
    through_time: float = 0.0

    @property
    def label(self) -> str:
        """Name and country of the port, and its way if it is not the main one."""
        return f"{self.port.label} {self.way}".rstrip()

    @property
    def berth(self) -> Position:
        """The berth (lat, lon) [deg]."""
        return self.line[0]

    @property
    def sea_end(self) -> Position:
        """The end in open sea (lat, lon) [deg]."""
        return self.line[-1]

    @cached_property
    def length(self) -> float:
        """Length of the line [m]."""
        return line_length(self.line)

    def duration(self, speed: float) -> float:
        """Return the time along the line [s] at a speed [m/s], in a canal at that of the canal."""
        return (self.length - self.through_length) / speed + self.through_time


@dataclass(frozen=True)
class PortApproaches:
    """The approaches of all ports, read on first use."""

    def of(self, port: Port) -> PortApproach | None:
        """Return the approach of a port; None where it has none (see `reason`)."""
        row = self._rows.get(port)
        if port not in self._made and row and row["line"]:
            self._made[port] = _approach_of(port, row)
        return self._made.get(port)

    def reason(self, port: Port) -> str:
        """Return why a port has no approach; empty where it has one or is not in the table."""
        row = self._rows.get(port)
        return row["source"] if row and not row["line"] else ""

    @cached_property
    def all(self) -> tuple[PortApproach, ...]:
        """Every approach of the table."""
        every = (self.of(port) for port in self._rows)
        return tuple(approach for approach in every if approach is not None)

    def nearest(self, lat: float, lon: float, *, within: float) -> tuple[Port, float] | None:
        """Return the nearest port with an approach and its distance [m]; None if none is near.

        Parameters
        ----------
        lat, lon : Position [deg].
        within : Largest distance [m].
        """
        ports = self._ports_with_approach
        near = np.abs(ports[1] - lat) * METRES_PER_DEGREE <= 1.01 * within
        which = np.flatnonzero(near)
        if not len(which):
            return None
        apart = np.asarray(distance(lat, lon, ports[1][which], ports[2][which]))
        best = int(np.argmin(apart))
        return (ports[0][which[best]], float(apart[best])) if apart[best] <= within else None

    def legs(self, lat: FloatArray, lon: FloatArray) -> NDArray[np.bool_]:
        """Return which legs of a track run along approaches.

        A leg does if both ends lie within `ON_LINE` of one line and it is as long as the line
        between them, or if it is a joint from one line to another one.

        Parameters
        ----------
        lat, lon : Waypoints [deg], (n,).

        Returns
        -------
        bool array (n - 1,)
        """
        found = np.zeros(len(lat) - 1, np.bool_)
        here = self._lines_at(float(lat[0]), float(lon[0]))
        for leg in range(len(found)):
            there = self._lines_at(float(lat[leg + 1]), float(lon[leg + 1]))
            if here and there:
                length = float(distance(lat[leg], lon[leg], lat[leg + 1], lon[leg + 1]))
                slack = 2.0 * ON_LINE + _LENGTH_TOLERANCE * length
                found[leg] = length <= LONGEST_JOINT or any(
                    abs(abs(there[line] - along) - length) <= slack
                    for line, along in here.items()
                    if line in there
                )
            here = there
        return found

    def is_on_line(self, lat: float, lon: float) -> bool:
        """Return whether a position [deg] is within `ON_LINE` of the line of any approach."""
        return bool(self._lines_at(lat, lon))

    def lines_near(
        self, lat: float, lon: float, *, within: float
    ) -> list[tuple[PortApproach, float, float]]:
        """Return the approaches that pass a position, and how far along each and how far off.

        Parameters
        ----------
        lat, lon : Position [deg].
        within : Greatest distance from the line [m].

        Returns
        -------
        list of (approach, metres from the berth, metres from the position)
        """
        near = np.flatnonzero(np.abs(self._segments[0] - lat) < 1.0)  # no leg is that long
        found = self._nearest_places(lat, lon, near, within)
        return [(self.all[k], *place) for k, place in found.items() if k < len(self.all)]

    def _lines_at(self, lat: float, lon: float) -> dict[int, float]:
        """Return the lines on which a position lies, and how far along each [m]."""
        near = self._segments_by_cell.get(_cell(lat, lon))
        found = {} if near is None else self._nearest_places(lat, lon, near, ON_LINE)
        return {line: along for line, (along, _apart) in found.items()}

    def _nearest_places(
        self, lat: float, lon: float, segments: NDArray[np.int64], within: float
    ) -> dict[int, tuple[float, float]]:
        """Return the nearest place on each line: how far along it and how far off [m]."""
        a_lat, a_lon, b_lat, b_lon, start, line = (column[segments] for column in self._segments)
        scale = np.cos(np.radians(lat))
        bx, by = longitude_difference(b_lon, a_lon) * scale, b_lat - a_lat
        px, py = longitude_difference(lon, a_lon) * scale, lat - a_lat
        share = np.clip((px * bx + py * by) / np.maximum(bx**2 + by**2, 1e-18), 0.0, 1.0)
        apart = np.hypot(px - share * bx, py - share * by) * METRES_PER_DEGREE
        along = start + share * np.hypot(bx, by) * METRES_PER_DEGREE
        on = np.flatnonzero(apart <= within)
        far_to_near = on[np.argsort(-apart[on], kind="stable")]
        return {int(line[k]): (float(along[k]), float(apart[k])) for k in far_to_near}

    @cached_property
    def _segments(self) -> tuple[FloatArray, ...]:
        """Ends [deg] of all segments, distance of the first along its line [m], and its line."""
        lines = [approach.line for approach in self.all]
        lines += [branch.line for branch in approach_branches()]
        if not lines:
            return tuple(np.empty((6, 0)))
        count = np.array([len(line) for line in lines])
        vertices = np.array(list(itertools.chain.from_iterable(lines)), float)
        last = np.cumsum(count) - 1
        begin = np.delete(np.arange(len(vertices)), last)
        a, b = vertices[begin], vertices[begin + 1]
        sailed = cumulative_sums(distance(*a.T, *b.T))[:-1]
        first = np.concatenate([[0], last[:-1] + 1]) - np.arange(len(lines))
        whose = np.repeat(np.arange(len(lines)), count - 1)
        start = sailed - sailed[np.minimum(first, len(sailed) - 1)][whose]
        return (*a.T, *b.T, start, whose.astype(float))

    @cached_property
    def _segments_by_cell(self) -> dict[tuple[int, int], NDArray[np.int64]]:
        """The segments in each cell, and in those within a few hundred metres."""
        a_lat, a_lon, b_lat, b_lon = self._segments[:4]
        b_lon = a_lon + longitude_difference(b_lon, a_lon)
        low, high = (
            np.floor(edge / _CELL).astype(np.int64)
            for edge in (np.minimum(a_lat, b_lat) - 0.01, np.maximum(a_lat, b_lat) + 0.01)
        )
        left, right = (
            np.floor(edge / _CELL).astype(np.int64)
            for edge in (np.minimum(a_lon, b_lon) - 0.05, np.maximum(a_lon, b_lon) + 0.05)
        )
        across = right - left + 1
        cells = (high - low + 1) * across
        which, number = numbered_parts(cells)
        row = low[which] + number // across[which]
        column = (left[which] + number % across[which]) % _TURN
        order = np.lexsort((which, column, row))
        row, column, which = row[order], column[order], which[order]
        new = np.flatnonzero((np.diff(row) != 0) | (np.diff(column) != 0)) + 1
        first = np.concatenate([[0], new])[: len(which)]
        keys = zip(row[first].tolist(), column[first].tolist())
        return dict(zip(keys, np.split(which, new)))

    @cached_property
    def _made(self) -> dict[Port, PortApproach]:
        """The approaches made so far."""
        return {}

    @cached_property
    def _ports_with_approach(self) -> tuple[list[Port], FloatArray, FloatArray]:
        ports = [port for port, row in self._rows.items() if row["line"]]
        return ports, np.array([p.lat for p in ports]), np.array([p.lon for p in ports])

    @cached_property
    def _rows(self) -> dict[Port, dict[str, str]]:
        """The rows of the table by port."""
        by_key = {(p.locode, p.name, p.country_code): p for p in PORTS.all}
        rows = table_rows("thalweg.chart", "port_approaches.csv.gz")
        named = ((by_key.get((r["unlocode"], r["name"], r["country_code"])), r) for r in rows)
        return {port: row for port, row in named if port is not None}


def line_part(line: tuple[Position, ...], along: float) -> list[Position]:
    """Return the vertices of a line up to a distance [m] from its start, and the place there."""
    part, sailed = [line[0]], 0.0
    for a, b in itertools.pairwise(line):
        length = _metres(a, b)
        if sailed + length >= along - 1.0:
            share = (along - sailed) / length if length > 0.0 else 0.0
            turn = longitude_difference(b[1], a[1])
            part.append((a[0] + share * (b[0] - a[0]), a[1] + share * turn))
            break
        part.append(b)
        sailed += length
    return part


def place_along_line(line: tuple[Position, ...], place: Position) -> float | None:
    """Return how far along a line a position lies [m]; None if it is not within `ON_LINE` of it."""
    sailed, best, nearest = 0.0, None, ON_LINE
    for a, b in itertools.pairwise(line):
        length = _metres(a, b)
        scale = math.cos(math.radians(a[0]))
        bx, by = longitude_difference(b[1], a[1]) * scale, b[0] - a[0]
        px, py = longitude_difference(place[1], a[1]) * scale, place[0] - a[0]
        share = min(max((px * bx + py * by) / max(bx**2 + by**2, 1e-18), 0.0), 1.0)
        apart = math.hypot(px - share * bx, py - share * by) * METRES_PER_DEGREE
        if apart <= nearest:
            best, nearest = sailed + share * length, apart
        sailed += length
    return best


def dense_line(line: tuple[Position, ...]) -> FloatArray:
    """Return rows (lat, lon [deg], distance from the first [m]) at most `JOINT_SPACING` apart."""
    rows, sailed = [(*line[0], 0.0)], 0.0
    for a, b in itertools.pairwise(line):
        length = _metres(a, b)
        turn = longitude_difference(b[1], a[1])
        for share in np.linspace(0.0, 1.0, int(length / JOINT_SPACING) + 2)[1:]:
            place = (a[0] + share * (b[0] - a[0]), a[1] + share * turn, sailed + share * length)
            rows.append(place)
        sailed += length
    return np.array(rows)


def _metres(a: Position, b: Position) -> float:
    return float(distance(*a, *b))


def _cell(lat: float, lon: float) -> tuple[int, int]:
    return int(lat // _CELL), int(lon // _CELL) % _TURN


def _approach_of(port: Port, row: dict[str, str]) -> PortApproach:
    pairs = (pair.split(",") for pair in row["line"].split())
    row = row | port_draughts().get(row["unlocode"] or port.label, {})
    return PortApproach(
        port,
        tuple((float(lat), float(lon)) for lat, lon in pairs),
        float(row["half_width_nm"] or "nan") * NAUTICAL_MILE,
        row["quality"],
        row["source"],
        float(row.get("max_draught_m") or "nan"),
        float(row.get("max_length_m") or "nan"),
        row.get("draught_source", ""),
    )


PORT_APPROACHES = PortApproaches()
