"""`LegPlanner`: legs between any two places, planned on request.

A simulation of vessels and sites requests a leg from one place to another, at the present time and
load. The network, the frozen sea and the searches of each pair of places are prepared once.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from thalweg.core.errors import InputError, NoRouteError, OutsidePeriodError
from thalweg.core.geodesy import Position, check_position, distance, format_position
from thalweg.core.time import TimeLike, format_time, parse_time
from thalweg.core.units import DAY
from thalweg.operations.dredging.cycle_records import SailedLeg
from thalweg.operations.dredging.project_environment import (
    ProjectEnvironment,
    freeze_site_network,
    project_network,
)
from thalweg.operations.dredging.project_parts import SiteNetworkOptions, Sites
from thalweg.operations.dredging.project_validation import MAX_DAYS, check_clearance
from thalweg.operations.dredging.verified_legs import SiteLegPlanner
from thalweg.planning.request.coverage_check import check_argument_types
from thalweg.planning.voyage import Voyage
from thalweg.sea.standard_names import BED_DEPTH, CHANNEL_VARIABLES, plain_names

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
    period : tuple of float
        Start and end [s since 1970-01-01T00:00Z].
    min_ukc : float or None
        Minimum under-keel clearance [m]; None: that of the ship file.
    network : SiteNetworkOptions
        How the water between two places is divided.
    load_steps : int
        Loads are rounded up to a multiple of one over this number, so that the draught is never
        underestimated.
    progress : callable
        Called with a short text when a network is prepared.

    Examples
    --------
    >>> from thalweg.operations.examples.estuary import synthetic_estuary
    >>> from thalweg import Ship
    >>> estuary = synthetic_estuary(1500.0)
    >>> planner = LegPlanner.open(
    ...     ship=Ship.load("hopper-dredger"), sea=estuary.sea, chart=estuary.chart,
    ...     start="2026-05-01T00:00Z", days=1.0, min_ukc=1.0)
    >>> leg = planner.sail(
    ...     estuary.load, estuary.unload, depart="2026-05-01T01:00Z", load_factor=0.5)
    >>> leg.clearance >= 1.0
    True
    """

    ship: Ship
    sea: Sea
    chart: Chart
    period: tuple[float, float]
    min_ukc: float | None = None
    network: SiteNetworkOptions = field(default_factory=SiteNetworkOptions)
    load_steps: int = 10
    progress: Callable[[str], None] = field(default=lambda text: None)

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
        network: SiteNetworkOptions | None = None,
        load_steps: int = 10,
    ) -> LegPlanner:
        """Return the leg planner of a ship.

        Parameters
        ----------
        ship, sea, chart
            As for `thalweg.plan`.
        start : time
            Start of the period.
        days : float
            Length of the period [days].
        min_ukc : float, optional
            Minimum under-keel clearance [m]; default: that of the ship file.
        network : SiteNetworkOptions, optional
            How the water between two places is divided.
        load_steps : int
            Steps of the load factor, 1 to 100.

        Returns
        -------
        LegPlanner
            Networks are built at the first leg between two places.

        Raises
        ------
        InputError
            For a period, clearance or number of steps out of range.
        """
        first = parse_time(start)
        voyage = Voyage(start=(0.0, 0.0), goal=(0.0, 1.0), depart=first, min_ukc_m=min_ukc)
        check_argument_types(voyage, ship, sea, chart)
        if not (isinstance(days, (int, float)) and 0.0 < days <= MAX_DAYS):
            raise InputError(
                f"The period is {days!r} days.",
                f"It is more than 0 and at most {MAX_DAYS:g} days.",
                "Correct it.",
            )
        whole = isinstance(load_steps, int) and not isinstance(load_steps, bool)
        if not (whole and 1 <= load_steps <= 100):
            raise InputError(
                f"load_steps is {load_steps!r}.", "It is a number from 1 to 100.", "Give 10."
            )
        if min_ukc is not None:
            check_clearance("min_ukc", min_ukc)
        period = (first, first + float(days) * DAY)
        return cls(ship, sea, chart, period, min_ukc, network or SiteNetworkOptions(), load_steps)

    @property
    def start(self) -> float:
        """Start of the period [s since 1970-01-01T00:00Z]."""
        return self.period[0]

    @property
    def end(self) -> float:
        """End of the period [s since 1970-01-01T00:00Z]."""
        return self.period[1]

    def sail(
        self, origin: Position, destination: Position, *, depart: TimeLike, load_factor: float
    ) -> SailedLeg:
        """Return the leg with the earliest arrival, evaluated by the referee.

        Parameters
        ----------
        origin, destination : (lat, lon)
            [deg], at least one metre apart.
        depart : time
            Time at which the ship is ready to leave.
        load_factor : float
            0 empty to 1 full.

        Returns
        -------
        SailedLeg
            With its route (waits included), least clearance, energy and fuel. ``route.feasible`` is
            False if the referee finds a limit broken between the nodes in every attempt.

        Raises
        ------
        InputError
            For places on land, or a load factor out of range.
        OutsidePeriodError
            If the departure is outside the period.
        NoRouteError
            If there is no route before the period ends, or a place is outside the data.
        """
        time = parse_time(depart)
        if not self.start <= time < self.end:
            raise OutsidePeriodError(
                f"The departure {format_time(time)} is outside the period of the leg planner.",
                f"It is from {format_time(self.start)} to {format_time(self.end)}.",
                "Open a leg planner for a longer period.",
            )
        share = self._rounded(load_factor)
        planner, outward = self._site_planner_between(origin, destination)
        leg = planner.sail(share, time, outward=outward)
        if leg is None:
            self._check_data(
                planner.environment, {"origin": origin, "destination": destination}, time
            )
            raise self._no_route_error(origin, destination, time, share)
        return leg

    def _rounded(self, load_factor: float) -> float:
        if not 0.0 <= load_factor <= 1.0 + 1e-9:
            raise InputError(
                f"The load factor is {load_factor!r}.",
                "It is 0 (empty) to 1 (full).",
                "Correct it.",
            )
        return min(1.0, math.ceil(load_factor * self.load_steps - 1e-9) / self.load_steps)

    @cached_property
    def _site_planners(self) -> dict[tuple[Position, Position], SiteLegPlanner]:
        return {}

    def _site_planner_between(
        self, origin: Position, destination: Position
    ) -> tuple[SiteLegPlanner, bool]:
        """Return the leg planner between two places, and whether the places are in its order."""
        first = check_position(float(origin[0]), float(origin[1]), "origin")
        last = check_position(float(destination[0]), float(destination[1]), "destination")
        if float(distance(*first, *last)) < _SAME_PLACE:
            raise InputError(
                f"The leg from {format_position(*first)} ends at the same place.",
                "Its ends are at least one metre apart.",
                "Give two places.",
            )
        for pair, outward in (((first, last), True), ((last, first), False)):
            if pair in self._site_planners:
                return self._site_planners[pair], outward
        self._check_water(first, "origin")
        self._check_water(last, "destination")
        sites = Sites(first, last, self.min_ukc, self.network)
        environment = ProjectEnvironment.open(
            sites, self.period, ship=self.ship, sea=self.sea, chart=self.chart
        )
        network = freeze_site_network(environment, project_network(environment), self.progress)
        self._site_planners[first, last] = SiteLegPlanner(environment, network)
        return self._site_planners[first, last], True

    def _check_water(self, place: Position, what: str) -> None:
        if not bool(np.all(self.chart.is_navigable(np.array([place[0]]), np.array([place[1]])))):
            raise InputError(
                f"The {what} {format_position(*place)} is on land or in a no-go zone.",
                "It must be navigable water on the chart.",
                "Move it.",
                field=what,
            )

    def _check_data(
        self, environment: ProjectEnvironment, places: dict[str, Position], time: float
    ) -> None:
        """Raise `NoRouteError` where the sea is not known at an end of a leg without a route."""
        channels = environment.needs.channels
        names = [name for c, name in CHANNEL_VARIABLES.items() if c in channels]
        if self.chart.has_depth:
            names = [name for name in names if name != BED_DEPTH]
        for what, place in places.items():
            at = (np.array([float(x)]) for x in (time, *place))
            values = self.sea.sample(names, *at)
            unknown = [name for name in names if not np.isfinite(values[name]).all()]
            if unknown:
                raise NoRouteError(
                    f"The {what} {format_position(*map(float, place))} is outside the data: there "
                    f"is no {plain_names(unknown)} at {format_time(time)}.",
                    "Both ends of a leg are within the data of the sea, given as (lat, lon).",
                    "Correct the position, or add data there.",
                    field=what,
                )

    def _no_route_error(
        self, origin: Position, destination: Position, time: float, share: float
    ) -> NoRouteError:
        return NoRouteError(
            f"There is no route from {format_position(*origin)} to {format_position(*destination)} "
            f"with load factor {share:g}, leaving {format_time(time)}.",
            f"The period ends {format_time(self.end)}.",
            "Load less, require less clearance, or open a leg planner for a longer period.",
        )
