"""CII lines, reductions and ratings of the IMO guidelines, and the EEOI."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from thalweg.core.errors import InputError
from thalweg.ship.methods import carbon_intensity as cii

#: exp(d1) to exp(d4) as printed in MEPC.354(78), Table 1.
PRINTED_BOUNDARIES = [
    ("bulk_carrier", 80_000, (0.86, 0.94, 1.06, 1.18)),
    ("gas_carrier", 65_000, (0.81, 0.91, 1.12, 1.44)),
    ("gas_carrier", 64_999, (0.85, 0.95, 1.06, 1.25)),
    ("tanker", 50_000, (0.82, 0.93, 1.08, 1.28)),
    ("container_ship", 50_000, (0.83, 0.94, 1.07, 1.19)),
    ("general_cargo_ship", 5_000, (0.83, 0.94, 1.06, 1.19)),
    ("refrigerated_cargo_carrier", 9_000, (0.78, 0.91, 1.07, 1.20)),
    ("combination_carrier", 80_000, (0.87, 0.96, 1.06, 1.14)),
    ("lng_carrier", 100_000, (0.89, 0.98, 1.06, 1.13)),
    ("lng_carrier", 99_999, (0.78, 0.92, 1.10, 1.37)),
    ("vehicle_carrier", 40_000, (0.86, 0.94, 1.06, 1.16)),
    ("ro_ro_cargo_ship", 20_000, (0.76, 0.89, 1.08, 1.27)),
    ("ro_ro_passenger_ship", 20_000, (0.76, 0.92, 1.14, 1.30)),
    ("cruise_passenger_ship", 90_000, (0.87, 0.95, 1.06, 1.16)),
]


@pytest.mark.parametrize(("kind", "capacity", "printed"), PRINTED_BOUNDARIES)
def test_boundaries_as_printed(kind, capacity, printed):
    limits = cii.rating_boundaries(kind, capacity=capacity, year=2024)
    assert limits / cii.required_cii(kind, capacity=capacity, year=2024) == pytest.approx(printed)


def test_eighty_thousand_tonne_bulker():
    """5000 t of heavy fuel oil over 60 000 nm: 3.2437 attained, 4.23169 line, A in 2024."""
    attained = cii.attained_cii(5e6 * 3.114, capacity=80_000.0, distance_nm=60_000.0)
    assert attained == pytest.approx(3.2437, abs=5.1e-5)
    assert cii.reference_cii("bulk_carrier", capacity=80_000.0) == pytest.approx(4.23169, abs=6e-6)
    required = cii.required_cii("bulk_carrier", capacity=80_000.0, year=2024)
    assert required == pytest.approx(3.9355, abs=5.1e-5)
    limits = cii.rating_boundaries("bulk_carrier", capacity=80_000.0, year=2024)
    assert limits[0] == pytest.approx(3.3845, abs=5.1e-5)
    rating = cii.cii_rating(attained, ship_type="bulk_carrier", capacity=80_000.0, year=2024)
    assert rating == "A"


def test_worked_example_of_the_guidelines():
    """Required 10: boundaries 8.6, 9.4, 10.6, 11.8; attained 9 is rated B (G4, section 4)."""
    capacity = (4745.0 / 10.0) ** (1.0 / 0.622)
    limits = cii.rating_boundaries("bulk_carrier", capacity=capacity, year=2019)
    assert limits == pytest.approx([8.6, 9.4, 10.6, 11.8])
    given = np.array([8.0, 9.0, 10.0, 11.0, 12.0, np.nan])
    rating = cii.cii_rating(given, ship_type="bulk_carrier", capacity=capacity, year=2019)
    assert rating.tolist() == ["A", "B", "C", "D", "E", "-"]


def test_reductions():
    assert [cii.reduction_factor(y) for y in range(2019, 2031)] == [
        0.0, 1.0, 2.0, 3.0, 5.0, 7.0, 9.0, 11.0, 13.625, 16.25, 18.875, 21.5,
    ]  # fmt: skip
    with pytest.raises(InputError, match="2031"):
        cii.reduction_factor(2031)


def test_capped_and_split_lines():
    line = cii.reference_cii("bulk_carrier", capacity=[279_000.0, 400_000.0, 100_000.0])
    assert line[0] == line[1] == pytest.approx(4745.0 * 279_000.0**-0.622)
    assert line[2] == pytest.approx(4745.0 * 100_000.0**-0.622)
    gas = cii.reference_cii("gas_carrier", capacity=[65_000.0, 64_999.0])
    assert gas == pytest.approx([14405e7 * 65_000.0**-2.071, 8104.0 * 64_999.0**-0.639])
    cargo = cii.reference_cii("general_cargo_ship", capacity=[20_000.0, 19_999.0])
    assert cargo == pytest.approx([31948.0 * 2e4**-0.792, 588.0 * 19_999.0**-0.3885])
    cars = cii.reference_cii("vehicle_carrier", capacity=[70_000.0, 57_700.0, 30_000.0, 29_999.0])
    assert cars[0] == cars[1]
    assert cars[2:] == pytest.approx([3627.0 * 3e4**-0.59, 330.0 * 29_999.0**-0.329])


@pytest.mark.parametrize(
    ("kind", "a", "c"),
    [
        ("tanker", 5247.0, 0.610),
        ("container_ship", 1984.0, 0.489),
        ("refrigerated_cargo_carrier", 4600.0, 0.557),
        ("combination_carrier", 5119.0, 0.622),
        ("ro_ro_cargo_ship", 1967.0, 0.485),
        ("ro_ro_passenger_ship", 2023.0, 0.460),
        ("high_speed_ro_ro_passenger_craft", 4196.0, 0.460),
        ("cruise_passenger_ship", 930.0, 0.383),
    ],
)
def test_plain_lines_as_printed(kind, a, c):
    sizes = np.array([5_000.0, 60_000.0, 250_000.0])
    assert cii.reference_cii(kind, capacity=sizes) == pytest.approx(a / sizes**c, rel=1e-12)


def test_lng_lines_and_their_doubt():
    lng = cii.reference_cii("lng_carrier", capacity=[120_000.0, 80_000.0, 50_000.0, 20_000.0])
    assert lng[0] == pytest.approx(9.827)
    assert lng[1] == pytest.approx(14479e10 * 8e4**-2.673)
    assert lng[2] == lng[3]
    small = cii.SHIP_TYPES["lng_carrier"].bands[-1]
    assert not small.verified
    assert "14479E10" in small.note


def test_the_line_never_rises_with_size_inside_a_band():
    for name, kind in cii.SHIP_TYPES.items():
        edges = [*sorted(band.least for band in kind.bands), 500_000.0]
        for low, high in itertools.pairwise(edges):
            sizes = np.linspace(max(low, 500.0), high * 0.999, 50)
            assert np.all(np.diff(cii.reference_cii(name, capacity=sizes)) <= 1e-12), name


def test_unknown_type_has_near_matches():
    with pytest.raises(InputError, match="bulk_carrier"):
        cii.reference_cii("bulk_carier", capacity=1e5)


def test_no_capacity_is_unknown_not_best():
    assert np.isnan(cii.attained_cii(1.0, capacity=0.0, distance_nm=100.0))
    assert np.isnan(cii.reference_cii("tanker", capacity=[0.0, -5.0, np.nan])).all()
    assert cii.cii_rating(1.0, ship_type="tanker", capacity=0.0, year=2025) == "-"


def test_eeoi_counts_ballast_voyages():
    """MEPC.1/Circ.684 example form: sum over voyages, not mean of ratios."""
    got = cii.eeoi([300e3, 200e3], cargo_t=[20_000.0, 0.0], distance_nm=[1000.0, 900.0])
    assert got == pytest.approx(500e6 / 20e6)
    assert np.isnan(cii.eeoi(100e3, cargo_t=0.0, distance_nm=10.0))


def test_eeoi_of_one_full_voyage_is_the_cii():
    one = cii.eeoi(100e3, cargo_t=5e4, distance_nm=700.0)
    assert one == pytest.approx(cii.attained_cii(100e3, capacity=5e4, distance_nm=700.0))
