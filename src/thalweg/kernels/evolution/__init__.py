"""Kernels of evolutionary search: dominance, crossover, mutation, random numbers."""
