"""Fillings by name of what grids leave unknown next to land, and of heights without direction."""

from __future__ import annotations

import numpy as np
import pytest

from tests.sea.small_datasets import HS, T0, mesh, regular, value
from thalweg.core.errors import InputError
from thalweg.core.units import NAUTICAL_MILE
from thalweg.sea import Sea
from thalweg.ship.methods.relative_angles import relative_angle

EAST, NORTH = (f"sea_surface_wave_to_direction_{w}" for w in ("east", "north"))
PERIOD = "sea_surface_wave_period_at_variance_spectral_density_maximum"


def coast() -> Sea:
    """Return waves of 2 m + 0.1 m per degree of latitude, unknown in the south-east."""
    data = regular(
        lat=np.arange(10.0, 14.01, 0.25),
        lon=np.arange(20.0, 24.01, 0.25),
        field=lambda t, y, x: 2.0 + 0.1 * y + 0.0 * (t + x),
    )
    data["swh"] = data["swh"].where((data["lat"] > 11.0) | (data["lon"] < 21.0))
    return Sea.open(data)


def test_the_nearest_known_value_is_used_up_to_its_distance() -> None:
    sea = coast().filled(waves="nearest:20")
    assert np.isnan(value(coast(), HS, T0, 11.1, 22.0))
    # 11.1 N is in a cell with an unknown corner at 11.0 N: the nearest known row is 11.25 N
    assert value(sea, HS, T0, 11.1, 22.0) == pytest.approx(2.0 + 0.1 * 11.25)
    assert np.isnan(value(sea, HS, T0, 10.9, 22.0))  # 21 nm from 11.25 N
    assert value(sea, HS, T0, 12.3, 22.0) == pytest.approx(2.0 + 0.1 * 12.3)  # known: unchanged
    series = sea.series([HS], np.array([T0, T0 + 3600.0]), np.array([11.1]), np.array([22.0]))
    assert series[HS] == pytest.approx(2.0 + 0.1 * 11.25)


def test_positions_outside_the_grid_and_the_period_stay_unknown() -> None:
    sea = coast().filled(waves="nearest:100")
    assert np.isnan(value(sea, HS, T0, 9.9, 20.5))
    assert np.isnan(value(sea, HS, T0 - 60.0, 11.1, 22.0))


def test_the_nearest_position_is_the_nearest_on_the_sphere() -> None:
    """Against all known points, by brute force."""
    sea = coast().filled(waves="nearest:60")
    rng = np.random.default_rng(4)
    lat, lon = rng.uniform(10.1, 11.0, 50), rng.uniform(21.0, 23.9, 50)
    y, x = np.meshgrid(np.arange(10.0, 14.01, 0.25), np.arange(20.0, 24.01, 0.25), indexing="ij")
    keep = (y > 11.0) | (x < 21.0)
    y, x = np.radians(y[keep]), np.radians(x[keep])
    a, b = np.radians(lat)[:, None], np.radians(lon)[:, None]
    cosine = np.sin(a) * np.sin(y) + np.cos(a) * np.cos(y) * np.cos(b - x)
    best = np.argmax(cosine, axis=1)
    far = np.arccos(cosine.max(axis=1)) * 6371008.8 / NAUTICAL_MILE
    expected = np.where(far <= 60.0, 2.0 + 0.1 * np.degrees(y[best]), np.nan)
    sure = np.abs(far - 60.0) > 0.5
    got = value(sea, HS, T0, lat, lon)
    assert got[sure] == pytest.approx(expected[sure], nan_ok=True, abs=1e-6)


def test_meshes_are_filled_from_their_known_nodes() -> None:
    data = mesh()
    data["swh"][:, 0] = np.nan
    sea = Sea.open(data).filled(waves="nearest:60")
    assert np.isnan(value(Sea.open(data), HS, T0, 50.2, 2.2))
    assert np.isfinite(value(sea, HS, T0, 50.2, 2.2))


def test_head_seas_give_waves_of_known_height_a_direction_and_a_period() -> None:
    sea = Sea.open(regular(field=lambda t, y, x: 4.0 + 0.0 * (t + y + x))).filled(waves="head_seas")
    got = sea.sample([HS, EAST, NORTH, PERIOD], T0, 11.0, 21.0)
    assert [float(got[n]) for n in (HS, EAST, NORTH)] == [4.0, 0.0, 0.0]
    assert float(got[PERIOD]) == pytest.approx(10.0)  # Pierson-Moskowitz: 5.0 sqrt(Hs)
    for course in np.radians([0.0, 77.0, 200.0]):
        assert relative_angle(-got[EAST], -got[NORTH], course) == 0.0
    assert any("from ahead" in text for text in sea.assumptions)
    assert np.isnan(value(sea, PERIOD, T0, 50.0, 21.0))


def test_known_directions_stay() -> None:
    data = regular(fields={"swh": {"units": "m"}, "mwd": {"units": "degree"}})
    data["mwd"] = data["mwd"] * 0.0 + 270.0
    data["mwd"].attrs = {"units": "degree"}
    got = Sea.open(data).filled(waves="head_seas").sample([EAST, NORTH], T0, 11.0, 21.0)
    assert float(got[EAST]) == pytest.approx(1.0)


def test_each_filling_is_recorded() -> None:
    sea = coast().filled(waves="nearest:25").filled(waves="head_seas", wind=0.0)
    text = " ".join(sea.assumptions)
    assert "nearest known position within 25 nm" in text
    assert "from ahead" in text
    assert sea.fingerprint() != coast().filled(waves="nearest:30").fingerprint()


@pytest.mark.parametrize(
    ("policies", "match"),
    [
        ({"waves": "nearest"}, "nearest:NM"),
        ({"waves": "nearest:0"}, "nearest:NM"),
        ({"waves": "nearest:1000"}, "100 nm"),
        ({"waves": "nearest:x"}, "nearest:NM"),
        ({"waves": "head"}, "head_seas"),
        ({"wind": "nearest:25"}, "no file holds"),
        ({"swell": "nearest:25"}, "no filling policy"),
    ],
)
def test_impossible_fillings_are_refused(policies, match) -> None:
    with pytest.raises(InputError, match=match):
        coast().filled(**policies)


def test_head_seas_without_a_height_are_refused() -> None:
    with pytest.raises(InputError, match="no wave height"):
        Sea.from_functions({"sea_surface_height_above_geoid": lambda t, y, x: 0.0}).filled(
            waves="head_seas"
        )
