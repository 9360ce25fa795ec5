"""`DepartureSeries`: the fastest route on a network for each of many departures.

The network is built once, and the sea is frozen once for the departures of a month. A departure
then takes a few milliseconds in place of a second: its route is exact on the network, but neither
refined in open water nor sailed by the referee; its figures are those of
`thalweg.planning.departures.network_figures`.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Final

import numpy as np

from thalweg.chart import Chart
from thalweg.core.errors import InputError, NoRouteError, OutsidePeriodError
from thalweg.core.geodesy import line_length
from thalweg.core.time import format_time, to_datetime64
from thalweg.core.units import HOUR
from thalweg.network import Network, fixed_route, shortest_path
from thalweg.planning.approach_sailing import ApproachSailing, shared_line
from thalweg.planning.departures.network_figures import (
    ApproachFigures,
    LandAlongLegs,
    approach_figures,
    figures_of_paths,
)
from thalweg.planning.departures.path_points import SailedPath
from thalweg.planning.frozen_sea import FrozenSea, freeze_at_stations
from thalweg.planning.network_selection.bed_along_edges import with_bed_along_edges
from thalweg.planning.network_selection.network_builder import build_network
from thalweg.planning.offing_attempts import plan_off_land
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.request.network_choice import NetworkBuilder, NetworkChoice
from thalweg.planning.request.offing_choice import chosen_offing
from thalweg.planning.request.ordered_speed import with_order
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.request.voyage_objective import with_voyage_prices
from thalweg.planning.single.no_route_diagnosis import late_arrival_error, no_route_error
from thalweg.planning.single.weather_stall import SearchedWater
from thalweg.planning.voyage import Voyage
from thalweg.planning.voyage_context import voyage_context
from thalweg.route import Route, with_wind_speed
from thalweg.sea import Sea
from thalweg.search import ShipOnNetwork, earliest_arrival
from thalweg.search.prepared_network import PreparedNetwork
from thalweg.search.profile_search import ProfileSearch, prepare_profile_search
from thalweg.search.timed_path import TimedPath
from thalweg.ship import Ship

#: Longest voyages, in multiples of the time on the geodesic; the last with two tides more.
_HORIZONS: Final = (2.5, 8.0)
_TWO_TIDES: Final = 25 * HOUR

#: The figures of a departure, or why it has no route.
SeriesFigures = dict[str, Any] | NoRouteError | OutsidePeriodError


@dataclass(frozen=True, eq=False)
class _Section:
    """One section of the voyage in the sea of one window."""

    network: Network
    frozen: FrozenSea
    search: ProfileSearch


@dataclass(frozen=True, eq=False)
class DepartureSeries:
    """The fastest routes of one voyage on its network, by departure.

    Attributes
    ----------
    context : The request and its data, at sea.
    ends : Start, via points and goal.
    networks : One for each section.
    approaches : What the approaches of the ports add.
    """

    context: PlanningContext
    ends: Sequence[Endpoint]
    networks: tuple[Network, ...]
    approaches: ApproachFigures
    _windows: dict[tuple[int, float], tuple[_Section, ...]] = field(default_factory=dict)

    @cached_property
    def _land(self) -> LandAlongLegs:
        return LandAlongLegs(self.context.chart)

    @classmethod
    def prepare(
        cls,
        voyage: Voyage,
        *,
        ship: Ship,
        sea: Sea,
        chart: Chart,
        network: str | NetworkBuilder = "auto",
        resolution: float | None = None,
    ) -> DepartureSeries:
        """Build the networks of a voyage.

        Parameters
        ----------
        voyage : With any of the departures.
        ship, sea, chart : As in `thalweg.planning.plan`.
        network, resolution : As there.

        Raises
        ------
        InputError
            For an objective other than time, a window or time of arrival in place of a departure,
            canals, and what `plan` refuses.
        NoRouteError
            If a network has no path.
        """
        _check_series(voyage)
        ship = with_order(with_voyage_prices(ship, voyage), voyage)
        if voyage.min_ukc_m is not None:
            ship = ship.with_clearance(voyage.min_ukc_m)
        choice = NetworkChoice(network, resolution, voyage.layered)
        context, ends = voyage_context(voyage, ship, with_wind_speed(ship, sea), chart, choice)
        if shared_line(context, ends) is not None:
            raise _unsuitable("whose ports share an approach")
        sailing = ApproachSailing.of_voyage(context, ends)
        at_sea = replace(context, chart=replace(context.chart, approaches=None))

        def build(tried: PlanningContext) -> tuple[PlanningContext, tuple[Network, ...]]:
            places = [(end.lat, end.lon) for end in ends]
            period = tried.voyage.earliest_departure, tried.data_end
            networks = (
                build_network(
                    tried.choice.of_section(places, k), tried.chart, tried.sea, pair, period=period
                )
                for k, pair in enumerate(itertools.pairwise(ends))
            )
            required = tried.needs.limits.required_depth
            return tried, tuple(with_bed_along_edges(one, tried.sea, required) for one in networks)

        offing = chosen_offing(context.voyage, ship)
        at_sea, networks = plan_off_land(at_sea, ends, offing, build, length_of=_least_length)
        if any(np.isfinite(one.edges.fixed_time).any() for one in networks):
            raise _unsuitable("through canals")
        return cls(at_sea, ends, networks, approach_figures(sailing, context))

    def figures(self, departures: Sequence[float]) -> list[SeriesFigures]:
        """Return the figures of each departure, or why there is no route.

        Parameters
        ----------
        departures : sequence of float
            [s since 1970-01-01T00:00Z].

        Returns
        -------
        list of dict or error
            See `thalweg.planning.departures.network_figures.figures_of_paths`.
        """
        found: list[SeriesFigures | None] = [None] * len(departures)
        paths, places = [], []
        for place, depart in enumerate(departures):
            try:
                paths.append(self._path(float(depart)))
                places.append(place)
            except (NoRouteError, OutsidePeriodError) as error:
                found[place] = error
        rows = figures_of_paths(self.context, paths, self.approaches, self._land)
        for place, row in zip(places, rows):
            found[place] = row
        return found  # type: ignore[return-value]

    def _path(self, depart: float) -> SailedPath:
        """Return the fastest path of one departure from berth to berth.

        Raises
        ------
        NoRouteError
            If there is none, or it arrives too late.
        OutsidePeriodError
            If the data do not cover the departure.
        """
        at_sea = depart + self.approaches.outward_s
        refusal: NoRouteError | None = None
        for horizon in _HORIZONS:
            sections = self._sections(at_sea, horizon)
            paths, refusal = self._timed_paths(sections, at_sea, at_sea + self._longest(horizon))
            last = float(sections[-1].frozen.stations.times[-1])
            if refusal is None or last >= self.context.data_end:
                break
        if refusal is not None:
            raise refusal
        arrive = paths[-1].arrive + self.approaches.inward_s
        latest = self.context.latest_arrival
        if arrive > latest + 1.0:
            raise late_arrival_error(latest, arrive, window=False)
        return SailedPath.of_paths(depart, arrive, self.networks, paths)

    def _timed_paths(
        self, sections: Sequence[_Section], depart: float, latest: float
    ) -> tuple[list[TimedPath], NoRouteError | None]:
        """Return the paths of all sections, or the refusal of the one that has none."""
        paths: list[TimedPath] = []
        for number, section in enumerate(sections):
            path = section.search.sail(depart, arrive_by=latest)
            if not path.found:
                return [], self._refusal(section, number, depart)
            paths.append(path)
            depart = path.arrive
        return paths, None

    def _refusal(self, section: _Section, number: int, depart: float) -> NoRouteError:
        """Return why a section has no route for a departure."""
        context, network = self.context, section.network
        ship = ShipOnNetwork(
            network, section.frozen.stations, context.table, setting=context.setting,
            limits=context.needs.limits, top_speed=section.frozen.top_speed,
        )  # fmt: skip
        result = earliest_arrival(
            ship, start=network.meta.start, goal=network.meta.goal, depart=depart,
            wait=False,  # what closes the way at once is counted by reason
        )  # fmt: skip
        pair = self.ends[number], self.ends[number + 1]
        last = float(section.frozen.stations.times[-1])
        return no_route_error(
            network, result, pair, depart=depart,
            last=last if last >= context.data_end else math.inf,
            water=SearchedWater(
                section.frozen.stations, context.needs.limits.required_depth, context.table,
                context.setting,
            ),
        )  # fmt: skip

    def _longest(self, horizon: float) -> float:
        """Return the longest path that is searched [s]."""
        way = line_length([(end.lat, end.lon) for end in self.ends])
        usual = way / float(self.context.ship.speeds[self.context.setting])
        return horizon * usual + (HOUR if horizon == _HORIZONS[0] else _TWO_TIDES)

    def _sections(self, depart: float, horizon: float) -> tuple[_Section, ...]:
        """Return the sections in the sea of the month of a departure.

        The month, not the departures at hand, sets the window, so that results do not depend on
        how departures are put together.
        """
        month = int(to_datetime64(depart).astype("datetime64[M]").astype(np.int64))
        if (month, horizon) not in self._windows:
            if len(self._windows) > 1:
                self._windows.clear()
            self._windows[month, horizon] = self._prepared(month, horizon)
        sections = self._windows[month, horizon]
        times = sections[0].frozen.stations.times
        if not times[0] <= depart <= times[-1]:
            raise OutsidePeriodError(
                f"The departure is {format_time(depart)}.",
                f"The data of its month are from {format_time(times[0])} to "
                f"{format_time(times[-1])}.",
                "Choose a departure in that period, or give data for the voyage.",
            )
        return sections

    def _prepared(self, month: int, horizon: float) -> tuple[_Section, ...]:
        context = self.context
        months = np.array([month, month + 1], "datetime64[M]")  # since 1970-01
        start, after = months.astype("datetime64[s]").astype(np.int64).astype(float).tolist()
        end = min(after + self._longest(horizon), context.data_end)
        sections = []
        for network in self.networks:
            frozen = freeze_at_stations(context, network, start, max(end, start))
            search = prepare_profile_search(
                PreparedNetwork.prepare(network, frozen.stations),
                context.table,
                start=network.meta.start,
                goal=network.meta.goal,
                setting=context.setting,
                limits=context.needs.limits,
                top_speed=frozen.top_speed,
                wait=context.voyage.wait,
            )
            sections.append(_Section(network, frozen, search))
        return tuple(sections)

    def weather_blind(self) -> DepartureSeries:
        """Return the series along the path that is fastest in calm weather.

        Raises
        ------
        NoRouteError
            If there is none.
        """
        context = self.context
        calm = replace(context, sea=Sea.layered(Sea.calm(), context.sea))
        in_calm = replace(self, context=calm, _windows={})
        depart = context.voyage.earliest_departure
        paths, refusal = in_calm._timed_paths(
            in_calm._sections(depart, _HORIZONS[0]), depart, math.inf
        )
        if refusal is not None:
            raise refusal
        lines = []
        for network, one in zip(self.networks, paths):
            lat, lon = network.stations.lat[one.nodes], network.stations.lon[one.nodes]
            places = list(zip(lat.tolist(), lon.tolist()))
            lines.append(fixed_route(context.chart, places, spacing=math.inf))
        return replace(self, networks=tuple(lines), _windows={})

    def refereed(self, depart: float) -> Route:
        """Return the route of a departure as the referee sails it, between the sea ends of ports.

        Raises
        ------
        NoRouteError
            If there is none.
        OutsidePeriodError
            If the data do not cover the departure.
        """
        return self.context.evaluate(self._path(float(depart)).track(self.context.setting))


def _least_length(built: tuple[PlanningContext, tuple[Network, ...]]) -> float:
    """Return the least length of a way over networks one after the other [m]."""
    ends = [(one, one.meta.start, one.meta.goal) for one in built[1]]
    return sum(float(shortest_path(one, start, goal)[0][goal]) for one, start, goal in ends)


def _check_series(voyage: Voyage) -> None:
    if voyage.objective != "time":
        raise _unsuitable(f"for the objective {voyage.objective!r}")
    if voyage.depart is None or voyage.arrive is not None or voyage.ensemble is not None:
        raise _unsuitable("without a departure, with a time of arrival or a risk measure")


def _unsuitable(what: str) -> InputError:
    return InputError(
        f"The detail 'network' was requested for voyages {what}.",
        "It finds the least time of each departure, from position to position or port to port.",
        "Leave out detail: such voyages are planned one by one.",
        field="detail",
    )
