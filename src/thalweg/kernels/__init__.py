"""Compiled kernels over plain arrays; the only room that imports numba."""
