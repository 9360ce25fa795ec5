"""What the planning of a voyage begins with: its context and its ends, after all checks."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from thalweg.chart import Chart
from thalweg.planning.network_selection.southern_limit import southern_limit
from thalweg.planning.network_selection.way_choice import with_chosen_ways, without_small_ways
from thalweg.planning.planning_context import PlanningContext, ShipTables, performance_table_of
from thalweg.planning.report.zone_report import margin_notes
from thalweg.planning.request.chart_restrictions import (
    add_emission_control_areas,
    exclude_closed_canals,
    exclude_ice_latitudes,
)
from thalweg.planning.request.coverage_check import doubts_of_voyage, endpoints_within_coverage
from thalweg.planning.request.early_checks import check_request
from thalweg.planning.request.lane_choice import add_traffic_schemes
from thalweg.planning.request.network_choice import NetworkChoice
from thalweg.planning.request.offing_choice import (
    chosen_offing,
    restrict_passages,
    ship_dimensions,
)
from thalweg.planning.request.ordered_speed import ordered_setting
from thalweg.planning.request.requirements import derive_requirements
from thalweg.planning.request.shoal_choice import add_shoals
from thalweg.planning.request.voyage_endpoints import Endpoint, resolve_places
from thalweg.planning.seaways import Seaways
from thalweg.planning.voyage import Voyage
from thalweg.sea import Sea
from thalweg.ship import Ship


def voyage_context(
    voyage: Voyage, ship: Ship, sea: Sea, chart: Chart, choice: NetworkChoice
) -> tuple[PlanningContext, list[Endpoint]]:
    """Return the context of a voyage and its end points, after all checks of the request."""
    if choice.layered is not None:
        choice.layered.shapes(len(voyage.via) + 1)  # refuses lists of another length
    check_request(voyage, ship, sea)
    ends, chart, notes = ends_by_ways(voyage, ship, chart)
    chart, shoal_notes = add_shoals(chart, voyage, ship, sea, ends)
    notes += shoal_notes
    chart = add_traffic_schemes(chart, voyage, ship, ends)
    notes += margin_notes(chart)
    seas = partial(Seaways.of_ship_chart, chart)
    chart, far_south = exclude_ice_latitudes(chart, ends, partial(southern_limit, ends, seas))
    chart, more = add_emission_control_areas(chart, voyage, ship)
    notes += far_south
    needs = derive_requirements(voyage, ship=ship, sea=sea, chart=chart)
    ends = endpoints_within_coverage(
        ends, voyage=voyage, ship=ship, sea=sea, chart=chart, needs=needs
    )
    context = PlanningContext(
        voyage=voyage,
        ship=ship,
        sea=sea,
        chart=chart,
        needs=replace(
            needs, notes=(*notes, *more, *doubts_of_voyage(voyage, sea, ends, needs), *needs.notes)
        ),
        tables=ShipTables(performance_table_of(ship), ordered_setting(ship, voyage.speed_kn)),
        choice=choice,
    )
    return context, ends


def ends_by_ways(
    voyage: Voyage, ship: Ship, chart: Chart
) -> tuple[list[Endpoint], Chart, list[str]]:
    """Return the ends by the ways from their berths, the chart open to the ship, and notes."""
    joins = voyage.offing_nm != 0.0
    ends = resolve_places(voyage.start, voyage.via, voyage.goal, chart, joins=joins)
    ends = without_small_ways(ends, ship_dimensions(ship))
    chart, notes = exclude_closed_canals(chart, voyage, ship, ends)
    chart = restrict_passages(chart, voyage, ship, chosen_offing(voyage, ship))
    seas = partial(Seaways.of_ship_chart, chart)
    return with_chosen_ways(ends, seas, draught=float(ship.draught)), chart, notes
