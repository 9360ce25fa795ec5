"""Particulars of a hull for the SNNM formula of added resistance in waves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray


@dataclass(frozen=True)
class SnnmHull:
    """Particulars of a hull in waves; scalars, or arrays that broadcast with the conditions.

    Attributes
    ----------
    length, breadth : L_PP and B [m].
    draught_fore, draught_aft : [m]; the deeper one is T_max.
    block_coefficient : C_B.
    pitch_gyration : k_yy as a part of L_PP.
    entrance_length, run_length : L_E and L_R, on the waterline from the ends to 0.99 B [m].
    """

    length: ArrayLike
    breadth: ArrayLike
    draught_fore: ArrayLike
    draught_aft: ArrayLike
    block_coefficient: ArrayLike
    entrance_length: ArrayLike
    run_length: ArrayLike
    pitch_gyration: ArrayLike = 0.25

    def arrays(self) -> tuple[FloatArray, ...]:
        """Return length, breadth, deepest draught, trim, C_B, k_yy and the angles E1 and E2."""
        length, breadth = np.asarray(self.length, dtype=float), np.asarray(self.breadth)
        fore, aft = np.asarray(self.draught_fore), np.asarray(self.draught_aft)
        half = 0.495 * breadth
        return (
            *(length, breadth, np.maximum(fore, aft), np.arctan(np.abs(aft - fore) / length)),
            *(np.asarray(self.block_coefficient), np.asarray(self.pitch_gyration)),
            *(np.arctan(half / np.asarray(end)) for end in (self.entrance_length, self.run_length)),
        )


def entrance_length(breadth: ArrayLike, *, entrance_angle_deg: ArrayLike) -> FloatArray:
    """L_E from the half angle of entrance [deg], as E1 = atan(0.495 B / L_E) is that angle [m].

    Parameters
    ----------
    breadth : Breadth B [m].
    entrance_angle_deg : Half angle of entrance [deg].

    Returns
    -------
    ndarray : Length of entrance L_E [m].
    """
    return np.asarray(0.495 * np.asarray(breadth) / np.tan(np.radians(entrance_angle_deg)))
