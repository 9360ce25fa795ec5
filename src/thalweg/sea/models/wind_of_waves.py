"""Wind that raises known waves, for seas whose data hold no wind."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR
from thalweg.sea import standard_names as nm
from thalweg.sea.layer import Layer
from thalweg.sea.layer_stack import stack_variables
from thalweg.sea.models.coast_fills import HeadSeasLayer
from thalweg.sea.models.derived_layer import DerivedLayer
from thalweg.sea.models.wind_sea import DEFAULT_DURATION, DEFAULT_FETCH


def carter_1982_wind(
    height: ArrayLike, *, fetch: float = DEFAULT_FETCH, duration: float = DEFAULT_DURATION
) -> FloatArray:
    r"""Return the steady wind that raises waves of a significant height.

    The inverse of `thalweg.sea.models.wind_sea.carter_1982`. The height there is the smallest of
    three that rise with the wind, so that the wind is the greatest of the three that belong to it:

    .. math::

        U = \max\left(\frac{H_s}{0.0163\,X^{1/2}},\;
            \left(\frac{H_s}{0.0146\,D^{5/7}}\right)^{7/9},\;
            \sqrt{\frac{H_s}{0.0248}}\right)

    with fetch X [km] and duration D [h].

    Parameters
    ----------
    height : array_like
        Significant wave height [m], at least 0.
    fetch : float
        Length of open water over which the wind has blown [m], above 0.
    duration : float
        Time for which it has blown [s], above 0.

    Returns
    -------
    float64 array
        Wind speed at 10 m [m/s], of the shape of ``height``.

    Notes
    -----
    Swell counts as waves of a local wind. In 500 km and 24 h waves above 3.5 m are not fully
    developed: the wind is above that of a Pierson-Moskowitz sea, 13.5 m/s for 4 m (13.3 there) and
    23.1 m/s for 8 m (18.8 there).

    References
    ----------
    .. [1] Carter, D.J.T. (1982). Prediction of wave height and period for a constant wind velocity
       using the JONSWAP results. *Ocean Engineering* 9(1), 17-33.
    """
    waves = np.asarray(height, float)
    root_km, hours = np.sqrt(fetch / 1000.0), duration / HOUR
    of_duration = (waves / (0.0146 * hours ** (5 / 7))) ** (7 / 9)
    wind = np.maximum(waves / (0.0163 * root_km), of_duration)
    return np.maximum(wind, np.sqrt(waves / 0.0248))


class WindOfWavesLayer(DerivedLayer):
    """The wind that raises the waves of other layers (`carter_1982_wind`); it blows with them.

    Where the waves have a height and no direction, the wind is unknown.

    Attributes
    ----------
    layers : tuple of Layer
        Layers that hold the waves, in order of priority.
    """

    needed = (nm.WAVE_HEIGHT, *nm.WAVES.pair)
    derived = frozenset(nm.WIND.pair)
    source_text = "from the waves of"

    def _values(
        self, needed: Mapping[str, FloatArray], lat: FloatArray, lon: FloatArray
    ) -> dict[str, FloatArray]:
        height, east, north = (np.asarray(needed[name], float) for name in self.needed)
        length = np.hypot(east, north)
        # a vector of length zero stands for waves from ahead, which no wind of the sea can be
        length = np.where(length > 0.0, length, np.nan)
        speed = carter_1982_wind(height)
        wind = {name: speed * part / length for name, part in zip(nm.WIND.pair, (east, north))}
        return {name: np.where(height == 0.0, 0.0, part) for name, part in wind.items()}

    def provenance(self) -> Mapping[str, Any]:
        """Return the method and its assumed fetch [m] and duration [s]."""
        return {"kind": "wind from waves", "method": "Carter (1982), inverted",
                "fetch_m": DEFAULT_FETCH, "duration_s": DEFAULT_DURATION}  # fmt: skip


def wind_of_waves_layer(layers: Sequence[Layer]) -> WindOfWavesLayer:
    """Return a layer of the wind that raises the waves of the layers.

    Parameters
    ----------
    layers : Layers in order of priority.

    Raises
    ------
    InputError : If the layers hold no wave height, or no direction of the waves.
    """
    variables = stack_variables(layers)
    directed = [one for one in layers if not isinstance(one, HeadSeasLayer)]
    if nm.WAVE_HEIGHT not in variables or not set(nm.WAVES.pair) <= stack_variables(directed):
        lacking = "direction of the waves" if nm.WAVE_HEIGHT in variables else "waves"
        raise InputError(
            f"The wind is to be derived from the waves, but the sea holds no {lacking}.",
            f"The sea holds: {nm.plain_names(variables)}.",
            "Add wave height and direction, or fill the wind with its parts: wind=EAST,NORTH.",
        )
    return WindOfWavesLayer(tuple(layers))
