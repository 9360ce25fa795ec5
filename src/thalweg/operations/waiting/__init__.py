"""Waiting studies: which departure and which wait give the shortest or cheapest trip."""
