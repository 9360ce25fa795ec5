"""The current triangle: crab angle and speed over ground; the rudder drag of Schless (2023)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.errors import unknown_name_error
from thalweg.core.types import FloatArray
from thalweg.core.units import SEA_WATER_DENSITY
from thalweg.ship.methods.array_conversion import as_float_array

#: Rudder drag coefficient read off Lübke (2016) by Schless (2023), Fig. 3.7: degrees -> C_D.
LUEBKE_ANGLES_DEG: Final = (0.0, 10.0, 20.0, 30.0, 35.0)
LUEBKE_DRAG: Final = (0.0, 0.09, 0.23, 0.45, 0.57)
LARGEST_RUDDER_ANGLE: Final = float(np.radians(35.0))  #: end of the nodes [rad]


@dataclass(frozen=True)
class CurrentTriangle:
    """Heading and speed of a ship that holds a course over ground in a current.

    Attributes
    ----------
    speed_over_ground : [m/s]; NaN where the course cannot be held or data are unknown.
    heading : Heading [rad], clockwise from north, 0 to 2 pi.
    crab_angle : Heading minus course [rad], positive to starboard.
    possible : ndarray of bool
        Whether the ship can hold the course and make headway; False where anything is unknown.
    """

    speed_over_ground: FloatArray
    heading: FloatArray
    crab_angle: FloatArray
    possible: NDArray[np.bool_]


def current_along_and_across(
    current_east: ArrayLike, current_north: ArrayLike, course: ArrayLike
) -> tuple[FloatArray, FloatArray]:
    """Return the current along a course and across it.

    Parameters
    ----------
    current_east, current_north : Current, towards [m/s].
    course : Course over ground [rad], clockwise from north.

    Returns
    -------
    along, across : c = u sin C + v cos C, and s = u cos C - v sin C, positive to starboard [m/s].
    """
    east, north = np.sin(course), np.cos(course)
    u, v = as_float_array(current_east), as_float_array(current_north)
    return u * east + v * north, u * north - v * east


def crab_angle(across: ArrayLike, speed: ArrayLike) -> FloatArray:
    """Return heading minus course, -asin(s / V).

    Parameters
    ----------
    across : Current across the course, positive to starboard [m/s].
    speed : Speed through water [m/s].

    Returns
    -------
    ndarray : [rad], positive where the bow points to starboard of the course; 0 where the speed is
        unknown or not positive, and -pi/2 or pi/2 where the current across is stronger than the
        ship.
    """
    s, v = as_float_array(across), as_float_array(speed)
    with np.errstate(invalid="ignore", divide="ignore"):
        sine = np.where(v > 0.0, s / v, 0.0)
    return -np.arcsin(np.clip(np.where(np.isfinite(sine), sine, 0.0), -1.0, 1.0))


def speed_over_ground(speed: ArrayLike, along: ArrayLike, across: ArrayLike) -> FloatArray:
    """Return the speed over ground on the course, c + sqrt(V^2 - s^2).

    Parameters
    ----------
    speed : Speed through water [m/s].
    along, across : Current along the course and across it, as in `current_along_and_across` [m/s].

    Returns
    -------
    ndarray : [m/s]; NaN where the current across is not weaker than the ship, where the ship makes
        no headway, and where anything is unknown.
    """
    v, c, s = as_float_array(speed), as_float_array(along), as_float_array(across)
    with np.errstate(invalid="ignore"):
        ground = c + np.sqrt(v * v - s * s)
        return np.where((ground > 0.0) & (v > np.abs(s)), ground, np.nan)


def current_triangle(
    speed: ArrayLike, course: ArrayLike, *, current_east: ArrayLike, current_north: ArrayLike
) -> CurrentTriangle:
    r"""Return speed over ground, heading and crab angle on a course through a current.

    .. math:: V_G = c + \sqrt{V^2 - s^2}, \quad \text{crab angle} = -\sin^{-1}(s / V)

    With the current along the course c and across it to starboard s, and the speed through
    water V: speed over ground = c + sqrt(V^2 - s^2), crab angle = -asin(s / V).

    Parameters
    ----------
    speed : Speed through the water [m/s].
    course : Course over the ground [rad], clockwise from north.
    current_east, current_north : Current, where it flows to [m/s].

    Returns
    -------
    CurrentTriangle
        Possible where the current across is weaker than the ship and the ship makes headway.

    Notes
    -----
    Exact vector addition. Schless (2023), eqs. 3.46, 3.57 to 3.64, adds the current along the
    course to the ship's speed before taking the angle, and swaps the components along and across
    in eqs. 3.61, 3.62, 3.67 and 3.68; this changes his energies by -0.26 to +0.26 %.
    van Halem (2019), eq. 2.4, prints tanh for atan2.

    References
    ----------
    van Halem (2019), eq. 2.4, and Schless (2023), eqs. 3.46 and 3.57 to 3.64, corrected (see
    the notes).
    """
    along, across = current_along_and_across(current_east, current_north, course)
    ground = speed_over_ground(speed, along, across)
    possible = np.isfinite(ground)
    crab = np.where(possible, crab_angle(across, speed), np.nan)
    return CurrentTriangle(
        speed_over_ground=ground,
        heading=np.mod(as_float_array(course) + crab, 2.0 * np.pi),
        crab_angle=crab,
        possible=possible,
    )


def _monotone_slopes(x: FloatArray, y: FloatArray) -> FloatArray:
    """Return node slopes of the monotone cubic of Fritsch and Butland (1984)."""
    h, d = np.diff(x), np.diff(y) / np.diff(x)
    w1, w2 = 2.0 * h[1:] + h[:-1], h[1:] + 2.0 * h[:-1]
    inner = (w1 + w2) / (w1 / d[:-1] + w2 / d[1:])
    return np.concatenate(([d[0] * 2.0 - inner[0]], inner, [2.0 * d[-1] - inner[-1]]))


_NODE_ANGLES_DEG, _NODE_DRAG = np.array(LUEBKE_ANGLES_DEG), np.array(LUEBKE_DRAG)


@cache
def _drag_curve() -> Callable[[FloatArray], FloatArray]:
    """Return the monotone cubic through the nodes, a function of degrees."""
    from scipy.interpolate import CubicHermiteSpline

    slopes = np.clip(_monotone_slopes(_NODE_ANGLES_DEG, _NODE_DRAG), 0.0, None)
    return CubicHermiteSpline(_NODE_ANGLES_DEG, _NODE_DRAG, slopes)


def rudder_drag_coefficient(angle: ArrayLike, *, curve: str = "nodes") -> FloatArray:
    """Return the drag coefficient of a semi-balanced rudder at an angle.

    Parameters
    ----------
    angle : Angle of attack [rad], either side.
    curve : str
        ``nodes``, a monotone cubic through the points read off Lübke's figure, or ``quadratic``,
        Schless's fit 3.0777e-4 d^2 + 5.5666e-3 d + 6.54e-4 with d in degrees, 0 at d = 0.

    Returns
    -------
    ndarray : C_D [-]; NaN beyond 35 degrees.

    References
    ----------
    L. Lübke, "Investigation of a semi-balanced rudder" (2016), known only through the reading of
    S. E. Schless, "Going with the flow", TU Delft (2023), Fig. 3.7; F. N. Fritsch, J. Butland,
    SIAM J. Sci. Stat. Comput. 5 (1984).
    """
    if curve not in ("nodes", "quadratic"):
        raise unknown_name_error("rudder drag curve", curve, ("nodes", "quadratic"))
    degrees = np.degrees(np.abs(as_float_array(angle)))
    degrees = np.where(degrees <= LUEBKE_ANGLES_DEG[-1] + 1e-9, degrees, np.nan)
    if curve == "nodes":
        return np.asarray(_drag_curve()(degrees))
    quadratic = (3.0777e-4 * degrees + 5.5666e-3) * degrees + 6.54e-4
    return np.where(degrees == 0.0, 0.0, quadratic)


def rudder_drag(
    speed: ArrayLike,
    crab_angle: ArrayLike,
    *,
    rudder_area: ArrayLike,
    density: ArrayLike = SEA_WATER_DENSITY,
    curve: str = "nodes",
) -> FloatArray:
    """Return Schless's rudder drag in a cross current: 1/2 rho C_D(crab angle) A V^2 [N].

    Parameters
    ----------
    speed : Speed through the water [m/s].
    crab_angle : Heading minus course [rad].
    rudder_area : Lateral area of the rudder [m2].
    density : array_like [kg/m3]
    curve : As in `rudder_drag_coefficient`.

    Returns
    -------
    ndarray : Resistance [N].

    Notes
    -----
    Not recommended for planning. In a uniform current a ship holds its heading with no drift
    through the water: hull and rudder move with the water and feel no oblique flow (Galilean
    invariance). The crab angle is an angle over the ground, not an angle of attack. The 1 to
    1.7 % of speed lost in Table 4.5 of Schless (2023) at 30 to 150 degrees comes from the model,
    not from the sea. It is offered to reproduce the tables of that thesis.

    References
    ----------
    S. E. Schless, "Going with the flow", TU Delft (2023), section 3.3.1.
    """
    coefficient = rudder_drag_coefficient(crab_angle, curve=curve)
    return (
        0.5
        * as_float_array(density)
        * coefficient
        * as_float_array(rudder_area)
        * as_float_array(speed) ** 2
    )
