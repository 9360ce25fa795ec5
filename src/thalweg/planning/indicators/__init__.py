"""Plans by key performance indicators: weighted sums, limits of totals, fronts, alternatives."""
