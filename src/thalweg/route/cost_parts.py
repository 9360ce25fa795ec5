"""Names of the parts of the cost of a route."""

from __future__ import annotations

from typing import Final

#: Columns of legs that add up to the cost, by the name of the part.
COST_PARTS: Final = {
    "fuel": "cost_of_fuel",
    "EU ETS": "cost_of_eu_allowances",
    "FuelEU": "cost_of_fueleu_penalty",
    "time": "cost_of_time",
    "canal dues": "cost_of_canals",
}
