"""Engines: specific fuel consumption and fuel properties."""
