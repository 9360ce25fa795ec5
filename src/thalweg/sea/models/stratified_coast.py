"""An analytic current along a stratified coast, such as that of Holland.

A tidal ellipse that varies over the water column (Prandle, 1982), plus the density current of fresh
water from a river (Heaps, 1972). Both decay away from the coast and are averaged over the ship's
draught. The scenarios range from neap tide (stratified: the ellipse at the surface is wide and
rotates clockwise) to spring tide (mixed: the tide is rectilinear along the coast), after Schless
(2023), *Going with the flow*, Table 4.9 and eqs. 3.73-3.74.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.geodesy import MEAN_RADIUS, longitude_difference
from thalweg.core.time import TimeLike, parse_time
from thalweg.core.types import FloatArray
from thalweg.sea import standard_names as nm
from thalweg.sea.models.current_profiles import WaterColumn, density_mean, tidal_mean, tidal_profile

CurrentFunction: TypeAlias = Callable[[FloatArray, FloatArray, FloatArray], FloatArray]

M2_PERIOD: Final = 44700.0  #: [s] the period of Schless (2023), sec. 4.3.1
DECAY_LENGTH: Final = 50e3  #: [m] offshore distance over which currents fall to 1/e (eq. 3.73)


@dataclass(frozen=True)
class TidalEllipse:
    """A tidal ellipse at the surface, long axis along the coast (Schless, 2023, Table 4.9).

    Attributes
    ----------
    alongshore, cross_shore : Amplitudes at the surface [m/s]; the current vector rotates clockwise.
    """

    alongshore: float
    cross_shore: float


TIDAL_ELLIPSES: Final[dict[str, TidalEllipse]] = {
    "neap": TidalEllipse(0.7, 0.35),
    "neap-to-mean": TidalEllipse(0.8, 0.2),
    "mean-to-spring": TidalEllipse(0.9, 0.1125),
    "spring": TidalEllipse(1.0, 0.0625),
}


def stratified_coast_current(
    scenario: str | TidalEllipse = "neap",
    *,
    coast: tuple[float, float],
    onshore_deg: float,
    flood: TimeLike,
    draught: float = 0.0,
    column: WaterColumn | None = None,
    density_gradient: float = -2e-4,
    decay: float = DECAY_LENGTH,
) -> dict[str, CurrentFunction]:
    """Return functions of the current for `Sea.from_functions`.

    Parameters
    ----------
    scenario : str or TidalEllipse
        "neap", "neap-to-mean", "mean-to-spring", "spring" or an ellipse at the surface.
    coast : (float, float)
        A point (lat, lon) [deg] of the coast, which is straight.
    onshore_deg : float
        Direction [deg] from the sea at right angles to the coast; the current along the coast is
        positive to the left of it (north, for a coast that faces west).
    flood : time
        A time of maximum tidal current along the coast at the surface.
    draught : float
        Depth [m] over which the current is averaged; 0 for the surface.
    column : WaterColumn, optional
        The water column; by default 25 m at neap tide off the Rhine, with the M2 period of
        44,700 s. Its ``frequency`` is that of the tide.
    density_gradient : float
        Change of density towards the coast [kg/m4]; 0 omits the density current.
    decay : float
        Offshore distance [m] over which the currents fall to 1/e; infinite for none. On land
        they have their values at the coast.

    Returns
    -------
    dict of str to callable
        East and north components ``f(time, lat, lon)`` [m/s].

    Raises
    ------
    InputError
        If the draught is greater than the depth, or a value is outside its range.

    Examples
    --------
    >>> from thalweg.sea import Sea
    >>> current = stratified_coast_current(
    ...     "neap", coast=(52.1, 4.26), onshore_deg=90.0, flood=0.0, draught=5.0
    ... )
    >>> sea = Sea.from_functions(current)
    >>> [round(float(v), 2) for v in sea.sample(list(nm.CURRENT.pair), 0.0, 52.1, 4.26).values()]
    [-0.05, 0.94]
    """
    water = column or WaterColumn(frequency=2.0 * np.pi / M2_PERIOD)
    if not (decay > 0.0 and np.isfinite(onshore_deg)):
        raise InputError(
            f"The decay length is {decay!r} m and the onshore direction {onshore_deg!r} degrees.",
            "The length must be positive (infinite for no decay), the direction finite.",
            "Correct them.",
        )
    plus, minus = ellipse_phasors(scenario, water, draught)
    steady = (
        complex(*density_mean(draught, water, density_gradient=density_gradient))
        if density_gradient
        else 0j
    )
    start = parse_time(flood)
    bearing = np.radians(onshore_deg)
    onshore = complex(np.sin(bearing), np.cos(bearing))  # east + i north of the axis to the coast

    def current(time: FloatArray, lat: FloatArray, lon: FloatArray) -> FloatArray:
        angle = water.frequency * (time - start)
        turned = plus * np.exp(1j * angle) + minus * np.exp(-1j * angle) + steady
        offshore = np.maximum(0.0, -_distance_from_coast(lat, lon, coast, onshore))
        return np.asarray(turned * onshore * np.exp(-offshore / decay))

    return {
        nm.EASTWARD_CURRENT: lambda time, lat, lon: current(time, lat, lon).real,
        nm.NORTHWARD_CURRENT: lambda time, lat, lon: current(time, lat, lon).imag,
    }


def ellipse_phasors(
    scenario: str | TidalEllipse, column: WaterColumn, draught: float = 0.0
) -> tuple[complex, complex]:
    r"""Return the anticlockwise and clockwise phasors of the tide, averaged over a draught.

    .. math:: W_\pm = i (M \pm m) / 2

    The depth-mean phasors W are those for which the profiles give the scenario's ellipse at the
    surface: with the x axis onshore and y along the coast, ``i (M + m) / 2`` and ``i (M - m) / 2``
    with the alongshore amplitude M and m = - cross-shore amplitude (clockwise).

    Parameters
    ----------
    scenario : Name of a scenario, or an ellipse at the surface.
    draught : Draught [m]; 0 for the surface.

    Returns
    -------
    plus, minus : Phasors [m/s].

    References
    ----------
    Prandle (1982), as in `thalweg.sea.models.current_profiles`.
    """
    ellipse = _tidal_ellipse(scenario)
    long, short = ellipse.alongshore, -ellipse.cross_shore
    surface = tidal_profile(column.depth, column)
    hull = tidal_mean(draught, column)
    plus = 0.5j * (long + short) * hull[0] / complex(surface[0])
    minus = 0.5j * (long - short) * hull[1] / complex(surface[1])
    return plus, minus


def _tidal_ellipse(scenario: str | TidalEllipse) -> TidalEllipse:
    if isinstance(scenario, str):
        if scenario not in TIDAL_ELLIPSES:
            raise unknown_name_error("tidal scenario", scenario, TIDAL_ELLIPSES)
        return TIDAL_ELLIPSES[scenario]
    if not (scenario.alongshore > 0.0 and 0.0 <= scenario.cross_shore <= scenario.alongshore):
        raise InputError(
            f"{scenario} is not an ellipse along the coast.",
            "The alongshore amplitude must be positive and at least the cross-shore amplitude.",
            "Correct the amplitudes.",
        )
    return scenario


def _distance_from_coast(
    lat: FloatArray, lon: FloatArray, coast: tuple[float, float], onshore: complex
) -> FloatArray:
    """Return the distance [m] from the coast along the onshore axis; negative at sea."""
    north = np.radians(lat - coast[0])
    east = np.radians(longitude_difference(lon, coast[1])) * np.cos(np.radians(coast[0]))
    return np.asarray(MEAN_RADIUS * (east * onshore.real + north * onshore.imag))
