"""What the size of a ship closes and opens in distances by sea."""

from __future__ import annotations

from typing import NamedTuple

from thalweg.chart import Chart
from thalweg.chart.passages import SMALL_SHIP_LENGTH
from thalweg.planning.request.offing_choice import ship_dimensions
from thalweg.ship import Ship


class SizeClosures(NamedTuple):
    """What the size of a ship closes and opens.

    Attributes
    ----------
    closed : Names of the canals and passages that are too small for her.
    opened : ``("all",)`` where passages for small ships are open to her, else empty.
    """

    closed: tuple[str, ...]
    opened: tuple[str, ...]


def closed_and_open(ship: Ship, chart: Chart, small_canals: tuple[str, ...] = ()) -> SizeClosures:
    """Return what the size of a ship closes and opens, as plans choose it.

    Parameters
    ----------
    ship : Dimensions that are not known are not checked.
    chart : Its canals and passages.
    small_canals : Those that a ship of unknown length does not use.
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
    return SizeClosures(tuple(closed), ("all",) if small else ())
