"""Savings of waiting for several starts, allowed waits and departure rules."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.errors import InputError
from thalweg.core.time import TimeLike, format_time, parse_time, to_datetime64
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR
from thalweg.deprecated_names import renamed_arguments
from thalweg.operations.waiting.trip_table import TripTable
from thalweg.operations.waiting.waiting_optimisation import (
    DEPARTURE_RULES,
    WaitingPlan,
    plan_waiting,
)

if TYPE_CHECKING:
    import pandas as pd

KWH = 3.6e6  #: [J]
MAX_PLANS = 20_000  #: of a study
_MIN_SAVING = 1e-9  # share of the energy that counts as a saving


@dataclass(frozen=True)
class WaitingStudy:
    """Plans for every start, allowed wait and rule.

    Attributes
    ----------
    trips : tuple of TripTable
        In the order in which they are sailed.
    hotel_power : float [W]
    starts : float64 array (s,) [s since 1970-01-01T00:00Z]
    max_waits : float64 array (w,)
        Longest wait before each trip [s].
    plans : dict of str to tuple of tuple of WaitingPlan
        By rule, then start, then allowed wait.
    """

    trips: tuple[TripTable, ...]
    hotel_power: float
    starts: FloatArray
    max_waits: FloatArray
    plans: dict[str, tuple[tuple[WaitingPlan, ...], ...]]

    def energy(self, rule: str) -> FloatArray:
        """Return the energy of all starts and allowed waits under one rule.

        Parameters
        ----------
        rule : str
            A key of ``plans``.

        Returns
        -------
        float64 array (starts, allowed waits)
            Energy [J].
        """
        return np.array([[plan.energy for plan in row] for row in self.plans[rule]])

    def saving(self, rule: str) -> FloatArray:
        """Return the saving under one rule, compared with no waiting.

        Parameters
        ----------
        rule : str
            A key of ``plans``.

        Returns
        -------
        float64 array (starts, allowed waits)
            Share of the energy without waiting [-]; negative for a loss.
        """
        return np.asarray(1.0 - self.energy(rule) / self.energy("none"))

    def to_frame(self) -> pd.DataFrame:
        """Return one row for each rule, start and allowed wait, in hours, kWh and per cent.

        Returns
        -------
        DataFrame
            One row for each combination.
        """
        import pandas as pd

        return pd.DataFrame(self._rows())

    def _rows(self) -> list[dict[str, Any]]:
        rows = []
        for rule, table in self.plans.items():
            saving = 100.0 * self.saving(rule)
            for i, row in enumerate(table):
                for j, plan in enumerate(row):
                    rows.append(
                        {
                            "rule": rule,
                            "start": to_datetime64(self.starts[i]),
                            "most_wait_h": self.max_waits[j] / HOUR,
                            "energy_kwh": plan.energy / KWH,
                            "saving_percent": saving[i, j],
                            "waited_h": plan.waited / HOUR,
                            "duration_h": plan.duration / HOUR,
                        }
                    )
        return rows

    def as_dict(self) -> dict[str, Any]:
        """Return the study as plain data for JSON.

        Returns
        -------
        dict
            ``trips``, ``hotel_power_kw`` and ``rows``; times as ISO 8601.
        """
        return {
            "trips": [trip.name for trip in self.trips],
            "hotel_power_kw": self.hotel_power / 1000.0,
            "rows": [{**row, "start": format_time(_seconds(row["start"]))} for row in self._rows()],
        }


@renamed_arguments(most_waits="max_waits")
def waiting_study(
    trips: Sequence[TripTable],
    *,
    starts: Sequence[TimeLike],
    max_waits: ArrayLike,
    hotel_power: float = 0.0,
) -> WaitingStudy:
    """Plan the departures by every rule, for several starts and allowed waits.

    Parameters
    ----------
    trips : sequence of TripTable
        In the order in which they are sailed; five cycles of two trips are ``[out, back] * 5``.
    starts : sequence of time
        When the ship is ready for the first trip.
    max_waits : array_like
        Longest wait before each trip [s].
    hotel_power : float
        Power used all the time [W]; 0: waiting needs no energy.

    Returns
    -------
    WaitingStudy

    Raises
    ------
    CoverageError
        If the tables end too early.
    InputError
        If there are no starts or waits, or more than 20,000 plans.
    """
    begin = np.array([parse_time(s) for s in starts], dtype=np.float64)
    waits = np.atleast_1d(np.asarray(max_waits, dtype=np.float64))
    count = begin.size * waits.size * len(DEPARTURE_RULES)
    if not 0 < count <= MAX_PLANS:
        raise InputError(
            f"{count} waiting plans were requested.",
            f"A study has 1 to {MAX_PLANS} plans: starts times waits times rules.",
            "Give at least one start and one wait, and fewer if there are too many.",
        )
    plans = {
        rule: tuple(
            tuple(
                plan_waiting(trips, start=s, max_wait=w, hotel_power=hotel_power, rule=rule)
                for w in waits.tolist()
            )
            for s in begin.tolist()
        )
        for rule in DEPARTURE_RULES
    }
    return WaitingStudy(tuple(trips), float(hotel_power), begin, waits, plans)


@renamed_arguments(most_wait="max_wait")
def break_even_power(
    trips: Sequence[TripTable],
    *,
    start: TimeLike,
    max_wait: float,
    rule: str = "optimum",
    largest: float = 1e6,
) -> float:
    """Return the hotel power [W] above which waiting no longer saves energy.

    Parameters
    ----------
    trips : sequence of TripTable
    start : time
    max_wait : float
        Longest wait before each trip [s].
    rule : str
        As in `plan_waiting`.
    largest : float
        The highest power considered [W].

    Returns
    -------
    float
        To 0.1 %; 0 if waiting saves nothing even when it is free, inf if it saves at ``largest``.

    Notes
    -----
    By bisection: the higher the hotel power, the smaller the saving; for the rules that ignore the
    hotel power it decreases linearly. A gain that only comes from arrivals just before a departure
    of the tables does not count: one step of hotel power for each trip but the last is subtracted.
    """

    def saves(power: float) -> bool:
        none, some = (
            plan_waiting(trips, start=start, max_wait=max_wait, hotel_power=power, rule=r).energy
            for r in ("none", rule)
        )
        rounding = power * trips[0].step * (len(trips) - 1)
        return some < none * (1.0 - _MIN_SAVING) - rounding

    if not saves(0.0):
        return 0.0
    if saves(largest):
        return math.inf
    low, high = 0.0, float(largest)
    while high - low > 1e-3 * high and high > 1e-3:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if saves(middle) else (low, middle)
    return 0.5 * (low + high)


def _seconds(moment: Any) -> float:
    return float(np.asarray(moment, dtype="datetime64[ns]").astype(np.int64)) / 1e9
