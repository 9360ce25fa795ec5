"""The plane networks of Prestegardshus (2020): pixels of a raster, as in print."""

from __future__ import annotations

import numpy as np

from thalweg.network.layered.section_shape import SectionShape, section_shapes

#: Points of the case [px of the raster]: start, two waypoints, goal.
START, FIRST, SECOND, GOAL = (3550, 1075), (4203, 2202), (4655, 3127), (4800, 4700)
METRES_PER_PIXEL = 211.00  # as the thesis has it
WEST_PX, EAST_PX = 3261, 5633  # the box of its weather, 8.75 to 13.25 E
_EQUATORIAL, _FLATTENING = 6378137.0, 1 / 298.257223563


def section_positions(shape: SectionShape, start, end):
    """Return x and y of the nodes of a section on the plane (eqs. 3.26 to 3.37)."""
    sizes = np.asarray(shape.nodes_in_layers)
    of = np.repeat(np.arange(len(sizes)), sizes)
    rank = np.arange(len(of)) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    dx, dy = end[0] - start[0], end[1] - start[1]
    length, angle = np.hypot(dx, dy), np.arctan2(dy, dx)
    w = of * length / (len(sizes) - 1)
    c = 2.0 * shape.offset / (shape.fan - 1)
    e = c * (sizes[of] - 1) / 2.0 - rank * c
    return (
        start[0] + w * np.cos(angle) - e * np.sin(angle),
        start[1] + w * np.sin(angle) + e * np.cos(angle),
    )


def plane_network(places, layers, fan, offset):
    """Return x, y [px] of all nodes and the nodes that segments join, from 0."""
    shapes = section_shapes(len(places) - 1, layers, fan, offset)
    x, y = [np.array([places[0][0]], float)], [np.array([places[0][1]], float)]
    first, second, count = [], [], 1
    for shape, a, b in zip(shapes, places[:-1], places[1:]):
        there = section_positions(shape, a, b)
        x.append(there[0][1:])
        y.append(there[1][1:])
        tails, heads = shape.segments()
        first.append(tails + count - 1)
        second.append(heads + count - 1)
        count += shape.n_nodes - 1
    return tuple(np.concatenate(part) for part in (x, y, first, second))


def positions(x, y):
    """Return latitude and longitude [deg] of pixels: inverse World Mercator on WGS 84."""
    lon = 8.75 + (np.asarray(x, float) - 3261.0) / 2372.0 * 4.5
    south, north = (_mercator(lat) for lat in (62.75, 67.25))
    target = south + np.asarray(y, float) / 5619.0 * (north - south)
    lat = np.full(np.shape(target), 65.0)
    e = np.sqrt(_FLATTENING * (2.0 - _FLATTENING))
    for _ in range(12):
        s = np.sin(np.radians(lat))
        shrink = ((1 - e * s) / (1 + e * s)) ** (e / 2)
        lat = np.degrees(2.0 * np.arctan(np.exp(target / _EQUATORIAL) / shrink) - np.pi / 2)
    return lat, lon


def _mercator(lat):
    e = np.sqrt(_FLATTENING * (2.0 - _FLATTENING))
    phi = np.radians(lat)
    shrink = ((1 - e * np.sin(phi)) / (1 + e * np.sin(phi))) ** (e / 2)
    return _EQUATORIAL * np.log(np.tan(np.pi / 4 + phi / 2) * shrink)
