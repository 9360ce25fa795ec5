"""Tables of plans and routes on the terminal."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pathlib import Path

    from thalweg.planning import Plan
    from thalweg.route import Route

_MAX_ROWS = 30
_LEAST_WAIT_H = 0.05  # shorter waits are not listed [h]
_WAYPOINT_COLUMNS = ("waypoint", "UTC", "course", "nm", "stw", "sog", "wait", "ukc")


def new_table(title: str, columns: Sequence[str], *, left: Sequence[str], wrap: str = "") -> Any:
    """Return an empty rich table.

    Parameters
    ----------
    columns : Heads of the columns.
    left : Columns that are aligned to the left; the others hold numbers.
    wrap : The column whose cells may be broken into several lines.
    """
    from rich import box
    from rich.table import Table

    table = Table(title=title, title_justify="left", box=box.SIMPLE_HEAD, padding=(0, 0, 0, 1))
    for name in columns:
        justify: Any = "left" if name in left else "right"
        table.add_column(name, justify=justify, no_wrap=name != wrap)
    return table


def print_notes(console: Any, notes: Iterable[str]) -> None:
    """Print notes, each on a line of its own, those on danger first."""
    from rich.markup import escape

    from thalweg.planning.report.note_order import danger_first

    for note in danger_first(notes):
        console.print(f"[yellow]note:[/yellow] {escape(note)}", soft_wrap=True)


def print_written(files: Iterable[Any]) -> None:
    """Print the names of the files that were written."""
    for path in files:
        print(f"wrote {path}")


def print_plan(plan: Plan, files: Sequence[Path] = (), *, verbose: bool = False) -> None:
    """Print a plan in at most twelve lines, more where there are several notes on danger.

    Parameters
    ----------
    files : The files that were written.
    verbose : bool, optional
        Whether the waypoints, the bounds, the front and the provenance follow, with all notes.
    """
    from thalweg.planning.report.plan_summary import MAX_LINES, plan_summary, summary_with_notes

    if verbose:
        print("\n".join(plan_summary(plan)))
        _print_details(plan)
        print_written(files)
        return
    written = [_files_line(files)] if files else []
    print("\n".join(summary_with_notes(plan, MAX_LINES - len(written)) + written))


def _files_line(files: Sequence[Path]) -> str:
    folder = files[0].parent
    names = [path.name for path in files if path.parent == folder]
    folders = sorted({f"{path.parent.name}/" for path in files if path.parent != folder})
    return f"Files     {folder}: {', '.join([*names, *folders])}"


def _print_details(plan: Plan) -> None:
    """Print the waypoints, the bounds, the front, the notes and the provenance of a plan."""
    from rich.console import Console
    from rich.markup import escape

    from thalweg.planning.report.plan_summary import bounding_percent

    console = Console()
    at = "" if plan.front is None else " at the speeds of the plan"
    title = f"{plan.provenance['from']} to {plan.provenance['to']}, least {plan.voyage.objective}"
    print_waypoints(console, plan.best.waypoints(), title)
    console.print(
        escape(
            f"Lower bound {plan.lower_bound:.2f} {plan.unit}: no route{at} can be below it, "
            f"at most {bounding_percent(plan.gap)} % less than this one (the gap); "
            if plan.gap < 1.0
            else ""
        )
        + f"{escape(plan.proof.kind)}.",
        soft_wrap=True,
    )
    if plan.front is not None:
        print_front(console, plan)
    print_passage_alternatives(console, plan)
    print_notes(console, plan.notes)
    from thalweg.core.errors import reasons_text

    refused = reasons_text(plan.rejections) or "none"
    console.print(f"Legs rejected: {refused}.", soft_wrap=True)
    for network in plan.provenance["networks"]:
        facts = ", ".join(f"{name} {value}" for name, value in network.items())
        console.print(f"Network: {escape(facts)}.", soft_wrap=True)
    for name in ("ship", "sea"):
        digest = plan.provenance[name].get("fingerprint")
        console.print(f"Fingerprint of the {name}: {digest}", soft_wrap=True)


def print_passage_alternatives(console: Any, plan: Plan) -> None:
    """Print the ways round the canals and passages of a plan."""
    if len(plan.passage_alternatives) < 2:
        return
    from thalweg.chart.canals import CANALS

    titles = {canal.name: canal.title for canal in CANALS}
    console.print(
        "Ways by distance in calm water at the speed of the plan; a plan that keeps off shoals and "
        "to traffic lanes may be longer:"
    )
    for row in plan.passage_alternatives:
        without, by = ("; ".join(titles.get(n, n) for n in row[k]) for k in ("without", "passes"))
        which = f"without {without}" if without else "shortest way"
        text = (
            f"  {row['distance_nm']:,.0f} nm, {row['time_h']:,.1f} h, canal dues "
            f"{row['canal_dues_usd']:,.0f} USD: {which}"
            f"{f', by {by}' if by else ''}."
        )
        console.print(text, soft_wrap=True, markup=False)  # whole names on narrow terminals
    console.print("'thalweg alternatives' plans such ways, with their fuel and cost.")


def print_front(console: Any, plan: Plan) -> None:
    """Print the routes of a Pareto front and their savings over the weather-blind route."""
    import numpy as np

    from thalweg.core.pareto_fronts import evenly_spaced_subset
    from thalweg.route.number_texts import amount_column, decimals

    front = plan.front
    assert front is not None  # checked by the caller
    columns = ("h", front.criterion, "nm", "wait h", "gap %", "from", "way")
    rows = sorted(front.rows(plan.routes), key=lambda row: float(row["time_h"]))
    shown = evenly_spaced_subset(
        np.array([row["time_h"] for row in rows]),
        np.array([row[front.column] for row in rows]),
        _MAX_ROWS,
    )
    values, unit = amount_column([rows[index][front.column] for index in shown], front.unit)
    title = f"{front.criterion} against time ({unit})"
    table = new_table(title, columns, left=("from", "way"), wrap="way")
    miles = decimals([row["distance_nm"] for row in rows])
    waits = decimals([row["waiting_h"] for row in rows], least=1)
    for row, value in zip((rows[index] for index in shown), values):
        gap = "" if row["gap"] is None else f"{100 * row['gap']:.1f}"
        table.add_row(
            f"{row['time_h']:.2f}", value, f"{row['distance_nm']:.{miles}f}",
            f"{row['waiting_h']:.{waits}f}", gap, row["stage"], row["way"],
        )  # fmt: skip
    console.print(table)
    if any(row["gap"] is not None for row in rows):
        console.print(f"gap: at most so much less {front.criterion} is possible at the same time.")
    if len(rows) > len(shown):
        console.print(f"{len(shown)} of {len(rows)} routes; --out DIR writes all to front.csv.")
    for line in _savings(plan):
        console.print(line, soft_wrap=True)


def _savings(plan: Plan) -> list[str]:
    """Return sentences on what the front saves over the weather-blind route, at the ends."""
    from thalweg.route.number_texts import amount_text

    comparison = plan.front.comparison if plan.front is not None else None
    if comparison is None or plan.front is None:
        return []
    lines = []
    for row in {id(row): row for row in (comparison.rows[0], comparison.rows[-1])}.values():
        saved = []
        if row["saved"] is not None and row["saved"] > 0.0:
            saved.append(
                f"{amount_text(row['saved'], plan.front.unit)} ({row['saved_percent']:.1f} %) in "
                "the same time"
            )
        if row["saved_h"] is not None and row["saved_h"] > 0.0:
            saved.append(f"{row['saved_h']:.2f} h at the same {plan.front.criterion}")
        lines.append(
            f"Weather-blind at {row['speed_kn']:.1f} kn: {row['time_h']:.2f} h, "
            + amount_text(row["value"], plan.front.unit)
            + ("" if row["feasible"] else " (breaks a limit)")
            + (f"; the front saves {', or '.join(saved)}." if saved else ".")
        )
    return lines


def print_route(
    route: Route,
    items: Sequence[tuple[str, str]],
    notes: Sequence[str],
    files: Sequence[Path] = (),
    *,
    verbose: bool = False,
) -> None:
    """Print an evaluated route in at most twelve lines, more with several notes on danger.

    Parameters
    ----------
    items : Its lines (`thalweg.planning.report.route_summary.route_items`).
    notes : Warnings first.
    files : The files that were written.
    verbose : Whether the waypoints, all violated limits and all notes follow.
    """
    from rich.console import Console

    from thalweg.planning.report.plan_summary import MAX_LINES, notes_lines

    lines = [f"{name:<9} {text}" for name, text in items]
    written = [_files_line(files)] if files else []
    if verbose:
        print("\n".join(lines))
        console = Console()
        print_waypoints(console, route.waypoints(), "the route as given")
        print_notes(console, notes)
        print_written(files)
        return
    shown, room = lines, max(1, MAX_LINES - len(written) - min(len(notes), 1))
    if len(lines) > room:
        shown = [*lines[: room - 1], f"Limits    {len(lines) - room + 1} more: --verbose"]
    shown += notes_lines(notes, MAX_LINES - len(shown) - len(written))
    print("\n".join(shown + written))


def print_waypoints(console: Any, waypoints: list[dict[str, Any]], title: str) -> None:
    """Print the table of a route's waypoints, narrow enough for a terminal of 80 columns."""
    table = new_table(title, _WAYPOINT_COLUMNS, left=("waypoint", "UTC"))
    for row in waypoints:
        table.add_row(*_waypoint_cells(row))
    console.print(table)


def _waypoint_cells(row: dict[str, Any]) -> list[str]:
    def number(key: str, digits: int) -> str:
        value = row.get(key)
        return "" if value is None else f"{value:.{digits}f}"

    lat, lon = row["lat"], row["lon"]
    course = number("course_deg", 0)
    return [
        f"{abs(lat):6.3f}{'N' if lat >= 0 else 'S'} {abs(lon):7.3f}{'E' if lon >= 0 else 'W'}",
        str(row["time"] or "")[5:16].replace("T", " "),
        f"{int(course) % 360:03d}" if course else "",
        number("distance_nm", 1),
        number("speed_through_water_kn", 1),
        number("speed_over_ground_kn", 1),
        number("waiting_h", 2) if (row.get("waiting_h") or 0.0) >= _LEAST_WAIT_H else "",
        number("ukc_m", 1),
    ]
