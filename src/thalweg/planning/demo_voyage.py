"""The demonstration voyage: Halifax to Bishop Rock, overtaken by a former hurricane."""

from __future__ import annotations

from dataclasses import replace

from thalweg.chart import Chart
from thalweg.planning.plan import Plan
from thalweg.planning.planner import plan
from thalweg.planning.voyage import Voyage
from thalweg.route import Route, evaluate
from thalweg.sea import Sea
from thalweg.ship import Ship


def demo_voyage() -> Voyage:
    """Return the voyage of ``make demo``.

    The shortest route meets Danielle (1998) south-west of Ireland, where the storm has turned to
    the north-east and overtakes the ship. The departure was chosen for this: with most others the
    ship does not meet the storm, and the routes with and without weather are the same.
    """
    return Voyage(start="Halifax", goal="49.7N 6.5W", depart="1998-08-31T12:00Z")


def weather_blind(found: Plan, *, ship: Ship, sea: Sea, chart: Chart) -> Route:
    """Return the route planned without weather, evaluated in the weather of the plan."""
    calm = plan(replace(found.voyage), ship=ship, sea=Sea.calm(), chart=chart, proof=0.0)
    return evaluate(calm.best.track, ship=ship, sea=sea, chart=chart, strict=False)
