"""Ways on the other sides of islands that lie outside the network of the shortest way."""

from __future__ import annotations

import numpy as np
import pytest

from tests.planning.test_comfort_plans import DATA, DEPART, PERIOD
from thalweg.chart import Chart
from thalweg.planning import Voyage, alternative_plans, plan
from thalweg.planning.network_selection.route_alternatives import (
    MAX_FRONT_NODES,
    find_route_alternatives,
    network_of_all_ways,
)
from thalweg.planning.report.note_order import danger_first
from thalweg.planning.request.network_choice import NetworkChoice
from thalweg.planning.voyage_context import voyage_context
from thalweg.sea import Sea
from thalweg.ship import Ship

#: 90 nm from south to north; its west coast is nearer to the direct line.
ISLAND = [[-0.7, -0.75], [0.9, -0.75], [0.9, 0.75], [-0.7, 0.75], [-0.7, -0.75]]
ENDS = {"start": (-1.1, 0.0), "goal": (1.1, 0.0)}


def _island() -> Chart:
    return Chart.from_geojson({"type": "Polygon", "coordinates": [ISLAND]})


def _ship() -> Ship:
    return Ship.simple(speed_kn=10.0, draught_m=3.0)


def _sheltered_in_the_east() -> Sea:
    constant = {PERIOD: 8.0, "sea_surface_wave_from_direction": 270.0, "eastward_wind": 0.0,
                "northward_wind": 0.0}  # fmt: skip
    functions = {name: (lambda t, lat, lon, v=value: v) for name, value in constant.items()}
    functions["sea_surface_wave_significant_height"] = lambda t, lat, lon: np.where(
        np.asarray(lon) > 0.5, 0.2, 2.0
    )
    return Sea.from_functions(functions, time_step=3600.0)


def _voyage(**changes) -> Voyage:
    given = {"depart": "2026-01-01T00:00Z", "offing_nm": 0.0}
    return Voyage(**(ENDS | given | changes))


@pytest.mark.slow
def test_a_network_of_all_ways_has_the_far_side_of_an_island():
    voyage, chart = _voyage(), _island()
    context, ends = voyage_context(
        voyage, _ship(), Sea.calm(), chart, NetworkChoice("auto", None, None)
    )
    (small,) = find_route_alternatives(context, ends, {})
    wide = network_of_all_ways(small, context.chart, ends)
    beyond = [bool(np.any(one.lon > 1.0)) for one in (small.network, wide)]
    assert beyond == [False, True]
    assert small.network.n_nodes <= MAX_FRONT_NODES < wide.n_nodes


@pytest.mark.slow
@pytest.mark.parametrize("network", ["auto", "layered"])
def test_alternatives_pass_on_both_sides_of_an_island(network):
    found = alternative_plans(
        _voyage(depart=DEPART), ship=Ship.from_dict(DATA), sea=_sheltered_in_the_east(),
        chart=_island(), network=network,
    )  # fmt: skip
    routes = {bool(np.max(one.route.track.lon) > 0.89): one.route for one in found.choices}
    assert set(routes) == {False, True}, str(found)
    assert routes[True].comfort < 0.3 * routes[False].comfort


@pytest.mark.slow
def test_plans_on_a_layered_network_round_land_say_that_they_know_one_way_first():
    ends = {"start": (-1.1, -0.2), "goal": (1.1, -0.2)}
    found = plan(
        _voyage(**ends), ship=_ship(), sea=Sea.calm(), chart=_island(), network="layered", proof=0.0
    )
    words = "Ways on other sides of land may be"
    assert danger_first(found.notes)[0].startswith(words)
    open_sea = Chart.open_water()
    free = plan(
        _voyage(**ends), ship=_ship(), sea=Sea.calm(), chart=open_sea, network="layered", proof=0.0
    )
    assert not any(note.startswith(words) for note in free.notes)
