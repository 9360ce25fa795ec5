"""Coverage check: whether the data cover the end points of a voyage."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Sequence, Set
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from thalweg.chart import Chart
from thalweg.chart.coast.snapping import joined_positions
from thalweg.core.errors import InputError, NoRouteError, OutsideAreaError
from thalweg.core.geodesy import (
    distance,
    format_position,
    unwrap_longitude,
    wrap_longitude,
)
from thalweg.core.time import format_time
from thalweg.core.types import BoolArray, FloatArray
from thalweg.core.units import HOUR, NAUTICAL_MILE
from thalweg.kernels import codes
from thalweg.planning.request.requirements import Requirements
from thalweg.planning.request.voyage_endpoints import MAX_SNAP_PORT, Endpoint
from thalweg.planning.voyage import Voyage
from thalweg.sea import Sea, standard_names
from thalweg.sea.doubtful_values import doubts_of_files, guesses_of_files
from thalweg.sea.fill_policies import (
    MAX_NEAREST,
    filled_distance,
    is_calm_layer,
    nearest_fills,
)
from thalweg.ship import Ship

CHECK_YEAR: Final = "Check the year"  #: a note on a departure before 1900 begins so
UNREAD: Final = "Weather is not considered"  #: a note on data that a ship does not read begins so
_FIRST_USUAL: Final = -2_208_988_800.0  # 1900-01-01T00:00Z [s since 1970]
_DIRECTIONS = ("sea_surface_wave_to_direction_east", "sea_surface_wave_to_direction_north")
#: Period that is checked where the data have no end [s].
_MAX_PERIOD = 20 * 24 * HOUR
_SAMPLE_TIMES = 24
#: First part of a voyage in which wave data are judged for a warning [s].
_DOUBT_PERIOD = 3 * 24 * HOUR
_DOUBT_ROWS = 9  # rows and columns of positions judged
_NEARBY = 10_000.0  # half the side of the first grid of water [m]
_BLOCK = 1_000  # positions that are sampled together


def check_argument_types(voyage: object, ship: object, sea: object, chart: object) -> None:
    """Raise `InputError` when an argument of `plan` is not what it should be.

    Parameters
    ----------
    voyage, ship, sea, chart : object
        Arguments of `plan`; required are a `Voyage`, `Ship`, `Sea` and `Chart`.
    """
    check_ship_type(ship)
    wanted = {
        "voyage": (voyage, Voyage, "Voyage(start=..., goal=..., depart=...)"),
        "sea": (sea, Sea, "Sea.open(files), Sea.from_functions(...), Sea.storm() or Sea.calm()"),
        "chart": (chart, Chart, 'Chart.gshhg("i") or Chart.open_water(...)'),
    }
    for name, (value, kind, example) in wanted.items():
        _check_type(name, value, kind, example)


def check_ship_type(ship: object) -> None:
    """Raise `InputError` for a ship that is none, such as the name of one."""
    _check_type("ship", ship, Ship, "Ship.load(name or file) or Ship.simple(...)")


def _check_type(name: str, value: object, kind: type, example: str) -> None:
    if not isinstance(value, kind):
        raise InputError(
            f"The {name} is {value!r}, which is not a {kind.__name__}.",
            f"Make one with {example}.",
            f"Give a {kind.__name__}.",
            field=name,
        )


def endpoints_within_coverage(
    ends: Sequence[Endpoint],
    *,
    voyage: Voyage,
    ship: Ship,
    sea: Sea,
    chart: Chart,
    needs: Requirements,
) -> list[Endpoint]:
    """Return the end points; ports are moved to the nearest water that is covered and deep enough.

    Raises
    ------
    OutsideAreaError : If the data do not cover all required variables at an end point at any time.
    NoRouteError : If the water at an end point is too shallow at any tide.
    """
    coverage_probe = _CoverageProbe(voyage=voyage, ship=ship, sea=sea, chart=chart, needs=needs)
    return [_moved_into_coverage(end, coverage_probe, chart) for end in ends]


def doubts_of_voyage(
    voyage: Voyage, sea: Sea, ends: Sequence[Endpoint], needs: Requirements
) -> tuple[str, ...]:
    """Return warnings of the year, data not read, units and times not stated, and doubtful waves.

    Not read are data that the speed of the ship does not depend on, and of these it is said where
    they do not hold at the departure.

    Parameters
    ----------
    voyage, sea, ends : The request, its sea and its end points.
    needs : Required variables; there is no warning of data that are not needed.
    """
    wanted = {standard_names.CHANNEL_VARIABLES[channel] for channel in needs.channels}
    first = voyage.earliest_departure
    unread = (*_note_of_year(first), *_notes_of_unread(first, sea, wanted))
    unread += guesses_of_files(sea.layers, wanted)
    if not wanted.intersection((standard_names.WAVE_HEIGHT, *_DIRECTIONS)):
        return unread
    lat = np.array([end.lat for end in ends])
    lon = unwrap_longitude([end.lon for end in ends])
    rows = np.linspace(max(lat.min() - 1.0, -90.0), min(lat.max() + 1.0, 90.0), _DOUBT_ROWS)
    columns = np.linspace(lon.min() - 1.0, lon.max() + 1.0, _DOUBT_ROWS)
    y, x = np.meshgrid(rows, columns)
    times = np.linspace(first, min(needs.data_end, first + _DOUBT_PERIOD), 4)
    return (*unread, *doubts_of_files(sea.layers, times, y.ravel(), wrap_longitude(x.ravel())))


def _note_of_year(depart: float) -> tuple[str, ...]:
    """Return a note on a departure before `_FIRST_USUAL`, which is mostly a slip."""
    if depart >= _FIRST_USUAL:
        return ()
    return (f"{CHECK_YEAR}: the departure is at {format_time(depart)}, before 1900.",)


def _notes_of_unread(depart: float, sea: Sea, wanted: Set[str]) -> tuple[str, ...]:
    """Return a note where a sea has wind or waves and the speed of the ship depends on neither."""
    weather = {"wind": standard_names.EASTWARD_WIND, "waves": standard_names.WAVE_HEIGHT}
    data = [layer.variables for layer in sea.layers if not is_calm_layer(layer)]
    names = frozenset[str]().union(*data)  # of a calm sea all that counts is known
    given = {word: name for word, name in weather.items() if name in names}
    if not given or wanted & set(given.values()):
        return ()
    periods = [sea.period_of([name]) for name in given.values()]
    words = " and ".join(given)
    note = f"{UNREAD}: the data have {words}, and the speed of this ship does not depend on them."
    if not any(first <= depart <= last for first, last in periods):
        first, last = periods[0]
        note += (
            f" They hold from {format_time(first)} to {format_time(last)}, not at the departure."
        )
    return (note,)


class _CoverageProbe:
    """Samples the required variables at positions over the period of the voyage."""

    def __init__(
        self,
        *,
        voyage: Voyage,
        ship: Ship,
        sea: Sea,
        chart: Chart,
        needs: Requirements,
    ) -> None:
        channels = {standard_names.CHANNEL_VARIABLES[channel] for channel in needs.channels}
        self.names = sorted(
            (channels | set(ship.needs)) - set(_DIRECTIONS) - {standard_names.BED_DEPTH}
        )
        self.sea, self.chart = sea, chart
        self.depth = needs.limits.required_depth
        first = voyage.earliest_departure
        end = (
            needs.data_end
            if math.isfinite(needs.data_end)
            else voyage.latest_departure + _MAX_PERIOD
        )
        self.times = np.linspace(first, end, _SAMPLE_TIMES)

    def missing(self, lat: FloatArray, lon: FloatArray) -> list[str]:
        """Return the variables that are not known at a position at any time."""
        return self._lacking(lat, lon, np.any)

    def unknown_at_times(self, lat: FloatArray, lon: FloatArray) -> list[str]:
        """Return the variables, or "depth", that are not known at a position at all times."""
        return self._lacking(lat, lon, np.all)

    def _lacking(
        self, lat: FloatArray, lon: FloatArray, often: Callable[[BoolArray], np.bool_]
    ) -> list[str]:
        """Return the variables, or "depth", that are not known as often as required."""
        samples = self._sample(self.names, lat, lon)
        lacking = [name for name in self.names if not often(np.isfinite(samples[name]))]
        if math.isfinite(self.depth) and not often(np.isfinite(self._depths(lat, lon))):
            lacking.append("depth")
        return lacking

    def suits(self, lat: FloatArray, lon: FloatArray, *, harbour: bool) -> NDArray[np.bool_]:
        """Return where all is known at some time; for a harbour, at all times and deep enough."""
        good = np.ones(lat.shape, bool)
        often = np.all if harbour else np.any
        for values in self._sample(self.names, lat, lon).values():
            good &= often(np.isfinite(values), axis=0)
        if math.isfinite(self.depth):
            depths = self._depths(lat, lon)
            good &= depths >= self.depth if harbour else np.isfinite(depths)
        return good

    def check_deep_enough(self, end: Endpoint) -> None:
        """Raise `NoRouteError` if an end point is too shallow at any tide of the data."""
        if not math.isfinite(self.depth):
            return
        place = np.array([end.lat]), np.array([end.lon])
        depth, time = float(self._depths(*place)[0]), math.nan
        if standard_names.WATER_LEVEL in self.sea.variables:
            first, last = float(self.times[0]), float(self.times[-1])
            native = self.sea.times(first, last, names=[standard_names.WATER_LEVEL])
            native = native[(native >= first) & (native <= last)]
            native = np.append(native, self.times)  # formulas have no native times
            level = self.sea.sample([standard_names.WATER_LEVEL], native, end.lat, end.lon)
            values = level[standard_names.WATER_LEVEL]
            if not np.isfinite(values).any():
                return
            highest = int(np.nanargmax(values))
            depth, time = depth + float(values[highest]), float(native[highest])
        if depth < self.depth:
            raise _too_shallow_error(end, depth, time, self.depth)

    def _sample(self, wanted: list[str], lat: FloatArray, lon: FloatArray) -> dict[str, FloatArray]:
        return self.sea.sample(wanted, self.times[:, None], lat, lon) if wanted else {}

    def _depths(self, lat: FloatArray, lon: FloatArray) -> FloatArray:
        """Return the depth at chart datum [m]; NaN where unknown."""
        depths = np.full(lat.shape, math.nan)
        if self.chart.has_depth:
            depths = np.asarray(self.chart.depths.at(lat, lon), float)
        if standard_names.BED_DEPTH in self.sea.variables:
            bed = self._sample([standard_names.BED_DEPTH], lat, lon)[standard_names.BED_DEPTH]
            depths = np.fmin(depths, np.fmin.reduce(bed, axis=0))
        return depths


def _moved_into_coverage(end: Endpoint, coverage_probe: _CoverageProbe, chart: Chart) -> Endpoint:
    here = np.array([end.lat]), np.array([end.lon])
    if end.is_port and not coverage_probe.suits(*here, harbour=True)[0]:
        near = _nearest_suitable_water(end, coverage_probe, chart, harbour=True)
        if near is not None:
            return _moved_to(near, end, coverage_probe)
    lacking = coverage_probe.missing(*here)
    if not lacking:
        coverage_probe.check_deep_enough(end)
        return end
    raise OutsideAreaError(
        f"{end.name} is outside the data: {', '.join(lacking)} "
        f"{'is' if len(lacking) == 1 else 'are'} not known there.",
        _coverage_hint(
            _nearest_suitable_water(end, coverage_probe, chart, harbour=False),
            coverage_probe,
            lacking,
        ),
        _swap_into_data(end, coverage_probe)
        or "Choose a place inside, or add data that cover this one.",
        lacking=lacking,
    )


def _swap_into_data(end: Endpoint, coverage_probe: _CoverageProbe) -> str:
    """Return a hint where the data cover the position with its degrees swapped; else empty."""
    lat, lon = end.given_position or (end.lat, end.lon)
    if end.is_port or abs(lon) > 90.0 or coverage_probe.missing(np.array([lon]), np.array([lat])):
        return ""
    return (
        f"Latitude comes first: {lon:g}, {lat:g} is {format_position(lon, lat)}, inside the data. "
        "Are latitude and longitude swapped?"
    )


def _moved_to(
    near: tuple[float, float, float], end: Endpoint, coverage_probe: _CoverageProbe
) -> Endpoint:
    """Return a port moved to water that suits, with the reason and the remedy."""
    here = np.array([end.lat]), np.array([end.lon])
    unknown, approach = coverage_probe.unknown_at_times(*here), end.approach
    why = f"in water without data of {', '.join(unknown)}" if unknown else "in too shallow water"
    berth = end.origin if approach is None else approach.berth
    far = float(distance(*berth, *near[:2]))
    return replace(
        end,
        lat=near[0],
        lon=near[1],
        moved_distance_m=far,
        why=why,
        remedy=_remedy(unknown, far + filled_distance(coverage_probe.sea.layers)),
        approach=None,
        other_ways=(),
        given_position=berth,
        way_left_m=near[2] + (0.0 if approach is None else approach.length),
    )


def _remedy(unknown: Sequence[str], far: float) -> str:
    """Return what a user can do so that a port [m] from data is reached, a sentence."""
    if not unknown:
        return "To reach it, load less or require less clearance under the keel."
    miles = min(MAX_NEAREST, 10.0 * math.ceil(far / NAUTICAL_MILE / 10.0 + 0.5))
    fills = nearest_fills(unknown, miles)
    if not fills:
        return "To reach it, add data that cover it."
    in_python = ", ".join(fill.replace("=", "='") + "'" for fill in fills)
    in_request = json.dumps(dict(fill.split("=") for fill in fills), allow_nan=False)
    return (
        "To reach it, add data that cover it, or fill the unknown values from the nearest known "
        f"ones: --fill {' '.join(fills)} (in Python sea.filled({in_python}), in requests of the "
        f'service and project files "fill": {in_request}).'
    )


def _too_shallow_error(end: Endpoint, depth: float, time: float, required: float) -> NoRouteError:
    dry = "is dry" if depth <= 0.0 else f"has at most {depth:.2f} m of water"
    when = "" if math.isnan(time) else f", at its highest tide at {format_time(time)}"
    return NoRouteError(
        f"{end.name} {dry}{when}.",
        f"{required:.2f} m are required: {required - depth:.2f} m too little at any tide of the "
        "data.",
        "Choose a place in deeper water, load less, or require less clearance.",
        reasons={codes.REASONS[codes.DEPTH]: 1},
        nearest=(end.lat, end.lon),
        missing_m=required - depth,
    )


def _nearest_suitable_water(
    end: Endpoint, coverage_probe: _CoverageProbe, chart: Chart, *, harbour: bool
) -> tuple[float, float, float] | None:
    """Return the nearest water that suits and that legs join to an end: lat, lon [deg], [m]."""
    lat, lon = np.array([end.lat]), np.array([end.lon])
    for half in (_NEARBY, MAX_SNAP_PORT):
        apart = distance(end.lat, end.lon, lat, lon)
        far = int(np.argmax(apart))  # out of a narrow river, for the coarser grid
        lat, lon = joined_positions(
            float(lat[far]), float(lon[far]), half,
            is_navigable=chart.is_navigable, legs_blocked=chart.legs_blocked,
        )  # fmt: skip
        if not lat.size:
            return None
        apart = distance(*end.origin, lat, lon)
        order = np.argsort(apart, kind="stable")
        for first in range(0, order.size, _BLOCK):
            some = order[first : first + _BLOCK]
            good = some[coverage_probe.suits(lat[some], lon[some], harbour=harbour)]
            if good.size and apart[good[0]] <= MAX_SNAP_PORT:
                k = int(good[0])
                return float(lat[k]), float(wrap_longitude(lon[k])), float(apart[k])
    return None


def _coverage_hint(
    near: tuple[float, float, float] | None, coverage_probe: _CoverageProbe, lacking: list[str]
) -> str:
    if near is not None:
        return (
            f"The nearest covered water is {near[2] / NAUTICAL_MILE:.1f} nm away, at "
            f"{format_position(near[0], near[1])}."
        )
    rows = [row for row in coverage_probe.sea.coverage() if row.variable in lacking]
    rows = [row for row in rows if row.north - row.south < 180.0]
    if not rows:
        return f"The data cover no water within {MAX_SNAP_PORT / NAUTICAL_MILE:.0f} nm."
    south, north = min(row.south for row in rows), max(row.north for row in rows)
    west, east = min(row.west for row in rows), max(row.east for row in rows)
    return (
        f"The data are between {format_position(south, west)} and {format_position(north, east)}, "
        "perhaps with gaps."
    )
