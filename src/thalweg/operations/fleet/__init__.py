"""History networks from the tracks of many ships."""

from thalweg.operations.fleet.fleet_tracks import FleetTracks, read_fleet
from thalweg.operations.fleet.history_from_tracks import history_from_tracks
from thalweg.operations.fleet.port_calls import PortCallRules

__all__ = ["FleetTracks", "PortCallRules", "history_from_tracks", "read_fleet"]
