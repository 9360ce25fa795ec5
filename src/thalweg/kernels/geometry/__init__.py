"""Kernels of geometry: coastline, polygons, depth grids, interpolation of fields."""
