"""A plan in a few lines for the person who sails it."""

from __future__ import annotations

import html
import math
from typing import TYPE_CHECKING

import numpy as np

from thalweg.core.geodesy import format_position_minutes
from thalweg.core.time import duration_text, utc_text
from thalweg.core.units import HOUR, KNOT
from thalweg.kernels.codes import OUTSIDE_PERIOD, REASONS
from thalweg.planning.plan_front import knee
from thalweg.planning.request.voyage_endpoints import CHECK_POSITION

if TYPE_CHECKING:
    from thalweg.chart.canals import Canal
    from thalweg.planning.plan_data import PlanData
    from thalweg.route import Route

MAX_LINES = 12  #: of a summary with its notes
_WAVES = "sea_surface_wave_significant_height"
_WIND = ("eastward_wind", "northward_wind")
_CURRENT = ("eastward_sea_water_velocity", "northward_sea_water_velocity")
_NAMES = (_WAVES, *_WIND, *_CURRENT)
#: Notes whose contents the summary states in its own lines.
_STATED = ("No depth in the data",)
_HELD = {"speed": "speed through water", "power": "power", "ground": "speed over ground"}
_LEAST = {"comfort": "least motion sickness"}
#: Notes on the safety of the ship come first.
_CHECK_DEPTH = "Check the depth"
_FIRST = (CHECK_POSITION, _CHECK_DEPTH)
_ALWAYS = ("land", "no-go zone")  # reasons that every coastal route meets


def plan_summary(plan: PlanData) -> list[str]:
    """Return the plan in at most ten lines, notes not included.

    Returns
    -------
    list of str : The first line names the places, the others begin with a word on their contents.
    """
    return [_title(plan), *(f"{name:<9} {text}" for name, text in summary_items(plan))]


def summary_with_notes(plan: PlanData, lines: int = MAX_LINES) -> list[str]:
    """Return the summary and as many notes as fit into a number of lines."""
    found = plan_summary(plan)
    notes = [note for note in plan.notes if not note.startswith(_STATED)]
    notes.sort(key=lambda note: not note.startswith(_FIRST))
    room = max(1, lines - len(found))
    shown = notes[:room]
    if len(shown) < len(notes):
        shown[-1] += f" ({len(notes) - len(shown)} more notes: --verbose, plan.notes)"
    return found + [f"Note      {note}" for note in shown]


def summary_items(plan: PlanData) -> list[tuple[str, str]]:
    """Return the lines of the summary as pairs of a word and a text."""
    best = plan.best
    items = [("Depart", utc_text(best.depart)), ("Arrive", _arrival(best))]
    items += [("Distance", _distance(plan)), ("Fuel", _fuel(best)), ("Cost", _cost(plan))]
    if plan.voyage.objective == "energy" and best.energy_mwh is not None:
        items.append(("Energy", f"{best.energy_mwh:,.2f} MWh"))
    if plan.front is not None and len(plan.routes) > 1:
        items.append(("Choice", _choice(plan)))
    items += [
        ("Weather", worst_weather(plan) + sickness_text(best)),
        ("Depth", least_clearance_text(best)),
    ]
    items += [("Limits", limits_text(plan)), ("Quality", quality_text(plan))]
    return items


def summary_html(plan: PlanData) -> str:
    """Return the summary as an HTML table for notebooks."""
    rows = "".join(
        f"<tr><th style='text-align:left'>{html.escape(name)}</th>"
        f"<td style='text-align:left'>{html.escape(text)}</td></tr>"
        for name, text in [*summary_items(plan), *(("Note", note) for note in plan.notes)]
    )
    return f"<table><caption>{html.escape(_title(plan))}</caption>{rows}</table>"


def one_line(plan: PlanData) -> str:
    """Return the plan in one line, such as ``<Plan: Hull to Bergen, 40.2 h, 512.0 nm>``."""
    best = plan.best
    totals = f"{best.time_h:.2f} h, {best.distance_nm:.1f} nm"
    state = "" if best.feasible else ", breaks a limit"
    routes = f", {len(plan.routes)} routes" if len(plan.routes) > 1 else ""
    return f"<Plan: {_title(plan)}, {totals}{routes}{state}>"


def worst_weather(plan: PlanData) -> str:
    """Return the highest waves, or the strongest wind or current, with place and time."""
    route, weather = plan.best, _weather_on_route(plan)
    waves = weather.get(_WAVES)
    wind, current = (_speed(weather, pair) for pair in (_WIND, _CURRENT))
    if waves is not None and np.nanmax(waves, initial=0.0) > 0.0:
        at = int(np.nanargmax(waves))
        more = "" if wind is None else f", wind {wind[at]:.0f} kn"
        return f"waves {waves[at]:.1f} m{more} {_place(route, at)}"
    for values, word in ((wind, "wind"), (current, "current")):
        if values is not None and np.nanmax(values, initial=0.0) > 0.0:
            at = int(np.nanargmax(values))
            return f"{word} {values[at]:.{0 if word == 'wind' else 1}f} kn {_place(route, at)}"
    return "calm or not known: no wind, waves or currents in the data"


def sickness_text(route: Route) -> str:
    """Return the share of people sick at each place of the ship; empty where it has none."""
    found = route.indicators
    places = [
        f"{name} {row['sick_percent']:.0f} %"
        for name, row in found["places"].items()
        if row["sick_percent"] is not None
    ]
    roll = found.get("max_roll_rms_deg")
    rolling = "" if roll is None else f"; roll to {roll:.1f} deg (root mean square)"
    return f"; sick: {', '.join(places)}{rolling}" if places else ""


def _weather_on_route(plan: PlanData) -> dict[str, np.ndarray]:
    """Return waves, wind and current along the best route, as far as the sea has them.

    The referee samples what the ship model needs; the rest comes from the sea of the plan.
    """
    samples = plan.best.samples
    found = {name: np.asarray(samples[name]) for name in _NAMES if name in samples}
    sea = plan.plot_context.sea if plan.plot_context is not None else None
    if sea is None or sea.members:
        return found
    more = [name for name in _NAMES if name not in found and name in sea.variables]
    if more:
        time = np.where(np.isfinite(samples["time"]), samples["time"], plan.best.depart)
        found |= sea.sample(more, time, samples["lat"], samples["lon"])
    return found


def least_clearance_text(route: Route) -> str:
    """Return the least under-keel clearance with place and time, or that depth is not known."""
    least, clearance = route.min_ukc_m, route.samples["under_keel_clearance"]
    if least is None:
        return "not known: no depth in the data"
    if not np.isfinite(clearance).any():
        return f"least under-keel clearance {least:.1f} m"
    at = int(np.nanargmin(clearance))
    where = f" {_place(route, at)}" if clearance[at] <= least + 0.05 else ""
    return f"least under-keel clearance {least:.1f} m{where}"


def limits_text(plan: PlanData) -> str:
    """Return the limit that the route violates, or the limits that closed other water."""
    if plan.best.violations:
        first, more = plan.best.violations[0], len(plan.best.violations) - 1
        return f"NOT KEPT: {first}" + (f", and {more} more" if more else "")
    if not plan.best.feasible:
        return "NOT KEPT: the route cannot be sailed to its end"
    met = [r for r, count in sorted(plan.rejections.items(), key=lambda item: -item[1]) if count]
    ignored = _ALWAYS if _has_weather(plan) else (*_ALWAYS, REASONS[OUTSIDE_PERIOD])
    met = [reason for reason in met if reason not in ignored]
    kept = _kept_text(plan)
    if not met:
        only = "; nothing but land and zones stood in the way" if plan.rejections else ""
        return kept + only
    return f"{kept}; other water was closed by: {', '.join(met[:3])}"


def _kept_text(plan: PlanData) -> str:
    """Return that all limits are kept, or which, where the depth is not known."""
    if plan.best.min_ukc_m is not None:
        return "all kept"
    checked = ["land", "zones"]
    limits = plan.plot_context.ship.limits if plan.plot_context is not None else None
    if limits is not None:
        named = (("waves", limits.wave_height), ("wind", limits.wind_speed))
        checked += [what for what, limit in named if math.isfinite(limit)]
    shallow = any(note.startswith(_CHECK_DEPTH) for note in plan.notes)
    depth = "TOO SHALLOW by the depth layer, see the note" if shallow else "NOT checked"
    return f"kept: {', '.join(checked)}; depth under the keel {depth}"


def quality_text(plan: PlanData) -> str:
    """Return how far the best route can be from the best possible one, or why that is unknown."""
    early = "stopped early; " if plan.cancelled else ""
    if not plan.best.feasible:
        return f"{early}not stated: the route breaks a limit"
    if plan.voyage.arrive is not None and math.isnan(plan.proof.certain):
        return "not stated: the times are given, and the speed over ground follows from them"
    if not plan.gap < 1.0:
        why = plan.proof.kind if plan.proof.kind.startswith("no bound") else "no bound was found"
        return f"{early}{why}"
    excess = plan.gap / (1.0 - plan.gap)  # of the route over the bound
    return f"{early}at most {_percent(excess)} % from the best possible"


def _percent(share: float) -> str:
    """Return a share in per cent, rounded up to a tenth, as it bounds something."""
    return f"{max(0.1, math.ceil(1000.0 * share - 1e-6) / 10.0):.1f}"


def _title(plan: PlanData) -> str:
    start, goal = (plan.provenance.get(key) or "?" for key in ("from", "to"))
    objective = plan.voyage.objective
    what = (
        "time against " + plan.front.criterion
        if (objective == "front" and plan.front is not None)
        else _LEAST.get(objective, f"least {objective}")
    )
    if plan.voyage.arrive is not None:
        at = utc_text(float(plan.voyage.arrive))  # type: ignore[arg-type]
        if objective in ("time", "distance"):
            held = _HELD[plan.voyage.hold or "power"]
            what = f"lowest {held}" if plan.voyage.depart is not None else "latest departure"
        what += f", to arrive at {at}"
    return f"{start} to {goal}, {what}"


def _arrival(route: Route) -> str:
    if not math.isfinite(route.arrive):
        return "never: the route cannot be sailed to its end"
    waits = f", of it waiting {duration_text(route.waiting_h * HOUR)}" if route.waiting_h else ""
    return f"{utc_text(route.arrive)}, after {duration_text(route.arrive - route.depart)}{waits}"


def _distance(plan: PlanData) -> str:
    route = plan.best
    sailing = route.time_h - route.waiting_h
    mean = f", mean speed {route.distance_nm / sailing:.1f} kn" if sailing > 0.0 else ""
    canals = [canal.title for canal in canals_passed(plan)]
    return f"{route.distance_nm:,.1f} nm{mean}" + (f", by {' and '.join(canals)}" if canals else "")


def canals_passed(plan: PlanData) -> list[Canal]:
    """Return the canals that the best route passes, in order."""
    if plan.plot_context is None:
        return []
    chart, track = plan.plot_context.chart, plan.best.track
    lat, lon = np.asarray(track.lat), np.asarray(track.lon)
    number = np.asarray(chart.canal_of_legs(lat[:-1], lon[:-1], lat[1:], lon[1:]))
    return [chart.canals[k] for k in number[number >= 0].tolist()]


def _fuel(route: Route) -> str:
    if route.fuel_t is None:
        return "not known: the ship file has no fuel"
    inside = route.fuel_eca_t
    areas = f", of it {inside:,.1f} t in emission control areas" if inside else ""
    return f"{route.fuel_t:,.1f} t{areas}"


def _cost(plan: PlanData) -> str:
    route, canals = plan.best, canals_passed(plan)
    dues = sum(canal.fee for canal in canals)
    basis = " and ".join(dict.fromkeys(canal.fee_basis for canal in canals if canal.fee_basis))
    basis = f" (by {basis})" if basis else ""
    if route.cost is None:
        paid = f"; canal dues {dues:,.0f} USD{basis}" if dues else ""
        return f"not known: no price of fuel or time{paid}"
    counted = route.currency == "USD"
    paid = (
        f", {'of it ' if counted else 'without '}canal dues {dues:,.0f} USD{basis}" if dues else ""
    )
    return f"{route.cost:,.0f} {route.currency}{paid}"


def _choice(plan: PlanData) -> str:
    """Return the ends of a front and its knee."""
    front = plan.front
    assert front is not None  # checked by the caller
    time = np.array([route.time_h for route in plan.routes])
    order = np.argsort(time)
    chosen = {
        int(order[0]): "fastest",
        int(order[-1]): _LEAST.get(front.criterion, f"least {front.criterion}"),
    }
    chosen.setdefault(int(order[knee(time[order], front.values[order])]), "between")
    digits = 0 if float(front.values.max()) >= 1e4 else 1
    texts = [
        f"{word} {time[k]:.1f} h {front.values[k]:,.{digits}f} {front.unit}"
        for k, word in sorted(chosen.items(), key=lambda item: time[item[0]])
    ]
    return "; ".join(texts)


def _has_weather(plan: PlanData) -> bool:
    """Return whether the data have wind, waves or currents."""
    weather = _weather_on_route(plan).values()
    return any(np.nanmax(np.abs(values), initial=0.0) > 0.0 for values in weather)


def _speed(weather: dict[str, np.ndarray], pair: tuple[str, str]) -> np.ndarray | None:
    if not all(name in weather for name in pair):
        return None
    return np.asarray(np.hypot(*(weather[name] for name in pair)) / KNOT)


def _place(route: Route, at: int) -> str:
    samples = route.samples
    where = format_position_minutes(float(samples["lat"][at]), float(samples["lon"][at]))
    return f"at {where} on {utc_text(float(samples['time'][at]))}"
