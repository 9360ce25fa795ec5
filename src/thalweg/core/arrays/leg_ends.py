"""The ends of the legs of lines."""

from __future__ import annotations

from thalweg.core.types import FloatArray


def leg_ends(
    lat: FloatArray, lon: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return the ends of the legs of a line (lat1, lon1, lat2, lon2), as tests of legs take them.

    Parameters
    ----------
    lat, lon : ndarray (n,)
        Positions along the line [deg].

    Returns
    -------
    tuple of ndarray (n - 1,) : Latitude and longitude of the first and the second ends [deg].
    """
    return lat[:-1], lon[:-1], lat[1:], lon[1:]
