"""Derive canonical variables from file variables: signs, differences, components, rotation."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from thalweg.core.types import FloatArray
from thalweg.sea.files.grid_detection import GridPlacement
from thalweg.sea.grids.source_variables import GridWindow
from thalweg.sea.plausible_values import check_direction

Combine = Callable[[Sequence[FloatArray]], Sequence[FloatArray]]


def identity(arrays: Sequence[FloatArray]) -> Sequence[FloatArray]:
    """Return the arrays unchanged."""
    return arrays


def scale_by(factor: float) -> Combine:
    """Return a function that multiplies the first array by a factor."""
    return lambda arrays: [factor * arrays[0]]


def subtract(sign: float) -> Combine:
    """Return a function that subtracts the second array, times a sign, from the first."""
    return lambda arrays: [arrays[0] - sign * arrays[1]]


def polar_to_components(sign: float) -> Combine:
    """Return a function that converts speed and direction [deg] to east and north components.

    ``sign`` is 1 for directions towards and -1 for directions from.
    """

    def combine(arrays: Sequence[FloatArray]) -> Sequence[FloatArray]:
        length, angle = sign * arrays[0], np.radians(arrays[1])
        return [length * np.sin(angle), length * np.cos(angle)]

    return combine


def direction_to_unit_vector(sign: float) -> Combine:
    """Return a function that converts a direction [deg] to a unit vector (east, north).

    ``sign`` is 1 for directions towards and -1 for directions from.
    """

    def combine(arrays: Sequence[FloatArray]) -> Sequence[FloatArray]:
        angle = np.radians(arrays[0])
        return [sign * np.sin(angle), sign * np.cos(angle)]

    return combine


def with_checked_direction(combine: Combine, index: int, variable: str, source: str) -> Combine:
    """Return a function that checks the directions [deg] among the arrays, then combines them.

    Parameters
    ----------
    combine : Makes the variables from the arrays.
    index : Number of the array that holds directions.
    variable, source : Names of the variable and of the file, for messages.
    """

    def checked(arrays: Sequence[FloatArray]) -> Sequence[FloatArray]:
        check_direction(arrays[index], variable, source)
        return combine(arrays)

    return checked


def make_conversion(combine: Combine, place: GridPlacement, rotate: bool) -> Any:
    """Return the function that converts the arrays of a window, in SI, to canonical variables.

    Parameters
    ----------
    place : Their grid; on faces of a mesh, values are also averaged to its nodes.
    rotate : Whether the variables are components along the grid, to be rotated to east and north.
    """
    angle = place.angle if rotate else None

    def make(raws: Sequence[FloatArray], window: GridWindow) -> Sequence[FloatArray]:
        made = combine(raws)
        if angle is not None:
            made = _rotate(
                made[0], made[1], _angle_in_window(angle, window, place.mesh is not None)
            )
        if place.mesh is not None and place.mesh.averaging is not None:
            made = [place.mesh.averaging.append_nodes(value) for value in made]
        return made

    return make


def _angle_in_window(angle: FloatArray, window: GridWindow, is_mesh: bool) -> FloatArray:
    if is_mesh:
        return angle
    columns = np.arange(window.x0, window.x0 + window.width) % angle.shape[1]
    return angle[window.y0 : window.y1][:, columns]


def _rotate(u: FloatArray, v: FloatArray, angle: FloatArray) -> list[FloatArray]:
    """Rotate components along the grid to true east and north."""
    cosine, sine = np.cos(angle), np.sin(angle)
    return [u * cosine - v * sine, u * sine + v * cosine]
