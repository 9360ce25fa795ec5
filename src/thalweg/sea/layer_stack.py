"""Reading a sea: layers by priority, answered as one."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray
from thalweg.sea import standard_names as nm
from thalweg.sea.coverage import Coverage
from thalweg.sea.ensemble_layer import ensemble_not_allowed_error, member_count, select_member
from thalweg.sea.grids.triangle_mesh import Mesh
from thalweg.sea.layer import Layer, Samples
from thalweg.sea.layer_priority import merge_layers, period_edges, point_reader, series_reader

_DUPLICATE_TOLERANCE = 1e-3  #: [s] within which two layers mean the same time


@dataclass(frozen=True, eq=False)
class LayeredSea:
    """Layers by priority, read as one sea.

    For each variable the first layer that knows a value wins; both components of a vector come
    from the same layer. What no layer knows is NaN. Layers may hold an ensemble; then only its
    members have values.

    Attributes
    ----------
    layers : tuple of Layer
        Sources, first one first.
    assumptions : tuple of str
        What was assumed on the user's word.
    """

    layers: tuple[Layer, ...]
    assumptions: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        member_count(self.layers)

    @property
    def members(self) -> int:
        """How many members the sea has as an ensemble; 0 if it is one sea."""
        return member_count(self.layers)

    def member(self, index: int) -> Self:
        """Return one member of an ensemble, a sea like any other.

        Parameters
        ----------
        index : int
            From 0 to ``members - 1``.

        Raises
        ------
        InputError
            If the sea is no ensemble or has no such member.
        """
        return replace(self, layers=select_member(self.layers, index))

    @property
    def variables(self) -> frozenset[str]:
        """Canonical names of everything some layer holds (vectors as components)."""
        return frozenset().union(*(layer.variables for layer in self.layers))

    def provides(self, name: str) -> bool:
        """Return whether some layer holds the variable, or what it can be derived from."""
        return all(n in self.variables for n in self._sources(name))

    def coverage(self) -> list[Coverage]:
        """Return where and when each variable of each layer is known."""
        return [row for layer in self.layers for row in layer.coverage()]

    def sample(
        self, names: Sequence[str], time: ArrayLike, lat: ArrayLike, lon: ArrayLike
    ) -> dict[str, FloatArray]:
        """Return values at points, linear in time and space.

        Parameters
        ----------
        names : sequence of str
            Canonical names, or CF names of a vector's speed and direction [deg].
        time : array_like
            Seconds since 1970-01-01T00:00Z.
        lat, lon : array_like
            Positions [deg]; all three are broadcast together.

        Returns
        -------
        dict of str to float64 array
            One array of the broadcast shape per name; NaN where nothing is known (see
            `why_missing`).

        Raises
        ------
        InputError
            If the sea is an ensemble (see `member`).
        """
        self.check_single()
        names = [names] if isinstance(names, str) else names
        arrays = np.broadcast_arrays(*(np.asarray(a, np.float64) for a in (time, lat, lon)))
        shape = arrays[0].shape
        flat = [np.ascontiguousarray(a).reshape(-1) for a in arrays]
        base = merge_layers(
            self.layers, self._base(names), point_reader(flat[0], flat[1], flat[2]), flat[0].shape
        )
        return {name: self._derive(name, base).reshape(shape) for name in names}

    def series(
        self, names: Sequence[str], times: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> dict[str, FloatArray]:
        """Return values (S, T) at stations (S,) for every time (T,); faster than `sample`."""
        self.check_single()
        read = series_reader(times, lat, lon)
        base = merge_layers(self.layers, self._base(names), read, (lat.size, times.size))
        return {name: self._derive(name, base) for name in names}

    def check_single(self) -> None:
        """Raise `InputError` if the sea is an ensemble, where one sea is needed."""
        if self.members:
            raise ensemble_not_allowed_error(self.members)

    def why_missing(self, name: str, time: float, lat: float, lon: float) -> str:
        """Return why a value is NaN: "variable", "area", "period" or "gap" (a hole in the data)."""
        holders = [x for x in self.layers if set(self._sources(name)) & x.variables]
        if not holders or not self.provides(name):
            return "variable"
        point = np.array([lat], float), np.array([lon], float)
        holders = [x for x in holders if x.inside(*point)[0]]
        if not holders:
            return "area"
        spans = [x.period for x in holders]
        if not any(p is None or p[0] <= time <= p[1] for p in spans):
            return "period"
        return "gap"

    def period_of(self, names: Sequence[str]) -> tuple[float, float]:
        """Return first and last time [s] some layer knows any of the names; infinite if always."""
        sources = {s for n in names for s in self._sources(n)}
        spans = [x.period or (-np.inf, np.inf) for x in self.layers if x.variables & sources]
        if not spans:
            return np.nan, np.nan
        return min(s[0] for s in spans), max(s[1] for s in spans)

    def times(self, start: float, end: float, *, names: Sequence[str] | None = None) -> FloatArray:
        """Return the times at which the sea is known natively, over a window.

        Parameters
        ----------
        start, end : float
            Window [s since epoch].
        names : sequence of str, optional
            Only layers that hold these; all by default.

        Returns
        -------
        float64 array
            Strictly increasing: the union over layers, with one native step beyond each side of
            the window; formulas add their own uniform steps. Empty if no layer knows the window.
        """
        sources = None if names is None else {s for n in names for s in self._sources(n)}
        layers = [x for x in self.layers if sources is None or x.variables & sources]
        found = [layer.times(start, end) for layer in layers]
        if len(layers) > 1:
            found += [period_edges(x.period, start, end) for x in layers if x.period is not None]
        if not any(f.size for f in found):
            return np.empty(0)
        times = _without_duplicates(np.unique(np.concatenate(found)))
        return times if times.size > 1 else np.append(times, times + 1.0)

    def mesh(self) -> Mesh | None:
        """Return nodes and triangles of the first layer that lies on a mesh, if any."""
        return next((m for layer in self.layers if (m := layer.mesh()) is not None), None)

    def provenance(self) -> dict[str, Any]:
        """Return plain facts about every layer and assumption, ready for JSON."""
        return {
            "layers": [dict(layer.provenance()) for layer in self.layers],
            "assumptions": list(self.assumptions),
            "fingerprint": self.fingerprint(),
        }

    def fingerprint(self) -> str:
        """Return a hash that changes when a file, its variables or an assumption changes."""
        facts = [dict(layer.provenance()) for layer in self.layers]
        text = json.dumps([facts, self.assumptions], sort_keys=True, default=str)
        return hashlib.sha256(text.encode()).hexdigest()[:32]

    def _sources(self, name: str) -> tuple[str, ...]:
        """Return the canonical variables a name is made from."""
        name = nm.canonical_name(name)
        derived = nm.vector_of_derived_name(name)
        if derived is None or (name in self.variables and derived[0].east not in self.variables):
            return (name,)
        return derived[0].pair

    def _base(self, names: Sequence[str]) -> list[str]:
        """Return all variables that must be read, vectors complete."""
        wanted = [s for name in names for s in self._sources(name)]
        whole = [part for name in wanted for part in nm.inseparable_variables(name)]
        return list(dict.fromkeys(whole))

    def _derive(self, name: str, base: Samples) -> FloatArray:
        kept = nm.canonical_name(name)
        if kept in base:
            return base[kept]
        vector, part = nm.vector_of_derived_name(kept) or (nm.WIND, "speed")
        east, north = base[vector.east], base[vector.north]
        if part == "speed":
            return np.asarray(np.hypot(east, north), np.float64)
        sign = 1.0 if part == "towards" else -1.0
        return np.degrees(np.arctan2(sign * east, sign * north)) % 360.0


def _without_duplicates(times: FloatArray) -> FloatArray:
    """Return ascending times without those that follow another within a millisecond.

    The first and the last stay exactly as they are: a ship may leave at the one to the bit.
    """
    kept: FloatArray = times[np.append(True, np.diff(times) > _DUPLICATE_TOLERANCE)]
    if kept.size > 1:
        kept[-1] = times[-1]
    return kept
