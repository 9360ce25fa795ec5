"""Shoal water in the graph of all seas."""

from dataclasses import replace

import numpy as np
import pytest

from thalweg.chart.depth.shoals_of_draught import shoals_of_draught
from thalweg.chart.passages import find_passages
from thalweg.core.geodesy import line_length
from thalweg.network.global_grid import sea_graph_cache
from thalweg.network.global_grid.sea_graph import GraphClosures, SeaGraph
from thalweg.network.global_grid.sea_graph_cache import edge_excess, sea_graph
from thalweg.planning.seaways import world_chart

pytestmark = pytest.mark.slow


def test_shoals_count_also_where_the_excess_of_the_edges_is_not_given():
    chart = world_chart()
    graph = sea_graph(chart)
    ends = (25.6, -79.6), (23.0, -80.0)  # round or over the Cay Sal Bank
    shoals = shoals_of_draught(chart, 12.0, 12.0, ends)
    without = GraphClosures(shoals=shoals)
    given = replace(without, excess=graph.shoal_excess(shoals))
    path = graph.path(chart, *ends, without)
    assert path == graph.path(chart, *ends, given)
    assert line_length(path) > line_length(graph.path(chart, *ends)) + 1000.0


def test_shoals_of_a_draught_are_read_from_disk_the_next_time(tmp_path, monkeypatch):
    """They were computed again for each ship: half a second of each distance."""
    chart = world_chart()
    made = sea_graph(chart)
    folder = tmp_path / "globe"
    folder.mkdir()
    monkeypatch.setattr(sea_graph_cache, "cache_folder", lambda name: folder)
    ends = (25.6, -79.6), (23.0, -80.0)
    clear_memory()
    for draught in (9.0, 12.0):
        shoals = shoals_of_draught(chart, draught, draught, ends)
        first = edge_excess(chart, shoals)
        assert first.max() > 1.0
        clear_memory()
        with monkeypatch.context() as patch:
            patch.setattr(SeaGraph, "shoal_excess", None)
            np.testing.assert_array_equal(edge_excess(chart, shoals), first)
    assert len(list(folder.glob("*-shoals-*.npz"))) == 2
    monkeypatch.setattr(sea_graph_cache, "_DRAUGHTS_KEPT", 2)
    edge_excess(chart, shoals_of_draught(chart, 13.0, 13.0, ends))
    assert len(list(folder.glob("*-shoals-*.npz"))) == 2
    clear_memory()
    assert made.target.shape == first.shape


def clear_memory():
    for function in (sea_graph_cache._load_or_make, sea_graph_cache._excess_elsewhere):
        function.cache_clear()
    sea_graph_cache._excess.cache_clear()


def test_the_weights_of_closed_water_are_worked_out_once():
    """Each plan asks for them dozens of times, with charts that are made anew."""
    world = world_chart()
    graph, ends = sea_graph(world), ((51.0, 1.5), (50.0, -2.0))
    closed = GraphClosures(passages=find_passages(["Dover"]))
    first, again = (graph._weights(world.without_passages("Dover"), ends, closed) for _ in range(2))
    assert again is first
    whole = graph._weights(world, ends, GraphClosures())
    assert np.isinf(first).sum() > np.isinf(whole).sum()
    assert np.array_equal(first[np.isfinite(first)], graph.weight[np.isfinite(first)])
