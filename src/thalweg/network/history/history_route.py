"""The usual route between two ports of a history network."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.geodesy import Position, distance, line_length
from thalweg.core.units import HOUR, NAUTICAL_MILE
from thalweg.network.history.season_masks import LEAST_SAMPLES
from thalweg.network.history.voyage_tracks import HistoryPort

_DEEPEST: Final = 30.0  # draught [m]
_FEW: Final = 3  # voyages below which the confidence is low
_ROUNDABOUT: Final = 1.5  # times the straight line: a way that no ship sailed whole is doubtful
_MUCH: Final = 0.05  # share of the length without tracks above which the confidence is low


@dataclass(frozen=True)
class HistoryRoute:
    """The usual route between two ports.

    Attributes
    ----------
    start, goal : HistoryPort
    arcs : tuple of int
        Arcs of the network, in order.
    length : float
        Length of the line with the approaches of both ports [m].
    duration : (float, float, float)
        p10, p50 and p90 of the time under way [s], without approaches: of whole voyages; sums over
        the arcs where fewer than ten sailed the whole way; NaN where an arc was not sailed.
    voyages : int
        Least number of voyages of its arcs; 0 with arcs that were not sailed in this direction.
    globe_share : float
        Share of the length that no track shows.
    eca_share : float
        Share of the length inside emission control areas; NaN where unknown.
    line : tuple of (lat, lon)
        Waypoints from where the approach of the start is left to where that of the goal is met
        [deg]: the sea ends, or places nearer to the berths as before canals.
    passes : tuple of str
        Corridors and canals, in order.
    voyages_in_month : int, optional
        Least number of voyages of its arcs in the month of the request; None without a month.
    notes : tuple of str
        That no voyages were seen in the month of the request.
    whole : int
        Voyages that sailed from the start to the goal without a call between, on this way if it is
        one arc; less than 0: so many in the other direction, whose line this is.
    """

    start: HistoryPort
    goal: HistoryPort
    arcs: tuple[int, ...]
    length: float
    duration: tuple[float, float, float]
    voyages: int
    globe_share: float
    eca_share: float
    line: tuple[Position, ...]
    passes: tuple[str, ...]
    voyages_in_month: int | None = None
    notes: tuple[str, ...] = ()
    whole: int = 0

    @property
    def nm(self) -> float:
        """Usual length with the approaches of both ports [nautical miles]."""
        return self.length / NAUTICAL_MILE

    @property
    def confidence(self) -> str:
        """How well the route is known: "high", "medium", "low" or "none"."""
        if self.globe_share > 0.5:
            return "none"
        least = min(self.voyages, self.whole)
        if self.globe_share > _MUCH or least < _FEW:
            return "low"
        return "high" if least >= LEAST_SAMPLES and self.voyages_in_month != 0 else "medium"

    @property
    def reason(self) -> str:
        """Why the route is known so well or so little, in words."""
        if self.whole < 0:
            reasons = [f"{-self.whole} voyages in the other direction, and few or none in this one"]
        elif len(self.arcs) == 1 and self.whole > 0:
            reasons = [f"{self.whole} voyages on this way"]
        else:
            sailed = f"{self.whole} voyages" if self.whole else "no voyage"
            reasons = [
                f"at least {self.voyages} voyages on every arc with tracks",
                f"{sailed} from the one port to the other",
            ]
            if not self.whole and self._times_straight > _ROUNDABOUT:
                reasons.append(f"{self._times_straight:.1f} times the straight line")
        if self.globe_share > 0.0:
            reasons.append(f"{100.0 * self.globe_share:.0f} % of the length without tracks")
        if self.voyages_in_month == 0:
            reasons.append("no voyage in this month on some of them")
        return ", ".join(reasons)

    @property
    def _times_straight(self) -> float:
        """The length of the line in lengths of the straight line between its ends."""
        straight = float(distance(*self.line[0], *self.line[-1]))
        return line_length(self.line) / max(straight, 1.0)

    def to_dict(self) -> dict[str, Any]:
        """Return plain data for JSON.

        Returns
        -------
        dict
            Distances [nm], times [h] and shares; unknown values are None.
        """
        hours = [None if np.isnan(t) else t / HOUR for t in self.duration]
        return {
            "from": self.start.name,
            "to": self.goal.name,
            "distance_nm": self.nm,
            "duration_h": dict(zip(("p10", "p50", "p90"), hours)),
            "voyages": self.voyages,
            "confidence": self.confidence,
            "reason": self.reason,
            "voyages_of_whole_way": max(self.whole, 0),
            "voyages_in_month": self.voyages_in_month,
            "share_without_tracks": self.globe_share,
            "eca_share": None if np.isnan(self.eca_share) else self.eca_share,
            "passes": list(self.passes),
            "notes": list(self.notes),
            "line": [list(place) for place in self.line],
        }


def check_month_and_draught(month: int | None, draught: float | None) -> None:
    """Raise `InputError` for a month or a draught [m] that is not possible."""
    if month is not None and not 1 <= month <= 12:
        raise InputError(f"The month is {month!r}.", "Months are 1 to 12.", "Give one of them.")
    if draught is not None and not 0.0 < draught <= _DEEPEST:
        raise InputError(
            f"The draught is {draught!r} m.",
            f"Draughts are above 0 and at most {_DEEPEST:g} m.",
            "Correct it, or leave it out.",
        )


def no_arcs_text(month: int | None, draught: float | None) -> str:
    """Return that no open arcs join two places, in the month and for the draught [m] in use."""
    limits = [] if month is None else [f"open in month {month}"]
    limits += [] if draught is None else [f"deep enough for a draught of {draught:g} m"]
    return f"No arcs join them that are {' and '.join(limits)}." if limits else "No arcs join them."


def what_to_leave_out(month: int | None, draught: float | None) -> str:
    """Return the begin of an advice: to leave out the limits in use, or b[uild another network]."""
    given = [name for name, one in (("month", month), ("draught", draught)) if one is not None]
    return f"Leave out the {' or the '.join(given)}, or b" if given else "B"
