"""Small charts for the tests of networks."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from thalweg.chart import Chart


def ring(south: float, north: float, west: float, east: float) -> list[list[float]]:
    """A box as a closed ring of (lon, lat), counter-clockwise."""
    return [[west, south], [east, south], [east, north], [west, north], [west, south]]


def land_chart(*boxes: tuple[float, float, float, float]) -> Chart:
    """A chart whose land is boxes (south, north, west, east)."""
    return Chart.from_geojson(land=geojson(*boxes))


def geojson(*boxes: tuple[float, float, float, float]) -> dict:
    shapes = [{"type": "Polygon", "coordinates": [ring(*box)]} for box in boxes]
    features = [{"type": "Feature", "properties": {}, "geometry": shape} for shape in shapes]
    return {"type": "FeatureCollection", "features": features}


def write(path: Path, data: dict) -> Path:
    path.write_text(json.dumps(data))
    return path


def triangular_mesh(n: int, spacing_m: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A regular triangular mesh round (0, 0): lat, lon [deg] and triangles."""
    north, east = 110574.3, 111319.5  # metres in a degree at the equator of WGS 84
    i, j = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    y = (i - n // 2) * spacing_m * np.sqrt(3.0) / 2.0
    x = (j - n // 2 + 0.5 * (i % 2)) * spacing_m
    node = (i * n + j).astype(int)
    triangles = []
    for row in range(n - 1):
        a, b = node[row], node[row + 1]
        if row % 2 == 0:
            triangles += list(zip(a[:-1], a[1:], b[:-1])) + list(zip(a[1:], b[1:], b[:-1]))
        else:
            triangles += list(zip(a[:-1], b[1:], b[:-1])) + list(zip(a[:-1], a[1:], b[1:]))
    return (y / north).ravel(), (x / east).ravel(), np.array(triangles)
