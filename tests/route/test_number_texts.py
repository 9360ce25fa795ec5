"""Digits of numbers in summaries and tables."""

import math

import pytest

from thalweg import Sea, Ship, evaluate
from thalweg.planning.report.route_summary import distance_text, fuel_text
from thalweg.route.number_texts import (
    amount_column,
    amount_text,
    decimals,
    hours_texts,
    miles_text,
)


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (0.0312, "t", "31.2 kg"),  # was 0.0 t
        (0.312, "t", "312 kg"),
        (0.00853, "t", "8.53 kg"),
        (2.9412, "t", "2.94 t"),
        (12.345, "t", "12.3 t"),
        (2345.64, "t", "2,345.6 t"),
        (23456.4, "t", "23,456 t"),
        (0.0, "t", "0.0 t"),
        (0.0453, "MWh", "45.3 kWh"),
        (4788.3, "USD", "4,788 USD"),
        (3.456, "EUR", "3.46 EUR"),
        (3.456, "% sick", "3.46 % sick"),
    ],
)
def test_amounts_have_the_unit_and_digits_of_their_size(value, unit, text):
    assert amount_text(value, unit) == text


def test_amounts_beside_each_other_have_one_unit_and_are_kept_apart():
    assert amount_column([0.5, 0.02, math.nan], "t") == (["500", "20", "-"], "kg")
    assert amount_column([1.5, 0.02], "t") == (["1.50", "0.02"], "t")
    assert amount_column([123.41, 123.43], "t").texts == ["123.41", "123.43"]
    assert amount_column([4788.31, 4788.42], "USD").texts == ["4,788.3", "4,788.4"]


def test_times_that_are_short_or_near_each_other_have_two_decimals():
    assert hours_texts([12.32, 14.0]) == ["12.3", "14.0"]
    assert hours_texts([12.32, 12.34]) == ["12.32", "12.34"]  # were both 12.3
    assert hours_texts([0.52]) == ["0.52"]
    assert hours_texts([12.321, 12.322]) == ["12.3", "12.3"]  # within a minute
    assert decimals([1234.56, 1234.57], least=1) == 1  # no more than five digits


def test_miles_of_short_ways_have_two_decimals():
    assert [miles_text(value) for value in (0.853, 61.27, 1234.5)] == ["0.85", "61.3", "1,234.5"]


def test_the_summary_of_a_small_craft_states_kilograms():
    boat = Ship.simple(speed_kn=6.0, draught_m=1.0, fuel_t_per_day=0.12)
    route = evaluate([(52.0, 3.0), (52.0, 3.05)], ship=boat, sea=Sea.calm(), depart=0.0)
    assert fuel_text(route) == "1.55 kg, of it 1.55 kg in emission control areas"  # was 0.0 t
    assert distance_text(route, []).startswith("1.85 nm")
    assert "1.55 kg fuel" in str(route)
