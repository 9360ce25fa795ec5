"""Layers that fill what data leave unknown next to land: nearest known values, and head seas.

Grids of waves and currents mask the cells that touch land, so that the first cells off a coast are
unknown. A user may state by name what holds there; nothing is filled unasked.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from thalweg.core.bounding_box import WORLD, BoundingBox
from thalweg.core.errors import InputError
from thalweg.core.geodesy import MEAN_RADIUS, geocentric_unit_vectors
from thalweg.core.types import BoolArray, FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.sea import standard_names as nm
from thalweg.sea.coverage import Coverage
from thalweg.sea.grids.grid_protocol import grid_positions
from thalweg.sea.grids.gridded_layer import GridLayer
from thalweg.sea.grids.source_variables import GridWindow
from thalweg.sea.layer import Layer, Samples
from thalweg.sea.layer_stack import (
    sample_stack,
    series_of_stack,
    stack_times,
    stack_variables,
)
from thalweg.sea.models.derived_layer import DerivedLayer, finite_period, inside_layers_with
from thalweg.sea.triangle_mesh import Mesh

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

PERIOD_OF_ROOT_HEIGHT: Final = 5.0  #: [s / sqrt(m)] peak period of a fully developed sea
COAST_CELLS: Final = 2  #: cells from an unknown one up to which known ones are candidates
SHORTEST_PERIOD: Final = 1.0  #: [s]


class HeadSeasLayer(DerivedLayer):
    """Waves of known height without direction or period, taken from ahead on every course.

    The direction is the vector of length zero, which counts as head seas for every heading. The
    peak period is that of a fully developed sea (Pierson and Moskowitz 1964):
    ``T = 5.0 s/sqrt(m) * sqrt(Hs)``, at least 1 s.

    Attributes
    ----------
    layers : tuple of Layer
        The layers with the height, in order of priority.
    """

    needed = (nm.WAVE_HEIGHT,)
    derived = frozenset({*nm.WAVES.pair, nm.WAVE_PERIOD})
    source_text = "head seas with the height of"

    def _values(
        self, needed: Mapping[str, FloatArray], lat: FloatArray, lon: FloatArray
    ) -> dict[str, FloatArray]:
        height = needed[nm.WAVE_HEIGHT]
        still = np.where(np.isnan(height), np.nan, 0.0)
        period = np.maximum(PERIOD_OF_ROOT_HEIGHT * np.sqrt(height), SHORTEST_PERIOD)
        return {nm.WAVE_TO_EAST: still, nm.WAVE_TO_NORTH: still.copy(), nm.WAVE_PERIOD: period}

    def provenance(self) -> Mapping[str, Any]:
        """Return what is assumed."""
        return {"kind": "head seas", "period_s_per_root_m": PERIOD_OF_ROOT_HEIGHT}


@dataclass(frozen=True, eq=False)
class NearestLayer:
    """Values of the nearest known position of the grids, up to a distance.

    Only positions inside the area of a grid are filled: its cells without data next to land.

    Attributes
    ----------
    layers : The layers that are filled, in order of priority.
    names : Canonical names of what is filled.
    distance : Greatest distance [m].
    height_factor : Wave heights are multiplied by this.
    """

    layers: tuple[Layer, ...]
    names: frozenset[str]
    distance: float
    height_factor: float = 1.0

    @property
    def variables(self) -> frozenset[str]:
        """What is filled, as far as the layers hold it."""
        return self.names & stack_variables(self.layers)

    @property
    def area(self) -> BoundingBox:
        """The world; the grids limit where values are filled."""
        return WORLD

    @property
    def period(self) -> tuple[float, float] | None:
        """The period of the layers."""
        return finite_period(self.layers, tuple(self.variables))

    @cached_property
    def _grids(self) -> list[tuple[frozenset[str], FloatArray, FloatArray, cKDTree]]:
        """Return for each grid its variables, and the known positions near its unknown ones."""
        from scipy.spatial import cKDTree

        grids = []
        for layer in self.layers:
            held = self.names & layer.variables
            if not isinstance(layer, GridLayer) or not held:
                continue
            lat, lon = _known_near_unknown(layer, held)
            if lat.size:
                tree = cKDTree(geocentric_unit_vectors(lat, lon))
                grids.append((held, lat, lon, tree))
        return grids

    def sample(
        self, names: Sequence[str], time: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        """Return values at points of one shape; NaN where nothing is known near enough."""
        return self._filled(
            names, lat, lon, lambda n, k, y, x: sample_stack(self.layers, n, time[k], y, x), ()
        )

    def series(
        self, names: Sequence[str], times: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        """Return values (S, T) at stations for all times."""
        return self._filled(
            names,
            lat,
            lon,
            lambda n, k, y, x: series_of_stack(self.layers, n, times, y, x),
            (times.size,),
        )

    def _filled(
        self,
        names: Sequence[str],
        lat: FloatArray,
        lon: FloatArray,
        read: Callable[[list[str], Any, FloatArray, FloatArray], Samples],
        more: tuple[int, ...],
    ) -> Samples:
        samples = {name: np.full((lat.size, *more), np.nan) for name in names}
        limit = 2.0 * np.sin(min(0.5 * self.distance / MEAN_RADIUS, 0.5 * np.pi))
        here = geocentric_unit_vectors(lat, lon)
        for held, y, x, tree in self._grids:
            own = [n for n in names if n in held]
            rows = np.flatnonzero(inside_layers_with(self.layers, held, lat, lon))
            if not (own and rows.size):
                continue
            far, nearest = tree.query(here[rows], distance_upper_bound=limit)
            rows, nearest = rows[np.isfinite(far)], nearest[np.isfinite(far)]
            if rows.size == 0:
                continue
            values = read(own, rows, y[nearest], x[nearest])
            if nm.WAVE_HEIGHT in values:
                values = {**values, nm.WAVE_HEIGHT: self.height_factor * values[nm.WAVE_HEIGHT]}
            for name in own:
                old = samples[name][rows]
                samples[name][rows] = np.where(np.isnan(old), values[name], old)
        return samples

    def times(self, start: float, end: float) -> FloatArray:
        """Return the times of the layers that are filled."""
        return stack_times(self.layers, start, end, names=sorted(self.variables))

    def inside(self, lat: FloatArray, lon: FloatArray) -> BoolArray:
        """Return whether positions are in the area of a layer that is filled."""
        return inside_layers_with(self.layers, self.variables, lat, lon)

    def coverage(self) -> list[Coverage]:
        """Return the rows of the layers that are filled."""
        text = f"nearest within {self.distance / NAUTICAL_MILE:g} nm of "
        return [
            replace(row, source=text + row.source)
            for layer in self.layers
            for row in layer.coverage()
            if row.variable in self.variables
        ]

    def mesh(self) -> Mesh | None:
        """Return None: the layer has no mesh."""
        return None

    def provenance(self) -> Mapping[str, Any]:
        """Return what is filled and how far."""
        return {
            "kind": "nearest known values",
            "variables": sorted(self.variables),
            "distance_m": self.distance,
            "wave_height_factor": self.height_factor,
        }


def head_seas_layer(layers: Sequence[Layer]) -> HeadSeasLayer:
    """Return a layer of head seas for waves of known height.

    Parameters
    ----------
    layers : Layers in order of priority.

    Raises
    ------
    InputError : If the layers hold no wave height.
    """
    variables = stack_variables(layers)
    if nm.WAVE_HEIGHT not in variables:
        raise InputError(
            "Waves are to be taken from ahead, but the sea holds no wave height.",
            f"The sea holds: {', '.join(sorted(variables)) or 'nothing'}.",
            "Add a file with the significant wave height, or fill waves with a height.",
        )
    return HeadSeasLayer(tuple(layers))


def nearest_layer(
    layers: Sequence[Layer], names: Sequence[str], distance: float, *, height_factor: float = 1.0
) -> NearestLayer:
    """Return a layer of the nearest known values of some variables.

    Parameters
    ----------
    layers : Layers in order of priority.
    names : Canonical names.
    distance : Greatest distance [m].
    height_factor : Wave heights are multiplied by this.

    Raises
    ------
    InputError : If no layer that was read from a file holds one of them.
    """
    wanted = frozenset(names)
    if not any(isinstance(x, GridLayer) and wanted & x.variables for x in layers):
        raise InputError(
            f"The nearest values of {', '.join(sorted(wanted))} were requested, but no file holds "
            "them.",
            f"The sea holds: {', '.join(sorted(stack_variables(layers))) or 'nothing'}.",
            "Add a file with them, or fill with a value.",
        )
    return NearestLayer(tuple(layers), wanted, distance, height_factor)


def _known_near_unknown(layer: GridLayer, names: frozenset[str]) -> tuple[FloatArray, FloatArray]:
    """Return the grid points [deg] next to unknown ones where all names are known.

    A point counts as known if it is so at the first, middle and last time, and can be sampled.
    """
    rows, columns = layer.grid.shape
    count = max(1, layer.axis.times.size)
    levels = sorted({0, count // 2, count - 1})
    known = np.ones(rows * columns, bool)
    for level in levels:
        window = GridWindow(level, level + 1, 0, rows, 0, columns)
        for quantity in layer.quantities:
            if names & set(quantity.names):
                for values in quantity.read(window, columns).values():
                    known &= ~np.isnan(values[0])
    known &= _beside_unknown(known.reshape(rows, columns), layer.grid.wraps).ravel()
    lat, lon = grid_positions(layer.grid)
    known &= np.isfinite(lat) & np.isfinite(lon)
    lat, lon = lat[known], lon[known]
    moments = layer.axis.times[levels] if layer.axis.times.size else np.zeros(1)
    series = layer.series(sorted(names), moments, lat, lon)
    sound = np.all([np.isfinite(v).all(axis=1) for v in series.values()], axis=0)
    return lat[sound], lon[sound]


def _beside_unknown(known: BoolArray, wraps: bool) -> BoolArray:
    """Return which points have an unknown one within `COAST_CELLS`; all points of a mesh."""
    from scipy import ndimage

    if known.shape[0] == 1:
        return np.ones(known.shape, bool)
    pad = COAST_CELLS
    wide = np.pad(~known, ((0, 0), (pad, pad)), mode="wrap" if wraps else "edge")
    near = ndimage.binary_dilation(wide, np.ones((2 * pad + 1, 2 * pad + 1), bool))
    return np.asarray(near[:, pad:-pad])
