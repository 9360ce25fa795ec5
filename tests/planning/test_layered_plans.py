"""Plans on layered networks."""

import pytest

from thalweg.chart import Chart
from thalweg.core.errors import InputError, NoRouteError
from thalweg.planning import Voyage, plan
from thalweg.sea import Sea
from thalweg.ship import Ship

PLACES = {"start": (63.6706, 9.2983), "goal": (66.5653, 11.6697)}
#: In the Naeroysund at Rorvik: node 120 of the fine network of Prestegardshus (2020).
STRAIT = (64.862, 11.253)


def _plan(voyage, **options):
    return plan(voyage, ship=Ship.simple(speed_kn=10.0, draught_m=3.0), sea=Sea.calm(), chart=Chart.gshhg("i"),
                **options)  # fmt: skip


def _voyage(**changes):
    return Voyage(depart="2026-01-01T00:00Z", offing_nm=0.0, **(PLACES | changes))


def test_inshore_by_the_strait_of_the_thesis():
    """--via by a lattice gives 191.8 nm = 355.2 km; offshore 184.3 nm."""
    shape = {"layers": 25, "fan": 7, "offset_nm": 1.5}
    inshore = _plan(_voyage(via=[STRAIT], layered=shape, objective="distance"))
    assert inshore.provenance["networks"][0]["kind"] == "layered"
    assert inshore.best.feasible
    assert inshore.best.distance_nm == pytest.approx(191.8, abs=0.4)
    offshore = _plan(_voyage(objective="distance"), network="layered")
    assert offshore.best.distance_nm == pytest.approx(184.3, abs=0.3)
    assert any("chosen" in note for note in offshore.notes)


def test_lists_need_one_value_for_each_section():
    with pytest.raises(InputError, match="2 values of layers are given for 1 section"):
        _plan(_voyage(layered={"layers": [1, 2], "fan": 3, "offset_nm": 1.0}))


def test_layers_belong_to_the_layered_network():
    with pytest.raises(InputError, match="Layers are given for the network 'lattice'"):
        _plan(_voyage(layered={"layers": 5, "fan": 3, "offset_nm": 1.0}), network="lattice")


def test_a_shape_without_a_route_is_refused_in_words():
    with pytest.raises(NoRouteError, match="between layer 0 and layer 1"):
        _plan(_voyage(layered={"layers": 5, "fan": 3, "offset_nm": 9.0}))


def test_files_of_voyages_keep_the_shape(tmp_path):
    shape = {"layers": [3, 15], "fan": 5, "offset_nm": [1.0, 0.5]}
    voyage = _voyage(via=[STRAIT], layered=shape)
    voyage.save(tmp_path / "voyage.yaml")
    assert Voyage.load(tmp_path / "voyage.yaml").to_dict()["layered"] == shape
