"""Kernels of the exact Pareto front on a network and of its lower bound."""
