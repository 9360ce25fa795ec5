"""Layered networks against the printed values of Prestegardshus (2020)."""

from dataclasses import replace

import numpy as np
import pytest

from tests.network import prestegardshus_plane as plane
from thalweg.chart import Chart
from thalweg.chart.coast.coast_index_builder import build_index
from thalweg.chart.coast.coastline import Coastline
from thalweg.chart.coast.gshhg import read_land_rings
from thalweg.chart.rings import Rings
from thalweg.core import geodesy
from thalweg.core.errors import NoPathError
from thalweg.network import shortest_path
from thalweg.network.assembly import allowed_legs
from thalweg.network.layered.layered_builder import segments_on_paths
from thalweg.network.layered.layered_request import (
    LayeredRequest,
    layered_section,
    suggested_shape,
)
from thalweg.network.layered.section_shape import SectionShape

ONE, THREE = (plane.START, plane.GOAL), (plane.START, plane.FIRST, plane.SECOND, plane.GOAL)
NETWORKS = {
    "1LF": (ONE, 5, 3, 190),
    "1HF": (ONE, 10, 6, 200),
    "3LF": (THREE, [1, 3, 6], [5, 7, 3], [150, 150, 200]),
    "3HF": (THREE, [1, 15, 20], [5, 5, 3], [150, 50, 70]),
}
#: Printed paths (node numbers from 1), printed length [m] and length on WGS 84 [km].
PATHS = {
    "A": ("1LF", "1 4 9 15 21 24 25", 832_458, 352.10),
    "B": ("1LF", "1 4 9 16 21 24 25", 844_114, 357.14),
    "C": ("1HF", "1 7 16 30 51 75 103 126 144 155 161 162", 875_070, 370.34),
    "D": ("1HF", "1 7 16 30 49 75 100 126 144 155 161 162", 880_400, 372.41),
    "E": ("1HF", "1 7 16 30 51 75 100 126 144 155 161 162", 880_281, 372.45),
    "F": ("3LF", "1 3 7 12 21 30 35 37 41 48 55 62 65 66", 895_402, 377.35),
    "G": ("3LF", "1 3 7 12 21 29 35 38 43 49 57 62 65 66", 933_239, 393.16),
    "H": ("3LF", "1 3 7 14 25 34 35 38 43 49 57 62 65 66", 942_378, 397.26),
    "variation 1": (
        "3HF",
        "1 3 7 11 16 26 41 58 82 107 140 169 196 220 237 254 267 274 279 282 287 293 302 313 326 "
        "341 357 375 394 415 435 454 470 484 495 504 511 516 519 520",
        945_459,
        398.56,
    ),
    "Dijkstra": (
        "3HF",
        "1 4 7 10 16 27 41 60 82 109 140 172 199 223 242 258 269 276 279 281 285 291 299 309 321 "
        "335 351 369 389 410 430 448 464 478 490 500 508 514 518 520",
        831_000,
        351.29,
    ),
    "January": (
        "3HF",
        "1 3 7 10 16 27 41 60 82 108 139 170 198 223 243 257 268 274 279 281 285 292 300 310 323 "
        "337 353 371 391 413 434 453 470 484 495 504 511 516 519 520",
        912_065,
        384.30,
    ),
}
COUNTS = {
    (5, 3): (25, 54), (10, 6): (162, 784), (25, 5): (703, 3250), (25, 13): (2055, 24674),
    (27, 5): (813, 3780), (30, 7): (1472, 9655), (30, 13): (2912, 35461), (30, 20): (4592, 85744),
    (35, 7): (1981, 13104), (50, 3): (1352, 3901), (50, 9): (5252, 45439),
    (105, 5): (11343, 55650), (4, 4): (24, 59), (3, 5): (21, 60),
}  # fmt: skip
#: S, H, d [px]: printed nodes and segments after the filters of the thesis (nodes on water only).
FILTERED = [
    (5, 3, 190, 25, 54), (10, 6, 200, 136, 634), (25, 5, 50, 680, 3056), (25, 13, 50, 1993, 23368),
    (27, 5, 50, 773, 3516), (30, 7, 50, 1390, 8924), (30, 13, 50, 2750, 32762),
    (30, 20, 50, 4334, 79267), (35, 7, 50, 1821, 11716), (50, 9, 50, 4170, 34941),
    (50, 3, 50, 1061, 2948), (105, 5, 60, 4807, 22532), (90, 5, 70, 3349, 15595),
    (80, 5, 80, 2614, 12106), (75, 5, 90, 2199, 10113), (65, 5, 100, 1708, 7834),
    (10, 10, 200, 233, 1804), (10, 20, 200, 483, 7515), (30, 20, 200, 1890, 32886),
    (40, 7, 300, 573, 3352), (15, 20, 400, 493, 7762), (40, 5, 600, 197, 710),
]  # fmt: skip


@pytest.fixture(scope="module")
def chart():
    """GSHHG i as the counts were made with it: without the islets that it lacks, near Norway."""
    rings = read_land_rings("i", islets=False)
    lines = (slice(a, b) for a, b in zip(rings.start[:-1], rings.start[1:]))
    near = [k for k in lines if rings.lat[k].max() > 60.0 and rings.lat[k].min() < 70.0]
    land = Rings.from_lists(
        [(np.stack([rings.lat[k], rings.lon[k]], axis=1).tolist(), False) for k in near]
    )
    coastline = Coastline("GSHHG i", build_index(land, 512), lambda: land)
    return replace(Chart.gshhg("i"), coastline=coastline)


@pytest.mark.parametrize("shape, expected", COUNTS.items())
def test_counts_of_table_3(shape, expected):
    own = SectionShape(*shape, 1000.0)
    assert (own.n_nodes, own.n_segments) == expected


def test_closed_forms_are_the_counts_of_the_segments_themselves():
    for layers in range(1, 31):
        for fan in range(2, 21):
            shape = SectionShape(layers, fan, 1000.0)
            first, second = shape.segments()
            keys = first.astype(np.int64) * shape.n_nodes + second
            assert shape.n_segments == len(first) == len(np.unique(keys))
            assert shape.n_nodes == sum(shape.nodes_in_layers) == second.max() + 1


def test_segments_are_those_of_the_authors_length_rule():
    """Eq. 3.38: nodes of neighbouring layers at most sqrt(b^2 + d^2) apart are joined."""
    for layers in range(1, 12):
        for fan in range(2, 10):
            shape = SectionShape(layers, fan, 7.0)
            x, y = plane.section_positions(shape, (0.0, 0.0), (10.0 * (layers + 1), 0.0))
            layer = np.repeat(np.arange(layers + 2), shape.nodes_in_layers)
            near = np.hypot(x[:, None] - x, y[:, None] - y) <= np.hypot(10.0, 7.0) * (1 + 1e-9)
            joined = near & (layer[None, :] == layer[:, None] + 1)
            first, second = shape.segments()
            assert set(zip(*np.nonzero(joined))) == set(zip(first.tolist(), second.tolist()))


@pytest.mark.parametrize(
    "layers, fan, expected",
    [
        ([1, 3, 6], [5, 7, 3], (66, 195)), ([1, 15, 20], [5, 5, 3], (520, 1871)),
        ([1, 3, 5], [5, 7, 3], (59, 176)), ([1, 15, 6], [5, 7, 3], (438, 2547)),
        ([1, 15, 15], [5, 7, 3], (551, 2858)), ([1, 15, 20], [5, 7, 3], (648, 3135)),
        ([1, 15, 8], 5, (368, 1569)), ([1, 15, 6], 5, (334, 1419)),
    ],
)  # fmt: skip
def test_counts_of_three_sections(layers, fan, expected):
    x, _, first, _ = plane.plane_network(THREE, layers, fan, 100)
    assert (len(x), len(first)) == expected


@pytest.mark.parametrize("name", PATHS)
def test_printed_paths_are_walks_with_the_printed_lengths(name):
    kind, text, printed_m, true_km = PATHS[name]
    x, y, first, second = plane.plane_network(*NETWORKS[kind])
    path = np.array([int(part) - 1 for part in text.split()])
    edges = set(zip(first.tolist(), second.tolist()))
    assert all((a, b) in edges for a, b in zip(path[:-1].tolist(), path[1:].tolist()))
    px, py = np.round(x[path]), np.round(y[path])
    length = np.hypot(np.diff(px), np.diff(py)).sum() * plane.METRES_PER_PIXEL
    assert length == pytest.approx(printed_m, rel=3e-4)
    lat, lon = plane.positions(px, py)
    true = geodesy.distance(lat[:-1], lon[:-1], lat[1:], lon[1:]).sum() / 1000.0
    assert float(true) == pytest.approx(true_km, rel=1e-4)


def test_nodes_of_the_fine_three_sections_are_where_the_thesis_has_them():
    x, y, _, _ = plane.plane_network(*NETWORKS["3HF"])
    for node, there in (
        (2, (3746.712, 1713.701)), (4, (3876.5, 1638.5)), (7, plane.FIRST),
        (45, (4360.92, 2411.30)), (120, (4580.44, 2518.88)), (279, plane.SECOND),
        (519, (4862.8, 4618.67)), (520, plane.GOAL),
    ):  # fmt: skip
        assert (x[node - 1], y[node - 1]) == pytest.approx(there, abs=0.01)


@pytest.mark.parametrize("layers, fan, offset, nodes, segments", FILTERED)
def test_filtered_counts_of_the_thesis(chart, layers, fan, offset, nodes, segments):
    """Its rule: nodes on water inside the box, segments between two of them; within 5 %."""
    x, y, first, second = plane.plane_network(ONE, layers, fan, offset)
    lat, lon = plane.positions(x, y)
    kept = _water(chart, lat, lon)
    kept &= (x >= plane.WEST_PX) & (x <= plane.EAST_PX)
    free = kept[first] & kept[second]
    touched = np.unique(np.concatenate([first[free], second[free]]))
    assert len(touched) == pytest.approx(nodes, rel=0.05)
    assert int(free.sum()) == pytest.approx(segments, rel=0.05)


def _water(chart, lat, lon):
    return np.array(chart.without_canals("all").is_navigable(lat, lon))


def test_every_printed_path_crosses_land(chart):
    """What the thesis could not see: its filter tests nodes only."""
    crossed = {}
    for name, (kind, text, _, _) in PATHS.items():
        x, y, _, _ = plane.plane_network(*NETWORKS[kind])
        path = np.array([int(part) - 1 for part in text.split()])
        lat, lon = plane.positions(np.round(x[path]), np.round(y[path]))
        crossed[name] = int(np.sum(chart.leg_status(lat[:-1], lon[:-1], lat[1:], lon[1:]) != 0))
    expected = {"A": 3, "B": 4, "C": 8, "D": 7, "E": 7, "F": 5, "H": 7, "Dijkstra": 6, "January": 7}
    assert all(abs(crossed[name] - count) <= 1 for name, count in expected.items())
    assert all(crossed.values())


@pytest.mark.parametrize(
    "layers, fan, offset, nodes, segments",
    [(10, 6, 200, 111, 501), (50, 9, 50, 3637, 30759), (30, 20, 50, 3738, 68544),
     (40, 5, 600, 179, 629)],
)  # fmt: skip
def test_usable_counts_after_the_exact_test_and_two_sweeps(
    chart, layers, fan, offset, nodes, segments
):
    """Counts recomputed from GSHHG i when the thesis was studied; 4 to 42 % of its segments go."""
    used, keep = _usable(chart, ONE, layers, fan, offset)
    assert (int(used.sum()), int(keep.sum())) == pytest.approx((nodes, segments), rel=0.02)


@pytest.mark.parametrize("layers", [[1, 3, 6], [1, 15, 20]])
def test_no_three_section_network_of_the_thesis_has_a_route(chart, layers):
    offset = [150, 150, 200] if layers[1] == 3 else [150, 50, 70]
    fan = [5, 7, 3] if layers[1] == 3 else [5, 5, 3]
    assert not _usable(chart, THREE, layers, fan, offset)[1].any()


def _usable(chart, places, layers, fan, offset):
    x, y, first, second = plane.plane_network(places, layers, fan, offset)
    lat, lon = plane.positions(x, y)
    box = (x >= plane.WEST_PX) & (x <= plane.EAST_PX)
    free, _ = allowed_legs(chart, lat, lon, first, second)
    free &= box[first] & box[second]
    return segments_on_paths(len(x), first, second, free)


def test_a_route_by_the_strait_of_node_120_exists_where_the_shape_must_contain_it(chart):
    """The Naeroysund at Rorvik; the detour is 5 to 6 km of 95, as on the lattice."""
    strait, places = (64.862, 11.253), ((64.6047, 10.5371), (65.3480, 11.3946))
    shape = suggested_shape(chart, *places, contain=[strait])
    network = layered_section(chart, *places, shape)
    away = geodesy.distance(network.lat, network.lon, *strait)
    node = int(np.argmin(away))
    assert away[node] < 926.0
    there, _ = shortest_path(network, 0)
    onward, _ = shortest_path(network, node)
    inshore = (there[node] + onward[network.meta.goal]) / 1000.0
    offshore = there[network.meta.goal] / 1000.0
    assert 4.0 < inshore - offshore < 8.0
    with pytest.raises(NoPathError, match=r"has (a|no) path through"):
        suggested_shape(chart, *places, contain=[(64.87, 12.5)])


def test_straits_narrower_than_the_coastline_shows_are_noted(chart):
    request = LayeredRequest(contain=((64.862, 11.253),), within_percent=2.0)
    places = (64.6047, 10.5371), (65.3480, 11.3946)
    notes = layered_section(chart, *places, None, request=request).meta.notes
    assert any("smaller than about 1000 m" in note for note in notes)
    with pytest.raises(NoPathError, match="there is land on this coastline"):
        suggested_shape(chart, *places, contain=[(64.87, 12.5)])
