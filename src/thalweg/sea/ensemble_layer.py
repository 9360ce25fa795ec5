"""Ensembles: several versions of one sea, each as likely as the others.

An ensemble is a layer of a sea like any other source, so it can be combined with tides or depths
that are the same for all members. It has no values itself: `Sea.member` selects a member.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from thalweg.core.bounding_box import BoundingBox
from thalweg.core.errors import InputError
from thalweg.core.time import format_time
from thalweg.core.types import FloatArray
from thalweg.sea.coverage import Coverage
from thalweg.sea.grids.gridded_layer import GridLayer
from thalweg.sea.layer import Layer, Samples
from thalweg.sea.triangle_mesh import Mesh


@dataclass(frozen=True, eq=False)
class EnsembleLayer:
    """Several versions of one layer, on one grid and one time axis."""

    member_layers: tuple[Layer, ...]

    @property
    def variables(self) -> frozenset[str]:
        """Canonical names of what every member holds."""
        return self.member_layers[0].variables

    @property
    def area(self) -> BoundingBox:
        """The box of positions where the members may know values."""
        return self.member_layers[0].area

    @property
    def period(self) -> tuple[float, float] | None:
        """First and last time of every member [s since epoch]; None if they hold always."""
        return self.member_layers[0].period

    def sample(
        self, names: Sequence[str], time: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        """Raise `InputError`: an ensemble has no values itself."""
        raise ensemble_not_allowed_error(len(self.member_layers))

    def series(
        self, names: Sequence[str], times: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        """Raise `InputError`: an ensemble has no values itself."""
        raise ensemble_not_allowed_error(len(self.member_layers))

    def times(self, start: float, end: float) -> FloatArray:
        """Return the native times of every member."""
        return self.member_layers[0].times(start, end)

    def inside(self, lat: FloatArray, lon: FloatArray) -> NDArray[np.bool_]:
        """Return whether the members may know values at positions."""
        return self.member_layers[0].inside(lat, lon)

    def coverage(self) -> list[Coverage]:
        """Return where and when each variable is known; the same for all members."""
        count = len(self.member_layers)
        rows = self.member_layers[0].coverage()
        return [replace(row, source=f"{row.source} and {count - 1} more members") for row in rows]

    def mesh(self) -> Mesh | None:
        """Return the members' triangle mesh, if they have one."""
        return self.member_layers[0].mesh()

    def provenance(self) -> Mapping[str, Any]:
        """Return the facts of the first member, and a hash of those of all."""
        facts = [dict(version.provenance()) for version in self.member_layers]
        text = json.dumps(facts, sort_keys=True, default=str)
        digest = hashlib.sha256(text.encode()).hexdigest()[:32]
        return {"kind": "ensemble", "members": len(facts), "first": facts[0], "all": digest}


def member_count(layers: Sequence[Layer]) -> int:
    """Return the number of members of the ensembles among layers; 0 without an ensemble.

    Raises
    ------
    InputError : If there are ensembles of different sizes.
    """
    sizes = {len(x.member_layers) for x in layers if isinstance(x, EnsembleLayer)}
    if len(sizes) > 1:
        raise InputError(
            f"One sea contains ensembles of {' and '.join(map(str, sorted(sizes)))} members.",
            "Member i of one ensemble is combined with member i of the other.",
            "Give ensembles of equal size, or select a member of one with Sea.member(i).",
        )
    return sizes.pop() if sizes else 0


def check_not_ensemble(layers: Sequence[Layer]) -> None:
    """Do nothing for a single sea; raise `InputError` for an ensemble.

    Raises
    ------
    InputError
        If a layer holds an ensemble.
    """
    count = member_count(layers)
    if count:
        raise ensemble_not_allowed_error(count)


def ensemble_not_allowed_error(count: int) -> InputError:
    """Return the error for an ensemble where a single sea is needed."""
    return InputError(
        f"This sea is an ensemble of {count} members, and one sea is needed here.",
        f"Its members are numbered 0 to {count - 1}; in Python evaluate_members evaluates a route "
        "in all of them.",
        "Select one: thalweg evaluate --member N, member: in a study, sea.member(i) in Python.",
        members=count,
    )


def select_member(layers: Sequence[Layer], index: int) -> tuple[Layer, ...]:
    """Return the layers with one member of every ensemble among them.

    Parameters
    ----------
    layers : Layers, of which at least one is an ensemble.
    index : From 0 to the number of members minus 1.

    Raises
    ------
    InputError : If there is no ensemble, or it has no such member.
    """
    count = member_count(layers)
    if count == 0:
        raise InputError(
            f"Member {index!r} was requested, but the sea is not an ensemble.",
            "Ensembles come from files with a dimension such as number or realization, or from "
            "Sea.ensemble.",
            "Use the sea as it is.",
        )
    whole = isinstance(index, (int, np.integer)) and not isinstance(index, bool)
    if not (whole and 0 <= index < count):
        raise InputError(
            f"There is no member {index!r}.",
            f"Members are numbered 0 to {count - 1}.",
            "Choose one of them.",
        )
    picked = int(index)
    return tuple(x.member_layers[picked] if isinstance(x, EnsembleLayer) else x for x in layers)


def ensemble_layers(seas: Sequence[Sequence[Layer]]) -> tuple[Layer, ...]:
    """Return the layers of an ensemble of seas, each given by its layers (see `Sea.ensemble`).

    Parameters
    ----------
    seas : The layers of each member.

    Raises
    ------
    InputError : If there are fewer than two, or they differ in variables, grid, times or area.
    """
    if len(seas) < 2:
        raise InputError(
            f"An ensemble of {len(seas)} member(s) was requested.",
            "An ensemble has two or more members.",
            "Give more members, or use the one sea as it is.",
        )
    first = seas[0]
    names = [frozenset().union(*(layer.variables for layer in layers)) for layers in seas]
    for number, layers in enumerate(seas):
        members = member_count(layers)
        if members:
            raise _member_mismatch_error(number, f"is itself an ensemble of {members}")
        for name in sorted(names[0] ^ names[number]):
            has = "lacks" if name in names[0] else "has"
            raise _member_mismatch_error(number, f"{has} {name}, unlike member 0")
        if len(layers) != len(first):
            raise _member_mismatch_error(
                number, f"has {len(layers)} layers, member 0 has {len(first)}"
            )
    return tuple(combine_member_layers([layers[k] for layers in seas]) for k in range(len(first)))


def combine_member_layers(layers: Sequence[Layer]) -> Layer:
    """Return one ensemble layer from the layer of each member; a layer they share stays as it is.

    Raises
    ------
    InputError : If they differ in variables, grid, times or area.
    """
    first = layers[0]
    if all(layer is first for layer in layers):
        return first
    for number, layer in enumerate(layers):
        difference = _layer_difference(first, layer)
        if difference:
            raise _member_mismatch_error(number, difference)
    return EnsembleLayer(tuple(layers))


def _layer_difference(first: Layer, other: Layer) -> str:
    """Return why two layers cannot be members of one ensemble; empty if they can."""
    if first.variables != other.variables:
        return "has its variables in other layers than member 0"
    if first.period != other.period:
        return f"runs {_period_text(other.period)}, member 0 {_period_text(first.period)}"
    if isinstance(first, GridLayer) and isinstance(other, GridLayer):
        if not np.array_equal(first.axis.times, other.axis.times):
            return f"has {other.axis.times.size} times, not those of member 0"
        a, b = first.grid, other.grid
        same = a is b or (a.shape == b.shape and _same_positions(a, b))
        rows, columns = b.shape
        return "" if same else f"is on another grid ({rows} x {columns} points) than member 0"
    own = [replace(row, source="") for row in first.coverage()]
    theirs = [replace(row, source="") for row in other.coverage()]
    same = [_coverage_values(row) for row in own] == [_coverage_values(row) for row in theirs]
    return "" if same else "covers another area or period, or has other time steps, than member 0"


def _coverage_values(row: Coverage) -> list[Any]:
    return [getattr(row, name) for name in row.__dataclass_fields__]


def _same_positions(a: Any, b: Any) -> bool:
    return bool(
        np.array_equal(a.lat, b.lat, equal_nan=True)
        and np.array_equal(a.lon, b.lon, equal_nan=True)
    )


def _period_text(period: tuple[float, float] | None) -> str:
    if period is None:
        return "at all times"
    return f"from {format_time(period[0])} to {format_time(period[1])}"


def _member_mismatch_error(number: int, difference: str) -> InputError:
    return InputError(
        f"Member {number} of the ensemble {difference}.",
        "All members must have the same grid, times and variables.",
        "Select or interpolate the same part of every member.",
        member=number,
    )
