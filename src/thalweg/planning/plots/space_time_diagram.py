"""Space-time (s/t) diagram: distance along the track against time, closed periods hatched."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.errors import InputError
from thalweg.core.file_writing import new_figure, save_figure
from thalweg.core.time import format_time, parse_time
from thalweg.core.units import HOUR, NAUTICAL_MILE
from thalweg.planning.plan_data import PlanData
from thalweg.planning.plots.channel_closures import Closures, default_times, find_closures
from thalweg.planning.request.requirements import required_under_keel_clearance
from thalweg.route import Route
from thalweg.sea.standard_names import WATER_LEVEL

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.planning.voyage import Voyage
    from thalweg.sea import Sea
    from thalweg.ship import Ship

_INK, _ROUTE, _WAIT = "#22303c", "#c2185b", "#f57f17"
_CLOSURE_STYLES = (
    ("shallow", "too little water", "#b0bec5", "////"),
    ("strong", "current too strong", "#ffcc80", "\\\\\\\\"),
    ("unknown", "not known", "#eceff1", ".."),
)


def draw_space_time_diagram(
    plan_or_route: PlanData | Route,
    path: str | Path | None = None,
    *,
    ship: Ship | None = None,
    sea: Sea | None = None,
    chart: Chart | None = None,
    min_ukc: float | None = None,
) -> Any:
    """Draw the distance along the track against time, with the periods in which it is closed.

    Parameters
    ----------
    plan_or_route : Plan or Route
        A plan holds its ship, sea, chart, clearance and windows; a route needs ship and sea.
    path : path, optional
        Where to save it (PNG).
    ship, sea, chart
        For a route, or instead of those of the plan.
    min_ukc : float, optional
        Least under-keel clearance [m]; by default that of the voyage or of the ship file, or 0.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If ship or sea is not given.
    """
    voyage = plan_or_route.voyage if isinstance(plan_or_route, PlanData) else None
    route = plan_or_route.best if isinstance(plan_or_route, PlanData) else plan_or_route
    known = plan_or_route.plot_context if isinstance(plan_or_route, PlanData) else None
    ship = ship or (known.ship if known else None)
    sea = sea or (known.sea if known else None)
    if ship is None or sea is None:
        raise InputError(
            "The ship or the sea of the route is not given.",
            "Closed periods depend on both; a plan returned by `plan` holds them.",
            "Give ship and sea.",
        )
    if min_ukc is None:
        min_ukc = (
            ship.min_under_keel_clearance
            if voyage is None
            else required_under_keel_clearance(voyage, ship)
        )
    closures = find_closures(
        route,
        ship=ship,
        sea=sea,
        chart=chart or (known.chart if known else None),
        min_ukc=min_ukc,
        times=_times(route, voyage),
    )
    return _draw(route, closures, voyage, min_ukc, path)


def closures_of_plan(plan: PlanData, places: int = 60, count: int = 60) -> Closures | None:
    """Return where and when the best route of a plan is closed, if the tide matters to it.

    The tide matters if depth and water level are known, and the ship waits or a part of its track
    is closed at some time around the voyage.

    Parameters
    ----------
    places, count : Approximate number of positions and times.
    """
    known, best = plan.plot_context, plan.best
    if known is None or best.min_ukc_m is None or not math.isfinite(best.arrive):
        return None
    if known.sea.members or WATER_LEVEL not in known.sea.variables:
        return None
    found = find_closures(
        best, ship=known.ship, sea=known.sea, chart=known.chart,
        min_ukc=required_under_keel_clearance(plan.voyage, known.ship), places=places,
        times=default_times(best, count),
    )  # fmt: skip
    return found if best.waiting_h > 0.0 or (found.shallow | found.strong).any() else None


def write_space_time_diagram(plan: PlanData, folder: str | Path) -> list[Path]:
    """Draw st.png in a folder if the tide matters to a plan; return the files written."""
    if closures_of_plan(plan) is None:
        return []
    path = Path(folder) / "st.png"
    draw_space_time_diagram(plan, path)
    return [path]


def _times(route: Route, voyage: Voyage | None) -> np.ndarray:
    """Return the times of the plot, extended to the windows of the voyage where these are near."""
    times = default_times(route)
    low, high = float(times[0]), float(times[-1])
    reach = high - low
    for edge in _window_limits(voyage):
        if low - reach <= edge <= high + reach:
            low, high = min(low, edge - 0.03 * reach), max(high, edge + 0.03 * reach)
    return np.linspace(low, high, len(times))


def _window_limits(voyage: Voyage | None) -> list[float]:
    if voyage is None or voyage.departure_is_open:
        return []
    latest = [] if voyage.arrive_by is None else [parse_time(voyage.arrive_by)]
    return [voyage.earliest_departure, voyage.latest_departure, *latest]


def _draw(
    route: Route,
    closures: Closures,
    voyage: Voyage | None,
    min_ukc: float,
    path: str | Path | None,
) -> Any:
    figure = new_figure(9.0, 5.6)
    axes = figure.subplots()
    hours = (closures.times - route.depart) / HOUR
    miles = closures.distance / NAUTICAL_MILE
    handles = _hatch_closures(axes, closures, hours, miles)
    handles += _draw_ship_track(axes, route)
    handles += _draw_time_windows(axes, route, voyage, float(miles[-1]), float(hours[-1]))
    axes.set_xlim(hours[0], hours[-1])
    axes.set_ylim(0.0, miles[-1])
    axes.set_xlabel(f"hours since {format_time(route.depart)}", fontsize=9)
    axes.set_ylabel("distance along the track [nm]", fontsize=9)
    title = f"Where and when the track is open, with {min_ukc:g} m under the keel"
    axes.set_title(title, fontsize=10, loc="left", color=_INK)
    axes.tick_params(labelsize=8)
    axes.grid(alpha=0.25, lw=0.4)
    figure.legend(handles=handles, loc="outside lower left", fontsize=8, ncols=4, frameon=False)
    if path is not None:
        save_figure(figure, path)
    return figure


def _hatch_closures(
    axes: Any, closures: Closures, hours: np.ndarray, miles: np.ndarray
) -> list[Any]:
    """Hatch the closed periods, each kind in its style; return the handles of the legend."""
    from matplotlib.patches import Patch

    handles = []
    for name, label, colour, hatch in _CLOSURE_STYLES:
        mask = getattr(closures, name)
        if not mask.any():
            continue
        shade = axes.contourf(
            hours, miles, mask.astype(float), levels=[0.5, 1.5], colors=[colour], hatches=[hatch],
            alpha=0.75, zorder=1,
        )  # fmt: skip
        shade.set_edgecolor("#78909c")
        shade.set_linewidth(0.0)
        handles.append(Patch(facecolor=colour, edgecolor="#78909c", hatch=hatch, label=label))
    return handles


def _draw_ship_track(axes: Any, route: Route) -> list[Any]:
    """Draw the distance of the ship over time, with its waits."""
    hours = (route.samples["time"] - route.depart) / HOUR
    miles = route.samples["distance"] / NAUTICAL_MILE
    handles = axes.plot(hours, miles, color=_ROUTE, lw=1.8, zorder=4, label="ship")
    waits = np.flatnonzero(route.track.wait > 0.0)
    if not waits.size:
        return list(handles)
    reached = cumulative_sums(route.legs["length"]) / NAUTICAL_MILE
    arrive = np.concatenate([[route.depart], route.legs["arrive"]])
    for k in waits:
        span = (np.array([arrive[k], arrive[k] + route.track.wait[k]]) - route.depart) / HOUR
        (line,) = axes.plot(
            span, [reached[k]] * 2, color=_WAIT, lw=4.0, solid_capstyle="butt", zorder=5,
            label=f"waits {route.waiting_h:.2f} h in total",
        )  # fmt: skip
    return [*handles, line]


def _draw_time_windows(
    axes: Any, route: Route, voyage: Voyage | None, end: float, last_hour: float
) -> list[Any]:
    """Draw the departure window, and the latest arrival where it is before the last hour."""
    if voyage is None or voyage.departure_is_open:
        return []
    handles = []
    first, last = voyage.earliest_departure, voyage.latest_departure
    if last > first:
        span = [(t - route.depart) / HOUR for t in (first, last)]
        handles += axes.plot(
            span, [0.0, 0.0], color="#2e7d32", lw=7.0, solid_capstyle="butt", zorder=3,
            label="departure window", clip_on=False,
        )  # fmt: skip
    if voyage.arrive_by is not None:
        hour = (parse_time(voyage.arrive_by) - route.depart) / HOUR
        if hour <= last_hour:
            handles += axes.plot(
                [hour, hour], [0.0, end], color=_INK, lw=1.2, ls="--", zorder=3, label="arrive by"
            )
    return handles
