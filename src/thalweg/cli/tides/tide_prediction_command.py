"""``thalweg tides predict``: the tide at given times from tidal constituents."""

from __future__ import annotations

import argparse
import csv
import io
import json
import sys
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, TextIO

import numpy as np

from thalweg.cli import option_values
from thalweg.core.errors import InputError
from thalweg.core.file_writing import write_text
from thalweg.core.given_numbers import rounded_or_none
from thalweg.core.time import format_time, parse_time
from thalweg.core.types import FloatArray

if TYPE_CHECKING:
    from thalweg.sea.tides.constituents import Constituents

MAX_ROWS = 2_000_000  #: times of one prediction


def add_command(actions: Any) -> None:
    """Add the action to the parser of ``thalweg tides``."""
    parser = actions.add_parser(
        "predict",
        help="predict the tide from constituents",
        description="Predict the tide at equal steps of time from a file of constituents, as CSV "
        "or JSON.",
        epilog="Example: thalweg tides predict constituents.json --start 2026-01-01 "
        "--end 2026-02-01 --step 10 --out tide.csv",
    )
    parser.add_argument(
        "file",
        metavar="FILE",
        help="constituents: from 'thalweg tides analyse', a hatyan component file or a set of "
        "stations",
    )
    parser.add_argument(
        "--station", metavar="ID|NAME", help="station, for a file with several stations"
    )
    parser.add_argument(
        "--at", metavar="LAT,LON", help="position [deg], for a file with many nodes"
    )
    parser.add_argument("--start", required=True, metavar="TIME", help="first time (ISO 8601, UTC)")
    parser.add_argument("--end", required=True, metavar="TIME", help="last time (ISO 8601, UTC)")
    parser.add_argument(
        "--step", type=float, default=10.0, metavar="MIN", help="time step [min] (default: 10)"
    )
    parser.add_argument("--out", metavar="FILE", help="file for the CSV; default: printed")
    parser.add_argument("--json", action="store_true", help="print the result as one JSON object")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Predict the tide, and print or write it."""
    from thalweg.sea.tides.constituent_files import read_constituents

    times = _times(arguments)
    out = option_values.prepare_output_file(arguments.out) if arguments.out else None
    arguments.progress(f"predicting from {arguments.file}")
    constants = read_constituents(arguments.file, station=arguments.station)
    series = _series(constants, times, arguments.at)
    if arguments.json:
        print(json.dumps(_as_dict(constants, times, series), indent=2, allow_nan=False))
    elif out:
        text = io.StringIO(newline="")
        _write_csv(text, times, series)
        write_text(out, text.getvalue())
        print(f"wrote {arguments.out}")
    else:
        _write_csv(sys.stdout, times, series)
    return 0


def _times(arguments: argparse.Namespace) -> FloatArray:
    start, end = parse_time(arguments.start), parse_time(arguments.end)
    step = 60.0 * arguments.step
    if not (np.isfinite(step) and step > 0.0 and end >= start):
        raise InputError(
            f"Times every {arguments.step:g} minutes from {arguments.start} to {arguments.end} are "
            "requested.",
            "The step is positive, and the end is not before the start.",
            "Correct --start, --end or --step.",
        )
    rows = int((end - start) / step + 1e-6) + 1
    if rows > MAX_ROWS:
        raise InputError(
            f"{rows} times were requested.",
            f"A prediction has at most {MAX_ROWS}.",
            "Use a longer step.",
        )
    return start + step * np.arange(rows, dtype=np.float64)


def _series(constants: Constituents, times: Any, at: str | None) -> dict[str, Any]:
    """Return the tide of each variable, at a station or interpolated between nodes."""
    names = sorted(constants.variables)
    if constants.lat.size == 1:
        if at:
            raise InputError(
                "--at is given for a file with constants at a single place.",
                "The tide is predicted at that place; --at is for files with many nodes.",
                "Omit --at.",
            )
        return {n: constants.predict(n, times)[0] for n in names}
    if not at:
        raise InputError(
            f"The file holds {constants.lat.size} nodes.",
            "The tide is predicted at one position.",
            "Add --at LAT,LON.",
        )
    from thalweg.sea import Sea

    lat, lon = option_values.position_from_text(at)
    found = Sea.from_tides(constants).series(names, times, np.array([lat]), np.array([lon]))
    if all(np.isnan(v).all() for v in found.values()):
        raise InputError(
            f"There is no tide at {at}.",
            "It is outside the nodes of the file, or next to one without a tide.",
            "Choose another position.",
        )
    return {n: v[0] for n, v in found.items()}


def _as_dict(constants: Constituents, times: Any, series: dict[str, Any]) -> dict[str, Any]:
    return {
        "times": [format_time(t) for t in times],
        "variables": {n: [rounded_or_none(x, 6) for x in v] for n, v in series.items()},
        "constituents": list(constants.names),
        "convention": constants.convention,
        "source": dict(constants.facts),
    }


def _write_csv(file: TextIO, times: Any, series: dict[str, Any]) -> None:
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(["time", *series])
    writer.writerows(_lines(times, series))


def _lines(times: Any, series: dict[str, Any]) -> Iterator[list[str]]:
    columns = list(series.values())
    for k, time in enumerate(times):
        numbers = [f"{c[k]:.4f}" if np.isfinite(c[k]) else "" for c in columns]
        yield [format_time(time), *numbers]
