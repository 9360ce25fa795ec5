"""Where and when the data of a sea are known."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, eq=False)
class Coverage:
    """The area and period in which one variable of one layer is known.

    Attributes
    ----------
    variable : str
        Canonical name.
    south, north, west, east : float
        Box [deg]; ``east`` may pass 180.
    start, end : float or None
        Period [s since epoch]; None for all times.
    step_s : float or None
        Median time step [s]; None for a single or no time.
    spacing_deg : float or None
        Typical spacing of the grid [deg of latitude]; None for formulas.
    source : str
        File name, or a name for the formula.
    """

    variable: str
    south: float
    north: float
    west: float
    east: float
    start: float | None
    end: float | None
    step_s: float | None
    spacing_deg: float | None
    source: str
