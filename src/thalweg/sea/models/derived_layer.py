"""Layers whose values follow from those of other layers, at the same place and time."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from thalweg.core.bounding_box import WORLD, BoundingBox
from thalweg.core.types import BoolArray, FloatArray
from thalweg.sea.coverage import Coverage
from thalweg.sea.layer import Layer, Samples
from thalweg.sea.layer_stack import sample_stack, series_of_stack, stack_period, stack_times
from thalweg.sea.triangle_mesh import Mesh


@dataclass(frozen=True, eq=False)
class DerivedLayer(ABC):
    """A layer whose values follow from those of other layers.

    Attributes
    ----------
    layers : The layers with what is needed, in order of priority; values are unknown where it is.
    """

    layers: tuple[Layer, ...]

    #: Canonical names of what is needed, of what follows from it, and a text before the source.
    needed: ClassVar[tuple[str, ...]]
    derived: ClassVar[frozenset[str]]
    source_text: ClassVar[str]

    @property
    def variables(self) -> frozenset[str]:
        """What is derived."""
        return self.derived

    @property
    def area(self) -> BoundingBox:
        """The world; what is needed limits where values are known."""
        return WORLD

    @property
    def period(self) -> tuple[float, float] | None:
        """The period of what is needed."""
        return finite_period(self.layers, self.needed)

    def sample(
        self, names: Sequence[str], time: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        """Return values at points; NaN where what is needed is unknown."""
        values = self._values(
            sample_stack(self.layers, list(self.needed), time, lat, lon), lat, lon
        )
        return {name: values[name] for name in names if name in values}

    def series(
        self, names: Sequence[str], times: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        """Return values (S, T) at stations for all times."""
        values = self._values(
            series_of_stack(self.layers, list(self.needed), times, lat, lon), lat, lon
        )
        return {name: values[name] for name in names if name in values}

    @abstractmethod
    def _values(
        self, needed: Mapping[str, FloatArray], lat: FloatArray, lon: FloatArray
    ) -> dict[str, FloatArray]:
        """Return what is derived at positions [deg], each in an array of its own."""

    def times(self, start: float, end: float) -> FloatArray:
        """Return the times of what is needed."""
        return stack_times(self.layers, start, end, names=self.needed)

    def inside(self, lat: FloatArray, lon: FloatArray) -> BoolArray:
        """Return whether what is needed may be known at positions."""
        return inside_layers_with(self.layers, frozenset(self.needed), lat, lon)

    def coverage(self) -> list[Coverage]:
        """Return the rows of what is needed, for what is derived."""
        rows = [r for x in self.layers for r in x.coverage() if r.variable == self.needed[0]]
        return [
            replace(row, variable=name, source=f"{self.source_text} {row.source}")
            for row in rows
            for name in sorted(self.variables)
        ]

    def mesh(self) -> Mesh | None:
        """Return None: the layer has no mesh."""
        return None

    @abstractmethod
    def provenance(self) -> Mapping[str, Any]:
        """Return what is assumed."""


def finite_period(layers: Sequence[Layer], names: Sequence[str]) -> tuple[float, float] | None:
    """Return the period [s since 1970-01-01T00:00Z] of variables; None if it has no bounds.

    Parameters
    ----------
    names : Canonical names.
    """
    start, end = stack_period(layers, names)
    return (start, end) if np.isfinite([start, end]).all() else None


def inside_layers_with(
    layers: Sequence[Layer], names: frozenset[str], lat: FloatArray, lon: FloatArray
) -> BoolArray:
    """Return which positions are in the area of a layer that holds one of some variables.

    Parameters
    ----------
    names : Canonical names.
    lat, lon : Positions [deg].
    """
    inside = np.zeros(lat.shape, bool)
    for layer in layers:
        if names & layer.variables:
            inside |= np.asarray(layer.inside(lat, lon), bool)
    return inside
