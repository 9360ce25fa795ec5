"""Loading and displacement: draught, weight and displaced volume between empty and full."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray
from thalweg.ship.methods.array_conversion import as_float_array


def interpolate_loading(load_factor: ArrayLike, *, empty: ArrayLike, full: ArrayLike) -> FloatArray:
    """Interpolate linearly between the empty and the full ship: x = (1 - r) x_empty + r x_full.

    Van Halem (2019) applies it to draught, weight and service speed.

    Parameters
    ----------
    load_factor : r = (W - W_empty) / (W_full - W_empty), 0 empty to 1 full.
    empty, full : The quantity of the empty and of the full ship, in any unit.

    Returns
    -------
    ndarray : The quantity, NaN outside 0 <= r <= 1.

    References
    ----------
    J. P. van Halem, "Route optimization in dynamic currents", TU Delft (2019), section 3.2.3.
    """
    given = as_float_array(load_factor)
    r = np.where((given >= 0.0) & (given <= 1.0), given, np.nan)
    return (1.0 - r) * as_float_array(empty) + r * as_float_array(full)


def displacement_volume(
    length: ArrayLike, breadth: ArrayLike, *, draught: ArrayLike, block_coefficient: ArrayLike
) -> FloatArray:
    """Return the displaced volume C_B L B T [m3] (definition of the block coefficient).

    Parameters
    ----------
    length, breadth, draught : Length to which C_B belongs, breadth and mean draught [m].
    block_coefficient : Block coefficient [-].

    Returns
    -------
    ndarray : Volume [m3].
    """
    return (
        as_float_array(block_coefficient)
        * as_float_array(length)
        * as_float_array(breadth)
        * as_float_array(draught)
    )


def block_coefficient_of(
    displacement: ArrayLike, *, length: ArrayLike, breadth: ArrayLike, draught: ArrayLike
) -> FloatArray:
    """Return the block coefficient of a displaced volume [m3]: volume / (L B T).

    Parameters
    ----------
    displacement : Displaced volume [m3], not tonnes.
    length, breadth, draught : array_like [m]

    Returns
    -------
    ndarray : Block coefficient [-].
    """
    return as_float_array(displacement) / (
        as_float_array(length) * as_float_array(breadth) * as_float_array(draught)
    )


def block_at_draught(
    draught: ArrayLike, *, design_draught: ArrayLike, design_block: ArrayLike
) -> FloatArray:
    """Return the block coefficient at another draught: 1 - (1 - C_B)(T_design / T)^(1/3).

    Parameters
    ----------
    draught, design_draught : Mean draughts [m]; the first 0.4 to 1.1 of the second (our judgement).
    design_block : Block coefficient at the design draught [-].

    Returns
    -------
    ndarray : Block coefficient [-].

    References
    ----------
    Riddlesworth's method as given by J.-P. Jalkanen et al., "Extension of an assessment model of
    ship traffic exhaust emissions", Atmos. Chem. Phys. 12 (2012); not compared with the source.
    """
    ratio = as_float_array(design_draught) / as_float_array(draught)
    return 1.0 - (1.0 - as_float_array(design_block)) * np.cbrt(ratio)
