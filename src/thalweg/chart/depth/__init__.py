"""Charted depth: gridded bathymetry and layers by priority."""
