"""Carbon factors of MEPC.364(79) and fuel switching."""

from __future__ import annotations

import numpy as np
import pytest

from thalweg.core.errors import InputError
from thalweg.ship.fuel_prices import FuelTerms
from thalweg.ship.methods.engine import fuel_properties

PRINTED = {
    "mgo": (3.206, 42_700),
    "lfo": (3.151, 41_200),
    "hfo": (3.114, 40_200),
    "lpg_propane": (3.000, 46_300),
    "lpg_butane": (3.030, 45_700),
    "ethane": (2.927, 46_400),
    "lng": (2.750, 48_000),
    "methanol": (1.375, 19_900),
    "ethanol": (1.913, 26_800),
}


@pytest.mark.parametrize(("name", "row"), PRINTED.items())
def test_factors(name, row):
    found = fuel_properties.fuel_named(name)
    assert (found.carbon_factor, found.heating_value / 1e3) == row
    assert found.source


def test_every_fuel_is_in_the_printed_table():
    assert set(fuel_properties.FUELS) == set(PRINTED)


def test_carbon_factor_is_carbon_content_times_44_over_12():
    """The resolution's carbon contents .8744 ... .5217 give its factors to the third digit."""
    contents = {
        "mgo": 0.8744,
        "lfo": 0.8594,
        "hfo": 0.8493,
        "lpg_propane": 0.8182,
        "lpg_butane": 0.8264,
        "ethane": 0.7989,
        "lng": 0.75,
        "methanol": 0.375,
        "ethanol": 0.5217,
    }
    for name, content in contents.items():
        factor = content * (12.0107 + 2 * 15.9994) / 12.0107
        assert fuel_properties.FUELS[name].carbon_factor == pytest.approx(factor, abs=4e-3)


@pytest.mark.parametrize(
    ("name", "carbon", "hydrogen", "oxygen"),
    [("ethane", 2, 6, 0), ("methanol", 1, 4, 1), ("ethanol", 2, 6, 1), ("lng", 1, 4, 0)],
)
def test_pure_fuels_burn_to_the_carbon_of_their_molecule(name, carbon, hydrogen, oxygen):
    """The table's carbon contents are rounded: 0.12 % for the alcohols, 0.25 % for methane."""
    molecule = carbon * 12.011 + hydrogen * 1.008 + oxygen * 15.999
    assert fuel_properties.FUELS[name].carbon_factor == pytest.approx(
        carbon * 44.009 / molecule, rel=2.6e-3
    )


def test_co2_of_the_example():
    """27.593 t of heavy fuel oil: 85.925 t CO2."""
    assert fuel_properties.co2_mass(27.593, carbon_factor=3.114) == pytest.approx(85.925, abs=5e-4)


def test_names():
    assert fuel_properties.fuel_named("MDO").name == "mgo"
    assert fuel_properties.fuel_named("LPG Butane").name == "lpg_butane"
    with pytest.raises(InputError, match="methanol"):
        fuel_properties.fuel_named("metanol")


def test_same_heat():
    mgo, hfo = fuel_properties.FUELS["mgo"], fuel_properties.FUELS["hfo"]
    assert fuel_properties.equal_energy_mass(100.0, of=hfo, to=mgo) == pytest.approx(
        100.0 * 40.2 / 42.7
    )
    assert fuel_properties.equal_energy_mass(5.0, of=hfo, to=hfo) == 5.0


def _terms(inside: str, price_outside_t: float, price_inside_t: float) -> FuelTerms:
    """Heavy fuel oil outside control areas, and a fuel inside, with prices per tonne."""
    hfo = fuel_properties.FUELS["hfo"]
    other = hfo if inside == "hfo" else fuel_properties.FUELS[inside]
    return FuelTerms(hfo, other, price_outside_t / 1000.0, price_inside_t / 1000.0)


def test_switching_all_none_half():
    terms, fuel, share = _terms("mgo", 500.0, 800.0), [1000.0] * 3, [0.0, 1.0, 0.5]
    light = 1000.0 * 40.2 / 42.7
    mass, inside = terms.of_fuel("fuel", fuel, share)
    assert mass == pytest.approx([1000.0, light, 500.0 + light / 2])
    assert inside == pytest.approx([0.0, light, light / 2])
    co2 = terms.of_fuel("co2", fuel, share)[0]
    assert co2 == pytest.approx([3114.0, light * 3.206, 1557.0 + light / 2 * 3.206])
    cost = terms.of_fuel("cost", fuel, share)[0]
    assert cost == pytest.approx([500.0, light * 0.8, 250.0 + light * 0.4])


def test_switching_without_price_and_with_unknown():
    terms, fuel, share = _terms("mgo", 500.0, np.nan), [1000.0, np.nan], [0.0, 0.5]
    cost = terms.of_fuel("cost", fuel, share)[0]
    assert cost[0] == pytest.approx(500.0)
    assert np.isnan(terms.of_fuel("fuel", fuel, share)[0][1])
    assert np.isnan(cost[1])
    with pytest.raises(InputError, match="share"):
        terms.of_fuel("fuel", 1.0, 1.5)


def test_seuren_multiplier():
    """300 USD/t and 1.5593 inside (Seuren 2020, Table 5.2)."""
    terms = _terms("hfo", 300.0, 300 * 1.5593)
    assert terms.of_fuel("cost", 2000.0, 1.0)[0] == pytest.approx(2.0 * 300.0 * 1.5593)


def test_van_halem_cost():
    """One hour at 5 m/s costs 7766.67; in still water 4.1667 m/s is cheapest."""
    assert fuel_properties.halem_cost(3600.0, 5.0) == pytest.approx(7766.67, abs=5e-3)
    best = (700_000.0 / 604_800.0 / (2.0 * 0.008)) ** (1.0 / 3.0)
    assert best == pytest.approx(4.1667, abs=5e-5)
    speeds = np.linspace(3.0, 6.0, 30_001)
    assert speeds[np.argmin(fuel_properties.halem_cost(1e5 / speeds, speeds))] == pytest.approx(
        best, abs=2e-4
    )
