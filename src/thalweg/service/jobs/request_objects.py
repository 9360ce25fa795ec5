"""From a request of a client to the objects of the library: ship, sea and chart."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from thalweg.core.units import DAY, HOUR
from thalweg.planning.request.filled_sea import filled_in_turns
from thalweg.planning.request.voyage_surroundings import (
    chart_of_entries,
    ship_of_entries,
    with_year_of_rules,
)
from thalweg.service.jobs.plan_request import (
    EMBEDDED_SEAS,
    EvaluationRequest,
    PlanRequest,
    ShipAndSea,
)

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.network.history.history_corridor import HistoryCorridor
    from thalweg.sea import Sea
    from thalweg.ship import Ship


@dataclass(frozen=True)
class WorldOfJob:
    """The ship, sea and chart of a job."""

    ship: Ship
    sea: Sea
    chart: Chart


def open_world(request: ShipAndSea, files: Mapping[str, str]) -> WorldOfJob:
    """Return the objects that a request names.

    Parameters
    ----------
    files : mapping of str to str
        Paths of the uploaded files by their id; of a ship file by the name of the ship.
    """
    chart = chart_of_entries(
        request.coast,
        depths=[files[name] for name in request.depths],
        areas=[request.areas] if request.areas else [],
        traffic=[files[name] for name in request.traffic],
        eca=request.eca,
    )
    sea = open_seas(
        request.seas, files, average_over_m=request.average_over_m, variables=request.variables
    )
    sea = filled_in_turns(sea, request.fill_policies, chart)
    return WorldOfJob(open_ship_of(request, files), sea.sampled(request.sampling), chart)


def network_of(request: PlanRequest, files: Mapping[str, str]) -> str | HistoryCorridor:
    """Return the network of a request, as `plan` takes it."""
    from thalweg.network.history.history_corridor import HistoryCorridor
    from thalweg.network.history.history_file import read_history

    if request.history is None:
        return request.network
    gain = request.corridor_gain_percent
    history = read_history(files[request.history])
    return HistoryCorridor(history, gain=None if gain is None else gain / 100.0)


def open_ship_of(request: ShipAndSea, files: Mapping[str, str]) -> Ship:
    """Return the ship of a request, with its load and limits."""
    voyage = getattr(request, "voyage", {})
    times = voyage or {"depart": getattr(request, "depart", None)}
    charges = None if request.charges is None else request.charges.model_dump()
    return ship_of_entries(
        files.get(request.ship, request.ship),
        load_factor=request.load_factor,
        limits=request.limits.model_dump(),
        charges=None if charges is None else with_year_of_rules(charges, times),
        ends=(voyage.get("start"), voyage.get("goal")),
    )


def with_orders_of(ship: Ship, request: EvaluationRequest) -> Ship:
    """Return a ship with prices and clearance of an evaluation, holding the ordered speed."""
    from thalweg.ship.held_speed import with_held_power, with_held_speed

    hourly = request.time_price_usd_per_h
    ship = ship.with_prices(
        request.fuel_price_usd,
        request.eca_price_factor,
        time_usd_per_day=None if hourly is None else hourly * DAY / HOUR,
    )
    if request.min_ukc_m is not None:
        ship = ship.with_clearance(request.min_ukc_m)
    if request.hold is None or request.speed_kn is None:
        return ship
    hold = with_held_speed if request.hold == "speed" else with_held_power
    return hold(ship, request.speed_kn)


def open_seas(
    names: list[str],
    files: Mapping[str, str],
    *,
    average_over_m: float | None = None,
    variables: Mapping[str, str] | None = None,
) -> Sea:
    """Return the sea of a list of names, the first with priority."""
    from thalweg.sea import Sea

    embedded = {"calm": Sea.calm, "storm": Sea.storm}
    uploaded = [files[name] for name in names if name not in EMBEDDED_SEAS]
    options: dict[str, Any] = {"mapping": variables, "draught_m": average_over_m}
    parts = [Sea.open(*uploaded, **options)] if uploaded else []
    parts += [embedded[name]() for name in names if name in EMBEDDED_SEAS]
    return parts[0] if len(parts) == 1 else Sea.layered(*parts)
