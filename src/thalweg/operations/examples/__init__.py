"""Synthetic worlds and tracks for examples and tutorials."""
