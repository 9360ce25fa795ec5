"""Warnings of values that look like those of another unit, and of units and times not stated."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from thalweg.core.types import FloatArray
from thalweg.sea import standard_names as nm
from thalweg.sea.grids.gridded_layer import GridLayer
from thalweg.sea.layer import Layer
from thalweg.sea.layer_stack import sample_stack

FEWEST_VALUES: Final = 100  #: with fewer known values there is no warning
LOW_WAVES: Final = 0.1  #: waves that are lower everywhere raise a doubt [m]
NO_UNITS: Final = "Units not stated"  #: a note on variables without units begins so
NO_TIME: Final = "No time in the data"  #: a note on values that hold at all times begins so
_LASTING: Final = frozenset({nm.BED_DEPTH})  # variables that need no time
#: What values without units are read as, where it is not the canonical unit.
_READ_AS: Final = {**dict.fromkeys(nm.WAVES.pair, "degrees"), nm.ICE: "a fraction of 1"}
_FULL_TURN: Final = 2.0 * np.pi + 0.001  # of radians, read as degrees
_NAMES: Final = (nm.WAVE_HEIGHT, *nm.WAVES.pair)


def doubts_of_values(values: Mapping[str, NDArray[Any]]) -> tuple[str, ...]:
    """Return a warning for wave directions that look like radians, and for waves of centimetres.

    Parameters
    ----------
    values : Values [SI] of a sea at many places and times, by canonical name; NaN where unknown.

    Returns
    -------
    tuple of str : Empty if nothing is doubtful. Waves of no height and directions that are all
        exactly north raise no doubt.
    """
    doubts = []
    if all(name in values for name in nm.WAVES.pair):
        east, north = (np.asarray(values[name], float) for name in nm.WAVES.pair)
        if any(_look_like_radians(sign * east, sign * north) for sign in (1.0, -1.0)):
            doubts.append(
                "All wave directions of the data are between 0 and 6.28 degrees: they look like "
                "radians. If they are, correct the units in the file."
            )
    heights = np.asarray(values.get(nm.WAVE_HEIGHT, ()), float)
    highest = float(np.fmax.reduce(heights, axis=None, initial=0.0))
    if np.isfinite(heights).sum() >= FEWEST_VALUES and 0.0 < highest < LOW_WAVES:
        doubts.append(
            f"No wave of the data is higher than {highest:.2g} m: check the units in the file."
        )
    return tuple(doubts)


def doubts_of_files(
    layers: Sequence[Layer], times: FloatArray, lat: FloatArray, lon: FloatArray
) -> tuple[str, ...]:
    """Return the warnings of `doubts_of_values` on what files give for a part of the sea.

    Parameters
    ----------
    layers : Layers of a sea; formulas and single values among them are left out.
    times : Times [s since epoch], (T,).
    lat, lon : Positions [deg], (N,).
    """
    gridded = [layer for layer in layers if isinstance(layer, GridLayer)]
    known = frozenset[str]().union(*(layer.variables for layer in gridded))
    names = [name for name in _NAMES if name in known]
    if not names:
        return ()
    return doubts_of_values(sample_stack(gridded, names, times[:, None], lat, lon))


def guesses_of_files(layers: Sequence[Layer], names: Set[str]) -> tuple[str, ...]:
    """Return a note for each file on variables that are read without units or without a time.

    Parameters
    ----------
    layers : Layers of a sea; formulas and single values among them are left out.
    names : Canonical names of the variables that matter.

    Returns
    -------
    tuple of str : What the values are read as, and that they are used at all times.
    """
    notes = []
    for layer in layers:
        if not isinstance(layer, GridLayer):
            continue
        guessed: dict[str, str] = {}
        for one in layer.record.recognised:
            if one.variable in names and "not stated" in one.units.split(", "):
                unit = _READ_AS.get(one.variable) or nm.CANONICAL_UNITS.get(one.variable, "SI")
                guessed[" and ".join(one.file_variables)] = unit
        if guessed:
            read = ", ".join(f"{name} as {unit}" for name, unit in guessed.items())
            notes.append(f"{NO_UNITS}: {layer.source} is read with {read}. Add the units to it.")
        still = [
            " and ".join(one.file_variables)
            for one in layer.record.recognised
            if layer.axis.is_static and one.variable in names - _LASTING
        ]
        if still:
            notes.append(
                f"{NO_TIME}: the values of {', '.join(dict.fromkeys(still))} in {layer.source} "
                "are used at all times of a voyage."
            )
    return tuple(notes)


def _look_like_radians(east: FloatArray, north: FloatArray) -> bool:
    """Return whether all directions of vectors are in the range of radians, and not all north."""
    angle = (np.degrees(np.arctan2(east, north)) + 1.0) % 360.0 - 1.0
    angle = angle[np.isfinite(angle)]
    if angle.size < FEWEST_VALUES:
        return False
    return bool(angle.min() > -0.001 and 0.001 < angle.max() < _FULL_TURN)
