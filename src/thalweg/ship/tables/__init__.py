"""Performance tables: tabulation, bounds, output curves, cache."""
