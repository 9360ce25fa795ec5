"""Names of the parts of the cost of a route."""

from __future__ import annotations

from typing import Final

#: Columns of legs that add up to the cost, by the name of the part.
COST_PARTS: Final = {
    "fuel": "cost_of_fuel",
    "EU charges": "cost_of_eu_charges",
    "time": "cost_of_time",
    "canal dues": "cost_of_canals",
}
