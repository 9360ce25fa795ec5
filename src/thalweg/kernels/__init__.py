"""Compiled kernels over plain arrays; the only package that imports numba."""
