"""What every room stands on: geodesy, time, units, errors and the cache folder."""
