"""Vertical layers in files, and the mean of currents from the surface down to a draught.

The current that acts on a ship is the mean over her draught, not that of the top layer. Sigma
layers are fractions of the water depth at each time. z layers are at fixed depths below datum; the
top one reaches up to the moving surface. Each layer is weighted with its thickness within the
draught, as far as it holds water; where the draught is greater than the water depth, the mean is
that of the whole column.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from thalweg.core.errors import DatasetError
from thalweg.core.types import FloatArray
from thalweg.sea.files import unit_conversion
from thalweg.sea.files.vertical_levels import (
    depth_sign,
    is_sigma,
    level_coordinate,
    sigma_sign_and_offset,
)


@dataclass(frozen=True, eq=False)
class VerticalLayers:
    """The layers of a file along one dimension.

    Attributes
    ----------
    is_sigma : Whether edges are fractions of the water depth (0 surface, 1 bed), else depths [m
        below datum].
    top, bottom : Upper and lower edge of each layer, (L,).
    """

    dim: str
    is_sigma: bool
    top: FloatArray
    bottom: FloatArray

    @property
    def surface(self) -> int:
        """Index of the layer at the surface."""
        return int(np.argmin(self.top))

    def describe(self) -> str:
        """Return their number and kind as text."""
        return f"{self.top.size} {'sigma' if self.is_sigma else 'z'} layers"

    def shares(self, draught: float, column: FloatArray) -> FloatArray:
        """Return the thickness of each layer within a draught.

        Parameters
        ----------
        draught : Depth below the surface [m].
        column : float64 array (T, Y, X)
            Water depth at each time [m] for sigma layers, water level [m above datum] for others.

        Returns
        -------
        float64 array (T, L, Y, X)
            Thickness within the draught [m]; without positive water depth, 1 in the top layer.
        """
        high, low = (e[None, :, None, None] for e in (self.top, self.bottom))
        wide = column[:, None]
        if self.is_sigma:
            upper, lower = high * wide, low * wide
        else:
            upper, lower = high + wide, low + wide
            upper[:, self.surface] = 0.0
        thick = np.clip(np.minimum(lower, draught) - np.maximum(upper, 0.0), 0.0, None)
        if self.is_sigma:
            first = (np.arange(self.top.size) == self.surface)[None, :, None, None]
            thick = np.where(wide > 0.0, thick, np.where(first & ~np.isnan(wide), 1.0, 0.0))
        return np.asarray(thick)


def draught_averaging(
    layers: VerticalLayers, draught: float, depth: Callable[[Sequence[FloatArray]], FloatArray]
) -> Callable[[Sequence[FloatArray]], Sequence[FloatArray]]:
    """Return a function that averages two components over the draught.

    Parameters
    ----------
    layers : The layers of both components.
    draught : Draught [m].
    depth : ``depth(arrays)`` returns the ``column`` that `VerticalLayers.shares` needs, from all
        arrays, of which the first two are the components (T, L, Y, X).

    Returns
    -------
    callable : ``combine(arrays)`` returns the two means (T, Y, X).
    """

    def combine(arrays: Sequence[FloatArray]) -> Sequence[FloatArray]:
        shares = layers.shares(draught, depth(arrays))
        return [_weighted_mean(values, shares) for values in arrays[:2]]

    return combine


def _weighted_mean(values: FloatArray, shares: FloatArray) -> FloatArray:
    """Return the weighted mean over layers (axis 1), of the layers that are known."""
    weight = np.where(np.isnan(values), 0.0, np.broadcast_to(shares, values.shape))
    total = weight.sum(axis=1)
    summed = np.where(weight > 0.0, values * weight, 0.0).sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(total > 0.0, summed / total, np.nan)


def find_vertical_layers(
    dataset: Any, array: Any, keep: frozenset[str], source: str
) -> VerticalLayers | None:
    """Return the vertical layers of a variable; None without any.

    Parameters
    ----------
    dataset, array : The file and one of its variables.
    keep : Its dimensions of time and position.
    source : File name for messages.

    Raises
    ------
    DatasetError : If its layers are given neither as fractions of the depth nor as depths.
    """
    dims = [str(d) for d in array.dims if d not in keep and array.sizes[d] > 1]
    if len(dims) != 1:
        return None
    coordinate = level_coordinate(dataset, dims[0])
    if coordinate is None:
        raise _unknown_layers_error(array, dims[0], "have no coordinate", source)
    values = np.asarray(coordinate.values, float)
    if is_sigma(coordinate):
        return _sigma_layers(dataset, coordinate, dims[0], values)
    sign = depth_sign(coordinate)
    if sign is None:
        what = coordinate.attrs.get("standard_name") or coordinate.name
        raise _unknown_layers_error(array, dims[0], f"are those of {what!r}", source)
    unit = str(coordinate.attrs.get("units", ""))
    scale = (
        1.0
        if unit_conversion.is_unspecified(unit)
        else unit_conversion.si_factor(unit, "length") or 1.0
    )
    top, bottom = _layer_edges(dataset, coordinate, sign * scale, sign * scale * values)
    return VerticalLayers(dims[0], False, top, bottom)


def _sigma_layers(dataset: Any, coordinate: Any, dim: str, values: FloatArray) -> VerticalLayers:
    """Return layers in fractions of the depth; sigma may run downwards or upwards, from 0 or -1."""
    sign, offset = sigma_sign_and_offset(coordinate, values)
    top, bottom = _layer_edges(
        dataset, coordinate, sign, sign * values + offset, offset, (0.0, 1.0)
    )
    return VerticalLayers(dim, True, top, bottom)


def _layer_edges(
    dataset: Any,
    coordinate: Any,
    sign: float,
    middle: FloatArray,
    offset: float = 0.0,
    ends: tuple[float, float] | None = None,
) -> tuple[FloatArray, FloatArray]:
    """Return upper and lower edges: those of the file, else midway between the layer centres."""
    stated = _stated_edges(dataset, coordinate)
    if stated is not None:
        edges = sign * stated + offset
        return edges.min(axis=1), edges.max(axis=1)
    order = np.argsort(middle)
    inner = 0.5 * (middle[order][1:] + middle[order][:-1])
    first = 0.0 if ends is None else ends[0]
    last = 2.0 * middle[order][-1] - inner[-1] if ends is None else ends[1]
    rims = np.concatenate([[min(first, float(middle.min()))], inner, [last]])
    top, bottom = np.empty_like(middle), np.empty_like(middle)
    top[order], bottom[order] = rims[:-1], rims[1:]
    return top, bottom


def _stated_edges(dataset: Any, coordinate: Any) -> FloatArray | None:
    """Return edges (L, 2) from the bounds of a coordinate, or from its layer interfaces."""
    bounds = str(coordinate.attrs.get("bounds", ""))
    if bounds in dataset.variables and dataset[bounds].shape == (coordinate.size, 2):
        return np.asarray(dataset[bounds].values, float)
    name = str(coordinate.name)
    for twin in (name.replace("layer", "interface"), name.replace("siglay", "siglev")):
        if twin != name and twin in dataset.variables:
            rims = np.asarray(dataset[twin].values, float)
            if rims.shape == (coordinate.size + 1,):
                return np.stack([rims[:-1], rims[1:]], axis=1)
    return None


def _unknown_layers_error(array: Any, dim: str, fault: str, source: str) -> DatasetError:
    return DatasetError(
        f"{source}: the layers of {array.name!r} along {dim!r} {fault}; they cannot be averaged.",
        "Sigma layers (ocean_sigma_coordinate, 0 at the surface to -1) and depths or heights with "
        "units and a direction (positive up or down) can be averaged.",
        "Add the coordinate to the file, or omit draught_m to use the surface layer.",
        file=source,
        variable=str(array.name),
    )


def missing_depth_error(names: Sequence[str], source: str) -> DatasetError:
    """Return the error for sigma layers in a file without the water depth."""
    return DatasetError(
        f"{source}: {' and '.join(names)} are in sigma layers, and the file has no depth on the "
        "same grid that gives their thickness.",
        "A bed level or bed depth (and a water level), or a total depth, is needed on that grid.",
        "Add it to the file, or omit draught_m to use the surface layer.",
        file=source,
    )
