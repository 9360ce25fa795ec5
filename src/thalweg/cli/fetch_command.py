"""``thalweg fetch``: download a forecast for a box and a period."""

from __future__ import annotations

import argparse
import json
import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from thalweg.cli.exit_codes import SUCCESS
from thalweg.core.errors import InputError
from thalweg.core.given_numbers import to_number
from thalweg.core.time import format_time
from thalweg.core.units import HOUR

if TYPE_CHECKING:
    from thalweg.forecasts import ForecastRequest


def add_command(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "fetch",
        help="download a forecast for a box and a period",
        description="Download wind, waves or currents from a public server, cut to a box, and "
        "write one NetCDF file for --sea. Without SOURCE the sources are listed. What has arrived "
        "is kept: a broken download goes on where it stopped.",
        epilog="Example: thalweg fetch gfs --box 40,60,-75,5 --from 2026-11-22T12:00Z "
        "--to 2026-12-02T12:00Z --out forecast.nc",
    )
    parser.add_argument(
        "source",
        nargs="?",
        metavar="SOURCE",
        help="gfs, ecmwf, open-meteo, matroos, rws, copernicus or era5",
    )
    parser.add_argument(
        "--box", metavar="S,N,W,E", help="area [deg]; an east below west spans the antimeridian"
    )
    parser.add_argument("--from", dest="start", metavar="TIME", help="first time, UTC")
    parser.add_argument("--to", dest="end", metavar="TIME", help="last time, UTC")
    parser.add_argument("--out", metavar="FILE", help="NetCDF file to write")
    parser.add_argument(
        "--quantities",
        metavar="LIST",
        help="of wind,waves,current,level,ice,pressure (default: current of matroos and "
        "copernicus, level of rws, else wind,waves)",
    )
    parser.add_argument(
        "--step", type=float, default=3.0, metavar="H", help="hours between fields (default: 3)"
    )
    parser.add_argument(
        "--run",
        dest="run_time",
        metavar="TIME",
        help="start of the forecast run (default: the latest complete one)",
    )
    parser.add_argument(
        "--members", type=int, default=0, metavar="N", help="members of the ensemble (ecmwf)"
    )
    parser.add_argument(
        "--server",
        choices=("nomads", "aws"),
        default="nomads",
        help="server of gfs: nomads cuts the box (last ten days), aws keeps runs since 2021 and "
        "sends whole fields (default: nomads)",
    )
    parser.add_argument(
        "--max-mb",
        type=float,
        default=2000.0,
        metavar="MB",
        help="largest download (default: 2000)",
    )
    parser.add_argument(
        "--estimate", action="store_true", help="print the size of the download and stop"
    )
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Download a forecast, or list the sources."""
    from thalweg.forecasts.fetching import estimate_forecast, fetch_forecast, source_named
    from thalweg.forecasts.source_table import SOURCES, usual_quantities
    from thalweg.forecasts.sources.gfs import Gfs

    if arguments.source is None:
        return _list_sources(dict(SOURCES), as_json=arguments.json)
    source = source_named(arguments.source)
    if isinstance(source, Gfs):
        source = replace(source, server=arguments.server)
    if not arguments.max_mb > 0.0:
        raise InputError(
            f"The largest download is {arguments.max_mb:g} MB.",
            "It is above 0 MB.",
            "Correct --max-mb, or leave it out.",
        )
    request = _request(arguments, usual_quantities(source.name))
    if arguments.estimate:
        arguments.progress(f"asking {source.title} what it has")
        plan = estimate_forecast(request, source)
        facts: dict[str, Any] = {
            "source": source.title,
            "run": None if plan.run is None else format_time(plan.run),
            "times": len(plan.times),
            "megabytes": round(plan.bytes / 1e6, 1),
        }
    else:
        if arguments.out is None:
            raise InputError(
                "No file to write was given.",
                "The forecast is written as NetCDF.",
                "Give --out FILE, or --estimate for the size alone.",
            )
        done = fetch_forecast(
            request,
            source,
            arguments.out,
            most_bytes=1e6 * arguments.max_mb,
            progress=arguments.progress,
        )
        facts = {
            "source": source.title,
            "run": None if done.run is None else format_time(done.run),
            "from": format_time(done.first),
            "to": format_time(done.last),
            "variables": list(done.variables),
            "megabytes": round(done.bytes / 1e6, 1),
            "files": [str(path) for path in done.files],
            "licence": source.licence,
            "attribution": source.attribution,
        }
    if arguments.json:
        print(json.dumps(facts, indent=2, allow_nan=False))
    else:
        for name, value in facts.items():
            if value is not None:
                print(f"{name}: {', '.join(value) if isinstance(value, list) else value}")
    return SUCCESS


def _request(arguments: argparse.Namespace, usual: tuple[str, ...]) -> ForecastRequest:
    from thalweg.core.bounding_box import BoundingBox
    from thalweg.forecasts import ForecastRequest

    missing = [
        word
        for word, value in (
            ("--box", arguments.box),
            ("--from", arguments.start),
            ("--to", arguments.end),
        )
        if value is None
    ]
    if missing:
        raise InputError(
            f"{' and '.join(missing)} not given.",
            "A forecast is fetched for a box and a period.",
            "See thalweg fetch --help for an example.",
        )
    sides = [to_number(side) for side in arguments.box.split(",")]
    if len(sides) != 4 or not all(map(math.isfinite, sides)):
        raise InputError(
            f"The box {arguments.box!r} is not four numbers.",
            "A box is south,north,west,east in degrees.",
            "Give four values, for example --box 40,60,-75,5.",
        )
    given = arguments.quantities
    return ForecastRequest(
        BoundingBox.checked(*sides),
        arguments.start,
        arguments.end,
        usual if given is None else tuple(w.strip() for w in given.split(",") if w.strip()),
        arguments.step * HOUR,
        arguments.run_time,
        arguments.members,
    )


def _list_sources(sources: dict[str, Any], *, as_json: bool) -> int:
    rows = [
        {"source": name, "title": one.title, "quantities": list(one.quantities),
         "licence": one.licence}
        for name, one in sources.items()
    ]  # fmt: skip
    if as_json:
        print(json.dumps(rows, indent=2, allow_nan=False))
        return SUCCESS
    for row in rows:
        print(f"{row['source']:12} {row['title']}")
        print(f"{'':12} {', '.join(row['quantities'])}; {row['licence']}")
    return SUCCESS
