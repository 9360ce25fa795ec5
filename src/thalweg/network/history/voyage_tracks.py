"""Ports and tracks of voyages between them as arrays, and positions along these."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from thalweg.chart.port_names import normalised_port_name
from thalweg.chart.ports import PORTS
from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.arrays.sphere_vectors import arc_of_chord
from thalweg.core.errors import InputError
from thalweg.core.geodesy import EQUATORIAL_RADIUS, FLATTENING, MEAN_RADIUS, Position, distance
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.core.units import NAUTICAL_MILE

_BESIDE: Final = 8.0 * NAUTICAL_MILE  # a port of the index so near to a sea end is the same
_BETWEEN_VOYAGES: Final = 1000.0  # by how much `along` grows from one voyage to the next [m]
_AXIS_RATIO_SQUARED: Final = (1.0 - FLATTENING) ** 2


def ellipsoid_vectors(lat: FloatArray, lon: FloatArray) -> FloatArray:
    """Return positions on the ellipsoid as vectors from its centre [m].

    Parameters
    ----------
    lat, lon : Positions [deg], (n,).

    Returns
    -------
    float64 ndarray (n, 3) : Earth-centred coordinates [m].
    """
    phi, lam = np.radians(lat), np.radians(lon)
    sine, cosine = np.sin(phi), np.cos(phi)
    normal = EQUATORIAL_RADIUS / np.sqrt(1.0 - (1.0 - _AXIS_RATIO_SQUARED) * sine * sine)
    return np.stack(
        [
            normal * cosine * np.cos(lam),
            normal * cosine * np.sin(lam),
            _AXIS_RATIO_SQUARED * normal * sine,
        ],
        axis=-1,
    )


def lengths_between(first: FloatArray, second: FloatArray) -> FloatArray:
    """Return the lengths along the surface between vectors of `ellipsoid_vectors`.

    From the chord c: ``2 R arcsin(c / 2R)`` with the mean radius R. The error is below 1e-6 of a
    length of 200 km, and below 1e-4 of one of 2,000 km.

    Parameters
    ----------
    first, second : ndarray (..., 3)
        Ends [m].

    Returns
    -------
    ndarray (...) : Lengths [m].
    """
    chord = np.sqrt(np.sum((second - first) ** 2, axis=-1))
    return MEAN_RADIUS * arc_of_chord(chord / MEAN_RADIUS)


@dataclass(frozen=True)
class HistoryPort:
    """A port of a history network.

    Parameters
    ----------
    name : Name and country.
    locode : UN/LOCODE, or empty.
    lat, lon : Where voyages begin and end at sea: the sea end of its approach [deg].
    approach_m : Length from the berth to that position [m].
    places : tuple of (lat, lon)
        Berth and approach [deg]: a ship that stops near them calls at this port.
    """

    name: str
    locode: str
    lat: float
    lon: float
    approach_m: float = 0.0
    places: tuple[Position, ...] = ()


@dataclass(frozen=True, eq=False)
class PortNames:
    """The names of the ports of a history network.

    Parameters
    ----------
    ports : The ports, P in total.
    by_name : Numbers of ports by normalised name, name without the country, and UN/LOCODE.
    """

    ports: tuple[HistoryPort, ...]
    by_name: dict[str, list[int]]

    @classmethod
    def of_ports(cls, ports: Sequence[HistoryPort]) -> PortNames:
        """Return the names of some ports."""
        found: dict[str, list[int]] = {}
        for number, port in enumerate(ports):
            names = (port.name, port.name.rpartition(",")[0], port.locode)
            for name in {normalised_port_name(name) for name in names} - {""}:
                found.setdefault(name, []).append(number)
        return cls(tuple(ports), found)

    def find(self, place: str) -> list[int]:
        """Return the numbers of the ports of a name.

        Parameters
        ----------
        place : UN/LOCODE, or the name with or without the country; or the name of a port of the
            World Port Index that has another name here, or lies beside a port of the network.
        """
        if found := self.by_name.get(normalised_port_name(place), []):
            return found
        try:
            port = PORTS.lookup(place)
        except InputError:
            return []
        for name in (port.locode, port.label):
            if found := self.by_name.get(normalised_port_name(name), []):
                return found
        away = [float(distance(port.lat, port.lon, one.lat, one.lon)) for one in self.ports]
        nearest = int(np.argmin(away)) if away else 0
        return [nearest] if away and away[nearest] <= _BESIDE else []


@dataclass(frozen=True, eq=False)
class TrackShips:
    """The ship of every voyage, V in total.

    Parameters
    ----------
    draught, length : [m], (V,); NaN where unknown.
    """

    draught: FloatArray
    length: FloatArray


@dataclass(frozen=True, eq=False)
class VoyageTracks:
    """Tracks of V voyages between ports, n positions in all.

    Parameters
    ----------
    ptr : The positions of voyage v are ``ptr[v]:ptr[v + 1]``, at least two, (V + 1,).
    time : [s since 1970-01-01T00:00Z], (n,).
    lat, lon : [deg], (n,).
    under_way : Time under way since the start of the voyage, without stops [s], (n,).
    broken : Whether the interval after a position is not observed (a gap), (n,).
    start, goal : Index of the ports, (V,).
    ships : Draught and length of the ship of every voyage.
    """

    ptr: IntArray
    time: FloatArray
    lat: FloatArray
    lon: FloatArray
    under_way: FloatArray
    broken: BoolArray
    start: IntArray
    goal: IntArray
    ships: TrackShips

    def __len__(self) -> int:
        return len(self.start)

    @cached_property
    def vectors(self) -> FloatArray:
        """Positions as vectors (n, 3) from the centre of the ellipsoid [m]."""
        return ellipsoid_vectors(self.lat, self.lon)

    @cached_property
    def voyage(self) -> IntArray:
        """The voyage of every position (n,)."""
        return np.repeat(np.arange(len(self)), np.diff(self.ptr))

    @cached_property
    def steps(self) -> FloatArray:
        """Length from every position to the next of the same voyage (n,) [m]; 0 at the last."""
        steps = np.append(lengths_between(self.vectors[:-1], self.vectors[1:]), 0.0)
        steps[self.ptr[1:] - 1] = 0.0
        return steps

    @cached_property
    def along(self) -> FloatArray:
        """Distance sailed (n,) [m], ascending over all voyages, with a jump between them."""
        steps = self.steps.copy()
        steps[self.ptr[1:] - 1] = _BETWEEN_VOYAGES
        return cumulative_sums(steps)[:-1]

    @cached_property
    def unobserved(self) -> FloatArray:
        """Distance in gaps (n,) [m], summed over all positions before each."""
        return cumulative_sums(np.where(self.broken, self.steps, 0.0))[:-1]

    def vectors_at(self, along: FloatArray) -> FloatArray:
        """Return positions as vectors on the sphere of mean radius.

        Parameters
        ----------
        along : ndarray (...)
            Values of the attribute ``along`` [m].

        Returns
        -------
        float64 ndarray (..., 3)
            From the centre of the ellipsoid [m]; between two positions on the great circle.
        """
        found = np.stack(
            [np.interp(along, self.along, self.vectors[:, k]) for k in range(3)], axis=-1
        )
        return found * (MEAN_RADIUS / np.sqrt(np.sum(found**2, axis=-1, keepdims=True)))

    def values_at(self, values: FloatArray, along: FloatArray) -> FloatArray:
        """Return values given at the positions (n,), linear in the distance sailed.

        Parameters
        ----------
        values : One for each position, (n,).
        along : ndarray (...)
            Values of the attribute ``along`` [m].

        Returns
        -------
        float64 ndarray (...) : In the unit of the values.
        """
        return np.asarray(np.interp(along, self.along, values))


def port_vectors(ports: Sequence[HistoryPort]) -> FloatArray:
    """Return the positions at sea of ports as vectors (P, 3) on the sphere of mean radius [m]."""
    return sphere_vectors(
        np.array([port.lat for port in ports]), np.array([port.lon for port in ports])
    )


def sphere_vectors(lat: FloatArray, lon: FloatArray) -> FloatArray:
    """Return the directions of positions on the ellipsoid, scaled to the mean radius.

    Parameters
    ----------
    lat, lon : Positions [deg], (n,).

    Returns
    -------
    float64 ndarray (n, 3) : From the centre of the ellipsoid [m].
    """
    found = ellipsoid_vectors(np.asarray(lat, float), np.asarray(lon, float))
    return found * (MEAN_RADIUS / np.sqrt(np.sum(found**2, axis=-1, keepdims=True)))
