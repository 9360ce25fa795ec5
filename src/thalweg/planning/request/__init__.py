"""The request: end points, coverage of the data, required variables, restrictions."""
