"""Several layers read as one: for each variable the first layer that has a value is used.

The layers of a `thalweg.sea.Sea` are in order of priority. Both components of a vector come from
the same layer. A value that no layer knows is NaN.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.types import FloatArray
from thalweg.sea import standard_names as nm
from thalweg.sea.coverage import Coverage
from thalweg.sea.ensemble_layer import check_not_ensemble
from thalweg.sea.layer import Layer, Samples
from thalweg.sea.triangle_mesh import Mesh

LayerReader: TypeAlias = Callable[[Layer, Sequence[str], Any], Samples]

_DUPLICATE_TOLERANCE = 1e-3  #: [s] two layers' times closer than this are the same time


def stack_variables(layers: Sequence[Layer]) -> frozenset[str]:
    """Return the canonical names of all variables that at least one layer holds.

    Parameters
    ----------
    layers : Layers in order of priority.

    Returns
    -------
    frozenset of str : CF standard names; vectors as components.
    """
    return frozenset().union(*(layer.variables for layer in layers))


def stack_provides(layers: Sequence[Layer], name: str) -> bool:
    """Return whether a layer holds a variable, or the variables it is derived from.

    Parameters
    ----------
    name : str
        Canonical name, or the CF name of a vector's speed or direction.

    Returns
    -------
    bool
        Whether the variable can be sampled.
    """
    variables = stack_variables(layers)
    return all(n in variables for n in _sources(variables, name))


def sample_stack(
    layers: Sequence[Layer], names: Sequence[str], time: ArrayLike, lat: ArrayLike, lon: ArrayLike
) -> Samples:
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
        One array of the broadcast shape per name, in SI units; NaN where unknown (see
        `why_missing`).

    Raises
    ------
    InputError
        If the sea is an ensemble (see `member`).
    """
    check_not_ensemble(layers)
    names = [names] if isinstance(names, str) else names
    arrays = np.broadcast_arrays(*(np.asarray(a, np.float64) for a in (time, lat, lon)))
    shape = arrays[0].shape
    times, lats, lons = (np.ascontiguousarray(a).reshape(-1) for a in arrays)

    def read(layer: Layer, wanted: Sequence[str], rows: Any) -> Samples:
        pick = slice(None) if rows is None else rows
        return layer.sample(wanted, times[pick], lats[pick], lons[pick])

    base = _merged(layers, _base_variables(layers, names), read, times.shape)
    return {name: _derived(name, base).reshape(shape) for name in names}


def series_of_stack(
    layers: Sequence[Layer],
    names: Sequence[str],
    times: FloatArray,
    lat: FloatArray,
    lon: FloatArray,
) -> Samples:
    """Return values at stations for every time; faster than `sample`.

    Parameters
    ----------
    names : sequence of str
        Canonical names, or CF names of a vector's speed and direction.
    times : float64 array (T,)
        Seconds since 1970-01-01T00:00Z.
    lat, lon : float64 array (S,)
        Stations [deg].

    Returns
    -------
    dict of str to float64 array (S, T)
        One array per name, in SI units; NaN where unknown.

    Raises
    ------
    InputError
        If the sea is an ensemble (see `member`).
    """
    check_not_ensemble(layers)

    def read(layer: Layer, wanted: Sequence[str], rows: Any) -> Samples:
        pick = slice(None) if rows is None else rows
        return layer.series(wanted, times, lat[pick], lon[pick])

    base = _merged(layers, _base_variables(layers, names), read, (lat.size, times.size))
    return {name: _derived(name, base) for name in names}


def stack_times(
    layers: Sequence[Layer], start: float, end: float, *, names: Sequence[str] | None = None
) -> FloatArray:
    """Return the native times of the data over a window.

    Parameters
    ----------
    start, end : float
        Window [s since epoch].
    names : sequence of str, optional
        Only layers that hold these; all by default.

    Returns
    -------
    float64 array (T,)
        Strictly increasing [s since epoch]: the union over layers, with one native step beyond
        each side of the window; formulas add their own uniform steps. Empty if no layer covers the
        window.
    """
    if names is not None:
        layers = _holders(layers, names)
    found = [layer.times(start, end) for layer in layers]
    if len(layers) > 1:
        found += [_period_edges(x.period, start, end) for x in layers if x.period is not None]
    if not any(f.size for f in found):
        return np.empty(0)
    times = _without_duplicates(np.unique(np.concatenate(found)))
    return times if times.size > 1 else np.append(times, times + 1.0)


def stack_period(layers: Sequence[Layer], names: Sequence[str]) -> tuple[float, float]:
    """Return the first and last time at which a layer knows any of the names.

    Parameters
    ----------
    names : sequence of str
        Canonical names.

    Returns
    -------
    first, last : float
        Times [s since 1970-01-01T00:00Z]: infinite if a layer holds at all times, NaN if no layer
        holds a name.
    """
    spans = [layer.period or (-np.inf, np.inf) for layer in _holders(layers, names)]
    if not spans:
        return np.nan, np.nan
    return min(s[0] for s in spans), max(s[1] for s in spans)


def first_mesh(layers: Sequence[Layer]) -> Mesh | None:
    """Return nodes and triangles of the first layer that has a mesh.

    Returns
    -------
    Mesh or None
        None if no layer has one.
    """
    return next((mesh for layer in layers if (mesh := layer.mesh()) is not None), None)


def coverage_of_layers(layers: Sequence[Layer]) -> list[Coverage]:
    """Return where and when each variable of each layer is known.

    Returns
    -------
    list of Coverage
        One for each variable of each layer, in order of priority.
    """
    return [row for layer in layers for row in layer.coverage()]


def missing_reason(layers: Sequence[Layer], name: str, time: float, lat: float, lon: float) -> str:
    """Return why a value is NaN.

    Parameters
    ----------
    name : str
        Canonical name.
    time : float
        Time [s since epoch].
    lat, lon : float
        Position [deg].

    Returns
    -------
    {"variable", "area", "period", "gap"}
        No layer holds the variable, covers the position or covers the time; or data are missing
        there (land, ice, a gap between two times).
    """
    holders = _holders(layers, [name])
    if not holders or not stack_provides(layers, name):
        return "variable"
    point = np.array([lat], float), np.array([lon], float)
    holders = [x for x in holders if x.inside(*point)[0]]
    if not holders:
        return "area"
    spans = [x.period for x in holders]
    if not any(p is None or p[0] <= time <= p[1] for p in spans):
        return "period"
    return "gap"


def _holders(layers: Sequence[Layer], names: Sequence[str]) -> list[Layer]:
    """Return the layers that hold a source of any of the names."""
    variables = stack_variables(layers)
    sources = {s for n in names for s in _sources(variables, n)}
    return [layer for layer in layers if layer.variables & sources]


def _sources(variables: frozenset[str], name: str) -> tuple[str, ...]:
    """Return the canonical variables from which a name is derived."""
    name = nm.canonical_name(name)
    derived = nm.vector_of_derived_name(name)
    if derived is None or (name in variables and derived[0].east not in variables):
        return (name,)
    return derived[0].pair


def _base_variables(layers: Sequence[Layer], names: Sequence[str]) -> list[str]:
    """Return all variables that must be read, vectors complete."""
    variables = stack_variables(layers)
    wanted = [s for name in names for s in _sources(variables, name)]
    whole = [part for name in wanted for part in nm.inseparable_variables(name)]
    return list(dict.fromkeys(whole))


def _derived(name: str, base: Samples) -> FloatArray:
    """Return a variable, or the speed [m/s] or direction [deg] derived from two components."""
    canonical = nm.canonical_name(name)
    if canonical in base:
        return base[canonical]
    vector, part = nm.vector_of_derived_name(canonical) or (nm.WIND, "speed")
    east, north = base[vector.east], base[vector.north]
    if part == "speed":
        return np.asarray(np.hypot(east, north), np.float64)
    sign = 1.0 if part == "towards" else -1.0
    return np.degrees(np.arctan2(sign * east, sign * north)) % 360.0


def _merged(
    layers: Sequence[Layer], names: Sequence[str], read: LayerReader, shape: tuple[int, ...]
) -> Samples:
    """Return the variables, each value from the first layer that knows it; NaN without one."""
    found: Samples = {}
    for layer in layers:
        have = [n for n in names if n in layer.variables]
        rows = _unknown_rows(have, found)
        if have and (rows is None or rows.size):
            _fill_unknown(found, read(layer, have, rows), rows)
    for name in names:
        found.setdefault(name, np.full(shape, np.nan))
    return found


def _unknown_rows(names: Sequence[str], merged: Samples) -> Any:
    """Return the rows where at least one variable is still unknown; None for all rows."""
    if not names or any(name not in merged for name in names):
        return None
    unknown = np.zeros(merged[names[0]].shape, bool)
    for name in names:
        unknown |= np.isnan(merged[name])
    return np.flatnonzero(unknown if unknown.ndim == 1 else unknown.any(axis=1))


def _fill_unknown(merged: Samples, found: Samples, rows: Any) -> None:
    """Write values that a layer found where none was known; layers return vectors NaN in pairs."""
    for name, value in found.items():
        if name not in merged:
            merged[name] = value
            continue
        pick = slice(None) if rows is None else rows
        old = merged[name] = np.array(merged[name])
        old[pick] = np.where(np.isnan(old[pick]), value, old[pick])


def _period_edges(period: tuple[float, float], start: float, end: float) -> FloatArray:
    """Return times just outside a layer's period, where another layer takes over."""
    edges = np.array([period[0] - 1.0, period[1] + 1.0])
    return edges[(edges > start) & (edges < end)]


def _without_duplicates(times: FloatArray) -> FloatArray:
    """Return ascending times without those that follow another within a millisecond.

    The first and last stay exactly as they are, because a departure may equal the first one.
    """
    unique: FloatArray = times[np.append(True, np.diff(times) > _DUPLICATE_TOLERANCE)]
    if unique.size > 1:
        unique[-1] = times[-1]
    return unique
