"""Ports outside the locks of a canal are reached without its dues."""

import numpy as np
import pytest

from thalweg import Chart
from thalweg.chart.canal_parts import part_number_of_legs
from thalweg.chart.ports import PORTS


@pytest.mark.slow
def test_no_approach_of_the_table_runs_through_a_canal():
    chart = Chart.gshhg("i")
    paying = set()
    for port in PORTS.all:
        approach = chart.approaches.of(port)
        if approach is not None:
            lat, lon = np.array(approach.line, float).T
            whole = chart.canal_of_legs(lat[:-1], lon[:-1], lat[1:], lon[1:])
            if (part_number_of_legs(chart.canals, lat, lon) >= 0).any() or (whole >= 0).any():
                paying.add(port.name)
    assert not paying  # ports between gates have other ways, by `ways_through_canals`
