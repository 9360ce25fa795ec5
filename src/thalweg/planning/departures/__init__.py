"""One voyage for many departures: the least time of each on one network."""
