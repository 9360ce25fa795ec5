"""Dues of canals depend on the size of the ship."""

from dataclasses import replace

import pytest

from thalweg.chart.canal_tariff import known_gross_tonnage, tariff_kind
from thalweg.chart.canals import CANALS, CORINTH, KIEL, PANAMA, SUEZ, canals_with_dues
from thalweg.ship import Ship
from thalweg.ship.schema.ship_schema import HullSection


def dues_of(canal, **hull):
    return canals_with_dues([canal], HullSection(**hull))[0]


def test_suez_charges_by_bands_of_net_tonnage_and_kind():
    factor = SUEZ.tariff.usd
    got = dues_of(SUEZ, suez_net_tonnage=12_000, type="bulk carrier")
    assert got.fee == pytest.approx(factor * (5000 * 7.65 + 5000 * 4.39 + 2000 * 3.15), abs=1.0)
    assert got.fee_basis == "suez net tonnage 12,000 (of the ship file)"
    crude = dues_of(SUEZ, suez_net_tonnage=80_000, type="crude oil tanker")
    per_sdr = 5000 * 6.88 + 5000 * 3.84 + 10_000 * 3.45 + 50_000 * 1.48 + 10_000 * 1.29
    assert crude.fee == pytest.approx(factor * per_sdr, abs=1.0)


def test_a_ship_of_the_mean_net_tonnage_pays_the_mean():
    mean = 1.5e9 / 25_887
    assert SUEZ.tariff.dues(mean, kind="other ships") == pytest.approx(363_000, rel=1e-3)


def test_a_handysize_pays_less_than_a_vlcc():
    small, large = (
        canals_with_dues(CANALS, Ship.load(name).file.hull) for name in ("handysize-bulker", "jbc")
    )
    assert small[0].fee == pytest.approx(112_400, rel=0.01)
    assert large[0].fee == pytest.approx(296_500, rel=0.01)
    assert small[0].fee_basis == "suez net tonnage 11,132 (estimated: 0.4 of the displacement)"
    assert "half the deadweight" in large[0].fee_basis


@pytest.mark.parametrize(
    ("beam", "fixed", "rate"), [(23.4, 60e3, 5.25), (32.2, 100e3, 5.25), (45.0, 300e3, 3.25)]
)
def test_panama_charges_a_fixed_part_by_beam_and_a_rate_per_ton(beam, fixed, rate):
    got = dues_of(PANAMA, panama_net_tonnage=20_000, breadth_m=beam)
    assert got.fee == pytest.approx(fixed + rate * 20_000)
    by_gross = dues_of(PANAMA, gross_tonnage=20_000, breadth_m=beam)
    assert by_gross.fee == pytest.approx(fixed + rate * 0.92 * 20_000)
    assert by_gross.fee_basis.endswith("(from the gross tonnage of the ship file)")


def test_panama_dues_without_a_breadth_are_the_lowest_and_say_so():
    got = dues_of(PANAMA, panama_net_tonnage=20_000)
    assert got.fee == pytest.approx(60e3 + 5.25 * 20_000)
    assert got.fee_basis.endswith("; breadth unknown: the lowest tariff")
    assert "breadth" not in dues_of(SUEZ, suez_net_tonnage=12_000).fee_basis


@pytest.mark.parametrize(
    ("gross", "euro"), [(500, 159 + 1201), (2000, 615 + 1318), (7000, 1212 + 1618), (10_000, 3165)]
)
def test_kiel_charges_dues_and_steerers_by_gross_tonnage(gross, euro):
    pilots = 3914
    got = dues_of(KIEL, gross_tonnage=gross)
    assert got.fee / KIEL.tariff.usd - pilots == pytest.approx(euro, abs=5)


def test_unknown_size_and_own_fees():
    assert dues_of(SUEZ).fee == SUEZ.fee
    assert dues_of(SUEZ).fee_basis.startswith("the mean of all ships")
    own = replace(SUEZ, fee=1000.0)
    assert canals_with_dues([own], HullSection(gross_tonnage=9e3)) == (own,)
    assert dues_of(CORINTH, gross_tonnage=9e3) == CORINTH
    once = canals_with_dues(CANALS, HullSection(gross_tonnage=9e3))
    assert canals_with_dues(once, HullSection(gross_tonnage=50e3)) == once


def test_tonnage_from_length_breadth_and_draught():
    hull = HullSection(length_overall_m=100, breadth_m=15, draught_m=6)
    tons, how = known_gross_tonnage(hull)
    assert tons == pytest.approx(0.4 * 1.025 * 0.7 * 100 * 15 * 6) and "from length" in how


@pytest.mark.parametrize(
    ("written", "kind"),
    [
        ("Bulk carrier", "dry bulk carriers"),
        ("trailing suction hopper dredger", "special floating units"),
        ("product tanker", "product tankers"),
        ("LNG carrier", "chemical tankers, LNG carriers"),
        ("ferry", "other ships"),
    ],
)
def test_kinds_of_ships(written, kind):
    assert tariff_kind(written, 20.0)["suez_net_tonnage"] == kind
