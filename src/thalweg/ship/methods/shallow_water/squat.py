"""Squat: sinkage of a ship by its own speed, and the speed that the depth allows."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray
from thalweg.core.units import GRAVITY, KNOT
from thalweg.ship.methods.array_conversion import as_float_array
from thalweg.ship.methods.validity import RangeNote, range_notes

#: Width of open water that takes part in the flow, in ship breadths (van Halem 2019).
OPEN_WATER_BREADTHS: Final = 9.0

_DEEP_WATER_DEPTH: Final = 1e5  # used as infinite depth [m]
_LANDWEBER: Final = (1.002, 0.005, -0.1159, 0.0191)
#: Where Landweber's cubic is least: 0 = c1 + 2 c2 q + 3 c3 q^2. Beyond, it would rise again.
_LARGEST_BLOCKAGE_PARAMETER: Final = float(
    np.polynomial.Polynomial(_LANDWEBER).deriv().roots().max()
)

#: Published ranges of both of Barrass's forms; deeper water is not reported: squat tends to zero.
_BLOCK_COEFFICIENT_RANGE: Final = (0.5, 0.9)
_LEAST_DEPTH_TO_DRAUGHT: Final = 1.1  # depth over draught


def _waterway_width(breadth: ArrayLike, channel_width: ArrayLike | None) -> FloatArray:
    if channel_width is None:
        return OPEN_WATER_BREADTHS * as_float_array(breadth)
    return as_float_array(channel_width)


def blockage_ratio(
    depth: ArrayLike,
    draught: ArrayLike,
    *,
    breadth: ArrayLike,
    channel_width: ArrayLike | None = None,
) -> FloatArray:
    """Return the blockage S2 = A_s / (b h - A_s): the ship's section over the water beside it.

    Parameters
    ----------
    depth, draught, breadth : array_like
        Water depth h, draught T and breadth B [m].
    channel_width : array_like, optional
        Width b of the waterway [m]; without it 9 B, open water.

    Returns
    -------
    ndarray
        Blockage [-]; infinite where the ship fills the waterway.

    References
    ----------
    C. B. Barrass, "The phenomenon of ship squat", Int. Shipbuilding Progress 26 (1979).
    """
    h, section = as_float_array(depth), as_float_array(breadth) * as_float_array(draught)
    free = _waterway_width(breadth, channel_width) * h - section
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(free > 0.0, section / free, np.where(np.isnan(free), np.nan, np.inf))


def barrass_squat(
    speed: ArrayLike,
    depth: ArrayLike,
    *,
    draught: ArrayLike,
    breadth: ArrayLike,
    block_coefficient: ArrayLike,
    channel_width: ArrayLike | None = None,
) -> FloatArray:
    """Return the largest squat by Barrass (1979): C_B S2^(2/3) V_kn^2.08 / 30.

    Parameters
    ----------
    speed : array_like
        Speed through the water [m/s].
    depth, draught, breadth : array_like
        Water depth, draught and breadth [m].
    block_coefficient : array_like
        Block coefficient [-], 0.5 to 0.9.
    channel_width : array_like, optional
        Width of the waterway [m]; without it 9 B, open water.

    Returns
    -------
    ndarray
        Squat [m], 0 at rest; infinite where the ship fills the waterway.

    Notes
    -----
    The speed of the formula is in knots; the conversion is done here. Published for
    depth/draught 1.1 to 1.5; at greater depth it tends to zero as it should.

    References
    ----------
    C. B. Barrass, "The phenomenon of ship squat", Int. Shipbuilding Progress 26 (1979).
    """
    blockage = blockage_ratio(depth, draught, breadth=breadth, channel_width=channel_width)
    knots = np.abs(as_float_array(speed)) / KNOT
    sink = knots**2.08 / 30.0
    with np.errstate(invalid="ignore"):
        return np.where(
            knots == 0.0,
            0.0 * blockage,
            as_float_array(block_coefficient) * blockage ** (2.0 / 3.0) * sink,
        )


def barrass_2004_squat(
    speed: ArrayLike,
    depth: ArrayLike,
    *,
    draught: ArrayLike,
    breadth: ArrayLike,
    block_coefficient: ArrayLike,
    channel_width: ArrayLike | None = None,
) -> FloatArray:
    """Return the largest squat by Barrass's later form: C_B K^0.81 V_kn^2.08 / 20.

    K = B T / (b h) is the blockage factor; without a channel width b is Barrass's width of
    influence 7.04 B / C_B^0.85 (that constant is from memory). Published for C_B 0.5 to 0.9,
    depth/draught 1.1 to 1.4 and K 0.100 to 0.265.

    Parameters
    ----------
    speed : array_like
        Speed through the water [m/s].
    depth, draught, breadth : array_like
        Water depth, draught and breadth [m].
    block_coefficient : array_like
        Block coefficient [-].
    channel_width : array_like, optional
        Width of the waterway [m].

    Returns
    -------
    ndarray
        Squat [m].

    References
    ----------
    C. B. Barrass, "Thirty-two years of research into ship squat", Squat Workshop, Oldenburg
    (2004).
    """
    block = as_float_array(block_coefficient)
    width = (
        7.04 / block**0.85 * as_float_array(breadth)
        if channel_width is None
        else as_float_array(channel_width)
    )
    h = as_float_array(depth)
    knots = np.abs(as_float_array(speed)) / KNOT
    with np.errstate(divide="ignore", invalid="ignore"):
        blockage = (
            as_float_array(breadth) * as_float_array(draught) / (width * np.where(h > 0, h, np.nan))
        )
        return block * blockage**0.81 * knots**2.08 / 20.0


def barrass_2004_speed(
    squat: ArrayLike,
    depth: ArrayLike,
    *,
    draught: ArrayLike,
    breadth: ArrayLike,
    block_coefficient: ArrayLike,
    channel_width: ArrayLike | None = None,
) -> FloatArray:
    """Return the speed at which `barrass_2004_squat` reaches a given squat [m/s].

    Parameters
    ----------
    squat : array_like
        Squat that is allowed [m]; zero or less gives speed zero.
    depth, draught, breadth, block_coefficient, channel_width
        As in `barrass_2004_squat`.

    Returns
    -------
    ndarray
        Speed through the water [m/s].
    """
    at_one_knot = barrass_2004_squat(
        KNOT,
        depth,
        draught=draught,
        breadth=breadth,
        block_coefficient=block_coefficient,
        channel_width=channel_width,
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        return KNOT * (np.maximum(as_float_array(squat), 0.0) / at_one_knot) ** (1.0 / 2.08)


def barrass_speed(
    squat: ArrayLike,
    depth: ArrayLike,
    *,
    draught: ArrayLike,
    breadth: ArrayLike,
    block_coefficient: ArrayLike,
    channel_width: ArrayLike | None = None,
) -> FloatArray:
    """Return the speed at which `barrass_squat` reaches a given squat.

    Parameters
    ----------
    squat : array_like
        Squat that is allowed [m]; zero or less gives speed zero.
    depth, draught, breadth, block_coefficient, channel_width
        As in `barrass_squat`.

    Returns
    -------
    ndarray
        Speed through the water [m/s], the inverse of `barrass_squat`.

    Notes
    -----
    van Halem (2019), eq. 2.5, prints min(0, ...) for max(0, ...), leaves out the power 1/2.08
    and gives the blockage as a length; the program published with the thesis compares the
    result, which is in knots, with metres per second. All four are put right here.
    """
    allowed = as_float_array(squat)
    blockage = blockage_ratio(depth, draught, breadth=breadth, channel_width=channel_width)
    with np.errstate(divide="ignore", invalid="ignore"):
        base = (
            30.0
            * np.maximum(allowed, 0.0)
            / (as_float_array(block_coefficient) * blockage ** (2.0 / 3.0))
        )
        return KNOT * base ** (1.0 / 2.08)


def shallow_water_speed(
    deep_speed: ArrayLike,
    depth: ArrayLike,
    *,
    draught: ArrayLike,
    breadth: ArrayLike,
    channel_width: ArrayLike | None = None,
    gravity: float = GRAVITY,
) -> FloatArray:
    """Return the speed in shallow water at the power of a deep-water speed.

    V = V_max sqrt(tanh(g h / V_max^2)) (1.002 + 0.005 q - 0.1159 q^2 + 0.0191 q^3), with
    q = sqrt(A_s) / R_H, the root of the midship section over the hydraulic radius.

    Parameters
    ----------
    deep_speed : array_like
        Speed through deep water V_max [m/s].
    depth, draught, breadth : array_like
        Water depth, draught and breadth [m].
    channel_width : array_like, optional
        Width of the waterway [m]; without it 9 B, open water.
    gravity : float
        Acceleration of gravity [m/s2].

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
    b, width = as_float_array(breadth), _waterway_width(breadth, channel_width)
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
    """Return the speed a depth allows: the smaller of `shallow_water_speed` and `barrass_speed`.

    The squat that is allowed is depth - draught - clearance.

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
    depth, draught, squat : array_like
        Water depth, draught at rest and squat [m].

    Returns
    -------
    ndarray
        Clearance [m], negative where the ship would touch the bed.
    """
    return as_float_array(depth) - as_float_array(draught) - as_float_array(squat)


def squat_validity(
    depth: ArrayLike, *, draught: ArrayLike, block_coefficient: ArrayLike
) -> list[RangeNote]:
    """Return where `barrass_squat` or `barrass_2004_squat` is used outside its published range.

    Deep water is not reported: squat tends to zero there.

    Parameters
    ----------
    depth, draught : array_like
        [m].
    block_coefficient : array_like
        [-].

    Returns
    -------
    list of RangeNote
        Empty when all are inside.
    """
    ratio = as_float_array(depth) / as_float_array(draught)
    return range_notes(
        "Barrass squat",
        {
            "block coefficient": (block_coefficient, *_BLOCK_COEFFICIENT_RANGE),
            "depth over draught": (ratio, _LEAST_DEPTH_TO_DRAUGHT, np.inf),
        },
    )
