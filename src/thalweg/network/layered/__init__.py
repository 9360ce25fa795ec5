"""Layered networks between waypoints, for coasts with islands and straits."""
