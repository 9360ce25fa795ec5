"""Routes: tracks to sail, the referee that scores them, and the formats they travel in."""

from thalweg.route.formats import read_track, write_csv, write_geojson, write_gpx
from thalweg.route.joining import join
from thalweg.route.referee import evaluate
from thalweg.route.route import Route, Violation
from thalweg.route.track import Track

__all__ = [
    "Route",
    "Track",
    "Violation",
    "evaluate",
    "join",
    "read_track",
    "write_csv",
    "write_geojson",
    "write_gpx",
]
