"""Nodes and segments of layered networks, before any test."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thalweg.core import geodesy
from thalweg.core.arrays.numbered_parts import numbered_parts
from thalweg.core.geodesy import Position
from thalweg.core.types import FloatArray, Int32Array
from thalweg.network.layered.section_shape import PerSection, SectionShape, section_shapes


@dataclass(frozen=True, eq=False)
class LayeredDraft:
    """All nodes and segments of a layered network, before any test.

    Attributes
    ----------
    shapes : Of every section.
    lat, lon : float64[N]
        Nodes [deg], section by section, layer by layer, port to starboard. The end of a section
        is the start of the next.
    section, layer : int32[N]
        Section and layer that a node belongs to; waypoints belong to the section they end.
    first, second : int32[P]
        The nodes that segments join.
    """

    shapes: tuple[SectionShape, ...]
    lat: FloatArray
    lon: FloatArray
    section: Int32Array
    layer: Int32Array
    first: Int32Array
    second: Int32Array


def layered_draft(
    places: Sequence[Position], *, layers: PerSection, fan: PerSection, offset: PerSection
) -> LayeredDraft:
    """Return the nodes and segments of a layered network without a chart; see `layered_network`."""
    shapes = section_shapes(max(len(places) - 1, 1), layers, fan, offset)
    lat, lon = [np.array([places[0][0]], float)], [np.array([places[0][1]], float)]
    section, layer = [np.zeros(1, np.int32)], [np.zeros(1, np.int32)]
    first, second = [], []
    count = 1
    for number, (shape, (a, b)) in enumerate(zip(shapes, itertools.pairwise(places))):
        in_layers = np.repeat(np.arange(shape.layers + 2), shape.nodes_in_layers)[1:]
        there = _section_positions(shape, a, b)
        lat.append(there[0][1:])
        lon.append(there[1][1:])
        section.append(np.full(len(in_layers), number, np.int32))
        layer.append(in_layers.astype(np.int32))
        tails, heads = shape.segments()
        first.append(tails + np.int32(count - 1))
        second.append(heads + np.int32(count - 1))
        count += len(in_layers)
    parts = (lat, lon, section, layer, first, second)
    return LayeredDraft(shapes, *(np.concatenate(part) for part in parts))


def _section_positions(
    shape: SectionShape, start: Position, end: Position
) -> tuple[FloatArray, FloatArray]:
    """Return the nodes of a section [deg], its two waypoints included."""
    length, course, _ = geodesy.inverse(*start, *end)
    sizes = np.asarray(shape.nodes_in_layers)
    along = np.arange(len(sizes)) / (len(sizes) - 1) * float(length)
    middle_lat, middle_lon = geodesy.direct(*start, float(course), along)
    _, onward, _ = geodesy.inverse(middle_lat[:-1], middle_lon[:-1], *end)
    of, rank = numbered_parts(sizes)
    starboard = shape.spacing_in_layer() * (rank - 0.5 * (sizes[of] - 1))
    across = np.append(onward, 0.0)[of] + 0.5 * math.pi
    lat, lon = geodesy.direct(middle_lat[of], middle_lon[of], across, starboard)
    lat[0], lon[0] = start
    lat[-1], lon[-1] = end
    return lat, lon
