"""How a route is written into files for a bridge."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from thalweg.core.errors import InputError
from thalweg.core.units import NAUTICAL_MILE

if TYPE_CHECKING:
    from thalweg.chart import Chart

LEG_LINES = ("rhumb", "great-circle")
RTZ_VERSIONS = ("1.0", "1.1", "1.2")
#: Endings of the route files that can be written; ``gml`` is S-421.
ROUTE_FORMATS = ("rtz", "rtzp", "gml", "gpx", "geojson", "kml", "csv")
#: Bytes of a route file that is read, of some 50,000 waypoints with a schedule in any format.
LARGEST_FILE = 50_000_000
_MAX_CROSS_TRACK = 9.99  #: RTZ allows less than 10 nm [nm]


@dataclass(frozen=True)
class RouteFileOptions:
    """How a route is written into files for a bridge.

    Attributes
    ----------
    start, goal : str
        Names of the places at both ends, for the names of waypoints.
    cross_track_nm : float
        Cross-track limit [nm]: the lines between the waypoints of the file are closer to the route
        than this. Above 0 and below 10.
    spacing_nm : float or None
        Greatest distance between waypoints [nm]; None: as the cross-track limit requires.
    max_waypoints : int or None
        Greatest number of waypoints; the cross-track limit grows as far as this needs.
    legs : {"rhumb", "great-circle"}
        Lines between the waypoints of the file.
    rtz_version : {"1.2", "1.1", "1.0"}
        Version of RTZ files.
    chart : Chart or None
        Lines that touch land of this chart are broken into shorter ones.
    thinning : float
        Waypoints this close to the line of their neighbours are left out [share of the cross-track
        limit], 0 to 1.
    decimals : int
        Decimals of positions [deg], 5 to 9; six are 0.1 m.
    formats : tuple of str
        Endings of the files written for a route, of `ROUTE_FORMATS`.

    Raises
    ------
    InputError
        If a number is outside its range or the version unknown.
    """

    start: str = ""
    goal: str = ""
    cross_track_nm: float = 0.1
    spacing_nm: float | None = None
    max_waypoints: int | None = None
    legs: str = "rhumb"
    rtz_version: str = "1.2"
    chart: Chart | None = None
    thinning: float = 0.5
    decimals: int = 6
    formats: tuple[str, ...] = ("rtz", "gpx", "geojson", "csv")

    def __post_init__(self) -> None:
        spacing, most = self.spacing_nm, self.max_waypoints
        if not 0.001 <= self.cross_track_nm <= _MAX_CROSS_TRACK:
            raise InputError(
                f"The cross-track limit is {self.cross_track_nm:g} nm.",
                f"It is between 0.001 and {_MAX_CROSS_TRACK:g} nm.",
                "Correct it; 0.1 nm is usual.",
            )
        if spacing is not None and not 0.1 <= spacing <= 10_000.0:
            raise InputError(
                f"The distance between waypoints is {spacing:g} nm.",
                "It is between 0.1 and 10000 nm.",
                "Correct it, or leave it out.",
            )
        if most is not None and most < 2:
            raise InputError(
                f"A route of at most {most} waypoints was requested.",
                "A route has at least two waypoints.",
                "Give a larger number, or leave it out.",
            )
        if not (0.0 <= self.thinning <= 1.0 and 5 <= self.decimals <= 9):
            raise InputError(
                f"Thinning by {self.thinning:g} and {self.decimals} decimals were requested.",
                "Thinning is a share of the limit, 0 to 1; positions have 5 to 9 decimals.",
                "Correct them, or leave them out.",
            )
        if unknown := [ending for ending in self.formats if ending not in ROUTE_FORMATS]:
            raise InputError(
                f"Route files are not written as {', '.join(map(repr, unknown))}.",
                f"Formats are {', '.join(ROUTE_FORMATS)} (gml is S-421).",
                "Choose among them, separated by commas.",
            )
        if self.legs not in LEG_LINES:
            raise InputError(
                f"Legs of route files are not written as {self.legs!r}.",
                f"They are {' or '.join(LEG_LINES)}.",
                "Choose one of them.",
            )
        if self.rtz_version not in RTZ_VERSIONS:
            raise InputError(
                f"RTZ {self.rtz_version} is not known.",
                f"Versions {', '.join(RTZ_VERSIONS)} can be written.",
                "Choose one of them.",
            )

    @property
    def great_circles(self) -> bool:
        """Whether the waypoints are joined by great circles."""
        return self.legs == "great-circle"

    @property
    def limit(self) -> float:
        """The cross-track limit [m]."""
        return self.cross_track_nm * NAUTICAL_MILE

    @property
    def spacing(self) -> float:
        """Greatest distance between waypoints [m]."""
        return math.inf if self.spacing_nm is None else self.spacing_nm * NAUTICAL_MILE


def voyage_name(options: RouteFileOptions) -> str:
    """Return the voyage in words, such as ``Rotterdam to Southampton``; blank if an end is."""
    return f"{options.start} to {options.goal}" if options.start and options.goal else ""
