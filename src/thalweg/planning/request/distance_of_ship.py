"""What the size of a ship means for the distance by sea: what is closed to her, and open."""

from __future__ import annotations

from typing import Any

from thalweg.chart import Chart
from thalweg.chart.passages import SMALL_SHIP_LENGTH
from thalweg.planning.request.offing_choice import ship_dimensions
from thalweg.ship import Ship


def distance_options(
    ship: Ship, chart: Chart, small_canals: tuple[str, ...] = ()
) -> dict[str, Any]:
    """Return the options of `thalweg.planning.sea_distance` for a ship, as plans choose them.

    Parameters
    ----------
    ship : Dimensions that are not known are not checked.
    chart : Its canals and passages.
    small_canals : Those that a ship of unknown length does not use.

    Returns
    -------
    dict : ``draught_m``, ``avoid`` with the canals and passages that are too small for the ship,
        and ``open`` with the passages for small ships, below 120 m.
    """
    sizes = ship_dimensions(ship)
    closed = [one.name for one in chart.canals if one.transit_restriction(**sizes)]
    closed += [
        one.name for one in chart.passages if one.use == "trade" and one.ship_restriction(**sizes)
    ]
    length = sizes["length"]
    small = length is not None and length < SMALL_SHIP_LENGTH
    if length is None:
        closed += [name for name in small_canals if name not in closed]
    return {
        "draught_m": sizes["draught"],
        "avoid": tuple(closed),
        "open": ("all",) if small else (),
    }
