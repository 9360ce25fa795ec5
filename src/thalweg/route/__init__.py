"""Routes: tracks to sail, the referee that scores them, and the formats they travel in."""

from thalweg.route.ensemble import Distribution, Spread, cvar, evaluate_members
from thalweg.route.formats import read_track, write_csv, write_geojson, write_gpx
from thalweg.route.improving import better_route, shorten_waits
from thalweg.route.joining import join
from thalweg.route.polishing import polish
from thalweg.route.referee import evaluate
from thalweg.route.route import Route, Violation
from thalweg.route.smooth import smooth
from thalweg.route.track import Track
from thalweg.route.wind import with_wind_speed

__all__ = [
    "Distribution",
    "Route",
    "Spread",
    "Track",
    "Violation",
    "better_route",
    "cvar",
    "evaluate",
    "evaluate_members",
    "join",
    "polish",
    "read_track",
    "shorten_waits",
    "smooth",
    "with_wind_speed",
    "write_csv",
    "write_geojson",
    "write_gpx",
]
