"""Pictures of a plan: map, profile, Pareto front, space-time diagram."""
