"""Kernels of sailing: speed at a point, one edge of a network, one leg of a track."""
