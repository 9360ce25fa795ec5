"""A plan in a few lines for the person who sails it."""

from __future__ import annotations

import html
import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from thalweg.chart.depth.closed_shoals import CLOSED_SHOALS
from thalweg.core.time import utc_text
from thalweg.kernels.codes import NO_GO, OUTSIDE_PERIOD, REASONS, SHIP_RANGE
from thalweg.planning.plan_front import least_words, not_rising, words_of_points
from thalweg.planning.report.ice_report import SOUTH_LEFT_OUT
from thalweg.planning.report.note_order import count_of_dangers, danger_first
from thalweg.planning.report.route_summary import (
    arrival_text,
    canals_passed,
    cost_text,
    distance_text,
    fuel_text,
    kept_text,
    least_clearance_text,
    sickness_text,
    weather_on_route,
    weather_text,
)
from thalweg.planning.request.chart_restrictions import EXCLUDED_BY_DUES, IN_WATER
from thalweg.route.indicator_columns import indicator_value
from thalweg.route.number_texts import amount_column, amount_text, hours_texts
from thalweg.ship.ship_assumptions import NO_DEPTH

if TYPE_CHECKING:
    from thalweg.planning.plan_data import PlanData
    from thalweg.planning.plan_front import ParetoFront
    from thalweg.sea import Sea

MAX_LINES = 12  #: of a summary with its notes
#: Notes whose contents the summary states in its own lines.
_STATED = (NO_DEPTH,)
_HELD = {"speed": "speed through water", "power": "power", "ground": "speed over ground"}
_TENTH: Final = 0.1  # by which waves in another member are higher to be named [m]
_WEAK: Final = 0.5  # gap from which a bound says little of a route
_CLEARLY_LESS: Final = 0.01  # of a gap, for which another one is stated beside it
#: Of key figures in sentences on how much less of them is possible.
_FIGURE_WORDS: Final = {
    "co2": "CO2",
    "comfort": "motion sickness dose",
    "inshore": "length near land",
    "weighted": "weighted sum",
    "front": "time",
}
_ALWAYS = ("land", "no-go zone")  # reasons that every coastal route meets
_OF_WEATHER = (
    REASONS[OUTSIDE_PERIOD],
    REASONS[SHIP_RANGE],
)  # not named where the sea has no weather


def plan_summary(plan: PlanData) -> list[str]:
    """Return the plan in at most ten lines, notes not included.

    Returns
    -------
    list of str : The first line names the places, the others begin with a word on their contents.
    """
    return [_title(plan), *(f"{name:<9} {text}" for name, text in summary_items(plan))]


def summary_with_notes(plan: PlanData, lines: int = MAX_LINES) -> list[str]:
    """Return the summary, all notes on danger, and as many others as fit into a number of lines."""
    found = plan_summary(plan)
    return found + notes_lines(plan.notes, lines - len(found), where="--verbose, plan.notes")


def notes_lines(notes: Sequence[str], room: int, where: str = "--verbose") -> list[str]:
    """Return as many notes as fit into a number of lines, one at least, and how many are left.

    All notes on danger are returned, first, whatever the number of lines.
    """
    notes = danger_first(note for note in notes if not note.startswith(_STATED))
    shown = notes[: max(1, room, count_of_dangers(notes))]
    if len(shown) < len(notes):
        more = len(notes) - len(shown)
        shown[-1] += f" ({more} more {'note' if more == 1 else 'notes'}: {where})"
    return [f"Note      {note}" for note in shown]


def summary_items(plan: PlanData) -> list[tuple[str, str]]:
    """Return the lines of the summary as pairs of a word and a text."""
    best = plan.best
    known = plan.plot_context
    canals = canals_passed(best, None if known is None else known.chart)
    items = [("Depart", utc_text(best.depart)), ("Arrive", arrival_text(best))]
    items += [("Distance", distance_text(best, canals)), ("Fuel", fuel_text(best))]
    items.append(("Cost", cost_text(best, canals)))
    if plan.ensemble:
        items.append(
            ("Members", members_text(_row_of_best(plan), best.currency, plan.voyage.ensemble))
        )
    if plan.voyage.objective == "energy" and best.energy_mwh is not None:
        items.append(("Energy", amount_text(best.energy_mwh, "MWh")))
    if plan.front is not None and len(plan.routes) > 1:
        items.append(("Choice", _choice(plan)))
    items += [
        (
            "Weather",
            weather_text(best, _sea(plan))
            + _waves_of_members(plan)
            + sickness_text(best, known.ship if known else None),
        ),
        ("Depth", least_clearance_text(best)),
    ]
    items += [("Limits", limits_text(plan)), ("Quality", quality_text(plan))]
    return items


def summary_html(plan: PlanData) -> str:
    """Return the summary as an HTML table for notebooks."""
    rows = "".join(
        f"<tr><th style='text-align:left'>{html.escape(name)}</th>"
        f"<td style='text-align:left'>{html.escape(text)}</td></tr>"
        for name, text in [
            *summary_items(plan),
            *(("Note", note) for note in danger_first(plan.notes)),
        ]
    )
    return f"<table><caption>{html.escape(_title(plan))}</caption>{rows}</table>"


def one_line(plan: PlanData) -> str:
    """Return the plan in one line, such as ``<Plan: Hull to Bergen, 40.2 h, 512.0 nm>``."""
    best = plan.best
    totals = f"{best.time_h:.2f} h, {best.distance_nm:.1f} nm"
    state = "" if best.feasible else ", breaks a limit"
    routes = f", {len(plan.routes)} routes" if len(plan.routes) > 1 else ""
    return f"<Plan: {_title(plan)}, {totals}{routes}{state}>"


def limits_text(plan: PlanData) -> str:
    """Return the limit that the route violates, or the limits that closed other water."""
    if plan.ensemble and _row_of_best(plan)["infeasible"]:
        row = _row_of_best(plan)
        return (
            f"NOT KEPT in {_members(row['infeasible'])} ({len(row['infeasible'])} of "
            f"{row['members']}): {row['first_reason']}"
        )
    if plan.best.violations:
        first, more = plan.best.violations[0], len(plan.best.violations) - 1
        return f"NOT KEPT: {first}" + (f", and {more} more" if more else "")
    if not plan.best.feasible:
        return "NOT KEPT: the route cannot be sailed to its end"
    met = [r for r, count in sorted(plan.rejections.items(), key=lambda item: -item[1]) if count]
    ignored = _ALWAYS if _has_weather(plan) else (*_ALWAYS, *_OF_WEATHER)
    met = [reason for reason in met if reason not in ignored]
    known = plan.plot_context
    kept = kept_text(plan.best, None if known is None else known.ship, plan.notes)
    if not met:
        only = "; nothing but land and zones stood in the way" if plan.rejections else ""
        return kept + only
    if known is not None and known.chart.zones.closed_shoals is not None:
        met = [f"{reason} or shoal" if reason == REASONS[NO_GO] else reason for reason in met]
    return f"{kept}; other ways were refused for: {', '.join(met[:3])}"


def members_text(row: Mapping[str, Any], currency: str, measure: str | None = None) -> str:
    """Return the mean and the spread of a route over the members of an ensemble.

    Parameters
    ----------
    row : Of `Plan.ensemble`.
    currency : Of the cost.
    measure : By which the route was chosen; with "cvar" the mean of the worst tenth follows.
    """
    kept = row["members"] - len(row["infeasible"])
    here = f"the other lines are those of member {row['shown_member']}"
    if row["time_h"] is None:
        return f"the route keeps the limits in none of {row['members']}; {here}"
    of = f"{kept} of {row['members']} that keep the limits" if row["infeasible"] else f"all {kept}"
    parts = []
    for name, unit in (("time_h", "h"), ("fuel_t", "t"), ("cost", currency)):
        spread = row[name]
        if spread is not None:
            column = amount_column([spread[k] for k in ("p10", "mean", "p90", "cvar")], unit)
            low, mean, high, worst = column.texts
            tail = f"; worst tenth {worst}" if measure == "cvar" else ""
            parts.append(f"{name.split('_')[0]} {mean} {column.unit} ({low} to {high}{tail})")
    return f"mean of {of}, with 10 and 90 %: {', '.join(parts)}; {here}"


def _waves_of_members(plan: PlanData) -> str:
    """Return the highest waves of the worst member, where it is not the one that is shown."""
    row = _row_of_best(plan) if plan.ensemble else {}
    waves = {k: height for k, height in enumerate(row.get("highest_waves_m", ())) if height}
    worst = max(waves, key=lambda k: waves[k], default=None)
    if worst is None or waves[worst] < waves.get(row["shown_member"], 0.0) + _TENTH:
        return ""
    return f"; in member {worst} waves of up to {waves[worst]:.1f} m"


def _row_of_best(plan: PlanData) -> Mapping[str, Any]:
    """Return the distribution of the best route over the members."""
    best = next((k for k, route in enumerate(plan.routes) if route is plan.best), 0)
    return plan.ensemble[min(best, len(plan.ensemble) - 1)]


def _members(numbers: Sequence[int]) -> str:
    word = "member" if len(numbers) == 1 else "members"
    return f"{word} {', '.join(map(str, numbers))}"


def quality_text(plan: PlanData) -> str:
    """Return how much better than the best route is possible at most, or why that is unknown."""
    early = "stopped early; " if plan.cancelled else ""
    if not plan.best.feasible:
        return f"{early}not stated: the route breaks a limit"
    other_speeds = _other_speeds(plan)
    if plan.voyage.arrive is not None and math.isnan(plan.proof.certain):
        why = "not stated: the times are given, and the speed over ground follows from them"
        return f"{why}{other_speeds}"
    if not plan.gap < 1.0:
        why = plan.proof.kind if plan.proof.kind.startswith("no bound") else "no bound was found"
        return f"{early}{why}{other_speeds}"
    figure = _figure_words(plan.voyage.objective)
    if plan.gap > _WEAK:
        least = math.floor(100.0 * (1.0 - plan.gap) + 1e-9)
        return (
            f"{early}little is proved: the least possible {figure} is between {least} and 100 % "
            f"of this{other_speeds}"
        )
    deep = ""
    if CLOSED_SHOALS in plan.proof.kind:
        deep = " outside the shoal water that is closed here"
    closed = [note for note in plan.notes if note.startswith(EXCLUDED_BY_DUES)]
    names = [note.removeprefix(EXCLUDED_BY_DUES).partition(":")[0] for note in closed]
    deep += f" without the {' and the '.join(names)}" if names else ""
    latitudes = plan.proof.kind.partition(IN_WATER)[2].partition(",")[0].partition(";")[0]
    for note in plan.notes:
        if note.startswith(SOUTH_LEFT_OUT):
            limit = note.removeprefix(SOUTH_LEFT_OUT).partition(" ")[0]
            latitudes = latitudes or f"north of {limit} S"
    deep += f" {latitudes}" if latitudes else ""
    bounded = f"{_at_most(plan.gap, figure)}{_at_speeds(plan)}{deep}{_quality_of_front(plan)}"
    return f"{early}{bounded}{other_speeds}"


def _other_speeds(plan: PlanData) -> str:
    """Return what may take less fuel than the one order that arrives at a given time."""
    voyage = plan.voyage
    one_order = voyage.arrive is not None and voyage.depart is not None
    if not one_order or voyage.chooses_speeds or plan.best.fuel_t is None:
        return ""
    held = _HELD[voyage.hold or "power"]
    return (
        f"; the {held} is constant: other speeds on the way may take less fuel (--objective fuel "
        "--arrive-by TIME)"
    )


def _figure_words(name: str) -> str:
    return _FIGURE_WORDS.get(name, name)


def _at_most(gap: float, figure: str) -> str:
    """Return how much less of a key figure is possible, with few words."""
    return f"at most {bounding_percent(gap)} % less {figure} is possible"


def _at_speeds(plan: PlanData) -> str:
    """Return among how many speeds a plan chooses, where the bound is for these."""
    speeds = plan.provenance.get("ship", {}).get("speed_kn")
    if plan.voyage.objective == "front" or not isinstance(speeds, list | tuple):
        return ""
    return f" at the {len(speeds)} speeds of the plan"


def _quality_of_front(plan: PlanData) -> str:
    """Return how much better the other routes of a front can be, if asked for."""
    if plan.front is None:
        return ""
    if plan.voyage.objective != "front":
        return _quality_at_this_time(plan, plan.front)
    gaps = [gap for gap in plan.front.gaps(plan.routes) if gap is not None]
    joint = plan.front.joint_gaps(plan.routes, least_time_h=plan.proof.certain)
    both = [gap for gap in joint if gap is not None]
    value = _figure_words(plan.front.criterion)
    if not both:
        return f"; how much less {value} is possible over the front is not known"
    alone = f"at the same time {_at_most(max(gaps), value)}"
    if max(gaps) > _WEAK:
        alone = f"how much less {value} is possible at the same time is hardly known"
    if max(both) > _WEAK:
        return f"; {alone}"
    share = bounding_percent(max(both))
    return f"; over the front no route is {share} % better in both time and {value}; {alone}"


def _quality_at_this_time(plan: PlanData, front: ParetoFront) -> str:
    """Return how much better routes can be that take no longer, if that is less."""
    front = replace(front, certain=not_rising(front.certain))
    gaps = [gap for gap, one in zip(front.gaps(plan.routes), plan.routes) if one is plan.best]
    if not gaps or gaps[0] is None or gaps[0] > plan.gap - _CLEARLY_LESS:
        return ""
    return f", and at most {bounding_percent(gaps[0])} % less without taking longer"


def bounding_percent(share: float) -> str:
    """Return a share in per cent, rounded up to a tenth, as it bounds something.

    Parameters
    ----------
    share : 0 to 1.
    """
    return f"{max(0.1, math.ceil(1000.0 * share - 1e-6) / 10.0):.1f}"


def _title(plan: PlanData) -> str:
    start, goal = (plan.provenance.get(key) or "?" for key in ("from", "to"))
    objective = plan.voyage.objective
    what = (
        "time against " + plan.front.criterion
        if (objective == "front" and plan.front is not None)
        else least_words(objective)
    )
    if plan.voyage.arrive is not None:
        at = utc_text(float(plan.voyage.arrive))  # type: ignore[arg-type]
        if objective in ("time", "distance"):
            held = _HELD[plan.voyage.hold or "power"]
            what = f"lowest {held}" if plan.voyage.depart is not None else "latest departure"
            what += f", to arrive at {at}"
        else:  # the latest arrival: the speed is chosen leg by leg
            what += f", arriving by {at}"
    return f"{start} to {goal}, {what}"


def _choice(plan: PlanData) -> str:
    """Return the ends of a front and its knee."""
    front = plan.front
    assert front is not None  # checked by the caller
    time = np.array([route.time_h for route in plan.routes])
    chosen = words_of_points(front, time)
    values, unit = front.values, front.unit
    if front.criterion == "comfort":  # a share of people says more than a squared dose
        values = np.array([indicator_value(route, "sick_percent") for route in plan.routes])
        unit = "% sick"
    rows = sorted(chosen, key=lambda k: time[k])
    hours = hours_texts([time[k] for k in rows])
    amounts, unit = amount_column([values[k] for k in rows], unit)
    return "; ".join(
        f"{chosen[k]} {hour} h {amount} {unit}".rstrip()
        for k, hour, amount in zip(rows, hours, amounts)
    )


def _sea(plan: PlanData) -> Sea | None:
    return plan.plot_context.sea if plan.plot_context is not None else None


def _has_weather(plan: PlanData) -> bool:
    """Return whether the data have wind, waves or currents."""
    weather = weather_on_route(plan.best, _sea(plan)).values()
    return any(np.nanmax(np.abs(values), initial=0.0) > 0.0 for values in weather)
