"""How canonical quantities are made from variables of files: signs, components, turns, means."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from thalweg.core.types import FloatArray
from thalweg.sea.files.grid_detection import GridPlacement
from thalweg.sea.grids.source_variables import GridWindow

Combine = Callable[[Sequence[FloatArray]], Sequence[FloatArray]]


def identity(arrays: Sequence[FloatArray]) -> Sequence[FloatArray]:
    """Return what comes in."""
    return arrays


def scale_by(sign: float) -> Combine:
    """Return what multiplies an array."""
    return lambda arrays: [sign * arrays[0]]


def subtract(sign: float) -> Combine:
    """Return what takes the second array, of a sign, from the first."""
    return lambda arrays: [arrays[0] - sign * arrays[1]]


def polar_to_components(sign: float) -> Combine:
    """Return what makes components of a speed and a direction [deg]; -1 where it tells from."""

    def combine(arrays: Sequence[FloatArray]) -> Sequence[FloatArray]:
        length, angle = sign * arrays[0], np.radians(arrays[1])
        return [length * np.sin(angle), length * np.cos(angle)]

    return combine


def direction_to_unit_vector(sign: float) -> Combine:
    """Return what makes a unit vector of a direction [deg]; -1 where it tells from."""

    def combine(arrays: Sequence[FloatArray]) -> Sequence[FloatArray]:
        angle = np.radians(arrays[0])
        return [sign * np.sin(angle), sign * np.cos(angle)]

    return combine


def make_conversion(combine: Combine, place: GridPlacement, turn: bool) -> Any:
    """Return what turns arrays of a window, in SI, into canonical ones."""
    angle = place.angle if turn else None

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
    """Turn components along the grid into true east and north."""
    cosine, sine = np.cos(angle), np.sin(angle)
    return [u * cosine - v * sine, u * sine + v * cosine]
