"""Ships that other packages offer in the entry-point group ``thalweg.ships``."""

import sys

import numpy as np
import pytest

from thalweg.core.errors import InputError
from thalweg.ship import Ship, check_ship_model, plugin_names
from thalweg.ship.conditions import Conditions

MODULE = """
import numpy as np
from thalweg.ship import Ship, TableError
from thalweg.ship.tables.tabulate import constant_part


class Barge:
    reads = frozenset()
    identity = {"kind": "barge"}
    draught = 2.5

    def speeds(self, load_factor):
        return np.array([3.0, 4.0])

    def speed_through_water(self, conditions, setting):
        shape = np.broadcast_shapes(conditions.shape, np.shape(setting))
        return np.broadcast_to(self.speeds(1.0)[setting], shape)

    def power(self, conditions, setting):
        return np.full(np.shape(self.speed_through_water(conditions, setting)), np.nan)

    fuel_rate = power

    def top_speed(self, setting, load_factor):
        return float(self.speeds(load_factor)[setting])

    def tabulate(self, load_factor, tolerance):
        return (constant_part(self.speeds(load_factor)),), TableError(0.0, 0.0, 0.0, 0)

    def notes(self, conditions, setting):
        return []


def whole():
    return Ship.simple(speed_kn=9.0, draught_m=4.0, name="whole")


def slowed(conditions):
    return 5.0 - 0.3 * conditions.wave_height


plain = {"name": "plain", "hull": {"draught_m": 3.0}, "speeds_kn": [7, 9]}
number = 7
"""
ENTRIES = """[thalweg.ships]
offered-whole = offered_ships:whole
offered-plain = offered_ships:plain
offered-barge = offered_ships:Barge
offered-slowed = offered_ships:slowed
offered-number = offered_ships:number
offered-gone = offered_ships:gone
offered-broken = no_such_module_at_all:ship
"""


@pytest.fixture(autouse=True)
def package(tmp_path, monkeypatch):
    """A package with entry points, as pip leaves it."""
    (tmp_path / "offered_ships.py").write_text(MODULE)
    info = tmp_path / "offered_ships-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: offered-ships\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(ENTRIES)
    monkeypatch.syspath_prepend(tmp_path)
    yield
    sys.modules.pop("offered_ships", None)


@pytest.mark.parametrize(
    ("name", "draught", "speed"),
    [
        ("offered-whole", 4.0, 9.0 * 1852 / 3600),
        ("offered-plain", 3.0, 7.0 * 1852 / 3600),
        ("offered-barge", 2.5, 3.0),
        ("offered-slowed", 0.0, 4.4),
    ],
)
def test_a_ship_of_another_package_loads_by_name_and_satisfies_the_protocol(name, draught, speed):
    ship = Ship.load(name)
    assert ship.draught == draught
    conditions = Conditions(wave_height=2.0)
    assert float(ship.speed_through_water(conditions, 0)) == pytest.approx(speed)
    check_ship_model(ship)


def test_names_are_listed_and_near_names_found():
    assert "offered-barge" in plugin_names()
    with pytest.raises(InputError, match="Did you mean 'offered-barge'"):
        Ship.load("offered-barg")


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("offered-number", "is int"),
        ("offered-gone", "cannot be loaded: .*gone"),
        ("offered-broken", "cannot be loaded: No module named"),
    ],
)
def test_plugins_that_offer_no_ship_are_refused(name, words):
    with pytest.raises(InputError, match=words) as refusal:
        Ship.load(name)
    assert refusal.value.possible and refusal.value.remedy


def test_a_model_without_members_of_the_protocol_is_refused_with_their_names():
    class Incomplete:
        reads = frozenset({"load_factor"})
        identity = "incomplete"

        def speeds(self, load_factor):
            return np.array([5.0])

    message = "it has no speed_through_water; it has no power"
    with pytest.raises(InputError, match=message) as caught:
        check_ship_model(Incomplete())
    assert "it has no speeds" not in str(caught.value)
