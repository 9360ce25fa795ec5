"""Squat by the formulas of Barrass: the sinkage of a ship by its own speed, and their inverse."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray
from thalweg.core.units import KNOT
from thalweg.ship.methods.array_conversion import as_float_array
from thalweg.ship.methods.validity import RangeNote, range_notes

#: Width of open water that takes part in the flow, in ship breadths (van Halem 2019).
OPEN_WATER_BREADTHS: Final = 9.0

_SPEED_EXPONENT: Final = 2.08  #: of the speed [kn] in both forms
#: Published ranges of both of Barrass's forms; deeper water is not reported: squat tends to zero.
_BLOCK_COEFFICIENT_RANGE: Final = (0.5, 0.9)
_LEAST_DEPTH_TO_DRAUGHT: Final = 1.1  # depth over draught


def waterway_width(breadth: ArrayLike, channel_width: ArrayLike | None) -> FloatArray:
    """Return the width of the waterway [m]: that of a channel, or nine breadths of open water.

    Parameters
    ----------
    breadth : Breadth of the ship [m].
    channel_width : Width of the waterway [m]; None for open water.

    Returns
    -------
    ndarray : Width [m].
    """
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
    r"""Return the blockage: the ship's section over the water beside it.

    .. math:: S_2 = \frac{A_s}{b h - A_s}, \quad A_s = B T

    Parameters
    ----------
    depth, draught, breadth : Water depth h, draught T and breadth B [m].
    channel_width : Width b of the waterway [m]; without it 9 B, open water.

    Returns
    -------
    ndarray : Blockage [-]; infinite where the ship fills the waterway.

    References
    ----------
    C. B. Barrass, "The phenomenon of ship squat", Int. Shipbuilding Progress 26 (1979).
    """
    h, section = as_float_array(depth), as_float_array(breadth) * as_float_array(draught)
    free = waterway_width(breadth, channel_width) * h - section
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
    r"""Return the largest squat by Barrass (1979).

    .. math:: s = \frac{1}{30} C_B S_2^{2/3} V_{kn}^{2.08}, \quad S_2 = \frac{B T}{b h - B T}

    Parameters
    ----------
    speed : Speed through the water [m/s]; the formula takes it in knots, and it is converted here.
    depth, draught, breadth : Water depth h, draught T and breadth B [m]; depth over draught 1.1 to
        1.5. At greater depth the squat tends to zero.
    block_coefficient : Block coefficient C_B [-], 0.5 to 0.9.
    channel_width : Width b of the waterway [m]; without it 9 B, open water.

    Returns
    -------
    ndarray : Squat s [m], 0 at rest; under way infinite where the ship fills the waterway. NaN
        where the depth is unknown.

    References
    ----------
    C. B. Barrass, "The phenomenon of ship squat", Int. Shipbuilding Progress 26 (1979), as
    inverted in J. P. van Halem, "Route optimization in dynamic currents", TU Delft (2019), eq. 2.5.
    """
    blockage = blockage_ratio(depth, draught, breadth=breadth, channel_width=channel_width)
    knots = np.abs(as_float_array(speed)) / KNOT
    with np.errstate(invalid="ignore"):
        return np.where(
            knots == 0.0,
            np.where(np.isnan(blockage), np.nan, 0.0),
            _squat_at_one_knot(blockage, block_coefficient) * knots**_SPEED_EXPONENT,
        )


def barrass_speed(
    squat: ArrayLike,
    depth: ArrayLike,
    *,
    draught: ArrayLike,
    breadth: ArrayLike,
    block_coefficient: ArrayLike,
    channel_width: ArrayLike | None = None,
) -> FloatArray:
    r"""Return the speed at which `barrass_squat` reaches a given squat.

    .. math:: V_{kn} = \left(\frac{30 \max(0, s)}{C_B S_2^{2/3}}\right)^{1/2.08}

    Parameters
    ----------
    squat : Squat s that is allowed [m]; zero or less gives speed zero.
    depth, draught, breadth, block_coefficient, channel_width
        As in `barrass_squat`.

    Returns
    -------
    ndarray : Speed through the water [m/s], the inverse of `barrass_squat`.

    Notes
    -----
    van Halem (2019), eq. 2.5, prints min(0, ...) for max(0, ...), leaves out the power 1/2.08
    and gives the blockage as a length; the program published with the thesis compares the
    result, which is in knots, with metres per second. All four are corrected here.

    References
    ----------
    J. P. van Halem, "Route optimization in dynamic currents", TU Delft (2019), eq. 2.5, corrected.
    """
    blockage = blockage_ratio(depth, draught, breadth=breadth, channel_width=channel_width)
    return _speed_of_squat(squat, _squat_at_one_knot(blockage, block_coefficient))


def barrass_2004_squat(
    speed: ArrayLike,
    depth: ArrayLike,
    *,
    draught: ArrayLike,
    breadth: ArrayLike,
    block_coefficient: ArrayLike,
    channel_width: ArrayLike | None = None,
) -> FloatArray:
    r"""Return the largest squat by Barrass's later form.

    .. math:: s = \frac{1}{20} C_B K^{0.81} V_{kn}^{2.08}, \quad K = \frac{B T}{b h}

    Parameters
    ----------
    speed : Speed through the water [m/s]; the formula takes it in knots, and it is converted here.
    depth, draught, breadth : Water depth h, draught T and breadth B [m]; depth over draught 1.1 to
        1.4, blockage factor K 0.100 to 0.265.
    block_coefficient : Block coefficient C_B [-], 0.5 to 0.9.
    channel_width : array_like, optional
        Width b of the waterway [m]; without it Barrass's width of influence 7.04 B / C_B^0.85.

    Returns
    -------
    ndarray : Squat s [m]; NaN where the depth is not positive.

    Notes
    -----
    The constant 7.04 was not compared with the source.

    References
    ----------
    C. B. Barrass, "Thirty-two years of research into ship squat", Squat Workshop, Oldenburg
    (2004).
    """
    block = as_float_array(block_coefficient)
    section = as_float_array(breadth) * as_float_array(draught)
    if channel_width is None:
        width = 7.04 / block**0.85 * as_float_array(breadth)
    else:
        width = as_float_array(channel_width)
    h = as_float_array(depth)
    knots = np.abs(as_float_array(speed)) / KNOT
    with np.errstate(divide="ignore", invalid="ignore"):
        factor = section / (width * np.where(h > 0, h, np.nan))
        return block * factor**0.81 * knots**_SPEED_EXPONENT / 20.0


def barrass_2004_speed(
    squat: ArrayLike,
    depth: ArrayLike,
    *,
    draught: ArrayLike,
    breadth: ArrayLike,
    block_coefficient: ArrayLike,
    channel_width: ArrayLike | None = None,
) -> FloatArray:
    r"""Return the speed at which `barrass_2004_squat` reaches a given squat.

    .. math:: V_{kn} = \left(\frac{20 \max(0, s)}{C_B K^{0.81}}\right)^{1/2.08}

    Parameters
    ----------
    squat : Squat s that is allowed [m]; zero or less gives speed zero.
    depth, draught, breadth, block_coefficient, channel_width
        As in `barrass_2004_squat`.

    Returns
    -------
    ndarray : Speed through the water [m/s], the inverse of `barrass_2004_squat`.

    References
    ----------
    C. B. Barrass, "Thirty-two years of research into ship squat", Squat Workshop, Oldenburg
    (2004), inverted.
    """
    sizes = {"draught": draught, "breadth": breadth, "block_coefficient": block_coefficient}
    at_one_knot = barrass_2004_squat(KNOT, depth, **sizes, channel_width=channel_width)
    return _speed_of_squat(squat, at_one_knot)


def _squat_at_one_knot(blockage: FloatArray, block_coefficient: ArrayLike) -> FloatArray:
    """Return the squat [m] at one knot by Barrass (1979)."""
    return as_float_array(block_coefficient) * blockage ** (2.0 / 3.0) / 30.0


def _speed_of_squat(squat: ArrayLike, at_one_knot: FloatArray) -> FloatArray:
    """Return the speed [m/s] of a squat that grows with the speed to the power 2.08."""
    with np.errstate(divide="ignore", invalid="ignore"):
        times = np.maximum(as_float_array(squat), 0.0) / at_one_knot
        return KNOT * times ** (1.0 / _SPEED_EXPONENT)


def squat_validity(
    depth: ArrayLike, *, draught: ArrayLike, block_coefficient: ArrayLike
) -> list[RangeNote]:
    """Return where `barrass_squat` or `barrass_2004_squat` is used outside its published range.

    Deep water is not reported: squat tends to zero there.

    Parameters
    ----------
    depth, draught : array_like [m]
    block_coefficient : array_like [-]

    Returns
    -------
    list of RangeNote : Empty when all are inside.
    """
    ratio = as_float_array(depth) / as_float_array(draught)
    return range_notes(
        "Barrass squat",
        {
            "block coefficient": (block_coefficient, *_BLOCK_COEFFICIENT_RANGE),
            "depth over draught": (ratio, _LEAST_DEPTH_TO_DRAUGHT, np.inf),
        },
    )
