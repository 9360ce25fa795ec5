"""``thalweg inspect``: what was recognised in a met-ocean file, and what not."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any


def add_command(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "inspect",
        help="say what a met-ocean file holds",
        description="Print what was recognised in a file, its coverage, steps and gaps.",
    )
    parser.add_argument("file", nargs="+", metavar="FILE")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument("--out", metavar="DIR", help="folder for the map pictures")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Inspect, print and draw."""
    from thalweg.planning.output import check_folder
    from thalweg.sea import Sea

    folder = check_folder(arguments.out) if arguments.out else None
    inspection = Sea.open(*arguments.file).describe()
    pictures: list[Path] = inspection.draw(folder) if folder else []
    if arguments.json:
        print(json.dumps(inspection.as_dict(), indent=2, allow_nan=False))
        return 0
    _show(inspection.as_dict())
    for path in pictures:
        print(f"wrote {path}")
    return 0


def _show(data: dict[str, Any]) -> None:
    raise NotImplementedError
