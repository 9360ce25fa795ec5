"""Published regressions that estimate form coefficients of a hull from others."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray
from thalweg.ship.methods.array_conversion import as_float_array


def block_from_froude(froude: ArrayLike) -> FloatArray:
    """Return a usual block coefficient at a design Froude number.

    C_B = -4.22 + 27.8 sqrt(Fn) - 39.1 Fn + 46.6 Fn^3, for 0.15 < Fn < 0.32.

    Parameters
    ----------
    froude : V / sqrt(g L) at design speed [-].

    Returns
    -------
    ndarray : Block coefficient [-], NaN outside the range.

    References
    ----------
    H. Schneekluth, V. Bertram, "Ship design for efficiency and economy", 2nd ed. (1998),
    section 1.5 (after Jensen).
    """
    fn = as_float_array(froude)
    fn = np.where((fn >= 0.15) & (fn <= 0.32), fn, np.nan)
    return -4.22 + 27.8 * np.sqrt(fn) - 39.1 * fn + 46.6 * fn**3


def midship_from_block(block_coefficient: ArrayLike) -> FloatArray:
    """Return a usual midship section coefficient: 1 / (1 + (1 - C_B)^3.5).

    Parameters
    ----------
    block_coefficient : Block coefficient [-].

    Returns
    -------
    ndarray : Midship section coefficient [-].

    References
    ----------
    Schneekluth and Bertram (1998), section 1.6 (after Jensen, HSVA).
    """
    return 1.0 / (1.0 + (1.0 - as_float_array(block_coefficient)) ** 3.5)


def waterplane_from_block(block_coefficient: ArrayLike) -> FloatArray:
    """Return a usual waterplane coefficient of average sections: (1 + 2 C_B) / 3.

    Parameters
    ----------
    block_coefficient : Block coefficient [-].

    Returns
    -------
    ndarray : Waterplane coefficient [-].

    References
    ----------
    Schneekluth and Bertram (1998), section 1.6.
    """
    return (1.0 + 2.0 * as_float_array(block_coefficient)) / 3.0


def lcb_from_prismatic(prismatic_coefficient: ArrayLike) -> FloatArray:
    """Return a usual centre of buoyancy, percent of length forward of midship: 19.4 C_P - 13.5.

    Parameters
    ----------
    prismatic_coefficient : C_P = C_B / C_M [-], about 0.55 to 0.85.

    Returns
    -------
    ndarray : Longitudinal centre of buoyancy [% of length, + forward].

    References
    ----------
    Schneekluth and Bertram (1998), section 1.5, not compared with the source. It has two
    such lines, this one and `lcb_from_froude`; which of them was drawn for tankers and bulkers is
    not certain.
    """
    return 19.4 * as_float_array(prismatic_coefficient) - 13.5


def lcb_from_froude(froude: ArrayLike) -> FloatArray:
    """Return a usual centre of buoyancy, percent of length forward of midship: 8.80 - 38.9 Fn.

    Parameters
    ----------
    froude : Froude number at design speed [-], about 0.10 to 0.25.

    Returns
    -------
    ndarray : Longitudinal centre of buoyancy [% of length, + forward].

    References
    ----------
    Schneekluth and Bertram (1998), section 1.5, not compared with the source; see
    `lcb_from_prismatic`.
    """
    return 8.80 - 38.9 * as_float_array(froude)
