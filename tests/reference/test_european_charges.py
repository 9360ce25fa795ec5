"""Emission allowances and FuelEU Maritime: published figures."""

import math

import pytest

from thalweg import InputError, Sea, Ship, evaluate
from thalweg.ship.methods.engine.european_charges import (
    WELL_TO_WAKE,
    EuropeanCharges,
    ets_phase_in,
    fueleu_penalty,
    fueleu_target,
    other_greenhouse_gases,
    voyage_share_between,
)

BULKER = Ship.load("handysize-bulker")
AT_SEA = [(0, -30), (0, -29)]


def test_the_phase_in_and_the_targets_are_those_of_the_regulations():
    assert [ets_phase_in(y) for y in (2023, 2024, 2025, 2026, 2030)] == [0.0, 0.4, 0.7, 1.0, 1.0]
    assert fueleu_target(2025) == pytest.approx(89.3368)  # 89.34 as published
    assert fueleu_target(2030) == pytest.approx(85.6904)
    assert fueleu_target(2050) == pytest.approx(18.232)
    assert math.isinf(fueleu_target(2024))


def test_methane_and_nitrous_oxide_need_allowances_from_2026():
    """3.114 + 28 x 0.00005 + 265 x 0.00018 = 3.1631 t of CO2 equivalent per t of HFO."""
    assert [3.114 + other_greenhouse_gases("hfo", year) for year in (2025, 2026)] == [
        3.114, pytest.approx(3.1631)
    ]  # fmt: skip
    charges = EuropeanCharges(0.5, allowance_price=80.0, year=2026)
    assert charges.per_kg("hfo", 3.114) == pytest.approx(0.5 * 0.080 * 3.1631)
    assert charges.per_kg("lng", 2.75) == pytest.approx(0.5 * 0.080 * 2.75)


def test_default_intensities_of_fuels():
    assert WELL_TO_WAKE["hfo"].intensity == pytest.approx(91.74, abs=0.005)
    assert WELL_TO_WAKE["mgo"].intensity == pytest.approx(90.77, abs=0.005)


def test_the_penalty_of_a_tonne_of_heavy_fuel_oil_in_2025():
    """(91.744 - 89.337) x 40,500 / (91.744 x 41,000) x 2400 EUR = 62.2 EUR."""
    penalty = fueleu_penalty(40_500.0, intensity=WELL_TO_WAKE["hfo"].intensity, year=2025)
    assert float(penalty) == pytest.approx(62.2, abs=0.05)
    assert float(fueleu_penalty(40_500.0, intensity=80.0, year=2025)) == 0.0


def test_charges_are_a_part_of_the_cost_by_the_share_of_the_voyage():
    plain = evaluate(AT_SEA, ship=BULKER, sea=Sea.calm(), depart=0)
    for share in (0.0, 0.5, 1.0):
        charges = EuropeanCharges(share, allowance_price=80.0, year=2025)
        route = evaluate(AT_SEA, ship=BULKER.with_charges(charges), sea=Sea.calm(), depart=0)
        expected = share * 0.7 * 80.0 * plain.co2_t
        assert route.cost_parts["EU ETS"] == pytest.approx(expected, rel=1e-9)
        assert route.cost_parts["FuelEU"] is None  # without a price of the euro
        assert route.cost == pytest.approx(plain.cost + expected, rel=1e-9)
        assert route.prices["european_charges"]["allowance_price"] == 80.0
    both = BULKER.with_charges(EuropeanCharges(1.0, 80.0, euro_price=1.1, year=2025))
    route = evaluate(AT_SEA, ship=both, sea=Sea.calm(), depart=0)
    parts = route.cost_parts
    assert parts["FuelEU"] == pytest.approx(1.1 * 62.2 * plain.fuel_t, rel=1e-3)
    assert parts["EU ETS"] == pytest.approx(0.7 * 80.0 * plain.co2_t, rel=1e-9)
    assert parts["fuel"] == pytest.approx(plain.cost, rel=1e-9)
    assert sum(parts.values()) == pytest.approx(route.cost, rel=1e-12)


@pytest.mark.parametrize(
    ("tonnage", "share", "words"),
    [
        (2990.0, 0.0, "0 % for a ship of 2,990 GT; they apply from 5,000 GT on"),
        (5000.0, 1.0, None),
        (None, 1.0, "are counted as for a ship of 5,000 GT or more"),
    ],
)
def test_ships_below_5000_gross_tons_pay_none(tonnage, share, words):
    engine = {"sfoc_g_per_kwh": 190, "reference_power_kw": 900, "reference_speed_kn": 10.0}
    boat = Ship.from_dict(
        {
            "name": "coaster",
            "hull": {"draught_m": 5.0} | ({} if tonnage is None else {"gross_tonnage": tonnage}),
            "speeds_kn": [10],
            "engine": engine,
            "fuel": {"type": "mgo", "price_per_t": 700},
        }
    ).with_charges(EuropeanCharges(1.0, 80.0, year=2026))
    route = evaluate(AT_SEA, ship=boat, sea=Sea.calm(), depart=0)
    expected = share * 80.0 * route.co2_t
    assert route.cost_parts["EU ETS"] == pytest.approx(expected, rel=0.02, abs=1e-9)
    notes = [text for text in route.assumptions if "European Union" in text]
    assert (words is None and not notes) or words in notes[0]


def test_allowances_for_a_fuel_of_unknown_carbon_are_refused():
    """A plan of least cost said that no price of fuel was known, although one was given."""
    ship = Ship.from_dict(
        {"name": "x", "speeds_kn": [12], "fuel": {"reference_t_per_day": 24, "price_per_t": 600},
         "engine": {"reference_speed_kn": 12}, "hull": {"draught_m": 9.0}}
    )  # fmt: skip
    with pytest.raises(InputError, match="the CO2 of the fuel is unknown"):
        ship.with_charges(EuropeanCharges(0.5, 80.0, year=2026))
    assert ship.with_charges(EuropeanCharges(0.0, 80.0, year=2026)).fuel_terms.charges is not None


def test_charges_need_a_price_of_fuel_and_a_share_of_the_rules():
    with pytest.raises(InputError, match="fuel has no price"):
        Ship.simple(8.0, 5.0).with_charges(EuropeanCharges(1.0, 80.0))
    with pytest.raises(InputError, match=r"voyage share of 0\.3"):
        EuropeanCharges(0.3, 80.0)


@pytest.mark.parametrize(
    ("departure", "destination", "share"),
    [("NL", "DE", 1.0), ("NO", "IS", 1.0), ("NL", "GB", 0.5), ("US", "FR", 0.5), ("RE", "FR", 1.0),
     ("GL", "DK", 0.5), ("GB", "US", 0.0), ("FO", "GI", 0.0)],
)  # fmt: skip
def test_the_share_by_the_countries_of_the_ports(departure, destination, share):
    assert voyage_share_between(departure, destination) == share
