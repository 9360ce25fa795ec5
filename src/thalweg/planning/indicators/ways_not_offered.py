"""Why no alternative of a voyage avoids a canal or a passage, in notes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

from thalweg.chart import Chart
from thalweg.chart.canals import Canal
from thalweg.chart.passage_crossings import CAPES
from thalweg.core.errors import names_in_words
from thalweg.core.time import utc_text
from thalweg.planning.indicators.route_choices import passages_of
from thalweg.planning.indicators.route_differences import line_at_shares, lines_differ
from thalweg.planning.report.route_summary import canals_passed
from thalweg.route import Route

NOT_OFFERED: Final = "Not offered"  #: a note on a way that is not among the alternatives


def fastest_without_canals(routes: Sequence[Route], chart: Chart) -> list[tuple[Canal, Route]]:
    """Return each canal of the fastest route, with the fastest of those that do not use it.

    Canals that all routes use are left out.
    """
    order = sorted(routes, key=lambda route: route.arrive - route.depart)
    found = []
    for canal in canals_passed(order[0], chart):
        without = (one for one in order if canal not in canals_passed(one, chart))
        first = next(without, None)
        if first is not None:
            found.append((canal, first))
    return found


def canal_notes(
    chart: Chart,
    routes: Sequence[Route],
    kept: Sequence[Route],
    latest: float,
    refused: Sequence[tuple[set[str], str]],
) -> list[str]:
    """Return why no route that is kept avoids a canal of the fastest one.

    Parameters
    ----------
    routes, kept : All that were found, and those within the limits and in time.
    latest : Latest arrival [s].
    refused : For each way that could not be sailed, the names of its canals, and why.
    """
    notes = []
    round_it = {canal.name: route for canal, route in fastest_without_canals(routes, chart)}
    for canal in canals_passed(kept[0], chart):
        if any(canal not in canals_passed(one, chart) for one in kept):
            continue
        other = round_it.get(canal.name)
        if other is not None:
            why = _why_not_kept(other, latest)
        else:
            why = next(
                (text for names, text in refused if canal.name not in names),
                "the ends are not joined by sea without it, for this ship and its limits.",
            )
        notes.append(_note(canal.title, why))
    return notes


def _why_not_kept(route: Route, latest: float) -> str:
    """Return why a route is not kept: its first broken limit, or its arrival."""
    if route.violations:
        return f"it breaks a limit: {route.violations[0]}"
    if route.arrive > latest + 1.0:
        return f"it arrives at {utc_text(route.arrive)}, after the latest arrival."
    return "it cannot be sailed to its end."


def unchosen_notes(
    chart: Chart, routes: Sequence[Route], chosen: Sequence[Route], broken: Callable[[Route], str]
) -> list[str]:
    """Return which ways without a canal or passage were found and are not among the chosen.

    Parameters
    ----------
    routes : All within the limits of ships and in time, the fastest first.
    broken : Returns the limit of the voyage that a route breaks, as text; empty for none.
    """
    notes = []
    for canal, other in fastest_without_canals(routes, chart):
        if all(canal in canals_passed(one, chart) for one in chosen):
            limit = broken(other)
            why = f"it breaks {limit}." if limit else "more routes were found than asked for."
            notes.append(_note(canal.title, why))
    return notes + _passage_notes(chart, routes, chosen) or _other_water_notes(routes, chosen)


def _passage_notes(chart: Chart, routes: Sequence[Route], chosen: Sequence[Route]) -> list[str]:
    """Return which passages all chosen routes use, with why none avoids them."""
    found = [set(passages_of(route, chart)) for route in routes]
    used = set.intersection(*(set(passages_of(route, chart)) for route in chosen)) - set(CAPES)
    names = [name for name in passages_of(chosen[0], chart) if name in used]
    by_all = [name for name in names if all(name in some for some in found)]
    others = [name for name in names if name not in by_all]
    notes = []
    if by_all:
        notes.append(
            f"{NOT_OFFERED}: ways without {names_in_words(by_all)}: the network along the fastest "
            "route has none that keep the limits and the lanes (plan with --avoid NAME for another "
            "one)."
        )
    if others:
        why = "those found are best in no figure of the table."
        notes.append(f"{NOT_OFFERED}: ways without {names_in_words(others)}: {why}")
    return notes


def _other_water_notes(routes: Sequence[Route], chosen: Sequence[Route]) -> list[str]:
    """Return why all chosen routes lead through the same water; empty where they do not."""
    lines = [line_at_shares(route) for route in chosen]
    if any(lines_differ(line, lines[0]) for line in lines[1:]):
        return []
    others = [line_at_shares(route) for route in routes]
    apart = any(all(lines_differ(line, one) for one in lines) for line in others)
    why = (
        "those found, round islands or farther off land, are best in no figure of the table."
        if apart
        else "none was found round islands, by named passages or farther off land."
    )
    return [f"{NOT_OFFERED}: ways through other water: {why}"]


def _note(title: str, why: str) -> str:
    """Return the note on a canal."""
    return f"{NOT_OFFERED}: a way without the {title}: {why}" + ("" if why[-1] == "." else ".")
