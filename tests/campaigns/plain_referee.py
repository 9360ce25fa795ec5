"""A referee in plain NumPy and shapely that shares no code with the package."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence

import numpy as np
import shapely

A, F = 6378137.0, 1.0 / 298.257223563
B = A * (1.0 - F)
MILE = 1852.0


def arguments(count: int) -> argparse.Namespace:
    """Return the options of a campaign."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--count", type=int, default=count)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first case")
    return parser.parse_args()


def vincenty(lat1, lon1, lat2, lon2) -> np.ndarray:
    """Return the length of geodesics on WGS 84 [m] (Vincenty 1975, equations 13 to 21)."""
    u1, u2 = (np.arctan((1.0 - F) * np.tan(np.radians(y))) for y in (lat1, lat2))
    apart = np.radians((np.asarray(lon2) - lon1 + 540.0) % 360.0 - 180.0)
    lam = apart.copy()
    for _ in range(200):
        a = np.cos(u2) * np.sin(lam)
        b = np.cos(u1) * np.sin(u2) - np.sin(u1) * np.cos(u2) * np.cos(lam)
        sine = np.maximum(np.hypot(a, b), 1e-300)
        cosine = np.sin(u1) * np.sin(u2) + np.cos(u1) * np.cos(u2) * np.cos(lam)
        sigma = np.arctan2(sine, cosine)
        alpha = np.cos(u1) * np.cos(u2) * np.sin(lam) / sine
        square = 1.0 - alpha**2
        middle = cosine - 2.0 * np.sin(u1) * np.sin(u2) / np.where(square > 0.0, square, np.inf)
        c = F / 16.0 * square * (4.0 + F * (4.0 - 3.0 * square))
        inner = sigma + c * sine * (middle + c * cosine * (2.0 * middle**2 - 1.0))
        new = apart + (1.0 - c) * F * alpha * inner
        if np.abs(new - lam).max(initial=0.0) < 1e-13:
            break
        lam = new
    k = square * (A**2 - B**2) / B**2
    big = 1.0 + k / 16384.0 * (4096.0 + k * (-768.0 + k * (320.0 - 175.0 * k)))
    small = k / 1024.0 * (256.0 + k * (-128.0 + k * (74.0 - 47.0 * k)))
    turn = cosine * (2.0 * middle**2 - 1.0) - small / 6.0 * middle * (4.0 * sine**2 - 3.0) * (
        4.0 * middle**2 - 3.0
    )
    return B * big * (sigma - small * sine * (middle + small / 4.0 * turn))


def between(lat1, lon1, lat2, lon2, share) -> tuple[np.ndarray, np.ndarray]:
    """Return positions between two, by normal vectors; within 1 m of short geodesics."""

    def normal(lat, lon):
        y, x = np.radians(lat), np.radians(lon)
        return np.stack([np.cos(y) * np.cos(x), np.cos(y) * np.sin(x), np.sin(y)], -1)

    share = np.asarray(share)[..., None]
    n = (1.0 - share) * normal(lat1, lon1) + share * normal(lat2, lon2)
    lat = np.degrees(np.arctan2(n[..., 2], np.hypot(n[..., 0], n[..., 1])))
    return lat, np.degrees(np.arctan2(n[..., 1], n[..., 0]))


def sailing_time(
    lat: Sequence[float],
    lon: Sequence[float],
    *,
    speed: float,
    current: Callable,
    depart: float,
    steps: int = 400,
) -> float:
    """Return the time [s] of a track in a current, by the midpoint rule; NaN if it cannot hold.

    ``current(time, lat, lon)`` returns (east, north) [m/s].
    """
    time = depart
    for k in range(len(lat) - 1):
        ends = (lat[k], lon[k], lat[k + 1], lon[k + 1])
        length = float(vincenty(*(np.array([x]) for x in ends))[0])
        share = np.linspace(0.0, 1.0, steps + 1)
        y, x = between(*ends, share)
        my, mx = between(*ends, 0.5 * (share[1:] + share[:-1]))
        east = np.diff(x) * np.cos(np.radians(my)) * A
        north = np.diff(y) * A * (1.0 - F * (2.0 - 3.0 * np.sin(np.radians(my)) ** 2))
        size = np.hypot(east, north)
        ce, cn = east / size, north / size
        for j in range(steps):
            middle = time
            for _ in range(3):
                u, v = current(middle, my[j], mx[j])
                along, across = u * ce[j] + v * cn[j], v * ce[j] - u * cn[j]
                spare = speed**2 - across**2
                over = along + np.sqrt(spare) if spare > 0.0 else np.nan
                if not over > 0.0:
                    return np.nan
                took = length / steps / over
                middle = time + 0.5 * took
            time += took
    return time - depart


def legs_on_land(lat1, lon1, lat2, lon2, land) -> tuple[np.ndarray, np.ndarray]:
    """Return whether legs touch land (a shapely geometry in degrees), and whether that is sure."""
    share = np.linspace(0.0, 1.0, 9)
    y, x = between(*(np.asarray(a)[:, None] for a in (lat1, lon1, lat2, lon2)), share[None])
    lines = shapely.linestrings(np.stack([x, y], -1))
    shapely.prepare(land)
    touches = shapely.intersects(land, lines)
    margin = 3e-5  # about 3 m
    sure = np.where(
        touches,
        shapely.intersects(land.buffer(-margin), lines),
        ~shapely.intersects(land.buffer(margin), lines),
    )
    return touches, sure


def random_islands(rng: np.random.Generator, number: int, size: float = 0.12):
    """Return islands within a degree of the equator, as one shapely geometry."""
    shapes = []
    for _ in range(number):
        y, x = rng.uniform(-0.8, 0.8, 2)
        corners = np.sort(rng.uniform(0.0, 2.0 * np.pi, rng.integers(5, 12)))
        radius = size * rng.uniform(0.3, 1.0, corners.size)
        ring = np.column_stack([x + radius * np.cos(corners), y + radius * np.sin(corners)])
        shapes.append(shapely.Polygon(ring).buffer(0))
    return shapely.unary_union([s for s in shapes if s.is_valid and not s.is_empty])
