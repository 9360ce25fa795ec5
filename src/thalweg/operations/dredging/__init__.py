"""Dredging projects: cycles of loading, sailing and dumping, planned and simulated."""
