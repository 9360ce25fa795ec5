"""The demonstration voyage: Halifax to Bishop Rock, overtaken by a former hurricane."""

from __future__ import annotations

from thalweg.chart import Chart
from thalweg.planning.plan import Plan
from thalweg.planning.planner import plan
from thalweg.planning.request.ordered_speed import with_order
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
    calm = plan(found.voyage, ship=ship, sea=Sea.calm(), chart=chart, proof=0.0)
    ordered = with_order(ship, found.voyage)  # the settings of the track are those of this ship
    return evaluate(
        calm.best.track,
        ship=ordered,
        sea=sea,
        chart=chart,
        min_ukc=found.voyage.min_ukc_m,
        strict=False,
    )
