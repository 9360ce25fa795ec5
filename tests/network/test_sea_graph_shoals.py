"""Shoal water in the graph of all seas."""

from dataclasses import replace

import pytest

from thalweg.chart.depth.shoals_of_draught import shoals_of_draught
from thalweg.core.geodesy import line_length
from thalweg.network.global_grid.sea_graph import (
    GraphClosures,
)
from thalweg.network.global_grid.sea_graph_cache import sea_graph
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
