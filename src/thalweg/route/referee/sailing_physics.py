"""What the ship meets and does at points of a track: the sea and the ship's own formulas."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from thalweg.chart.chart import control_areas_in_force
from thalweg.core.errors import MissingVariableError
from thalweg.core.types import FloatArray
from thalweg.route.referee.leg_segments import TrackPoints
from thalweg.sea.fill_policies import fill_hint
from thalweg.sea.standard_names import plain_names
from thalweg.ship.condition_variables import (
    BED_DEPTH,
    EASTWARD_CURRENT,
    NORTHWARD_CURRENT,
    WATER_LEVEL,
    WAVE_EAST,
    WAVE_HEIGHT,
    WAVE_NORTH,
)
from thalweg.ship.conditions import Conditions
from thalweg.ship.methods.current_triangle import crab_angle, current_triangle
from thalweg.ship.ship_assumptions import stated_assumptions, unchecked_depth_note

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.chart.zones.zone_set import Zones
    from thalweg.sea import Sea
    from thalweg.ship import Ship

CURRENTS = (EASTWARD_CURRENT, NORTHWARD_CURRENT)
_MAX_HEADING_ITERATIONS = 60  # corrections of the heading at most
_SPEED_TOLERANCE = 1e-11  # relative change of speed that ends them ...
_SPEED_NOISE = 1e-5  # ... or one below this that shrinks no more: ships that solve for their speed


@dataclass(frozen=True)
class SailingEnvironment:
    """A ship, the sea and the chart, and the variables that are sampled.

    Attributes
    ----------
    names : Variables of the sea to sample.
    assumptions : Assumptions where data are missing.
    """

    ship: Ship
    sea: Sea
    chart: Chart | None
    names: tuple[str, ...]
    assumptions: tuple[str, ...]

    @property
    def has_current(self) -> bool:
        """Whether the sea has currents."""
        return EASTWARD_CURRENT in self.names

    @property
    def control_areas(self) -> Zones | None:
        """Emission control areas that count; None if they are switched off."""
        if self.chart is None:
            return control_areas_in_force()
        return getattr(self.chart, "control_areas", None)  # a chart of the user's own has none

    @property
    def charted(self) -> bool:
        """Whether the chart has depths."""
        return self.chart is not None and bool(self.chart.has_depth)

    @property
    def has_depth(self) -> bool:
        """Whether the chart or the sea has depths."""
        return self.charted or BED_DEPTH in self.names


@dataclass(frozen=True)
class SailingState:
    """Motion of a ship, and the sea, at points and times.

    Attributes
    ----------
    sampled : Variables of the sea by name, SI.
    depth : Water depth, level included [m]; +inf where no source of depth exists, NaN unknown.
    heading : [rad from north].
    speed_through_water, speed_over_ground : ndarray
        [m/s]; the latter is NaN where the ship cannot hold its course or its speed is unknown.
    """

    sampled: dict[str, FloatArray]
    depth: FloatArray
    heading: FloatArray
    speed_through_water: FloatArray
    speed_over_ground: FloatArray


def make_sailing_environment(ship: Ship, sea: Sea, chart: Chart | None) -> SailingEnvironment:
    """Find the variables that a ship needs, and check that the sea has them.

    Raises
    ------
    MissingVariableError : If a model or a limit of the ship needs a variable that no source has.
    """
    missing = sorted(name for name in ship.needs if name not in sea.variables)
    if missing:
        raise MissingVariableError(
            f"The ship {ship.name!r} needs data that the sea does not have: "
            f"{plain_names(missing)}.",
            f"The sea has: {plain_names(sea.variables)}.",
            f"Add a file with {'it' if len(missing) == 1 else 'them'}, or fill by name: "
            f"{fill_hint(missing, sea.variables)} (in Python, Sea.filled).",
            missing=missing,
        )
    names = set(ship.needs)
    assumptions = [*getattr(sea, "assumptions", ()), *stated_assumptions(ship)]
    if all(name in sea.variables for name in CURRENTS):
        names |= set(CURRENTS)
    else:
        assumptions.append("No currents in the data: still water is assumed.")
    charted = chart is not None and bool(chart.has_depth)
    if BED_DEPTH in sea.variables:
        names.add(BED_DEPTH)
    if charted or BED_DEPTH in names:
        if WATER_LEVEL in sea.variables:
            names.add(WATER_LEVEL)
        else:
            assumptions.append("No water levels in the data: depths are taken at chart datum.")
    else:
        assumptions.append(unchecked_depth_note(ship))
    if chart is None:
        assumptions.append("No chart: land was not checked.")
    return SailingEnvironment(
        ship, sea, chart, tuple(sorted(names)), tuple(dict.fromkeys(assumptions))
    )


def sample_sea_and_depth(
    world: SailingEnvironment, points: TrackPoints, time: FloatArray
) -> tuple[dict[str, FloatArray], FloatArray]:
    """Return (sampled sea variables, water depth [m]) at points and times.

    Parameters
    ----------
    world : Ship, sea and chart.
    points : Positions and courses.
    time : Times [s since 1970-01-01T00:00Z], (n,).

    Returns
    -------
    sampled : Sea variables by CF standard name [SI].
    depth : Water depth [m], (n,); NaN where unknown.
    """
    sampled = world.sea.sample(world.names, time, points.lat, points.lon)
    if WAVE_HEIGHT in sampled and WAVE_NORTH in sampled:  # no waves have no direction
        flat = (sampled[WAVE_HEIGHT] == 0.0) & ~np.isfinite(sampled[WAVE_NORTH])
        sampled[WAVE_EAST] = np.where(flat, 0.0, sampled[WAVE_EAST])
        sampled[WAVE_NORTH] = np.where(flat, 1.0, sampled[WAVE_NORTH])
    depth = points.charted
    if BED_DEPTH in sampled:
        depth = np.minimum(depth, sampled[BED_DEPTH])
    if WATER_LEVEL in sampled:
        depth = depth + sampled[WATER_LEVEL]
    return sampled, depth


def solve_sailing_state(
    world: SailingEnvironment,
    points: TrackPoints,
    time: FloatArray,
    guess: FloatArray | None = None,
) -> SailingState:
    """Return what the ship does at points and times.

    Parameters
    ----------
    time : [s since 1970-01-01T00:00Z].
    guess : Speed through water [m/s] near the answer, to start the current triangle from.

    Notes
    -----
    Heading and speed over ground follow from the speed through water V by
    `thalweg.ship.methods.current_triangle.current_triangle` (van Halem 2019, section 2.3). As V
    depends on the heading where waves and wind are met at an angle, both are found by fixed-point
    iteration to a relative 1e-11.
    """
    sampled, depth = sample_sea_and_depth(world, points, time)
    east = north = np.zeros(len(points))
    if world.has_current:
        east, north = sampled[EASTWARD_CURRENT], sampled[NORTHWARD_CURRENT]
    across = east * np.cos(points.course) - north * np.sin(points.course)
    speed, crab = _solve_current_triangle(world, points, time, sampled, depth, across, guess)
    found = current_triangle(speed, points.course, current_east=east, current_north=north)
    heading = np.where(found.possible, found.heading, (points.course + crab) % (2.0 * math.pi))
    return SailingState(sampled, depth, heading, speed, found.speed_over_ground)


def conditions_at(
    world: SailingEnvironment,
    points: TrackPoints,
    time: FloatArray,
    *,
    sampled: dict[str, FloatArray],
    depth: FloatArray,
    heading: FloatArray,
) -> Conditions:
    """Return the conditions a ship model reads.

    Parameters
    ----------
    world : Ship, sea and chart.
    points : Positions and courses.
    time : Times [s since 1970-01-01T00:00Z], (n,).
    sampled : Sea variables by CF standard name [SI].
    depth : Water depth [m], (n,).
    heading : Headings [rad from north], (n,).
    """
    crab = (heading - points.course + math.pi) % (2.0 * math.pi) - math.pi
    more = {"depth": depth, "crab_angle": crab} if world.has_depth else {"crab_angle": crab}
    return Conditions.from_sea(
        sampled, heading=heading, time=time, lat=points.lat, lon=points.lon, **more
    )


def conditions_in_state(
    world: SailingEnvironment, points: TrackPoints, time: FloatArray, state: SailingState
) -> Conditions:
    """Return the conditions a ship model reads where the state of sailing is known."""
    return conditions_at(
        world,
        points,
        time,
        sampled=state.sampled,
        depth=state.depth,
        heading=state.heading,
    )


def _solve_current_triangle(
    world: SailingEnvironment,
    points: TrackPoints,
    time: FloatArray,
    sampled: dict[str, FloatArray],
    depth: FloatArray,
    across: FloatArray,
    guess: FloatArray | None,
) -> tuple[FloatArray, FloatArray]:
    """Return (speed through water, crab angle), consistent with each other."""
    ship = world.ship
    field = ship.speed_field
    if field is not None:
        speed = np.broadcast_to(field(sampled, time, points.lat, points.lon), across.shape)
        return speed, crab_angle(across, speed)
    fixed = not ship.heading_matters or not np.any(across)
    crab = np.zeros_like(across) if guess is None or fixed else crab_angle(across, guess)
    speed = np.full_like(across, math.nan)
    change = math.inf
    for _ in range(_MAX_HEADING_ITERATIONS):
        before = speed
        here = conditions_at(
            world, points, time, sampled=sampled, depth=depth, heading=points.course + crab
        )
        speed = np.broadcast_to(ship.speed_through_water(here, points.setting), across.shape)
        crab = crab_angle(across, speed)
        if fixed:
            break
        last_change, change = change, _largest_change(before, speed)
        if change <= _SPEED_TOLERANCE or (change < _SPEED_NOISE and change > 0.3 * last_change):
            break
    return speed, crab


def _largest_change(before: FloatArray, speed: FloatArray) -> float:
    """Return the largest relative change of the speeds that are known; inf at first."""
    with np.errstate(invalid="ignore", divide="ignore"):
        change = np.abs(speed - before) / np.abs(speed)
    change = np.where(speed == before, 0.0, change)[~np.isnan(speed)]
    return math.inf if np.isnan(change).any() else float(change.max(initial=0.0))
