"""The demonstration voyage: Halifax to Bishop Rock while a hurricane's remains catch up."""

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

    The shortest way meets Danielle (1998) south-west of Ireland, where the storm, fresh from its
    turn to the north-east, overtakes the ship. The departure was chosen for that: most others
    miss the storm, and the routes with and without the weather are then the same.
    """
    return Voyage(start="Halifax", goal="49.7N 6.5W", depart="1998-08-31T12:00Z")


def weather_blind(found: Plan, *, ship: Ship, sea: Sea, chart: Chart) -> Route:
    """Return the route that ignores the weather, scored by the referee in the same weather."""
    calm = plan(replace(found.voyage), ship=ship, sea=Sea.calm(), chart=chart)
    return evaluate(calm.best.track, ship=ship, sea=sea, chart=chart, strict=False)
