"""The answer to a question for the distance by sea between two places."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from thalweg.core.errors import InputError
from thalweg.core.given_numbers import is_number, shortened_repr
from thalweg.core.units import DAY, KNOT, NAUTICAL_MILE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from thalweg.core.geodesy import Position
    from thalweg.planning.voyage_parts import Place


#: Canals too small for most ships, which are not used by default.
SMALL_CANALS: Final = ("corinth",)
#: Distance from land that ways keep outside passages, where they can [nm].
DEFAULT_OFFING_NM: Final = 2.0
#: Ways without a draught keep off water shallower than this where they can [m].
USUAL_DEPTH: Final = 5.0


@dataclass(frozen=True)
class DistanceRequest:
    """What is asked for: the parameters of `thalweg.planning.sea_distance.sea_distance`."""

    start: Place
    goal: Place
    via: Sequence[Place]
    avoid: Sequence[str] | None
    open: Sequence[str]
    offing_nm: float
    draught_m: float | None

    @property
    def vias(self) -> Sequence[Place]:
        """Places to pass: a single name is one place."""
        return (self.via,) if isinstance(self.via, str) else self.via

    @property
    def names_to_avoid(self) -> tuple[str, ...]:
        """Canals and passages that are not used: a single name is one of them."""
        return (self.avoid,) if isinstance(self.avoid, str) else tuple(self.avoid or ())


@dataclass(frozen=True)
class SeaDistance:
    """The shortest way by sea between two places.

    Attributes
    ----------
    start, goal : str
        Names of the places.
    length : float
        Of the whole way [m].
    canals : tuple of str
        Canals, in order.
    straits : tuple of str
        Named passages and capes whose water the way goes through, in order.
    approaches : tuple of (str, float)
        Name of the port and length of its approach [m], both part of the whole.
    line : tuple of (lat, lon)
        Waypoints [deg].
    notes : tuple of str
        How positions were taken.
    """

    start: str
    goal: str
    length: float
    canals: tuple[str, ...]
    straits: tuple[str, ...]
    approaches: tuple[tuple[str, float], ...]
    line: tuple[Position, ...]
    notes: tuple[str, ...] = ()

    @property
    def nm(self) -> float:
        """Length of the whole way [nautical miles]."""
        return self.length / NAUTICAL_MILE

    def days(self, speed_kn: float) -> float:
        """Return the time at a speed; approaches count at no more than 10 kn.

        Canals are counted at that speed: their transit times depend on convoys and locks.

        Parameters
        ----------
        speed_kn : float
            Speed [kn], above 0 and at most 100.

        Returns
        -------
        float
            Time [days].

        Raises
        ------
        InputError
            If the speed is not above zero.
        """
        if not (is_number(speed_kn) and 0.0 < speed_kn <= 100.0):
            raise InputError(
                f"The speed is {shortened_repr(speed_kn)} kn.",
                "Speeds are above 0 and at most 100 kn.",
                "Give the speed in knots.",
                field="speed_kn",
            )
        from thalweg.chart.approaches import MAX_APPROACH_SPEED  # loads the tables of ports

        near = sum(length for _, length in self.approaches)
        speed = speed_kn * KNOT
        return ((self.length - near) / speed + near / min(speed, MAX_APPROACH_SPEED)) / DAY

    def to_dict(self) -> dict[str, Any]:
        """Return plain data for JSON.

        Returns
        -------
        dict
            Distances [nm], canals, straits, approaches by name, waypoints [deg] and
            notes.
        """
        return {
            "from": self.start,
            "to": self.goal,
            "distance_nm": self.nm,
            "canals": list(self.canals),
            "straits": list(self.straits),
            "approaches_nm": {name: length / NAUTICAL_MILE for name, length in self.approaches},
            "line": [list(place) for place in self.line],
            "notes": list(self.notes),
        }
