"""Values on the user's word: a calm sea, and what to take where nothing is known."""

from __future__ import annotations

import numpy as np

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.sea import standard_names as nm
from thalweg.sea.files.plausible_values import PLAUSIBLE_RANGES

CALM_PERIOD = 8.0  #: [s] placeholder peak period of waves of height zero
CALM_VALUES = {
    nm.EASTWARD_WIND: 0.0,
    nm.NORTHWARD_WIND: 0.0,
    nm.EASTWARD_CURRENT: 0.0,
    nm.NORTHWARD_CURRENT: 0.0,
    nm.WAVE_HEIGHT: 0.0,
    nm.WAVE_TO_EAST: 0.0,
    nm.WAVE_TO_NORTH: 1.0,
    nm.WAVE_PERIOD: CALM_PERIOD,
}
FILL_LIMITS = {"waves": PLAUSIBLE_RANGES[nm.WAVE_HEIGHT], "ice": (0.0, 1.0)}
FILLABLE_VARIABLES: dict[str, tuple[str, ...]] = {
    "currents": nm.CURRENT.pair,
    "wind": nm.WIND.pair,
    "waves": (nm.WAVE_HEIGHT, *nm.WAVES.pair, nm.WAVE_PERIOD),
    "water_level": (nm.WATER_LEVEL,),
    "ice": (nm.ICE,),
}


def fill_values(policy: str, value: float | tuple[float, float]) -> dict[str, float]:
    """Return canonical variables and values for a filling policy (see `Sea.filled`)."""
    if policy not in FILLABLE_VARIABLES:
        raise unknown_name_error("filling policy", policy, FILLABLE_VARIABLES)
    names = FILLABLE_VARIABLES[policy]
    try:
        numbers = np.atleast_1d(np.asarray(value, float))
    except (TypeError, ValueError):
        numbers = np.array([np.nan])
    is_pair = numbers.size == 2 and len(names) == 2
    if not np.isfinite(numbers).all() or not (is_pair or numbers.size == 1):
        raise InputError(
            f"{policy} cannot be filled with {value!r}.",
            "Give one finite number, (east, north) for currents and wind, or 'wind' for waves.",
            f"For example filled({policy}=0.0).",
        )
    if is_pair:
        return dict(zip(names, numbers.tolist()))
    number = float(numbers[0])
    if policy in FILL_LIMITS and not FILL_LIMITS[policy][0] <= number <= FILL_LIMITS[policy][1]:
        raise InputError(
            f"{policy}={number:g} cannot be.",
            f"{policy} lie between {FILL_LIMITS[policy][0]:g} and {FILL_LIMITS[policy][1]:g}.",
            "Correct it.",
        )
    if len(names) == 2 and number != 0.0:
        raise InputError(
            f"{policy}={number:g} has no direction.",
            f"{policy} can be 0.0 or (east, north) in m/s.",
            f"For example filled({policy}=({number:g}, 0.0)).",
        )
    if policy == "waves":
        return {**{n: CALM_VALUES[n] for n in names}, nm.WAVE_HEIGHT: number}
    return dict.fromkeys(names, number)
