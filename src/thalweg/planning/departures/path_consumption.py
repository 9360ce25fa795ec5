"""What paths on networks consume, without the referee: fuel, that in control areas, CO2, cost."""

from __future__ import annotations

import math

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray
from thalweg.core.units import TONNE
from thalweg.planning.departures.path_points import PathPoints
from thalweg.planning.planning_context import PlanningContext
from thalweg.route import Route
from thalweg.ship.conditions import Conditions
from thalweg.ship.consumption import consumption_table


def consumed_by_route(route: Route) -> dict[str, float]:
    """Return the fuel [t], that in control areas [t], CO2 [t] and cost of a route; NaN: unknown."""
    values = {
        "fuel_t": route.fuel_t,
        "fuel_eca_t": route.fuel_eca_t,
        "co2_t": route.co2_t,
        route.cost_name: route.cost,
    }
    return {name: math.nan if value is None else float(value) for name, value in values.items()}


def consumed_by_paths(
    context: PlanningContext, conditions: Conditions, at: PathPoints
) -> dict[str, FloatArray]:
    """Return what paths consume, waits included, as `consumed_by_route` names it.

    The share of every piece inside control areas burns the fuel inside. Energy is left out.

    Returns
    -------
    dict of str to float64 array (paths,) : NaN where unknown; without ``fuel_eca_t`` where no
        areas count.
    """
    terms = context.ship.fuel_terms
    ship, waits = context.ship, at.waits
    lying = waits.seconds * float(ship.waiting_fuel_rate) if len(waits.seconds) else waits.seconds
    mass = np.concatenate([_fuel_rate(context, conditions, at) * at.seconds, lying])
    seconds = np.concatenate([at.seconds, waits.seconds])
    owner = np.concatenate([at.path, waits.path])
    still = waits.lat, waits.lon
    areas = getattr(context.chart, "control_areas", None)
    share = np.zeros(len(mass))
    if areas is not None:
        share = np.concatenate([areas.eca_fraction(*at.ends), areas.in_eca(*still)])

    def total(values: FloatArray) -> FloatArray:
        return np.bincount(owner, weights=values, minlength=at.count).astype(np.float64)

    burnt, inside = terms.of_fuel("fuel", mass, share)
    found = {"fuel_t": total(burnt) / TONNE}
    if areas is not None:
        found["fuel_eca_t"] = total(inside) / TONNE
    cubed = np.zeros(len(mass))
    cubed[: len(at.seconds)] = float(ship.speeds[context.setting]) ** 3 * at.seconds
    if terms.emits_by_speed:
        found["co2_t"] = total(terms.cubed_speed_co2 * cubed) / TONNE
    else:
        found["co2_t"] = total(terms.of_fuel("co2", mass, share)[0]) / TONNE
    if terms.by_speed:
        spent = terms.cubed_speed_price * cubed
    else:
        spent = terms.of_fuel("cost", mass, share)[0]
    if context.chart.zones.price:
        zones = context.chart.zones
        factors = [zones.factors(*ends)[1] for ends in (at.ends, (*still, *still))]
        spent = np.concatenate(factors) * spent
    cost = total(spent) + terms.time_price * total(seconds)
    return found | {f"cost_{(terms.currency or 'USD').casefold()}": cost}


def _fuel_rate(context: PlanningContext, conditions: Conditions, at: PathPoints) -> FloatArray:
    """Return the fuel rate [kg/s] at points; NaN where it is unknown."""
    try:
        table = consumption_table(context.ship, "fuel")
    except InputError:
        return np.full(len(at.lat), math.nan)
    if not table.axes <= set(conditions):
        return np.full(len(at.lat), math.nan)
    return np.broadcast_to(table.lookup(conditions, context.setting), at.lat.shape)
