"""Thalweg: voyage optimisation for ships."""
