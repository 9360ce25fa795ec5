"""Calm-water resistance: Holtrop-Mennen, Hollenbach, friction lines."""
