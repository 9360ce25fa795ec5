"""``thalweg tides analyse``: tidal constituents of a record or a model run."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from thalweg.cli import option_values, options
from thalweg.core.errors import InputError
from thalweg.core.given_numbers import rounded_or_none
from thalweg.core.time import format_time
from thalweg.core.units import DAY

if TYPE_CHECKING:
    from thalweg.sea.tides.constituents import Constituents
    from thalweg.sea.tides.harmonic_analysis import TideAnalysis

MAX_ROWS_SHOWN = 12  #: constituents printed on the terminal
_YEAR_DAYS = 365.0  # from which a record has all seasons
_HALF_YEAR_DAYS = 182.6  # from which K2 and S2 are separated


def add_command(actions: Any) -> None:
    """Add the action to the parser of ``thalweg tides``."""
    parser = actions.add_parser(
        "analyse",
        help="find the tidal constituents of a record or a model run",
        description="Find the tidal constituents of a record (CSV, NOOS, DIA or two columns) or of "
        "a model run (NetCDF), by harmonic analysis.",
        epilog="Example: thalweg tides analyse gauge.csv --at 51.44,3.60 --out constituents.json",
    )
    parser.add_argument("file", metavar="FILE", help="record or model run")
    options.add_mapping_option(parser)
    parser.add_argument(
        "--at",
        metavar="LAT,LON",
        help="position of the record [deg], if the file does not state it",
    )
    parser.add_argument(
        "--unit",
        metavar="m|dm|cm|mm",
        help="unit of the levels, for a record of two columns without a header",
    )
    parser.add_argument(
        "--days-since",
        metavar="DATE",
        help="date of day 0, for a record of two columns without a header",
    )
    parser.add_argument(
        "--constituents",
        nargs="+",
        metavar="NAME",
        help="constituents to find, for example M2 S2; default: all that the length of the record "
        "can separate",
    )
    parser.add_argument(
        "--rayleigh",
        type=float,
        default=1.0,
        metavar="R",
        help="Rayleigh criterion: cycles by which two constituents must differ over the record "
        "(default: 1)",
    )
    parser.add_argument("--out", metavar="FILE", help="file for the constituents (JSON)")
    parser.add_argument("--json", action="store_true", help="print the result as one JSON object")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Analyse the file, print the constituents and write them."""
    from thalweg.sea.tides.constituent_files import write_constituents
    from thalweg.sea.tides.tide_records import is_text_record

    if not (np.isfinite(arguments.rayleigh) and arguments.rayleigh > 0.0):
        raise InputError(
            f"The Rayleigh criterion is {arguments.rayleigh:g}.",
            "It is a positive number of cycles, usually 1.",
            "Correct --rayleigh.",
        )
    out = option_values.prepare_output_file(arguments.out) if arguments.out else None
    arguments.progress(f"analysing {arguments.file}")
    of_record = is_text_record(arguments.file)
    analysis, source = _analyse_record(arguments) if of_record else _analyse_model(arguments)
    if out:
        write_constituents(analysis.constituents, out)
    found = _summary(analysis, source, arguments.out)
    if arguments.json:
        print(json.dumps(found, indent=2, allow_nan=False))
    else:
        _print_analysis(found)
    return 0


def _analyse_record(arguments: argparse.Namespace) -> tuple[TideAnalysis, str]:
    from thalweg.sea.tides.harmonic_analysis import MIN_KNOWN_FRACTION, analyse
    from thalweg.sea.tides.tide_records import read_record, readable_name

    _check_options(arguments, ("map",), "a record", "variables of a model run")
    record = read_record(arguments.file, unit=arguments.unit, days_since=arguments.days_since)
    place = option_values.position_from_text(arguments.at) if arguments.at else record.position
    if place is None:
        raise InputError(
            "The position of the record is not given.",
            "Nodal corrections depend on the latitude.",
            "Add --at LAT,LON.",
        )
    analysis = analyse(
        record.times,
        record.series,
        lat=place[0],
        lon=place[1],
        constituents=arguments.constituents,
        rayleigh=arguments.rayleigh,
    )
    for name, mean in analysis.constituents.mean.items():
        if not np.isfinite(mean[0]):
            share = np.isfinite(record.series[name]).mean()
            raise InputError(
                f"The {readable_name(name)} is known at {100.0 * share:.0f} % of the times.",
                f"At least {100.0 * MIN_KNOWN_FRACTION:.0f} % of a record must be known, and more "
                "values than constants to find.",
                "Use a part of the record with fewer gaps, or fewer constituents.",
            )
    return analysis, f"{record.description} at {place[0]:.4f}, {place[1]:.4f}"


def _analyse_model(arguments: argparse.Namespace) -> tuple[TideAnalysis, str]:
    from thalweg.sea import Sea
    from thalweg.sea.tides.model_run_analysis import tidal_analysis

    _check_options(arguments, ("at", "unit", "days_since"), "a model run", "a record")
    analysis = tidal_analysis(
        Sea.open(arguments.file, mapping=option_values.variable_mapping(arguments)).layers,
        constituents=arguments.constituents,
        rayleigh=arguments.rayleigh,
        progress=_progress(arguments),
    )
    return analysis, "model run"


def _check_options(
    arguments: argparse.Namespace, names: tuple[str, ...], what: str, others: str
) -> None:
    """Raise `InputError` for options that do not apply to the kind of file that is given."""
    for name in names:
        if getattr(arguments, name):
            option = f"--{name.replace('_', '-')}"
            raise InputError(
                f"{Path(arguments.file).name} is {what}, and {option} is for {others}.",
                "It has no effect here.",
                f"Omit {option}.",
            )


def _progress(arguments: argparse.Namespace) -> Callable[[int, int], None] | None:
    if arguments.json or not sys.stderr.isatty():
        return None

    def show(done: int, total: int) -> None:
        end = "\n" if done >= total else ""
        print(f"\r{done} of {total} series", end=end, file=sys.stderr, flush=True)

    return show


def _summary(analysis: TideAnalysis, source: str, out: str | None) -> dict[str, Any]:
    constants = analysis.constituents
    known = {n: np.isfinite(constants.mean[n]) for n in sorted(constants.variables)}
    return {
        "source": source,
        "start": format_time(analysis.start),
        "end": format_time(analysis.end),
        "nodes": int(constants.lat.size),
        "constituents": list(constants.names),
        "tidal_share": {n: rounded_or_none(analysis.share(n), 6) for n in known},
        "nodes_without_tide": {n: int((~k).sum()) for n, k in known.items()},
        "variables": {n: _rows(constants, n, k) for n, k in known.items()},
        "notes": _notes_on_length(analysis.start, analysis.end),
        "wrote": out,
    }


def _notes_on_length(start: float, end: float) -> list[str]:
    """Return a note on what a record shorter than a year does not separate."""
    days = (end - start) / DAY
    if days >= _YEAR_DAYS:
        return []
    near = "K2 is not separated from S2, nor P1 from K1, and " if days < _HALF_YEAR_DAYS else ""
    return [
        f"The record has {days:.0f} days: {near}levels that change with the season are taken as "
        "tides of weeks and months. In other seasons predictions can be wrong by decimetres: give "
        "a record of a year or longer where the clearance under the keel depends on them."
    ]


def _rows(constants: Constituents, name: str, known: Any) -> list[dict[str, Any]]:
    """Return the constants at a single node, or the median amplitudes over many nodes."""
    if constants.lat.size == 1:
        return constants.table(name)
    sizes = constants.amplitude[name][:, known]
    middle = np.median(sizes, axis=1) if known.any() else np.full(len(constants.names), np.nan)
    rows = [
        {"name": n, "period_h": float(1.0 / f), "amplitude_median": rounded_or_none(a, 6)}
        for n, f, a in zip(constants.names, constants.frequencies(), middle)
    ]
    return sorted(rows, key=lambda r: -(r["amplitude_median"] or 0.0))


def _print_analysis(analysis: dict[str, Any]) -> None:
    print(analysis["source"])
    print(f"{analysis['start']} to {analysis['end']}, {analysis['nodes']} nodes")
    for name, rows in analysis["variables"].items():
        share = analysis["tidal_share"][name]
        variance = "constant" if share is None else f"{100 * share:.1f} % of the variance is tidal"
        dry = analysis["nodes_without_tide"][name]
        print(f"{name}: {variance}" + (f", {dry} nodes without tide" if dry else ""))
        for row in rows[:MAX_ROWS_SHOWN]:
            size = row.get("amplitude", row.get("amplitude_median"))
            phase = f"  {row['phase_deg']:6.1f} deg" if "phase_deg" in row else "  (median)"
            print(f"  {row['name']:>6}  {row['period_h']:9.4f} h  {size:8.4f}{phase}")
        if len(rows) > MAX_ROWS_SHOWN:
            print(f"  and {len(rows) - MAX_ROWS_SHOWN} more")
    for note in analysis["notes"]:
        print(f"note: {note}")
    if analysis["wrote"]:
        print(f"wrote {analysis['wrote']}")
