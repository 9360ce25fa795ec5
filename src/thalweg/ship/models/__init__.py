"""Ship models composed of the published methods."""
