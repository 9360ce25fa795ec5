"""Certificates of passages whose routes may cross a pole or any meridian; zones kept out of."""

import numpy as np
import pytest
import shapely

from tests.search.test_time_certificate import bound, on_meshes, ship_of_one_speed
from thalweg.chart import Chart
from thalweg.core.geodesy import distance
from thalweg.sea import Sea
from thalweg.search.certificate.barrier_domain import BarrierDomain, StretchToBound
from thalweg.search.certificate.linked_solutions import joined_edges

START, GOAL = (0.0, -40.0), (0.0, 40.0)


def wall(north: float) -> Chart:
    ring = [[-8.0, -85.0], [8.0, -85.0], [8.0, north], [-8.0, north], [-8.0, -85.0]]
    feature = {
        "type": "Feature",
        "properties": {"kind": "no-go"},
        "geometry": {"type": "Polygon", "coordinates": [ring]},
    }
    return Chart.open_water(-90.0, 90.0, -180.0, 180.0).with_zones(feature)


def stretch(chart: Chart, known: float) -> StretchToBound:
    ship = ship_of_one_speed(1.0)
    return StretchToBound(Sea.calm(), chart, ship, (), START, GOAL, depart=0.0, known=known)


@pytest.mark.slow
def test_the_way_round_a_wall_that_reaches_near_the_pole_is_the_bound():
    """The geodesic through the wall is less than half as long: 80 degrees of the equator."""
    best = 2.0 * float(distance(*START, 80.0, -8.0)) + float(distance(80.0, -8.0, 80.0, 8.0))
    where = stretch(wall(80.0), 1.002 * best)
    domain = BarrierDomain.around(where, 180)
    rows, columns = domain.raster.values.shape[1:3]
    assert columns > 1.9 * rows  # all round
    found = on_meshes(where, 60, 1)
    assert found.mesh.is_round
    assert 0.94 * best < found.value <= best
    assert np.array_equal(found.barrier.phi, joined_edges(found.barrier.phi))


def test_a_way_over_the_pole_is_not_cut_off_by_the_edge_of_the_mesh():
    """A wall up to 80 N between ends at opposite meridians: the way is over the pole."""
    ends = (60.0, -90.0), (60.0, 90.0)
    best = float(distance(*ends[0], *ends[1]))
    where = StretchToBound(
        Sea.calm(), wall(80.0), ship_of_one_speed(1.0), (), *ends, depart=0.0, known=1.01 * best
    )
    found = on_meshes(where, 60, 1)
    # the water within 4 degrees of the pole costs nothing
    assert (1.0 - 8.5 / 60.0) * best < found.reached <= best


def test_joined_edges_continue_a_function_round_the_globe():
    phi = np.array([[3.0, 5.0, 4.0], [7.0, 1.0, 2.0], [9.0, 8.0, 6.0]])
    joined = joined_edges(phi)
    assert joined.tolist() == [[3.0, 3.0, 3.0], [2.0, 1.0, 2.0], [6.0, 6.0, 6.0]]


@pytest.mark.slow
def test_a_zone_that_routes_keep_out_of_makes_the_bound_longer():
    """A square from south of the chart to 0.3 degrees north of the line between the ends."""
    ends = (0.0, 0.0), (0.0, 1.0)
    chart = Chart.open_water(-0.6, 0.6, -0.5, 1.5)
    best = 2.0 * float(distance(*ends[0], 0.3, 0.4)) + float(distance(0.3, 0.4, 0.3, 0.6))
    given = {"chart": chart, "ship": ship_of_one_speed(1.0), "ends": ends, "cells": 80}
    free = bound(Sea.calm(), 1.005 * best, **given)
    kept = bound(Sea.calm(), 1.005 * best, kept_out=(shapely.box(0.4, -2.0, 0.6, 0.3),), **given)
    assert free.value <= float(distance(*ends[0], *ends[1]))
    assert 0.97 * best < kept.value <= best
