"""Data that a ship and a voyage require of the sea, and the assumptions where there are none."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from thalweg.chart import Chart
from thalweg.core.errors import MissingVariableError, OutsidePeriodError
from thalweg.core.limits import Limits
from thalweg.core.time import format_time
from thalweg.kernels import codes
from thalweg.planning.voyage import Voyage
from thalweg.sea import Sea, standard_names
from thalweg.sea.fill_policies import fill_hint
from thalweg.ship import Ship
from thalweg.ship.condition_variables import WAVES
from thalweg.ship.ship_assumptions import stated_assumptions, unchecked_depth_note

_CHANNEL_OF = {name: channel for channel, name in standard_names.CHANNEL_VARIABLES.items()}


@dataclass(frozen=True)
class Requirements:
    """What the legs of a voyage are computed from and checked against.

    Attributes
    ----------
    channels : Channels of the sea to freeze (see `thalweg.kernels.codes`).
    limits : Limits along the route.
    notes : Assumptions for data that are missing.
    data_end : Last time at which the sea covers all channels [s since 1970]; may be infinite.
    """

    channels: tuple[int, ...]
    limits: Limits
    notes: tuple[str, ...]
    data_end: float


def derive_requirements(voyage: Voyage, *, ship: Ship, sea: Sea, chart: Chart) -> Requirements:
    """Check that the sea supplies what the ship and the voyage need.

    Parameters
    ----------
    voyage : The request.
    ship : The ship that sails it.
    sea : Currents, levels, waves and wind.
    chart : Land, depth and zones.

    Returns
    -------
    Requirements : Required variables, and the assumptions where data are absent.

    Raises
    ------
    MissingVariableError : If a model or a limit of the ship needs a variable that no data hold, or
        a clearance is required and there is no depth.
    OutsidePeriodError : If the departure is outside the period of the data.
    """
    needed = variables_of_request(voyage, ship)
    check_variables(ship, sea, needed)
    notes = [*sea.assumptions, *stated_assumptions(ship)]
    channels = {_CHANNEL_OF[name] for name in needed if name in _CHANNEL_OF}
    if all(name in sea.variables for name in standard_names.CURRENT.pair):
        channels |= {codes.CURRENT_EAST, codes.CURRENT_NORTH}
    else:
        notes.append("No currents in the data: still water is assumed.")
    required = _required_depth(voyage, ship, sea, chart, notes)
    if math.isfinite(required):
        if standard_names.WATER_LEVEL in sea.variables:
            channels.add(codes.WATER_LEVEL)
        else:
            notes.append("No water levels in the data: depths are taken at chart datum.")
        if standard_names.BED_DEPTH in sea.variables:
            channels.add(codes.BED_DEPTH)
    limits = Limits(required, ship.limits.wave_height, ship.limits.wind_speed)
    data_end = check_departure_in_data(voyage, sea, channels)
    return Requirements(tuple(sorted(channels)), limits, tuple(notes), data_end)


def variables_of_request(voyage: Voyage, ship: Ship) -> frozenset[str]:
    """Return the variables of the sea that a ship and the objective of a voyage need.

    Returns
    -------
    frozenset of str : CF standard names; for comfort those of the waves as well.
    """
    return ship.needs | (
        WAVES if voyage.objective == "comfort" or voyage.asks_for_motions else frozenset()
    )


def check_variables(ship: Ship, sea: Sea, needed: frozenset[str] | None = None) -> None:
    """Raise `MissingVariableError` if variables are needed that a sea does not have.

    Parameters
    ----------
    needed : By default what the ship needs.
    """
    needed = ship.needs if needed is None else needed
    missing = sorted(name for name in needed if name not in sea.variables)
    if missing:
        raise MissingVariableError(
            f"The ship {ship.name!r} needs data that the sea does not have: "
            f"{standard_names.plain_names(missing)}.",
            f"The sea has: {standard_names.plain_names(sea.variables)}.",
            f"Add a file with {'it' if len(missing) == 1 else 'them'}, or fill by name: "
            f"{fill_hint(missing, sea.variables)}.",
            missing=missing,
        )


def _required_depth(voyage: Voyage, ship: Ship, sea: Sea, chart: Chart, notes: list[str]) -> float:
    known = chart.has_depth or standard_names.BED_DEPTH in sea.variables
    if voyage.min_ukc_m is not None and not known:
        raise MissingVariableError(
            f"The voyage requires an under-keel clearance of {voyage.min_ukc_m:g} m, but neither "
            "the chart nor the sea provides depth.",
            "Depth comes from a chart with depth (--depth FILE) or from a sea with a bed level.",
            "Add depth, or plan without a clearance and check the depth on the chart.",
            field="min_ukc_m",
        )
    if "depth" in ship.reads and not known:
        raise MissingVariableError(
            f"The speed of {ship.name!r} depends on the water depth, but neither the chart nor the "
            "sea provides depth.",
            "Depth comes from a chart with depth (--depth FILE) or from a sea with a bed level.",
            "Add depth, or use a ship file without a shallow-water method.",
        )
    if not known:
        notes.append(unchecked_depth_note(ship))
        return -math.inf
    return float(ship.draught) + required_under_keel_clearance(voyage, ship)


def required_under_keel_clearance(voyage: Voyage, ship: Ship) -> float:
    """Return the required under-keel clearance [m]: that of the voyage, else of the ship file.

    Parameters
    ----------
    voyage : The request.
    ship : The ship, with the clearance of its file.

    Returns
    -------
    float : Clearance [m]; `Ship.min_under_keel_clearance` if the voyage gives none.
    """
    if voyage.min_ukc_m is not None:
        return voyage.min_ukc_m
    return ship.min_under_keel_clearance


def period_of_data(ship: Ship, sea: Sea) -> tuple[float, float]:
    """Return the first and last time at which all that a ship needs is covered [s since 1970].

    Parameters
    ----------
    sea : Its currents count as well, where it has them.

    Returns
    -------
    first, last : Infinite where the sea does not change with time.
    """
    names = {name for name in standard_names.CHANNEL_VARIABLES.values() if name in ship.needs}
    if all(name in sea.variables for name in standard_names.CURRENT.pair):
        names.update(standard_names.CURRENT.pair)
    return _covered_period(sea, names)


def _covered_period(sea: Sea, names: set[str]) -> tuple[float, float]:
    periods: dict[str, list[tuple[float, float]]] = {}
    for row in sea.coverage():
        if row.variable in names:
            start = -math.inf if row.start is None else row.start
            end = math.inf if row.end is None else row.end
            periods.setdefault(row.variable, []).append((start, end))
    first = max((min(s for s, _ in rows) for rows in periods.values()), default=-math.inf)
    last = min((max(e for _, e in rows) for rows in periods.values()), default=math.inf)
    return first, last


def check_departure_in_data(voyage: Voyage, sea: Sea, channels: Iterable[int]) -> float:
    """Return the last time at which all channels are covered; check that the ship departs in it."""
    needed = {standard_names.CHANNEL_VARIABLES[channel] for channel in channels}
    first, last = _covered_period(sea, needed)
    if not first <= voyage.earliest_departure < last or voyage.latest_departure >= last:
        earliest, latest = (
            format_time(time) for time in (voyage.earliest_departure, voyage.latest_departure)
        )
        raise OutsidePeriodError(
            f"Departure {earliest} is outside the data."
            if voyage.depart_window is None
            else f"The window of departures {earliest} to {latest} reaches outside the data.",
            f"The data run from {format_time(first)} to {format_time(last)}.",
            "Choose a departure in that period, or add data.",
            field="depart",
        )
    return last
