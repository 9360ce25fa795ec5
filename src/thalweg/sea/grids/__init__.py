"""Gridded layers: location of points in grids and interpolation."""
