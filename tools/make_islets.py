"""Make the islets of the package, ``src/thalweg/chart/data/islets.npz``, from GSHHG f.

    pip install "thalweg[hires]"
    python tools/make_islets.py

An islet is land of scale f whose number scale i does not have, more than half a nautical mile from
land of scale i. Those on the lines of named passages are left out: the lines are drawn in scale h,
and are clear of land there. Rocks and reefs that scale f lacks too are in ``rocks_by_hand.csv``.
Boxes are rounded outwards.
"""

import csv
from pathlib import Path

import numpy as np

from thalweg.chart.coast.coast_index_builder import build_index
from thalweg.chart.coast.coastline import Coastline
from thalweg.chart.coast.gshhg import LAND_LEVELS, data_files, read_land_rings
from thalweg.chart.coast.islets import FILE, UNITS_OF_DEGREE
from thalweg.chart.passages import PASSAGES
from thalweg.core.units import NAUTICAL_MILE

APART = 0.5 * NAUTICAL_MILE  # least distance from land of scale i
LARGEST = 255  # units of a side; longer boxes are cut
ROCKS = Path(__file__).with_name("rocks_by_hand.csv")
OUT = Path(__file__).parents[1] / "src/thalweg/chart" / FILE


def table(scale: str) -> tuple[np.ndarray, Path]:
    """Return the rows of the land rings of a scale (as text), and the file of their points."""
    meta, points = data_files(scale)
    rows = np.array(meta.read_text(encoding="ascii").split()).reshape(-1, 8)
    return rows[np.isin(rows[:, 0].astype(int), LAND_LEVELS)], points


def missing_boxes() -> np.ndarray:
    """Return south, west, north, east [deg] of the land of scale f that scale i lacks."""
    full, points = table("f")
    full = full[~np.isin(full[:, 7], table("i")[0][:, 7])]
    raw = np.fromfile(points, "<f4").reshape(-1, 2).astype(np.float64)
    first, count = full[:, 5].astype(int) // 8, full[:, 2].astype(int)
    rings = [raw[a : a + n, ::-1] for a, n in zip(first, count)]
    return np.array([[*ring.min(axis=0), *ring.max(axis=0)] for ring in rings])


def rock_boxes() -> np.ndarray:
    """Return south, west, north, east [deg] of the rocks and reefs by hand."""
    with ROCKS.open(encoding="utf-8", newline="") as file:
        rows = [(row["lat"], row["lon"], row["radius_nm"]) for row in csv.DictReader(file)]
    lat, lon, radius = np.array(rows, float).T
    north = radius / 60.0
    east = north / np.cos(np.radians(lat))
    return np.stack([lat - north, lon - east, lat + north, lon + east], axis=-1)


def units(boxes: np.ndarray) -> np.ndarray:
    """Return boxes as south, west, height, width in whole units, long ones in parts."""
    low = np.floor(boxes[:, :2] * UNITS_OF_DEGREE).astype(np.int64)
    high = np.ceil(boxes[:, 2:] * UNITS_OF_DEGREE).astype(np.int64)
    found = []
    for (south, west), (north, east) in zip(low, high):
        for y in range(south, north, LARGEST):
            for x in range(west, east, LARGEST):
                found.append((y, x, min(north - y, LARGEST), min(east - x, LARGEST)))
    return np.array(found)


def on_passages(boxes: np.ndarray) -> np.ndarray:
    """Return which boxes [deg] the line of a named passage meets."""
    import shapely

    lines = [shapely.LineString([(lon, lat) for lat, lon in passage.line]) for passage in PASSAGES]
    areas = shapely.box(boxes[:, 1], boxes[:, 0], boxes[:, 3], boxes[:, 2])
    met = np.zeros(len(boxes), bool)
    met[shapely.STRtree(areas).query(lines, predicate="intersects")[1]] = True
    return met


def main() -> None:
    """Write the table."""
    rings = read_land_rings("i", islets=False)
    land = Coastline("GSHHG i", build_index(rings, 512), lambda: rings)
    boxes = missing_boxes()
    middle = 0.5 * (boxes[:, :2] + boxes[:, 2:])
    boxes = boxes[np.asarray(land.shore_distance(*middle.T, cap=2.0 * APART)) > APART]
    met = on_passages(boxes)
    rows = units(np.concatenate([boxes[~met], rock_boxes()]))
    cell = np.floor(rows[:, :2] / UNITS_OF_DEGREE)
    rows = rows[np.lexsort((rows[:, 0], rows[:, 1], cell[:, 1], cell[:, 0]))]
    steps = np.diff(rows[:, :2], axis=0, prepend=0).astype(np.int32)
    sides = rows[:, 2:].astype(np.uint8)
    np.savez_compressed(
        OUT, south=steps[:, 0], west=steps[:, 1], height=sides[:, 0], width=sides[:, 1]
    )
    print(f"{met.sum()} islets on lines of passages left out")
    print(f"{OUT}: {len(rows)} boxes, {OUT.stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
