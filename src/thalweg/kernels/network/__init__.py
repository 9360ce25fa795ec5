"""Kernels that build networks and find static shortest paths."""
