"""Fill values: a calm sea, and the values a user requests where the data are unknown."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence, Set
from functools import partial
from typing import Any, Final, TypeAlias

import numpy as np

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.units import NAUTICAL_MILE
from thalweg.sea import standard_names as nm
from thalweg.sea.ensemble_layer import EnsembleLayer, member_count, select_member
from thalweg.sea.layer import Layer, RetimedLayer
from thalweg.sea.layer_stack import stack_variables
from thalweg.sea.models.coast_fills import NearestLayer, head_seas_layer, nearest_layer
from thalweg.sea.models.function_layer import FormulaLayer, constant_layer
from thalweg.sea.models.wind_of_waves import WindOfWavesLayer, wind_of_waves_layer
from thalweg.sea.models.wind_sea import FetchFunction, WindSeaLayer, wind_sea_layer
from thalweg.sea.plausible_values import PLAUSIBLE_RANGES

#: A number, a vector, a named policy, or a function of the fetch.
FillValue: TypeAlias = "float | tuple[float, float] | str | FetchFunction"

NEAREST: Final = "nearest"  #: begins the policy of the nearest known position
SHELTER: Final = "coastal_shelter"  #: begins that of waves in the shelter of a coast
SHELTER_DISTANCE: Final = 25.0  #: [nm] of that policy where none is given
SHELTER_FACTOR: Final = 0.8  #: of the wave height there, as in Prestegardshus (2020), eq. 3.4
OF_WAVES: Final = "waves"  #: of wind: that which raises the known waves
FETCH_LIMITED: Final = "fetch_limited"  #: waves of the local wind over the true fetch
MAX_NEAREST: Final = 100.0  #: [nm] greatest distance of that policy
_FILLED: Final = "filled"  # label of the layer of constant values
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
_SPEEDS = {"wind": nm.WIND.speed, "currents": nm.CURRENT.speed}
FILLABLE_VARIABLES: dict[str, tuple[str, ...]] = {
    "currents": nm.CURRENT.pair,
    "wind": nm.WIND.pair,
    "waves": (nm.WAVE_HEIGHT, *nm.WAVES.pair, nm.WAVE_PERIOD),
    "water_level": (nm.WATER_LEVEL,),
    "ice": (nm.ICE,),
}


def is_calm_layer(layer: Layer) -> bool:
    """Return whether a layer is that of a calm sea: no wind, waves and currents anywhere."""
    return isinstance(layer, FormulaLayer) and layer.facts.get("values") == CALM_VALUES


def _names_a_model(policy: str, value: FillValue) -> bool:
    """Return whether a fill value is the name of a policy, not a number or a function."""
    of_quantity = policy == "waves" or (policy == "wind" and value == OF_WAVES)
    return isinstance(value, str) and (of_quantity or value.startswith(NEAREST))


def layers_filled(
    layers: Sequence[Layer], policies: Mapping[str, FillValue]
) -> tuple[tuple[Layer, ...], tuple[str, ...]]:
    """Return layers with one more for the fill values, and a sentence for each policy.

    Parameters
    ----------
    layers : In order of priority.
    policies : Values by policy (see `thalweg.sea.Sea.filled`).

    Raises
    ------
    InputError : If a policy is unknown or its value is impossible.
    """
    values: dict[str, float] = {}
    assumptions: list[str] = []
    known = stack_variables(layers)
    models: list[tuple[str, Any]] = []
    for policy, value in policies.items():
        if _names_a_model(policy, value):
            _check_name(policy)
            models.append((policy, value.strip()))  # type: ignore[union-attr]
            continue
        if callable(value):
            models.append((policy, _checked_fetch(policy, value)))
            continue
        values.update(fill_values(policy, value))  # type: ignore[arg-type]
        assumptions.append(f"where unknown, {policy.replace('_', ' ')} = {value}")
    made = {*values, *(nm.WIND.pair if ("wind", OF_WAVES) in models else ())}
    for vector in (nm.WIND, nm.CURRENT):
        if vector.east in made and vector.speed in known and vector.east not in known:
            assumptions.append(f"the data's {vector.speed}, without direction, is not used")
    filled = [*layers]
    for policy, value in models:
        if isinstance(value, str) and value.startswith((NEAREST, SHELTER)):
            fill = _nearest if value.startswith(NEAREST) else _shelter
            made_of = [fill(part, policy, value) for part in _by_member(filled)]
            filled.append(_joined([layer for layer, _ in made_of]))
            assumptions.append(made_of[0][1])
    if values:
        filled.append(constant_layer(values, _FILLED))
    for policy, value in models:
        if isinstance(value, str) and value.startswith((NEAREST, SHELTER)):
            continue
        make, text = _wave_model(value) if policy == "waves" else _WIND_MODEL
        filled.append(_joined([make(part) for part in _by_member(filled)]))
        assumptions.append(text)
    return tuple(filled), tuple(assumptions)


def _by_member(layers: Sequence[Layer]) -> list[Sequence[Layer]]:
    """Return the layers of every member of an ensemble, or those of a single sea."""
    count = member_count(layers)
    return [select_member(layers, k) for k in range(count)] if count else [layers]


def _joined(made: Sequence[Layer]) -> Layer:
    """Return one layer of those that were made for every member."""
    return made[0] if len(made) == 1 else EnsembleLayer(tuple(made))


def variables_filled(policies: Sequence[tuple[str, FillValue]]) -> frozenset[str]:
    """Return the variables that fills make known at all times, also beyond the data.

    Parameters
    ----------
    policies : Quantity and value; values of a known position nearby hold within the data only.
    """
    everywhere = {
        name
        for name, value in policies
        if not (isinstance(value, str) and value.strip().startswith((NEAREST, SHELTER)))
    }
    return frozenset(name for one in everywhere for name in FILLABLE_VARIABLES.get(one, ()))


def layers_without_fills(layers: Sequence[Layer]) -> tuple[Layer, ...]:
    """Return the layers that hold data or models, without those of fill values and policies.

    Parameters
    ----------
    layers : In order of priority; those whose times are changed count as what they change.
    """

    def is_fill(layer: Layer) -> bool:
        while isinstance(layer, (RetimedLayer, EnsembleLayer)):
            layer = layer.layer if isinstance(layer, RetimedLayer) else layer.member_layers[0]
        constant = isinstance(layer, FormulaLayer) and layer.label == _FILLED
        return constant or isinstance(layer, (NearestLayer, WindSeaLayer, WindOfWavesLayer))

    return tuple(layer for layer in layers if not is_fill(layer))


def filled_distance(layers: Sequence[Layer]) -> float:
    """Return how far from data values are filled with the nearest ones [m]; 0 where none are."""
    first = _by_member(layers)[0]
    return max((one.distance for one in first if isinstance(one, NearestLayer)), default=0.0)


def check_fill(policy: str, value: FillValue) -> None:
    """Raise `InputError` for a fill value that no sea can be filled with.

    Parameters
    ----------
    policy, value : As of `thalweg.sea.Sea.filled`; the waves of a fetch also by their name.
    """
    _check_name(policy)
    if isinstance(value, str) and value.startswith(NEAREST):
        _nearest_miles(policy, value)
    elif policy == "waves" and isinstance(value, str) and value.startswith(SHELTER):
        _shelter_numbers(policy, value)
    elif policy == "waves" and isinstance(value, str):
        if value != FETCH_LIMITED:
            _wave_model(value)
    elif not callable(value) and not _names_a_model(policy, value):
        fill_values(policy, value)


def _nearest_miles(policy: str, value: str) -> float:
    """Return the greatest distance to a known position [nm]."""
    _, _, distance = value.partition(":")
    try:
        miles = float(distance)
    except ValueError:
        miles = math.nan
    if not 0.0 < miles <= MAX_NEAREST:
        raise InputError(
            f"{policy} cannot be filled with {value!r}.",
            f"It is {NEAREST}:NM, the greatest distance to a known position, up to "
            f"{MAX_NEAREST:g} nm.",
            f"For example {policy}={NEAREST}:25.",
        )
    return miles


def _nearest(layers: Sequence[Layer], policy: str, value: str) -> tuple[Layer, str]:
    """Return the layer of the nearest known values, and the sentence that states it."""
    miles = _nearest_miles(policy, value)
    layer = nearest_layer(layers, FILLABLE_VARIABLES[policy], miles * NAUTICAL_MILE)
    text = f"those of the nearest known position within {miles:g} nm"
    return layer, f"where unknown next to land, {policy.replace('_', ' ')} = {text}"


def _shelter_numbers(policy: str, value: str) -> tuple[float, float]:
    """Return the greatest distance to a known position [nm], and the factor of the height."""
    parts = value.split(":")[1:]
    try:
        numbers = [float(part) for part in parts]
    except ValueError:
        numbers = [math.nan]
    miles, factor = [*numbers, *(SHELTER_DISTANCE, SHELTER_FACTOR)[len(numbers) :]][:2]
    if len(numbers) > 2 or not (0.0 < miles <= MAX_NEAREST and 0.0 <= factor <= 1.0):
        raise InputError(
            f"{policy} cannot be filled with {value!r}.",
            f"It is {SHELTER}, {SHELTER}:NM or {SHELTER}:NM:FACTOR, with a distance up to "
            f"{MAX_NEAREST:g} nm and a factor of the wave height from 0 to 1.",
            f"For example {policy}={SHELTER}:25:0.8.",
        )
    return miles, factor


def _shelter(layers: Sequence[Layer], policy: str, value: str) -> tuple[Layer, str]:
    """Return the layer of the nearest known waves, with their height times a factor."""
    miles, factor = _shelter_numbers(policy, value)
    names, distance = FILLABLE_VARIABLES[policy], miles * NAUTICAL_MILE
    text = (
        f"where unknown next to land, waves = those of the nearest known position within "
        f"{miles:g} nm with {factor:g} of their height (coastal shelter)"
    )
    return nearest_layer(layers, names, distance, height_factor=factor), text


def _checked_fetch(policy: str, fetch: Any) -> FetchFunction:
    """Return a function of the fetch, for waves only."""
    if policy == "waves" and hasattr(fetch, "name"):
        return fetch  # type: ignore[no-any-return]
    raise InputError(
        f"{policy} cannot be filled with a function.",
        "Waves are filled with those of the local wind by a CoastalFetch of the chart.",
        "Give waves=CoastalFetch(chart).",
    )


def _wave_model(
    value: str | FetchFunction,
) -> tuple[Callable[[Sequence[Layer]], Layer], str]:
    if not isinstance(value, str):
        return partial(wind_sea_layer, fetch=value), (
            "where unknown, waves are those that the local wind raises over its fetch to the "
            f"coast of {value.name} (Carter 1982, 24 h, at most 500 km), without any swell"
        )
    if value == FETCH_LIMITED:
        raise InputError(
            "The fetch needs a coast, which the sea does not know.",
            "A CoastalFetch of a chart gives it.",
            "Give waves=CoastalFetch(chart) in place of the name.",
        )
    if value == "wind":
        return wind_sea_layer, (
            "where unknown, waves are those that the wind raises (Carter 1982, 500 km of fetch, "
            "24 h)"
        )
    if value == "head_seas":
        return head_seas_layer, (
            "where their direction is unknown, waves come from ahead on every course; where their "
            "period is, they have the peak period of a fully developed sea of their height"
        )
    raise InputError(
        f"waves cannot be filled with {value!r}.",
        f"Give a height [m], 'wind', 'head_seas', '{SHELTER}', '{FETCH_LIMITED}' or "
        f"'{NEAREST}:NM'.",
        "For example waves=head_seas.",
    )


#: of ``wind=waves``: the layer, and the sentence that states it
_WIND_MODEL: Final = (
    wind_of_waves_layer,
    "where unknown, the wind is that which raises the known waves (Carter 1982, 500 km of fetch, "
    "24 h), in their direction",
)


def _check_name(policy: str) -> None:
    if policy not in FILLABLE_VARIABLES:
        raise unknown_name_error("filling policy", policy, FILLABLE_VARIABLES)


def fill_values(policy: str, value: float | tuple[float, float] | str) -> dict[str, float]:
    """Return canonical variables and values [SI] for a fill policy (see `Sea.filled`).

    Parameters
    ----------
    policy : "currents", "wind", "waves", "water_level" or "ice".
    value : A value, or (east, north) of a vector [m/s].

    Raises
    ------
    InputError : If the policy is unknown, or the value is impossible or has no direction.
    """
    _check_name(policy)
    names = FILLABLE_VARIABLES[policy]
    try:
        numbers = np.atleast_1d(np.asarray(value, float))
    except (TypeError, ValueError):
        numbers = np.array([np.nan])
    is_pair = numbers.size == 2 and len(names) == 2
    if not np.isfinite(numbers).all() or not (is_pair or numbers.size == 1):
        raise InputError(
            f"{policy} cannot be filled with {value!r}.",
            "Give one finite number, (east, north) for currents and wind, 'waves' for wind, 'wind' "
            f"or 'head_seas' for waves, or '{NEAREST}:NM'.",
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
            f"{policy} can be 0, or its parts towards the east and the north in m/s.",
            f"Give both: --fill {policy}={number:g},0 on the command line, "
            f"filled({policy}=({number:g}, 0.0)) in Python.",
        )
    if policy == "waves":
        return {**{n: CALM_VALUES[n] for n in names}, nm.WAVE_HEIGHT: number}
    return dict.fromkeys(names, number)


def fill_hint(missing: Sequence[str], known: frozenset[str]) -> str:
    """Return how to fill missing variables on the command line, one value for each quantity.

    Parameters
    ----------
    missing : Canonical names that a sea lacks.
    known : Canonical names that it holds.
    """
    lacking = set(missing)
    hints = []
    for policy, names in FILLABLE_VARIABLES.items():
        if not lacking & {*names, _SPEEDS.get(policy, "")}:
            continue
        if policy == "waves" and nm.WAVE_HEIGHT in known:
            hints.append("waves=head_seas (the known heights, from ahead on every course)")
        elif policy == "waves" and set(nm.WIND.pair) <= known:
            hints.append("waves=wind (those that the wind raises)")
        elif policy == "wind" and nm.WAVE_HEIGHT in known:
            hints.append(_wind_hint(lacking, known))
        else:
            hints.append(f"{policy}=0")
    others = lacking - {n for names in FILLABLE_VARIABLES.values() for n in names}
    others -= set(_SPEEDS.values())
    text = f"--fill {' '.join(hints)}" if hints else "no value can be filled"
    return f"{text} ({', '.join(sorted(others))} cannot be filled)" if others and hints else text


def _wind_hint(lacking: Set[str], known: Set[str]) -> str:
    """Return how to fill the wind of a sea with waves: never calm beside waves that act by it."""
    if set(nm.WAVES.pair) <= known:
        return "wind=waves (that which raises the known waves)"
    if lacking & set(nm.WAVES.pair):  # the ship reads the waves themselves
        return "wind=0"
    return "wind=EAST,NORTH (towards, in m/s; the known waves have no direction to take it from)"


def nearest_fills(unknown: Sequence[str], miles: float = 25.0) -> list[str]:
    """Return the policies that fill variables from the nearest known values: "wind=nearest:25".

    Parameters
    ----------
    unknown : Canonical names.
    miles : Greatest distance of known values [nm].
    """
    lacking = set(unknown)
    return [
        f"{policy}={NEAREST}:{miles:g}"
        for policy, names in FILLABLE_VARIABLES.items()
        if lacking & set(names)
    ]
