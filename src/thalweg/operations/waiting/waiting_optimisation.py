"""Departure rules: when to leave on each of several trips in tidal currents.

In Schless (2023), *Going with the flow*, a dredger waits at either end of its trips until the
current is favourable. That rule can be compared with two others and with the optimum:

``none``
    Sail as soon as the trip can be made.
``current``
    The rule of Schless: within the allowed wait, leave when the current at the place of departure
    is most favourable along the course. The rule ignores the cross current and all later currents,
    and can lose energy.
``next trip``
    Leave when the next trip, with the wait before it, needs least energy. Never worse than ``none``
    for a single trip; over several trips it can be, because it ignores the trips after the next.
``optimum``
    The departures of all trips together that need least energy, by dynamic programming from the
    last trip backwards.

All rules choose from the departures of the trip tables; a ship that is ready between two of them
leaves at the later one. On these departures the optimum is exact.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import CoverageError, InputError, unknown_name_error
from thalweg.core.time import TimeLike, format_time, parse_time
from thalweg.core.types import FloatArray
from thalweg.deprecated_names import renamed_arguments
from thalweg.operations.waiting.trip_table import TripTable

DEPARTURE_RULES: Final = ("none", "current", "next trip", "optimum")


@dataclass(frozen=True)
class WaitingPlan:
    """Departures of all trips, and the total energy.

    Attributes
    ----------
    rule : str
    start : float
        When the ship is ready for the first trip [s since 1970-01-01T00:00Z].
    departs, arrives : tuple of float
        Of every trip [s since 1970-01-01T00:00Z].
    energy : float
        Brake energy under way and hotel energy from the start to the last arrival [J].
    """

    rule: str
    start: float
    departs: tuple[float, ...]
    arrives: tuple[float, ...]
    energy: float

    @property
    def duration(self) -> float:
        """Time from the start to the last arrival [s]."""
        return self.arrives[-1] - self.start

    @property
    def waited(self) -> float:
        """Time not under way [s]."""
        return self.duration - sum(b - a for a, b in zip(self.departs, self.arrives))


@renamed_arguments(most_wait="max_wait")
def plan_waiting(
    trips: Sequence[TripTable],
    *,
    start: TimeLike,
    max_wait: float,
    hotel_power: float = 0.0,
    rule: str = "optimum",
) -> WaitingPlan:
    """Choose the departures of trips that follow each other.

    Parameters
    ----------
    trips : sequence of TripTable
        In the order in which they are sailed, all with the same departures.
    start : time
        When the ship is ready for the first.
    max_wait : float
        Longest wait before each trip [s], at least 0, counted from when the trip can be made.
    hotel_power : float
        Power used all the time, also while waiting [W].
    rule : {"none", "current", "next trip", "optimum"}

    Returns
    -------
    WaitingPlan

    Raises
    ------
    CoverageError
        If the tables end before the last trip does.
    InputError
        If the tables have different departures, or a number is out of range.
    """
    if rule not in DEPARTURE_RULES:
        raise unknown_name_error("waiting rule", rule, DEPARTURE_RULES)
    grid = _DepartureGrid.of(trips, max_wait if rule != "none" else 0.0, hotel_power)
    first = grid.index(parse_time(start))
    return grid.follow(rule, first, grid.values() if rule == "optimum" else None)


@renamed_arguments(most_wait="max_wait")
def optimum_energy(
    trips: Sequence[TripTable], *, max_wait: float, hotel_power: float = 0.0
) -> FloatArray:
    """Return the least energy of a sequence of trips, for every start in the tables.

    Parameters
    ----------
    trips : sequence of TripTable
        In the order in which they are sailed; tables with one step.
    max_wait : float
        Longest wait before each trip [s], 0 or more.
    hotel_power : float, optional
        Power while waiting [W].

    Returns
    -------
    float64 array (starts,)
        Energy [J], that of waiting included; +inf for starts from which the tables end too
        early.
    """
    grid = _DepartureGrid.of(trips, max_wait, hotel_power)
    return grid.best_from(grid.values()[0], trips[0])[: len(trips[0])]


@dataclass(frozen=True, eq=False)
class _DepartureGrid:
    """Trips over one grid of departures."""

    trips: tuple[TripTable, ...]
    width: int  # longest wait [steps]
    hotel: float  # energy of one step of hotel load [J]

    @classmethod
    def of(cls, trips: Sequence[TripTable], max_wait: float, hotel_power: float) -> _DepartureGrid:
        _check_trips(trips)
        for name, value, unit in (
            ("longest wait", max_wait, "s"),
            ("hotel power", hotel_power, "W"),
        ):
            if not (math.isfinite(value) and value >= 0.0):
                raise InputError(
                    f"The {name} is {value!r} {unit}.",
                    "It is zero or more.",
                    "Correct it.",
                )
        table = trips[0]
        width = int(max_wait / table.step + 1e-9)
        if table.periodic:  # after a whole period the table repeats
            width = min(width, len(table) - 1)
        return cls(tuple(trips), min(width, len(table)), hotel_power * table.step)

    @property
    def first(self) -> TripTable:
        return self.trips[0]

    def index(self, time: float) -> int:
        """Return the first departure at or after a time."""
        index = math.ceil((time - self.first.start) / self.first.step - 1e-9)
        if not self.first.periodic and not 0 <= index < len(self.first):
            raise self._too_short(time)
        return index

    def window(self, index: int, trip: TripTable) -> NDArray[np.int64]:
        """Return the departures allowed for a ship that is ready at ``index``."""
        count = len(trip)
        possible = np.isfinite(trip.duration)
        if not possible.any():
            raise _no_departure_error(trip)
        if trip.periodic:
            possible_at = index + np.flatnonzero(possible[(index + np.arange(count)) % count])
        else:
            possible_at = index + np.flatnonzero(possible[index:])
        if not possible_at.size:
            raise self._too_short(trip.start + index * trip.step)
        return np.asarray(possible_at[possible_at <= possible_at[0] + self.width], dtype=np.int64)

    def cost(self, trip: TripTable, at: NDArray[np.int64], last: bool) -> FloatArray:
        """Return the energy [J] of a trip and of the time until the next can begin."""
        i = at % len(trip)
        known = np.where(np.isfinite(trip.duration), trip.duration, 0.0)
        time = known[i] / trip.step if last else trip.steps[i]
        return np.asarray(trip.energy[i] + self.hotel * time)

    def values(self) -> list[FloatArray]:
        """Return for every trip the energy from each departure to the end [J].

        The hotel energy of ``s`` steps is added for a departure ``s``, so that the best departure
        of a window is the one with the least value.
        """
        count = len(self.first)
        reach = 2 * count + self.width if self.first.periodic else count
        at = np.arange(reach, dtype=np.int64)
        per_trip: list[FloatArray] = []
        later = None
        for k in range(len(self.trips) - 1, -1, -1):
            trip = self.trips[k]
            total = self.cost(trip, at, later is None)
            if later is not None:
                total = total + self._energy_after_arrival(trip, at, later)
            per_trip.append(np.where(np.isfinite(total), total + self.hotel * at, np.inf))
            later = self.best_from(per_trip[-1], trip)
        return per_trip[::-1]

    def _energy_after_arrival(
        self, trip: TripTable, at: NDArray[np.int64], later: FloatArray
    ) -> FloatArray:
        """Return the energy [J] after arrival, for departures ``at``."""
        count = len(trip)
        ready = at + trip.steps[at % count]
        if trip.periodic:
            return np.asarray(later[ready % count])
        inside = ready < count
        return np.where(inside, later[np.where(inside, ready, 0)], np.inf)

    def best_from(self, values: FloatArray, trip: TripTable) -> FloatArray:
        """Return the least energy [J] of a ship that is ready for a trip at each departure."""
        count = len(trip)
        least = _windowed_minimum(values, self.width)
        at = np.arange(len(values))
        possible_at = np.where(np.isfinite(trip.duration[at % count]), at, len(values))
        possible_at = np.minimum.accumulate(possible_at[::-1])[::-1]
        padded = np.append(least, np.inf)
        return np.asarray(padded[possible_at] - self.hotel * at)[:count]

    def follow(self, rule: str, index: int, values: list[FloatArray] | None) -> WaitingPlan:
        """Return the plan of all trips by a rule, from the departure ``index``."""
        ready, energy = index, 0.0
        departs, arrives = [], []
        for k, trip in enumerate(self.trips):
            last = k == len(self.trips) - 1
            at = self._choose(rule, ready, k, values)
            energy += self.hotel * (at - ready) + float(self.cost(trip, np.array([at]), last)[0])
            departs.append(trip.start + trip.step * at)
            arrives.append(departs[-1] + float(trip.duration[at % len(trip)]))
            ready = at + int(trip.steps[at % len(trip)])
            if not (last or trip.periodic or ready < len(trip)):
                raise self._too_short(arrives[-1])
        start = self.first.start + self.first.step * index
        return WaitingPlan(rule, start, tuple(departs), tuple(arrives), energy)

    def _choose(self, rule: str, ready: int, k: int, values: list[FloatArray] | None) -> int:
        trip = self.trips[k]
        allowed = self.window(ready, trip)
        if rule == "none":
            return int(allowed[0])
        if values is not None:
            turn = ready - ready % len(trip) if trip.periodic else 0
            padded = np.append(values[k], np.inf)
            wanted = padded[np.minimum(allowed - turn, len(values[k]))]
            if not np.isfinite(wanted).any():
                raise self._too_short(trip.start + ready * trip.step)
        elif rule == "current":
            wanted = -trip.current[allowed % len(trip)]
        else:
            wanted = self.cost(trip, allowed, True) + self.hotel * (allowed - ready)
        return int(allowed[np.argmin(wanted)])

    def _too_short(self, time: float) -> CoverageError:
        table = self.first
        last = float(table.times[-1])
        return CoverageError(
            f"No departure is left for a ship that is ready at {format_time(time)}.",
            f"The tables hold departures from {format_time(table.start)} to {format_time(last)}; "
            "some of them may be impossible.",
            "Make the tables longer, allow less waiting or fewer trips.",
        )


def _no_departure_error(trip: TripTable) -> CoverageError:
    return CoverageError(
        f"The trip {trip.name!r} cannot be made at any of its {len(trip)} departures.",
        "At each of them the water is too shallow, the current too strong or a weather limit "
        "exceeded.",
        "Require less clearance, or choose another time, track or ship.",
    )


def _windowed_minimum(values: FloatArray, width: int) -> FloatArray:
    """Return the minimum of each value and the ``width`` values after it (doubling windows)."""
    least, span = values.copy(), 1
    while 2 * span <= width + 1:
        least[:-span] = np.minimum(least[:-span], least[span:])
        span *= 2
    rest = width + 1 - span
    if rest:
        least[:-rest] = np.minimum(least[:-rest], least[rest:])
    return least


def _check_trips(trips: Sequence[TripTable]) -> None:
    if not trips:
        raise InputError("No trips are given.", "At least one is needed.", "Give a trip table.")
    kinds = {(t.start, t.step, len(t), t.periodic) for t in trips}
    if len(kinds) > 1:
        raise InputError(
            "The trip tables have different departures.",
            "All tables must have the same start, step, length and period.",
            "Compute them with the same Departures.",
        )
