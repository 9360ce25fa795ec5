"""Waves raised by the wind, where no data tell waves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.bounding_box import WORLD, BoundingBox
from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray
from thalweg.sea import standard_names as nm
from thalweg.sea.coverage import Coverage
from thalweg.sea.grids.triangle_mesh import Mesh
from thalweg.sea.layer import Samples

if TYPE_CHECKING:
    from thalweg.sea.sea import Sea

DEFAULT_FETCH = 500_000.0  #: [m] over which the wind is taken to have blown
DEFAULT_DURATION = 24.0 * 3600.0  #: [s] for which it is taken to have blown
_VARIABLES = frozenset({nm.WAVE_HEIGHT, *nm.WAVES.pair, nm.WAVE_PERIOD})


def carter_1982(
    wind_speed: ArrayLike, *, fetch: float = DEFAULT_FETCH, duration: float = DEFAULT_DURATION
) -> tuple[FloatArray, FloatArray]:
    """Return significant height [m] and peak period [s] of the waves that a steady wind raises.

    Parameters
    ----------
    wind_speed : array_like
        At 10 m [m/s], at least 0.
    fetch : float
        Water over which it has blown [m].
    duration : float
        Time for which it has blown [s].

    Returns
    -------
    height, period : ndarray
        The least of the sea limited by fetch, that limited by duration and the fully grown one.

    Raises
    ------
    InputError
        If fetch or duration is not positive.

    Notes
    -----
    Carter, D.J.T. (1982), "Prediction of wave height and period for a constant wind velocity using
    the JONSWAP results", *Ocean Engineering* 9(1), 17-33; as given in WMO-No. 702, Guide to Wave
    Analysis and Forecasting, with fetch X [km] and duration D [h]:
    ``H = 0.0163 X^(1/2) U``, ``T = 0.566 X^0.3 U^0.4``; ``H = 0.0146 D^(5/7) U^(9/7)``,
    ``T = 0.540 D^(3/7) U^(4/7)``; ``H = 0.0248 U^2``, ``T = 0.729 U``. The coefficients are quoted
    from memory of the guide and were not compared with its print.
    """
    if not (fetch > 0.0 and duration > 0.0):
        raise InputError(
            f"A fetch of {fetch:g} m and a duration of {duration:g} s raise no waves.",
            "Both are above zero.",
            "Correct them.",
        )
    wind = np.asarray(wind_speed, float)
    km, hours = fetch / 1000.0, duration / 3600.0
    height = np.minimum(0.0163 * np.sqrt(km) * wind, 0.0146 * hours ** (5 / 7) * wind ** (9 / 7))
    period = np.minimum(0.566 * km**0.3 * wind**0.4, 0.540 * hours ** (3 / 7) * wind ** (4 / 7))
    return np.minimum(height, 0.0248 * wind**2), np.minimum(period, 0.729 * wind)


@dataclass(frozen=True, eq=False)
class WindSeaLayer:
    """Waves of the wind of a sea; they travel with it.

    Attributes
    ----------
    sea : Sea
        Holds the wind; where that is unknown the waves are.
    """

    sea: Sea

    @property
    def variables(self) -> frozenset[str]:
        """Height, direction and peak period of the waves."""
        return _VARIABLES

    @property
    def area(self) -> BoundingBox:
        """The world: the wind says where it is known."""
        return WORLD

    @property
    def period(self) -> tuple[float, float] | None:
        """That of the wind."""
        start, end = self.sea.period_of(nm.WIND.pair)
        return (start, end) if np.isfinite([start, end]).all() else None

    def sample(
        self, names: Sequence[str], time: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        """Return values at points; NaN where the wind is unknown."""
        return _waves_from_wind(names, self.sea.sample(list(nm.WIND.pair), time, lat, lon))

    def series(
        self, names: Sequence[str], times: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        """Return values (S, T) at stations for all times."""
        return _waves_from_wind(names, self.sea.series(list(nm.WIND.pair), times, lat, lon))

    def times(self, start: float, end: float) -> FloatArray:
        """Return the times of the wind."""
        return self.sea.times(start, end, names=nm.WIND.pair)

    def inside(self, lat: FloatArray, lon: FloatArray) -> NDArray[np.bool_]:
        """Return whether positions lie where the wind may be known."""
        windy = [x for x in self.sea.layers if set(nm.WIND.pair) & x.variables]
        return np.any([x.inside(lat, lon) for x in windy], axis=0)

    def coverage(self) -> list[Coverage]:
        """Return the rows of the wind, for waves."""
        rows = [row for row in self.sea.coverage() if row.variable == nm.EASTWARD_WIND]
        return [
            replace(row, variable=name, source=f"from the wind of {row.source}")
            for row in rows
            for name in sorted(_VARIABLES)
        ]

    def mesh(self) -> Mesh | None:
        """No mesh of its own."""
        return None

    def provenance(self) -> Mapping[str, Any]:
        """Return how the waves were made."""
        return {"kind": "waves from wind", "method": "Carter (1982)", "fetch_m": DEFAULT_FETCH,
                "duration_s": DEFAULT_DURATION}  # fmt: skip


def _waves_from_wind(names: Sequence[str], wind: Mapping[str, FloatArray]) -> Samples:
    east, north = (np.asarray(wind[name], float) for name in nm.WIND.pair)
    speed = np.hypot(east, north)
    height, period = carter_1982(speed)
    still = np.where(speed > 0.0, speed, 1.0)
    made = {
        nm.WAVE_HEIGHT: height,
        nm.WAVE_PERIOD: np.maximum(period, 1.0),
        nm.WAVE_TO_EAST: east / still,
        nm.WAVE_TO_NORTH: np.where(speed == 0.0, 1.0, north / still),
    }
    return {name: made[name] for name in names if name in made}
