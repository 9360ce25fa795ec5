"""Objectives: priced key figures of a route, and prices on legs."""

from types import SimpleNamespace

import numpy as np
import pytest

from thalweg.core.errors import InputError
from thalweg.core.objective import FUEL_MASS, OBJECTIVE_NAMES, LegPrices, Objective

ROUTE = SimpleNamespace(
    time_h=10.0, distance_nm=120.0, fuel_t=3.0, energy_mwh=None, cost=900.0, co2_t=np.nan
)


@pytest.mark.parametrize(
    ("name", "value", "unit"),
    [("time", 10.0, "h"), ("distance", 120.0, "nm"), ("fuel", 3.0, "t"), ("cost", 900.0, "EUR")],
)
def test_an_objective_of_one_key_figure_has_its_value_and_unit(name, value, unit):
    objective = Objective.of(name, currency="EUR")
    assert objective.value(ROUTE) == value
    assert (objective.name, objective.unit) == (name, unit)
    assert objective.prices == {name: 1.0}


def test_prices_add_up():
    both = Objective(time=50.0, fuel=600.0)
    assert both.value(ROUTE) == 50.0 * 10.0 + 600.0 * 3.0
    assert (both.name, both.unit) == ("weighted sum", "")


def test_unknown_key_figures_make_the_value_infinite_only_where_they_are_priced():
    assert Objective.of("energy").value(ROUTE) == np.inf
    assert Objective.of("co2").value(ROUTE) == np.inf
    names = {
        "time",
        "distance",
        "fuel",
        "energy",
        "cost",
        "co2",
        "comfort",
        "encounters",
        "inshore",
    }
    assert set(OBJECTIVE_NAMES) == names


@pytest.mark.parametrize("wrong", [{}, {"time": -1.0}, {"fuel": np.nan}, {"cost": np.inf}])
def test_impossible_objectives_are_refused(wrong):
    with pytest.raises(InputError):
        Objective(**wrong)


def test_names_are_checked():
    with pytest.raises(InputError, match="Did you mean 'fuel'"):
        Objective.of("fule")


@pytest.mark.parametrize(
    "wrong", [{"inside": -1.0}, {"time": np.nan}, {"waiting": -1e-9}, {"dues": np.inf}]
)
def test_impossible_prices_of_legs_are_refused(wrong):
    with pytest.raises(InputError, match=next(iter(wrong))):
        LegPrices(**wrong)


def test_prices_of_legs_mix_control_areas_and_count_price_zones_only_with_dues():
    inside, factor = np.array([0.0, 0.25, 1.0]), np.array([1.0, 2.0, 3.0])
    mass = LegPrices(inside=1.4, outside=1.0)
    assert mass.of_legs(inside, factor) == pytest.approx([1.0, 1.1, 1.4])
    money = LegPrices(inside=1.4, outside=1.0, dues=1.0)
    assert money.of_legs(inside, factor) == pytest.approx([1.0, 2.2, 4.2])
    assert mass.differs_in_control_areas and not FUEL_MASS.differs_in_control_areas
