"""Waves raised by the local wind, for seas whose data hold no waves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray
from thalweg.core.units import DAY, HOUR
from thalweg.sea import standard_names as nm
from thalweg.sea.layer import Layer
from thalweg.sea.layer_stack import stack_variables
from thalweg.sea.models.derived_layer import DerivedLayer

DEFAULT_FETCH = 500_000.0  #: [m] assumed fetch of the wind
DEFAULT_DURATION = DAY  #: [s] assumed duration of the wind


def carter_1982(
    wind_speed: ArrayLike, *, fetch: ArrayLike = DEFAULT_FETCH, duration: float = DEFAULT_DURATION
) -> tuple[FloatArray, FloatArray]:
    r"""Return significant height and peak period of the waves that a steady wind raises.

    The result is the smallest of the sea limited by fetch, the sea limited by duration and the
    fully developed sea:

    .. math::

        H_s &= \min(0.0163\,X^{1/2} U,\; 0.0146\,D^{5/7} U^{9/7},\; 0.0248\,U^2) \\
        T_p &= \min(0.566\,X^{0.3} U^{0.4},\; 0.540\,D^{3/7} U^{4/7},\; 0.729\,U)

    with wind speed U [m/s], fetch X [km] and duration D [h].

    Parameters
    ----------
    wind_speed : array_like
        Wind speed at 10 m [m/s], at least 0.
    fetch : array_like
        Length of open water over which the wind has blown [m].
    duration : Time for which it has blown [s].

    Returns
    -------
    height, period : float64 array
        Significant wave height [m] and peak period [s], of the shape of ``wind_speed``.

    Raises
    ------
    InputError
        If fetch or duration is not positive.

    Notes
    -----
    The coefficients are those of WMO-No. 702; they were not compared with the source.

    References
    ----------
    .. [1] Carter, D.J.T. (1982). Prediction of wave height and period for a constant wind velocity
       using the JONSWAP results. *Ocean Engineering* 9(1), 17-33.
    .. [2] World Meteorological Organization. *Guide to Wave Analysis and Forecasting*, WMO-No. 702.
    """
    fetch = np.asarray(fetch, float)
    if np.any(fetch <= 0.0) or not duration > 0.0:
        raise InputError(
            f"A fetch of {np.min(fetch):g} m and a duration of {duration:g} s raise no waves.",
            "Both must be above zero.",
            "Correct them.",
        )
    wind = np.asarray(wind_speed, float)
    km, hours = fetch / 1000.0, duration / HOUR
    height = np.minimum(0.0163 * np.sqrt(km) * wind, 0.0146 * hours ** (5 / 7) * wind ** (9 / 7))
    period = np.minimum(0.566 * km**0.3 * wind**0.4, 0.540 * hours ** (3 / 7) * wind ** (4 / 7))
    return np.minimum(height, 0.0248 * wind**2), np.minimum(period, 0.729 * wind)


class FetchFunction(Protocol):
    """The length of open water over which the wind blows to a position."""

    @property
    def name(self) -> str:
        """Name of the coastline, for records."""

    def __call__(self, lat: FloatArray, lon: FloatArray, origin: FloatArray) -> FloatArray:
        """Return the fetch [m] at positions [deg] for winds from a direction [rad]."""


@dataclass(frozen=True, eq=False)
class WindSeaLayer(DerivedLayer):
    """Waves that the wind of other layers raises; they travel with the wind.

    Attributes
    ----------
    layers : tuple of Layer
        Layers that hold the wind, in order of priority; waves are unknown where the wind is.
    fetch : ``f(lat, lon, origin)``: fetch [m] at positions [deg] for winds from a direction [rad],
        such as `thalweg.chart.coastal_fetch.CoastalFetch`; by default 500 km.
    """

    fetch: FetchFunction | None = None

    needed = nm.WIND.pair
    derived = frozenset({nm.WAVE_HEIGHT, *nm.WAVES.pair, nm.WAVE_PERIOD})
    source_text = "from the wind of"

    def _values(
        self, needed: Mapping[str, FloatArray], lat: FloatArray, lon: FloatArray
    ) -> dict[str, FloatArray]:
        east, north = (np.asarray(needed[name], float) for name in nm.WIND.pair)
        speed = np.hypot(east, north)
        fetch: FloatArray | float = DEFAULT_FETCH
        if self.fetch is not None:
            fetch = self.fetch(lat, lon, np.arctan2(-east, -north))
        height, period = carter_1982(speed, fetch=fetch)
        nonzero = np.where(speed > 0.0, speed, 1.0)
        return {
            nm.WAVE_HEIGHT: height,
            nm.WAVE_PERIOD: np.maximum(period, 1.0),
            nm.WAVE_TO_EAST: east / nonzero,
            nm.WAVE_TO_NORTH: np.where(speed == 0.0, 1.0, north / nonzero),
        }

    def provenance(self) -> Mapping[str, Any]:
        """Return the method and its assumed fetch [m] and duration [s]."""
        fetch = DEFAULT_FETCH if self.fetch is None else f"to the coast of {self.fetch.name}"
        return {"kind": "waves from wind", "method": "Carter (1982)", "fetch_m": fetch,
                "duration_s": DEFAULT_DURATION}  # fmt: skip


def wind_sea_layer(layers: Sequence[Layer], fetch: FetchFunction | None = None) -> WindSeaLayer:
    """Return a layer of the waves that the wind of the layers raises.

    Parameters
    ----------
    layers : Layers in order of priority.
    fetch : As in `WindSeaLayer`.

    Raises
    ------
    InputError : If the layers hold no wind components.
    """
    variables = stack_variables(layers)
    if not set(nm.WIND.pair) <= variables:
        raise InputError(
            "Waves are to be derived from the wind, but the sea holds no wind.",
            f"The sea holds: {', '.join(sorted(variables)) or 'nothing'}.",
            "Add wind, or fill waves with a height.",
        )
    return WindSeaLayer(tuple(layers), fetch)
