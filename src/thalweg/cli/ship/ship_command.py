"""``thalweg ship``: resistance, power, fuel and emissions of a ship."""

from __future__ import annotations

import argparse
import json
import math
from pathlib import Path
from typing import Any, Final

from thalweg.cli import options
from thalweg.cli.ship.motion_table import draw_motions, print_motions
from thalweg.cli.ship.ship_sheet_table import print_sheet
from thalweg.cli.tables import print_written
from thalweg.core.errors import InputError
from thalweg.core.file_writing import make_folder, write_text
from thalweg.core.units import GRAVITY


def add_command(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "ship",
        help="resistance, power and fuel of a ship at each speed",
        description="Compute resistance by component, power, fuel, CO2 and carbon intensity (CII) "
        "of a ship at several speeds in given weather; in waves also motions and motion sickness "
        "at the places of the ship file, at the highest speed.",
        epilog="Example: thalweg ship handysize-bulker --speed 8:16 --hs 3 --wind 12 --out results",
    )
    parser.add_argument(
        "ship", nargs="?", metavar="NAME|FILE", help="ship of the library or a ship file (YAML)"
    )
    parser.add_argument("--list", action="store_true", help="list the ships of the library")
    parser.add_argument(
        "--speed",
        metavar="KN",
        help="speeds through water [kn]: a range 8:16, a range with a step 8:16:0.5, or a list "
        "10,12,14; default: those of the ship file",
    )
    _add_weather_options(parser)
    options.add_load_factor_option(parser)
    parser.add_argument(
        "--strict", action="store_true", help="stop with an error where a method is out of range"
    )
    options.add_output_options(parser, "ship.json and the plots")
    parser.set_defaults(run=run)


def _add_weather_options(parser: argparse.ArgumentParser) -> None:
    for option, metavar, text in (
        ("--hs", "M", "significant wave height [m]; default: 0"),
        ("--tp", "S", "peak wave period [s]; default: estimated from the wave height"),
        ("--wave-from", "DEG", "direction waves come from, off the bow [deg]; default: 0 (ahead)"),
        ("--wind", "M/S", "true wind speed at 10 m height [m/s]; default: 0"),
        ("--wind-from", "DEG", "direction the wind comes from, off the bow [deg]; default: 0"),
        ("--crab", "DEG", "crab angle [deg], for the drag of the rudder; default: 0"),
        ("--water-depth", "M", "depth of the water [m]; default: deep water"),
    ):
        parser.add_argument(option, type=float, metavar=metavar, help=text)


def run(arguments: argparse.Namespace) -> int:
    """Compute the performance sheet, print it and write its files."""
    from thalweg.ship import Ship, library_names, plugin_names
    from thalweg.ship.performance_sheet import performance_sheet

    names = [*library_names(), *plugin_names()]
    if arguments.list:
        as_json = json.dumps({"ships": names}, indent=2, allow_nan=False)
        print(as_json if arguments.json else "\n".join(names))
        return 0
    if arguments.ship is None:
        raise InputError(
            "No ship is given.",
            f"Ships of the library: {', '.join(names)}.",
            "Give a name or a ship file.",
        )
    arguments.progress(f"computing the performance of {arguments.ship}")
    ship = Ship.load(arguments.ship)
    if arguments.load_factor is not None:
        ship = ship.with_load_factor(arguments.load_factor)
    speeds = [] if arguments.speed is None else parse_speeds(arguments.speed)
    weather = _weather(arguments)
    sheet = performance_sheet(ship, weather, speeds_kn=speeds)
    _check_ranges(sheet, arguments.strict)
    motions = _motions(ship, weather, speeds)
    if motions is not None:
        sheet["motions"] = motions
    files = _write(ship, sheet, weather, arguments.out) if arguments.out else []
    if arguments.json:
        print(json.dumps(sheet, indent=2, allow_nan=False))
        return 0
    print_sheet(sheet)
    if motions is not None:
        print_motions(motions)
    print_written(files)
    return 0


_MAX_SPEEDS: Final = 1000


def parse_speeds(text: str) -> list[float]:
    """Read ``8:16``, ``8:16:0.5`` or ``10,12,14`` as speeds [kn].

    Raises
    ------
    InputError
    """
    wrong = InputError(
        f"--speed {text!r} is not understood.",
        "Speeds are in knots: a list 10,12,14, a range 8:16, or a range with a step 8:16:0.5; "
        f"at most {_MAX_SPEEDS}.",
        "Give the values in this form.",
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
    weather = {name: value for name, value in given.items() if value is not None}
    for name, value in weather.items():
        option, most, above = _RANGES[name]
        if not (0.0 <= value <= most) or (above and value == 0.0):
            quantity = name.replace("_", " ")
            least = "above 0" if above else "at least 0"
            raise InputError(
                f"The {quantity} is {value:g}.",
                f"It is {least} and at most {most:g}.",
                f"Correct {option}.",
                option=option,
            )
    _check_steepness(weather.get("wave_height"), weather.get("wave_period"))
    angles = {"wave_angle": ("--wave-from", arguments.wave_from)}
    angles["wind_angle"] = ("--wind-from", arguments.wind_from)
    for name, (option, degrees) in angles.items():
        if degrees is not None:
            if not -360.0 <= degrees <= 360.0:
                raise InputError(
                    f"{option} is {degrees:g} degrees.",
                    "It is an angle off the bow, 0 (ahead) to 360.",
                    f"Correct {option}.",
                    option=option,
                )
            weather[name] = math.radians(abs((degrees + 180.0) % 360.0 - 180.0))
    if arguments.crab is not None:
        if not abs(arguments.crab) <= 35.0:
            raise InputError(
                f"The crab angle is {arguments.crab:g} degrees.",
                "The lift of the rudder is known up to 35 degrees.",
                "Give a smaller angle.",
            )
        weather["crab_angle"] = math.radians(arguments.crab)
    return weather


def _check_steepness(height: float | None, period: float | None) -> None:
    """Refuse waves that break: no sea is so steep."""
    if not height or period is None:
        return
    from thalweg.ship.methods.seakeeping.wave_spectra import STEEPEST

    per_metre = 2.0 * math.pi / (GRAVITY * period**2)
    if height * per_metre > STEEPEST:
        raise InputError(
            f"Waves of {height:g} m with a peak period of {period:g} s have a steepness of "
            f"{height * per_metre:.2f}.",
            f"Seas have up to about 0.07 (2 pi Hs / (g Tp^2)): {STEEPEST / per_metre:.1f} m at "
            f"this period is the most that is taken, and {height:g} m need "
            f"{math.sqrt(height * per_metre / STEEPEST) * period:.1f} s or more.",
            "Correct --hs or --tp.",
            option="--tp",
        )


def _check_ranges(sheet: dict[str, Any], strict: bool) -> None:
    from thalweg.core.errors import ModelRangeError

    notes = sorted({note for row in sheet["conditions"] for note in row["warnings"]})
    notes += sheet["warnings"]
    if strict and notes:
        raise ModelRangeError(
            "; ".join(notes) + ".",
            "Each method is valid in the range of the data it was fitted to.",
            "Choose other methods or speeds, or omit --strict.",
            notes=notes,
        )


def _write(ship: Any, sheet: dict[str, Any], weather: dict[str, float], out: str) -> list[Path]:
    from thalweg.cli.ship.ship_plots import draw_ship

    folder = make_folder(out)
    write_text(folder / "ship.json", json.dumps(sheet, indent=2, allow_nan=False) + "\n")
    files = [folder / "ship.json", *draw_ship(ship, sheet, weather, folder)]
    if "motions" in sheet:
        files.append(draw_motions(sheet["motions"], folder / "motions.png"))
    return files


def _motions(ship: Any, weather: dict[str, float], speeds: list[float]) -> dict[str, Any] | None:
    """Return motions by place and heading, in waves and where the ship file has places."""
    from thalweg.ship.comfort.motion_sheet import motion_sheet

    if not weather.get("wave_height", 0.0) > 0.0:
        return None
    return motion_sheet(ship, weather, speed_kn=max(speeds) if speeds else None)
