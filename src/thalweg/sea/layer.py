"""What every layer of a sea can do, whatever its data come from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from thalweg.core.bounding_box import BoundingBox
from thalweg.core.types import FloatArray
from thalweg.sea.coverage import Coverage
from thalweg.sea.grids.triangle_mesh import Mesh

Samples = dict[str, FloatArray]


class Layer(Protocol):
    """One source of data; its variables are canonical names, vectors as components."""

    @property
    def variables(self) -> frozenset[str]:
        """Canonical names of what the layer holds."""
        ...

    @property
    def area(self) -> BoundingBox:
        """The box of positions the layer may know."""
        ...

    @property
    def period(self) -> tuple[float, float] | None:
        """First and last time [s since epoch], or None if the layer holds for all times."""
        ...

    def sample(
        self, names: Sequence[str], time: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        """Return values (N,) at points (N,); NaN where unknown."""
        ...

    def series(
        self, names: Sequence[str], times: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        """Return values (S, T) at stations (S,) for all times (T,); NaN where unknown."""
        ...

    def times(self, start: float, end: float) -> FloatArray:
        """Return native times in [start, end] and one beyond each side; empty if it has none."""
        ...

    def inside(self, lat: FloatArray, lon: FloatArray) -> NDArray[np.bool_]:
        """Return whether positions (N,) lie where the layer may know values."""
        ...

    def coverage(self) -> list[Coverage]:
        """Return where and when each variable is known."""
        ...

    def mesh(self) -> Mesh | None:
        """Return the layer's triangle mesh, if it has one."""
        ...

    def provenance(self) -> Mapping[str, Any]:
        """Return plain facts about the source; they make up the fingerprint."""
        ...


def nan_pairs(samples: Samples, pairs: Sequence[tuple[str, str]]) -> Samples:
    """Make both components of a vector unknown where either is."""
    for east, north in pairs:
        if east in samples and north in samples:
            unknown = np.isnan(samples[east]) | np.isnan(samples[north])
            if unknown.any():
                samples[east] = np.where(unknown, np.nan, samples[east])
                samples[north] = np.where(unknown, np.nan, samples[north])
    return samples
