"""The request: end points, network, coverage of the data, required variables, restrictions."""
