"""A layer of tides: currents and water level at any date, predicted from constituents."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from thalweg.core.bounding_box import WORLD, BoundingBox
from thalweg.core.errors import InputError
from thalweg.core.geodesy import longitude_difference
from thalweg.core.types import ComplexArray, FloatArray
from thalweg.sea import standard_names as nm
from thalweg.sea.coverage import Coverage
from thalweg.sea.ensemble_layer import check_not_ensemble
from thalweg.sea.grids.grid_protocol import Grid, GridLocation
from thalweg.sea.grids.gridded_layer import GridLayer
from thalweg.sea.grids.triangle_grid import TriangleGrid
from thalweg.sea.layer import Layer, Samples, nan_pairs
from thalweg.sea.models.function_layer import automatic_times
from thalweg.sea.tides import harmonic_analysis
from thalweg.sea.tides.constituents import Constituents, tidal_signal, unit_phasors
from thalweg.sea.tides.model_run_analysis import analyse_layer, has_tides, no_tides_error
from thalweg.sea.triangle_mesh import Mesh

TIME_STEP: Final = 600.0  #: [s] step at which kernels receive the tide
POINTS_PER_BLOCK: Final = 1 << 13  #: points predicted at once


@dataclass(frozen=True, eq=False)
class TidalLayer:
    """Constituents on a grid: linear in space between nodes, exact at any time.

    Attributes
    ----------
    constituents : Constants at the points of the grid.
    grid : Positions of the nodes; None for one node that applies to a whole area.
    box : The area, if there is no grid.
    time_step : Step [s] at which kernels receive the tide.
    source : Origin of the constants.
    facts : Further plain facts for the provenance.
    """

    constituents: Constituents
    grid: Grid | None
    box: BoundingBox = WORLD
    time_step: float = TIME_STEP
    source: str = "tidal constituents"
    facts: Mapping[str, Any] = field(default_factory=dict)

    @property
    def variables(self) -> frozenset[str]:
        """Canonical names of what is predicted."""
        return self.constituents.variables

    @property
    def area(self) -> BoundingBox:
        """The box around the nodes."""
        return self.box if self.grid is None else self.grid.area

    @property
    def period(self) -> tuple[float, float] | None:
        """None: the tide is known at all times."""
        return None

    @cached_property
    def _waves(self) -> dict[str, ComplexArray]:
        """Coefficients (N, C) by variable."""
        return {
            n: np.ascontiguousarray(self.constituents.coefficients(n).T) for n in self.variables
        }

    def sample(
        self, names: Sequence[str], time: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        """Return values at points (N,); NaN outside the grid and where nodes have no tide."""
        result = {name: np.full(time.shape, np.nan) for name in names}
        for first in range(0, time.size, POINTS_PER_BLOCK):
            part = slice(first, first + POINTS_PER_BLOCK)
            moments, which = np.unique(time[part], return_inverse=True)
            wave = self._phasors(moments)[which.ravel()]
            located = self._locate(lat[part], lon[part])
            for name in names:
                mean, coefficient = self._at(name, located)
                wave_part = coefficient.real * wave.real - coefficient.imag * wave.imag
                result[name][part] = mean + wave_part.sum(axis=1)
        return nan_pairs(result, [v.pair for v in nm.VECTORS])

    def series(
        self, names: Sequence[str], times: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        """Return values (S, T) at stations for all times."""
        result = {name: np.empty((lat.size, times.size)) for name in names}
        located = self._locate(lat, lon)
        held = {name: self._at(name, located) for name in names}
        for first in range(0, times.size, POINTS_PER_BLOCK):
            part = slice(first, first + POINTS_PER_BLOCK)
            wave = self._phasors(times[part]).T
            for name, (mean, coefficient) in held.items():
                result[name][:, part] = mean[:, None] + tidal_signal(coefficient, wave)
        return nan_pairs(result, [v.pair for v in nm.VECTORS])

    def times(self, start: float, end: float) -> FloatArray:
        """Return the times at which the tide is frozen over a window."""
        return automatic_times(start, end, self.time_step) if end > start else np.array([start])

    def inside(self, lat: FloatArray, lon: FloatArray) -> NDArray[np.bool_]:
        """Return whether positions are in the grid or the area."""
        return np.asarray(self._locate(lat, lon).corner[:, 0] >= 0)

    def coverage(self) -> list[Coverage]:
        """Return one row per variable; the tide is known at all times."""
        a = self.area
        spacing = self.grid.spacing if self.grid is not None else None
        return [
            Coverage(n, a.south, a.north, a.west, a.east, None, None, None, spacing, self.source)
            for n in sorted(self.variables)
        ]

    def mesh(self) -> Mesh | None:
        """Return the mesh, if the grid is one."""
        return None if self.grid is None else self.grid.mesh()

    def provenance(self) -> Mapping[str, Any]:
        """Return the constituents, a hash of their values, and their source."""
        constants = self.constituents
        digest = hashlib.sha256()
        for name in sorted(self.variables):
            for part in (constants.amplitude, constants.phase, constants.mean):
                digest.update(np.ascontiguousarray(part[name]).tobytes())
        return {
            "kind": "tide",
            "source": self.source,
            "variables": sorted(self.variables),
            "constituents": list(constants.names),
            "convention": constants.convention,
            "values": digest.hexdigest()[:32],
            "time_step": self.time_step,
            **self.facts,
        }

    def _phasors(self, times: FloatArray) -> ComplexArray:
        known = np.where(np.isfinite(times), times, 0.0)
        constants = self.constituents
        wave = _cached_phasors(
            constants.names, known.tobytes(), constants.latitude, constants.convention
        )
        if not np.isfinite(times).all():
            wave = np.where(np.isfinite(times)[:, None], wave, np.nan)
        return wave

    def _locate(self, lat: FloatArray, lon: FloatArray) -> GridLocation:
        if self.grid is not None:
            return self.grid.locate(lat, lon)
        inside = np.where(self.box.covers(lat, lon), 0, -1).astype(np.int64)
        return GridLocation(inside[:, None], np.ones((lat.size, 1)))

    def _at(self, name: str, located: GridLocation) -> tuple[FloatArray, ComplexArray]:
        """Return mean (N,) and coefficients (N, C) at located points; NaN outside."""
        corner, weight = located.corner, located.weight
        mean, wave = self.constituents.mean[name], self._waves[name]
        level = np.zeros(corner.shape[0])
        coefficient = np.zeros((corner.shape[0], wave.shape[1]), np.complex128)
        for k in range(corner.shape[1]):
            node, share = np.maximum(corner[:, k], 0), weight[:, k]
            used = share != 0.0
            level[used] += share[used] * mean[node[used]]
            coefficient[used] += share[used, None] * wave[node[used]]
        level[corner[:, 0] < 0] = np.nan
        return level, coefficient


@lru_cache(maxsize=8)
def _cached_phasors(
    names: tuple[str, ...], times: bytes, latitude: float, convention: str
) -> ComplexArray:
    """Return phasors for times given as bytes; cached for other stations with the same times."""
    wave = unit_phasors(names, np.frombuffer(times), latitude, convention)
    wave.flags.writeable = False
    return wave


def tidal_layers(
    source: Sequence[Layer] | Constituents | harmonic_analysis.TideAnalysis,
    *,
    constituents: Sequence[str] | None = None,
    area: BoundingBox | None = None,
    rayleigh: float = harmonic_analysis.RAYLEIGH,
    progress: harmonic_analysis.ProgressCallback | None = None,
    cache: bool = True,
) -> tuple[Layer, ...]:
    """Return the layers of a sea of tides (see `thalweg.sea.Sea.from_tides`).

    Parameters
    ----------
    source : The layers of a model run, or constants.
    constituents, rayleigh, progress, cache : As for `thalweg.sea.Sea.from_tides`.
    area : Where a single station applies.

    Raises
    ------
    InputError : If the source has no tides, or the area does not fit the source.
    """
    if isinstance(source, harmonic_analysis.TideAnalysis):
        source = source.constituents
    if isinstance(source, Constituents):
        chosen = source if constituents is None else source.picked(constituents)
        return (_layer_from_constituents(chosen, area),)
    if area is not None:
        raise _area_not_allowed_error()
    check_not_ensemble(source)
    layers: list[Layer] = []
    for layer in source:
        if isinstance(layer, GridLayer) and has_tides(layer):
            layers.append(_layer_from_model_run(layer, constituents, rayleigh, progress, cache))
        elif layer.period is None:
            layers.append(layer)
    if not any(isinstance(layer, TidalLayer) for layer in layers):
        raise no_tides_error()
    return tuple(layers)


def _layer_from_model_run(
    layer: GridLayer,
    constituents: Sequence[str] | None,
    rayleigh: float,
    progress: harmonic_analysis.ProgressCallback | None,
    cache: bool,
) -> TidalLayer:
    analysis = analyse_layer(
        layer, constituents=constituents, rayleigh=rayleigh, progress=progress, cache=cache
    )
    shares = {n: round(analysis.share(n), 4) for n in analysis.variance}
    facts = {
        "analysed": dict(layer.provenance()),
        "tidal_share": shares,
        "record": [analysis.start, analysis.end],
    }
    return TidalLayer(
        analysis.constituents, layer.grid, source=f"tide of {layer.source}", facts=facts
    )


def _layer_from_constituents(constants: Constituents, area: BoundingBox | None) -> TidalLayer:
    facts = dict(constants.facts)
    source = str(facts.get("source", "tidal constituents"))
    pair = nm.CURRENT.pair
    if len(constants.variables & set(pair)) == 1:
        raise InputError(
            "Constituents of one component of the current are given without the other.",
            "A current needs an east and a north component.",
            f"Give both {pair[0]} and {pair[1]}.",
        )
    if constants.lat.size == 1:
        if area is None:
            raise InputError(
                "Constituents of a single station are given without an area.",
                "The tide of one station can be applied to an area that you name.",
                "Give area=(south, north, west, east) in degrees.",
            )
        return TidalLayer(constants, None, area, source=source, facts=facts)
    if area is not None:
        raise _area_not_allowed_error()
    grid = _triangulated_grid(constants.lat, constants.lon)
    return TidalLayer(constants, grid, source=source, facts=facts)


def _area_not_allowed_error() -> InputError:
    return InputError(
        "An area is given for tides that have positions.",
        "An area applies to the tide of a single station only.",
        "Leave the area out.",
    )


def _triangulated_grid(lat: FloatArray, lon: FloatArray) -> TriangleGrid:
    """Return a mesh over scattered nodes."""
    from scipy.spatial import Delaunay, QhullError

    try:
        if not (np.isfinite(lat).all() and np.isfinite(lon).all()):
            raise ValueError
        centre = float(np.cos(np.radians(lat.mean())))
        east = longitude_difference(lon, lon[0])
        triangles = Delaunay(np.column_stack([east * centre, lat])).simplices
    except (QhullError, ValueError):
        raise InputError(
            f"{lat.size} nodes make no triangles: too few, in one line, or without positions.",
            "The tide is interpolated linearly between three or more nodes.",
            "Give more nodes, or one station with an area.",
        ) from None
    triangles = np.ascontiguousarray(triangles, np.int64)
    return TriangleGrid(lat, lon, triangles, (1, lat.size), Mesh(lat, lon, triangles))
