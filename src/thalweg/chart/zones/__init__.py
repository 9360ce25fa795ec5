"""Zones: emission control areas, no-go and penalty areas, and the fractions of legs inside."""
