"""``thalweg study``: many voyages and their statistics."""

from __future__ import annotations

import argparse
import json
from typing import TYPE_CHECKING, Any, Final

from thalweg.cli.exit_codes import SUCCESS
from thalweg.cli.progress import ProgressMessages

if TYPE_CHECKING:
    from thalweg.studies import StudyProgress


def add_command(commands: Any) -> None:
    """Add the command with its actions to the parser."""
    parser = commands.add_parser(
        "study",
        help="plan many voyages and summarise them",
        description="Plan the voyages of a study: departures, ships, speeds, routes, members or "
        "random draws. A study that was stopped goes on where it was.",
    )
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    run = actions.add_parser("run", help="plan the voyages that have no result yet")
    run.add_argument("study", metavar="STUDY.yaml")
    run.add_argument("--out", required=True, metavar="DIR", help="folder of the results")
    run.add_argument(
        "--workers",
        type=int,
        default=0,
        metavar="N",
        help="processes of this computer (default: 0, in this process)",
    )
    run.add_argument("--scheduler", metavar="ADDRESS", help="Dask scheduler: tcp://host:8786")
    run.add_argument("--count", action="store_true", help="print the number of voyages and stop")
    run.set_defaults(run=_run)
    ready = actions.add_parser("ready", help="list the ready studies, or print one to change it")
    ready.add_argument("name", nargs="?", metavar="NAME", help="print this study file")
    ready.set_defaults(run=_ready)
    summary = actions.add_parser("summary", help="voyages, quantiles by month and axis, refusals")
    summary.add_argument("folder", metavar="DIR")
    summary.add_argument("--out", metavar="DIR", help="write tables and a plot into this folder")
    summary.add_argument("--json", action="store_true", help="print JSON")
    summary.set_defaults(run=_summary)


def _run(arguments: argparse.Namespace) -> int:
    from thalweg.studies import load_study, run_study

    study = load_study(arguments.study)
    if arguments.count:
        print(f"{study.size} voyages")
        return SUCCESS
    report: ProgressMessages = arguments.progress
    report(f"planning {study.size} voyages")
    state = run_study(
        study,
        arguments.out,
        workers=arguments.workers,
        scheduler=arguments.scheduler,
        progress=lambda state: report(_words(state)),
    )
    print(
        f"{state.done} of {state.total} voyages have a result in {arguments.out}; "
        f"{state.new} were planned now, {state.refused} of them without a route"
    )
    return SUCCESS


def _ready(arguments: argparse.Namespace) -> int:
    from thalweg.studies import ready_studies, ready_study

    if arguments.name is not None:
        print(ready_study(arguments.name), end="")
        return SUCCESS
    for name, text in ready_studies().items():
        print(f"{name:18} {text}")
    print("thalweg study ready NAME > my-study.yaml")
    return SUCCESS


def _words(state: StudyProgress) -> str:
    left = state.seconds_left
    text = f"{state.done} of {state.total} voyages, {state.refused} without a route"
    return text if left is None else f"{text}, about {left / 60.0:.1f} min left"


_SHOWN_VOYAGES: Final = 10
_LONG_COLUMNS: Final = ("reason", "first_violation")


def _print_voyages(voyages: Any) -> None:
    """Print the first voyages, one line for each."""
    shown = voyages.head(_SHOWN_VOYAGES)
    hidden = [name for name in _LONG_COLUMNS if name in shown]
    print(shown.drop(columns=hidden).round(2).to_string(index=False, na_rep="-"))
    left = len(voyages) - len(shown)
    if left:
        print(f"and {left} more voyages: --out writes all of them to voyages.csv")
    print()


def _summary(arguments: argparse.Namespace) -> int:
    from thalweg.studies import summarise_study

    summary = summarise_study(arguments.folder)
    if arguments.out is not None:
        summary.write(arguments.out)
    if arguments.json:
        parts = {
            name: json.loads(frame.to_json(orient="records"))
            for name, frame in (
                ("groups", summary.table),
                ("refusals", summary.refusals),
                ("best", summary.best),
                ("fronts", summary.fronts),
                ("annual", summary.annual),
                ("voyages", summary.voyages),
                ("choices", summary.choices),
                ("hours", summary.hours),
                ("best_months", summary.best_months),
                ("fidelity", summary.fidelity),
            )
        }
        print(json.dumps(parts, indent=2, allow_nan=False))
        return SUCCESS
    _print_voyages(summary.voyages)
    hidden = [name for name in map(str, summary.table) if name.endswith(("_low", "_high"))]
    print(summary.table.drop(columns=hidden).round(2).to_string(index=False, na_rep="-"))
    if not summary.best.empty:
        for _, row in summary.best.iterrows():
            print(f"least median time: month {int(row['month'])}, {row['time_h_p50']:.2f} h")
    if len(summary.best_months) > 1:
        print(summary.best_months.round(2).to_string(index=False))
    if not summary.choices.empty:
        print(summary.choices.round(2).to_string(index=False, na_rep="-"))
    if not summary.fronts.empty and "method" in summary.fronts:
        ratios = summary.fronts.groupby("method")["hypervolume_ratio"].median()
        for method, ratio in ratios.sort_values(ascending=False).items():
            print(f"median hypervolume ratio of {method}: {ratio:.4f}")
    if not summary.fidelity.empty:
        print(summary.fidelity.round(3).to_string(index=False, na_rep="-"))
    if not summary.annual.empty:
        print(summary.annual.round(2).to_string(index=False, na_rep="-"))
    for _, row in summary.refusals.head(5).iterrows():
        print(f"{row['voyages']} voyages without a route: {row['refusal']}: {row['reason']}")
    return SUCCESS
