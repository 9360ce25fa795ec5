"""The layered network between two places; round land with waypoints where the shape is chosen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from thalweg.core import geodesy
from thalweg.core.cheapest_chain import cheapest_chain
from thalweg.core.errors import NoPathError
from thalweg.core.geodesy import Position, format_position
from thalweg.core.types import FloatArray, IntArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.assembly import allowed_legs
from thalweg.network.layered.layered_builder import layered_network
from thalweg.network.layered.layered_request import (
    LayeredRequest,
    distances_from_line,
    missed_straits_note,
    narrow_strait_note,
    suggested_shape,
)
from thalweg.network.layered.section_shape import SectionShape
from thalweg.network.network import Network
from thalweg.network.regional_lattice.lattice_builder import lattice
from thalweg.network.shortest_paths import shortest_path

if TYPE_CHECKING:
    from thalweg.chart import Chart

OTHER_WAYS: Final = "Ways on other sides of land"  #: a note on what is not searched begins so
_CLEARLY_LONGER = 0.02  # share by which a shortest path is longer than another way
_WIDEST_SPACING = 8.0 * NAUTICAL_MILE  # of the lattice on which turning points are found


def layered_section(
    chart: Chart,
    start: Position,
    goal: Position,
    shape: SectionShape | None,
    *,
    spacing: float | None = None,
    request: LayeredRequest | None = None,
    numbering: tuple[int, int] = (0, 1),
) -> Network:
    """Return the layered network of one section.

    Parameters
    ----------
    chart : Chart
        Land, zones and depth.
    start, goal : (lat, lon)
        Positions [deg].
    shape : SectionShape or None
        None: the shape with the fewest segments whose shortest path is within 1 % of that of the
        finest network tried (`suggested_shape`). Where none has a path, the section is divided at
        turning points of the shortest way round land.
    spacing : float, optional
        Layers are at most this far apart [m]; a shape that is coarser is made finer, with the
        same width.
    request : LayeredRequest, optional
        With what the shape must contain and how good it must be, where it is chosen, and with the
        refinement near the coast.
    numbering : tuple of int, optional
        Number of the section in the voyage, from 0, and how many it has.

    Returns
    -------
    Network

    Raises
    ------
    NoPathError
        If it has no path.
    """
    wanted = request or LayeredRequest()
    if shape is not None:
        places, shapes, shortest = [start, goal], [shape], None
    else:
        places, shapes, shortest = _chosen_sections(chart, start, goal, wanted, numbering)
    shapes = [
        _close_enough(own, float(geodesy.distance(*a, *b)), spacing)
        for own, a, b in zip(shapes, places[:-1], places[1:])
    ]
    network = layered_network(
        chart, places, layers=[s.layers for s in shapes], fan=[s.fan for s in shapes],
        offset=[s.offset for s in shapes],
        near_coast=None if wanted.near_coast_nm is None else wanted.near_coast_nm * NAUTICAL_MILE,
        numbering=numbering,
    )  # fmt: skip
    others = _one_way_note(chart, start, goal)
    if shape is not None:
        return replace(network, meta=replace(network.meta, notes=(*others, *network.meta.notes)))
    straits = (note for place in wanted.contain if (note := narrow_strait_note(chart, place)))
    missed = missed_straits_note(chart, network, (start, goal))
    choice = (*_choice_notes(places, shapes, wanted), *_longer_note(network, shortest))
    notes = (*choice, *others, *straits, *missed, *network.meta.notes)
    return replace(network, meta=replace(network.meta, notes=notes))


def _one_way_note(chart: Chart, start: Position, goal: Position) -> list[str]:
    """Return a note that routes lead one way round land, where land is across the direct line."""
    if not np.any(chart.legs_blocked(*start, *goal)):
        return []
    return [
        f"{OTHER_WAYS} may be more sheltered or as short, and the layered network does not search "
        "them: run 'thalweg alternatives', or give waypoints (via)."
    ]


def _close_enough(shape: SectionShape, length: float, spacing: float | None) -> SectionShape:
    """Return a shape whose layers are at most a spacing apart [m]."""
    between = length / (shape.layers + 1)
    if spacing is None or between <= 1.001 * spacing:
        return shape
    return shape.finer(int(np.ceil(between / spacing - 1e-3)))


def _choice_notes(
    places: Sequence[Position], shapes: Sequence[SectionShape], wanted: LayeredRequest
) -> list[str]:
    if len(shapes) == 1:
        (shape,) = shapes
        return [
            f"The layered network has {shape.layers} layers, a fan of {shape.fan} and an offset of "
            f"{shape.offset / NAUTICAL_MILE:.3g} nm, chosen for a shortest path within "
            f"{wanted.within_percent:g} % of that of the finest network tried."
        ]
    layers = ", ".join(str(shape.layers) for shape in shapes)
    offsets = ", ".join(f"{shape.offset / NAUTICAL_MILE:.2g}" for shape in shapes)
    turns = "; ".join(format_position(*place) for place in places[1:-1])
    return [
        f"Land is across the direct line: the layered network has {len(shapes)} sections, with "
        f"{layers} layers, a fan of {shapes[0].fan} and offsets of {offsets} nm, chosen for "
        f"shortest paths within {wanted.within_percent:g} % of those of the finest networks tried.",
        f"All its routes pass turning points of a way round land: {turns}. Give waypoints (via) "
        "for routes that turn elsewhere.",
    ]


def _longer_note(network: Network, shortest: float | None) -> list[str]:
    """Return a note where the shortest path of a network is clearly longer than a way [m]."""
    if shortest is None:
        return []
    length, _ = shortest_path(network, network.meta.start, network.meta.goal)
    least = float(length[network.meta.goal])
    if least <= (1.0 + _CLEARLY_LONGER) * shortest:
        return []
    return [
        f"Its shortest path is {least / NAUTICAL_MILE:.0f} nm long, and "
        f"{shortest / NAUTICAL_MILE:.0f} nm are possible: compare the plan with one on the network "
        "that is used by default."
    ]


def _chosen_sections(
    chart: Chart,
    start: Position,
    goal: Position,
    wanted: LayeredRequest,
    numbering: tuple[int, int],
) -> tuple[list[Position], list[SectionShape], float | None]:
    """Return waypoints from start to goal, the shapes between them, and the length of a way [m].

    One section if a shape has a path, without that length; else those between turning points of the
    shortest way over a lattice.
    """
    try:
        return [start, goal], [_chosen_shape(chart, start, goal, wanted, numbering)], None
    except NoPathError:
        way = _turning_points(chart, start, goal)
        if len(way) == 2:
            raise
    ends, shapes = zip(*_divided(chart, way, wanted, numbering))
    return [start, *ends], list(shapes), geodesy.line_length(way)


def _divided(
    chart: Chart, way: list[Position], wanted: LayeredRequest, numbering: tuple[int, int]
) -> list[tuple[Position, SectionShape]]:
    """Divide a way where it is farthest from the direct line, until every part has a shape."""
    turn = _farthest_from_line(way)
    found = []
    for number, part in enumerate((way[: turn + 1], way[turn:])):
        own = wanted.of_section([way[0], way[turn], way[-1]], number)
        try:
            shape = _chosen_shape(chart, part[0], part[-1], own, numbering)
        except NoPathError:
            if len(part) == 2:
                raise
            found += _divided(chart, part, own, numbering)
        else:
            found.append((part[-1], shape))
    return found


def _chosen_shape(
    chart: Chart,
    start: Position,
    goal: Position,
    wanted: LayeredRequest,
    numbering: tuple[int, int],
) -> SectionShape:
    return suggested_shape(
        chart, start, goal, tolerance=wanted.within_percent / 100.0, contain=wanted.contain,
        numbering=numbering,
    )  # fmt: skip


def _turning_points(chart: Chart, start: Position, goal: Position) -> list[Position]:
    """Return the shortest way over a lattice, without the waypoints that straight legs can skip."""
    length = float(geodesy.distance(*start, *goal))
    network = lattice(chart, start, goal, spacing=min(length / 15.0, _WIDEST_SPACING))
    _, path = shortest_path(network, network.meta.start, network.meta.goal)
    if not path:
        return [start, goal]
    lat, lon = network.lat[path], network.lon[path]

    def steps(here: int, before: int) -> tuple[IntArray, FloatArray]:
        there = np.arange(here + 1, len(lat))
        free, _ = allowed_legs(chart, lat, lon, np.full(len(there), here), there)
        length = geodesy.distance(lat[here], lon[here], lat[there], lon[there])
        return there, np.where(free, length, np.inf)

    kept = cheapest_chain(len(lat), steps, tolerance=1e-6)
    kept = np.arange(len(lat)) if kept is None else kept
    return list(zip(lat[kept].tolist(), lon[kept].tolist()))


def _farthest_from_line(way: Sequence[Position]) -> int:
    """Return the inner waypoint that is farthest from the geodesic between the ends."""
    inner = np.array(way[1:-1])
    return 1 + int(np.argmax(distances_from_line(inner, way[0], way[-1])))
