"""Seuren (2020), "Multi-objective weather routing": table 4.2 and figure 4.10.

Table 4.2 prints chords halved exactly and arcs of such chords; the arcs of the projected grid are
longer (checked apart, by haversines with his radius of 3440.0695 nautical miles).
"""

import numpy as np
import pytest

from thalweg.chart import Chart
from thalweg.network.global_grid.endpoint_attachment import ConnectedWaters
from thalweg.network.global_grid.grid import GridResolution, make_grid
from thalweg.network.global_grid.icosphere import icosphere

RADIUS = 3440.0695
PRINTED = {  # level: chord c, arc s [nm]
    0: (3617.10, 3808.67), 1: (1808.55, 1830.06), 2: (904.28, 906.90), 3: (452.14, 452.46),
    4: (226.07, 226.11), 5: (113.03, 113.04), 6: (56.52, 56.52), 7: (28.26, 28.26),
    8: (14.13, 14.13), 9: (7.06, 7.06), 10: (3.53, 3.53),
}  # fmt: skip
TRUE = {  # level: vertices, edges, faces, least, mean and largest arc [nm]
    0: (12, 30, 20, 3808.67, 3808.67, 3808.67),
    1: (42, 120, 80, 1904.33, 2032.90, 2161.46),
    2: (162, 480, 320, 952.17, 1033.66, 1122.72),
    3: (642, 1920, 1280, 476.08, 519.02, 567.04),
    4: (2562, 7680, 5120, 238.04, 259.78, 284.24),
    5: (10242, 30720, 20480, 119.02, 129.93, 142.21),
    6: (40962, 122880, 81920, 59.51, 64.97, 71.12),
}
ATLANTIC, MEDITERRANEAN = (36.0, -9.0), (37.5, 1.0)


def arcs(grid):
    first, second = grid.pairs()
    chord = np.linalg.norm(grid.vertices[first] - grid.vertices[second], axis=1)
    return 2.0 * RADIUS * np.arcsin(chord / 2.0)


@pytest.mark.parametrize("level", TRUE)
def test_counts_and_true_arcs(level):
    grid = icosphere(level)
    length = arcs(grid)
    vertices, edges, faces, least, mean, largest = TRUE[level]
    assert (len(grid.vertices), len(length), len(grid.faces)) == (vertices, edges, faces)
    assert [round(float(x), 2) for x in (length.min(), length.mean(), length.max())] == [
        least,
        mean,
        largest,
    ]


def test_printed_chords_and_arcs_are_halves_of_the_first():
    grid = icosphere(0)
    first, second = grid.pairs()
    chord = RADIUS * float(np.linalg.norm(grid.vertices[first[0]] - grid.vertices[second[0]]))
    assert chord == pytest.approx(3617.1031, abs=1e-4)
    for level, (c, s) in PRINTED.items():
        half = chord / 2**level
        assert half == pytest.approx(c, abs=0.00501)
        assert 2.0 * RADIUS * np.arcsin(half / 2.0 / RADIUS) == pytest.approx(s, abs=0.00501)


def water_at(grid, root, place):
    away = (grid.lat - place[0]) ** 2 + (grid.lon - place[1]) ** 2
    return root[np.argmin(away)]


@pytest.mark.slow
@pytest.mark.parametrize(("coast_levels", "joined"), [(0, False), (3, True)])
def test_gibraltar_is_closed_at_level_6_and_open_with_3_more(coast_levels, joined):
    grid = make_grid(Chart.gshhg("i"), GridResolution(6, coast_levels, directions=6))
    every = np.ones(len(grid.lat), bool)
    root = ConnectedWaters.of_pairs(grid.lat, grid.lon, grid.pairs, every, 0.0).water
    atlantic, inside = (water_at(grid, root, place) for place in (ATLANTIC, MEDITERRANEAN))
    assert np.sum(root == inside) > 50
    assert (atlantic == inside) == joined
