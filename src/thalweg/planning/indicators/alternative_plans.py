"""Alternatives of a voyage: a few routes that differ, each the best in something."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any, Final

from thalweg.chart import Chart
from thalweg.chart.coast.gshhg import usual_resolution
from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.file_writing import make_folder, write_csv_rows, write_text
from thalweg.core.units import HOUR
from thalweg.network.history.history_corridor import HistoryCorridor
from thalweg.planning.indicators.candidate_routes import (
    STOPPED,
    berth_to_berth_candidates,
    longest_notes,
)
from thalweg.planning.indicators.route_choices import (
    SLOWER,
    RouteChoice,
    name_with_limits,
    named_routes,
)
from thalweg.planning.indicators.route_differences import line_at_shares, lines_differ
from thalweg.planning.indicators.route_figures import (
    all_figures,
    champions,
    compared_values,
)
from thalweg.planning.indicators.ways_not_offered import fastest_without_canals, unchosen_notes
from thalweg.planning.pareto.indicator_limit import IndicatorLimit
from thalweg.planning.report.filled_weather import filled_waves_note
from thalweg.planning.report.land_report import NEAREST_LAND
from thalweg.planning.report.note_order import notes_of_routes
from thalweg.planning.report.provenance import route_warnings
from thalweg.planning.request.coverage_check import check_argument_types
from thalweg.planning.request.network_choice import (
    NetworkBuilder,
    NetworkChoice,
    history_corridor,
)
from thalweg.planning.request.ordered_speed import with_order
from thalweg.planning.request.voyage_objective import priced_objective, with_voyage_prices
from thalweg.planning.voyage import Voyage
from thalweg.planning.voyage_context import voyage_context
from thalweg.route import Route, RouteFileOptions, with_wind_speed, write_route_files
from thalweg.route.formats import remove_route_files
from thalweg.sea import Sea
from thalweg.ship import Ship
from thalweg.ship.condition_variables import WAVES

_MOST: Final = 5  # routes
#: Their best routes are always chosen, also where they sail the way of a faster one.
_MAIN_FIGURES: Final = ("time", "fuel", "cost", "sick_percent")


@dataclass(frozen=True, eq=False)
class AlternativePlans:
    """Routes of a voyage that differ, the fastest first.

    Attributes
    ----------
    voyage : The request.
    choices : 1 to 5 routes.
    slack_h : Time to the latest arrival of the voyage for each [h]; None without one.
    notes : What was assumed, and which candidates could not be found.
    ends : Names of start and goal.
    cancelled : Whether Ctrl-C ended the search for candidates.
    chart : That of the map; None for none.
    """

    voyage: Voyage
    choices: tuple[RouteChoice, ...]
    slack_h: tuple[float | None, ...]
    notes: tuple[str, ...]
    ends: tuple[str, str]
    cancelled: bool = False
    chart: Chart | None = field(default=None, repr=False, compare=False)

    def rows(self) -> list[dict[str, Any]]:
        """Return one row for each route.

        Returns
        -------
        list of dict
            Names, words and all indicators with their units; None where unknown.
        """
        return [
            {
                "name": one.name,
                "best_in": ", ".join(one.best_in),
                "difference": one.difference,
                "passes": ", ".join(one.passes),
                "canals": ", ".join(one.canals),
                "canal_dues_usd": one.canal_dues_usd,
                "slack_h": slack,
                **all_figures(one.route),
            }
            for one, slack in zip(self.choices, self.slack_h)
        ]

    def to_dict(self) -> dict[str, Any]:
        """Return plain data, ready for JSON.

        Returns
        -------
        dict
            The voyage, the routes with their figures, and the notes.
        """
        return {
            "voyage": self.voyage.to_dict(),
            "alternatives": [one.to_dict() for one in self.choices],
            "slack_h": list(self.slack_h),
            "notes": list(self.notes),
        }

    def write(self, folder: str | Path, options: RouteFileOptions | None = None) -> list[Path]:
        """Write alternatives.json, alternatives.csv, map.png and the route files of each.

        Parameters
        ----------
        folder : path
            Made where it does not exist. Files of alternatives of an earlier plan with more of
            them are removed.
        options : RouteFileOptions, optional
            Formats and waypoints of the route files.

        Returns
        -------
        list of Path
        """
        folder = make_folder(folder)
        text = json.dumps(self.to_dict(), indent=2, allow_nan=False)
        write_text(folder / "alternatives.json", text + "\n")
        rows = self.rows()
        names = list(dict.fromkeys(name for row in rows for name in row))
        table: list[list[Any]] = [names, *([row.get(name) for name in names] for row in rows)]
        write_csv_rows(folder / "alternatives.csv", table)
        files = [folder / "alternatives.json", folder / "alternatives.csv"]
        if self.chart is not None:
            from thalweg.planning.plots.alternatives_map import draw_alternatives_map

            names = [one.name for one in self.choices]
            routes = [one.route for one in self.choices]
            files.append(folder / "map.png")
            draw_alternatives_map(routes, names, self.chart, self.ends, files[-1])
        for number, one in enumerate(self.choices, start=1):
            files += write_route_files(one.route, folder, f"alternative_{number}", options)
        for number in range(len(self.choices) + 1, _MOST + 1):
            remove_route_files(folder, f"alternative_{number}")
        return files

    def __str__(self) -> str:
        lines = []
        for number, one in enumerate(self.choices, start=1):
            best = f" [{', '.join(one.best_in)}]" if one.best_in else ""
            lines.append(f"{number}. {one.name}{best}: {one.difference}")
            names = [*one.canals, *map(name_with_limits, one.passes)]
            if names:
                lines.append(f"   passes {', '.join(names)}")
        return "\n".join(lines)


def alternative_plans(
    voyage: Voyage,
    *,
    ship: Ship,
    sea: Sea,
    chart: Chart | None = None,
    network: str | NetworkBuilder | HistoryCorridor = "auto",
    resolution: float | None = None,
    progress: Callable[[str], None] | None = None,
    most: int = 5,
) -> AlternativePlans:
    """Plan a voyage for several objectives and by several ways, and choose routes that differ.

    Parameters
    ----------
    voyage : Voyage
        The request; its objective is not used.
    ship, sea, chart, network, resolution, progress
        As for `plan`.
    most : int
        Greatest number of routes, 2 to 5.

    Returns
    -------
    AlternativePlans

    Raises
    ------
    InputError
        If ``most`` is out of range, for an ensemble forecast, a network of historic routes, or an
        arrival without a departure; and as `plan`.
    CoverageError
        As `plan`.
    NoRouteError
        If the voyage has no route at all, or none within its limits.

    Notes
    -----
    Candidates are the fastest route, refined in open water; the best of the network in cost,
    fuel, comfort, encounters, length near land and distance, as far as they are known for this
    ship and chart (for cost and fuel also the fastest route at one lower speed), the knees of
    their fronts with time, and the best by a weighted sum; and at the speed of the fastest route
    the shortest ways round islands, by and round named passages and farther off
    land, straightened. All share one network and one sea for each set of open canals. Chosen are
    the best in one figure after the other that differ from those chosen before, in water or time,
    and the fastest without each canal of the fastest route, however long it takes. Notes say why a
    way without a canal or passage is not offered.
    """
    chart = Chart.gshhg(usual_resolution()) if chart is None else chart
    check_argument_types(voyage, ship, sea, chart)
    _check_request(voyage, sea, network, most)
    limits = IndicatorLimit.of_voyage(voyage)
    ship = with_order(with_voyage_prices(ship, voyage), voyage)
    if voyage.min_ukc_m is not None:
        ship = ship.with_clearance(voyage.min_ukc_m)
    assert not isinstance(network, HistoryCorridor)  # refused above
    choice = NetworkChoice(network, resolution, voyage.layered)
    context, ends = voyage_context(
        _request(voyage, ship, sea), ship, with_wind_speed(ship, sea), chart, choice
    )
    context = replace(context, report_progress=progress or context.report_progress)
    routes, notes = berth_to_berth_candidates(context, ends)
    kept = _kept(routes, limits)
    chosen = _chosen(kept, most, context.chart)
    notes += longest_notes(context, routes)
    notes += unchosen_notes(context.chart, routes, chosen, partial(_broken, limits))
    warnings = [
        [note for note in route_warnings(context, one) if not note.startswith(NEAREST_LAND)]
        for one in chosen
    ]  # the nearest land of each is a key figure
    filled = filled_waves_note(chosen, context.sea)
    notes += [filled] if filled else []
    notes = notes_of_routes([*(end.note for end in ends if end.note), *notes], warnings)
    latest = context.latest_arrival
    slack = [(latest - one.arrive) / HOUR if math.isfinite(latest) else None for one in chosen]
    return AlternativePlans(
        voyage,
        named_routes(chosen, kept, context.chart, ship.file.hull),
        tuple(slack),
        tuple(notes),
        (ends[0].true_name, ends[-1].true_name),
        any(note.startswith(STOPPED) for note in notes),
        context.chart,
    )


def _check_request(
    voyage: Voyage, sea: Sea, network: str | NetworkBuilder | HistoryCorridor, most: int
) -> None:
    """Refuse what alternatives cannot be planned for."""
    if not 2 <= most <= _MOST:
        raise InputError(
            f"{most} alternatives were requested.",
            "There are 2 to 5.",
            "Give such a number.",
            field="most",
        )
    if sea.members or voyage.ensemble is not None:
        raise InputError(
            "Alternatives were requested in an ensemble forecast.",
            "Their key figures are compared in one forecast.",
            "Give one member of it.",
            field="sea",
        )
    if voyage.arrive is not None and voyage.departure_is_open:
        raise InputError(
            "Alternatives were requested for an arrival without a departure.",
            "They depart at one time and arrive at different ones.",
            "Give the departure, and the arrival as the latest one.",
            field="arrive",
        )
    if history_corridor(network) is not None:
        raise InputError(
            "Alternatives were requested in the water that ships usually use.",
            "They are ways that differ, on a network of their own.",
            "Leave the network out; 'thalweg history compare' compares the usual route with the "
            "best.",
            field="network",
        )


def _request(voyage: Voyage, ship: Ship, sea: Sea) -> Voyage:
    """Return the voyage with an objective of which all settings of the ship are searched."""
    moves = bool(ship.file.places) and sea.variables >= WAVES  # a limit that needs these waves
    request = replace(
        voyage,
        objective="weighted",
        weights={"time": 1.0, "fuel": 1.0},
        at_most={"sick_percent": 100.0} if moves else {},
        at_least={},
        arrive=None,
        arrive_by=voyage.arrive if voyage.arrive_by is None else voyage.arrive_by,
    )
    try:
        priced_objective(request, ship)
    except InputError:  # her fuel is not known
        return replace(request, weights={"time": 1.0})
    return request


def _kept(routes: list[Route], limits: Sequence[IndicatorLimit]) -> list[Route]:
    """Return the routes that keep limits of the voyage.

    Raises
    ------
    NoRouteError : If none does, with the limit that is broken by all or most.
    """
    kept = [route for route in routes if not any(one.excess(route) for one in limits)]
    if kept:
        return kept
    nearest = min(routes, key=lambda route: sum(one.excess(route) > 0.0 for one in limits))
    broken = _broken(limits, nearest)
    asked = f"None of {len(routes)} routes keeps the limits of the voyage."
    raise NoRouteError(asked, f"The nearest breaks: {broken}.", "Relax the limits.", reasons={})


def _broken(limits: Sequence[IndicatorLimit], route: Route) -> str:
    """Return which limits a route breaks, as text; empty for none."""
    return ", ".join(one.text(route) for one in limits if one.excess(route) > 0.0)


def _chosen(routes: Sequence[Route], most: int, chart: Chart) -> list[Route]:
    """Return routes that differ, the best in one figure after the other, the fastest first.

    The fastest without each canal of the fastest route are among them.
    """
    values = [compared_values(route) for route in routes]
    best = champions(values)
    order = list(dict.fromkeys([best.get("time", 0), *best.values()]))
    lines = [line_at_shares(route) for route in routes]
    main = [best[name] for name in _MAIN_FIGURES if name in best]
    round_canals = [routes.index(one) for _, one in fastest_without_canals(routes, chart)]
    found = list(dict.fromkeys([order[0], *round_canals] if round_canals else []))[:most]
    for same_way_too, among in ((True, main), (False, order), (True, order)):
        for k in among:
            if len(found) == most or k in found:
                continue
            apart = all(lines_differ(lines[k], lines[j]) for j in found)
            slower = all(
                lines_differ(lines[k], lines[j])
                or abs(routes[k].time_h / routes[j].time_h - 1.0) > SLOWER
                for j in found
            )
            if apart or (same_way_too and slower):
                found.append(k)
    chosen = sorted((routes[k] for k in found), key=lambda route: route.time_h)
    good = {0, *champions([compared_values(route) for route in chosen]).values()}
    good |= {k for k, one in enumerate(chosen) if any(one is routes[j] for j in round_canals)}
    return [route for k, route in enumerate(chosen) if k in good]  # others are best in nothing
