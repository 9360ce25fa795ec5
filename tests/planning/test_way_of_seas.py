"""Routes of long voyages are held against the way over the graph of all seas."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from thalweg.core.errors import NoRouteError
from thalweg.core.limits import Limits
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.request.voyage_endpoints import Endpoint
from thalweg.planning.seaways import world_chart
from thalweg.planning.single import way_of_seas
from thalweg.planning.single.way_of_seas import along_way_of_seas

OFF_THE_CAPE = Endpoint("35.0000S 19.0000E", -35.0, 19.0, 0.0)
OFF_QINGDAO = Endpoint("35.8000N 121.0000E", 35.8, 121.0, 0.0)


def _context(network: str = "auto", *, way_is_open: bool = False) -> SimpleNamespace:
    return SimpleNamespace(
        chart=world_chart(),
        choice=SimpleNamespace(network=network),
        voyage=SimpleNamespace(objective="distance"),
        needs=SimpleNamespace(limits=SimpleNamespace(offing=2.0 * NAUTICAL_MILE)),
        setting=0,
        evaluate=lambda track: SimpleNamespace(feasible=way_is_open),
    )


def _route(miles: float) -> SimpleNamespace:
    """A route of one leg in open water; only its length and departure are read."""
    track = SimpleNamespace(lat=np.array([0.0, 0.1]), lon=np.array([60.0, 60.1]))
    return SimpleNamespace(
        legs={
            "length": np.array([miles * NAUTICAL_MILE]),
            "depart": np.zeros(1),
            "arrive": np.array([miles]),
        },
        track=track,
        feasible=True,
        violations=(),
        depart=0.0,
        arrive=miles,
        time_h=miles,
    )


@pytest.mark.slow
def test_a_route_by_a_strait_that_is_far_off_is_compared_with_the_way_by_sunda():
    networks = []

    def searched(network):
        networks.append(network)
        return _route(7780.0)

    by_lombok = _route(8240.0)  # as the coarse network finds it
    found = along_way_of_seas(
        _context(), (OFF_THE_CAPE, OFF_QINGDAO), by_lombok, searched, Limits()
    )
    assert found is not by_lombok
    assert found.legs["length"].sum() == pytest.approx(7780.0 * NAUTICAL_MILE)
    (network,) = networks
    lat, lon = network.stations.lat, network.stations.lon
    in_sunda = (abs(lat + 6.0) < 0.7) & (abs(lon - 105.8) < 0.7)
    in_lombok = (abs(lat + 8.8) < 0.7) & (abs(lon - 115.7) < 0.7)
    assert in_sunda.sum() > 5 and not in_lombok.any()


@pytest.mark.slow
def test_a_longer_route_along_the_way_or_none_changes_nothing(monkeypatch):
    monkeypatch.setattr(way_of_seas, "lattice", lambda chart, *places, along: along)
    given = _route(8240.0)

    def refused(network):
        raise NoRouteError("No route.", "A test.", "None.")

    ends = OFF_THE_CAPE, OFF_QINGDAO
    assert along_way_of_seas(_context(), ends, given, refused, Limits()) is given
    assert along_way_of_seas(_context(), ends, given, lambda own: _route(8300.0), Limits()) is given


@pytest.mark.parametrize(("network", "miles"), [("auto", 7700.0), ("globe", 8240.0)])
def test_no_way_is_searched_where_the_route_is_short_or_the_network_was_chosen(network, miles):
    def never(network):
        raise AssertionError("searched")

    given, ends = _route(miles), (OFF_THE_CAPE, OFF_QINGDAO)
    assert along_way_of_seas(_context(network), ends, given, never, Limits()) is given


@pytest.mark.parametrize(("way_is_open", "miles"), [(True, 7775.0), (False, 8235.0)])
def test_the_way_itself_is_refined_where_the_network_along_it_is_too_coarse(
    monkeypatch, way_is_open, miles
):
    refined = []

    def refine(context, track, limits):
        refined.append(track)
        return _route(7775.0)

    monkeypatch.setattr(way_of_seas, "lattice", lambda chart, *places, along: along)
    monkeypatch.setattr(way_of_seas, "refine_track", refine)
    found = along_way_of_seas(
        _context(way_is_open=way_is_open),
        (OFF_THE_CAPE, OFF_QINGDAO),
        _route(8240.0),
        lambda network: _route(8235.0),
        Limits(),
    )
    assert found.legs["length"].sum() == pytest.approx(miles * NAUTICAL_MILE)
    assert len(refined) == way_is_open
    for track in refined:
        assert (track.lat[0], track.lon[0]) == (-35.0, 19.0)
        assert (track.lat[-1], track.lon[-1]) == (35.8, 121.0)
