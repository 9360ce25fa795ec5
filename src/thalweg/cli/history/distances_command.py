"""``thalweg distances``: a table of distances by sea between ports."""

from __future__ import annotations

import argparse
import json
import sys
from typing import Any

from thalweg.cli import option_values
from thalweg.cli.exit_codes import SUCCESS
from thalweg.core.errors import InputError
from thalweg.core.given_numbers import rounded_or_none


def add_command(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "distances",
        help="table of distances by sea between the ports of a file",
        description="Print a table of distances by sea between all ports of a CSV file: the "
        "shortest ways, about half a second for each pair, or the usual ones of a history network "
        "at once.",
        epilog="Example: thalweg distances ports.csv --out distances.csv",
    )
    parser.add_argument(
        "ports", metavar="PORTS.csv", help="CSV with a column port, name or locode; optional: lat, "
        "lon",
    )  # fmt: skip
    parser.add_argument(
        "--network",
        default="globe",
        metavar="globe|history:NET",
        help="shortest ways (globe), or usual ways of a network made by thalweg history build; "
        "default: globe",
    )
    parser.add_argument("--month", type=int, metavar="1-12", help="month, with history:NET")
    parser.add_argument(
        "--draught",
        type=float,
        metavar="M",
        help="draught [m]: shortest ways keep out of water shallower than one and a half of it "
        "where they can; usual ways leave out arcs on which only smaller ships were seen",
    )
    parser.add_argument(
        "--avoid", action="append", default=None, metavar="NAME",
        help="canal or passage that shortest ways do not use; may be repeated (default: corinth)",
    )  # fmt: skip
    parser.add_argument("--out", metavar="FILE", help="write the table as CSV")
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Print the table, and write it."""
    from thalweg.core.file_writing import write_text
    from thalweg.planning.distance_table import (
        distance_table,
        read_places,
        usual_distance_table,
    )
    from thalweg.planning.request.network_choice import history_corridor
    from thalweg.planning.sea_distance import SMALL_CANALS

    if arguments.out:
        option_values.prepare_output_file(arguments.out)
    corridor = history_corridor(arguments.network)
    _check(arguments, history=corridor is not None)
    places = read_places(arguments.ports)
    if corridor is not None:
        table = usual_distance_table(
            [name for name, _ in places], corridor.network, month=arguments.month,
            draught=arguments.draught,
        )  # fmt: skip
    else:
        avoid = SMALL_CANALS if arguments.avoid is None else arguments.avoid
        table = distance_table(
            places, avoid=avoid, draught_m=arguments.draught, progress=arguments.progress
        )
    if arguments.out:
        write_text(arguments.out, table.to_csv())
    if arguments.json:
        rows = [[rounded_or_none(x, 6) for x in row] for row in table.nm.tolist()]
        found = {"ports": list(table.names), "distance_nm": rows, "notes": list(table.notes)}
        print(json.dumps(found, indent=2, allow_nan=False))
    elif not arguments.out:
        print(table.to_csv(), end="")
    else:
        print(f"wrote {arguments.out}")
    if not arguments.json:
        for note in table.notes:
            print(f"note: {note}", file=sys.stderr)
    return SUCCESS


def _check(arguments: argparse.Namespace, *, history: bool) -> None:
    """Raise `InputError` for options that do not belong to the network."""
    if not history and arguments.network != "globe":
        raise InputError(
            f"There is no table of distances on the network {arguments.network!r}.",
            "It is made on the globe, or on a history network.",
            "Give --network globe or --network history:NET.",
        )
    wrong = ("avoid",) if history else ("month",)
    given = [f"--{name}" for name in wrong if getattr(arguments, name) is not None]
    if given:
        raise InputError(
            f"{' and '.join(given)} cannot be used with --network {arguments.network}.",
            "The month chooses among usual ways; --avoid closes water to shortest ways.",
            "Leave it out.",
        )
