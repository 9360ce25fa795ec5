"""The referee: evaluates any track in small steps with the formulas of the ship.

It uses no tables, no network and no frozen fields; its time, distance, fuel and clearance are the
published results. Every route states the numerical error of its time.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import InputError
from thalweg.core.geodesy import format_position_minutes
from thalweg.core.given_numbers import is_number, shortened_repr
from thalweg.core.time import TimeLike, parse_time
from thalweg.core.types import FloatArray
from thalweg.core.units import KNOT, NAUTICAL_MILE
from thalweg.kernels import codes
from thalweg.route.referee.adaptive_sailing import sail_to_tolerance
from thalweg.route.referee.leg_segments import cut_into_pieces
from thalweg.route.referee.limit_checks import coverage_error, is_data_gap
from thalweg.route.referee.route_assembly import assemble_route
from thalweg.route.referee.sailing import data_spacings
from thalweg.route.referee.sailing_physics import SailingEnvironment, make_sailing_environment
from thalweg.route.referee.wind_speed_only import with_wind_speed
from thalweg.route.route import ORDERED_TOO_FAST, Route, Violation
from thalweg.route.stated_times import stated_time_notes
from thalweg.route.track import Track
from thalweg.ship.fuel_prices import FuelTerms

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.sea import Sea
    from thalweg.ship import Ship

RouteLike: TypeAlias = "Track | Route | str | Path | Iterable[Sequence[float]]"

MIN_PIECES = 8  #: of every leg
MAX_STEP = 0.5 * NAUTICAL_MILE  #: [m]
MAX_PIECES = 2000  #: of a route at the coarser of its two step sizes (`MIN_PIECES` come first)
_SPEED_TOLERANCE = 1e-6  # relative, for speeds that went through a file
#: What rounding in a file changes: waves and wind as a share of the limit, the clearance [m].
_WEATHER_ROUNDING, _CLEARANCE_ROUNDING = 1e-3, 5e-3
_WEATHER = {codes.REASONS[codes.WAVE_HEIGHT], codes.REASONS[codes.WIND_SPEED]}
_CLEARANCE = codes.REASONS[codes.DEPTH]
_FILE_ROUNDING = 1e-4  # relative, by which files may round a speed above the greatest of the ship


def evaluate(
    route: RouteLike,
    *,
    ship: Ship,
    sea: Sea,
    chart: Chart | None = None,
    depart: TimeLike | None = None,
    min_ukc: float | None = None,
    step: float | None = None,
    load_factor: float | None = None,
    speed_kn: float | None = None,
    strict: bool = True,
    terms: FuelTerms | None = None,
) -> Route:
    r"""Sail a route in small steps with the formulas of the ship, and check every limit.

    Parameters
    ----------
    route : Track, Route, path, or iterable of (lat, lon)
        Legs are geodesics of WGS 84. Files are those of `thalweg.route.read_track`.
    ship : Ship
    sea : Sea
    chart : Chart, optional
        Land, zones and charted depth; without one they are not checked, and the
        route states this assumption.
    depart : time, optional
        Departure; required unless the track or the file gives it.
    min_ukc : float, optional
        Least under-keel clearance [m], checked where the chart or the sea gives a depth; by default
        that of the ship file, 0 if it gives none.
    step : float, optional
        Length of a piece [m]. By default the least of an eighth of the leg, half a nautical mile
        and a quarter of the spacing of the data, but not below 1/2000 of the route.
    load_factor : float, optional
        0 empty to 1 full; by default as the ship is loaded.
    speed_kn : float, optional
        Ordered calm-water speed on every leg [kn]; by default the track's own speeds and settings,
        those given in a file, and the highest of the ship for positions and other files.
    strict : bool
        Raise if the data end before the route does. Otherwise this is a violation and the totals
        are NaN.
    terms : FuelTerms, optional
        Prices of fuel and time; by default those of the ship file. Without them the cost is
        unknown.

    Returns
    -------
    Route

    Raises
    ------
    CoverageError
        If strict and a required variable is not known somewhere along the route.
    MissingVariableError
        If the ship needs a variable that the sea does not have.
    InputError
        If the route cannot be read, there is no departure, or a setting does not exist.

    Notes
    -----
    The time of passage T along the distance s solves

    .. math:: \frac{dT}{ds} = \frac{1}{SOG(s, T)}

    by the two-stage Gauss method (order 4 in smooth fields, 2 across the kinks of gridded data),
    first with pieces of ``step``, then of half that. The second solution is the result; the
    difference is its ``tolerance_s``, with what jumps of the speed between two points can add.
    Without ``step``, pieces with jumps of the speed and those where it comes near zero are split
    further until the error is at most 1e-5 of the time. Limits are checked at up to 10,000 further
    points, and where one may be exceeded between two of them, at parts of 1/512 of that interval;
    for a route that waits for the tide, the longest time between two points is part of the
    tolerance. Wind is relative to the moving water; angles of wind and
    waves are from the heading. A waiting ship burns the fuel of its hotel load and does not drift
    (it is at anchor); only its clearance is checked, and not at the first waypoint, where the ship
    is at its berth. If the sea has no current variables, still water is assumed, and the route
    states this.

    Positions, times and speeds of a file are rounded: waves and wind up to 0.1 % above a limit and
    a clearance up to 5 mm below the required one are no violations of a route from a file.

    A leg that orders a speed above the greatest of the ship (that of its largest power, or the
    highest of a ship file that knows no power above it) is sailed at the greatest; this is a
    violation.

    Fuel is priced per piece: the exact share inside the emission control areas of the chart at the
    terms inside, the rest at those outside, times the factor of price zones. A leg from one end of
    a canal of the chart to the other takes the length, time and dues of the canal, at the fuel rate
    in calm water of the slowest setting that reaches its mean speed. Sea, land and depth are not
    checked there; the limits of draught and beam of the canal are. A leg along the approach of a
    port (`thalweg.chart.approaches`) is sailed at 10 kn over ground, or the ordered speed if that
    is lower, at the fuel rate of that speed in calm water; sea, land and depth are not checked.
    """
    _check_given(ship, sea, chart)
    least_ukc = _checked_clearance(ship, min_ukc)
    terms = _checked_terms(ship, terms)
    ship = ship if load_factor is None else ship.with_load_factor(load_factor)
    track = _with_ordered_speed(as_track(route, depart), speed_kn)
    wanted, track = track.speed, _within_reach(ship, track)
    ship, track = resolve_settings(ship, track)
    world = make_sailing_environment(ship, with_wind_speed(ship, sea), chart)
    step = None if step is None else _checked_step(step)
    pieces = cut_into_pieces(track, step or _default_step(world, track), MIN_PIECES, chart, ship)
    sailed, tolerance = sail_to_tolerance(world, pieces, adapt=step is None)
    result = assemble_route(sailed, least_ukc, tolerance, terms)
    result = _with_too_fast_legs(result, wanted)
    if isinstance(route, (str, Path)):
        from thalweg.route.formats import cross_track_notes, route_file_contents

        notes = stated_time_notes(route_file_contents(Path(route)), result)
        notes += [] if chart is None else cross_track_notes(route, chart)
        rounded = [v for v in result.violations if _is_rounding_of_file(v)]
        kept = tuple(v for v in result.violations if v not in rounded)
        notes += [_rounding_note(v) for v in rounded]
        result = replace(result, assumptions=(*result.assumptions, *notes), violations=kept)
    if strict and not math.isfinite(result.arrive):
        gaps = [violation for violation in result.violations if is_data_gap(violation)]
        if gaps:
            raise coverage_error(gaps)
    return result


def as_track(route: RouteLike, depart: TimeLike | None = None) -> Track:
    """Return the track of a route, a file or positions, with the departure if one is given.

    Parameters
    ----------
    route : Track, Route, path, or iterable of (lat, lon)

    Raises
    ------
    InputError : If it cannot be read, or no departure is given.
    """
    if isinstance(route, Route):
        route = route.track
    if isinstance(route, (str, Path)):
        from thalweg.route.formats import read_track

        route = read_track(route, depart=depart)
    if isinstance(route, Track):
        return route if depart is None else route.replaced(depart=parse_time(depart))
    if depart is None:
        raise InputError(
            "The route has no departure.",
            "A list of positions has no times.",
            "Give a departure (depart, or --depart), such as 2026-01-01T06:00Z.",
            field="depart",
        )
    return Track.from_positions(route, depart=depart)


def _with_ordered_speed(track: Track, speed_kn: float | None) -> Track:
    """Return the track with an ordered calm-water speed on every leg [kn]; None: its own."""
    if speed_kn is None:
        return track
    if not (is_number(speed_kn) and speed_kn > 0.0):
        raise InputError(
            f"The ordered speed is {shortened_repr(speed_kn)}, which is not a number above zero.",
            "It is a calm-water speed in knots.",
            "Correct it, or leave it out.",
            field="speed_kn",
        )
    return track.replaced(speed=np.full(len(track) - 1, speed_kn * KNOT))


def _within_reach(ship: Ship, track: Track) -> Track:
    """Return the track with no speed ordered above the greatest of the ship."""
    greatest = ship.greatest_order() if np.isfinite(track.speed).any() else math.inf
    return track.replaced(speed=np.minimum(track.speed, greatest)) if greatest < math.inf else track


def _with_too_fast_legs(route: Route, wanted: FloatArray) -> Route:
    """Return the route with the legs as violations that order more [m/s] than the ship makes."""
    found, track = [], route.track
    made = np.asarray(route.legs["ordered_speed"], float)
    number = track.leg_numbers
    for leg in np.flatnonzero(wanted > made * (1.0 + _FILE_ROUNDING)):
        if leg and number[leg] == number[leg - 1]:  # a part of the same leg of the given route
            continue
        found.append(
            Violation(
                f"{ORDERED_TOO_FAST}: leg {number[leg]}",
                float(route.legs["depart"][leg]),
                float(track.lat[leg]),
                float(track.lon[leg]),
                float(wanted[leg]),
                float(made[leg]),
            )
        )
    return replace(route, violations=(*found, *route.violations)) if found else route


def _is_rounding_of_file(violation: Violation) -> bool:
    """Return whether a limit is exceeded by less than rounded positions and speeds change."""
    exceeded = abs(violation.value - violation.limit)
    if violation.reason in _WEATHER:
        return exceeded <= _WEATHER_ROUNDING * violation.limit
    return violation.reason.startswith(_CLEARANCE) and exceeded <= _CLEARANCE_ROUNDING


def _rounding_note(violation: Violation) -> str:
    """Return that an exceeded limit is no violation, since numbers of files are rounded."""
    place = format_position_minutes(violation.lat, violation.lon)
    return (
        f"{violation.reason.capitalize()} of {violation.value:.4g} where the limit is "
        f"{violation.limit:.4g}, near {place}: counted as kept, since the numbers of a route file "
        "are rounded."
    )


def resolve_settings(ship: Ship, track: Track) -> tuple[Ship, Track]:
    """Return the ship and the track with every setting an index from 0, the lowest.

    Where the track orders speeds that the ship does not have, the ship gets these.

    Returns
    -------
    ship : Ship
    track : With a setting for every leg and no speeds.

    Raises
    ------
    InputError : If a setting does not exist, or the ship cannot sail at a speed.
    """
    count = len(ship.speeds)
    setting = np.where(track.setting < 0, track.setting + count, track.setting)
    by_speed = np.isfinite(track.speed)
    if np.any((setting < 0) | (setting >= count)):
        raise InputError(
            f"The track has a speed setting that {ship.name!r} does not have.",
            f"It has {count} settings, 0 to {count - 1}.",
            "Use the settings of this ship, or an ordered speed.",
        )
    if not by_speed.any():
        return ship, _with_settings(track, setting)
    wanted = np.where(by_speed, track.speed, ship.speeds[setting])
    if not _nearest_settings(ship, wanted)[1]:
        ship = ship.with_speeds(wanted)
    return ship, _with_settings(track, _nearest_settings(ship, wanted)[0])


def _with_settings(track: Track, setting: NDArray[np.int64]) -> Track:
    return track.replaced(setting=setting, speed=None)


def _nearest_settings(ship: Ship, wanted: FloatArray) -> tuple[NDArray[np.int64], bool]:
    """Return the setting nearest to each speed, and whether all are the same to rounding."""
    off = np.abs(ship.speeds[None, :] - wanted[:, None])
    same = bool(np.all(off.min(axis=1) <= _SPEED_TOLERANCE * wanted))
    return np.asarray(np.argmin(off, axis=1), dtype=np.int64), same


def _check_given(ship: Ship, sea: Sea, chart: Chart | None) -> None:
    from thalweg.chart import Chart
    from thalweg.sea import Sea
    from thalweg.ship import Ship

    for name, value, kind in (("ship", ship, Ship), ("sea", sea, Sea), ("chart", chart, Chart)):
        # a chart of the user's own needs only the tests of legs
        is_chart = name == "chart" and (value is None or hasattr(value, "legs_blocked"))
        if not isinstance(value, kind) and not is_chart:
            raise InputError(
                f"The {name} is {shortened_repr(value)}, which is not a {kind.__name__}.",
                f"It must be a thalweg.{kind.__name__}.",
                f"Give a {kind.__name__}.",
                field=name,
            )


def _checked_clearance(ship: Ship, min_ukc: float | None) -> float:
    """Return the required clearance [m]; None: that of the ship file."""
    if min_ukc is None:
        return ship.min_under_keel_clearance
    if not (is_number(min_ukc) and 0.0 <= min_ukc < 100.0):
        raise InputError(
            f"An under-keel clearance of {shortened_repr(min_ukc)} m is not possible.",
            "It is between 0 and 100 m.",
            "Correct it.",
            field="min_ukc",
        )
    return float(min_ukc)


def _checked_terms(ship: Ship, terms: FuelTerms | None) -> FuelTerms:
    if terms is None:
        return ship.fuel_terms
    if not isinstance(terms, FuelTerms):
        raise InputError(
            f"The terms are {terms!r}, which are not FuelTerms.",
            "A ship has its own terms (ship.fuel_terms); with_prices changes them.",
            "Give ship.fuel_terms.with_prices(...).",
            field="terms",
        )
    return terms


def _checked_step(step: float) -> float:
    if not (is_number(step) and step > 0.0):
        raise InputError(
            f"A step of {shortened_repr(step)} m cannot be used.",
            "It is a length above zero.",
            "Leave it out.",
        )
    return float(step)


def _default_step(world: SailingEnvironment, track: Track) -> float:
    finest = min([MAX_STEP, *data_spacings(world, 0.25)])
    return max(finest, float(track.lengths.sum()) / MAX_PIECES, 1e-3)
