"""Kernels of the earliest-arrival search: label setting, waiting, bounds."""
