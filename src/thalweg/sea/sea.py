"""`Sea`: wind, waves, currents, level and depth, from any number of sources, as one thing."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.errors import InputError, unknown_name
from thalweg.core.time import TimeLike, parse_time
from thalweg.sea import freeze, functions, storm
from thalweg.sea import names as nm
from thalweg.sea.fields import WORLD, Area, Coverage, FloatArray, GridFields, Mesh, StationFields
from thalweg.sea.layer import Layer, Samples

CALM_PERIOD = 8.0  #: [s] placeholder peak period of waves of height zero
CALM = {
    nm.EASTWARD_WIND: 0.0,
    nm.NORTHWARD_WIND: 0.0,
    nm.EASTWARD_CURRENT: 0.0,
    nm.NORTHWARD_CURRENT: 0.0,
    nm.WAVE_HEIGHT: 0.0,
    nm.WAVE_TO_EAST: 0.0,
    nm.WAVE_TO_NORTH: 1.0,
    nm.WAVE_PERIOD: CALM_PERIOD,
}
FILLABLE: dict[str, tuple[str, ...]] = {
    "currents": nm.CURRENT.pair,
    "wind": nm.WIND.pair,
    "waves": (nm.WAVE_HEIGHT, *nm.WAVES.pair, nm.WAVE_PERIOD),
    "water_level": (nm.WATER_LEVEL,),
    "ice": (nm.ICE,),
}


@dataclass(frozen=True)
class Sea:
    """Met-ocean fields from layers by priority; never changed, never guessed.

    Make one with `Sea.open`, `Sea.from_functions`, `Sea.storm` or `Sea.calm`; put one over another
    with ``+`` (the left one first). For each variable the first layer that knows a value wins; both
    components of a vector come from the same layer. What no layer knows is NaN.

    Attributes
    ----------
    layers : tuple of Layer
        Sources, first one first.
    assumptions : tuple of str
        What was assumed on the user's word (see `filled`).
    """

    layers: tuple[Layer, ...]
    assumptions: tuple[str, ...] = ()

    @classmethod
    def from_functions(
        cls,
        functions_by_name: Mapping[str, functions.FieldFunction],
        *,
        time_step: float | None = None,
        area: tuple[float, float, float, float] | None = None,
        period: tuple[TimeLike, TimeLike] | None = None,
    ) -> Sea:
        """Return a sea given by formulas.

        Parameters
        ----------
        functions_by_name : mapping of str to callable
            ``f(time_s, lat, lon) -> array``: seconds since 1970-01-01T00:00Z and degrees, as
            float64 arrays of one shape; the answer has that shape or is one number, in SI units,
            NaN where unknown. Names are CF standard names: components
            (``eastward_sea_water_velocity``, ...), or speed and direction [deg]
            (``wind_speed`` + ``wind_from_direction``; ``sea_water_speed`` +
            ``sea_water_velocity_to_direction``), ``sea_surface_wave_from_direction`` or
            ``..._to_direction``, any ``sea_floor_depth_below_...`` and
            ``sea_surface_height_above_...``. The depth below the *moving* surface
            (``sea_floor_depth_below_sea_surface``) is turned into depth below datum by subtracting
            the water level, if that is given too. Other names are kept as plain variables.
        time_step : float, optional
            Step [s] at which kernels get the formulas (linear between); 0 for fields that never
            change. By default ``min(600 s, window / 200)``, at most 2000 steps.
        area : tuple of float, optional
            (south, north, west, east) [deg] outside which nothing is known.
        period : tuple of time, optional
            (start, end) outside which nothing is known.

        Returns
        -------
        Sea

        Raises
        ------
        InputError
            If one half of a vector is missing, a variable is given twice, or (when sampled) a
            function returns something of another shape.
        """
        layer = functions.layer_of_functions(
            dict(functions_by_name),
            area=_area(area),
            period=_period(period),
            time_step=_step(time_step),
        )
        return cls((layer,))

    @classmethod
    def calm(cls) -> Sea:
        """Return a sea without wind, waves and currents, everywhere and always.

        Waves of height zero travel north with a placeholder peak period of 8 s, so that models
        which look at angle and period can be asked; it knows no water level and no depth.
        """
        return cls(
            (functions.constant_layer(CALM, "calm"),), ("no wind, waves and currents anywhere",)
        )

    @classmethod
    def storm(
        cls,
        name: str = storm.DEFAULT_STORM,
        *,
        start: TimeLike | None = None,
        ambient: storm.Ambient | None = None,
        time_step: float = storm.TIME_STEP,
    ) -> Sea:
        """Return wind and waves of a real cyclone, **modelled** from its best track.

        The track (6-hourly positions, winds and pressures of Hurricane Danielle, 24 August to
        8 September 1998, which ran along the lane between New York and the English Channel) is
        observed; the fields are not: Holland (1980) gradient wind with radius of maximum wind by
        Willoughby et al. (2006), brought to a 10-min mean at 10 m, turned by Bretschneider's
        inflow angle, asymmetric by Lin and Chavas (2012); waves by the equivalent fetch of Young
        and Vinoth (2013), scaled with the local wind and travelling with it. Beyond 1200 km lies a
        uniform ambient sea. There are no currents and no land: for demonstrations and tests, not
        for navigation.

        Parameters
        ----------
        name : str
            Name of an embedded storm.
        start : time, optional
            When the track shall begin; its true dates by default. Outside the life of the track
            nothing is known.
        ambient : Ambient, optional
            The sea around; by default 5.2 m/s of wind and 1.5 m of waves from the west.
        time_step : float, optional
            Step [s] at which kernels get the storm, one hour by default.
        """
        layer = storm.storm_layer(name, start=start, ambient=ambient, time_step=time_step)
        return cls((layer,))

    @classmethod
    def layered(cls, *seas: Sea) -> Sea:
        """Return one sea from several, the first one first."""
        layers = tuple(layer for sea in seas for layer in sea.layers)
        return cls(layers, tuple(dict.fromkeys(a for sea in seas for a in sea.assumptions)))

    def __add__(self, other: Sea) -> Sea:
        return Sea.layered(self, other) if isinstance(other, Sea) else NotImplemented

    def filled(self, **policies: float | tuple[float, float]) -> Sea:
        """Return a sea in which what is unknown takes a named value, on the user's word.

        Parameters
        ----------
        **policies
            ``currents`` and ``wind``: 0.0 or (east, north) [m/s]; ``waves``: significant height
            [m] (0.0, or a height with direction north and period 8 s); ``water_level`` [m];
            ``ice`` [fraction]. The value holds wherever and whenever no layer knows better.

        Returns
        -------
        Sea
            With one more layer of lowest priority; each policy is told in ``assumptions``.
        """
        values: dict[str, float] = {}
        told: list[str] = []
        for policy, value in policies.items():
            values.update(_policy_values(policy, value))
            told.append(f"where unknown, {policy.replace('_', ' ')} = {value}")
        layer = functions.constant_layer(values, "filled")
        return Sea((*self.layers, layer), (*self.assumptions, *told))

    @property
    def variables(self) -> frozenset[str]:
        """Canonical names of everything some layer holds (vectors as components)."""
        return frozenset().union(*(layer.variables for layer in self.layers))

    def knows(self, name: str) -> bool:
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
        """
        names = [names] if isinstance(names, str) else names
        arrays = np.broadcast_arrays(*(np.asarray(a, np.float64) for a in (time, lat, lon)))
        shape = arrays[0].shape
        flat = [np.ascontiguousarray(a).reshape(-1) for a in arrays]
        base = self._merge(
            self._base(names), _point_reader(flat[0], flat[1], flat[2]), flat[0].shape
        )
        return {name: self._derive(name, base).reshape(shape) for name in names}

    def series(
        self, names: Sequence[str], times: FloatArray, lat: FloatArray, lon: FloatArray
    ) -> dict[str, FloatArray]:
        """Return values (S, T) at stations (S,) for every time (T,); faster than `sample`."""
        read = _series_reader(times, lat, lon)
        base = self._merge(self._base(names), read, (lat.size, times.size))
        return {name: self._derive(name, base) for name in names}

    def why_missing(self, name: str, time: float, lat: float, lon: float) -> str:
        """Return why a value is NaN: "variable", "area", "period" or "gap" (a hole in the data)."""
        holders = [x for x in self.layers if set(self._sources(name)) & x.variables]
        if not holders or not self.knows(name):
            return "variable"
        point = np.array([lat], float), np.array([lon], float)
        holders = [x for x in holders if x.area.covers(*point)[0]]
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
            found += [_edges(x.period, start, end) for x in layers if x.period is not None]
        if not any(f.size for f in found):
            return np.empty(0)
        times: FloatArray = np.unique(np.concatenate(found).round(3)).astype(np.float64)
        return times if times.size > 1 else np.append(times, times + 1.0)

    def freeze_stations(
        self,
        lat: ArrayLike,
        lon: ArrayLike,
        start: float,
        end: float,
        channels: Sequence[int],
        *,
        extra: Mapping[int, freeze.Extra] | None = None,
    ) -> StationFields:
        """Return the sea at stations for kernels.

        Parameters
        ----------
        lat, lon : array_like (S,)
            Stations [deg].
        start, end : float
            Window [s since epoch]; frozen times reach one native step beyond it.
        channels : sequence of int
            Channels of `thalweg.kernels.codes`; those the sea lacks get index -1.
        extra : mapping of int to callable, optional
            Channels computed as ``f(sampled, time, lat, lon) -> array``, where ``sampled`` maps
            any variable of the sea to its values and all arrays are (stations, times).

        Raises
        ------
        OutsidePeriodError
            If no data reach into the window.
        """
        return freeze.freeze_stations(
            self,
            np.asarray(lat, np.float64),
            np.asarray(lon, np.float64),
            window=(float(start), float(end)),
            channels=channels,
            extra=extra or {},
        )

    def freeze_grid(
        self,
        south: float,
        north: float,
        west: float,
        east: float,
        start: float,
        end: float,
        channels: Sequence[int],
        *,
        spacing_deg: float,
        extra: Mapping[int, freeze.Extra] | None = None,
    ) -> GridFields:
        """Return the sea on a regular raster for kernels; arguments as in `freeze_stations`.

        The spacing [deg] is fitted down so that the raster ends on the box; ``east < west`` spans
        the antimeridian.
        """
        return freeze.freeze_grid(
            self,
            (float(south), float(north), float(west), float(east)),
            window=(float(start), float(end)),
            channels=channels,
            spacing_deg=float(spacing_deg),
            extra=extra or {},
        )

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
        name = nm.canonical(name)
        derived = nm.components_for(name)
        if derived is None or (name in self.variables and derived[0].east not in self.variables):
            return (name,)
        return derived[0].pair

    def _base(self, names: Sequence[str]) -> list[str]:
        """Return all variables that must be read, vectors complete."""
        wanted = [s for name in names for s in self._sources(name)]
        whole = [part for name in wanted for part in nm.group_of(name)]
        return list(dict.fromkeys(whole))

    def _derive(self, name: str, base: Samples) -> FloatArray:
        kept = nm.canonical(name)
        if kept in base:
            return base[kept]
        vector, part = nm.components_for(kept) or (nm.WIND, "speed")
        east, north = base[vector.east], base[vector.north]
        if part == "speed":
            return np.asarray(np.hypot(east, north), np.float64)
        sign = 1.0 if part == "towards" else -1.0
        return np.degrees(np.arctan2(sign * east, sign * north)) % 360.0

    def _merge(self, names: Sequence[str], read: Reader, shape: tuple[int, ...]) -> Samples:
        """Read the variables layer by layer, each layer only where those before knew nothing."""
        merged: Samples = {}
        for layer in self.layers:
            have = [n for n in names if n in layer.variables]
            rows = _pending(have, merged)
            if have and (rows is None or rows.size):
                _take(merged, read(layer, have, rows), rows)
        for name in names:
            merged.setdefault(name, np.full(shape, np.nan))
        return merged


Reader = Callable[[Layer, Sequence[str], Any], Samples]


def _point_reader(time: FloatArray, lat: FloatArray, lon: FloatArray) -> Reader:
    def read(layer: Layer, names: Sequence[str], rows: Any) -> Samples:
        pick = slice(None) if rows is None else rows
        return layer.sample(names, time[pick], lat[pick], lon[pick])

    return read


def _series_reader(times: FloatArray, lat: FloatArray, lon: FloatArray) -> Reader:
    def read(layer: Layer, names: Sequence[str], rows: Any) -> Samples:
        pick = slice(None) if rows is None else rows
        return layer.series(names, times, lat[pick], lon[pick])

    return read


def _pending(names: Sequence[str], merged: Samples) -> Any:
    """Return the rows where some of the variables are still unknown; None for all rows."""
    if not names or any(name not in merged for name in names):
        return None
    unknown = np.zeros(merged[names[0]].shape, bool)
    for name in names:
        unknown |= np.isnan(merged[name])
    return np.flatnonzero(unknown if unknown.ndim == 1 else unknown.any(axis=1))


def _take(merged: Samples, found: Samples, rows: Any) -> None:
    """Put what was found where nothing was known; vectors go as pairs, being NaN as pairs."""
    for name, value in found.items():
        if name not in merged:
            merged[name] = value
            continue
        pick = slice(None) if rows is None else rows
        old = merged[name] = np.array(merged[name])
        old[pick] = np.where(np.isnan(old[pick]), value, old[pick])


def _edges(period: tuple[float, float] | None, start: float, end: float) -> FloatArray:
    """Return times just outside a layer's period, where another layer takes over."""
    if period is None:
        return np.empty(0)
    edges = np.array([period[0] - 1.0, period[1] + 1.0])
    return edges[(edges > start) & (edges < end)]


def _policy_values(policy: str, value: float | tuple[float, float]) -> dict[str, float]:
    if policy not in FILLABLE:
        raise unknown_name("filling policy", policy, FILLABLE)
    names = FILLABLE[policy]
    numbers = np.atleast_1d(np.asarray(value, float))
    is_pair = numbers.size == 2 and len(names) == 2
    if not np.isfinite(numbers).all() or not (is_pair or numbers.size == 1):
        raise InputError(
            f"{policy} cannot be filled with {value!r}.",
            "Give one finite number, or (east, north) for currents and wind.",
            f"For example filled({policy}=0.0).",
        )
    if is_pair:
        return dict(zip(names, numbers.tolist()))
    number = float(numbers[0])
    if len(names) == 2 and number != 0.0:
        raise InputError(
            f"{policy}={number:g} has no direction.",
            f"{policy} can be 0.0 or (east, north) in m/s.",
            f"For example filled({policy}=({number:g}, 0.0)).",
        )
    if policy == "waves":
        return {**{n: CALM[n] for n in names}, nm.WAVE_HEIGHT: number}
    return dict.fromkeys(names, number)


def _area(area: tuple[float, float, float, float] | None) -> Area:
    if area is None:
        return WORLD
    south, north, west, east = (float(x) for x in area)
    if not (-90.0 <= south < north <= 90.0):
        raise InputError(
            f"The area {area} has no height.",
            "An area is (south, north, west, east) in degrees with south < north.",
            "Check the order of the four numbers.",
        )
    return Area(south, north, west, east if east > west else east + 360.0)


def _period(period: tuple[TimeLike, TimeLike] | None) -> tuple[float, float] | None:
    if period is None:
        return None
    start, end = parse_time(period[0]), parse_time(period[1])
    if end < start:
        raise InputError(
            "The period ends before it starts.", "A period is (start, end).", "Swap the two times."
        )
    return start, end


def _step(time_step: float | None) -> float | None:
    if time_step is not None and not (np.isfinite(time_step) and time_step >= 0.0):
        raise InputError(
            f"A time step of {time_step!r} s cannot be used.",
            "It must be positive, or 0 for fields that never change.",
            "Leave it out to have one chosen.",
        )
    return None if time_step is None else float(time_step)
