"""``thalweg ship``: resistance, power, fuel and emissions of a ship, as table, JSON or pictures."""

from __future__ import annotations

import argparse
import json
import math
from pathlib import Path
from typing import Any, Final

from thalweg.core.errors import InputError


def add_ship_command(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "ship",
        help="show what a ship needs at each speed",
        description="Resistance by component, power, fuel and CO2 of a ship in given weather.",
    )
    parser.add_argument("ship", nargs="?", metavar="NAME|FILE", help="library ship or YAML file")
    parser.add_argument("--list", action="store_true", help="list the ships that have a name")
    parser.add_argument("--speed", metavar="KN", help="8:16, 8:16:0.5 or 10,12,14")
    parser.add_argument("--hs", type=float, metavar="M", help="significant wave height")
    parser.add_argument("--tp", type=float, metavar="S", help="peak wave period")
    parser.add_argument("--wave-from", type=float, metavar="DEG", help="off the bow, 0 from ahead")
    parser.add_argument("--wind", type=float, metavar="M/S", help="true wind at 10 m")
    parser.add_argument("--wind-from", type=float, metavar="DEG", help="off the bow, 0 from ahead")
    parser.add_argument("--crab", type=float, metavar="DEG", help="crab angle, for rudder drag")
    parser.add_argument("--water-depth", type=float, metavar="M", help="depth of the water")
    parser.add_argument("--load-factor", type=float, metavar="0..1", help="0 empty, 1 full")
    parser.add_argument("--strict", action="store_true", help="refuse methods outside their range")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument("--out", metavar="DIR", help="folder for ship.json and the pictures")
    parser.set_defaults(run=run_ship)


def run_ship(arguments: argparse.Namespace) -> int:
    """Compute, print and draw."""
    from thalweg.ship import Ship, library_names, plugin_names
    from thalweg.ship.performance_sheet import performance_sheet

    names = [*library_names(), *plugin_names()]
    if arguments.list:
        as_json = json.dumps({"ships": names}, indent=2, allow_nan=False)
        print(as_json if arguments.json else "\n".join(names))
        return 0
    if arguments.ship is None:
        raise InputError(
            "No ship is named.",
            f"Ships with a name: {', '.join(names)}.",
            "Give a name or a ship file.",
        )
    ship = Ship.load(arguments.ship)
    if arguments.load_factor is not None:
        ship = ship.with_load_factor(arguments.load_factor)
    speeds = [] if arguments.speed is None else parse_speeds(arguments.speed)
    weather = _weather(arguments)
    sheet = performance_sheet(ship, weather, speeds_kn=speeds)
    _refuse(sheet, arguments.strict)
    pictures = _draw(ship, sheet, weather, arguments.out) if arguments.out else []
    if arguments.json:
        print(json.dumps(sheet, indent=2, allow_nan=False))
        return 0
    print_sheet(sheet)
    for path in pictures:
        print(f"wrote {path}")
    return 0


add_command, run = add_ship_command, run_ship


_MAX_SPEEDS: Final = 1000


def parse_speeds(text: str) -> list[float]:
    """Read ``8:16``, ``8:16:0.5`` or ``10,12,14`` as speeds [kn].

    Raises
    ------
    InputError
    """
    wrong = InputError(
        f"{text!r} are not speeds.",
        "Speeds are knots: a list 10,12,14, a range 8:16, or a range with a step 8:16:0.5; "
        f"{_MAX_SPEEDS} at most.",
        "Write them that way.",
        value=text,
    )
    try:
        numbers = [float(part) for part in text.replace(":", ",").split(",")]
    except ValueError:
        raise wrong from None
    if not all(math.isfinite(n) and n > 0 for n in numbers):
        raise wrong
    if ":" not in text and len(numbers) <= _MAX_SPEEDS:
        return numbers
    if len(numbers) not in (2, 3) or "," in text or numbers[1] < numbers[0]:
        raise wrong
    step = numbers[2] if len(numbers) == 3 else 1.0
    steps = (numbers[1] - numbers[0]) / step + 1e-9
    if steps >= _MAX_SPEEDS:
        raise wrong
    return [numbers[0] + k * step for k in range(math.floor(steps) + 1)]


#: option, greatest value, and whether it must be above 0
_RANGES: Final = {
    "wave_height": ("--hs", 40.0, False),
    "wave_period": ("--tp", 60.0, True),
    "wind_speed": ("--wind", 150.0, False),
    "depth": ("--water-depth", 12_000.0, True),
}


def _weather(arguments: argparse.Namespace) -> dict[str, float]:
    given = {
        "wave_height": arguments.hs,
        "wave_period": arguments.tp,
        "wind_speed": arguments.wind,
        "depth": arguments.water_depth,
    }
    found = {name: value for name, value in given.items() if value is not None}
    for name, value in found.items():
        option, most, above = _RANGES[name]
        if not (0.0 <= value <= most) or (above and value == 0.0):
            words = name.replace("_", " ")
            least = "above 0" if above else "at least 0"
            raise InputError(
                f"The {words} is {value:g}.",
                f"It is {least} and at most {most:g}.",
                f"Correct {option}.",
                option=option,
            )
    angles = {"wave_angle": ("--wave-from", arguments.wave_from)}
    angles["wind_angle"] = ("--wind-from", arguments.wind_from)
    for name, (option, degrees) in angles.items():
        if degrees is not None:
            if not math.isfinite(degrees):
                raise InputError(f"{option} is {degrees:g}.", "It is in degrees.", "Correct it.")
            found[name] = math.radians(abs((degrees + 180.0) % 360.0 - 180.0))
    if arguments.crab is not None:
        if not abs(arguments.crab) <= 35.0:
            raise InputError(
                f"The crab angle is {arguments.crab:g} degrees.",
                "The rudder's curve goes to 35 degrees.",
                "Give a smaller angle.",
            )
        found["crab_angle"] = math.radians(arguments.crab)
    return found


def _refuse(sheet: dict[str, Any], strict: bool) -> None:
    from thalweg.core.errors import ModelRangeError

    notes = sorted({note for row in sheet["conditions"] for note in row["warnings"]})
    notes += sheet["warnings"]
    if strict and notes:
        raise ModelRangeError(
            "; ".join(notes) + ".",
            "Each method holds in the range it was fitted for.",
            "Choose other methods or speeds, or leave --strict out.",
            notes=notes,
        )


def print_sheet(sheet: dict[str, Any]) -> None:
    """Print the sheet for a person."""
    from rich import box
    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table

    console = Console()
    console.print(f"[bold]{escape(sheet['name'])}[/bold], draught {sheet['draught_m']:.2f} m")
    table = Table(box=box.SIMPLE, pad_edge=False, padding=(0, 1, 0, 0))
    composed = any(row["resistance_n"]["total"] is not None for row in sheet["conditions"])
    heads = ["speed\nkn"]
    if composed:
        heads += ["resistance\nkN", "waves\nkN", "wind\nkN"]
    heads += ["power\nkW", "fuel\nkg/h", "fuel\nkg/nm", "CO2\nkg/h", "CII\ng/(t nm)"]
    for head in heads:
        table.add_column(head, justify="right", no_wrap=True)
    for row in sheet["conditions"]:
        forces = row["resistance_n"]
        cells = [_text(row["speed_kn"], 2)]
        if composed:
            cells += [_text(_in_thousands(forces[name]), 1) for name in ("total", "waves", "wind")]
        cii = row["cii"]
        cells += [
            _text(row["brake_power_kw"], 0),
            _text(row["fuel_kg_per_h"], 0),
            _text(row["fuel_kg_per_nm"], 1),
            _text(row["co2_kg_per_h"], 0),
            f"{cii['attained_g_per_t_nm']:.2f} {cii['rating_2026'] or ''}" if cii else "-",
        ]
        table.add_row(*cells)
    console.print(table)
    _print_notes(console, sheet)


def _print_notes(console: Any, sheet: dict[str, Any]) -> None:
    from rich.markup import escape

    def show(head: str, text: str) -> None:
        console.print(head + escape(text), highlight=False)

    for note in sheet["warnings"]:
        show("[yellow]warning:[/yellow] ", note)
    for note in sheet["assumed"]:
        show("Assumed: ", note)
    for where, note in merged_notes(sheet["conditions"]):
        show(f"[yellow]warning[/yellow] at {where} kn: ", note)
    for note in sheet["missing"]:
        show("Not known: ", note)
    if sheet["estimated"]:
        console.print("Estimated, not given:")
        for one in sheet["estimated"]:
            value = one["value"] if isinstance(one["value"], str) else f"{one['value']:.5g}"
            show("  ", f"{one['key']} = {value}  ({one['method']})")
    for source in sheet["sources"]:
        show("Source: ", source)


def merged_notes(rows: list[dict[str, Any]]) -> list[tuple[str, str]]:
    """Return the warnings of rows as (speeds, text); those that differ in a value only, once."""
    found: dict[str, list[tuple[float, str]]] = {}
    for row in rows:
        for note in row["warnings"]:
            head, _, value = note.partition(" is ")
            value, _, bounds = value.partition(", ")
            found.setdefault(f"{head} is {{}}, {bounds}" if bounds else note, []).append(
                (row["speed_kn"] or 0.0, value)
            )
    gathered = []
    for note, where in found.items():
        speeds = _ends([f"{speed:.4g}" for speed, _ in sorted(where)])
        gathered.append((speeds, note.replace("{}", _ends([value for _, value in where]))))
    return gathered


def _ends(words: list[str]) -> str:
    return " to ".join(dict.fromkeys((words[0], words[-1])))


def _draw(ship: Any, sheet: dict[str, Any], weather: dict[str, float], out: str) -> list[Path]:
    from thalweg.cli.ship_plots import draw_ship

    folder = Path(out)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "ship.json").write_text(json.dumps(sheet, indent=2, allow_nan=False) + "\n")
    except OSError as problem:
        raise InputError(
            f"The folder {folder} cannot be written: {problem.strerror or problem}.",
            "It is made when it does not exist, with ship.json and pictures in it.",
            "Give another folder with --out.",
            folder=str(folder),
        ) from None
    return [folder / "ship.json", *draw_ship(ship, sheet, weather, folder)]


def _in_thousands(value: float | None) -> float | None:
    return None if value is None else value / 1000.0


def _text(value: float | None, digits: int) -> str:
    return "-" if value is None else f"{value:,.{digits}f}"
