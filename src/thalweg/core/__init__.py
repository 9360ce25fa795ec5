"""Shared by all packages: geodesy, time, units, errors and the cache folder."""
