"""``thalweg tides``: analyse records and model runs, predict from constituents."""

from __future__ import annotations

import argparse
import csv
import json
import re
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

import numpy as np

from thalweg.cli import options
from thalweg.core.errors import InputError
from thalweg.core.time import format_time, parse_time
from thalweg.sea.tides.noos_dia_series import LENGTH_UNITS

if TYPE_CHECKING:
    from thalweg.sea.tides.constituents import Constituents
    from thalweg.sea.tides.harmonic_analysis import TideAnalysis

MAX_ROWS = 2_000_000  #: times one prediction may have
MAX_ROWS_SHOWN = 12  #: constituents printed for a reader


def add_command(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "tides",
        help="analyse tides and predict them for any date",
        description="Find tidal constituents in a record or a model run, and predict from them.",
    )
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    _add_analyse(actions)
    _add_predict(actions)
    for action in actions.choices.values():
        action._negative_number_matcher = re.compile(r"^-\d[\d.]*([,;\s].*)?$")
        action.set_defaults(run=run)


def _add_analyse(actions: Any) -> None:
    parser = actions.add_parser(
        "analyse",
        help="find the tidal constituents of a record or a model run",
        description="Find the tidal constituents of a record (CSV, NOOS, DIA or two columns) or of "
        "a model run (NetCDF).",
    )
    parser.add_argument("file", metavar="FILE", help="record or model run")
    options.add_mapping_option(parser)
    parser.add_argument(
        "--at", metavar="LAT,LON", help="position of the record, if it does not tell it"
    )
    parser.add_argument(
        "--unit", choices=tuple(LENGTH_UNITS), help="of levels in two bare columns of a record"
    )
    parser.add_argument(
        "--days-since", metavar="DATE", help="first day of the days in two bare columns"
    )
    parser.add_argument(
        "--constituents", nargs="+", metavar="NAME", help="by default all the length can tell apart"
    )
    parser.add_argument(
        "--rayleigh", type=float, default=1.0, metavar="R", help="cycles two constituents must part"
    )
    parser.add_argument("--out", metavar="FILE", help="write the constituents as JSON")
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def _add_predict(actions: Any) -> None:
    parser = actions.add_parser(
        "predict",
        help="predict the tide from constituents",
        description="Predict the tide from a constituents file, as CSV or JSON.",
    )
    parser.add_argument(
        "file", metavar="FILE", help="of 'tides analyse', a hatyan component file or a station set"
    )
    parser.add_argument("--station", metavar="ID|NAME", help="station in a set of many")
    parser.add_argument("--at", metavar="LAT,LON", help="position, where the file holds many nodes")
    parser.add_argument("--start", required=True, metavar="TIME", help="ISO 8601, UTC")
    parser.add_argument("--end", required=True, metavar="TIME", help="ISO 8601, UTC")
    parser.add_argument("--step", type=float, default=10.0, metavar="MIN", help="step in minutes")
    parser.add_argument("--out", metavar="FILE", help="write CSV here instead of printing it")
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def run(arguments: argparse.Namespace) -> int:
    """Analyse or predict."""
    return _analyse(arguments) if arguments.action == "analyse" else _predict(arguments)


def _analyse(arguments: argparse.Namespace) -> int:
    from thalweg.sea.tides.constituent_files import write_constituents
    from thalweg.sea.tides.tide_records import is_text_record

    if not (np.isfinite(arguments.rayleigh) and arguments.rayleigh > 0.0):
        raise InputError(
            f"A Rayleigh criterion of {arguments.rayleigh:g} cannot be.",
            "It is a positive number of cycles, usually 1.",
            "Correct it.",
        )
    out = _writable(arguments.out) if arguments.out else None
    analysis, told = _record(arguments) if is_text_record(arguments.file) else _model(arguments)
    if out:
        write_constituents(analysis.constituents, out)
    found = _summary(analysis, told, arguments.out)
    if arguments.json:
        print(json.dumps(found, indent=2, allow_nan=False))
    else:
        _print_analysis(found)
    return 0


def _record(arguments: argparse.Namespace) -> tuple[TideAnalysis, str]:
    from thalweg.sea.tides.harmonic_analysis import MIN_KNOWN_FRACTION, analyse
    from thalweg.sea.tides.tide_records import read_record, readable_name

    _refuse(arguments, ("map",), "a record", "variables of a model run")
    record = read_record(arguments.file, unit=arguments.unit, days_since=arguments.days_since)
    place = _position(arguments.at) if arguments.at else record.position
    if place is None:
        raise InputError(
            "The position of the record is not given.",
            "Nodal corrections depend on latitude.",
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
                "than there are constants to find.",
                "Take out a part of the record with fewer gaps, or ask for fewer constituents.",
            )
    return analysis, f"{record.description} at {place[0]:.4f}, {place[1]:.4f}"


def _model(arguments: argparse.Namespace) -> tuple[TideAnalysis, str]:
    from thalweg.sea import Sea
    from thalweg.sea.tides.model_run_analysis import tidal_analysis

    _refuse(arguments, ("at", "unit", "days_since"), "a model run", "a record")
    analysis = tidal_analysis(
        Sea.open(arguments.file, mapping=options.variable_mapping(arguments)).layers,
        constituents=arguments.constituents,
        rayleigh=arguments.rayleigh,
        progress=_progress(arguments),
    )
    return analysis, "model run"


def _refuse(arguments: argparse.Namespace, names: tuple[str, ...], what: str, others: str) -> None:
    """Refuse options that mean nothing for the kind of file that is given."""
    for name in names:
        if getattr(arguments, name):
            option = f"--{name.replace('_', '-')}"
            raise InputError(
                f"{Path(arguments.file).name} is {what}, and {option} is for {others}.",
                "It would change nothing.",
                f"Leave {option} out.",
            )


def _progress(arguments: argparse.Namespace) -> Callable[[int, int], None] | None:
    if arguments.json or not sys.stderr.isatty():
        return None

    def tell(done: int, total: int) -> None:
        end = "\n" if done >= total else ""
        print(f"\r{done} of {total} series", end=end, file=sys.stderr, flush=True)

    return tell


def _summary(analysis: TideAnalysis, told: str, out: str | None) -> dict[str, Any]:
    constants = analysis.constituents
    known = {n: np.isfinite(constants.mean[n]) for n in sorted(constants.variables)}
    return {
        "source": told,
        "start": format_time(analysis.start),
        "end": format_time(analysis.end),
        "nodes": int(constants.lat.size),
        "constituents": list(constants.names),
        "tidal_share": {n: _number(analysis.share(n)) for n in known},
        "nodes_without_tide": {n: int((~k).sum()) for n, k in known.items()},
        "variables": {n: _rows(constants, n, k) for n, k in known.items()},
        "wrote": out,
    }


def _rows(constants: Constituents, name: str, known: Any) -> list[dict[str, Any]]:
    """Return the constants of a single node, or the median amplitude over many."""
    if constants.lat.size == 1:
        return constants.table(name)
    sizes = constants.amplitude[name][:, known]
    middle = np.median(sizes, axis=1) if known.any() else np.full(len(constants.names), np.nan)
    rows = [
        {"name": n, "period_h": float(1.0 / f), "amplitude_median": _number(a)}
        for n, f, a in zip(constants.names, constants.frequencies(), middle)
    ]
    return sorted(rows, key=lambda r: -(r["amplitude_median"] or 0.0))


def _print_analysis(found: dict[str, Any]) -> None:
    print(found["source"])
    print(f"{found['start']} to {found['end']}, {found['nodes']} nodes")
    for name, rows in found["variables"].items():
        share = found["tidal_share"][name]
        told = (
            "nothing varies" if share is None else f"{100 * share:.1f} % of the variance is tidal"
        )
        dry = found["nodes_without_tide"][name]
        print(f"{name}: {told}" + (f", {dry} nodes without tide" if dry else ""))
        for row in rows[:MAX_ROWS_SHOWN]:
            size = row.get("amplitude", row.get("amplitude_median"))
            phase = f"  {row['phase_deg']:6.1f} deg" if "phase_deg" in row else "  (median)"
            print(f"  {row['name']:>6}  {row['period_h']:9.4f} h  {size:8.4f}{phase}")
        if len(rows) > MAX_ROWS_SHOWN:
            print(f"  and {len(rows) - MAX_ROWS_SHOWN} more")
    if found["wrote"]:
        print(f"wrote {found['wrote']}")


def _predict(arguments: argparse.Namespace) -> int:
    from thalweg.sea.tides.constituent_files import read_constituents

    times = _times(arguments)
    out = _writable(arguments.out) if arguments.out else None
    constants = read_constituents(arguments.file, station=arguments.station)
    series = _series(constants, times, arguments.at)
    if arguments.json:
        print(json.dumps(_predicted(constants, times, series), indent=2, allow_nan=False))
    elif out:
        with out.open("w", encoding="utf-8", newline="") as file:
            _write(file, times, series)
        print(f"wrote {arguments.out}")
    else:
        _write(sys.stdout, times, series)
    return 0


def _writable(path: str) -> Path:
    """Return where to write a file, its folder made; before the work, not after it."""
    from thalweg.planning.report.output_files import make_folder

    target = Path(path)
    if target.is_dir():
        raise InputError(
            f"{path} is a folder.", "--out is a file here.", "Add the name of a file to it."
        )
    make_folder(target.parent)
    return target


def _times(arguments: argparse.Namespace) -> np.ndarray[Any, np.dtype[np.float64]]:
    start, end = parse_time(arguments.start), parse_time(arguments.end)
    step = 60.0 * arguments.step
    if not (np.isfinite(step) and step > 0.0 and end >= start):
        raise InputError(
            f"Every {arguments.step:g} minutes from {arguments.start} to {arguments.end} is no "
            "series of times.",
            "The step is positive and the end not before the start.",
            "Correct them.",
        )
    rows = int((end - start) / step + 1e-6) + 1
    if rows > MAX_ROWS:
        raise InputError(
            f"{rows} times are asked for.", f"At most {MAX_ROWS}.", "Use a longer step."
        )
    return start + step * np.arange(rows, dtype=np.float64)


def _series(constants: Constituents, times: Any, at: str | None) -> dict[str, Any]:
    """Return the tide by variable, at a station or at a position between nodes."""
    names = sorted(constants.variables)
    if constants.lat.size == 1:
        if at:
            raise InputError(
                "The file holds one place, and --at is for files of many nodes.",
                "The tide is predicted where the constants are from.",
                "Leave --at out.",
            )
        return {n: constants.predict(n, times)[0] for n in names}
    if not at:
        raise InputError(
            f"The file holds {constants.lat.size} nodes.",
            "The tide is predicted at one position.",
            "Add --at LAT,LON.",
        )
    from thalweg.sea import Sea

    lat, lon = _position(at)
    found = Sea.from_tides(constants).series(names, times, np.array([lat]), np.array([lon]))
    if all(np.isnan(v).all() for v in found.values()):
        raise InputError(
            f"{at} lies outside the nodes, or at one without a tide.",
            "",
            "Choose another position.",
        )
    return {n: v[0] for n, v in found.items()}


def _position(text: str) -> tuple[float, float]:
    from thalweg.core.geodesy import parse_position

    position = parse_position(text)
    if position is None:
        raise InputError(
            f"{text!r} is not a position.",
            "A position is LAT,LON in degrees, such as 51.44,3.60 or 51.44N 3.60E.",
            "Write it that way.",
            value=text,
        )
    return float(position[0]), float(position[1])


def _predicted(constants: Constituents, times: Any, series: dict[str, Any]) -> dict[str, Any]:
    return {
        "times": [format_time(t) for t in times],
        "variables": {n: [_number(x) for x in v] for n, v in series.items()},
        "constituents": list(constants.names),
        "convention": constants.convention,
        "source": dict(constants.facts),
    }


def _write(file: TextIO, times: Any, series: dict[str, Any]) -> None:
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(["time", *series])
    writer.writerows(_lines(times, series))


def _lines(times: Any, series: dict[str, Any]) -> Iterator[list[str]]:
    columns = list(series.values())
    for k, time in enumerate(times):
        numbers = [f"{c[k]:.4f}" if np.isfinite(c[k]) else "" for c in columns]
        yield [format_time(time), *numbers]


def _number(value: float) -> float | None:
    return round(float(value), 6) if np.isfinite(value) else None
