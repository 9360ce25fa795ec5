"""Prices of fuel and time, inside and outside emission control areas."""

from __future__ import annotations

import math

import pytest

from thalweg.core.errors import InputError
from thalweg.ship import Ship
from thalweg.ship.file.price_reader import fuel_terms
from thalweg.ship.fuel_prices import FuelTerms
from thalweg.ship.schema.ship_schema import ShipFile


def terms_of(sections: dict) -> FuelTerms:
    """Fuels and prices of a ship file with these sections."""
    return fuel_terms(ShipFile.of({"name": "ship", **sections}))


def test_factors_of_a_kilogram_of_fuel():
    terms = Ship.load("handysize-bulker").fuel_terms
    assert terms.per_kg("fuel", True) == terms.per_kg("fuel", False) == 1.0
    assert terms.per_kg("cost", False) == pytest.approx(0.3)
    assert terms.per_kg("cost", True) == pytest.approx(0.3 * 1.5593)
    assert terms.per_kg("co2", True) == terms.per_kg("co2", False) == pytest.approx(3.114)
    assert terms.currency == "USD" and terms.time_price == 0.0
    with pytest.raises(InputError, match="co2"):
        terms.per_kg("c02", True)


def test_another_fuel_inside_burns_by_the_same_heat():
    terms = terms_of(
        {"fuel": {"type": "hfo", "eca_type": "mgo", "price_per_t": 500.0, "eca_price_per_t": 800.0}}
    )
    assert terms.per_kg("fuel", True) == pytest.approx(40.2 / 42.7)
    assert terms.per_kg("cost", True) == pytest.approx(0.8 * 40.2 / 42.7)
    assert terms.per_kg("co2", True) == pytest.approx(3.206 * 40.2 / 42.7)
    dearer = terms.with_prices(1000.0)
    assert dearer.price_inside == pytest.approx(1.6)  # the ratio is kept


def test_given_prices_are_used():
    terms = Ship.load("handysize-bulker").fuel_terms
    dearer = terms.with_prices(600.0)
    assert dearer.per_kg("cost", False) == pytest.approx(0.6)
    assert dearer.per_kg("cost", True) == pytest.approx(0.6 * 1.5593)
    flat = terms.with_prices(eca_price_factor=1.0)
    assert flat.per_kg("cost", True) == flat.per_kg("cost", False) == pytest.approx(0.3)
    hired = terms.with_prices(time_usd_per_day=8640.0)
    assert hired.time_price == pytest.approx(0.1)
    assert hired.price_outside == terms.price_outside


def test_a_factor_waits_for_a_price():
    """A ship file with a factor but no price keeps the factor until a price comes."""
    terms = terms_of({"fuel": {"type": "hfo", "eca_price_factor": 1.4}})
    assert math.isnan(terms.per_kg("cost", True))
    assert terms.with_prices(500.0).price_inside == pytest.approx(0.7)
    with pytest.raises(InputError, match="fuel has no price"):
        terms.with_prices(eca_price_factor=1.5)


def test_unknown_prices_stay_unknown():
    terms = terms_of({})
    assert math.isnan(terms.per_kg("cost", False)) and math.isnan(terms.per_kg("co2", True))
    assert math.isnan(terms.with_prices().per_kg("cost", True))


@pytest.mark.parametrize("bad", [-1.0, math.nan, math.inf, "much"])
def test_invalid_prices_are_refused(bad):
    terms = Ship.load("handysize-bulker").fuel_terms
    for name in ("usd_per_t", "eca_price_factor", "time_usd_per_day"):
        with pytest.raises(InputError, match="price") as caught:
            terms.with_prices(**{name: bad})
        assert caught.value.possible and caught.value.remedy
    with pytest.raises(InputError, match="above zero"):
        terms.with_prices(eca_price_factor=0.0)


def test_price_of_time_from_the_ship_file():
    assert terms_of({"costs": {"hire_per_day": 8640.0}}).time_price == pytest.approx(0.1)
    assert terms_of({"costs": {"per_week": 604800.0}}).time_price == pytest.approx(1.0)
    with pytest.raises(InputError, match="given twice"):
        terms_of({"costs": {"hire_per_day": 1.0, "per_week": 7.0}})


def test_a_currency_is_a_code_of_three_letters():
    assert terms_of({"fuel": {"price_per_t": 500.0, "currency": " eur"}}).currency == "EUR"
    for wrong in ("bananas", "E1R", "", "€"):
        with pytest.raises(ValueError, match=r"three letters|text"):
            terms_of({"fuel": {"price_per_t": 500.0, "currency": wrong}})


def test_one_currency():
    euros = {"fuel": {"price_per_t": 500.0, "currency": "EUR"}}
    assert terms_of(euros).currency == "EUR"
    with pytest.raises(InputError, match=r"EUR and USD"):
        terms_of({**euros, "costs": {"hire_per_day": 1.0, "currency": "USD"}})
    assert terms_of(euros).with_prices(600.0).currency == "USD"
    with pytest.raises(InputError, match="prices in EUR"):
        terms_of(euros).with_prices(time_usd_per_day=100.0)


def test_the_price_of_speed_is_used_only_where_fuel_has_no_price():
    costs = {"per_week": 604800.0, "per_second_per_cubed_speed": 0.008, "currency": "EUR"}
    terms = terms_of({"costs": costs})
    assert terms.by_speed and terms.cubed_speed_price == 0.008
    assert not terms_of({"costs": {"per_week": 604800.0}}).by_speed
    assert not terms_of({"costs": costs, "fuel": {"price_per_t": 500.0}}).by_speed
    with pytest.raises(InputError, match="prices in EUR"):
        terms.with_prices(time_usd_per_day=100.0)
    dollars = terms.with_prices(600.0, time_usd_per_day=100.0)
    assert not dollars.by_speed and dollars.currency == "USD"
