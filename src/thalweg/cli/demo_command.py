"""``thalweg demo``: the main job on a real coastline and the embedded storm."""

from __future__ import annotations

import argparse
from typing import Any

from thalweg.cli import options, plan_command
from thalweg.kernels.compilation import warm_up


def add_command(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "demo",
        help="cross the North Atlantic round the embedded storm",
        description="Plan Halifax to Bishop Rock through a modelled storm on its real track.",
    )
    parser.add_argument("--out", default="demo", metavar="DIR", help="folder for the result")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Plan the demonstration voyage, and say what the storm costs a ship that ignores it."""
    warm_up.start_compiling("thalweg.planning.compile_kernels")
    from thalweg.chart import Chart
    from thalweg.planning import plan as make_plan
    from thalweg.planning.demo_voyage import demo_voyage, weather_blind
    from thalweg.planning.report.output_files import make_folder
    from thalweg.sea import Sea
    from thalweg.ship import Ship

    folder = make_folder(arguments.out)
    ship, sea, chart = Ship.load("handysize-bulker"), Sea.storm(), Chart.gshhg("i")
    progress = options.progress_callback(arguments)
    found = make_plan(demo_voyage(), ship=ship, sea=sea, chart=chart, progress=progress)
    files = found.write(folder)
    if arguments.json:
        print(found.to_json())
        return 0
    plan_command.print_plan(found)
    _print_comparison(found, weather_blind(found, ship=ship, sea=sea, chart=chart))
    for path in files:
        print(f"wrote {path}")
    return 0


def _print_comparison(found: Any, blind: Any) -> None:
    waves = "sea_surface_wave_significant_height"
    worst, worst_blind = (float(route.samples[waves].max()) for route in (found.best, blind))
    print(
        f"The route that ignores the storm takes {blind.time_h:.1f} h in the same weather and "
        f"meets waves of {worst_blind:.1f} m; this one {found.best.time_h:.1f} h and {worst:.1f} m."
    )
