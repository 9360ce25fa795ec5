"""Speeds between those that a plan chooses among: what they would save, and a note on them."""

from __future__ import annotations

from typing import Final

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.units import KNOT
from thalweg.planning.pareto.trade_off_context import TradeOffContext
from thalweg.planning.report.note_order import SPEEDS_CHOSEN
from thalweg.ship.consumption import calm_water_consumption

_NOTABLE: Final = 0.003  # share of the value
_STEP_KN: Final = 0.5  # that the note proposes


def most_saved_between(trade_off: TradeOffContext) -> float:
    """Return the greatest share of the value that a held speed saves over a mixture of settings.

    A ship sails half of the time of a metre at each of two neighbouring settings, or all of it at
    the speed between them that is as fast, in calm water.

    Returns
    -------
    float
        0 where no speed between the settings can be ordered.
    """
    ship, prices = trade_off.context.ship, trade_off.objective.prices
    speeds = np.asarray(ship.speeds, float)[trade_off.settings]
    if len(speeds) < 2 or not np.isfinite(trade_off.calm_water_cost_rates).all():
        return 0.0
    between = 2.0 / (1.0 / speeds[:-1] + 1.0 / speeds[1:])
    try:
        rates = calm_water_consumption(ship.with_speeds(between), prices.consumption, prices.mix)
    except InputError:  # the model has these speeds alone
        return 0.0
    held = (prices.outside * rates + prices.time) / between
    mixed = trade_off.calm_water_cost_rates / speeds
    with np.errstate(divide="ignore", invalid="ignore"):
        saved = 1.0 - held / (0.5 * (mixed[:-1] + mixed[1:]))
    return float(np.nanmax(saved, initial=0.0))


def note_on_speeds_between(trade_off: TradeOffContext) -> str:
    """Return a note where speeds between the settings would clearly save; else an empty text."""
    saved = most_saved_between(trade_off)
    if saved < _NOTABLE:
        return ""
    speeds = np.asarray(trade_off.context.ship.speeds, float)[trade_off.settings] / KNOT
    listed = ", ".join(f"{speed:.1f}" for speed in speeds)
    return (
        f"{SPEEDS_CHOSEN} {len(speeds)} speeds ({listed} kn), and the bound is for these: a "
        f"speed between two of them may take up to {saved:.1%} less {trade_off.objective.name}. "
        f"--speed-step {_STEP_KN:g} (speed_step_kn) counts such speeds, too."
    )
