"""From a request of a client to the objects of the library: ship, sea and chart."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from thalweg.core.errors import InputError
from thalweg.core.units import KNOT
from thalweg.service.jobs.plan_request import EMBEDDED_SEAS, ShipAndSea

if TYPE_CHECKING:
    from thalweg.chart import Chart
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
    from thalweg.chart import Chart

    chart = Chart.gshhg(request.coast)
    for name in request.depths:
        chart = chart.with_depth(files[name])
    if request.areas:
        chart = chart.with_zones(request.areas)
    fill = {str(name): value for name, value in request.fill.items()}
    sea = open_seas(request.seas, fill, files)
    return WorldOfJob(open_ship_of(request, files), sea, chart)


def open_ship_of(request: ShipAndSea, files: Mapping[str, str]) -> Ship:
    """Return the ship of a request, with its load and limits."""
    from thalweg.ship import Ship

    name = files.get(request.ship, request.ship)
    sick = request.limits.motion_sickness_percent
    ship = Ship.load(name) if sick is None else _with_comfort_limit(name, sick)
    if request.load_factor is not None:
        ship = ship.with_load_factor(request.load_factor)
    given: dict[str, Any] = {}
    if request.limits.wave_height_m is not None:
        given["wave_height"] = request.limits.wave_height_m
    if request.limits.wind_speed_kn is not None:
        given["wind_speed"] = request.limits.wind_speed_kn * KNOT
    return ship.with_limits(replace(ship.limits, **given)) if given else ship


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


def open_seas(names: list[str], fill: Mapping[str, Any], files: Mapping[str, str]) -> Sea:
    """Return the sea of a list of names, the first with priority."""
    from thalweg.sea import Sea

    embedded = {"calm": Sea.calm, "storm": Sea.storm}
    uploaded = [files[name] for name in names if name not in EMBEDDED_SEAS]
    parts = [Sea.open(*uploaded)] if uploaded else []
    parts += [embedded[name]() for name in names if name in EMBEDDED_SEAS]
    sea = parts[0] if len(parts) == 1 else Sea.layered(*parts)
    return sea.filled(**fill) if fill else sea
