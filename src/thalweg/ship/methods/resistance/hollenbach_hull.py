"""Particulars of a hull and its appendages for the regressions of Hollenbach (1998)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray


@dataclass(frozen=True)
class HollenbachHull:
    """Particulars of a hull for Hollenbach's regressions; scalars or arrays that broadcast.

    Attributes
    ----------
    length_between_perpendiculars, length_waterline : L and L_WL [m].
    length_over_surface : L_OS [m], foremost to aftmost wetted point, bulb included.
    breadth, draught_fore, draught_aft : B, T_F and T_A [m].
    block_coefficient : C_B on L, B and the mean draught.
    propeller_diameter : D_P [m].
    """

    length_between_perpendiculars: ArrayLike
    length_waterline: ArrayLike
    length_over_surface: ArrayLike
    breadth: ArrayLike
    draught_fore: ArrayLike
    draught_aft: ArrayLike
    block_coefficient: ArrayLike
    propeller_diameter: ArrayLike


@dataclass(frozen=True)
class AppendageCounts:
    """Numbers of appendages; they act on the twin-screw mean curves and surfaces only.

    Attributes
    ----------
    rudders, brackets, bosses, thrusters : Counts; thrusters are side thrusters.
    """

    rudders: ArrayLike = 1
    brackets: ArrayLike = 0
    bosses: ArrayLike = 0
    thrusters: ArrayLike = 0


def froude_length(
    length_between_perpendiculars: ArrayLike, *, length_over_surface: ArrayLike
) -> FloatArray:
    r"""Length that enters the Froude number (Hollenbach 1998, Table 1).

    .. math::
        L_{fn} = L_{OS}\ (L_{OS} / L < 1), \quad L + \frac{2}{3} (L_{OS} - L)\ (< 1.1),
            \quad 1.0667 L

    Parameters
    ----------
    length_between_perpendiculars : L [m].
    length_over_surface : L_OS [m], foremost to aftmost wetted point, bulb included.

    Returns
    -------
    ndarray : L_OS below L_OS / L = 1; L + 2/3 (L_OS - L) up to 1.1; 1.0667 L from there on [m].

    References
    ----------
    U. Hollenbach, Schiffstechnik 45(2) (1998), as in Schneekluth and Bertram (1998) and Birk
    (2019).
    """
    length = np.asarray(length_between_perpendiculars, dtype=float)
    over = np.asarray(length_over_surface, dtype=float)
    ratio = over / length
    middle = length + 2.0 / 3.0 * (over - length)
    known = np.where(ratio < 1.0, over, np.where(ratio < 1.1, middle, 1.0667 * length))
    return np.where(np.isnan(ratio), np.nan, known)
