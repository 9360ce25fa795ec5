"""One route between two points for one objective, and why none was found.

Routes here are of least time or distance at one speed setting. `thalweg.planning.pareto` plans many
routes, with a choice of speeds.
"""
