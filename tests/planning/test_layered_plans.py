"""Plans on layered networks."""

import numpy as np
import pytest

from thalweg.chart import Chart
from thalweg.core import geodesy
from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning import Voyage, plan
from thalweg.sea import Sea
from thalweg.ship import Ship

PLACES = {"start": (63.6706, 9.2983), "goal": (66.5653, 11.6697)}
WAYPOINT = (64.6047, 10.5371)


def _plan(voyage, **options):
    ship = Ship.simple(speed_kn=10.0, draught_m=3.0)
    return plan(voyage, ship=ship, sea=Sea.calm(), chart=Chart.gshhg("i"), **options)


def _voyage(**changes):
    return Voyage(depart="2026-01-01T00:00Z", **(PLACES | {"offing_nm": 0.0} | changes))


@pytest.mark.slow
def test_offshore_is_practically_the_geodesic():
    offshore = _plan(_voyage(objective="distance"), network="layered")
    assert offshore.provenance["networks"][0]["kind"] == "layered"
    assert offshore.best.distance_nm == pytest.approx(184.3, abs=0.3)
    assert any("chosen" in note for note in offshore.notes)


def test_lists_need_one_value_for_each_section():
    with pytest.raises(InputError, match="2 values of layers are given for 1 section"):
        _plan(_voyage(layered={"layers": [1, 2], "fan": 3, "offset_nm": 1.0}))


def test_layers_belong_to_the_layered_network():
    with pytest.raises(InputError, match="Layers are given for the network 'lattice'"):
        _plan(_voyage(layered={"layers": 5, "fan": 3, "offset_nm": 1.0}), network="lattice")


@pytest.mark.slow
def test_a_shape_without_a_route_is_refused_in_words():
    with pytest.raises(NoRouteError, match="section 1 of 1: it ends between layer 0 and layer 1"):
        _plan(_voyage(layered={"layers": 5, "fan": 3, "offset_nm": 9.0}))


@pytest.mark.slow
def test_a_start_beside_rocks_does_not_lower_the_offing_of_the_whole_voyage():
    shape = {"layers": 15, "fan": 5, "offset_nm": 2.4}
    ends = {"start": (64.2, 9.3), "goal": (65.6, 11.0), "offing_nm": 0.3}
    found = _plan(_voyage(layered=shape, objective="distance", **ends), network="layered").best
    lat, lon = geodesy.densify(found.track.lat, found.track.lon, 500.0)[:2]
    from_ends = (geodesy.distance(lat, lon, lat[k], lon[k]) for k in (0, -1))
    far = np.minimum(*from_ends) > 15.0 * NAUTICAL_MILE
    assert far.sum() > 200
    shore = Chart.gshhg("i").coastline.shore_distance(lat[far], lon[far])
    assert shore.min() >= 0.3 * NAUTICAL_MILE


def test_files_of_voyages_keep_the_shape(tmp_path):
    shape = {"layers": [3, 15], "fan": 5, "offset_nm": [1.0, 0.5]}
    voyage = _voyage(via=[WAYPOINT], layered=shape)
    voyage.save(tmp_path / "voyage.yaml")
    assert Voyage.load(tmp_path / "voyage.yaml").to_dict()["layered"] == shape


@pytest.mark.slow
def test_a_chosen_shape_that_contains_a_strait_has_a_route_through_it():
    """The Naeroysund, node 120 of Prestegardshus; plans by it and offshore have all figures."""
    ends = {"start": (64.6047, 10.5371), "goal": (65.3480, 11.3946), "objective": "distance"}
    strait = (64.862, 11.253)
    offshore = _plan(_voyage(layered={"contain": [strait], "within_percent": 2.0}, **ends))
    inshore = _plan(_voyage(via=[strait], **ends))
    assert 2.0 < inshore.best.distance_nm - offshore.best.distance_nm < 5.0
    away = geodesy.distance(inshore.best.track.lat, inshore.best.track.lon, *strait)
    assert away.min() < 100.0
    for plan_ in (inshore, offshore):
        known = plan_.best.indicators
        assert known["inshore_percent"] > 0.0 and known["land_distance_nm"] >= 0.0
    assert any("within 2 %" in note for note in offshore.notes)
