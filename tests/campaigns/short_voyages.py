"""Distances of short voyages against the shortest way over a fine grid of the water between them.

The ways from a berth to the sea are lines of a table: a voyage between two ports on one fjord or
bay is far too long where the table lacks the way between them. Here each of the chosen ports is
held against those within `FARTHEST` of it: the shortest way over a grid of 0.3 nm of water at least
0.15 nm off land, with the passages for small ships closed, from any place of the line of one port
to any place of that of the other.

Usage: ``python -m tests.campaigns.short_voyages [--importance N] [--country NO] [--out FILE.csv]``
"""

from __future__ import annotations

import argparse
import csv
import sys

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from thalweg.chart import Chart
from thalweg.chart.approaches import PORT_APPROACHES, PortApproach, dense_line
from thalweg.chart.ports import PORTS, Port
from thalweg.core.geodesy import distance
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.sea_distance import SMALL_CANALS, sea_distance
from thalweg.planning.seaways import Seaways, world_chart

SPACING = 0.3 / 60.0  # [deg] of latitude
OFF_LAND = 0.15 * NAUTICAL_MILE
FARTHEST = 150.0 * NAUTICAL_MILE
MARGIN = 1.2  # of the grid around a port, over the farthest port
LONGER, MORE = 1.25, 8.0  # ratio and miles from which a distance is printed as too long
NEIGHBOURS = ((0, 1), (1, 0), (1, 1), (1, -1), (1, 2), (2, 1), (1, -2), (2, -1))


class WaterGrid:
    """A grid of the water around a position and the shortest ways over it from one port."""

    def __init__(self, chart: Chart, centre: tuple[float, float]) -> None:
        reach = MARGIN * FARTHEST / NAUTICAL_MILE / 60.0
        lat0, lon0 = centre
        wide = SPACING / np.cos(np.radians(min(abs(lat0) + 1.0, 80.0)))
        self.lat = np.arange(lat0 - reach, lat0 + reach, SPACING)
        across = reach / np.cos(np.radians(lat0))
        self.lon = np.arange(lon0 - across, lon0 + across, wide)
        self.steps = (SPACING, wide)
        y, x = np.meshgrid(self.lat, self.lon, indexing="ij")
        self.y, self.x = y, (x + 180.0) % 360.0 - 180.0
        shore = chart.coastline.shore_distance(self.y.ravel(), self.x.ravel(), cap=2.0 * OFF_LAND)
        self.wet = (np.asarray(shore) >= OFF_LAND).reshape(y.shape)
        self.number = np.arange(y.size).reshape(y.shape)
        self._edges = self._wet_edges(chart)

    def _wet_edges(self, chart: Chart):
        from_, to, far = [], [], []
        near_line = self._near_closing_lines(chart)
        rows, columns = self.wet.shape
        for down, right in NEIGHBOURS:
            a = (slice(0, rows - down), slice(max(0, -right), columns - max(0, right)))
            b = (slice(down, rows), slice(max(0, right), columns + min(0, right)))
            open_ = self.wet[a] & self.wet[b]
            if abs(down) + abs(right) == 3:  # a leg of two cells passes between two others
                left = max(0, -right)
                for r, c in _between(down, right):
                    cell = slice(left + c, columns - max(0, right) + c)
                    open_ &= self.wet[r : r + rows - down, cell]
            p, q = self.number[a][open_], self.number[b][open_]
            y, x = self.y.ravel(), self.x.ravel()
            test = near_line.ravel()[p] | near_line.ravel()[q]
            shut = np.zeros(len(p), bool)
            if test.any():
                shut[test] = chart.legs_blocked(y[p[test]], x[p[test]], y[q[test]], x[q[test]])
            from_.append(p[~shut])
            to.append(q[~shut])
            far.append(distance(y[p[~shut]], x[p[~shut]], y[q[~shut]], x[q[~shut]]))
        return np.concatenate(from_), np.concatenate(to), np.concatenate(far)

    def _near_closing_lines(self, chart: Chart):
        near = np.zeros(self.wet.shape, bool)
        for passage in chart.closed_passages:
            lat, lon = np.array(passage.closing_line or passage.line, float).T
            if lat.min() > self.lat[-1] or lat.max() < self.lat[0]:
                continue
            near |= (
                (self.y > lat.min() - 0.05)
                & (self.y < lat.max() + 0.05)
                & (self.x > lon.min() - 0.1)
                & (self.x < lon.max() + 0.1)
            )
        return near

    def cells_of(self, approach: PortApproach):
        """Return the wet cells within a cell of the line, and the length to them from the berth."""
        along = dense_line(approach.line)
        row = np.rint((along[:, 0] - self.lat[0]) / self.steps[0]).astype(int)
        lon = self.lon[0] + (along[:, 1] - self.lon[0]) % 360.0
        column = np.rint((lon - self.lon[0]) / self.steps[1]).astype(int)
        inside = (row >= 0) & (row < len(self.lat)) & (column >= 0) & (column < len(self.lon))
        row, column, length = row[inside], column[inside], along[inside, 2]
        wet = self.wet[row, column]
        cells, first = np.unique(self.number[row[wet], column[wet]], return_index=True)
        return cells, length[wet][first]

    def lengths_from(self, approach: PortApproach):
        """Return the length [m] from the berth to every cell."""
        cells, length = self.cells_of(approach)
        count = self.wet.size
        p, q, far = self._edges
        source = np.full(len(cells), count)
        graph = coo_array(
            (np.concatenate([far, np.maximum(length, 1e-3)]),
             (np.concatenate([p, source]), np.concatenate([q, cells]))),
            shape=(count + 1, count + 1),
        ).tocsr()  # fmt: skip
        return dijkstra(graph, directed=False, indices=count, limit=2.0 * FARTHEST)


def _between(down: int, right: int):
    """Return the two cells that a knight's move passes between."""
    if down == 1:
        half = 1 if right > 0 else -1
        return (0, half), (1, half)
    return (1, 0), (1, right)


def chosen_ports(importance: int, country: str) -> list[Port]:
    """Return the ports with an approach that are important enough, or those of a country."""
    return [
        port
        for port in PORTS.all
        if port.locode
        and PORT_APPROACHES.of(port)
        and (port.country_code == country if country else port.importance >= importance)
    ]


def main() -> None:
    """Print the voyages that are much longer than the water between the ports."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--importance", type=int, default=12, help="of ports, at least")
    parser.add_argument("--country", default="", help="ports of this country, all of them")
    parser.add_argument("--out", help="CSV file of all pairs")
    options = parser.parse_args()
    ports = chosen_ports(options.importance, options.country)
    chart = Seaways.of_chart(world_chart(), SMALL_CANALS).chart
    print(f"{len(ports)} ports", flush=True)
    rows = []
    for number, port in enumerate(ports):
        near = [p for p in ports[number + 1 :]
                if float(distance(port.lat, port.lon, p.lat, p.lon)) < FARTHEST]  # fmt: skip
        if not near or abs(port.lat) > 74.0:
            continue
        grid = WaterGrid(chart, (port.lat, port.lon))
        lengths = grid.lengths_from(PORT_APPROACHES.of(port))
        for other in near:
            cells, more = grid.cells_of(PORT_APPROACHES.of(other))
            if not len(cells):
                continue
            water = float(np.min(lengths[cells] + more)) / NAUTICAL_MILE
            if not water < 1.5 * FARTHEST / NAUTICAL_MILE:
                continue
            ours = sea_distance(port.locode, other.locode).nm
            rows.append((port.label, other.label, round(ours, 1), round(water, 1)))
            if ours > LONGER * water and ours > water + MORE:
                print(f"{port.label} - {other.label}: {ours:.0f} nm, water {water:.0f}", flush=True)
    ratio = np.array([row[2] / max(row[3], 1.0) for row in rows])
    middle, high = np.quantile(ratio, [0.5, 0.95])
    print(f"{len(rows)} pairs: median {middle:.3f}, 95 % within {high:.2f}")
    if options.out:
        with open(options.out, "w", newline="") as file:
            csv.writer(file).writerows([("from", "to", "nm", "water_nm"), *rows])


if __name__ == "__main__":
    sys.exit(main())
