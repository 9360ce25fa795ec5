"""`LegPlanner`: legs between named places, planned when they are asked for.

What a simulation of several vessels and sites asks of a planner: from here to there, now, with this
load. Networks, frozen sea and searches are prepared once for each pair of places and kept.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from thalweg.core.errors import InputError, NoRouteError, OutsidePeriodError
from thalweg.core.geodesy import Position, check_position, distance, format_position
from thalweg.core.time import TimeLike, format_time, parse_time
from thalweg.core.units import DAY
from thalweg.operations.dredging.cycles import SailedLeg
from thalweg.operations.dredging.project import Sites
from thalweg.operations.dredging.project_environment import (
    ProjectEnvironment,
    freeze_site_network,
    project_network,
)
from thalweg.operations.dredging.project_validation import MAX_DAYS
from thalweg.operations.dredging.verified_legs import SiteLegPlanner
from thalweg.planning.request.coverage_check import check_argument_types
from thalweg.planning.voyage import Voyage

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.sea import Sea
    from thalweg.ship import Ship

_SAME_PLACE = 1.0  # [m]


@dataclass(frozen=True, eq=False)
class LegPlanner:
    """Legs of one ship between places, over a period.

    Attributes
    ----------
    ship : Ship
    sea : Sea
    chart : Chart
    start, days : float
        First moment [s since 1970-01-01T00:00Z] and length of the period [days].
    sites : Sites
        How the water is divided; its two places are those of the pair that is sailed.
    load_steps : int
        Loads are rounded up to this many even steps, so that a ship is never taken to lie less deep
        than it does.
    tell : callable
        Called with a short text when something is prepared.

    Examples
    --------
    >>> from thalweg.operations.examples.estuary import synthetic_estuary
    >>> from thalweg import Ship
    >>> world = synthetic_estuary(1500.0)
    >>> ways = Fairways.open(
    ...     ship=Ship.load("hopper-dredger"), sea=world.sea, chart=world.chart,
    ...     start="2026-05-01T00:00Z", days=1.0, min_ukc=1.0)
    >>> leg = ways.sail(world.load, world.unload, depart="2026-05-01T01:00Z", load_factor=0.5)
    >>> leg.clearance >= 1.0
    True
    """

    ship: Ship
    sea: Sea
    chart: Chart
    start: float
    days: float
    sites: Sites
    load_steps: int = 10
    tell: Callable[[str], None] = field(default=lambda text: None)

    @classmethod
    def open(
        cls,
        *,
        ship: Ship,
        sea: Sea,
        chart: Chart,
        start: TimeLike,
        days: float,
        min_ukc: float | None = None,
        margin: float = 0.01,
        spacing: float | None = None,
        rings: int = 3,
        detour: float = 3.0,
        load_steps: int = 10,
    ) -> LegPlanner:
        """Return the fairways of a ship.

        Parameters
        ----------
        ship, sea, chart
            As for `thalweg.plan`.
        start : time
            First moment that can be asked.
        days : float
            Length of the period.
        min_ukc, margin, spacing, rings, detour
            As in `thalweg.operations.dredging.project.Sites`.
        load_steps : int
            Steps of the load factor, 1 to 100.

        Raises
        ------
        InputError
            For a period or number of steps that cannot be, or what `Sites` refuses.
        """
        first = parse_time(start)
        voyage = Voyage(start=(0.0, 0.0), goal=(0.0, 1.0), depart=first, min_ukc_m=min_ukc)
        check_argument_types(voyage, ship, sea, chart)
        if not (isinstance(days, (int, float)) and 0.0 < days <= MAX_DAYS):
            raise InputError(
                f"A period of {days!r} days cannot be.",
                f"More than 0 and at most {MAX_DAYS:g}.",
                "Correct it.",
            )
        whole = isinstance(load_steps, int) and not isinstance(load_steps, bool)
        if not (whole and 1 <= load_steps <= 100):
            raise InputError(f"load_steps is {load_steps!r}.", "1 to 100.", "Give 10.")
        nowhere = (math.nan, math.nan)
        sites = Sites(nowhere, nowhere, min_ukc, margin, spacing, rings, detour)
        return cls(ship, sea, chart, first, float(days), sites, load_steps)

    @property
    def end(self) -> float:
        """Last moment of the period [s since 1970-01-01T00:00Z]."""
        return self.start + self.days * DAY

    def sail(
        self, origin: Position, destination: Position, *, depart: TimeLike, load_factor: float
    ) -> SailedLeg:
        """Plan a leg with the earliest arrival, and let the referee sail it.

        Parameters
        ----------
        origin, destination : (lat, lon)
            [deg], a metre apart or more.
        depart : time
            When the ship is ready to leave.
        load_factor : float
            0 empty to 1 full.

        Returns
        -------
        Leg
            With its route, waits included, least clearance, energy and fuel. Where the referee
            finds a limit broken between the nodes whatever is tried, ``route.feasible`` is False.

        Raises
        ------
        InputError
            For places on land, load factors that cannot be.
        OutsidePeriodError
            If the departure lies outside the period.
        NoRouteError
            If there is no way before the period ends.
        """
        time = parse_time(depart)
        if not self.start <= time < self.end:
            raise OutsidePeriodError(
                f"The departure {format_time(time)} lies outside the period prepared.",
                f"It runs from {format_time(self.start)} to {format_time(self.end)}.",
                "Open fairways for a longer period.",
            )
        share = self._rounded(load_factor)
        sailor, outward = self._site_planner_between(origin, destination)
        leg = sailor.sail(share, time, outward=outward)
        if leg is None:
            raise self._no_way(origin, destination, time, share)
        return leg

    def _rounded(self, load_factor: float) -> float:
        if not 0.0 <= load_factor <= 1.0 + 1e-9:
            raise InputError(
                f"The load factor is {load_factor!r}.", "0 (empty) to 1 (full).", "Correct it."
            )
        return min(1.0, math.ceil(load_factor * self.load_steps - 1e-9) / self.load_steps)

    @cached_property
    def _site_planners(self) -> dict[tuple[Position, Position], SiteLegPlanner]:
        return {}

    def _site_planner_between(
        self, origin: Position, destination: Position
    ) -> tuple[SiteLegPlanner, bool]:
        """Return what sails between two places, and whether they are in its order."""
        first = check_position(float(origin[0]), float(origin[1]), "origin")
        last = check_position(float(destination[0]), float(destination[1]), "destination")
        if float(distance(*first, *last)) < _SAME_PLACE:
            raise InputError(
                f"A leg from {format_position(*first)} leads to itself.", "", "Give two places."
            )
        for pair, outward in (((first, last), True), ((last, first), False)):
            if pair in self._site_planners:
                return self._site_planners[pair], outward
        self._check_water(first, "origin")
        self._check_water(last, "destination")
        sites = replace(self.sites, load=first, unload=last)
        period = (self.start, self.end)
        world = ProjectEnvironment.open(
            sites, period, ship=self.ship, sea=self.sea, chart=self.chart
        )
        ways = freeze_site_network(world, project_network(world), self.tell)
        self._site_planners[first, last] = SiteLegPlanner(world, ways)
        return self._site_planners[first, last], True

    def _check_water(self, place: Position, what: str) -> None:
        if not bool(np.all(self.chart.is_navigable(np.array([place[0]]), np.array([place[1]])))):
            raise InputError(
                f"The {what} {format_position(*place)} is on land or in a no-go zone.",
                "A place is navigable water of the chart.",
                "Move it.",
                field=what,
            )

    def _no_way(
        self, origin: Position, destination: Position, time: float, share: float
    ) -> NoRouteError:
        return NoRouteError(
            f"No way from {format_position(*origin)} to {format_position(*destination)} with load "
            f"factor {share:g}, leaving {format_time(time)}.",
            f"The period prepared ends {format_time(self.end)}.",
            "Load less, ask less clearance, or prepare a longer period.",
        )
