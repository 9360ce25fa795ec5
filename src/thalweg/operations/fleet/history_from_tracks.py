"""History networks from the tracks of a fleet: ports, calls, voyages, network."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from os import PathLike
from typing import TYPE_CHECKING, Final

import numpy as np

from thalweg.chart.geojson_polygons import read_features
from thalweg.chart.ports import PORTS, Port
from thalweg.core.errors import InputError
from thalweg.core.geodesy import Position, check_position, distance, format_position
from thalweg.core.types import IntArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.history.history_builder import HistoryRules, build_history
from thalweg.network.history.history_network import HistoryNetwork
from thalweg.network.history.junctions import CorridorLine
from thalweg.network.history.voyage_tracks import HistoryPort
from thalweg.operations.fleet.fleet_tracks import FleetTracks
from thalweg.operations.fleet.port_calls import (
    PortCallRules,
    PortCalls,
    find_port_calls,
    voyages_between_calls,
    without_waits_at_canals,
)
from thalweg.planning.distance_table import read_places
from thalweg.planning.request.voyage_endpoints import MAX_SNAP_PORT, resolve_port
from thalweg.planning.voyage_parts import Place

if TYPE_CHECKING:
    from thalweg.chart import Chart

_BESIDE: Final = 5.0 * NAUTICAL_MILE  # a berth so near to a port of the index is at it
#: By how much distances from the berth of a port count more: a terminal beside a small port mostly
#: belongs to the large one.
_WEIGHT_OF_SIZE: Final = {"large": 1.0, "medium": 1.25, "small": 1.75}


def history_from_tracks(
    fleet: FleetTracks,
    chart: Chart,
    *,
    ports: Sequence[HistoryPort] | None = None,
    corridors: Sequence[CorridorLine] = (),
    rules: HistoryRules | None = None,
    calls: PortCallRules | None = None,
    progress: Callable[[str], None] | None = None,
) -> HistoryNetwork:
    """Return the history network of the tracks of a fleet.

    Parameters
    ----------
    fleet : FleetTracks
    chart : Chart
        Land, canals, emission control areas and approaches of ports.
    ports : sequence of HistoryPort, optional
        By default the ports of the World Port Index that are called at.
    corridors : sequence of CorridorLine, optional
        Lines across straits or other places that ships pass.
    rules : HistoryRules, optional
    calls : PortCallRules, optional
    progress : callable, optional
        Called with a short text at each stage.

    Returns
    -------
    HistoryNetwork

    Raises
    ------
    InputError
        If no voyage between two ports is found.
    """
    report = progress or (lambda text: None)
    report("finding port calls and voyages")
    if ports is None:
        known, places = world_port_places(chart)
        port_calls = find_port_calls(fleet, places, calls, weights=size_weights(known))
        at_sea = {
            k: _at_sea(chart, known[k], places[k]) for k in np.unique(port_calls.port).tolist()
        }
        number = _numbers(len(known), [k for k, port in at_sea.items() if port is not None])
        own = [port for port in at_sea.values() if port is not None]
        reachable = number[port_calls.port] >= 0
        port_calls = replace(
            port_calls, ship=port_calls.ship[reachable], port=number[port_calls.port[reachable]],
            first=port_calls.first[reachable], last=port_calls.last[reachable],
        )  # fmt: skip
        closed = [str(known[k]) for k, port in at_sea.items() if port is None]
    else:
        own, closed = list(ports), []
        port_calls = find_port_calls(fleet, [port.places for port in own], calls)
    port_calls = without_waits_at_canals(fleet, port_calls, chart.canals)
    tracks = voyages_between_calls(fleet, port_calls)
    if not len(tracks):
        raise _no_voyage(fleet, port_calls, calls or PortCallRules(), of_index=ports is None)
    network = build_history(chart, tracks, own, rules=rules, corridors=corridors, progress=progress)
    notes = [*fleet.notes, *network.summary["notes"]]
    notes += [
        f"Calls at {name} are left out: no water of the chart leads there." for name in closed
    ]
    return replace(network, summary={
        **network.summary, "ships": len(fleet.ptr) - 1, "port_calls": len(port_calls.port),
        "notes": notes,
    })  # fmt: skip


def _no_voyage(
    fleet: FleetTracks, calls: PortCalls, rules: PortCallRules, *, of_index: bool
) -> InputError:
    """Return the error for tracks without a voyage, with what was found in them."""
    ships, ports = len(fleet.ptr) - 1, len(np.unique(calls.port))
    known = "the World Port Index" if of_index else "the file of ports"
    box = (
        f"{format_position(float(of(fleet.lat)), float(of(fleet.lon)))}" for of in (np.min, np.max)
    )
    return InputError(
        f"No voyage between two ports was found: {ships} {'ship' if ships == 1 else 'ships'} with "
        f"{len(fleet.time):,} positions from {' to '.join(box)} call {len(calls.port)} times, at "
        f"{ports} ports.",
        f"A call is a stop, or the first or last position, within "
        f"{rules.reach / NAUTICAL_MILE:g} nm of a port of {known}; a voyage joins two calls.",
        "Name the ports where these ships stop (--ports FILE), or give a greater --reach or more "
        "tracks.",
    )


def read_history_ports(path: str | PathLike[str], chart: Chart) -> list[HistoryPort]:
    """Read ports from a CSV file.

    Parameters
    ----------
    path : path
        By `thalweg.planning.distance_table.read_places`; rows without a position are ports of the
        World Port Index.
    chart : Chart
        Positions are moved to its navigable water.

    Returns
    -------
    list of HistoryPort

    Raises
    ------
    InputError
        If the file cannot be read, or a port is unknown or too far from water.
    """
    return [_history_port_at(name, place, chart) for name, place in read_places(path)]


def read_corridors(path: str | PathLike[str]) -> list[CorridorLine]:
    """Read corridors from GeoJSON lines of two positions with a property ``name``.

    Parameters
    ----------
    path : path
        GeoJSON file.

    Returns
    -------
    list of CorridorLine

    Raises
    ------
    InputError
        If the file cannot be read or a feature is not a line.
    """
    found = []
    for number, (geometry, properties) in enumerate(read_features(path, "corridors"), start=1):
        line = geometry.get("coordinates") or []
        if geometry.get("type") != "LineString" or len(line) < 2:
            raise InputError(
                f"Feature {number} of {str(path)!r} is no line.",
                "A corridor is a LineString from one side to the other.",
                "Draw a line across the way of the ships.",
            )
        ends = [check_position(float(p[1]), float(p[0]), "end of a corridor")
                for p in (line[0], line[-1])]  # fmt: skip
        found.append(CorridorLine(str(properties.get("name") or f"corridor {number}"), *ends))
    return found


def history_port(port: Port, chart: Chart) -> HistoryPort:
    """Return a port of the World Port Index as a port of history networks.

    Parameters
    ----------
    chart : Gives its approach, or the nearest water.

    Raises
    ------
    InputError : If the port cannot be reached on this chart.
    """
    end = resolve_port(port, chart, "port")
    line = end.approach.line if end.approach else ()
    length = end.approach.length if end.approach else 0.0
    places = ((port.lat, port.lon), *line)
    return HistoryPort(port.label, port.locode, end.lat, end.lon, length, places)


def world_port_places(chart: Chart) -> tuple[list[Port], list[tuple[Position, ...]]]:
    """Return the ports of the World Port Index with their berths and approaches."""
    ports = list(PORTS.all)
    places = []
    for port in ports:
        approach = None if chart.approaches is None else chart.approaches.of(port)
        places.append(((port.lat, port.lon), *(approach.line if approach else ())))
    return ports, places


def size_weights(ports: Sequence[Port]) -> list[float]:
    """Return by how much distances from the berths of ports count more."""
    return [_WEIGHT_OF_SIZE.get(port.size, 2.0) for port in ports]


def _at_sea(chart: Chart, port: Port, places: Sequence[Position]) -> HistoryPort | None:
    try:
        return replace(history_port(port, chart), places=tuple(places))
    except InputError:
        return None


def _port_beside(place: Position, chart: Chart) -> Port | None:
    """Return the nearest port with an approach that is beside a berth, or None."""
    near = [
        (float(distance(*place, port.lat, port.lon)), port)
        for port in PORTS.all
        if abs(port.lat - place[0]) < 1.0 and chart.approaches is not None
        and chart.approaches.of(port) is not None
    ]  # fmt: skip
    least, nearest = min(near, key=lambda pair: pair[0], default=(math.inf, None))
    return nearest if least <= _BESIDE else None


def _numbers(count: int, kept: Sequence[int]) -> IntArray:
    """Return the new number of every port, -1 for those that are not kept."""
    number = np.full(count, -1, np.int64)
    number[list(kept)] = np.arange(len(kept))
    return number


def _history_port_at(name: str, place: Place, chart: Chart) -> HistoryPort:
    """Return a named port, or a position under a name.

    A berth on the land of the chart leads to the sea by the approach of the port beside it; where
    there is none, the port is the nearest water.
    """
    if isinstance(place, str):
        return history_port(PORTS.lookup(place), chart)
    if not bool(np.asarray(chart.is_navigable(*place))):
        beside = _port_beside(place, chart)
        if beside is not None:
            index = history_port(beside, chart)
            away = float(distance(*place, beside.lat, beside.lon))
            return replace(
                index, name=name, locode="", approach_m=index.approach_m + away,
                places=(place, *index.places),
            )  # fmt: skip
    water = chart.nearest_navigable(*place, largest=MAX_SNAP_PORT)
    if water is None:
        raise InputError(
            f"The port {name} is farther than 60 km from navigable water.",
            "Ports are moved to the nearest water of the chart.",
            "Correct its position.",
        )
    return HistoryPort(name, "", water[0], water[1], 0.0, (place,))
