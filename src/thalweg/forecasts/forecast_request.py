"""What is fetched: a box, a period and quantities."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from thalweg.core.bounding_box import BoundingBox
from thalweg.core.errors import InputError, errors_about
from thalweg.core.time import format_time, parse_time
from thalweg.core.units import HOUR

QUANTITIES: Final = ("wind", "waves", "current", "level", "ice", "pressure")
_LONGEST: Final = 400 * 24 * HOUR  #: [s] period of one request


@dataclass(frozen=True)
class ForecastRequest:
    """What is fetched.

    Parameters
    ----------
    box : BoundingBox or tuple of float
        Area: south, north, west, east [deg]; it may span the antimeridian.
    start, end : time
        Period; kept as seconds since 1970.
    quantities : tuple of str
        Of `QUANTITIES`.
    step : float
        Time between fields [s], a whole number of hours. Sources with coarser fields deliver these.
    run : time or None
        Start of the forecast run. None: the latest run that is complete and not
        after ``start``.
    members : int
        Members of an ensemble; 0: the single forecast.

    Raises
    ------
    InputError
        If the period is empty or longer than 400 days, the step is not a whole number of hours
        between 1 and 24, or a quantity is not known.
    """

    box: BoundingBox
    start: float
    end: float
    quantities: tuple[str, ...] = ("wind", "waves")
    step: float = 3 * HOUR
    run: float | None = None
    members: int = 0

    def __post_init__(self) -> None:
        if not isinstance(self.box, BoundingBox):
            object.__setattr__(self, "box", BoundingBox.checked(*self.box))
        for name in ("start", "end", "run"):
            if (moment := getattr(self, name)) is not None:
                with errors_about(name):
                    object.__setattr__(self, name, parse_time(moment))
        if not self.start < self.end <= self.start + _LONGEST:
            raise InputError(
                f"The period from {format_time(self.start)} to {format_time(self.end)} was "
                "requested.",
                "The end is after the start, and within 400 days of it.",
                "Correct the times.",
                field="end",
            )
        hours = self.step / HOUR
        if not (1.0 <= hours <= 24.0 and hours == round(hours)):
            raise InputError(
                f"Fields every {hours:g} h were requested.",
                "The step is a whole number of hours, 1 to 24.",
                "Give one of them, for example 3.",
                field="step_h",
            )
        unknown = [name for name in self.quantities if name not in QUANTITIES]
        if unknown or not self.quantities:
            raise InputError(
                f"The quantities {', '.join(unknown) or '(none)'} are not known.",
                f"Quantities: {', '.join(QUANTITIES)}.",
                "Give one or more of them.",
                field="quantities",
            )
        if not 0 <= self.members <= 200:
            raise InputError(
                f"{self.members} members were requested.",
                "0 (the single forecast) to the number of members of the ensemble.",
                "Correct the number.",
                field="members",
            )

    def steps(self, run: float, lead_hours: Sequence[int]) -> list[int]:
        """Return the lead times of a run that cover the period [h].

        Parameters
        ----------
        run : float
            Start of the run [s since 1970].
        lead_hours : sequence of int
            Lead times that the source has [h], ascending.

        Returns
        -------
        list of int
            Those at the requested step (or the coarser one of the source) from the last at or
            before the start to the first at or after the end.

        Raises
        ------
        InputError
            If the run does not cover the period.
        """
        first, last = (self.start - run) / HOUR, (self.end - run) / HOUR
        if first < lead_hours[0] - 1e-9 or last > lead_hours[-1] + 1e-9:
            raise InputError(
                f"{format_time(self.start)} to {format_time(self.end)} was requested.",
                f"The run of {format_time(run)} covers {format_time(run + HOUR * lead_hours[0])} "
                f"to {format_time(run + HOUR * lead_hours[-1])}.",
                "Shorten the period, or give another run.",
            )
        low = max(hour for hour in lead_hours if hour <= first + 1e-9)
        high = min(hour for hour in lead_hours if hour >= last - 1e-9)
        kept = [low]
        for hour in lead_hours:
            if low < hour <= high and (hour - kept[-1] >= self.step / HOUR or hour == high):
                kept.append(hour)
        return kept

    def values(self, degrees: float, fields: int, times: int) -> int:
        """Return the number of values in the box.

        Parameters
        ----------
        degrees : float
            Spacing of the grid [deg].
        fields, times : int

        Returns
        -------
        int
        """
        rows = math.floor((self.box.north - self.box.south) / degrees) + 1
        return rows * (math.floor(self.box.width / degrees) + 1) * fields * times
