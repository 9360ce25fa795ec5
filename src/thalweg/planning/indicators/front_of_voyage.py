"""The front of two key figures of a voyage."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from thalweg.chart import Chart
from thalweg.chart.coast.gshhg import usual_resolution
from thalweg.planning.offing_attempts import plan_off_land, shortest_length
from thalweg.planning.pareto.indicator_front import IndicatorFront, search_indicator_front
from thalweg.planning.pareto.trade_off_planner import with_trade_off
from thalweg.planning.planning_context import PlanningContext
from thalweg.planning.request.coverage_check import check_argument_types
from thalweg.planning.request.network_choice import NetworkBuilder, NetworkChoice
from thalweg.planning.request.offing_choice import chosen_offing
from thalweg.planning.request.ordered_speed import with_order
from thalweg.planning.request.voyage_objective import with_voyage_prices
from thalweg.planning.voyage import Voyage
from thalweg.planning.voyage_context import voyage_context
from thalweg.route import with_wind_speed
from thalweg.sea import Sea
from thalweg.ship import Ship


def indicator_front(
    voyage: Voyage,
    of: tuple[str, str],
    *,
    ship: Ship,
    sea: Sea,
    chart: Chart | None = None,
    network: str | NetworkBuilder = "auto",
    resolution: float | None = None,
    progress: Callable[[str], None] | None = None,
) -> IndicatorFront:
    """Search the front of two additive key figures on the network of a voyage.

    Parameters
    ----------
    voyage : Voyage
        The request; its objective is not used.
    of : (str, str)
        Two of time, distance, fuel, energy, cost, co2, comfort, encounters and inshore.
    ship, sea, chart, network, resolution, progress
        As for `plan`.

    Returns
    -------
    IndicatorFront
        Between the sea ends of the approaches of ports. Its bounds hold for every path of the
        network without waits; the routes are scored by the referee.

    Raises
    ------
    InputError, CoverageError, NoRouteError
        As `plan`.
    """
    chart = Chart.gshhg(usual_resolution()) if chart is None else chart
    check_argument_types(voyage, ship, sea, chart)
    ship = with_order(with_voyage_prices(ship, voyage), voyage)
    request = replace(voyage, objective="weighted", weights=dict.fromkeys(of, 1.0))
    choice = NetworkChoice(network, resolution, voyage.layered)
    context, ends = voyage_context(request, ship, with_wind_speed(ship, sea), chart, choice)
    context = replace(context, report_progress=progress or context.report_progress)
    at_sea = replace(context, chart=replace(context.chart, approaches=None))

    def search(off_land: PlanningContext) -> IndicatorFront:
        return with_trade_off(
            off_land, ends, lambda own, found: search_indicator_front(own, found[0].network, of)
        )

    return plan_off_land(
        at_sea, ends, chosen_offing(request, ship), search,
        length_of=lambda front: shortest_length(front.routes),
    )  # fmt: skip
