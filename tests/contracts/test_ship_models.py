"""All ship models of the package pass the model check, and the check detects faults."""

from dataclasses import dataclass

import numpy as np
import pytest

from thalweg.core.errors import InputError
from thalweg.ship import Ship, TableError, library_names
from thalweg.ship.model_check import check_ship_model
from thalweg.ship.tables.tabulate import constant_part

_QUICK = [name for name in library_names() if name not in ("jbc", "kvlcc2", "s175", "gunnerus")]


@pytest.mark.slow
@pytest.mark.parametrize("name", _QUICK)
def test_library_ships_keep_the_contract(name):
    check_ship_model(Ship.load(name))


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(set(library_names()) - set(_QUICK)))
def test_large_library_ships_keep_the_contract(name):
    check_ship_model(Ship.load(name))


def test_the_dredger_satisfies_it_empty_and_half_full():
    for load_factor in (0.0, 0.5):
        check_ship_model(Ship.load("hopper-dredger").with_load_factor(load_factor))


@pytest.mark.parametrize(
    "function",
    [
        lambda c: 4.0,
        lambda c: 6.0 - 0.2 * c.wave_height,
        lambda c: 6.0 - 0.05 * c.wind_speed * np.cos(c.wind_angle / 2),
        lambda c: 2.0 + np.abs(c.lat),
    ],
)
def test_function_ships_keep_the_contract(function):
    check_ship_model(Ship.from_speed_function(function))


@dataclass
class PluginModel:
    """A small third-party model with faults to order."""

    fault: str = ""

    @property
    def reads(self):
        return frozenset() if self.fault == "undeclared" else frozenset({"wave_height"})

    @property
    def identity(self):
        return {"kind": "plug-in"}

    def speeds(self, load_factor):
        return np.array([6.0, 5.0] if self.fault == "order" else [5.0, 6.0])

    def speed_through_water(self, conditions, setting):
        waves = np.asarray(conditions["wave_height"], float)
        speed = self.speeds(1.0)[setting] - 0.1 * waves
        if self.fault == "nan":
            speed = np.nan_to_num(speed, nan=4.0)
        if self.fault == "array":
            speed = speed - 0.001 * np.size(waves)
        if self.fault == "negative":
            speed = speed - 5.0
        if self.fault == "shape":
            return np.atleast_1d(speed)[:1]
        return speed

    def power(self, conditions, setting):
        rates = np.array([2e6, 1e6] if self.fault == "power" else [1e6, 2e6])
        return np.broadcast_to(
            rates[setting], np.broadcast_shapes(conditions.shape, np.shape(setting))
        )

    def fuel_rate(self, conditions, setting):
        if self.fault == "setting":
            return np.full(conditions.shape, 0.05)  # whatever the settings
        return self.power(conditions, setting) * 5e-8

    def top_speed(self, setting, load_factor):
        return 4.0 if self.fault == "bound" else 6.0

    def tabulate(self, load_factor, tolerance):
        from thalweg.kernels import codes
        from thalweg.ship import TablePart

        heights = np.linspace(0.0, 20.0, 21)
        slope = -0.3 if self.fault == "table" else -0.1
        losses = np.repeat((slope * heights)[:, None], 2, axis=1)
        parts = (
            constant_part(self.speeds(1.0)),
            TablePart((codes.AXIS_WAVE_HEIGHT,), (heights,), losses),
        )
        return parts, TableError(0.0, 0.0, 0.0, 100)

    def notes(self, conditions, setting):
        return []


def test_a_third_party_model_without_faults_passes():
    check_ship_model(PluginModel())


@pytest.mark.parametrize(
    ("fault", "message"),
    [
        ("undeclared", "'wave_height', which is not among the conditions"),
        ("order", "not positive and ascending"),
        ("nan", "an unknown wave_height gives a known speed"),
        ("array", "a single condition gives"),
        ("negative", "negative or not finite"),
        ("shape", "has shape"),
        ("setting", "the fuel rate has shape"),
        ("power", "power falls"),
        ("bound", "above its bound"),
        ("table", "the table differs"),
    ],
)
def test_each_fault_is_found_and_named(fault, message):
    with pytest.raises(InputError, match=message):
        check_ship_model(PluginModel(fault))


def test_a_plugin_ship_is_loaded_by_its_entry_point(monkeypatch):
    class Entry:
        name = "river-boat"

        @staticmethod
        def load():
            return lambda: Ship.simple(speed_kn=6.0, draught_m=2.0, name="River boat")

    monkeypatch.setattr("importlib.metadata.entry_points", lambda group: [Entry()])
    assert Ship.load("river-boat").name == "River boat"
