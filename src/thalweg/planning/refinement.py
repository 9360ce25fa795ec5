"""From a path on a network to a smooth route, scored by the referee and kept only if better."""
