"""Lipschitz bounds of functions: how fast their values change at most from place to place."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from thalweg.core.bounding_box import WORLD
from thalweg.core.errors import InputError
from thalweg.core.given_numbers import is_number, shortened_repr
from thalweg.core.types import FloatArray
from thalweg.kernels import codes
from thalweg.sea import standard_names as nm
from thalweg.sea.layer import Layer
from thalweg.sea.models.function_layer import FormulaLayer

_METRES_PER_DEGREE = 111_700.0  # of latitude, at most; of longitude times the cosine of latitude
_VECTORS = (
    (codes.CURRENT_EAST, codes.CURRENT_NORTH),
    (codes.WIND_EAST, codes.WIND_NORTH),
    (codes.WAVE_EAST, codes.WAVE_NORTH),
)
_ROUNDING = 1e-6  # of 32-bit samples, relative
Rates = Mapping[str, tuple[float, float]]


def parse_lipschitz(
    given: Rates | None, functions: Iterable[str]
) -> dict[str, tuple[float, float]]:
    """Return the greatest changes a metre and a second by canonical name.

    Parameters
    ----------
    given : Greatest change a metre and a second by the name of a function, in its unit.
    functions : Names of the functions.

    Raises
    ------
    InputError : If it is no mapping of such pairs, a name is not that of a function, or is the
        speed or the direction of wind or current.
    """
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise InputError(
            f"The Lipschitz bounds are {shortened_repr(given)}, which is not a mapping.",
            "They are the greatest changes a metre and a second by the name of a function.",
            "Write them as {'eastward_sea_water_velocity': (1e-5, 1e-4)}.",
            field="lipschitz",
        )
    names, found = list(functions), {}
    for name, pair in given.items():
        if name not in names:
            raise InputError(
                f"There is a Lipschitz bound for {name!r}, but no function of that name.",
                f"The functions are {', '.join(map(repr, sorted(names)))}.",
                "Give the bound of one of these.",
                field="lipschitz",
            )
        rates = _rates(name, pair)
        vector, part = nm.vector_of_derived_name(name) or (None, "")
        if vector is None:
            found[_canonical(name, names)] = rates
        elif part == "speed" or vector.speed:
            raise InputError(
                f"There is a Lipschitz bound for {name!r}.",
                "Of wind and current the bounds are those of the eastward and northward component.",
                f"Give functions for {vector.east!r} and {vector.north!r}, and their bounds.",
                field="lipschitz",
            )
        else:  # the direction of a unit vector [deg]: both components together change as much
            found[vector.east] = math.radians(rates[0]), math.radians(rates[1])
            found[vector.north] = 0.0, 0.0
    return found


def _canonical(name: str, names: Sequence[str]) -> str:
    if nm.is_bed_level(name):
        return nm.BED_DEPTH
    if name != nm.TOTAL_DEPTH:
        return nm.canonical_name(name)
    if any(nm.canonical_name(other) == nm.WATER_LEVEL for other in names):
        raise InputError(
            f"There is a Lipschitz bound for {name!r}, from which the water level is subtracted.",
            "The bound is for the depth below datum.",
            "Give a function for 'sea_floor_depth_below_geoid' in its place, and its bound.",
            field="lipschitz",
        )
    return nm.BED_DEPTH


def _rates(name: str, pair: tuple[float, float]) -> tuple[float, float]:
    listed = isinstance(pair, (Sequence, np.ndarray)) and not isinstance(pair, str)
    if listed and len(pair) == 2 and all(is_number(one) and one >= 0.0 for one in pair):
        return float(pair[0]), float(pair[1])
    raise InputError(
        f"The Lipschitz bound of {name!r} is {shortened_repr(pair)}.",
        "It is two numbers of 0 or more: the greatest change a metre and a second.",
        f"Write it as {{{name!r}: (1e-5, 1e-4)}}.",
        field="lipschitz",
    )


def margins_of_samples(
    layers: Sequence[Layer],
    channels: Sequence[int],
    values: NDArray[np.float32],
    spacing: tuple[float, float, float],
) -> FloatArray | None:
    """Return by how much functions may differ from their interpolated samples, by channel.

    Parameters
    ----------
    channels : Those of the last axis of ``values``.
    values : Samples.
    spacing : Between rows and columns [m] and between times [s], at most.

    Returns
    -------
    float64 array (CHANNELS,), or None
        Of vectors the length of the difference, for both components. None where a layer that is
        not uniform has no Lipschitz bounds for a channel, or is not known everywhere.

    Notes
    -----
    A linear interpolation is a mean of values at corners. By Jensen's inequality the mean distance
    of a place from the corners is half a diagonal at most, and that of a time half a step.
    """
    north, east, step = spacing
    found = np.zeros(codes.CHANNEL_COUNT)
    for number, channel in enumerate(channels):
        name = nm.CHANNEL_VARIABLES.get(channel)
        layer = next((one for one in layers if name in one.variables), None)
        if not isinstance(layer, FormulaLayer):
            return None
        if "values" in layer.facts:  # uniform
            continue
        rates = layer.lipschitz.get(str(name))
        if rates is None or layer.area is not WORLD or layer.period is not None:
            return None
        of_channel = values[..., number]
        largest = max(of_channel.max(initial=0.0), -of_channel.min(initial=0.0))
        rounding = _ROUNDING * float(largest)
        still = layer.time_step == 0.0
        found[channel] = 0.5 * math.hypot(north, east) * rates[0] + rounding
        found[channel] += 0.0 if still else 0.5 * step * rates[1]
    for pair in _VECTORS:
        found[list(pair)] = math.hypot(*found[list(pair)])
    return found if np.isfinite(values).all() else None


def greatest_spacing(
    lat: FloatArray, spacing_lat: float, spacing_lon: float, times: FloatArray
) -> tuple[float, float, float]:
    """Return the greatest spacing of a raster: rows and columns [m] and times [s]."""
    nearest = 0.0 if lat.min() < 0.0 < lat.max() else float(np.abs(lat).min())
    widest = math.cos(math.radians(nearest))
    step = float(np.diff(times).max()) if times.size > 1 else 0.0
    return spacing_lat * _METRES_PER_DEGREE, spacing_lon * _METRES_PER_DEGREE * widest, step
