"""Tables of dredging projects, waiting studies and track analyses on the terminal."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from thalweg.cli.tables import new_table, print_notes
from thalweg.core.time import format_time
from thalweg.core.units import HOUR, KNOT

if TYPE_CHECKING:
    from thalweg.operations.dredging.project_result import ProjectResult
    from thalweg.operations.tracks.track_analysis import TrackAnalysis
    from thalweg.operations.waiting.waiting_study import WaitingStudy


def print_project(result: ProjectResult) -> None:
    """Print the table and the notes of a dredging project."""
    from rich.console import Console
    from rich.markup import escape

    console = Console()
    head, *rows = result.table()
    table = new_table(escape(result.project.name), head, left=head[:1])
    for row in rows:
        table.add_row(*(escape(cell) for cell in row))
    console.print(table)
    notes = [note for run in result.runs for note in run.notes]
    print_notes(console, dict.fromkeys(notes + list(result.provenance["assumptions"])))


def print_waiting_study(
    study: WaitingStudy, break_even: dict[str, list[float]], notes: list[str]
) -> None:
    """Print the savings of each departure rule.

    Parameters
    ----------
    break_even : Hotel power [W] for each rule and start, above which waiting saves nothing.
    notes : Assumptions about the ships.
    """
    from rich.console import Console

    shown = range(3, len(study.max_waits), 3)
    waits = [f"{study.max_waits[j] / HOUR:.1f} h" for j in shown]
    hotel = study.hotel_power / 1000.0
    title = f"energy compared with not waiting [%], hotel power {hotel:g} kW"
    columns = ("ready", "rule", *waits, "total [h]", "even [kW]")
    table = new_table(title, columns, left=("ready", "rule"))
    for i, start in enumerate(study.starts):
        for rule in study.plans:
            change = -100.0 * study.saving(rule)[i]
            power = break_even[rule][i] if rule in break_even else math.nan
            table.add_row(
                format_time(float(start))[5:16] if rule == "none" else "",
                rule,
                *("" if rule == "none" else f"{change[j] + 0.0:+.2f}" for j in shown),
                f"{study.plans[rule][i][-1].duration / HOUR:.1f}",
                "" if math.isnan(power) else f"{power / 1000.0:.1f}",
            )
    console = Console()
    console.print(table)
    console.print(
        f"{len(study.trips)} trip{'s' if len(study.trips) > 1 else ''}, without loading and "
        "unloading. Columns with hours: longest wait allowed before each trip. "
        "total: from ready to the last arrival, with the longest wait. even: hotel power above "
        "which waiting saves nothing."
    )
    print_notes(console, notes)


def print_track_analysis(analysis: TrackAnalysis) -> None:
    """Print the activities, cycles and speeds of a track, and the models compared with it."""
    from rich.console import Console

    data, console = analysis.as_dict(), Console(markup=False)  # names may contain brackets
    console.print(
        f"{data['vessel'] or 'ship'}: {data['start']} to {data['end']}, "
        f"{data['positions']} positions, {data['cycles']['count']} complete cycles "
        f"({data['cycles']['per_week']:.1f} per week)"
    )
    for note in data["notes"]:
        console.print(f"note: {note}", soft_wrap=True, highlight=False)
    _print_activities(console, data)
    _print_models(console, data)


def _print_activities(console: Any, analysis: dict[str, Any]) -> None:
    columns = ("activity", "count", "mean, h", "std, h", "sum, h", "share")
    table = new_table("activities", columns, left=("activity",))
    for row in analysis["activities"]:
        table.add_row(
            row["activity"],
            str(row["count"]),
            *(_two_digits(row[key]) for key in ("mean_h", "std_h", "sum_h")),
            f"{100.0 * row['share']:.1f} %",
        )
    console.print(table)
    for kind, row in analysis["speeds"].items():
        deviation = _two_digits(row["std_kn"])
        console.print(f"{kind}: {row['mean_kn']:.2f} ± {deviation} kn over {row['legs']} legs")


def _print_models(console: Any, analysis: dict[str, Any]) -> None:
    title = "modelled against measured speeds of the legs"
    columns = ("model", "legs", "slope", "intercept, kn", "r2", "RMSE_rel, %")
    table = new_table(title, columns, left=("model",))
    for name, row in analysis["models"].items():
        intercept = None if row["intercept"] is None else row["intercept"] / KNOT
        values = (row["slope"], intercept, row["r2"], row["rmse_rel"])
        table.add_row(name, str(row["count"]), *(_two_digits(v) for v in values))
    console.print(table)
    fit = analysis["calibration"]
    if fit is not None:
        speeds = ", ".join(f"{kind} {v / KNOT:.2f} kn" for kind, v in fit["speeds"].items())
        console.print(
            f"factor on the currents {fit['factor']:.3f} ± {fit['factor_error']:.3f} "
            f"(factor for a slope of one: {_two_digits(fit['slope_one'])}); speed through water: "
            f"{speeds}"
        )


def _two_digits(value: float | None) -> str:
    return "" if value is None or not math.isfinite(value) else f"{value:.2f}"
