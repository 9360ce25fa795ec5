"""Certified lower bounds of the time of a passage, by barrier functions of the arrival time."""
