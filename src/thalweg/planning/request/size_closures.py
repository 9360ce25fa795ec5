"""What the size of a ship closes and opens in distances by sea."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from thalweg.chart import Chart
from thalweg.chart.canals import Canal
from thalweg.chart.passages import SMALL_SHIP_LENGTH, Passage
from thalweg.planning.request.offing_choice import ship_dimensions
from thalweg.ship import Ship


class SizeClosures(NamedTuple):
    """What the size of a ship closes and opens.

    Attributes
    ----------
    closed : Names of the canals and passages that are too small for her, without those of which
        the draught alone is the reason.
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
    every: list[Canal | Passage] = [*chart.canals]
    every += [one for one in chart.passages if one.use == "trade"]
    closed = [one.name for one in every if _is_too_small(one, sizes)]
    length = sizes["length"]
    small = length is not None and length < SMALL_SHIP_LENGTH
    if length is None:
        closed += [name for name in small_canals if name not in closed]
    return SizeClosures(tuple(closed), ("all",) if small else ())


def _is_too_small(one: Canal | Passage, sizes: Mapping[str, float | None]) -> bool:
    """Return whether a canal or passage is too small, the draught alone not counted."""
    reason = one.transit_restriction if isinstance(one, Canal) else one.ship_restriction
    draught = sizes["draught"]
    if reason(**{**sizes, "draught": None}):
        return True
    return bool(reason(**sizes)) and not reason(draught=draught)  # long ships draw less in Suez
