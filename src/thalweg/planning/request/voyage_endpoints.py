"""End points of a voyage: from text or degrees to navigable water."""

from __future__ import annotations

from dataclasses import dataclass, replace

from thalweg.chart import Chart
from thalweg.chart.ports import PORTS
from thalweg.core.errors import InputError
from thalweg.core.geodesy import distance, format_position, parse_position
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.voyage_parts import Place

#: Greatest distance that a position is moved [m]; coastlines are generalised.
MAX_SNAP_POSITION = 2_000.0
#: The same for ports [m]; harbours are on land at every resolution of the coastline.
MAX_SNAP_PORT = 60_000.0


@dataclass(frozen=True)
class Endpoint:
    """An end point of a voyage on navigable water.

    Attributes
    ----------
    name : str
        Name and country of the port ("Sydney, AU"), or the position as text.
    lat, lon : float
        Position used [deg].
    moved_distance_m : float
        Distance moved to navigable water [m].
    asked : (lat, lon), optional
        Requested position [deg], where it was moved.
    is_port : bool
        Whether the request was the name of a port.
    why : str
        Reason for moving it.
    """

    name: str
    lat: float
    lon: float
    moved_distance_m: float
    asked: tuple[float, float] | None = None
    is_port: bool = False
    why: str = "on charted land"

    @property
    def origin(self) -> tuple[float, float]:
        """Requested position (lat, lon) [deg]."""
        return self.asked or (self.lat, self.lon)

    @property
    def note(self) -> str:
        """A note for the user where the position was moved, else empty."""
        if self.moved_distance_m < 1.0:
            return ""
        return (
            f"{self.name} is {self.why}: moved {self.moved_distance_m / NAUTICAL_MILE:.1f} nm to "
            f"open water at {format_position(self.lat, self.lon)}."
        )


def resolve_endpoint(place: Place, chart: Chart, what: str) -> Endpoint:
    """Resolve a place to navigable water of a chart.

    Raises
    ------
    InputError
        If the port is unknown (with near matches), or the place is on land and too far from water.
    """
    if isinstance(place, str):
        position = parse_position(place)
        if position is None:
            port = PORTS.lookup(place)
            found = _snap_to_water(port.label, port.lat, port.lon, chart, what, MAX_SNAP_PORT)
            return replace(found, is_port=True)
    else:
        position = place
    return _snap_to_water(format_position(*position), *position, chart, what, MAX_SNAP_POSITION)


def _snap_to_water(
    name: str, lat: float, lon: float, chart: Chart, what: str, limit: float
) -> Endpoint:
    if bool(chart.is_navigable(lat, lon)):
        return Endpoint(name, lat, lon, 0.0)
    found = chart.nearest_navigable(lat, lon, largest=MAX_SNAP_PORT)
    if found is None:
        raise InputError(
            f"The {what} {name} is not on navigable water.",
            f"There is none within {MAX_SNAP_PORT / NAUTICAL_MILE:.0f} nm on this chart.",
            _swap_hint(lat, lon, chart) or "Choose another position, or a chart that covers it.",
            field=what,
        )
    near_lat, near_lon, moved = found
    if moved > limit:
        raise InputError(
            f"The {what} {name} is on land or in enclosed water.",
            f"The nearest navigable water is {moved / NAUTICAL_MILE:.1f} nm away, at "
            f"{format_position(near_lat, near_lon)}.",
            _swap_hint(lat, lon, chart) or "Give that position, or a port by name.",
            field=what,
        )
    return Endpoint(name, float(near_lat), float(near_lon), float(moved), asked=(lat, lon))


def _swap_hint(lat: float, lon: float, chart: Chart) -> str:
    if abs(lon) <= 90.0 and bool(chart.is_navigable(lon, lat)):
        return (
            f"Latitude comes first: {lon:g}, {lat:g} is at sea. Are latitude and longitude swapped?"
        )
    return ""


def check_distinct(start: Endpoint, goal: Endpoint) -> None:
    """Raise `InputError` if two end points are the same place."""
    if float(distance(start.lat, start.lon, goal.lat, goal.lon)) < 1.0:
        raise InputError(
            f"{start.name} and {goal.name} are the same place.",
            "Two places in succession are at least 1 m apart.",
            "Choose two different places.",
        )
