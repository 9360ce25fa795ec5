"""A track: waypoints, departure, waits and speeds, before it is evaluated."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.errors import InputError
from thalweg.core.geodesy import Position, check_position, distance, wrap_longitude
from thalweg.core.given_numbers import float_array, shortened_repr
from thalweg.core.time import TimeLike, parse_time
from thalweg.core.types import FloatArray
from thalweg.route.carried_extensions import NO_EXTENSIONS, CarriedExtensions

TOP_SETTING = -1  #: the ship's highest speed setting, counted from the end as in Python
_FIELDS = ("lat", "lon", "depart", "wait", "setting", "speed", "extensions", "given_leg")


@dataclass(frozen=True, eq=False)
class Track:
    """Waypoints joined by geodesics, with waits, a departure and a speed setting for each leg.

    Parameters
    ----------
    lat, lon : array_like of float, shape (n,)
        Waypoints [deg], n >= 2; longitudes are wrapped to [-180, 180).
    wait : array_like of float, shape (n,), optional
        Waiting time at each waypoint before departure from it [s], >= 0; the last is 0. None: no
        waits.
    depart : float
        Departure [s since 1970-01-01T00:00Z]. The wait at the first waypoint comes after it.
    setting : array_like of int, shape (n - 1,), optional
        Index into the ship's speeds for each leg; negative numbers count from the top as in
        Python. None: the highest on every leg.
    speed : array_like of float, shape (n - 1,), optional
        Ordered calm-water speed on each leg [m/s]; it overrides the setting. NaN (or None): the
        setting is used. Files contain speeds, since they are independent of a ship.
    extensions : CarriedExtensions, optional
        Extensions of other makers in the RTZ file that it was read from; RTZ files that are written
        of it have them too.
    given_leg : array_like of int, shape (n - 1,), optional
        The leg of the given route that each leg is a part of, from 1, where rhumb lines of a file
        were broken into geodesics; results name it. None: each leg is its own.

    Raises
    ------
    InputError
        For fewer than two waypoints, unequal lengths, positions or times that are not numbers.
    """

    lat: FloatArray
    lon: FloatArray
    depart: float
    wait: FloatArray = None  # type: ignore[assignment]
    setting: NDArray[np.int64] = None  # type: ignore[assignment]
    speed: FloatArray = None  # type: ignore[assignment]
    extensions: CarriedExtensions = NO_EXTENSIONS
    given_leg: NDArray[np.int64] | None = None

    def __post_init__(self) -> None:
        lat = float_array(self.lat, "latitudes").reshape(-1)
        lon = float_array(self.lon, "longitudes").reshape(-1)
        _check_positions(lat, lon)
        count = len(lat)
        wait = np.zeros(count) if self.wait is None else float_array(self.wait, "waits")
        if self.setting is None:
            setting = np.full(count - 1, TOP_SETTING, dtype=np.int64)
        else:
            setting = np.array(self.setting, dtype=np.int64)
        _check_lengths(count, wait, setting)
        no_speed = self.speed is None
        speed = np.full(count - 1, math.nan) if no_speed else float_array(self.speed, "speeds")
        _check_speeds(count, speed)
        depart = parse_time(self.depart)
        fields = {"lat": lat, "lon": wrap_longitude(lon), "wait": wait, "setting": setting}
        fields["speed"] = speed
        if self.given_leg is not None:
            number = np.array(self.given_leg, dtype=np.int64)
            object.__setattr__(self, "given_leg", number if number.shape == (count - 1,) else None)
        for name, values in fields.items():
            values.setflags(write=False)
            object.__setattr__(self, name, values)
        object.__setattr__(self, "depart", depart)

    @classmethod
    def from_positions(
        cls,
        positions: Iterable[Sequence[float]],
        *,
        depart: TimeLike,
        setting: int = TOP_SETTING,
    ) -> Track:
        """Return a track without waits through positions; repeated positions are merged.

        Parameters
        ----------
        positions : iterable of (lat, lon)
            Waypoints [deg], two or more that differ.
        depart : time
            Departure.
        setting : int, optional
            Index into the ship's speeds on all legs; by default the highest.

        Returns
        -------
        Track
            The track.

        Raises
        ------
        InputError
            If positions or the departure cannot be read.
        """
        pairs = _pairs(positions)
        keep = [pairs[0], *(b for a, b in itertools.pairwise(pairs) if a != b)] if pairs else []
        lat, lon = np.array(keep, dtype=float).reshape(-1, 2).T
        return cls(lat, lon, parse_time(depart), None, np.full(max(len(lat) - 1, 0), setting))  # type: ignore[arg-type]

    @classmethod
    def along_path(
        cls,
        lat: FloatArray,
        lon: FloatArray,
        *,
        arrive: ArrayLike,
        depart: ArrayLike,
        setting: ArrayLike,
    ) -> Track:
        """Return the track of a path that a search found, with its waits.

        A later departure than arrival is a wait. Waits below 1 s are rounding and are left out, and
        there is none at the last node.

        Parameters
        ----------
        lat, lon : ndarray (n,)
            Nodes of the path [deg].
        arrive, depart : array_like (n,)
            Arrival at and departure from the nodes [s since 1970-01-01T00:00Z].
        setting : array_like
            Index into the ship's speeds, of all legs or (n - 1,).

        Returns
        -------
        Track
            Through all nodes.
        """
        arrived = np.asarray(arrive, float)
        wait = np.asarray(depart, float) - arrived
        wait[-1] = 0.0
        wait = np.where(wait < 1.0, 0.0, wait)
        settings = np.broadcast_to(np.asarray(setting, np.int64), (len(lat) - 1,))
        return cls(lat, lon, float(arrived[0]), wait, settings)

    def __len__(self) -> int:
        return len(self.lat)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Track):
            return NotImplemented
        return self.depart == other.depart and all(
            np.array_equal(getattr(self, name), getattr(other, name), equal_nan=True)
            for name in ("lat", "lon", "wait", "setting", "speed")
        )

    __hash__ = None  # type: ignore[assignment]

    @property
    def lengths(self) -> FloatArray:
        """Geodesic length of each leg [m]."""
        return distance(self.lat[:-1], self.lon[:-1], self.lat[1:], self.lon[1:])

    @property
    def leg_numbers(self) -> NDArray[np.int64]:
        """Number of the leg of the given route that each leg is a part of, from 1."""
        return np.arange(1, len(self)) if self.given_leg is None else self.given_leg

    @property
    def positions(self) -> list[Position]:
        """The waypoints as (lat, lon) pairs [deg]."""
        return list(zip(self.lat.tolist(), self.lon.tolist()))

    def replaced(self, **changes: Any) -> Track:
        """Return a copy with some fields changed.

        Parameters
        ----------
        **changes
            By the names ``lat``, ``lon``, ``depart``, ``wait``, ``setting``, ``speed``,
            ``extensions`` and ``given_leg``.

        Returns
        -------
        Track
            The changed track.
        """
        fields = {name: getattr(self, name) for name in _FIELDS}
        return Track(**{**fields, **changes})

    def kept(self, keep: ArrayLike) -> Track:
        """Return the track through some of its waypoints.

        Parameters
        ----------
        keep : array_like of int
            Ascending indices of the waypoints to keep, first and last included. A joined leg has
            the setting (and speed) of its first part; waits at removed waypoints are removed.

        Returns
        -------
        Track
            With the waypoints kept.
        """
        index = np.asarray(keep, dtype=np.int64)
        return Track(
            self.lat[index],
            self.lon[index],
            self.depart,
            self.wait[index],
            self.setting[index[:-1]],
            self.speed[index[:-1]],
            given_leg=None if self.given_leg is None else self.given_leg[index[:-1]],
        )

    def part(self, first: int, last: int, depart: float) -> Track:
        """Return the track between two of its waypoints.

        Parameters
        ----------
        first, last : int
            Indices of its first and last waypoint.
        depart : float
            Departure from the first of them [s since 1970-01-01T00:00Z].

        Returns
        -------
        Track
            With the wait at its first waypoint, without that at its last.
        """
        wait = np.append(self.wait[first:last], 0.0)
        lat, lon = self.lat[first : last + 1], self.lon[first : last + 1]
        return Track(lat, lon, depart, wait, self.setting[first:last], self.speed[first:last])

    def with_part(self, first: int, last: int, part: Track) -> Track:
        """Return the track with another one between two of its waypoints.

        Parameters
        ----------
        first, last : int
            Indices of the waypoints between which the track is replaced.
        part : Track
            What takes its place; its departure has no effect.

        Returns
        -------
        Track
            With the departure of this track.
        """
        return Track(
            np.concatenate([self.lat[:first], part.lat, self.lat[last + 1 :]]),
            np.concatenate([self.lon[:first], part.lon, self.lon[last + 1 :]]),
            self.depart,
            np.concatenate([self.wait[:first], part.wait[:-1], self.wait[last:]]),
            np.concatenate([self.setting[:first], part.setting, self.setting[last:]]),
            np.concatenate([self.speed[:first], part.speed, self.speed[last:]]),
        )


def _pairs(positions: Iterable[Sequence[float]]) -> list[Position]:
    if not isinstance(positions, Iterable):
        raise InputError(
            f"The route is {shortened_repr(positions)}, which is not a list of waypoints.",
            "A route is a Track, a Route, a file or pairs (lat, lon) in degrees.",
            "Give one of these.",
        )
    pairs = []
    for number, pair in enumerate(positions, start=1):
        count = len(pair) if isinstance(pair, (Sequence, np.ndarray)) else 0
        if count != 2 or isinstance(pair, str):
            raise InputError(
                f"Waypoint {number} is {shortened_repr(pair)}.",
                "A waypoint is a pair (lat, lon) in degrees.",
                "Give pairs.",
                waypoint=number,
            )
        pairs.append(check_position(pair[0], pair[1], f"waypoint {number}"))
    return pairs


def _check_positions(lat: FloatArray, lon: FloatArray) -> None:
    if len(lat) != len(lon):
        raise InputError(
            f"A track has {len(lat)} latitudes and {len(lon)} longitudes.",
            "Each waypoint has one of each.",
            "Give two lists of one length.",
        )
    if len(lat) < 2:
        raise InputError(
            f"A track of {len(lat)} waypoint{'' if len(lat) == 1 else 's'} cannot be sailed.",
            "A track has at least two different waypoints.",
            "Give the start and the goal.",
            waypoints=len(lat),
        )
    bad = ~(np.isfinite(lat) & np.isfinite(lon)) | (np.abs(lat) > 90.0) | (np.abs(lon) > 360.0)
    if bad.any():
        first = int(np.argmax(bad))
        check_position(lat[first], lon[first], f"waypoint {first + 1}")


def _check_lengths(count: int, wait: FloatArray, setting: NDArray[np.int64]) -> None:
    if wait.shape != (count,) or setting.shape != (count - 1,):
        raise InputError(
            f"A track of {count} waypoints has {wait.size} waits and {setting.size} settings.",
            f"It needs {count} waits and {count - 1} settings.",
            "Leave them out, or give one wait per waypoint and one setting per leg.",
        )
    if not np.all(wait >= 0.0) or not np.all(np.isfinite(wait)) or wait[-1] != 0.0:
        raise InputError(
            "A track has a wait that is negative, not a number, or at its last waypoint.",
            "Waits are seconds, zero or more, and end before the goal.",
            "Correct the waits.",
        )


def _check_speeds(count: int, speed: FloatArray) -> None:
    if speed.shape != (count - 1,) or not np.all(np.isnan(speed) | (speed > 0.0)):
        raise InputError(
            f"A track of {count} waypoints has ordered speeds {speed.tolist()!r}.",
            f"It needs {count - 1}, above zero, NaN where the setting is used.",
            "Leave them out, or give one speed per leg [m/s].",
        )
