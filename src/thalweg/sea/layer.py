"""The protocol of a layer: one source of data of a sea, whatever its kind."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias

import numpy as np

from thalweg.core.bounding_box import BoundingBox
from thalweg.core.types import BoolArray, FloatArray
from thalweg.sea.coverage import Coverage
from thalweg.sea.triangle_mesh import Mesh

Samples: TypeAlias = dict[str, FloatArray]


class Layer(Protocol):
    """One source of data; its variables are canonical names, vectors as components."""

    @property
    def variables(self) -> frozenset[str]:
        """Canonical names of the variables of the layer."""
        ...

    @property
    def area(self) -> BoundingBox:
        """The box of positions where the layer may know values."""
        ...

    @property
    def period(self) -> tuple[float, float] | None:
        """First and last time [s since epoch]; None if the layer holds at all times."""
        ...

    def sample(
        self, names: Sequence[str], time: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        """Return values (N,) in SI units at points (N,); NaN where unknown."""
        ...

    def series(
        self, names: Sequence[str], times: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        """Return values (S, T) at stations (S,) for all times (T,); NaN where unknown."""
        ...

    def times(self, start: float, end: float) -> FloatArray:
        """Return native times in [start, end] and one beyond each side; empty without any."""
        ...

    def inside(self, lat: FloatArray, lon: FloatArray) -> BoolArray:
        """Return whether the layer may know values at positions (N,)."""
        ...

    def coverage(self) -> list[Coverage]:
        """Return where and when each variable is known."""
        ...

    def mesh(self) -> Mesh | None:
        """Return the layer's triangle mesh, if it has one."""
        ...

    def provenance(self) -> Mapping[str, Any]:
        """Return plain facts about the source; the fingerprint is a hash of them."""
        ...


@dataclass(frozen=True, eq=False)
class RetimedLayer(ABC):
    """A layer whose values at a time are those of another layer at another time."""

    layer: Layer

    @property
    def variables(self) -> frozenset[str]:
        """Those of the layer."""
        return self.layer.variables

    @property
    def area(self) -> BoundingBox:
        """That of the layer."""
        return self.layer.area

    @abstractmethod
    def _read_at(self, times: FloatArray) -> FloatArray:
        """Return the times at which the layer is read."""

    def sample(
        self, names: Sequence[str], time: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        """Return values at points (N,); NaN where the layer knows none."""
        return self.layer.sample(names, self._read_at(time), lat, lon)

    def series(
        self, names: Sequence[str], times: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        """Return values (S, T) at stations for all times."""
        moments, which = np.unique(self._read_at(times), return_inverse=True)
        found = self.layer.series(names, moments, lat, lon)
        return {name: values[:, which.ravel()] for name, values in found.items()}

    def inside(self, lat: FloatArray, lon: FloatArray) -> BoolArray:
        """Return whether the layer may know values at positions."""
        return self.layer.inside(lat, lon)

    def coverage(self) -> list[Coverage]:
        """Return where and when each variable of the layer is known."""
        return self.layer.coverage()

    def mesh(self) -> Mesh | None:
        """Return the mesh of the layer, if it has one."""
        return self.layer.mesh()


def nan_pairs(samples: Samples, pairs: Sequence[tuple[str, str]]) -> Samples:
    """Make both components of a vector NaN where one of them is.

    Parameters
    ----------
    samples : Values by canonical name; changed in place.
    pairs : sequence of (str, str)
        Names of the components of each vector.
    """
    for east, north in pairs:
        if east in samples and north in samples:
            unknown = np.isnan(samples[east]) | np.isnan(samples[north])
            if unknown.any():
                samples[east] = np.where(unknown, np.nan, samples[east])
                samples[north] = np.where(unknown, np.nan, samples[north])
    return samples
