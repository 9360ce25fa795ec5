"""What the steps of planning one voyage share: the request, the data, the ship as tables."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Protocol, runtime_checkable

import numpy as np

from thalweg.chart import Chart
from thalweg.core.geodesy import positions_along
from thalweg.planning.request.network_choice import NetworkChoice
from thalweg.planning.request.requirements import Requirements, required_under_keel_clearance
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.voyage import Voyage
from thalweg.route import Route, Track, evaluate
from thalweg.sea import Sea
from thalweg.sea.fill_policies import is_calm_layer
from thalweg.ship import PerformanceTable, Ship, TableError, TablePart
from thalweg.ship.fuel_prices import FuelTerms


@dataclass(frozen=True)
class ShipTables:
    """A ship as the searches use it.

    Attributes
    ----------
    speed : Speed through water [m/s].
    setting : Speed setting of a search at one setting; by default the highest.
    """

    speed: PerformanceTable
    setting: int


@runtime_checkable
class RouteProgress(Protocol):
    """Capability of a progress callback: it receives each better route."""

    def show_route(self, route: Route) -> None:
        """Receive a route that was found so far."""
        ...


@runtime_checkable
class FrontProgress(Protocol):
    """Capability of a progress callback: it receives each better front."""

    def show_front(self, points: Sequence[tuple[float, float]], unit: str) -> None:
        """Receive times [s] and values of the front so far."""
        ...


@dataclass(frozen=True)
class PlanningContext:
    """What stays the same for every passage of a voyage.

    Attributes
    ----------
    needs : Channels of the sea, limits and the end of the data.
    report_progress : Called with a short text at each stage; see `show_route`, `show_front`.
    proof_seconds : Time for the certificate of a lower bound [s]; None for that of the search.
    approach_times : In the approaches before and after the voyage at sea [s].
    with_approaches : Returns a route at sea with the approaches of its ports, to be shown.
    leaves_later : Whether a later departure is searched where the ship waits above her limits.
    """

    voyage: Voyage
    ship: Ship
    sea: Sea
    chart: Chart
    needs: Requirements
    tables: ShipTables
    choice: NetworkChoice
    report_progress: Callable[[str], None] = field(default=lambda text: None)
    proof_seconds: float | None = None
    approach_times: tuple[float, float] = (0.0, 0.0)
    with_approaches: Callable[[Route], Route] = field(default=lambda route: route)
    leaves_later: bool = True

    def show_route(self, route: Route) -> None:
        """Give a route that was found so far to a progress callback with ``show_route``."""
        if isinstance(self.report_progress, RouteProgress) and route.feasible:
            self.report_progress.show_route(self.with_approaches(route))

    def show_front(self, points: Sequence[tuple[float, float]], unit: str) -> None:
        """Give the front so far to a progress callback with ``show_front``.

        Parameters
        ----------
        points : sequence of (float, float)
            Time [s] and value.
        unit : Of the value.
        """
        if isinstance(self.report_progress, FrontProgress):
            self.report_progress.show_front(points, unit)

    def with_stricter_motions(self, share: float) -> PlanningContext:
        """Return the context of searches with limits of motions that are stricter by a share."""
        if share == 0.0 or self.table.safety is None:
            return self
        speed = replace(self.table, motions_margin=share)
        return replace(self, tables=replace(self.tables, speed=speed))

    @property
    def table(self) -> PerformanceTable:
        """Speed through water [m/s]."""
        return self.tables.speed

    @property
    def setting(self) -> int:
        """Speed setting of a search at one setting."""
        return self.tables.setting

    @property
    def data_end(self) -> float:
        """Last time that the data cover [s since 1970]; may be infinite."""
        return self.needs.data_end

    @property
    def sea_is_calm(self) -> bool:
        """Whether the sea is known to have no wind, waves and currents anywhere."""
        return all(map(is_calm_layer, self.sea.layers))

    @property
    def min_ukc(self) -> float:
        """Least under-keel clearance that is required [m]."""
        return required_under_keel_clearance(self.voyage, self.ship)

    @property
    def latest_arrival(self) -> float:
        """Latest arrival that the voyage allows [s since 1970]; inf without any."""
        deadline = self.voyage.arrive_by
        return math.inf if deadline is None else float(deadline)  # type: ignore[arg-type]

    def evaluate(self, track: Track, terms: FuelTerms | None = None) -> Route:
        """Return a track scored by the referee; broken limits are listed, not raised."""
        return evaluate(
            track,
            ship=self.ship,
            sea=self.sea,
            chart=self.chart,
            min_ukc=self.min_ukc,
            strict=False,
            terms=terms,
        )


def greatest_speed_of(ship: Ship, table: PerformanceTable, setting: int) -> float:
    """Return an upper bound of the speed through water at a setting [m/s].

    That of the ship's model or, where it knows none, of its table; +inf where the speed is a field
    of the sea without a known bound.
    """
    top = ship.top_speed(setting)
    if top is None:
        top = table.largest(setting) if ship.speed_field is None else math.inf
    return float(top)


def performance_table_of(ship: Ship) -> PerformanceTable:
    """Return the speed table of a ship; a placeholder where its speed is a field of the sea."""
    if ship.speed_field is None:
        return ship.tabulate()
    none = TablePart((), (), np.zeros(len(ship.speeds), np.float32))
    return PerformanceTable((none,), ship.speeds, ship.fingerprint(), TableError(0.0, 0.0, 0.0))


def expected_speed(context: PlanningContext, ends: Sequence[Endpoint], depart: float) -> float:
    """Return the expected speed [m/s]: of the setting, or the mean of a speed field on the way."""
    if context.ship.speed_field is None:
        return float(context.ship.speeds[context.setting])
    start, goal = ends
    lat, lon = positions_along(start.lat, start.lon, goal.lat, goal.lon, np.linspace(0, 1, 33))
    time = np.full(lat.shape, depart)
    names = sorted(context.ship.needs)
    speed = context.ship.speed_field(context.sea.sample(names, time, lat, lon), time, lat, lon)
    known = speed[np.isfinite(speed) & (speed > 0)]
    return float(known.mean()) if known.size else 1.0
