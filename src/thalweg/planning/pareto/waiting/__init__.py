"""Waits of fronts: one at the start, long enough, and speeds between the settings."""
