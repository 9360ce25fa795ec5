"""The speed that the depth allows: by the flow around the ship, and by its squat."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray
from thalweg.core.units import GRAVITY
from thalweg.ship.methods.array_conversion import as_float_array
from thalweg.ship.methods.shallow_water.barrass_squat import barrass_speed, waterway_width

_DEEP_WATER_DEPTH: Final = 1e5  # used as infinite depth [m]
_LANDWEBER: Final = (1.002, 0.005, -0.1159, 0.0191)
#: Where Landweber's cubic is least: 0 = c1 + 2 c2 q + 3 c3 q^2. Beyond, it would rise again.
_LARGEST_BLOCKAGE_PARAMETER: Final = float(
    np.polynomial.Polynomial(_LANDWEBER).deriv().roots().max()
)


def shallow_water_speed(
    deep_speed: ArrayLike,
    depth: ArrayLike,
    *,
    draught: ArrayLike,
    breadth: ArrayLike,
    channel_width: ArrayLike | None = None,
    gravity: float = GRAVITY,
) -> FloatArray:
    r"""Return the speed in shallow water at the power of a deep-water speed.

    .. math::
        V = V_{max} \sqrt{\tanh(g h / V_{max}^2)}
            (1.002 + 0.005 q - 0.1159 q^2 + 0.0191 q^3), \quad q = \sqrt{A_s} / R_H, \\
        A_s = B T, \quad R_H = (b h - A_s) / (b + 2 h + 2 T + B)

    q is the root of the midship section over the hydraulic radius.

    Parameters
    ----------
    deep_speed : array_like
        Speed through deep water V_max [m/s].
    depth, draught, breadth : array_like
        Water depth h, draught T and breadth B [m].
    channel_width : array_like, optional
        Width b of the waterway [m]; without it 9 B, open water.
    gravity : float
        Acceleration of gravity g [m/s2].

    Returns
    -------
    ndarray
        Speed through the water [m/s], between 0 and ``deep_speed``; 0 where the ship fills the
        waterway or the depth is not positive. The depth may be infinite.

    Notes
    -----
    The polynomial exceeds one by up to 0.2 % for very small q; it is limited to one. It has its
    least value, 0.39, at q = 4.02, where the ship nearly fills a channel; beyond, this value is
    used (the polynomial rises again, so that a narrower channel would allow a higher speed).

    References
    ----------
    O. Schlichting (1934) and L. Landweber (1939) as used by van Oord; van Halem (2019), eq. 2.5,
    where V_max and the root of the tanh are missing and 0.0191 is rounded to 0.019.
    """
    v, h = as_float_array(deep_speed), np.minimum(as_float_array(depth), _DEEP_WATER_DEPTH)
    b, width = as_float_array(breadth), waterway_width(breadth, channel_width)
    section = b * as_float_array(draught)
    free = width * h - section
    open_water = (free > 0.0) & (h > 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        schlichting = np.where(v > 0.0, np.sqrt(np.tanh(gravity * h / v**2)), 1.0 + 0.0 * h)
        radius = free / (width + 2.0 * h + 2.0 * as_float_array(draught) + b)
        q = np.sqrt(section) / np.where(open_water, radius, np.nan)
        q = np.minimum(q, _LARGEST_BLOCKAGE_PARAMETER)
        landweber = np.minimum(np.polynomial.polynomial.polyval(q, _LANDWEBER), 1.0)
    blocked = np.where(np.isnan(free * v), np.nan, 0.0)
    return np.where(open_water, v * schlichting * landweber, blocked)


def shallow_water_speed_limit(
    deep_speed: ArrayLike,
    depth: ArrayLike,
    *,
    draught: ArrayLike,
    breadth: ArrayLike,
    block_coefficient: ArrayLike,
    clearance: ArrayLike = 0.0,
    channel_width: ArrayLike | None = None,
    gravity: float = GRAVITY,
) -> FloatArray:
    r"""Return the speed a depth allows: the smaller of `shallow_water_speed` and `barrass_speed`.

    .. math:: V = \min(V_{shallow}(h), V_{squat}(h - T - c))

    The squat that is allowed is the depth h less the draught T and the clearance c.

    Parameters
    ----------
    deep_speed : array_like
        Speed through deep water [m/s].
    depth, draught, breadth : array_like
        Water depth, draught and breadth [m].
    block_coefficient : array_like
        Block coefficient [-].
    clearance : array_like
        Water that must remain under the sunken ship [m].
    channel_width : array_like, optional
        Width of the waterway [m]; without it 9 B, open water.
    gravity : float
        Acceleration of gravity [m/s2].

    Returns
    -------
    ndarray
        Speed through the water [m/s]; 0 where the clearance allows no squat.

    Notes
    -----
    Two errors of the program released with van Halem (2019), HALEM 1.0.3, are not repeated: the
    block coefficient was worked out with the density in kg/m3 and the weight in tonnes, so it was
    a thousand times too small and the squat limit never acted; and the speed of the Barrass
    formula, in knots, was compared with metres per second.

    References
    ----------
    J. P. van Halem, "Route optimization in dynamic currents", TU Delft (2019), eq. 2.5, corrected.
    """
    critical = shallow_water_speed(
        deep_speed,
        depth,
        draught=draught,
        breadth=breadth,
        channel_width=channel_width,
        gravity=gravity,
    )
    room = as_float_array(depth) - as_float_array(draught) - as_float_array(clearance)
    squatting = barrass_speed(
        room,
        depth,
        draught=draught,
        breadth=breadth,
        block_coefficient=block_coefficient,
        channel_width=channel_width,
    )
    return np.minimum(critical, squatting)


def dynamic_under_keel_clearance(
    depth: ArrayLike, draught: ArrayLike, *, squat: ArrayLike
) -> FloatArray:
    """Return the water under the keel of a moving ship: depth - draught - squat [m].

    Parameters
    ----------
    depth, draught, squat : Water depth, draught at rest and squat [m].

    Returns
    -------
    ndarray : Clearance [m], negative where the ship would touch the bed.
    """
    return as_float_array(depth) - as_float_array(draught) - as_float_array(squat)
