"""Plots of dredging projects, track analyses and waiting studies."""

from thalweg.operations.plots.project_plots import draw_project, draw_routes
from thalweg.operations.plots.track_plot import draw_tracks
from thalweg.operations.plots.waiting_plot import draw_waiting

__all__ = ["draw_project", "draw_routes", "draw_tracks", "draw_waiting"]
