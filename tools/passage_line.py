"""Print the line of a passage for the table of passages: the widest water between two places.

    python tools/passage_line.py LAT,LON LAT,LON [--coast i] [--spacing 0.1] [--margin 0.12]

The line keeps as far from land as it can at its narrowest place (the widest path of a grid: the
path in the maximum spanning tree of the distances from land), and is then shortened where it stays
three quarters as far off. Printed are the half width in nautical miles, and the line. The line is
wrong between islets that the coastline lacks: compare it with a chart.
"""

from __future__ import annotations

import argparse

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import breadth_first_order, dijkstra, minimum_spanning_tree

from thalweg.chart import Chart
from thalweg.core.geodesy import densify, distance
from thalweg.core.units import NAUTICAL_MILE

WIDE, TAUT = 3.0, 0.75


def widest_line(chart, start, goal, spacing_nm, margin):
    """Return latitudes and longitudes of the line, and its least distance from land [nm]."""
    (y0, x0), (y1, x1) = start, goal
    step = spacing_nm / 60.0
    wide = step / np.cos(np.radians(0.5 * (y0 + y1)))
    lat = np.arange(min(y0, y1) - margin, max(y0, y1) + margin, step)
    lon = np.arange(min(x0, x1) - 2.0 * margin, max(x0, x1) + 2.0 * margin, wide)
    y, x = (grid.ravel() for grid in np.meshgrid(lat, lon, indexing="ij"))
    shore = chart.coastline.shore_distance(y, x, cap=WIDE * NAUTICAL_MILE) / NAUTICAL_MILE
    number = np.arange(len(y)).reshape(len(lat), len(lon))
    pairs = [(number[:-1], number[1:]), (number[:, :-1], number[:, 1:]),
             (number[:-1, :-1], number[1:, 1:]), (number[1:, :-1], number[:-1, 1:])]  # fmt: skip
    a, b = (np.concatenate([pair[k].ravel() for pair in pairs]) for k in (0, 1))
    wet = (shore[a] > 0.0) & (shore[b] > 0.0)
    a, b = a[wet], b[wet]
    free = ~np.asarray(chart.legs_blocked(y[a], x[a], y[b], x[b]))
    a, b = a[free], b[free]
    room = np.minimum(shore[a], shore[b])
    graph = coo_array((WIDE + 1.0 - room, (a, b)), shape=(len(y), len(y)))
    ends = [
        int(np.argmin(distance(y, x, *place) + 1e6 * (shore <= 0.0))) for place in (start, goal)
    ]
    tree = minimum_spanning_tree(graph.tocsr())
    path = path_of(breadth_first_order(tree, ends[0], directed=False)[1], *ends)
    least = float(shore[path].min())
    keep = room >= TAUT * least
    far = np.asarray(distance(y[a[keep]], x[a[keep]], y[b[keep]], x[b[keep]]), float)
    far *= 1.0 + 0.5 * (1.0 - room[keep] / WIDE)  # shorter, but in the middle of the water
    taut = coo_array((far, (a[keep], b[keep])), shape=(len(y), len(y))).tocsr()
    path = path_of(
        dijkstra(taut, directed=False, indices=ends[0], return_predecessors=True)[1], *ends
    )
    return simplified(chart, y[path], x[path], TAUT * least)


def path_of(before, start, goal):
    """Return the nodes from start to goal."""
    path = [goal]
    while path[-1] != start:
        if before[path[-1]] < 0:
            raise SystemExit("the coastline has no water between the two places")
        path.append(int(before[path[-1]]))
    return path[::-1]


def simplified(chart, lat, lon, least):
    """Return a line with few points that stays so far off land [nm], and its least distance."""

    def room(i, j):
        y, x, _ = densify(lat[[i, j]], lon[[i, j]], 0.02 * NAUTICAL_MILE)
        return float(chart.coastline.shore_distance(y, x).min()) / NAUTICAL_MILE

    kept, at, found = [0], 0, np.inf
    while at < len(lat) - 1:
        to = next(j for j in range(len(lat) - 1, at, -1) if j == at + 1 or room(at, j) >= least)
        found = min(found, room(at, to))
        kept.append(to)
        at = to
    return lat[kept], lon[kept], found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("start")
    parser.add_argument("goal")
    parser.add_argument("--coast", default="i")
    parser.add_argument("--spacing", type=float, default=0.1, help="of the grid [nm]")
    parser.add_argument("--margin", type=float, default=0.12, help="round both places [deg]")
    options = parser.parse_args()
    start, goal = (tuple(map(float, text.split(","))) for text in (options.start, options.goal))
    chart = Chart.gshhg(options.coast)
    lat, lon, width = widest_line(chart, start, goal, options.spacing, options.margin)
    print(f"{width:.2f}", " ".join(f"{a:.4f},{b:.4f}" for a, b in zip(lat, lon)))


if __name__ == "__main__":
    main()
