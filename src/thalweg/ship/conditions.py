"""`Conditions`: wind, waves, current and depth at a ship, as arrays in SI."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.errors import InputError, close_matches
from thalweg.core.types import FloatArray
from thalweg.ship.condition_variables import (
    BED_DEPTH,
    EASTWARD_CURRENT,
    EASTWARD_WIND,
    NORTHWARD_CURRENT,
    NORTHWARD_WIND,
    WATER_LEVEL,
    WAVE_EAST,
    WAVE_FROM,
    WAVE_HEIGHT,
    WAVE_NORTH,
    WAVE_PERIOD,
    WAVE_TO,
)
from thalweg.ship.methods.relative_angles import relative_angle, relative_wind_from_vectors


class Conditions(Mapping[str, FloatArray]):
    """A frozen set of arrays that broadcast together, read by attribute or by key.

    Parameters
    ----------
    values : mapping of str to array_like, optional
        Conditions by name; for names that are not Python identifiers.
    **more : array_like
        Conditions by name.

    Notes
    -----
    The names ship models know, all SI: ``lat``, ``lon`` [deg], ``time`` [s since 1970-01-01Z],
    ``heading`` [rad from north], ``wind_speed`` [m/s] at 10 m relative to the moving water and
    ``wind_angle`` [rad] between the heading and where that wind comes from (0 head, pi following),
    ``wave_height`` (significant) [m], ``wave_angle`` [rad, as ``wind_angle``], ``wave_period``
    (peak) [s], ``depth`` of the water [m], ``current_east``, ``current_north`` [m/s towards],
    ``load_factor`` [0 empty to 1 full]. Other names are plain sea variables. NaN is unknown.

    Examples
    --------
    >>> c = Conditions(wind_speed=[0.0, 12.0], wind_angle=0.0)
    >>> c.shape
    (2,)
    >>> float(c.wind_speed[1])
    12.0
    """

    __slots__ = ("_shape", "_values")
    _shape: tuple[int, ...]
    _values: dict[str, FloatArray]

    def __init__(self, values: Mapping[str, ArrayLike] | None = None, /, **more: ArrayLike) -> None:
        arrays = {
            name: _read_only(name, value) for name, value in {**(values or {}), **more}.items()
        }
        try:
            shape = np.broadcast_shapes(*(array.shape for array in arrays.values()))
        except ValueError:
            shapes = ", ".join(f"{name} {array.shape}" for name, array in arrays.items())
            raise InputError(
                f"The conditions do not broadcast together: {shapes}.",
                "Arrays must have the same shape, or shapes that NumPy stretches to one.",
                "Give arrays of one length, or numbers.",
            ) from None
        object.__setattr__(self, "_values", arrays)
        object.__setattr__(self, "_shape", shape)

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape all conditions broadcast to."""
        return self._shape

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"conditions are frozen: use with_values({name}=...)")

    def __getattr__(self, name: str) -> FloatArray:
        if name.startswith("_"):
            raise AttributeError(name)
        return self[name]

    def __getitem__(self, name: str) -> FloatArray:
        try:
            return self._values[name]
        except KeyError:
            raise self._missing(name) from None

    def __contains__(self, name: object) -> bool:
        return name in self._values

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __repr__(self) -> str:
        return f"Conditions({', '.join(self._values)}; shape {self._shape})"

    def get(self, name: str, default: Any = None) -> Any:
        """Return a condition, or a default if it is not there.

        Parameters
        ----------
        name : str
            Name of the condition.
        default : optional
            What is returned in its place.

        Returns
        -------
        float64 array
            In SI units, or the default.
        """
        return self._values.get(name, default)

    def with_values(self, **more: ArrayLike) -> Conditions:
        """Return conditions with some values added or replaced.

        Parameters
        ----------
        **more : array_like
            Values by name, in SI units.

        Returns
        -------
        Conditions
            Otherwise unchanged.
        """
        return Conditions({**self._values, **more})

    def with_default(self, **defaults: ArrayLike) -> Conditions:
        """Return conditions with values added for names that are not there yet.

        Parameters
        ----------
        **defaults : array_like
            Values by name, in SI units.

        Returns
        -------
        Conditions
            Values that were there are kept.
        """
        new = {name: value for name, value in defaults.items() if name not in self}
        return self.with_values(**new) if new else self

    def _missing(self, name: str) -> InputError:
        near = close_matches(name, self._values)
        hint = f" Did you mean {' or '.join(repr(n) for n in near)}?" if near else ""
        return InputError(
            f"The ship model reads {name!r}, which is not among the conditions.",
            f"There are: {', '.join(sorted(self._values)) or 'none'}.",
            f"Supply {name!r}, or use a model that does without it.{hint}",
            value=name,
        )

    @classmethod
    def from_sea(
        cls,
        sampled: Mapping[str, ArrayLike],
        *,
        heading: ArrayLike | None = None,
        **more: ArrayLike,
    ) -> Conditions:
        """Make conditions from sampled sea variables.

        Parameters
        ----------
        sampled : mapping of str to array_like
            Sea variables by CF standard name, SI, NaN where unknown; all are also stored under
            their own names.
        heading : array_like, optional
            Heading of the ship [rad from north]; without it there are no relative angles.
        **more : array_like
            Further conditions (``lat``, ``lon``, ``time``, ``depth``, ...), which win.

        Returns
        -------
        Conditions
            Without currents among the variables the wind relative to the water is the wind.
        """
        raw = {name: np.asarray(value, float) for name, value in sampled.items()}
        derived: dict[str, ArrayLike] = {**_currents(raw), **_wind(raw, heading)}
        derived |= {**_waves(raw, heading), **_depth(raw)}
        if heading is not None:
            derived["heading"] = heading
        return cls({**raw, **derived, **more})


def _read_only(name: str, value: ArrayLike) -> FloatArray:
    try:
        array = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        raise InputError(
            f"The condition {name!r} is not made of numbers.",
            "Numbers and arrays of numbers in SI units are possible.",
            "Give a number or an array.",
        ) from None
    view = array.view()
    view.flags.writeable = False
    return view


def _currents(raw: Mapping[str, FloatArray]) -> dict[str, ArrayLike]:
    pairs = (("current_east", EASTWARD_CURRENT), ("current_north", NORTHWARD_CURRENT))
    return {name: raw[source] for name, source in pairs if source in raw}


def _wind(raw: Mapping[str, FloatArray], heading: ArrayLike | None) -> dict[str, ArrayLike]:
    if EASTWARD_WIND not in raw or NORTHWARD_WIND not in raw:
        return {}
    still = np.zeros(())
    speed, angle = relative_wind_from_vectors(
        raw[EASTWARD_WIND],
        raw[NORTHWARD_WIND],
        frame_east=raw.get(EASTWARD_CURRENT, still),
        frame_north=raw.get(NORTHWARD_CURRENT, still),
        heading=still if heading is None else heading,
    )
    return {"wind_speed": speed} if heading is None else {"wind_speed": speed, "wind_angle": angle}


def _waves(raw: Mapping[str, FloatArray], heading: ArrayLike | None) -> dict[str, ArrayLike]:
    waves: dict[str, ArrayLike] = {}
    if WAVE_HEIGHT in raw:
        waves["wave_height"] = raw[WAVE_HEIGHT]
    if WAVE_PERIOD in raw:
        waves["wave_period"] = raw[WAVE_PERIOD]
    if heading is None:
        return waves
    if WAVE_EAST in raw and WAVE_NORTH in raw:
        waves["wave_angle"] = relative_angle(-raw[WAVE_EAST], -raw[WAVE_NORTH], heading)
    elif WAVE_FROM in raw or WAVE_TO in raw:
        degrees = raw[WAVE_FROM] if WAVE_FROM in raw else raw[WAVE_TO] + 180.0
        angle = np.radians(degrees)
        waves["wave_angle"] = relative_angle(np.sin(angle), np.cos(angle), heading)
    return waves


def _depth(raw: Mapping[str, FloatArray]) -> dict[str, ArrayLike]:
    if BED_DEPTH not in raw or "depth" in raw:
        return {}
    return {"depth": raw[BED_DEPTH] + raw.get(WATER_LEVEL, np.zeros(()))}
