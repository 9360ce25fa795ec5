"""Fill values: a calm sea, and the values a user requests where the data are unknown."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.sea import standard_names as nm
from thalweg.sea.layer import Layer
from thalweg.sea.layer_stack import stack_variables
from thalweg.sea.models.function_layer import constant_layer
from thalweg.sea.models.wind_sea import wind_sea_layer
from thalweg.sea.plausible_values import PLAUSIBLE_RANGES

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


def layers_filled(
    layers: Sequence[Layer], policies: Mapping[str, float | tuple[float, float] | str]
) -> tuple[tuple[Layer, ...], tuple[str, ...]]:
    """Return layers with one more for the fill values, and a sentence for each policy.

    Parameters
    ----------
    layers : sequence of Layer
        In order of priority.
    policies : mapping
        Values by policy (see `thalweg.sea.Sea.filled`).

    Raises
    ------
    InputError
        If a policy is unknown or its value is impossible.
    """
    values: dict[str, float] = {}
    assumptions: list[str] = []
    waves_from_wind = policies.get("waves") == "wind"
    for policy, value in policies.items():
        if not (waves_from_wind and policy == "waves"):
            values.update(fill_values(policy, value))
            assumptions.append(f"where unknown, {policy.replace('_', ' ')} = {value}")
    known = stack_variables(layers)
    for vector in (nm.WIND, nm.CURRENT):
        if vector.east in values and vector.speed in known and vector.east not in known:
            assumptions.append(f"the data's {vector.speed}, without direction, is not used")
    filled = [*layers]
    if values:
        filled.append(constant_layer(values, "filled"))
    if waves_from_wind:
        filled.append(wind_sea_layer(filled))
        assumptions.append(
            "where unknown, waves are those that the wind raises (Carter 1982, 500 km of "
            "fetch, 24 h)"
        )
    return tuple(filled), tuple(assumptions)


def fill_values(policy: str, value: float | tuple[float, float] | str) -> dict[str, float]:
    """Return canonical variables and values [SI] for a fill policy (see `Sea.filled`).

    Parameters
    ----------
    policy : str
        "currents", "wind", "waves", "water_level" or "ice".
    value : float or tuple of float
        A value, or (east, north) of a vector [m/s].

    Raises
    ------
    InputError
        If the policy is unknown, or the value is impossible or has no direction.
    """
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
            f"{policy}={number:g} is outside the possible range.",
            f"{policy} must be between {FILL_LIMITS[policy][0]:g} and {FILL_LIMITS[policy][1]:g}.",
            "Correct the value.",
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
