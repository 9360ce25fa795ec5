"""Tides: astronomy, harmonic analysis and prediction, records and constituent files."""
