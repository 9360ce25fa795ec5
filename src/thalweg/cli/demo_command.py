"""``thalweg demo``: an example voyage on a real coastline through a modelled storm."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

import numpy as np

from thalweg.cli import options
from thalweg.cli.first_run import announce_compilation
from thalweg.cli.tables import print_plan
from thalweg.kernels.compilation import warm_up

if TYPE_CHECKING:
    from thalweg.planning import Plan
    from thalweg.route import Route


def add_command(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "demo",
        help="example: plan a North Atlantic crossing that avoids a storm",
        description="Plan Halifax to Bishop Rock through a modelled storm on its recorded track, "
        "and compare the route with one that ignores the weather.",
    )
    parser.add_argument(
        "--out", default="demo", metavar="DIR", help="folder for files and plots (default: demo)"
    )
    parser.add_argument("--json", action="store_true", help="print the result as one JSON object")
    options.add_verbose_option(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Plan the example voyage, write its files, and compare it with the weather-blind route."""
    announce_compilation(search=True, quiet=arguments.quiet)
    warm_up.start_compiling("thalweg.planning.compile_kernels")
    from thalweg.chart import Chart
    from thalweg.core.file_writing import make_folder
    from thalweg.planning import plan as make_plan
    from thalweg.planning.demo_voyage import demo_voyage, weather_blind
    from thalweg.sea import Sea
    from thalweg.ship import Ship

    folder = make_folder(arguments.out)
    arguments.progress("reading the ship, the storm and the coastline")
    ship, sea, chart = Ship.load("handysize-bulker"), Sea.storm(), Chart.gshhg("i")
    plan = make_plan(demo_voyage(), ship=ship, sea=sea, chart=chart, progress=arguments.progress)
    arguments.progress("evaluating the route that ignores the weather")
    blind = weather_blind(plan, ship=ship, sea=sea, chart=chart)
    arguments.progress("writing the files and drawing the plots")
    files = plan.write(folder, beside=blind)
    if arguments.json:
        print(plan.to_json())
        return 0
    print_plan(plan, files, verbose=arguments.verbose)
    _print_comparison(plan, blind)
    return 0


def _print_comparison(plan: Plan, blind: Route) -> None:
    waves = "sea_surface_wave_significant_height"
    # the approach from the berth has no waves
    worst, worst_blind = (float(np.nanmax(route.samples[waves])) for route in (plan.best, blind))
    print(
        f"The route that ignores the storm takes {blind.time_h:.1f} h in the same weather and "
        f"meets waves of {worst_blind:.1f} m; this one {plan.best.time_h:.1f} h and {worst:.1f} m."
    )
