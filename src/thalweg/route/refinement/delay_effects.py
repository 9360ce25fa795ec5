"""Effects of a delay, carried back from the goal over the legs of tracks."""

from __future__ import annotations

import numpy as np

from thalweg.core.types import BoolArray, FloatArray

_LEAST_GROWTH, _LARGEST_GROWTH = 0.1, 11.0  # of a delay over one leg


def accumulated_delay_effects(
    growth: FloatArray,
    added: FloatArray | float,
    at_goal: FloatArray | float,
    *,
    absorbed: BoolArray | None = None,
    remaining: float = 0.0,
) -> FloatArray:
    """Return what a second of delay at each point of tracks causes until the goal.

    Parameters
    ----------
    growth : Seconds later at the end of each leg, for each second later at its start, (R, M - 1).
    added : float64 array (R, M - 1) or float
        What a second of delay at the start of each leg adds on that leg, such as cost.
    at_goal : What a second of delay at the goal counts, (R,).
    absorbed : Points where the ship waits: a delay there shortens the wait, (R, M).
    remaining : What a second of delay counts where it is absorbed.

    Returns
    -------
    float64 array (R, M)

    Notes
    -----
    .. math:: v_k = a_k + g_k v_{k+1}

    with the growth :math:`g` limited to between 0.1 and 11.
    """
    growth = np.clip(growth, _LEAST_GROWTH, _LARGEST_GROWTH)
    legs = np.broadcast_to(added, growth.shape)
    out = np.empty((growth.shape[0], growth.shape[1] + 1))
    out[:, -1] = at_goal
    for p in range(growth.shape[1] - 1, -1, -1):
        out[:, p] = legs[:, p] + growth[:, p] * out[:, p + 1]
        if absorbed is not None:
            out[absorbed[:, p], p] = remaining
    return out
