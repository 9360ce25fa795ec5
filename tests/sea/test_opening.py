"""Tidal constituents as a sea, and clear refusals for series of one station."""

from __future__ import annotations

import numpy as np
import pytest

from tests.sea import hydrodynamic_runs as hydro
from tests.sea.small_datasets import EAST, NORTH, regular
from thalweg.core.errors import DatasetError, InputError
from thalweg.core.time import format_time, parse_time
from thalweg.sea import Sea
from thalweg.sea.tides.constituent_files import write_constituents
from thalweg.sea.tides.constituents import Constituents
from thalweg.sea.tides.station_area import BETWEEN_TURNS

LEVEL = "sea_surface_height_above_geopotential_datum"


def constants(nodes: int) -> Constituents:
    lat = np.array([50.0, 50.0, 51.0, 51.0])[:nodes]
    lon = np.array([2.0, 3.0, 2.0, 3.0])[:nodes]
    amplitude = np.full((1, nodes), 1.5)
    phase = np.full((1, nodes), 40.0)
    return Constituents(
        ("M2",), {LEVEL: amplitude}, {LEVEL: phase}, {LEVEL: np.zeros(nodes)}, lat, lon
    )


def test_the_analysis_of_a_model_run_is_a_sea(tmp_path) -> None:
    path = tmp_path / "run.json"
    write_constituents(constants(4), path)
    sea = Sea.open(path)
    got = sea.sample([LEVEL], hydro.T0 + 3600.0 * np.arange(24.0), 50.4, 2.3)[LEVEL]
    assert np.ptp(got) == pytest.approx(3.0, rel=0.15)
    expected = Sea.from_tides(constants(4)).sample([LEVEL], hydro.T0, 50.4, 2.3)[LEVEL]
    assert float(sea.sample([LEVEL], hydro.T0, 50.4, 2.3)[LEVEL]) == pytest.approx(float(expected))


@pytest.mark.parametrize("first", [True, False])
def test_tides_and_files_keep_their_order_of_priority(tmp_path, first) -> None:
    write_constituents(constants(4), tmp_path / "run.json")
    data = regular(
        lat=(50.0, 51.0),
        lon=(2.0, 3.0),
        fields={"zos": {"units": "m"}},
        field=lambda t, y, x: 9.0 + 0.0 * (t + y + x),
    )
    data.to_netcdf(tmp_path / "level.nc")
    names = ["run.json", "level.nc"] if first else ["level.nc", "run.json"]
    sea = Sea.open(*(tmp_path / n for n in names))
    start = sea.period_of([LEVEL])
    time = float(data["time"].values[0])
    assert start == (-np.inf, np.inf)
    got = float(sea.sample([LEVEL], time, 50.5, 2.5)[LEVEL])
    assert (got == 9.0) is not first


def test_the_tide_of_one_station_is_refused_with_what_to_do(tmp_path) -> None:
    write_constituents(constants(1), tmp_path / "gauge.json")
    with pytest.raises(InputError, match=r"one station.*@SOUTH,NORTH,WEST,EAST"):
        Sea.open(tmp_path / "gauge.json")


@pytest.mark.parametrize("header", ["time,water_level", "time,current_east,current_north"])
def test_a_series_of_one_station_is_refused_with_what_to_do(tmp_path, header) -> None:
    rows = [header]
    for hour in range(48):
        values = ",".join(["0.5"] * header.count(","))
        rows.append(f"{format_time(hydro.T0 + 3600.0 * hour)},{values}")
    (tmp_path / "gauge.csv").write_text("\n".join(rows))
    with pytest.raises(InputError, match=r"series of one station.*gauge.csv@SOUTH.*tides analyse"):
        Sea.open(tmp_path / "gauge.csv")


def station_file(path, times, levels, name="water_level"):
    rows = [f"{format_time(t)},{level}" for t, level in zip(times, levels)]
    path.write_text("\n".join([f"time,{name}", *rows]))
    return f"{path}@51.0,52.0,3.0,4.5"


def test_a_record_of_one_station_holds_in_its_area(tmp_path) -> None:
    times = hydro.T0 + 3600.0 * np.arange(48.0)
    sea = Sea.open(station_file(tmp_path / "gauge.csv", times, 0.1 * np.arange(48.0)))
    got = sea.sample([LEVEL], hydro.T0 + 5400.0, [51.0, 51.6, 52.5], [3.0, 4.4, 4.0])[LEVEL]
    assert got[:2] == pytest.approx(0.15)
    assert np.isnan(got[2])
    assert sea.assumptions == ()


def test_a_table_may_have_semicolons_and_decimal_commas(tmp_path) -> None:
    path = tmp_path / "getij.csv"
    path.write_text(
        "time;water_level\n2024-05-01T00:00;-1,25\n2024-05-01T06:00;1,5\n2024-05-01T12:30;-1,0\n"
    )
    sea = Sea.open(f"{path}@51,52,3,4")
    got = sea.sample(
        [LEVEL], [parse_time(text) for text in ("2024-05-01T00:00", "2024-05-01T06:00")], 51.5, 3.5
    )[LEVEL]
    np.testing.assert_allclose(np.ravel(got), [-1.25, 1.5], atol=1e-6)


def test_a_grid_has_no_area_of_one_station(tmp_path) -> None:
    data = regular(lat=(50.0, 51.0), lon=(2.0, 3.0), fields={"zos": {"units": "m"}})
    data.to_netcdf(tmp_path / "level.nc")
    with pytest.raises(InputError, match="without its area"):
        Sea.open(f"{tmp_path / 'level.nc'}@50,51,2,3")


def test_between_high_and_low_water_the_level_follows_half_a_cosine(tmp_path) -> None:
    hours = np.array([0.0, 6.2, 12.4, 18.7])
    source = station_file(tmp_path / "table.csv", hydro.T0 + 3600.0 * hours, [4.0, 1.0, 4.2, 0.8])
    sea = Sea.open(source)
    asked = np.array([0.0, 3.1, 6.2, 9.3, 12.4, 12.4 + 6.3 / 3.0])
    got = sea.sample([LEVEL], hydro.T0 + 3600.0 * asked, 51.5, 3.5)[LEVEL]
    assert got == pytest.approx([4.0, 2.5, 1.0, 2.6, 4.2, 4.2 - 0.25 * 3.4], abs=2e-3)
    assert sea.assumptions == (BETWEEN_TURNS,)


@pytest.mark.parametrize(
    ("hours", "levels", "between"),
    [
        ((0.0, 6.0, 12.0, 24.0, 30.0), (4.0, 0.5, 4.0, 4.0, 0.5), "12:00:00Z and .*T00:00:00Z"),
        ((0.0, 6.0, 12.0, 24.4, 30.0), (4.0, 0.5, 4.0, 3.9, 0.5), "12:00:00Z and .*T06:00:00Z"),
        ((0.0, 6.0, 24.0), (4.0, 0.5, 4.0), "06:00:00Z and .*T00:00:00Z"),
        ((0.0, 6.0, 12.0, 18.0), (4.0, 0.5, "", 0.5), "06:00:00Z and .*12:00:00Z"),
    ],
)
def test_a_table_that_lacks_a_water_is_refused(tmp_path, hours, levels, between) -> None:
    """As a record it had 4 m between two high waters: a ship crossed a bar at low water."""
    times = hydro.T0 + 3600.0 * np.array(hours)
    with pytest.raises(InputError, match=f"lacks a high or low water.*{between}"):
        Sea.open(station_file(tmp_path / "table.csv", times, levels))


def test_two_rows_and_a_double_low_water_are_tables(tmp_path) -> None:
    two = station_file(tmp_path / "two.csv", hydro.T0 + 3600.0 * np.array([0.0, 6.0]), [4.0, 0.5])
    got = Sea.open(two).sample([LEVEL], hydro.T0 + 4.5 * 3600.0, 51.5, 3.5)[LEVEL]
    assert float(got) == pytest.approx(1.013, abs=2e-3)
    hours = np.array([0.0, 5.0, 6.5, 8.0, 12.333, 18.0])  # the agger of Hoek van Holland
    agger = station_file(
        tmp_path / "agger.csv", hydro.T0 + 3600.0 * hours, [2.0, 0.2, 0.3, 0.1, 2.1, 0.2]
    )
    got = Sea.open(agger).sample([LEVEL], hydro.T0 + 3600.0 * np.array([2.5, 5.75]), 51.5, 3.5)
    assert got[LEVEL] == pytest.approx([1.1, 0.25], abs=2e-3)


def test_constituents_of_one_station_hold_in_their_area(tmp_path) -> None:
    write_constituents(constants(1), tmp_path / "gauge.json")
    sea = Sea.open(f"{tmp_path / 'gauge.json'}@51,52,3,4.5")
    times = hydro.T0 + 3600.0 * np.arange(30.0)
    got = sea.sample([LEVEL], times, 51.5, 3.5)[LEVEL]
    expected = Sea.from_tides(constants(1), area=(51.0, 52.0, 3.0, 4.5))
    assert got == pytest.approx(expected.sample([LEVEL], times, 51.2, 4.0)[LEVEL])


def test_areas_that_are_none_and_files_that_are_missing_are_refused(tmp_path) -> None:
    source = station_file(tmp_path / "gauge.csv", hydro.T0 + 600.0 * np.arange(9.0), np.ones(9))
    with pytest.raises(InputError, match="not a valid box"):
        Sea.open(source.replace("51.0,52.0", "52.0,51.0"))
    for area in ("51,52,3", "51,52,3,x", "51, 52, 3, 4", "51,52,4,3", "51,52,-170,170"):
        with pytest.raises(InputError, match=r"four numbers of degrees"):
            Sea.open(f"{tmp_path / 'gauge.csv'}@{area}")
    with pytest.raises(DatasetError, match=r"other.csv cannot be read"):
        Sea.open(source.replace("gauge", "other"))
    back = hydro.T0 + 600.0 * np.array([0.0, 2.0, 1.0])
    with pytest.raises(InputError, match=r"has \d{4}-\d\d-\d\d.* after \d{4}"):
        Sea.open(station_file(tmp_path / "back.csv", back, [1.0, 2.0, 3.0]))


def test_other_text_is_still_no_data(tmp_path) -> None:
    (tmp_path / "zones.json").write_text('{"type": "FeatureCollection", "features": []}')
    with pytest.raises(DatasetError, match="not in a known format"):
        Sea.open(tmp_path / "zones.json")


def test_a_mapping_needs_the_files_together(tmp_path) -> None:
    write_constituents(constants(4), tmp_path / "run.json")
    regular(fields={"a": {"units": "m"}}).to_netcdf(tmp_path / "a.nc")
    regular(fields={"b": {"units": "m/s"}, "c": {"units": "m/s"}}).to_netcdf(tmp_path / "b.nc")
    mapping = {"sea_surface_wave_significant_height": "a", EAST: "b", NORTH: "c"}
    paths = [tmp_path / n for n in ("a.nc", "run.json", "b.nc")]
    with pytest.raises(InputError, match="first or last"):
        Sea.open(*paths, mapping=mapping)
    assert EAST in Sea.open(*paths[::2], paths[1], mapping=mapping).variables
