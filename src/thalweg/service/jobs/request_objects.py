"""From a request of a client to the objects of the library: ship, sea and chart."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from thalweg.core.errors import InputError
from thalweg.core.units import DAY, HOUR, KNOT
from thalweg.planning.request.european_scope import share_between_places
from thalweg.planning.request.filled_sea import filled_in_turns
from thalweg.service.jobs.plan_request import (
    EMBEDDED_SEAS,
    EvaluationRequest,
    PlanRequest,
    RequestedCharges,
    ShipAndSea,
)

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.network.history.history_corridor import HistoryCorridor
    from thalweg.sea import Sea
    from thalweg.ship import Ship
    from thalweg.ship.methods.engine.european_charges import EuropeanCharges


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
    chart = open_coast(request.coast)
    for name in request.depths:
        chart = chart.with_depth(files[name])
    if request.areas:
        chart = chart.with_zones(request.areas)
    for name in request.traffic:
        chart = chart.with_traffic(files[name])
    chart = chart if request.eca else chart.without_eca()
    sea = open_seas(
        request.seas, files, average_over_m=request.average_over_m, variables=request.variables
    )
    sea = filled_in_turns(sea, request.fill_policies, chart)
    return WorldOfJob(open_ship_of(request, files), sea.sampled(request.sampling), chart)


def open_coast(resolution: str) -> Chart:
    """Return the chart of a resolution of GSHHG; ``none``: of a world without land."""
    from thalweg.chart import Chart

    if resolution == "none":
        return Chart.open_water(-90.0, 90.0, -180.0, 180.0)
    return Chart.gshhg(resolution)


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
    from thalweg.ship import Ship

    name = files.get(request.ship, request.ship)
    sick = request.limits.motion_sickness_percent
    ship = Ship.load(name) if sick is None else _with_comfort_limit(name, sick)
    if request.load_factor is not None:
        ship = ship.with_load_factor(request.load_factor)
    if request.charges is not None:
        ship = ship.with_charges(_charges(request.charges, request))
    given: dict[str, Any] = {}
    if request.limits.wave_height_m is not None:
        given["wave_height"] = request.limits.wave_height_m
    if request.limits.wind_speed_kn is not None:
        given["wind_speed"] = request.limits.wind_speed_kn * KNOT
    return ship.with_limits(replace(ship.limits, **given)) if given else ship


def _charges(given: RequestedCharges, request: ShipAndSea) -> EuropeanCharges:
    from thalweg.ship.methods.engine.european_charges import EuropeanCharges

    prices = given.ets_price, given.eur_rate, given.year
    if given.share_percent is not None:
        return EuropeanCharges(given.share_percent / 100.0, *prices)
    voyage = getattr(request, "voyage", {})
    share, source = share_between_places(voyage.get("start"), voyage.get("goal"))
    return EuropeanCharges(share, *prices, source)


def with_orders_of(ship: Ship, request: EvaluationRequest) -> Ship:
    """Return a ship with the prices of an evaluation, and what it holds at the ordered speed."""
    from thalweg.ship.held_speed import with_held_power, with_held_speed

    hourly = request.time_price_usd_per_h
    ship = ship.with_prices(
        request.fuel_price_usd,
        request.eca_price_factor,
        time_usd_per_day=None if hourly is None else hourly * DAY / HOUR,
    )
    if request.hold is None or request.speed_kn is None:
        return ship
    hold = with_held_speed if request.hold == "speed" else with_held_power
    return hold(ship, request.speed_kn)


def _with_comfort_limit(name: str, percent: float) -> Ship:
    """Return a ship whose file has another limit of motion sickness."""
    from thalweg.ship import Ship, plugin_names
    from thalweg.ship.file.ship_file import read_ship

    if name in plugin_names():
        raise InputError(
            f"A limit of motion sickness was given for the ship {name!r}.",
            "It can be given for ships of the library and of files; this one is of a plug-in.",
            "Leave the limit out, or choose another ship.",
            field="motion_sickness_percent",
        )
    data, source = read_ship(name)
    limits = {**(data.get("limits") or {}), "max_motion_sickness_percent": percent}
    return Ship.from_dict({**data, "limits": limits}, source=source)


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
