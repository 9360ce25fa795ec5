"""Sills of one row of the data under a tide: crossed when, and only when, the referee lets them."""

import numpy as np
import pytest

from tests.sill_seas import DREDGER, narrow_sill, write_sea
from thalweg import Chart, Sea, Voyage, plan
from thalweg.core.geodesy import distance
from thalweg.core.units import HOUR, KNOT
from thalweg.network import lattice, mesh
from thalweg.planning.network_selection.bed_along_edges import with_bed_along_edges
from thalweg.sea.standard_names import BED_DEPTH

START, GOAL = (51.75, 3.6), (51.65, 3.6)
WATER = Chart.open_water(51.6, 51.8, 3.5, 3.7)


def hours_until_open(required):
    """Return when the tide of `narrow_sill` rises to a depth over the sill after 6 h [h]."""
    return float(12.4206 * (1.0 - np.arccos((required - 6.5) / 1.5) / (2.0 * np.pi)))


@pytest.mark.slow
@pytest.mark.parametrize(("objective", "speed"), [("time", 10.0), ("fuel", 8.0)])
def test_a_sill_of_one_row_is_crossed_as_soon_as_the_tide_allows_it(tmp_path, objective, speed):
    """Least time went 5 nm round to where a node lay on the crest; least fuel went aground."""
    narrow_sill(tmp_path / "sill.nc")
    voyage = Voyage(
        start=START, goal=GOAL, depart="2026-05-01T08:00Z", objective=objective, min_ukc_m=1.0
    )
    sea = Sea.open(tmp_path / "sill.nc")
    best = plan(voyage, ship=DREDGER, sea=sea, chart=WATER).best
    assert best.feasible and best.min_ukc_m == pytest.approx(1.0, abs=0.02)
    straight = float(distance(*START, *GOAL))
    assert best.distance_nm * 1852.0 == pytest.approx(straight, rel=1e-3)
    half = 0.5 * straight / (speed * KNOT)
    opens = np.datetime64("2026-05-01").astype("datetime64[s]").astype(float)
    opens += hours_until_open(7.5) * HOUR
    assert best.arrive == pytest.approx(opens + half, abs=90.0)


def test_edges_are_as_deep_as_the_least_of_the_bed_along_them(tmp_path):
    """Against close samples; deep water and other seas stay as they are."""
    lat, lon = 51.6 + 0.01 * np.arange(21), np.array([3.5, 3.55, 3.56, 3.6, 3.7])
    depth = 8.0 + 6.0 * np.random.default_rng(4).random(21)
    write_sea(tmp_path / "bed.nc", lat, depth, lon, np.zeros(3), np.arange(3.0))
    sea = Sea.open(tmp_path / "bed.nc")
    network = lattice(WATER, START, GOAL, spacing=1500.0)
    found = with_bed_along_edges(network, sea, 10.0)
    tails, heads = network.tails(), network.graph.target
    share = np.linspace(0.0, 1.0, 2001)
    for edge in np.random.default_rng(5).integers(0, network.n_edges, 200):
        a, b = tails[edge], heads[edge]
        y = network.lat[a] + share * (network.lat[b] - network.lat[a])
        x = network.lon[a] + share * (network.lon[b] - network.lon[a])
        bed = sea.sample([BED_DEPTH], np.zeros(share.size), y, x)[BED_DEPTH]
        least = float(np.nanmin(bed))
        assert least - 0.02 <= found.edges.depth[edge] <= least + 1e-3
    assert with_bed_along_edges(network, sea, -np.inf) is network
    assert with_bed_along_edges(network, sea, -10.0) is network  # 5 m and more deeper
    assert with_bed_along_edges(network, Sea.calm(), 10.0) is network


def test_an_edge_across_a_cell_is_as_shallow_as_its_middle(tmp_path):
    """Between two deep points across the corner of flats the water is half as deep."""
    lat, lon = 51.6 + 0.01 * np.arange(21), 3.5 + 0.01 * np.arange(21)
    steps = np.where(np.eye(21) > 0.0, 8.0, 2.0)
    write_sea(tmp_path / "steps.nc", lat, steps, lon, np.zeros(3), np.arange(3.0))
    sea = Sea.open(tmp_path / "steps.nc")
    network = mesh(WATER, *(axis.ravel() for axis in np.meshgrid(lat, lon, indexing="ij")))
    found = with_bed_along_edges(network, sea, 10.0)
    tails, heads = network.tails(), network.graph.target
    row = np.rint((network.lat - 51.6) / 0.01).astype(int)
    column = np.rint((network.lon - 3.5) / 0.01).astype(int)
    along = (row == column)[tails] & (row == column)[heads] & (np.abs(row[tails] - row[heads]) == 1)
    assert along.sum() == 38  # the last point is on the edge of the chart
    assert found.edges.depth[along] == pytest.approx(5.0, abs=1e-4)
