"""Fields of the sea frozen as arrays, the input of the compiled kernels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from thalweg.core.types import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class StationFields:
    """The sea at fixed stations, frozen for kernels that interpolate in time only.

    Attributes
    ----------
    times : float64 array (T,)
        Strictly increasing [s since 1970-01-01T00:00Z].
    values : float32 array (S, T, K)
        (stations, times, channels), C order; one index per channel present; NaN where unknown.
    channel_index : int64 array (CHANNELS,)
        Index in the last axis of each channel of `thalweg.kernels.codes`, -1 if absent.
    """

    times: FloatArray
    values: NDArray[np.float32]
    channel_index: IntArray


@dataclass(frozen=True, eq=False)
class GridFields:
    """The sea on a regular raster, frozen for kernels that interpolate in space and time.

    Attributes
    ----------
    times : float64 array (T,)
        Strictly increasing [s since 1970-01-01T00:00Z].
    lat0, dlat, lon0, dlon : float
        South-west corner and spacing [deg]. Longitude is unwrapped: column x is at
        ``lon0 + x * dlon``, which may pass 180; shift a query by 360 to fit.
    values : float32 array (T, Y, X, K)
        (times, rows, columns, channels), C order; NaN where unknown.
    channel_index : int64 array (CHANNELS,)
        Index in the last axis of each channel of `thalweg.kernels.codes`, -1 if absent.
    """

    times: FloatArray
    lat0: float
    dlat: float
    lon0: float
    dlon: float
    values: NDArray[np.float32]
    channel_index: IntArray
