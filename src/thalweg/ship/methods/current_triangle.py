"""The current triangle with crab angle, and Schless's rudder drag as an option."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.errors import unknown_name_error
from thalweg.core.units import SEA_WATER_DENSITY
from thalweg.ship.methods.array_conversion import Floats, as_float_array

#: Rudder drag coefficient read off Lübke (2016) by Schless (2023), Fig. 3.7: degrees -> C_D.
LUEBKE_ANGLES_DEG: Final = (0.0, 10.0, 20.0, 30.0, 35.0)
LUEBKE_DRAG: Final = (0.0, 0.09, 0.23, 0.45, 0.57)
LARGEST_RUDDER_ANGLE: Final = float(np.radians(35.0))  #: end of the nodes [rad]


@dataclass(frozen=True)
class CurrentTriangle:
    """How a ship holds a course over the ground through a current.

    Parameters
    ----------
    speed_over_ground : ndarray
        [m/s]; NaN where the course cannot be held or data are unknown.
    heading : ndarray
        Heading [rad], clockwise from north, 0 to 2 pi.
    crab_angle : ndarray
        Heading minus course [rad], positive to starboard.
    possible : ndarray of bool
        Whether the ship makes way on the course; False where anything is unknown.
    """

    speed_over_ground: Floats
    heading: Floats
    crab_angle: Floats
    possible: NDArray[np.bool_]


def current_triangle(
    speed: ArrayLike, course: ArrayLike, *, current_east: ArrayLike, current_north: ArrayLike
) -> CurrentTriangle:
    """Return speed over ground, heading and crab angle on a course through a current.

    With the current along the course c and across it to starboard s:
    SOG = sqrt(STW^2 - s^2) + c, crab angle = -asin(s / STW).

    Parameters
    ----------
    speed : array_like
        Speed through the water [m/s].
    course : array_like
        Course over the ground [rad], clockwise from north.
    current_east, current_north : array_like
        Current, where it flows to [m/s].

    Returns
    -------
    CurrentTriangle
        Possible where the current across is not stronger than the ship and the ship gets ahead.

    Notes
    -----
    Exact vector addition. Schless (2023), eqs. 3.46, 3.57 to 3.64, adds the current along the
    course to the ship's speed before taking the angle, and swaps the components along and across
    in eqs. 3.61, 3.62, 3.67 and 3.68; that changes the energies there by -0.26 to +0.26 %.
    van Halem (2019), eq. 2.4, prints tanh for atan2.
    """
    stw, course_ = as_float_array(speed), as_float_array(course)
    sin, cos = np.sin(course_), np.cos(course_)
    along = as_float_array(current_east) * sin + as_float_array(current_north) * cos
    across = as_float_array(current_east) * cos - as_float_array(current_north) * sin
    with np.errstate(divide="ignore", invalid="ignore"):
        ahead = np.sqrt(stw**2 - across**2)
        ground = ahead + along
        possible = (ground > 0.0) & (stw > 0.0)
        crab = -np.arcsin(np.where(possible, across / np.where(stw > 0.0, stw, np.nan), np.nan))
    return CurrentTriangle(
        speed_over_ground=np.where(possible, ground, np.nan),
        heading=np.mod(course_ + crab, 2.0 * np.pi),
        crab_angle=crab,
        possible=possible,
    )


def distance_through_water(
    distance: ArrayLike, *, speed: ArrayLike, speed_over_ground: ArrayLike
) -> Floats:
    """Return the way made through the water: STW s / SOG [m].

    Parameters
    ----------
    distance : array_like
        Way over the ground [m].
    speed, speed_over_ground : array_like
        [m/s].

    Returns
    -------
    ndarray
        Way through the water [m].

    Notes
    -----
    Schless (2023), eqs. 3.56, 3.60 and 3.64, divides by the cosine of the drift angle as well,
    which counts the current twice.
    """
    return as_float_array(speed) * as_float_array(distance) / as_float_array(speed_over_ground)


def _monotone_slopes(x: Floats, y: Floats) -> Floats:
    """Return node slopes of the monotone cubic of Fritsch and Butland (1984)."""
    h, d = np.diff(x), np.diff(y) / np.diff(x)
    w1, w2 = 2.0 * h[1:] + h[:-1], h[1:] + 2.0 * h[:-1]
    inner = (w1 + w2) / (w1 / d[:-1] + w2 / d[1:])
    return np.concatenate(([d[0] * 2.0 - inner[0]], inner, [2.0 * d[-1] - inner[-1]]))


_NODE_ANGLES_DEG, _NODE_DRAG = np.array(LUEBKE_ANGLES_DEG), np.array(LUEBKE_DRAG)
_NODE_SLOPES = np.clip(_monotone_slopes(_NODE_ANGLES_DEG, _NODE_DRAG), 0.0, None)


def _interpolated_drag(degrees: Floats) -> Floats:
    """Return the monotone cubic through the nodes."""
    i = np.clip(
        np.searchsorted(_NODE_ANGLES_DEG, degrees, side="right") - 1, 0, _NODE_ANGLES_DEG.size - 2
    )
    h = _NODE_ANGLES_DEG[i + 1] - _NODE_ANGLES_DEG[i]
    t = (degrees - _NODE_ANGLES_DEG[i]) / h
    value: Floats = (
        (1.0 + 2.0 * t) * (1.0 - t) ** 2 * _NODE_DRAG[i]
        + t * (1.0 - t) ** 2 * h * _NODE_SLOPES[i]
        + t**2 * (3.0 - 2.0 * t) * _NODE_DRAG[i + 1]
        + t**2 * (t - 1.0) * h * _NODE_SLOPES[i + 1]
    )
    return value


def rudder_drag_coefficient(angle: ArrayLike, *, curve: str = "nodes") -> Floats:
    """Return the drag coefficient of a semi-balanced rudder at an angle.

    Parameters
    ----------
    angle : array_like
        Angle of attack [rad], either side.
    curve : str
        ``nodes``, a monotone cubic through the points read off Lübke's figure, or ``quadratic``,
        Schless's fit 3.0777e-4 d^2 + 5.5666e-3 d + 6.54e-4 with d in degrees, 0 at d = 0.

    Returns
    -------
    ndarray
        C_D [-]; NaN beyond 35 degrees.

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
        return _interpolated_drag(degrees)
    quadratic = (3.0777e-4 * degrees + 5.5666e-3) * degrees + 6.54e-4
    return np.where(degrees == 0.0, 0.0, quadratic)


def rudder_drag(
    speed: ArrayLike,
    crab_angle: ArrayLike,
    *,
    rudder_area: ArrayLike,
    density: ArrayLike = SEA_WATER_DENSITY,
    curve: str = "nodes",
) -> Floats:
    """Return Schless's rudder drag in a cross current: 1/2 rho C_D(crab angle) A V^2 [N].

    Parameters
    ----------
    speed : array_like
        Speed through the water [m/s].
    crab_angle : array_like
        Heading minus course [rad].
    rudder_area : array_like
        Lateral area of the rudder [m2].
    density : array_like
        [kg/m3].
    curve : str
        As in `rudder_drag_coefficient`.

    Returns
    -------
    ndarray
        Resistance [N].

    Notes
    -----
    Do not use this without need. In a uniform current a ship holds its heading with no drift
    through the water: hull and rudder move with the water and feel no oblique flow (Galilean
    invariance). The crab angle is an angle over the ground, not an angle of attack. The 1 to
    1.7 % of speed lost in Table 4.5 of Schless (2023) at 30 to 150 degrees comes from the model,
    not from the sea. It is here so that the tables there can be repeated.

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
