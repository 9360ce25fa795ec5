"""Arithmetic of arrays that all packages share."""
