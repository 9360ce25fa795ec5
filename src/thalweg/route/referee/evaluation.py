"""The referee: re-sails any track in small steps with the ship's own formulas.

No tables, no network, no frozen fields: what it says about time, distance, fuel and clearance is
what gets published. Its own error is told with every route.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import InputError
from thalweg.core.time import TimeLike, parse_time
from thalweg.core.types import FloatArray
from thalweg.core.units import KNOT, NAUTICAL_MILE
from thalweg.route.referee.limit_checks import coverage_error, is_data_gap
from thalweg.route.referee.route_assembly import assemble_route
from thalweg.route.referee.sailing import data_spacings, sail_track
from thalweg.route.referee.sailing_physics import SailingEnvironment, make_sailing_environment
from thalweg.route.referee.wind_speed_only import with_wind_speed
from thalweg.route.route import Route
from thalweg.route.track import Track
from thalweg.ship.fuel_prices import FuelTerms

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.sea import Sea
    from thalweg.ship import Ship

RouteLike: TypeAlias = "Track | Route | str | Path | Iterable[Sequence[float]]"

MIN_PIECES = 8  #: of every leg
MAX_STEP = 0.5 * NAUTICAL_MILE  #: [m]
MAX_PIECES = 2000  #: of a route at the coarser of its two step sizes (besides `MIN_PIECES`)
_SPEED_TOLERANCE = 1e-6  # relative, for speeds that went through a file


def evaluate(
    route: RouteLike,
    *,
    ship: Ship,
    sea: Sea,
    chart: Chart | None = None,
    depart: TimeLike | None = None,
    min_ukc: float | None = 0.0,
    step: float | None = None,
    load_factor: float | None = None,
    speed_kn: float | None = None,
    strict: bool = True,
    terms: FuelTerms | None = None,
) -> Route:
    """Sail a route in small steps with the ship's own formulas, and check every limit.

    Parameters
    ----------
    route : Track, Route, path, or iterable of (lat, lon)
        What to sail along geodesics of WGS 84. Files are CSV, GeoJSON or GPX.
    ship : Ship
    sea : Sea
    chart : Chart, optional
        Land, zones and charted depth; without one they are not checked, which is told.
    depart : time, optional
        Departure; needed unless the track or the file tells it.
    min_ukc : float or None
        Least under-keel clearance [m], checked wherever the chart or the sea tells depth;
        None: not checked.
    step : float, optional
        Length of a piece [m]. By default the least of an eighth of the leg, half a nautical mile
        and a quarter of the spacing of the data, but not below 1/2000 of the route.
    load_factor : float, optional
        0 empty to 1 full; by default as the ship is loaded.
    speed_kn : float, optional
        Ordered calm-water speed on every leg [kn]; by default the track's own speeds and settings,
        those a file tells, and the ship's highest for positions and other files.
    strict : bool
        Raise if the data end before the route does. Otherwise that is listed among the violations
        and the totals are NaN.
    terms : FuelTerms, optional
        What fuel and time cost; by default what the ship file says. Unknown prices make the cost
        unknown.

    Returns
    -------
    Route

    Raises
    ------
    CoverageError
        If strict and the route runs where or when a variable that is needed is not known.
    MissingVariableError
        If the ship needs a variable that the sea does not hold.
    InputError
        If the route cannot be read, there is no departure, or a setting does not exist.

    Notes
    -----
    The time of passage solves ``dT/ds = 1 / SOG(s, T)`` by the two-stage Gauss method (order 4 in
    smooth fields, 2 across the kinks of gridded data), first with pieces of ``step``, then of half
    that; the second is what is told and the difference is its ``tolerance_s``. Limits are looked at
    more closely, at up to 10,000 places; for a route that waits, the time between two of them is
    part of the tolerance, as its waits can be that much too short. Wind acts relative
    to the moving water, weather at angles from the heading. Waiting burns the hotel load, and the
    ship does not drift (it lies at anchor); only its clearance is checked meanwhile, and
    not at the first waypoint, where it lies at its berth. Without currents in the sea (no such
    variable at all) still water is assumed, which is told.

    Fuel is priced per piece: the exact share of each inside the chart's emission control areas at
    the terms inside, the rest at those outside, times the factor of price zones. A leg from one end
    of a canal of the chart to the other takes the canal's length, time and dues, at the fuel rate
    of calm water at the slowest setting that keeps up; sea, land and depth are not looked at there,
    but the canal's limits of draught and beam are.
    """
    _check_given(ship, sea, min_ukc)
    terms = _checked_terms(ship, terms)
    ship = ship if load_factor is None else ship.with_load_factor(load_factor)
    ship, track = resolve_settings(ship, as_track(route, depart), speed_kn)
    world = make_sailing_environment(ship, with_wind_speed(ship, sea), chart)
    step = _default_step(world, track) if step is None else _checked_step(step)
    coarse = sail_track(world, track, step, MIN_PIECES, None)
    fine = sail_track(world, track, 0.5 * step, 2 * MIN_PIECES, coarse)
    result = assemble_route(fine, min_ukc, abs(fine.arrive - coarse.arrive), terms)
    if strict and not math.isfinite(result.arrive):
        gaps = [violation for violation in result.violations if is_data_gap(violation)]
        if gaps:
            raise coverage_error(gaps[-1])
    return result


def as_track(route: RouteLike, depart: TimeLike | None = None) -> Track:
    """Return the track of a route, a file or positions, with the departure if one is given.

    Raises
    ------
    InputError
        If it cannot be read or nothing tells the departure.
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
            "A list of positions tells no times.",
            "Give depart, such as 2026-01-01T06:00Z.",
            field="depart",
        )
    return Track.from_positions(route, depart=depart)


def resolve_settings(ship: Ship, track: Track, speed_kn: float | None = None) -> tuple[Ship, Track]:
    """Return the ship and the track with every setting an index from the bottom, by its speeds.

    Where the track orders speeds that are none of the ship's, the ship gets these.

    Raises
    ------
    InputError
        If a setting does not exist, or the ship cannot sail at a speed.
    """
    if speed_kn is not None:
        ship = ship.with_speeds([speed_kn * KNOT])
        return ship, _with_settings(track, np.zeros(len(track) - 1, dtype=np.int64))
    count = len(ship.speeds)
    setting = np.where(track.setting < 0, track.setting + count, track.setting)
    by_speed = np.isfinite(track.speed)
    if np.any((setting < 0) | (setting >= count)):
        raise InputError(
            f"The track asks for a speed setting that {ship.name!r} does not have.",
            f"It has {count} settings, 0 to {count - 1}.",
            "Give the settings of this ship, or an ordered speed.",
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


def _check_given(ship: Ship, sea: Sea, min_ukc: float | None) -> None:
    from thalweg.sea import Sea
    from thalweg.ship import Ship

    for name, value, kind in (("ship", ship, Ship), ("sea", sea, Sea)):
        if not isinstance(value, kind):
            raise InputError(
                f"The {name} is {value!r}, which is no {kind.__name__}.",
                f"It is made by thalweg.{kind.__name__}.",
                f"Give a {kind.__name__}.",
                field=name,
            )
    if min_ukc is not None and not 0.0 <= min_ukc < 100.0:
        raise InputError(
            f"An under-keel clearance of {min_ukc!r} m cannot be.",
            "It lies between 0 and 100 m.",
            "Correct it.",
            field="min_ukc",
        )


def _checked_terms(ship: Ship, terms: FuelTerms | None) -> FuelTerms:
    if terms is None:
        return ship.fuel_terms
    if not isinstance(terms, FuelTerms):
        raise InputError(
            f"The terms are {terms!r}, which are no FuelTerms.",
            "A ship tells its own (ship.fuel_terms); with_prices changes them.",
            "Give ship.fuel_terms.with_prices(...).",
            field="terms",
        )
    return terms


def _checked_step(step: float) -> float:
    if not (math.isfinite(step) and step > 0.0):
        raise InputError(
            f"A step of {step!r} m cannot be used.", "It is a length above zero.", "Leave it out."
        )
    return float(step)


def _default_step(world: SailingEnvironment, track: Track) -> float:
    finest = min([MAX_STEP, *data_spacings(world, 0.25)])
    return max(finest, float(track.lengths.sum()) / MAX_PIECES, 1e-3)
