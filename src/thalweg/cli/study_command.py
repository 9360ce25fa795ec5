"""``thalweg study``: many voyages and their statistics."""

from __future__ import annotations

import argparse
import json
import math
import sys
import time
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from thalweg.cli.exit_codes import NO_ROUTE, SUCCESS, exit_code_of_kind
from thalweg.cli.progress import ProgressMessages
from thalweg.core import errors
from thalweg.core.errors import InputError

if TYPE_CHECKING:
    import pandas as pd

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
    run = actions.add_parser(
        "run",
        help="plan the voyages that have no result yet",
        description="Plan the voyages of a study that have no result in the folder yet. Ctrl-C "
        "stops it: what is finished is kept, and the same command plans the rest.",
        epilog="Example: thalweg study run season.yaml --out season --workers 2",
    )
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
    ready = actions.add_parser(
        "ready",
        help="list the ready studies, or print one to change it",
        description="List the ready studies, or print the file of one, to save and change it.",
        epilog="Example: thalweg study ready season > season.yaml",
    )
    ready.add_argument("name", nargs="?", metavar="NAME", help="print this study file")
    ready.set_defaults(run=_ready)
    summary = actions.add_parser(
        "summary",
        help="voyages, quantiles by month and axis, refusals",
        description="Print the voyages of a study, the median and the 10 and 90 % quantiles of "
        "their figures by month or by what the study varies, and why voyages have no route.",
        epilog="Example: thalweg study summary season --out season-tables",
    )
    summary.add_argument("folder", metavar="DIR")
    summary.add_argument("--out", metavar="DIR", help="write tables and a plot into this folder")
    summary.add_argument("--json", action="store_true", help="print JSON")
    summary.set_defaults(run=_summary)


def _run(arguments: argparse.Namespace) -> int:
    from thalweg.studies import load_study, run_study
    from thalweg.studies.study_run import has_route

    _refuse_ready_name(arguments.study)
    study = load_study(arguments.study)
    if arguments.count:
        print(f"{study.size} voyages")
        return SUCCESS
    report: ProgressMessages = arguments.progress
    report(f"planning {study.size} voyages")
    reasons: Counter[str] = Counter()
    kinds: set[str] = set()

    def progress(state: StudyProgress) -> None:
        kinds.update(str(row["refusal"]) for row in state.rows if not has_route(row))
        reasons.update(
            str(row["reason"] or row.get("first_violation"))
            for row in state.rows
            if not has_route(row)
        )
        report(_words(state))

    state = run_study(
        study,
        arguments.out,
        workers=arguments.workers,
        scheduler=arguments.scheduler,
        progress=progress,
    )
    print(
        f"{state.done} of {state.total} voyages have a result in {arguments.out}; "
        f"{state.new} were planned now, {state.refused} of them without a route"
    )
    for reason, count in reasons.most_common(1):
        print(f"{count} of these: {reason}")
    if not state.new or state.refused < state.new:
        return SUCCESS
    # a route that breaks a limit and a fault of Thalweg are no errors of the request
    codes = {exit_code_of_kind(getattr(errors, kind, errors.NoRouteError)) for kind in kinds}
    return codes.pop() if len(codes) == 1 else NO_ROUTE


def _refuse_ready_name(given: str) -> None:
    """Raise an error for the name of a ready study, which is no file yet."""
    from thalweg.studies import ready_studies

    if not Path(given).exists() and given in ready_studies():
        raise InputError(
            f"{given!r} is a ready study, and no file of this name exists.",
            "Studies are run from files.",
            f"thalweg study ready {given} > {given}.yaml writes it; then run {given}.yaml.",
            value=given,
        )


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
    if left is None or state.done == state.total:
        return text
    return (
        f"{text}, the rest until about {time.strftime('%H:%M', time.localtime(time.time() + left))}"
    )


_SHOWN_VOYAGES: Final = 10
#: Figures on the terminal, where they are known and not all zero; the files have all of them.
_SHOWN_FIGURES: Final = (
    "time_h", "distance_nm", "fuel_t", "cost_usd", "waiting_h", "waiting_above_limits_h",
    "sick_percent", "inshore_percent", "saved_time_h", "saved_fuel_t", "saved_sick_percent",
    "saved",
)  # fmt: skip
_SHOWN_SHARES: Final = (
    "without_route", "waiting_days_mean", "waiting_days_max", "inshore_share",
)  # fmt: skip


def _print_voyages(voyages: Any) -> None:
    """Print the first voyages, one line for each."""
    figures = [
        name
        for name in _SHOWN_FIGURES
        if name in voyages and voyages[name].fillna(0.0).round(2).any()
    ]
    if "arrive" not in voyages:  # none has a route
        return
    axes = list(voyages.columns[: list(voyages.columns).index("arrive")])
    broken = "feasible" in voyages and not voyages["feasible"].fillna(True).all()
    last = [*(["feasible"] if broken else []), *(["refusal"] if "refusal" in voyages else [])]
    shown = voyages.head(_SHOWN_VOYAGES)[[*axes, "arrive", *figures, *last]]
    numbers = shown.select_dtypes("number").columns
    shown[numbers] = shown[numbers].round(2) + 0.0  # no -0.00
    print(shown.to_string(index=False, na_rep="-"))
    left = len(voyages) - len(shown)
    if left:
        print(f"and {left} more voyages: --out writes all of them to voyages.csv")
    print()


def _print_groups(table: Any) -> None:
    """Print the median of each figure by group, with its 10 and 90 % quantiles."""
    import pandas as pd

    if (table["voyages"] == 1).all():
        return  # each group is a line of the voyages
    names = list(table.columns)
    shown = table[names[: names.index("routes") + 1]].copy()
    for name in _SHOWN_SHARES:
        if name in table and table[name].fillna(0.0).any():
            shown[name] = table[name].astype(float).round(2)
    for name in _SHOWN_FIGURES:
        parts = [f"{name}_{part}" for part in ("p50", "p10", "p90")]
        if set(parts) <= set(names) and table[parts].astype(float).fillna(0.0).round(2).any(
            axis=None
        ):
            shown[name] = [
                "-" if pd.isna(middle) else f"{middle:z.2f} ({low:z.2f} to {high:z.2f})"
                for middle, low, high in table[parts].astype(float).itertuples(index=False)
            ]
    print("Medians (10 to 90 %):")
    print(shown.to_string(index=False, na_rep="-"))
    print()


def _print_savings(voyages: Any) -> None:
    """Print against how many routes that ignore the weather savings are counted."""
    if "saved_time_h" not in voyages or not voyages["time_h"].notna().any():
        return
    compared = voyages[voyages["time_h"].notna()]
    kept = compared["saved_time_h"].notna()
    text = f"Against the route that ignores the weather, {int(kept.sum())} of {len(kept)} voyages"
    if kept.any():
        hours, tonnes = (
            compared.loc[kept, name].mean() if name in compared else float("nan")
            for name in ("saved_time_h", "saved_fuel_t")
        )
        fuel = "" if math.isnan(tonnes) else f" and {tonnes:z.2f} t"
        text += f" save {hours:z.2f} h{fuel} on average"
    else:
        text += " have a saving"
    if not kept.all():
        text += "; on the others that route does not keep the limits, and no saving is counted"
    print(f"{text}.\n")


def _summary(arguments: argparse.Namespace) -> int:
    from thalweg.studies import summarise_study

    summary = summarise_study(arguments.folder)
    if summary.left:
        print(
            f"warning: {summary.left} voyages of this study are not planned yet: shares and "
            "choices below compare a part of it. thalweg study run plans the others.",
            file=sys.stderr,
        )
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
        parts["voyages_left"] = summary.left
        parts["notes"] = summary.notes
        print(json.dumps(parts, indent=2, allow_nan=False))
        return SUCCESS
    _print_voyages(summary.voyages)
    _print_groups(summary.table)
    _print_savings(summary.voyages)
    if not summary.best_months.empty:
        print("Best month by the median of each figure:")
        print(summary.best_months.round(2).to_string(index=False))
        print()
    if not summary.choices.empty:
        print(
            "Share of departures for which a value is the best (chosen; values that are equally "
            "good share it: tied), and of those with the same choice at the next departure "
            "(persistence):"
        )
        print(summary.choices.round(2).to_string(index=False, na_rep="-"))
        print()
    _print_fronts(summary.fronts)
    if not summary.fidelity.empty:
        print("Accuracy: gap_percent of the objective to the finest:")
        print(summary.fidelity.round(3).to_string(index=False, na_rep="-"))
    _print_annual(summary.annual)
    for note in summary.notes:
        print(f"Note: {note}")
    for _, row in summary.refusals.head(5).iterrows():
        count = f"{row['voyages']} voyages" if row["voyages"] > 1 else "1 voyage"
        print(f"{count} without a route ({row['refusal']}): {row['reason']}")
    return SUCCESS


def _print_fronts(fronts: pd.DataFrame) -> None:
    """Print the median hypervolume ratio of each method, the greatest first."""
    if not fronts.empty and "method" in fronts:
        ratios = fronts.groupby("method")["hypervolume_ratio"].median()
        for method, ratio in ratios.sort_values(ascending=False).items():
            print(f"median hypervolume ratio of {method}: {ratio:.4f}")


def _print_annual(annual: pd.DataFrame) -> None:
    """Print the figures of a year, and what is missing in them."""
    if annual.empty:
        return
    print("In a year (cii in grams of CO2 per tonne and nautical mile, cost in the prices given):")
    print(annual.round(2).to_string(index=False, na_rep="-"))
    if "cii" in annual and annual["cii"].isna().any():
        print(
            "cii -: the ship is below 5,000 GT, or the ship file has no hull.deadweight_t (or "
            "hull.gross_tonnage, for some types), no type that the rating is for, or no carbon "
            "of the fuel."
        )
    if "eu_ets_cost" in annual and annual["eu_ets_cost"].notna().any():
        if "charges_in_cost" in annual:
            print(
                "The costs (cost_...) include eu_ets_cost and fueleu_penalty where charges_in_cost "
                "is True: do not add them there. Other costs do not include them."
            )
        else:
            print("The costs (cost_...) do not include eu_ets_cost and fueleu_penalty.")
    elif "eu_ets_cost" in annual:
        print(
            "eu_ets_cost, fueleu_penalty -: no price, no share of the voyage in the European "
            "Union is known, or the ship is below 5,000 GT."
        )
