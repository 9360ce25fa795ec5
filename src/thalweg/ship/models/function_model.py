"""Ships given as a function of conditions, for analytic test seas and measured polars."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray
from thalweg.core.units import KNOT
from thalweg.ship.condition_variables import (
    AXIS_OF_CONDITION,
    BED_DEPTH,
    HEADING_DEPENDENT,
    needed_variables,
)
from thalweg.ship.conditions import Conditions
from thalweg.ship.methods.validity import RangeNote
from thalweg.ship.model_protocol import setting_index
from thalweg.ship.tables.table_parts import TableError, TablePart
from thalweg.ship.tables.tabulate import (
    DEFAULT_AXES,
    constant_part,
    random_conditions,
    tabulate_dense,
)

_GREATEST_SPEED: Final = 80.0 * KNOT  # [m/s]: more is knots

SpeedFunction = Callable[[Conditions], ArrayLike]

_PROBE_RANGES = {
    "lat": (-60.0, 60.0),
    "lon": (-170.0, 170.0),
    "time": (1.6e9, 1.8e9),
    "heading": (0.0, 6.28),
    "current_east": (-2.0, 2.0),
    "current_north": (-2.0, 2.0),
    "load_factor": (0.0, 1.0),
    BED_DEPTH: (5.0, 5000.0),
}
_PROBES = 32


class RecordingConditions(Conditions):
    """Conditions with plausible values for any name that record what was read.

    Parameters
    ----------
    row : Give this one of the values as a single number, instead of all as an array.
    """

    __slots__ = ("_read", "_row")
    _read: set[str]
    _row: int | None

    def __init__(self, row: int | None = None) -> None:
        super().__init__()
        object.__setattr__(self, "_read", set())
        object.__setattr__(self, "_row", row)

    @property
    def read(self) -> frozenset[str]:
        """The names read so far."""
        return frozenset(self._read)

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of every value."""
        return (_PROBES,) if self._row is None else ()

    def __getitem__(self, name: str) -> FloatArray:
        self._read.add(name)
        low, high = _PROBE_RANGES.get(name, (0.5, 1.5))
        if name in DEFAULT_AXES:
            low, high = DEFAULT_AXES[name].start, 0.5 * DEFAULT_AXES[name].stop
        digest = hashlib.sha256(name.encode()).digest()
        draw = np.random.default_rng(int.from_bytes(digest[:8], "little"))
        values = draw.uniform(low, high, _PROBES)
        return np.asarray(values if self._row is None else values[self._row])

    def __contains__(self, name: object) -> bool:
        return True

    def __iter__(self) -> Iterator[str]:
        return iter((*DEFAULT_AXES, *_PROBE_RANGES))


@dataclass(frozen=True, eq=False)
class FunctionModel:
    """A ship whose speed through water is a user's function of conditions.

    Attributes
    ----------
    function : ``f(conditions) -> speed through water [m/s]``, vectorised, at least 0.
    reads : What it was seen to read.
    top : Greatest speed [m/s], given or measured; None for an unbounded speed field.
    table : tuple of (TablePart, TableError), or None
        None for a speed field.
    """

    function: SpeedFunction
    reads: frozenset[str]
    top: float | None
    table: tuple[TablePart, TableError] | None

    @property
    def identity(self) -> Mapping[str, object]:
        """Data that distinguish this function from others: its values at fixed probes."""
        values = _evaluate(self.function, RecordingConditions())
        return {
            "kind": "function",
            "reads": sorted(self.reads),
            "answers": np.broadcast_to(values, (_PROBES,)).tolist(),
            "table": None if self.table is None else _digest(self.table[0].values),
        }

    @property
    def is_speed_field(self) -> bool:
        """Whether the speed depends on place, time or scalars instead of table axes."""
        return self.table is None

    @property
    def needs(self) -> frozenset[str]:
        """Sea variables needed; a field that reads depth needs the sea's own bed level."""
        extra = {BED_DEPTH} if self.is_speed_field and "depth" in self.reads else set()
        return needed_variables(self.reads) | extra

    def field(self, load_factor: float) -> Callable[..., FloatArray] | None:
        """Return ``f(sampled, time, lat, lon) -> speed [m/s]``, or None for a tabulated ship."""
        if not self.is_speed_field:
            return None

        def speed_field(
            sampled: Mapping[str, ArrayLike], time: ArrayLike, lat: ArrayLike, lon: ArrayLike
        ) -> FloatArray:
            conditions = Conditions.from_sea(
                sampled, time=time, lat=lat, lon=lon, load_factor=load_factor
            )
            return self.speed_through_water(conditions, 0)

        return speed_field

    def speeds(self, load_factor: float) -> FloatArray:
        """The one setting: the greatest speed [m/s]; NaN when it is unbounded."""
        return np.array([math.nan if self.top is None else self.top])

    def speed_through_water(self, conditions: Conditions, setting: ArrayLike) -> FloatArray:
        """Speed through water [m/s]."""
        index = setting_index(setting, 1)
        speed = _evaluate(self.function, conditions)
        shape = np.broadcast_shapes(conditions.shape, index.shape)
        unknown = np.zeros(shape, bool)
        for name in self.reads & set(conditions):
            unknown |= np.isnan(conditions[name])
        return np.where(unknown, np.nan, np.maximum(np.broadcast_to(speed, shape), 0.0))

    def power(self, conditions: Conditions, setting: ArrayLike) -> FloatArray:
        """Unknown: NaN."""
        index = setting_index(setting, 1)
        return np.full(np.broadcast_shapes(conditions.shape, index.shape), np.nan)

    def fuel_rate(self, conditions: Conditions, setting: ArrayLike) -> FloatArray:
        """Unknown: NaN."""
        return self.power(conditions, setting)

    def top_speed(self, setting: int, load_factor: float) -> float | None:
        """Greatest speed [m/s], None when unknown."""
        return self.top

    def tabulate(
        self, load_factor: float, tolerance: float
    ) -> tuple[tuple[TablePart, ...], TableError]:
        """One dense part over what the function reads.

        Raises
        ------
        InputError : For a speed field, which has no table.
        """
        if self.table is None:
            raise InputError(
                f"The speed function reads {', '.join(sorted(self.reads))}: it has no table.",
                "It is sampled in place and time instead (ship.speed_field).",
                "Read only conditions of a table: " + ", ".join(AXIS_OF_CONDITION) + ".",
            )
        part, error = self.table
        if error.p99 > tolerance or "load_factor" in self.reads:
            part, error = _tabulate(self.function, self.reads, load_factor, tolerance)
        return (part,), error

    def notes(self, conditions: Conditions, setting: ArrayLike) -> list[RangeNote]:
        """Return nothing: a function has no known ranges."""
        return []


def model_of_function(function: SpeedFunction, *, top_speed: float | None = None) -> FunctionModel:
    """Determine which conditions a speed function reads, and make a model of it.

    Parameters
    ----------
    function : ``f(conditions) -> speed through water [m/s]``.
    top_speed : Greatest speed it ever gives [m/s]; measured over the table when not given.

    Raises
    ------
    InputError : If it fails on plausible conditions, gives other than one speed per condition, or
        mixes place, time or plain variables with what depends on the heading.
    """
    if top_speed is not None and not 0.0 < top_speed < math.inf:
        raise InputError(
            f"The greatest speed is {top_speed:g} m/s.", "It is positive.", "Correct it."
        )
    recorder = RecordingConditions()
    try:
        _check_speed_values(np.asarray(function(recorder), float), recorder.shape)
        read_all = recorder.read
    except InputError:
        raise
    except (TypeError, ValueError) as problem:
        function, read_all = _elementwise(function, problem)
    reads = read_all - {"load_factor"}
    if reads <= AXIS_OF_CONDITION.keys():
        part, error = _tabulate(function, read_all, 1.0, 0.01)
        top = top_speed if top_speed is not None else _greatest_speed(function, read_all, part)
        return FunctionModel(function, read_all, top, (part, error))
    turning = reads & HEADING_DEPENDENT
    if turning:
        others = ", ".join(sorted(reads - AXIS_OF_CONDITION.keys() - turning))
        raise InputError(
            f"The speed function reads {', '.join(sorted(turning))}, which depends on the heading, "
            f"together with {others or 'no table axis'}.",
            f"It may read either only conditions of a table ({', '.join(AXIS_OF_CONDITION)}), "
            "or only what "
            "does not depend on the heading (place, time, currents, plain sea variables).",
            "Put what depends on place and time into the sea, and what depends on the heading into "
            "the ship.",
            reads=sorted(reads),
        )
    return FunctionModel(function, read_all, top_speed, None)


def _elementwise(
    function: SpeedFunction, problem: Exception
) -> tuple[SpeedFunction, frozenset[str]]:
    """Wrap a function of numbers, so that it takes arrays; also return what it reads."""
    recorders = [RecordingConditions(row) for row in range(_PROBES)]
    try:
        for recorder in recorders:
            _check_speed_values(np.asarray(function(recorder), float), ())
    except (TypeError, ValueError):
        raise InputError(
            f"The speed function fails on plausible conditions: {problem}.",
            "It gets one argument with attributes such as wave_height (arrays) and returns [m/s].",
            "Write it with NumPy functions, or for single numbers.",
        ) from problem
    reads = frozenset().union(*(recorder.read for recorder in recorders))
    names = sorted(reads)

    def elementwise(conditions: Conditions) -> ArrayLike:
        columns = [np.broadcast_to(conditions[n], conditions.shape).ravel() for n in names]
        if not columns:
            return float(np.asarray(function(conditions)))
        rows = (Conditions(dict(zip(names, row))) for row in zip(*columns))
        return np.reshape([float(np.asarray(function(row))) for row in rows], conditions.shape)

    elementwise.__name__ = getattr(function, "__name__", "function")
    return elementwise, reads


def _evaluate(function: SpeedFunction, conditions: Conditions) -> FloatArray:
    with np.errstate(all="ignore"):
        speed = np.asarray(function(conditions), float)
    _check_speed_values(speed, conditions.shape)
    return speed


def _check_speed_values(speed: FloatArray, shape: tuple[int, ...]) -> None:
    try:
        fits = np.broadcast_shapes(speed.shape, shape) == shape
    except ValueError:
        fits = False
    if not fits:
        raise InputError(
            f"The speed function gives shape {speed.shape} for conditions of shape {shape}.",
            "It gives one speed for each condition, or one number for all.",
            "Return an array of the conditions' shape.",
        )


def _tabulate(
    function: SpeedFunction, reads: frozenset[str], load_factor: float, tolerance: float
) -> tuple[TablePart, TableError]:
    names = sorted(reads & AXIS_OF_CONDITION.keys(), key=AXIS_OF_CONDITION.__getitem__)

    def speeds(where: Mapping[str, FloatArray]) -> FloatArray:
        whole = dict(zip(where, np.broadcast_arrays(*where.values())))
        conditions = Conditions(whole, load_factor=load_factor)
        speed = _evaluate(function, conditions)
        return np.maximum(np.broadcast_to(speed, conditions.shape), 0.0)[..., None]

    if not names:
        return constant_part(speeds({})), TableError(0.0, 0.0, 0.0, 0)
    return tabulate_dense(speeds, [DEFAULT_AXES[n] for n in names], tolerance=tolerance)


def _greatest_speed(function: SpeedFunction, reads: frozenset[str], part: TablePart) -> float:
    """Greatest speed over the table's nodes and random conditions between them [m/s]."""
    top = float(np.nanmax(part.values, initial=0.0))
    axes = [DEFAULT_AXES[n] for n in sorted(reads & AXIS_OF_CONDITION.keys())]
    if axes:
        draws: dict[str, Any] = random_conditions(axes, 20_000, 1)
        between_nodes = _evaluate(function, Conditions(draws, load_factor=1.0))
        top = max(top, float(np.nanmax(between_nodes, initial=0.0)))
    if not top > 0.0:
        raise InputError(
            "The speed function never gives a positive speed.",
            "It returns speed through water [m/s].",
            "Check its unit and its sign.",
        )
    if top > _GREATEST_SPEED:
        raise InputError(
            f"The speed function returns {top:g} m/s, which is {top / KNOT:.0f} kn.",
            f"Speeds through water are in metres a second, up to {_GREATEST_SPEED / KNOT:.0f} kn.",
            "Multiply knots by 0.514444.",
        )
    return top


def _digest(values: NDArray[Any]) -> str:
    return hashlib.sha256(np.ascontiguousarray(values).tobytes()).hexdigest()
