"""Wind coefficients of Fujiwara (2006), Blendermann (1994) and the ITTC data set."""

from dataclasses import replace

import numpy as np
import pytest

from thalweg.ship.methods.added_resistance.wind_resistance import (
    BLENDERMANN,
    ITTC_CURVES,
    FujiwaraShip,
    blendermann_1994,
    fujiwara_2006,
    ittc_curve,
    wind_resistance,
    yu_2021_area,
    yu_2021_coefficient,
)
from thalweg.ship.methods.relative_angles import relative_wind, relative_wind_from_vectors

SHIP = FujiwaraShip(
    length_overall=178.0,
    breadth=32.0,
    frontal_area=800.0,
    lateral_area=2000.0,
    deck_area=500.0,
    superstructure_height=28.0,
    area_centre_forward=0.0,
    area_centre_height=8.0,
)


def test_fujiwara_against_an_independent_calculation():
    got = fujiwara_2006(np.radians([0, 30, 60, 90, 120, 150, 180]), SHIP)
    expected = [0.744, 0.760, 0.497, 0.093, -0.165, -0.726, -0.745]
    np.testing.assert_allclose(got, expected, atol=5.1e-4)


def test_fujiwara_depends_on_the_position_of_the_side_area():
    """C_MC lowers the head wind's coefficient by 1.162 C_MC / L_OA, and the stern's not at all."""
    forward = replace(SHIP, area_centre_forward=0.1 * SHIP.length_overall)
    angles = np.radians([0.0, 180.0])
    change = fujiwara_2006(angles, forward) - fujiwara_2006(angles, SHIP)
    np.testing.assert_allclose(change, [-0.1162, 0.0], atol=1e-12)


def test_fujiwara_at_beam_is_the_mean_of_both_sides():
    sides = fujiwara_2006(np.radians([80.0, 100.0]), SHIP)
    assert fujiwara_2006(np.pi / 2, SHIP) == pytest.approx(sides.mean(), rel=1e-12)


def test_blendermann_tanker_against_an_independent_calculation():
    angles = np.arange(0.0, 181.0, 15.0)
    forward = [
        *(-0.9, -0.89097111, -0.84067181, -0.7048691, -0.4853621, -0.23873499, 0.0),
        *(0.14740434, 0.30652866, 0.45072204, 0.53092322, 0.55012048, 0.55),
    ]
    got = blendermann_1994(
        np.radians(angles),
        frontal_area=800.0,
        lateral_area=2000.0,
        ship_type=BLENDERMANN["tanker_loaded"],
    )
    np.testing.assert_allclose(got, -np.array(forward), atol=1e-8)


@pytest.mark.parametrize(
    ("kind", "transverse", "bow", "stern", "cross_force"),
    [
        ("car_carrier", 0.95, 0.55, 0.60, 0.80),
        ("cargo_loaded", 0.85, 0.65, 0.55, 0.40),
        ("container_loaded", 0.90, 0.55, 0.55, 0.40),
        ("ferry", 0.90, 0.45, 0.50, 0.80),
        ("lng_tanker", 0.70, 0.60, 0.65, 0.50),
        ("offshore_supply", 0.90, 0.55, 0.80, 0.55),
        ("cruise", 0.90, 0.40, 0.40, 0.80),
        ("research", 0.85, 0.55, 0.65, 0.60),
        ("tanker_loaded", 0.70, 0.90, 0.55, 0.40),
        ("tanker_ballast", 0.70, 0.75, 0.55, 0.40),
    ],
)
def test_blendermann_types_as_printed(kind, transverse, bow, stern, cross_force):
    """From ahead and astern the longitudinal drag; at 45 degrees delta and CD_t act in full."""
    got = blendermann_1994(
        np.radians([0.0, 45.0, 180.0]),
        frontal_area=800.0,
        lateral_area=2000.0,
        ship_type=BLENDERMANN[kind],
    )
    oblique = bow * np.sqrt(0.5) / (1.0 - 0.5 * cross_force * (1.0 - 0.4 * bow / transverse))
    np.testing.assert_allclose(got, [bow, oblique, -stern], rtol=1e-12)


def test_ittc_tanker_curve_against_a_polynomial_fitted_by_others():
    coefficients = [
        *(1.17123499947647e-12, -5.2511115870235e-10, 7.82952986643856e-08),
        *(-3.56045199257532e-06, -1.00927975153741e-04, -2.71257158080664e-03, 0.969153537514452),
    ]
    degrees = np.arange(0.0, 181.0, 10.0)
    got = ittc_curve(np.radians(degrees))
    np.testing.assert_allclose(got, ITTC_CURVES["tanker_laden"][1], rtol=1e-12)
    np.testing.assert_allclose(got, np.polyval(coefficients, degrees), atol=0.04)


@pytest.mark.parametrize(
    ("curve", "degrees", "digitised"),
    [
        (
            "general_cargo",
            [0, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 110, 120, 140, 150, 160, 170, 180],
            [
                *(0.60115, 0.874312, 0.997667, 1.00194, 0.875619, 0.84532, 0.657525, 0.435164),
                *(0.285782, 0.113352, -0.0667608, -0.461987, -0.822631, -1.34419, -1.44363),
                *(-1.2934, -0.885803, -0.770147),
            ],
        ),
        (
            "container_laden_no_boxes",
            [0, 15, 30, 45, 60, 75, 90, 105, 120, 135, 150, 165, 180],
            [
                *(1.03173, 1.1342, 1.13008, 0.966054, 0.744929, 0.466693, 0.135159),
                *(-0.257283, -0.74872, -1.07264, -1.15671, -1.16464, -0.925114),
            ],
        ),
    ],
)
def test_iso_curves_against_a_second_reading_of_the_charts(curve, degrees, digitised):
    np.testing.assert_allclose(ittc_curve(np.radians(degrees), curve=curve), digitised, atol=0.05)


@pytest.mark.parametrize(
    ("curve", "values"),
    [
        ("tanker_ballast", [0.87, 0.46, 0.16, 0.03, -0.23, -0.47, -0.52]),
        ("container_laden", [0.68, 0.67, 0.26, 0.27, -0.35, -0.88, -0.65]),
    ],
)
def test_iso_curves_of_one_reading(curve, values):
    """Every 30 degrees, as read off the printed charts once; no second reading was found."""
    degrees = np.arange(0.0, 181.0, 30.0)
    np.testing.assert_allclose(ittc_curve(np.radians(degrees), curve=curve), values, atol=1e-12)


def test_relative_wind_of_head_and_following_winds():
    """Ship at 6 m/s, wind of 10 m/s: 256 and 16 m2/s2 (Yu's program has them exchanged)."""
    speed, angle = relative_wind(10.0, [0.0, np.pi, np.pi / 2], ship_speed=6.0)
    np.testing.assert_allclose(speed**2, [256.0, 16.0, 136.0], rtol=1e-12)
    np.testing.assert_allclose(angle, [0.0, np.pi, np.arctan2(10.0, 6.0)], atol=1e-12)


def test_relative_wind_from_vectors_agrees():
    heading, wind_from = np.radians(230.0), np.radians(300.0)
    polar = relative_wind(12.0, wind_from - heading, ship_speed=7.0)
    vectors = relative_wind_from_vectors(
        -12.0 * np.sin(wind_from),
        -12.0 * np.cos(wind_from),
        frame_east=7.0 * np.sin(heading),
        frame_north=7.0 * np.cos(heading),
        heading=heading,
    )
    np.testing.assert_allclose(polar, vectors, rtol=1e-12)


def test_wind_resistance():
    force = wind_resistance(16.0, 0.8, frontal_area=500.0, density=1.25)
    assert force == pytest.approx(0.5 * 1.25 * 500.0 * 256.0 * 0.8)


def test_yu_rule():
    assert yu_2021_area(32.0, draught_aft=10.0) == 256.0
    np.testing.assert_allclose(yu_2021_coefficient([0.0, np.pi]), [0.7, -0.7])
