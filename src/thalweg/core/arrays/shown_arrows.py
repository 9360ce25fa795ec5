"""Which arrows of a current or a wind a map shows."""

from __future__ import annotations

from typing import Final

import numpy as np

from thalweg.core.types import BoolArray, FloatArray
from thalweg.core.units import KNOT

_LEAST_SPEED: Final = 0.1 * KNOT  # [m/s]
_LEAST_SHARE: Final = 0.1  # of the strongest


def shown_arrows(east: FloatArray, north: FloatArray) -> tuple[BoolArray, float]:
    """Return which arrows a map shows, and the strongest speed, which sets their scale.

    Parameters
    ----------
    east, north : Components [m/s], NaN where unknown.

    Returns
    -------
    tuple : A mask of those of at least 0.1 kn and a tenth of the strongest, and the strongest
        [m/s]; 0 where none is shown.
    """
    speed = np.hypot(east, north)
    strongest = float(np.nanmax(speed, initial=0.0))
    shown = speed >= max(_LEAST_SPEED, _LEAST_SHARE * strongest)
    return shown, strongest if shown.any() else 0.0
