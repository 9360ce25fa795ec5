"""The exact Pareto front on a network, and the lower front that bounds it."""
