"""Continuous refinement of tracks: waypoints and speeds improved between network nodes."""
