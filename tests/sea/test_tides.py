"""Tides: analysis, prediction for any date, seas of constituents, and what is refused."""

import gzip
import json
import os

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.conftest import data_file
from thalweg.core.errors import DatasetError, InputError, ThalwegWarning
from thalweg.core.time import parse_time
from thalweg.kernels import codes
from thalweg.sea import Sea
from thalweg.sea import standard_names as nm
from thalweg.sea.periodic_repeat import drift_deg, repeat_in_time
from thalweg.sea.tides import (
    constituent_files,
    foreman,
    harmonic_analysis,
    model_run_analysis,
    schureman,
)
from thalweg.sea.tides.constituents import Constituents, unit_phasors
from thalweg.sea.tides.harmonic_analysis import analyse, check_rayleigh

utide = pytest.importorskip("utide")

START = parse_time("2024-03-01T00:00Z")
LEVEL = nm.WATER_LEVEL
EAST, NORTH = nm.CURRENT.pair
TABLE = {"M2": (1.7, 30.0), "S2": (0.48, 88.0), "O1": (0.1, 178.0), "M4": (0.13, 60.0)}


def _hours(days, step=1.0, start=START):
    return start + 3600.0 * np.arange(0.0, days * 24.0, step)


def _gauge(**more):
    return Constituents.single(LEVEL, TABLE, mean=0.2, lat=51.4, lon=3.6, **more)


def _utide_times(times):
    return np.datetime64(0, "s") + np.round(times).astype("timedelta64[s]")


# --- arguments and nodal corrections


def test_arguments_and_nodal_corrections_are_those_of_utide():
    from utide.harmonics import FUV

    names = tuple(n for n in foreman.constituent_table().index if n != "Z0")
    times = np.linspace(parse_time("1995-01-01"), parse_time("2035-01-01"), 700)
    f, u, v = FUV(times / 86400.0 + 719163.0, 0.0, np.arange(1, len(names) + 1), 21.3, [0] * 4)
    theirs = f * np.exp(2j * np.pi * (u + v))
    assert np.abs(unit_phasors(names, times, 21.3, "foreman") - theirs).max() < 2e-6


@pytest.mark.parametrize("latitude", [0.0, -3.0, 89.0])
def test_nodal_corrections_exist_at_any_latitude(latitude):
    assert np.isfinite(
        foreman.nodal_corrections(("M2", "K1", "NO1", "L2"), _hours(1), latitude)
    ).all()


@pytest.mark.parametrize(
    ("name", "tolerance"),
    [("M2", 0.01), ("N2", 0.02), ("S2", 0.01), ("K2", 0.02), ("K1", 0.02), ("O1", 0.02),
     ("Q1", 0.05), ("M4", 0.02), ("MS4", 0.02), ("2MS6", 0.03), ("MSN6", 0.03), ("M8", 0.04)],
)  # fmt: skip
def test_schureman_and_foreman_agree(name, tolerance):
    """Two tables of different origin, over two nodal cycles."""
    times = np.linspace(parse_time("1990-01-01"), parse_time("2030-01-01"), 900)
    ours = unit_phasors((name,), times, 51.0, "schureman")
    assert np.abs(ours - unit_phasors((name,), times, 51.0, "foreman")).max() < tolerance


@pytest.mark.parametrize(
    ("name", "parts"),
    [
        ("3MNS6", {"M2": 3, "N2": 1, "S2": -1}),
        ("2(MS)N10", {"M2": 2, "S2": 2, "N2": 1}),
        ("4MS4", {"M2": 4, "S2": -2}),
        ("2ML2S2", {"M2": 2, "L2": 1, "S2": -2}),
        ("MPS2", {"M2": 1, "P1": 1, "S1": -1}),
        ("MSP2", {"M2": 1, "S1": 1, "P1": -1}),
        ("2SN(MK)2", {"S2": 2, "N2": 1, "M2": -1, "K2": -1}),
        ("3(SM)N2", {"S2": 3, "M2": -3, "N2": 1}),
        ("2MK3", {"M2": 2, "K1": -1}),
        ("2MK5", {"M2": 2, "K1": 1}),
        ("MKNU6", {"M2": 1, "K2": 1, "NU2": 1}),
        ("M12", {"M2": 6}),
        ("lambda2", {"LAMBDA2": 1}),
    ],
)
def test_compound_names_are_read(name, parts):
    assert dict(schureman.constituent_definition(name).parts) == parts


@pytest.mark.parametrize("name", ["ST3", "XY2", "M", "", "O2", "M2 and S2", "3L2"])
def test_unknown_names_are_refused(name):
    with pytest.raises(InputError):
        schureman.constituent_definition(name)


# --- analysis


@pytest.mark.slow
def test_honolulu_round_trip_with_utide():
    raw = np.loadtxt(data_file("tide/utide_HNL2010_hourly.asc"))
    times = parse_time("2010-01-01") + np.round((raw[:, 0] - raw[0, 0]) * 86400.0)
    level = raw[:, 1] / 1000.0
    when = _utide_times(times)
    solved = utide.solve(
        when, level, lat=21.3, method="ols", conf_int="none", trend=False, verbose=False
    )
    theirs = utide.reconstruct(when, solved, verbose=False).h
    found = analyse(times, {LEVEL: level}, lat=21.3)
    ours = found.constituents.predict(LEVEL, times)[0]
    assert set(found.constituents.names) == {str(n) for n in solved.name}
    assert np.abs(ours - theirs).max() < 1e-6  # aim: 1 mm
    assert found.share() == pytest.approx(1.0 - np.var(level - theirs) / np.var(level), abs=1e-9)
    assert 0.85 < found.share() < 0.90


def test_analysis_is_that_of_utide_with_gaps_and_noise():
    rng = np.random.default_rng(1)
    times = _hours(45)
    level = _gauge().predict(LEVEL, times)[0] + 0.1 * rng.normal(size=times.size)
    level[rng.random(times.size) < 0.2] = np.nan
    level[300:360] = np.nan
    solved = utide.solve(
        _utide_times(times), level, lat=51.4, method="ols", conf_int="none", trend=False,
        verbose=False,
    )  # fmt: skip
    found = analyse(times, {LEVEL: level}, lat=51.4, constituents=[str(n) for n in solved.name])
    for row in found.constituents.table(LEVEL):
        k = list(solved.name).index(row["name"])
        assert row["amplitude"] == pytest.approx(solved.A[k], abs=1e-8)
        assert np.exp(1j * np.radians(row["phase_deg"] - solved.g[k])) == pytest.approx(1, abs=1e-5)


def test_tidal_currents_of_a_line_in_vanuatu_as_utide_solves_them_in_two_dimensions():
    with xr.open_dataset(data_file("tide/dhi_vanuatu_tidal_current_line_hourly_202108.nc")) as data:
        times = data.time.values.astype("datetime64[ns]").astype(np.int64) / 1e9
        east, north = data.ucur.values.T, data.vcur.values.T
    found = analyse(times, {EAST: east, NORTH: north}, lat=np.full(11, -17.7))
    assert found.share() > 0.999  # a tide it is: another program predicted it
    when = _utide_times(times)
    solved = utide.solve(
        when, east[3], north[3], lat=-17.7, method="ols", conf_int="none", trend=False,
        verbose=False,
    )  # fmt: skip
    theirs = utide.reconstruct(when, solved, verbose=False)
    assert np.abs(found.constituents.predict(EAST, times)[3] - theirs.u).max() < 1e-6
    assert np.abs(found.constituents.predict(NORTH, times)[3] - theirs.v).max() < 1e-6


@settings(max_examples=25)
@given(
    st.dictionaries(
        st.sampled_from(["M2", "S2", "K1", "O1", "M4", "MS4", "M6"]),
        st.tuples(st.floats(0.01, 3.0), st.floats(0.0, 359.0)),
        min_size=1,
    ),
    st.floats(-75.0, 75.0),
    st.floats(-2.0, 2.0),
    st.integers(0, 12000),
)
def test_constants_are_recovered_from_a_record(table, latitude, mean, day):
    truth = Constituents.single(LEVEL, table, mean=mean, lat=latitude, convention="foreman")
    times = _hours(18, start=START + 86400.0 * (day - 6000))
    record = truth.predict(LEVEL, times)[0]
    found = analyse(times, {LEVEL: record}, lat=latitude, constituents=list(table)).constituents
    assert found.mean[LEVEL][0] == pytest.approx(mean, abs=1e-8)
    error = found.coefficients(LEVEL) - truth.coefficients(LEVEL)
    assert np.abs(error).max() < 1e-7
    other = times + 1e8
    assert np.allclose(found.predict(LEVEL, other), truth.predict(LEVEL, other), atol=1e-6)


def test_constants_are_recovered_and_valid_eleven_years_later():
    truth = Constituents.single(LEVEL, TABLE, mean=0.2, lat=51.4, convention="foreman")
    times = _hours(35, 0.25)
    record = truth.predict(LEVEL, times)[0]
    found = analyse(times, {LEVEL: record}, lat=51.4).constituents
    rows = {r["name"]: r for r in found.table(LEVEL)}
    for name, (size, phase) in TABLE.items():
        assert rows[name]["amplitude"] == pytest.approx(size, abs=1e-8)
        assert rows[name]["phase_deg"] == pytest.approx(phase, abs=1e-5)
    later = _hours(3, start=START + 11 * 365.25 * 86400)
    assert np.allclose(found.predict(LEVEL, later), truth.predict(LEVEL, later), atol=1e-7)
    assert found.mean[LEVEL] == pytest.approx([0.2])


def test_nodes_with_different_gaps_are_solved_separately():
    times = _hours(40)
    truth = Constituents.single(LEVEL, TABLE, lat=51.4, convention="foreman")
    record = np.repeat(truth.predict(LEVEL, times), 5, axis=0)
    record[1, ::3] = np.nan
    record[2, 100:200] = np.nan
    record[3, : int(0.6 * times.size)] = np.nan
    record[4] = np.nan
    found = analyse(times, {LEVEL: record}, lat=np.full(5, 51.4), constituents=list(TABLE))
    sizes = found.constituents.amplitude[LEVEL]
    assert np.allclose(sizes[:, :3], [[a] for a, _ in TABLE.values()], rtol=1e-6)
    assert np.isnan(sizes[:, 3:]).all()  # known for less than half the record


def test_a_node_with_values_at_half_days_only_has_no_tide():
    """S2 is constant there: a solution would give amplitudes of kilometres."""
    coarse = START + 43200.0 * np.arange(119)
    times = np.concatenate([coarse, coarse[-1] + 3600.0 * np.arange(1, 121)])
    truth = Constituents.single(
        LEVEL, {"M2": (1.75, 30.5), "S2": (0.48, 87.7)}, lat=51.4, convention="foreman"
    )
    record = np.repeat(truth.predict(LEVEL, times), 2, axis=0)
    record += 0.05 * np.random.default_rng(0).normal(size=record.shape)
    record[1, (times - coarse[0]) % 43200.0 != 0.0] = np.nan
    assert np.isfinite(record[1]).mean() > 0.5
    found = analyse(times, {LEVEL: record}, lat=np.full(2, 51.4), constituents=["M2", "S2"])
    sizes = found.constituents.amplitude[LEVEL]
    assert sizes[:, 0] == pytest.approx([1.75, 0.48], abs=0.02)
    assert np.isnan(sizes[:, 1]).all()


def test_tidal_fraction_of_variance():
    times = _hours(60)
    tide = _gauge().predict(LEVEL, times)[0]
    rng = np.random.default_rng(3)
    found = analyse(
        times, {LEVEL: tide + rng.normal(size=times.size) * tide.std()}, lat=51.4,
        constituents=list(TABLE),
    )  # fmt: skip
    assert found.share(LEVEL) == pytest.approx(0.5, abs=0.03)


@pytest.mark.parametrize(
    ("count", "wanted", "words"),
    [(1, None, "1 time"), (2, None, "2 time"), (48, ["Z0", "M2"], "the mean"), (48, [], "named")],
)
def test_records_with_unresolved_constituents_are_refused(count, wanted, words):
    with pytest.raises(InputError, match=words):
        harmonic_analysis.select_constituents(3600.0 * np.arange(count), wanted)


def test_progress_is_reported_to_the_end():
    reports = []
    record = np.repeat(_gauge().predict(LEVEL, _hours(20)), 3, axis=0)
    analyse(
        _hours(20), {EAST: record, NORTH: record}, lat=50.0, constituents=["M2"],
        progress=lambda done, total: reports.append((done, total)),
    )  # fmt: skip
    assert reports[-1] == (6, 6)
    assert reports == sorted(reports)


# --- what an analysis refuses


def test_record_too_short_names_pairs_and_length():
    times = _hours(10)
    record = _gauge().predict(LEVEL, times)
    with pytest.raises(InputError) as error:
        analyse(times, {LEVEL: record}, lat=51.0, constituents=["M2", "S2", "N2", "K1"])
    assert error.value.details["pairs"] == [["N2", "M2"], ["M2", "S2"]]
    assert error.value.details["needed_h"] == pytest.approx(661.3, abs=0.1)
    assert "M2 and S2 need 14.8 days" in str(error.value)
    assert "27.6 days long" in str(error.value)


def test_rayleigh_of_m2_and_s2():
    """35 days part M2 and S2 by 2.3704 cycles (van Halem, 2019, has 2.3 for 33 d 23:50)."""
    check_rayleigh(["M2", "S2"], 840.0, 2.37)
    with pytest.raises(InputError):
        check_rayleigh(["M2", "S2"], 840.0, 2.371)
    with pytest.raises(InputError, match="the mean and MM"):
        check_rayleigh(["MM"], 600.0)


def test_without_names_only_separable_constituents_are_analysed():
    names = harmonic_analysis.select_constituents(_hours(16), None)
    assert {"M2", "S2", "K1", "O1"} <= set(names)
    assert not {"N2", "K2", "P1", "SSA"} & set(names)
    check_rayleigh(names, 16 * 24.0)


@pytest.mark.parametrize(
    ("times", "wanted", "word"),
    [
        (_hours(40, 3.0), ["M2", "M8"], "coarse"),
        (_hours(400, 12.0), ["SSA", "S2"], "coarse"),
        (_hours(40)[::-1], ["M2"], "increase"),
        (_hours(0.3, 0.1), None, "too short to separate"),
        (_hours(40), ["M2", "M22"], "M22"),
    ],
)
def test_records_that_cannot_be_analysed(times, wanted, word):
    with pytest.raises(InputError, match=word):
        analyse(times, {LEVEL: np.cos(times / 7000.0)}, lat=50.0, constituents=wanted)


def test_a_record_without_numbers_or_of_another_length_is_refused():
    with pytest.raises(InputError, match="holds no number"):
        analyse(_hours(20), {LEVEL: np.full(480, np.nan)}, lat=50.0)
    with pytest.raises(InputError, match="shape"):
        analyse(_hours(20), {LEVEL: np.zeros(479)}, lat=50.0)


# --- seas


def _field(lat, lon, times):
    """Return u, v and level (T, ...): constants that are linear in latitude and longitude."""
    wave = unit_phasors(("M2", "S2"), times, 52.0, "foreman")
    m2, s2 = wave[:, 0].real, wave[:, 1].real
    shape = (-1,) + (1,) * lat.ndim
    a, b = 1.0 + 0.1 * (lat - 52.0), 0.3 + 0.05 * (lon - 3.0)
    m2, s2 = m2.reshape(shape), s2.reshape(shape)
    return a * m2 + b * s2, 0.5 * b * m2, 0.1 + 1.5 * a * m2 + 0.4 * s2


@pytest.fixture
def run(tmp_path, monkeypatch):
    """A model run of 20 days on a grid that holds, at one corner, dry land."""
    monkeypatch.setenv("THALWEG_CACHE", str(tmp_path / "cache"))
    lat, lon = np.linspace(51.5, 52.5, 3), np.linspace(2.5, 3.5, 4)
    times = _hours(20)
    u, v, h = _field(*np.meshgrid(lat, lon, indexing="ij"), times)
    u[:, 0, 0] = v[:, 0, 0] = h[:, 0, 0] = np.nan
    dims = ("time", "lat", "lon")
    attributes = {
        "u": (u, EAST, "m s-1"), "v": (v, NORTH, "m s-1"), "h": (h, "sea_surface_height", "m"),
    }  # fmt: skip
    data = {
        n: (dims, x, {"standard_name": s, "units": unit}) for n, (x, s, unit) in attributes.items()
    }
    bed = {"standard_name": "sea_floor_depth_below_geoid", "units": "m"}
    data["bed"] = (("lat", "lon"), np.full((3, 4), 18.0), bed)
    coords = {
        "time": _utide_times(times).astype("datetime64[ns]"),
        "lat": ("lat", lat, {"standard_name": "latitude", "units": "degrees_north"}),
        "lon": ("lon", lon, {"standard_name": "longitude", "units": "degrees_east"}),
    }
    path = tmp_path / "run.nc"
    xr.Dataset(data, coords).to_netcdf(path)
    return path


def test_a_model_run_gives_a_sea_of_any_date(run):
    sea = Sea.from_tides(Sea.open(run), constituents=["M2", "S2"])
    times = _hours(2, start=parse_time("2031-07-05"))
    lat, lon = np.array([52.1, 51.9]), np.array([3.1, 3.33])
    found = sea.series([EAST, NORTH, LEVEL], times, lat, lon)
    for name, expected in zip((EAST, NORTH, LEVEL), _field(lat, lon, times)):
        assert np.allclose(found[name], expected.T, atol=2e-3)
    points = sea.sample([EAST, NORTH, LEVEL], times[None, :], lat[:, None], lon[:, None])
    assert all(np.allclose(points[n], found[n], atol=1e-12) for n in points)
    assert sea.sample(["sea_floor_depth_below_geoid"], 0.0, 52.0, 3.0)[nm.BED_DEPTH] == 18.0
    assert sea.period_of([EAST]) == (-np.inf, np.inf)


def test_land_and_outside_stay_unknown(run):
    sea = Sea.from_tides(Sea.open(run), constituents=["M2", "S2"])
    found = sea.sample([EAST, LEVEL], START, [51.55, 53.0, 52.0], [2.55, 3.0, 3.0])
    assert np.isnan(found[EAST][:2]).all() and np.isnan(found[LEVEL][:2]).all()
    assert np.isfinite(found[EAST][2])
    assert sea.why_missing(EAST, START, 53.0, 3.0) == "area"


def test_the_tidal_fraction_is_reported(run):
    sea = Sea.from_tides(Sea.open(run), constituents=["M2"])
    layer = next(x for x in sea.provenance()["layers"] if x["kind"] == "tide")
    assert layer["constituents"] == ["M2"]
    assert 0.85 < layer["tidal_share"][EAST] < 0.97  # S2 is left out
    assert layer["tidal_share"][NORTH] > 0.999


def test_frozen_tides_are_accurate_between_steps(run):
    sea = Sea.from_tides(Sea.open(run), constituents=["M2", "S2"])
    start = parse_time("2030-01-01")
    frozen = sea.freeze_stations([52.1], [3.1], start, start + 86400.0, [codes.WATER_LEVEL])
    exact = sea.series([LEVEL], frozen.times, np.array([52.1]), np.array([3.1]))[LEVEL]
    assert np.diff(frozen.times).max() <= 600.0
    assert np.allclose(frozen.values[0, :, 0], exact[0], atol=1e-6)


def test_an_analysis_is_cached_on_disk(run, monkeypatch):
    first = Sea.from_tides(Sea.open(run), constituents=["M2", "S2"])

    def never(*args, **kwargs):
        raise AssertionError("analysed again")

    with monkeypatch.context() as patch:
        patch.setattr(harmonic_analysis, "analyse", never)
        again = Sea.from_tides(Sea.open(run), constituents=["M2", "S2"])
        assert again.fingerprint() == first.fingerprint()
        with pytest.raises(AssertionError):
            Sea.from_tides(Sea.open(run), constituents=["M2"])
        with pytest.raises(AssertionError):
            Sea.from_tides(Sea.open(run), constituents=["M2", "S2"], cache=False)


def test_a_damaged_cache_is_replaced(run, tmp_path):
    first = Sea.from_tides(Sea.open(run), constituents=["M2"])
    (kept,) = (tmp_path / "cache" / "tides").glob("*.npz")
    kept.write_bytes(kept.read_bytes()[:200])
    assert Sea.from_tides(Sea.open(run), constituents=["M2"]).fingerprint() == first.fingerprint()


def test_a_run_too_short_for_its_constituents(run):
    with pytest.raises(InputError, match=r"N2 and M2 need 27\.6 days"):
        Sea.from_tides(Sea.open(run), constituents=["M2", "N2"])


def test_a_sea_without_nodes_has_no_tides():
    with pytest.raises(InputError, match="no currents or water levels"):
        Sea.from_tides(Sea.calm())


def test_tides_on_a_mesh_of_a_real_model():
    path = data_file("metocean/northsea_waterlevel_wind_hourly_20171027_29_dhi_ugrid.nc")
    sea = Sea.from_tides(Sea.open(path), constituents=["M2", "M4"], cache=False)
    assert sea.mesh() is not None
    known = sea.sample([LEVEL], parse_time("2026-01-01"), 52.5, 3.5)[LEVEL]
    assert np.isfinite(known) and abs(known) < 3.0


def test_one_station_applies_to_the_area_given():
    sea = Sea.from_tides(_gauge(), area=(51.0, 52.0, 3.0, 4.0))
    found = sea.sample([LEVEL], START, [51.5, 51.9, 52.5], [3.1, 3.9, 3.5])[LEVEL]
    expected = _gauge().predict(LEVEL, [START])[0, 0]
    assert found[:2] == pytest.approx([expected, expected])
    assert np.isnan(found[2])
    assert np.isnan(sea.sample([LEVEL], np.nan, 51.5, 3.5)[LEVEL])
    with pytest.raises(InputError, match="area"):
        Sea.from_tides(_gauge())


def test_constituents_are_selected_and_unneeded_areas_refused(run):
    area = (51.0, 52.0, 3.0, 4.0)
    only = Sea.from_tides(_gauge(), area=area, constituents=["M2"])
    expected = _gauge().predict(LEVEL, [START], only=["M2"])[0]
    assert only.sample([LEVEL], START, 51.5, 3.5)[LEVEL] == pytest.approx(expected[0])
    assert abs(expected[0] - _gauge().predict(LEVEL, [START])[0, 0]) > 0.01
    with pytest.raises(InputError, match="tides that have positions"):
        Sea.from_tides(Sea.open(run), area=area)
    found = model_run_analysis.tidal_analysis(Sea.open(run).layers, constituents=["M2"])
    with pytest.raises(InputError, match="tides that have positions"):
        Sea.from_tides(found, area=area)


def test_another_run_of_the_same_name_size_and_date_is_analysed_again(run):
    sea = Sea.open(run)
    first = model_run_analysis.tidal_analysis(sea.layers, constituents=["M2", "S2"])
    stamp, raw = run.stat(), xr.load_dataset(run, decode_times=False)
    raw["h"] = raw["h"] * 2.0
    raw.to_netcdf(run.with_suffix(".new"))
    os.replace(run.with_suffix(".new"), run)
    os.utime(run, ns=(stamp.st_atime_ns, stamp.st_mtime_ns))
    assert run.stat().st_size == stamp.st_size
    again = model_run_analysis.tidal_analysis(Sea.open(run).layers, constituents=["M2", "S2"])
    ratio = again.constituents.amplitude[LEVEL][0] / first.constituents.amplitude[LEVEL][0]
    assert np.nanmax(np.abs(ratio - 2.0)) < 1e-6


def test_variables_on_another_grid_are_reported(run):
    data = xr.load_dataset(run)
    moved = data["h"].isel(lat=slice(0, 2)).rename(lat="y", lon="x")
    both = data.drop_vars("h").assign(h=moved)
    with pytest.warns(ThalwegWarning, match="sea_surface_height_above_geopotential_datum on"):
        found = model_run_analysis.tidal_analysis(
            Sea.open(both).layers, constituents=["M2"], cache=False
        )
    assert found.constituents.variables == {EAST, NORTH}


def test_between_stations_the_tide_is_linear():
    lat, lon = np.array([51.0, 52.0, 51.0, 52.0]), np.array([3.0, 3.0, 4.0, 4.0])
    size = np.stack([1.0 + 0.5 * (lat - 51.0) + 0.2 * (lon - 3.0)])
    stations = Constituents(
        ("M2",), {LEVEL: size}, {LEVEL: np.full((1, 4), 40.0)}, {LEVEL: np.zeros(4)}, lat, lon
    )
    found = Sea.from_tides(stations).sample([LEVEL], START, 51.3, 3.6)[LEVEL]
    one = Constituents.single(LEVEL, {"M2": (1.0 + 0.15 + 0.12, 40.0)}, lat=51.5)
    assert found == pytest.approx(one.predict(LEVEL, [START])[0, 0])
    line = Constituents(
        ("M2",), {LEVEL: size[:, :2]}, {LEVEL: np.zeros((1, 2))}, {LEVEL: np.zeros(2)},
        lat[:2], lon[:2],
    )  # fmt: skip
    with pytest.raises(InputError, match="triangles"):
        Sea.from_tides(line)


def test_half_a_current_is_refused():
    half = Constituents.single(EAST, {"M2": (1.0, 0.0)}, lat=50.0, lon=0.0)
    with pytest.raises(InputError, match="without the other"):
        Sea.from_tides(half, area=(49.0, 51.0, -1.0, 1.0))


# --- files


def test_constituents_are_equal_after_writing_and_reading(tmp_path):
    path = tmp_path / "gauge.json"
    constituent_files.write_constituents(_gauge(facts={"station": "X"}), path)
    back = constituent_files.read_constituents(path)
    times = _hours(2)
    assert np.array_equal(back.predict(LEVEL, times), _gauge().predict(LEVEL, times))
    assert back.facts == {"station": "X"}


def _set(tmp_path, stations):
    path = tmp_path / "set.json.gz"
    path.write_bytes(gzip.compress(json.dumps(stations).encode()))
    return path


CURRENT = {
    "id": "noaa/X1", "name": "Narrows", "kind": "current", "lat": 40.6, "lon": -74.0,
    "current": {"flood_direction": 240.0, "mean_flow": 0.1},
    "constituents": [["M2", 2.0, 10.0], ["LAM2", 0.1, 20.0], ["S6", 0, 0]],
}  # fmt: skip


def test_currents_of_a_station_are_along_the_flood_direction(tmp_path):
    found = constituent_files.read_constituents(_set(tmp_path, [CURRENT]))
    times = _hours(1)
    east, north = (found.predict(n, times)[0] for n in (EAST, NORTH))
    along = Constituents.single("x", {"M2": (2.0, 10.0), "LAM2": (0.1, 20.0)}, mean=0.1)
    expected = along.predict("x", times)[0] * 1852.0 / 3600.0
    assert np.allclose(east, expected * np.sin(np.radians(240.0)))
    assert np.allclose(north, expected * np.cos(np.radians(240.0)))
    assert set(found.names) == {"M2", "LAMBDA2"}


def test_a_station_must_be_named_in_a_file_with_several(tmp_path):
    path = _set(tmp_path, [CURRENT, {**CURRENT, "id": "noaa/X2", "name": "Race"}])
    assert constituent_files.read_constituents(path, station="Race").facts["station"] == "noaa/X2"
    with pytest.raises(InputError, match="none is named"):
        constituent_files.read_constituents(path)
    with pytest.raises(InputError, match="Narrows"):
        constituent_files.read_constituents(path, station="Narows")


def test_constituents_without_argument_are_omitted_with_a_warning(tmp_path):
    odd = {**CURRENT, "constituents": [["M2", 2.0, 10.0], ["XYZ9", 0.2, 1.0]]}
    with pytest.warns(ThalwegWarning, match="XYZ9"):
        found = constituent_files.read_constituents(_set(tmp_path, [odd]))
    assert found.names == ("M2",)


@pytest.mark.filterwarnings("ignore::thalweg.core.errors.ThalwegWarning")
def test_two_sources_of_one_gauge_agree():
    """Vlissingen: TICON-4 (UTC, two years) and Rijkswaterstaat (MET, four years)."""
    path = data_file("tide/tide_constituents_nw_europe_ticon4_kartverket.json.gz")
    ticon = constituent_files.read_constituents(path, station="ticon/vlissingen-vlis-nld-rws")
    rws = constituent_files.read_constituents(
        data_file("tide/rws_vlissingen_components_hatyan.txt")
    )
    fast = [n for n in ticon.names if schureman.frequency(n) > 0.03]  # the year is weather
    ticon = ticon.picked(fast)
    times = _hours(30, start=parse_time("2026-01-01"))
    there = rws.predict(LEVEL, times)[0]
    left = {
        minutes: float(np.std(ticon.predict(LEVEL, times + 60.0 * minutes)[0] - there))
        for minutes in (-60, -10, 0, 10, 60)
    }
    assert min(left, key=left.__getitem__) == 0
    assert left[0] < 0.2  # of a tide with a standard deviation of 1.3 m


@pytest.mark.parametrize(
    "text",
    [
        "nothing of the kind",
        "[1, 2",
        '{"format": "thalweg-constituents-1", "names": ["M2"]}',
        '{"format": "other"}',
        "STAT X WATHTE NAP cm 1\nNCOM 2\nCOMP 65 28.984104 10.0 20.0 M2\n",
        "STAT X WATHTE NAP ft 1\nCOMP 65 28.984104 10.0 20.0 M2\n",
        "STAT X WATHTE NAP cm 1\nCOMP 65 28.5 10.0 20.0 M2\n",
        "STAT X WATHTE NAP cm 1\nCOMP 65 28.984104 much 20.0 M2\n",
        "STAT X WATHTE NAP cm 1\nNCOM one\nCOMP 65 28.984104 10.0 20.0 M2\n",
        "STAT X WATHTE NAP cm 1\nMIDD x\nCOMP 65 28.984104 10.0 20.0 M2\n",
        "[]",
        "[1, 2]",
        '[{"name": "x"}]',
        '[{"id": "x", "lat": 1, "lon": 2, "constituents": 5}]',
        '[{"id": "x", "lat": 1, "lon": 2, "constituents": [["M2", "a", 3]]}]',
        '[{"id": "x", "lat": null, "lon": 2, "constituents": [["M2", 1, 3]]}]',
        '[{"id": "x", "lat": 1, "lon": 2, "kind": "current", "constituents": [["M2", 1, 3]]}]',
        '[{"id": "x", "lat": 1, "lon": 2, "constituents": []}]',
        '{"format": "thalweg-constituents-1", "names": [], "lat": [5], "lon": [1],'
        ' "convention": "rws", "variables": {}}',
    ],
)
def test_files_without_constituents_are_refused(tmp_path, text):
    path = tmp_path / "x.txt"
    path.write_text(text)
    with pytest.raises(DatasetError):
        constituent_files.read_constituents(path)


def test_a_station_named_for_a_file_with_one_station_must_match_it(tmp_path):
    path = tmp_path / "x.txt"
    path.write_text("STAT VLISSGN WATHTE NAP cm 1\nCOMP 65 28.984104 10.0 20.0 M2\n")
    assert constituent_files.read_constituents(path, station="VLISSGN").names == ("M2",)
    with pytest.raises(InputError, match="holds VLISSGN"):
        constituent_files.read_constituents(path, station="HOEKVHLD")


def test_a_missing_file():
    with pytest.raises(DatasetError):
        constituent_files.read_constituents("no/such/file.txt")


def test_invalid_constants_are_refused():
    with pytest.raises(InputError):
        Constituents.single(LEVEL, {"M2": (-1.0, 0.0)})
    with pytest.raises(InputError):
        Constituents.single(LEVEL, TABLE, convention="doodson")
    with pytest.raises(InputError):
        _gauge().predict(EAST, [0.0])
    with pytest.raises(InputError):
        _gauge().predict(LEVEL, [0.0], only=["K1"])


# --- repeating


def test_the_spring_neap_period_repeats_the_envelope_not_the_tide():
    """1 / T_c = 1 / T_S2 - 1 / T_M2 (van Halem, 2019, has the sign turned)."""
    period = 1.0 / (schureman.frequency("S2") - schureman.frequency("M2"))
    assert period == pytest.approx(354.367, abs=1e-3)
    assert abs(drift_deg(period, "M2")) == pytest.approx(169.0, abs=0.5)
    assert abs(drift_deg(period, "S2")) == pytest.approx(169.0, abs=0.5)
    assert drift_deg(360.0, "M2") == pytest.approx(-5.7, abs=0.05)
    assert drift_deg(360.0, "S2") == pytest.approx(0.0, abs=1e-6)
    assert drift_deg(707.974, "M2") == pytest.approx(0.0, abs=0.02)
    assert drift_deg(707.974, "S2") == pytest.approx(-0.8, abs=0.05)


def test_high_water_becomes_low_water_after_the_spring_neap_period():
    tide = Constituents.single(LEVEL, {"M2": (1.0, 0.0), "S2": (0.4, 0.0)})
    times = _hours(1, 0.1)
    now, envelope, month = (
        tide.predict(LEVEL, times + 3600.0 * h)[0] for h in (0.0, 354.367, 707.974)
    )
    assert np.corrcoef(now, envelope)[0, 1] < -0.95
    assert np.corrcoef(now, month)[0, 1] > 0.999


def test_a_run_is_repeated_by_its_period(run):
    sea = Sea.open(run)
    again = repeat_in_time(sea, START, period_h=360.0)
    moments = START + 3600.0 * np.array([1.0, 300.0])
    here = sea.sample([LEVEL], moments, 52.0, 3.0)[LEVEL]
    for rounds in (-2, 0, 5):
        there = again.sample([LEVEL], moments + rounds * 360.0 * 3600.0, 52.0, 3.0)[LEVEL]
        assert there == pytest.approx(here, abs=1e-9)
    long = START + 400.0 * 86400.0
    times = again.times(long, long + 86400.0)
    assert times[0] <= long and times[-1] >= long + 86400.0
    assert np.diff(times).max() <= 3600.0
    series = again.series([LEVEL], times, np.array([52.0]), np.array([3.0]))[LEVEL]
    assert series[0] == pytest.approx(again.sample([LEVEL], times, 52.0, 3.0)[LEVEL])
    assert any("repeated" in a for a in again.assumptions)


def test_a_repeated_run_is_frozen_up_to_its_seam():
    """Interpolating frozen times must not smear the end of one round into the next."""
    start, length = START, 360.0 * 3600.0
    level = {LEVEL: lambda t, lat, lon: (t - start) / length + 0.0 * lat}
    sea = Sea.from_functions(level, period=(start, start + length), time_step=6 * 3600.0)
    again = repeat_in_time(sea, start, period_h=360.0)
    seam = start + length
    channels = [codes.WATER_LEVEL]
    frozen = again.freeze_stations([0.0], [0.0], seam - 86400.0, seam + 86400.0, channels)
    before = np.interp(seam - 60.0, frozen.times, frozen.values[0, :, 0])
    assert before == pytest.approx(1.0 - 60.0 / length, abs=1e-3)
    after = np.interp(seam + 60.0, frozen.times, frozen.values[0, :, 0])
    assert after == pytest.approx(60.0 / length, abs=1e-3)


@pytest.mark.parametrize("period", [354.367, 355.0, 12.4, 0.0, float("nan")])
def test_other_periods_are_refused(run, period):
    with pytest.raises(InputError, match="not in phase"):
        repeat_in_time(Sea.open(run), START, period_h=period)


def test_the_data_must_cover_the_repeated_period(run):
    with pytest.raises(InputError, match="Repeating needs"):
        repeat_in_time(Sea.open(run), START, period_h=707.974)
