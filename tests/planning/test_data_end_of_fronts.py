"""Fronts that must arrive before the data end use the network of the plan by least time."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from thalweg import Chart, Sea, Ship, Voyage
from thalweg.planning.network_selection.network_builder import build_network
from thalweg.planning.pareto.exploration import fastest_in_known_water
from thalweg.planning.pareto.trade_off_planner import with_trade_off
from thalweg.planning.request.network_choice import NetworkChoice
from thalweg.planning.voyage_context import voyage_context

DEPART = np.datetime64("2023-11-14T00:00", "ns")


def small_waves(hours):
    time = DEPART + np.append(np.arange(0.0, hours, 1.0), hours) * np.timedelta64(3600 * 10**9)
    lat, lon = np.linspace(40.0, 55.0, 16), np.linspace(-40.0, -10.0, 31)
    names = {"standard_name": "sea_surface_wave_significant_height", "units": "m"}
    height = np.full((len(time), len(lat), len(lon)), 0.5)
    data = xr.Dataset(
        {"VHM0": (("time", "lat", "lon"), height, names)},
        coords={
            "time": time,
            "lat": ("lat", lat, {"standard_name": "latitude", "units": "degrees_north"}),
            "lon": ("lon", lon, {"standard_name": "longitude", "units": "degrees_east"}),
        },
    )
    return Sea.open(data).filled(wind=0.0)


ISLAND = {
    "type": "Polygon",
    "coordinates": [[[-25.4, 45.4], [-25.2, 45.4], [-25.2, 47.0], [-25.4, 47.0], [-25.4, 45.4]]],
}


@pytest.mark.slow
def test_a_network_with_longer_paths_does_not_refuse_what_least_time_finds():
    least = 27.597  # [h] round the island by the plan of least time in a longer sea
    voyage = Voyage(start=(45.03, -30.0), goal=(47.31, -20.71), depart=DEPART, objective="fuel")
    choice = NetworkChoice("auto", None, None)
    context, ends = voyage_context(
        voyage,
        Ship.load("handysize-bulker"),
        small_waves(least + 0.3),
        Chart.from_geojson(ISLAND),
        choice,
    )
    longer = build_network(
        replace(choice, network="lattice", spacing=20e3),
        context.chart,
        context.sea,
        (ends[0], ends[1]),
        period=(voyage.earliest_departure, context.data_end),
    )

    def fastest(trade_off, alternatives):
        return fastest_in_known_water(trade_off, replace(alternatives[0], network=longer))

    alternative, _horizon, route = with_trade_off(context, ends, fastest)
    assert alternative.network is not longer
    assert route.feasible
    assert route.time_h < least + 0.3
