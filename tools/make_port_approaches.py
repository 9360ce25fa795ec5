"""Make the table of port approaches, ``src/thalweg/chart/data/port_approaches.csv.gz``.

Run it after a change of the ports, the islets, or a file by hand (with ``--keep`` of the old table
only the lines that this changes are searched again)::

    pip install "thalweg[hires]"
    python tools/make_port_approaches.py --world-port-index UpdatedPub150.csv

For every port a path is searched from the charted water next to it to open sea: water 2 nautical
miles from land (`OFFING`) in a basin of more than 1,500 square miles at that distance. The path is
the one with the least sum of length times min(20, 1 mile / distance to land) on a grid of 0.1 miles
over the coastline GSHHG h, so it keeps to the middle of channels. Land between the port and the
first water counts 10 per mile. Ports whose water is not charted, or where the path takes the wrong
water, have a line by hand with its source; from its vertex ``rivers_from`` on it follows the rivers
of ``tools/river_lines.py`` near it. Where the sea at the end of a path is shoal, the line
follows one of ``tools/sea_fairways_by_hand.csv`` from there: a dredged channel, to its sea buoy.
"""

from __future__ import annotations

import argparse
import csv
import functools
import gzip
import io
import itertools
import re
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from river_lines import SOURCE as RIVERS
from river_lines import along_rivers
from scipy import ndimage
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from thalweg.chart import Chart
from thalweg.chart.ports import PORTS, Port
from thalweg.core.geodesy import densify, distance
from thalweg.core.units import NAUTICAL_MILE

OFFING = 2.0  #: distance from land of the sea end [nm]
BASIN = 1500.0  #: smallest basin that counts as sea [square nm]
REACHES = (3.0, 12.0, 25.0)  #: charted water is looked for within these distances [nm]
GRIDS = ((12.0, 0.1), (35.0, 0.1), (130.0, 0.25))  #: half width and spacing of grids [nm]
ROOT = Path(__file__).resolve().parents[1]
BY_HAND = ROOT / "tools" / "port_approaches_by_hand.csv"
FAIRWAYS = ROOT / "tools" / "sea_fairways_by_hand.csv"
TABLE = ROOT / "src" / "thalweg" / "chart" / "data" / "port_approaches.csv.gz"
COLUMNS = (
    "unlocode", "name", "country_code", "quality", "half_width_nm", "max_draught_m", "max_length_m",
    "source", "line",
)  # fmt: skip
_GREAT_LAKES = "on the Great Lakes, which are land on this chart"
_NO_WATER = "no charted water that leads to the sea within 25 nm"
_BLOCK, _CELLS = 8, 60  # coarse cells of 8 minutes; fine cells of 1 minute, 60 a degree


@functools.cache
def open_sea(chart: Chart) -> np.ndarray:
    """Return a mask (10800, 21600) of minutes of arc in basins at `OFFING` from land."""
    cache = Path("/tmp/thalweg-open-sea.npy")
    if cache.exists():
        return np.load(cache)
    rows, columns = 180 * _CELLS, 360 * _CELLS
    mask = np.zeros((rows, columns), bool)
    lat = -90.0 + (np.arange(rows) + 0.5) / _CELLS
    lon = -180.0 + (np.arange(columns) + 0.5) / _CELLS
    for top in range(0, rows, _BLOCK):
        middle = np.full(columns // _BLOCK, lat[top : top + _BLOCK].mean())
        lon_middle = lon.reshape(-1, _BLOCK).mean(axis=1)
        far = chart.coastline.shore_distance(middle, lon_middle, cap=40_000.0) / NAUTICAL_MILE
        half = 0.5 * _BLOCK * np.hypot(1.0, np.cos(np.radians(middle[0])))
        fine = np.repeat(far > OFFING + half + 0.5, _BLOCK)
        mask[top : top + _BLOCK] = fine
        unsure = np.repeat((far <= OFFING + half + 0.5) & (far > OFFING - half - 0.5), _BLOCK)
        where = np.flatnonzero(unsure)
        for row in range(top, top + _BLOCK):
            off = chart.coastline.shore_distance(lat[row], lon[where], cap=8_000.0)
            mask[row, where] = off >= OFFING * NAUTICAL_MILE
    labels, count = ndimage.label(mask)
    area = np.bincount(labels.ravel(), np.repeat(np.cos(np.radians(lat)), columns), count + 1)
    large = area > BASIN
    large[0] = False
    mask = large[labels]
    np.save(cache, mask)
    return mask


@dataclass(frozen=True)
class Charts:
    """The detailed coastline, the usual one, and the fairways."""

    fine: Chart
    usual: Chart
    fairways: list[Fairway]

    def is_open_sea(self, lat: np.ndarray, lon: np.ndarray) -> np.ndarray:
        """Return which positions are in a basin of the sea, by the nearest minutes of arc."""
        row = np.clip(((lat + 90.0) * _CELLS).astype(int), 0, 180 * _CELLS - 1)
        column = ((lon + 180.0) * _CELLS).astype(int) % (360 * _CELLS)
        return open_sea(self.usual)[row, column]


@dataclass(frozen=True)
class Grid:
    """Positions around a port; flat arrays."""

    lat: np.ndarray
    lon: np.ndarray
    shape: tuple[int, int]
    spacing: float

    @classmethod
    def around(cls, port: Port, half: float, spacing: float) -> Grid:
        """Return a grid with a half width and spacing in nautical miles."""
        n = round(half / spacing)
        step = np.arange(-n, n + 1) * spacing / 60.0
        lat = np.clip(port.lat + step, -89.9, 89.9)
        lon = port.lon + step / np.cos(np.radians(port.lat))
        a, b = np.meshgrid(lat, lon, indexing="ij")
        return cls(a.ravel(), (b.ravel() + 180.0) % 360.0 - 180.0, a.shape, spacing)


def shore_miles(chart: Chart, lat: np.ndarray, lon: np.ndarray) -> np.ndarray:
    """Return the distance to land [nm], up to 6."""
    return chart.coastline.shore_distance(lat, lon, cap=6 * NAUTICAL_MILE) / NAUTICAL_MILE


def edges(charts: Charts, grid: Grid, off: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return the allowed edges between neighbours: first, second, weight."""
    number = np.arange(grid.lat.size).reshape(grid.shape)
    water = (off > 0.0).reshape(grid.shape)
    parts = []
    for a, b, length in (
        (np.s_[:-1, :], np.s_[1:, :], 1.0),
        (np.s_[:, :-1], np.s_[:, 1:], 1.0),
        (np.s_[:-1, :-1], np.s_[1:, 1:], np.sqrt(2.0)),
        (np.s_[:-1, 1:], np.s_[1:, :-1], np.sqrt(2.0)),
    ):
        both = water[a] & water[b]
        p, q = number[a][both], number[b][both]
        near = np.minimum(off[p], off[q]) < 1.1 * length * grid.spacing
        blocked = np.zeros(len(p), bool)
        ends = (grid.lat[p[near]], grid.lon[p[near]], grid.lat[q[near]], grid.lon[q[near]])
        blocked[near] = charts.fine.legs_blocked(*ends)
        p, q = p[~blocked], q[~blocked]
        mean = 0.5 * (off[p] + off[q])
        weight = length * grid.spacing * np.clip(1.0 / np.maximum(mean, 1e-3), 0.5, 20.0)
        parts.append((p, q, weight))
    return tuple(np.concatenate(column) for column in zip(*parts))


def path_to_sea(charts: Charts, port: Port) -> np.ndarray | None:
    """Return the path (n, 2) from the first charted water to the open sea, or None.

    The nearest water that leads to the sea is used, however long the way is.
    """
    made: dict[int, Any] = {}
    for reach in REACHES:
        for size, (half, spacing) in enumerate(GRIDS):
            if reach > 0.8 * half:
                continue
            if size not in made:
                made[size] = _prepared(charts, port, half, spacing)
            grid, off, links, goal, from_port = made[size]
            seeds = np.flatnonzero((off > 0.0) & (from_port <= reach))
            if not (len(seeds) and goal.any()):
                continue
            found = _least_path(grid, links, seeds, from_port[seeds], goal)
            if found is not None:
                return found
    return None


def _prepared(charts: Charts, port: Port, half: float, spacing: float) -> tuple[Any, ...]:
    """Return a grid around a port, its distances from land, its edges, goals and distances."""
    grid = Grid.around(port, half, spacing)
    off = shore_miles(charts.fine, grid.lat, grid.lon)
    goal = charts.is_open_sea(grid.lat, grid.lon) & (off >= OFFING + 0.02)
    k = np.flatnonzero(goal)
    goal[k] = shore_miles(charts.usual, grid.lat[k], grid.lon[k]) >= OFFING + 0.02
    from_port = distance(port.lat, port.lon, grid.lat, grid.lon) / NAUTICAL_MILE
    return grid, off, edges(charts, grid, off), goal, from_port


def _least_path(
    grid: Grid, links: tuple[np.ndarray, ...], seeds: np.ndarray, start: np.ndarray, goal: Any
) -> np.ndarray | None:
    n = grid.lat.size
    first, second, weight = links
    source = np.full(len(seeds), n)
    graph = coo_array(
        (
            np.concatenate([weight, weight, 10.0 * start + 1e-6]),
            (
                np.concatenate([first, second, source]),
                np.concatenate([second, first, seeds]),
            ),
        ),
        shape=(n + 1, n + 1),
    ).tocsr()
    cost, before = dijkstra(graph, indices=n, return_predecessors=True)
    ends = np.flatnonzero(goal & np.isfinite(cost[:n]))
    if not len(ends):
        return None
    node = int(ends[np.argmin(cost[ends])])
    path = []
    while node != n and node >= 0:
        path.append(node)
        node = int(before[node])
    path = np.array(path[::-1])
    return np.stack([grid.lat[path], grid.lon[path]], axis=1)


def simplified(charts: Charts, path: np.ndarray, width: float) -> np.ndarray:
    """Return a path with fewer points: legs near it and as far from land as its points allow."""
    keep, at = [0], 0
    off = shore_miles(charts.fine, path[:, 0], path[:, 1])
    while at < len(path) - 1:
        best = at + 1
        for far in range(at + 2, len(path)):
            if not _follows(charts, path, off, (at, far)):
                if far > best + 12:
                    break
                continue
            best = far
        keep.append(best)
        at = best
    return path[keep]


def _follows(charts: Charts, path: np.ndarray, off: np.ndarray, leg: tuple[int, int]) -> bool:
    """Return whether a straight leg between two points of a path may replace the part between."""
    a, b = leg
    share = np.linspace(0.0, 1.0, b - a + 1)
    lon = path[a : b + 1, 1]
    lon = (lon - lon[0] + 180.0) % 360.0 - 180.0 + lon[0]
    lat = path[a, 0] + share * (path[b, 0] - path[a, 0])
    east = lon[0] + share * (lon[-1] - lon[0])
    apart = np.hypot(lat - path[a : b + 1, 0], (east - lon) * np.cos(np.radians(lat[0]))) * 60.0
    if apart.max() > 1.0:
        return False
    clear = shore_miles(charts.fine, lat, east)
    needed = np.minimum(0.7 * off[a : b + 1], 1.0)
    if (clear < needed).any():
        return False
    return not bool(charts.fine.legs_blocked(*path[a], *path[b]))


def half_width(charts: Charts, line: np.ndarray) -> float:
    """Return the least distance to land along the charted part of a line [nm]."""
    off = [shore_miles(charts.fine, line[:1, 0], line[:1, 1])]
    for a, b in itertools.pairwise(line):
        share = np.linspace(0.0, 1.0, 20)[:, None]
        turn = (b[1] - a[1] + 180.0) % 360.0 - 180.0
        place = a + share * np.array([b[0] - a[0], turn])
        off.append(shore_miles(charts.fine, place[:, 0], place[:, 1]))
    every = np.concatenate(off)
    return float(every[every > 0.0].min()) if (every > 0.0).any() else 0.0


def by_hand() -> dict[str, dict[str, str]]:
    """Return the lines by hand, by UN/LOCODE or, without one, by name and country."""
    with BY_HAND.open(encoding="utf-8", newline="") as file:
        return {row["port"]: row for row in csv.DictReader(file)}


@dataclass(frozen=True)
class Fairway:
    """A line from inner waters to sea by hand, and how near a path joins it [nm]."""

    name: str
    within: float
    line: np.ndarray
    source: str


def fairways() -> list[Fairway]:
    """Return the fairways to sea by hand."""
    with FAIRWAYS.open(encoding="utf-8", newline="") as file:
        return [
            Fairway(row["name"], float(row["within_nm"]), read_line(row["line"]), row["source"])
            for row in csv.DictReader(file)
        ]


def fairway_joined(line: np.ndarray, known: list[Fairway]) -> tuple[np.ndarray, Fairway | None]:
    """Return a line that follows the fairway it comes near, from the first vertex in reach."""
    lat, lon, leg = densify(line[:, 0], line[:, 1], 0.05 * NAUTICAL_MILE)
    for fairway in known:
        if abs(line[-1] - fairway.line[0]).max() > 4.0:
            continue
        for first, vertex in enumerate(fairway.line):
            apart = np.asarray(distance(*vertex, lat, lon)) / NAUTICAL_MILE
            at = int(np.argmin(apart))
            if apart[at] <= fairway.within:
                kept = line[: int(leg[min(at, len(leg) - 1)]) + 1]
                return np.concatenate([kept, fairway.line[first:]]), fairway
    return line, None


def read_table(path: Path) -> dict[tuple[str, str, str], dict[str, str]]:
    """Return the rows of a table of approaches by UN/LOCODE, name and country."""
    data = path.read_bytes()
    text = (gzip.decompress(data) if path.suffix == ".gz" else data).decode("utf-8")
    rows = csv.DictReader(text.splitlines())
    return {(row["unlocode"], row["name"], row["country_code"]): row for row in rows}


def ship_limits(index: Path) -> dict[tuple[str, str, str], tuple[str, str]]:
    """Return the largest draught and length [m] of ports in the World Port Index; "" if unknown."""
    with index.open(encoding="utf-8-sig", newline="") as file:
        limits = {
            round(float(row["World Port Index Number"])): tuple(
                _number_or_blank(row[f"Maximum Vessel {what} (m)"]) for what in ("Draft", "Length")
            )
            for row in csv.DictReader(file)
        }
    packed = TABLE.with_name("world_port_index.csv.gz").read_bytes()
    rows = csv.DictReader(gzip.decompress(packed).decode("utf-8").splitlines())
    return {
        (row["unlocode"], row["name"], row["country_code"]): limits[int(row["wpi_number"])]
        for row in rows
        if int(row["wpi_number"]) in limits
    }


def _number_or_blank(text: str) -> str:
    value = float(text or 0.0)
    return f"{value:g}" if value > 0.0 else ""


def written(line: np.ndarray) -> str:
    return " ".join(f"{lat:.4f},{(lon + 180.0) % 360.0 - 180.0:.4f}" for lat, lon in line)


def read_line(text: str) -> np.ndarray:
    return np.array([[float(x) for x in pair.split(",")] for pair in text.split()])


def _on_great_lakes(port: Port) -> bool:
    return port.country_code in ("US", "CA") and " Lake " in f"{port.region} "


def kept_tail(old: dict[str, str] | None, place: np.ndarray) -> np.ndarray | None:
    """Return the vertices of an old line from a place on; None where it does not pass there."""
    line = read_line(old["line"]) if old and old["line"] else np.empty((0, 2))
    there = np.flatnonzero(np.abs(line - place).max(axis=1, initial=0.0) < 1e-4)
    return line[there[0] :] if len(there) else None


def approach_row(
    charts: Charts, port: Port, hand: dict[str, str] | None, old: dict[str, str] | None
) -> dict[str, str]:
    """Return the row of a port; its line is empty where none was found.

    The computed part of an old line by hand that ends at the same place is kept.
    """
    row = {
        "unlocode": port.locode, "name": port.name, "country_code": port.country_code,
        "quality": "computed", "half_width_nm": "", "max_draught_m": "", "max_length_m": "",
        "source": "GSHHG h", "line": "",
    }  # fmt: skip
    if hand and hand["line"]:
        line = read_line(hand["line"])
        row["quality"], row["source"] = hand["quality"] or "by hand", hand["source"]
        if hand["rivers_from"]:
            first = int(hand["rivers_from"])
            line = np.concatenate([line[:first], along_rivers(line[first:])])
            row["source"] = f"{RIVERS}, {hand['source']}"
        if hand["then"] == "computed":  # by hand to charted water, from there by machine
            tail = kept_tail(old, line[-1])
            if tail is None:
                path = path_to_sea(charts, Port("", "", "", *line[-1]))
                if path is None:
                    raise ValueError(f"{port}: the hand line does not reach charted water.")
                tail = simplified(charts, path, 1.0)
            line = np.concatenate([line, tail[1:]])
    elif hand:
        row["quality"], row["source"] = "none", hand["source"]
        return row
    else:
        path = path_to_sea(charts, port)
        if path is None:
            row["quality"] = "none"
            return row
        line = simplified(charts, path, 1.0)
        if distance(port.lat, port.lon, *line[0]) > 200.0:
            line = np.concatenate([[[port.lat, port.lon]], line])
    line, fairway = fairway_joined(line, charts.fairways)
    if fairway is not None:
        row["quality"] = "by hand"
        row["source"] += f"; from the fairway {fairway.name} on: {fairway.source}"
    line = line[np.append(True, (np.diff(line, axis=0) != 0.0).any(axis=1))]
    row["line"] = written(line)
    row["half_width_nm"] = f"{half_width(charts, line):.2f}"
    return row


def is_kept(charts: Charts, row: dict[str, str]) -> bool:
    """Return whether a row of an old table still holds: off land, and near no fairway."""
    if row["quality"] not in ("computed", "none") or not row["line"]:
        return row["quality"] == "none"
    line = read_line(row["line"])
    off = float(shore_miles(charts.usual, *line[-1]))
    return off >= OFFING - 0.1 and fairway_joined(line, charts.fairways)[1] is None


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", default="", help="ports; with --keep the others stay as they are")
    parser.add_argument(
        "--world-port-index", type=Path, help="for the limits of draught and length"
    )
    parser.add_argument("--keep", type=Path, help="table whose computed lines are used again")
    parser.add_argument("--out", type=Path, default=TABLE)
    args = parser.parse_args()
    fine, usual = Chart.gshhg("h"), Chart.gshhg("i")
    charts = Charts(fine, usual, fairways())
    hands = by_hand()
    wanted = set(filter(None, re.split(",(?! )", args.only)))
    limits = ship_limits(args.world_port_index) if args.world_port_index else {}
    kept = read_table(args.keep) if args.keep else {}
    ports = tuple(p for p in PORTS.all if kept or not wanted or {p.locode, p.label} & wanted)
    rows, begin = [], time.time()
    for number, port in enumerate(ports):
        key = port.locode, port.name, port.country_code
        hand = hands.get(port.locode) if port.locode else hands.get(port.label)
        old = kept.get(key)
        if wanted and not {port.locode, port.label} & wanted:
            rows += [old] if old else []
            continue
        row = old if old and not hand and is_kept(charts, old) else None
        row = row or approach_row(charts, port, hand, old)
        if row["quality"] == "none" and not hand:
            row["source"] = _GREAT_LAKES if _on_great_lakes(port) else _NO_WATER
        if limits or not old:
            row["max_draught_m"], row["max_length_m"] = limits.get(key, ("", ""))
        else:
            row |= {name: old[name] for name in ("max_draught_m", "max_length_m")}
        rows.append(row)
        if number % 100 == 0:
            print(number, f"{time.time() - begin:.0f} s", flush=True)
    text = io.StringIO()
    writer = csv.DictWriter(text, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    data = text.getvalue().encode()
    args.out.write_bytes(gzip.compress(data, mtime=0) if args.out.suffix == ".gz" else data)
    print(f"{args.out}: {len(rows)} ports, {args.out.stat().st_size / 1e3:.0f} kB")


if __name__ == "__main__":
    main()
