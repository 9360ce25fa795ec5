"""Analytic fields: cyclones, wind sea, current profiles, functions."""
