"""Layers given by functions instead of files."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.bounding_box import WORLD, BoundingBox
from thalweg.core.errors import InputError, close_matches
from thalweg.core.given_numbers import shortened_repr
from thalweg.core.time import TimeLike
from thalweg.core.types import FloatArray
from thalweg.sea import standard_names as nm
from thalweg.sea.argument_checks import parse_area, parse_period, parse_time_step
from thalweg.sea.coverage import Coverage
from thalweg.sea.layer import Samples, nan_pairs
from thalweg.sea.plausible_values import check_not_negative
from thalweg.sea.triangle_mesh import Mesh

FieldFunction: TypeAlias = Callable[[FloatArray, FloatArray, FloatArray], ArrayLike]
Evaluate: TypeAlias = Callable[[Sequence[str], FloatArray, FloatArray, FloatArray], Samples]

_VECTOR_NAMES = frozenset(
    name for v in nm.VECTORS for name in (*v.pair, v.speed, v.towards, v.origin) if name
)
_KNOWN_NAMES = _VECTOR_NAMES | nm.CANONICAL_UNITS.keys() | {nm.TOTAL_DEPTH}
_LEVELS = (nm.WATER_LEVEL, nm.BED_DEPTH, nm.TOTAL_DEPTH)
_WAVE_NAMES = (nm.WAVE_HEIGHT, nm.WAVE_PERIOD, nm.WAVES.origin, nm.WAVES.towards)
#: names that may be meant where a name has a word
_OF_WORD: Final[dict[str, tuple[str, ...]]] = {
    **dict.fromkeys(
        ("current", "velocity", "stream"), (*nm.CURRENT.pair, nm.CURRENT.speed, nm.CURRENT.towards)
    ),
    "wind": (*nm.WIND.pair, nm.WIND.speed, nm.WIND.origin),
    **dict.fromkeys(("wave", "waves", "swell", "hs", "swh"), _WAVE_NAMES),
    **dict.fromkeys(("depth", "level", "tide", "tidal", "bathymetry", "elevation"), _LEVELS),
    "ice": (nm.ICE,),
}

MAX_STEP = 600.0  #: [s] longest automatic step when a formula is frozen
MIN_STEPS = 200  #: automatic steps across a short window
MAX_STEPS = 2000  #: automatic steps across a long window


@dataclass(frozen=True, eq=False)
class FormulaLayer:
    """A layer whose values are computed when they are needed.

    Attributes
    ----------
    variables : Canonical names.
    evaluate : ``evaluate(names, time, lat, lon) -> {name: array}`` on arrays of one shape.
    label : Origin of the values.
    area : Values are unknown outside.
    period : First and last time [s since epoch]; values are unknown outside.
    time_step : Step [s] at which the formula is frozen; 0 for a field that never changes; None to
        choose it by the length of the window (see `automatic_times`).
    facts : Further plain facts for the provenance.
    lipschitz : Greatest change a metre and a second by canonical name, where known
        (`thalweg.sea.models.lipschitz_bounds.parse_lipschitz`).
    """

    variables: frozenset[str]
    evaluate: Evaluate
    label: str = "formula"
    area: BoundingBox = WORLD
    period: tuple[float, float] | None = None
    time_step: float | None = None
    facts: Mapping[str, Any] = field(default_factory=dict)
    lipschitz: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    def sample(
        self, names: Sequence[str], time: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        """Return values at points of one shape; NaN outside the area and the period."""
        known = self._covers(time, lat, lon)
        values = self.evaluate(names, time, lat, lon)
        if known is not None:
            values = {name: np.where(known, value, np.nan) for name, value in values.items()}
        return nan_pairs(values, [v.pair for v in nm.VECTORS])

    def series(
        self, names: Sequence[str], times: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        """Return values (S, T) at stations for all times."""
        shape = (lat.size, times.size)
        if self.time_step == 0.0 and self.period is None:
            still = self.sample(names, np.zeros(lat.shape), lat, lon)
            return {name: np.broadcast_to(v[:, None], shape) for name, v in still.items()}
        time = np.ascontiguousarray(np.broadcast_to(times, shape))
        wide = [np.ascontiguousarray(np.broadcast_to(a[:, None], shape)) for a in (lat, lon)]
        return self.sample(names, time, wide[0], wide[1])

    def times(self, start: float, end: float) -> FloatArray:
        """Return the times at which the formula is frozen over a window [s since epoch]."""
        if self.period is not None:
            start, end = max(start, self.period[0]), min(end, self.period[1])
        if end < start:
            return np.empty(0)
        if self.time_step == 0.0 or end == start:
            return np.array([start, end]) if end > start else np.array([start])
        return automatic_times(start, end, self.time_step)

    def inside(self, lat: FloatArray, lon: FloatArray) -> NDArray[np.bool_]:
        """Return whether positions are in the area."""
        return self.area.covers(lat, lon)

    def coverage(self) -> list[Coverage]:
        """Return one row per variable."""
        a, (start, end) = self.area, self.period or (None, None)
        step = self.time_step or None
        return [
            Coverage(n, a.south, a.north, a.west, a.east, start, end, step, None, self.label)
            for n in sorted(self.variables)
        ]

    def mesh(self) -> Mesh | None:
        """Return None: formulas have no mesh."""
        return None

    def provenance(self) -> Mapping[str, Any]:
        """Return the names, area and period, which are all that identifies a formula."""
        a = self.area
        return {
            "kind": "formula",
            "label": self.label,
            "variables": sorted(self.variables),
            "area": [a.south, a.north, a.west, a.east],
            "period": list(self.period) if self.period else None,
            "time_step": self.time_step,
            **({"lipschitz": dict(self.lipschitz)} if self.lipschitz else {}),
            **self.facts,
        }

    def _covers(self, time: FloatArray, lat: FloatArray, lon: FloatArray) -> Any:
        known = None
        if self.area is not WORLD:
            known = self.area.covers(lat, lon)
        if self.period is not None:
            inside = (time >= self.period[0]) & (time <= self.period[1])
            known = inside if known is None else known & inside
        return known


def automatic_times(start: float, end: float, time_step: float | None = None) -> FloatArray:
    """Return uniform times for freezing a formula.

    Parameters
    ----------
    start, end : Window [s since epoch].
    time_step : Step [s], reduced so that the last step ends on the window; by default ``min(600 s,
        window / 200)``, increased where there would be more than 2000 steps.

    Returns
    -------
    float64 array (T,) : Times [s since epoch], both ends included.
    """
    window = end - start
    if time_step is None:
        time_step = max(min(MAX_STEP, window / MIN_STEPS), window / MAX_STEPS)
    steps = max(1, int(np.ceil(window / time_step - 1e-9)))
    return np.linspace(start, end, steps + 1)


def constant_layer(values: Mapping[str, float], label: str) -> FormulaLayer:
    """Return a layer with constant values [SI].

    Parameters
    ----------
    values : Value [SI] by canonical name.
    label : Origin of the values.
    """

    def evaluate(
        names: Sequence[str], time: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        return {name: np.full(time.shape, values[name]) for name in names}

    facts = {"values": dict(values)}
    return FormulaLayer(frozenset(values), evaluate, label, time_step=0.0, facts=facts)


def layer_of_functions(
    functions: Mapping[str, FieldFunction],
    *,
    area: tuple[float, float, float, float] | None = None,
    period: tuple[TimeLike, TimeLike] | None = None,
    time_step: float | None = None,
) -> FormulaLayer:
    """Return a layer of functions, with speeds and directions converted to components.

    Parameters
    ----------
    functions : As for `thalweg.sea.Sea.from_functions`.
    area : (south, north, west, east) [deg]; values are unknown outside.
    period : (start, end); values are unknown outside.
    time_step : Step [s] of frozen times.

    Raises
    ------
    InputError : If the functions are no mapping, one half of a vector is missing, or a variable is
        given twice; or the area, period or time step is not valid.
    """
    if not isinstance(functions, Mapping):
        raise InputError(
            f"The functions are {shortened_repr(functions)}, which is not a mapping.",
            "A mapping gives a function f(time_s, lat, lon) for each standard name.",
            "Write it as {'wind_speed': f, 'wind_from_direction': g}.",
        )
    box, span, step = parse_area(area), parse_period(period), parse_time_step(time_step)
    makers = _variable_functions(functions)

    def evaluate(
        names: Sequence[str], time: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> Samples:
        done: Samples = {}
        for name in names:
            if name not in done:
                done.update(makers[name](time, lat, lon))
        return {name: done[name] for name in names}

    return FormulaLayer(frozenset(makers), evaluate, "formula", box, span, step)


VariableFunction: TypeAlias = Callable[[FloatArray, FloatArray, FloatArray], Samples]


def _variable_functions(functions: Mapping[str, FieldFunction]) -> dict[str, VariableFunction]:
    """Return for each canonical variable the function that computes it (and its partner)."""
    for name in functions:
        _check_name(name)
    given = {name: _checked(name, function) for name, function in functions.items()}
    makers: dict[str, VariableFunction] = {}
    for vector in nm.VECTORS:
        _convert_vector(vector, given, makers)
    _convert_bed(given, makers)
    for name, function in given.items():
        canonical = nm.canonical_name(name)
        if canonical in makers:
            raise _given_twice_error(canonical, name)
        makers[canonical] = _single_variable(canonical, function)
    return makers


def _convert_vector(
    vector: nm.VectorNames, given: dict[str, FieldFunction], makers: dict[str, VariableFunction]
) -> None:
    """Move the functions of one vector from ``given`` to ``makers``."""
    have = [name for name in vector.pair if name in given]
    directions = [d for d in (vector.towards, vector.origin) if d in given]
    if len(have) == 1:
        missing = next(name for name in vector.pair if name not in have)
        raise InputError(
            f"The sea is given {have[0]!r} without {missing!r}.",
            "A vector needs both components, or a speed and a direction.",
            f"Add a function for {missing!r}; it can return 0.0.",
            missing=missing,
        )
    if len(have) == 2:
        again = [*directions, *(s for s in (vector.speed,) if s in given)]
        if again:
            raise _given_twice_error(have[0], again[0])
        for name in vector.pair:
            makers[name] = _single_variable(name, given.pop(name))
        return
    if not directions:
        return
    if len(directions) == 2:
        raise _given_twice_error(directions[0], directions[1])
    speed = given.pop(vector.speed, None) if vector.speed else _constant_one
    if speed is None:
        raise InputError(
            f"The sea is given {directions[0]!r} without {vector.speed!r}.",
            "A direction needs a speed.",
            f"Add a function for {vector.speed!r}.",
            missing=vector.speed,
        )
    maker = _components_of_polar(
        vector, speed, given.pop(directions[0]), directions[0] == vector.origin
    )
    makers[vector.east] = makers[vector.north] = maker


def _convert_bed(given: dict[str, FieldFunction], makers: dict[str, VariableFunction]) -> None:
    """Convert bed levels (positive up) and depths below the moving surface to bed depths."""
    for name in [n for n in given if nm.is_bed_level(n)]:
        if nm.BED_DEPTH in makers:
            raise _given_twice_error(nm.BED_DEPTH, name)
        makers[nm.BED_DEPTH] = _single_variable(
            nm.BED_DEPTH, _difference(_constant_zero, given.pop(name))
        )
    total = given.pop(nm.TOTAL_DEPTH, None)
    if total is None:
        return
    if any(nm.canonical_name(name) == nm.BED_DEPTH for name in given) or nm.BED_DEPTH in makers:
        raise _given_twice_error(nm.BED_DEPTH, nm.TOTAL_DEPTH)
    level = next(
        (f for name, f in given.items() if nm.canonical_name(name) == nm.WATER_LEVEL), None
    )
    bed = total if level is None else _difference(total, level)
    makers[nm.BED_DEPTH] = _single_variable(nm.BED_DEPTH, bed)


def _single_variable(name: str, function: FieldFunction) -> VariableFunction:
    return lambda time, lat, lon: {name: np.asarray(function(time, lat, lon))}


def _difference(first: FieldFunction, second: FieldFunction) -> FieldFunction:
    return lambda time, lat, lon: np.subtract(first(time, lat, lon), second(time, lat, lon))


def _components_of_polar(
    vector: nm.VectorNames, speed: FieldFunction, direction: FieldFunction, is_origin: bool
) -> VariableFunction:
    sign = -1.0 if is_origin else 1.0

    def make(time: FloatArray, lat: FloatArray, lon: FloatArray) -> Samples:
        length = np.asarray(speed(time, lat, lon))
        angle = np.radians(np.asarray(direction(time, lat, lon)))
        return {
            vector.east: sign * length * np.sin(angle),
            vector.north: sign * length * np.cos(angle),
        }

    return make


def _constant_one(time: FloatArray, lat: FloatArray, lon: FloatArray) -> FloatArray:
    return np.ones(time.shape)


def _constant_zero(time: FloatArray, lat: FloatArray, lon: FloatArray) -> FloatArray:
    return np.zeros(time.shape)


def _checked(name: str, function: FieldFunction) -> FieldFunction:
    """Wrap a user's function so that it always returns a float array of the requested shape."""
    if not callable(function):
        raise InputError(
            f"The sea's {name!r} is a {type(function).__name__}, not a function.",
            "Give a function f(time_s, lat, lon) that returns an array or a number.",
            f"For a constant write {{{name!r}: lambda time, lat, lon: {function!r}}}.",
            field=name,
        )

    def call(time: FloatArray, lat: FloatArray, lon: FloatArray) -> FloatArray:
        result = function(time, lat, lon)
        try:
            if np.iscomplexobj(result):
                raise TypeError
            value = np.broadcast_to(np.asarray(result, dtype=np.float64), time.shape)
        except (TypeError, ValueError):
            raise InputError(
                f"The function for {name!r} returned {_describe(result)} "
                f"for arrays of shape {time.shape}.",
                "It must return real numbers of that shape, or one number.",
                "Write it with NumPy operations on time, lat and lon.",
                field=name,
            ) from None
        check_not_negative(name, value)
        return value if value.flags.writeable else value.copy()

    return call


def _check_name(name: str) -> None:
    """Refuse a name that looks like a variable of the sea and is none: it would never be read.

    Other names are variables of the user's own, for ships that read them.
    """
    if nm.canonical_name(name) in _KNOWN_NAMES or nm.is_bed_level(name):
        return
    words = {near for word in name.casefold().split("_") for near in close_matches(word, _OF_WORD)}
    meant = list(dict.fromkeys(known for word in sorted(words) for known in _OF_WORD[word]))
    if meant:
        raise InputError(
            f"There is no variable of the sea named {name!r}.",
            f"Names with a similar word: {', '.join(meant)}.",
            "Write one of these. A variable of your own, which a ship of yours reads, needs a name "
            "without such words.",
            field=name,
        )


def _describe(result: object) -> str:
    shape = getattr(result, "shape", None)
    return f"an array of shape {shape}" if shape is not None else f"a {type(result).__name__}"


def _given_twice_error(name: str, other: str) -> InputError:
    return InputError(
        f"The sea is given {name!r} twice: {other!r} is another name of it.",
        "Each variable can be given once.",
        "Remove one of the two functions.",
        field=name,
    )
