"""The properties that every layer of a sea must have."""

from __future__ import annotations

import json

import numpy as np
import pytest

from tests.sea.small_datasets import T0, clock, mesh, regular
from thalweg.core.bounding_box import BoundingBox
from thalweg.kernels import codes
from thalweg.sea import Sea
from thalweg.sea import standard_names as nm

LAYERS = {
    "functions": lambda: Sea.from_functions(
        {
            "eastward_sea_water_velocity": lambda t, y, x: 0.1 * y,
            "northward_sea_water_velocity": lambda t, y, x: 0.01 * x,
            "sea_floor_depth_below_geoid": lambda t, y, x: 20.0,
        }
    ),
    "calm": Sea.calm,
    "storm": lambda: Sea.storm(start="2023-11-10T00:00Z"),
    "grid": lambda: Sea.open(regular()),
    "mesh": lambda: Sea.open(mesh()),
    "faces": lambda: Sea.open(mesh(location="face")),
    "filled": lambda: Sea.open(regular()).filled(currents=0.0, wind=(1.0, 2.0)),
    "layered": lambda: Sea.open(regular()) + Sea.calm(),
}


@pytest.fixture(params=sorted(LAYERS))
def sea(request) -> Sea:
    return LAYERS[request.param]()


def points(sea: Sea) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return points in, on the rim of and far from the data of every layer."""
    rng = np.random.default_rng(0)
    lat = np.concatenate(
        [rng.uniform(9.5, 13.5, 40), rng.uniform(49.8, 51.4, 40), [11.0, 89.9, -60.0]]
    )
    lon = np.concatenate(
        [rng.uniform(19.5, 22.5, 40), rng.uniform(1.8, 4.7, 40), [21.0, 179.9, -180.0]]
    )
    return T0 + rng.uniform(-600.0, 4200.0, lat.size), lat, lon


def test_shapes_follow_broadcasting(sea) -> None:
    name = sorted(sea.variables)[0]
    assert sea.sample([name], T0, 11.0, 21.0)[name].shape == ()
    got = sea.sample([name], np.full(3, T0), 11.0, np.full((2, 1), 21.0))[name]
    assert got.shape == (2, 3)
    assert got.dtype == np.float64
    assert sea.sample([name], np.empty(0), np.empty(0), np.empty(0))[name].shape == (0,)


def test_sampling_is_pure_and_order_does_not_matter(sea) -> None:
    names = sorted(sea.variables)
    time, lat, lon = points(sea)
    kept = [a.copy() for a in (time, lat, lon)]
    first = sea.sample(names, time, lat, lon)
    order = np.random.default_rng(1).permutation(time.size)
    again = sea.sample(names, time[order], lat[order], lon[order])
    for a, b in zip(kept, (time, lat, lon)):
        assert np.array_equal(a, b)
    for name in names:
        assert np.array_equal(first[name][order], again[name], equal_nan=True)


def test_longitude_may_be_given_either_way(sea) -> None:
    names = sorted(sea.variables)
    time, lat, lon = points(sea)
    if any("formula" in c.source for c in sea.coverage()):
        pytest.skip("a formula decides itself what it does with longitude")
    one, two = (sea.sample(names, time, lat, lon + turn) for turn in (0.0, 360.0))
    for name in names:
        assert one[name] == pytest.approx(two[name], rel=1e-6, abs=1e-6, nan_ok=True)


def test_vectors_are_known_or_unknown_as_pairs(sea) -> None:
    time, lat, lon = points(sea)
    for vector in nm.VECTORS:
        if vector.east in sea.variables:
            got = sea.sample(vector.pair, time, lat, lon)
            assert np.array_equal(np.isnan(got[vector.east]), np.isnan(got[vector.north]))


def test_every_unknown_value_has_a_reason(sea) -> None:
    time, lat, lon = points(sea)
    for name in sea.variables:
        got = sea.sample([name], time, lat, lon)[name]
        for k in np.flatnonzero(np.isnan(got)):
            reason = sea.why_missing(name, time[k], lat[k], lon[k])
            assert reason in ("area", "period", "gap")
    assert sea.why_missing("number_of_mermaids", T0, 11.0, 21.0) == "variable"


def test_series_equal_samples(sea) -> None:
    names = sorted(sea.variables)
    _, lat, lon = points(sea)
    times = T0 + np.array([-600.0, 0.0, 700.0, 3600.0])
    series = sea.series(names, times, lat, lon)
    for name in names:
        one = sea.sample([name], times[None], lat[:, None], lon[:, None])[name]
        assert series[name] == pytest.approx(one, rel=1e-9, abs=1e-12, nan_ok=True)


@pytest.mark.slow
def test_frozen_fields_have_the_layout_of_kernels(sea) -> None:
    _, lat, lon = points(sea)
    fields = sea.freeze_stations(lat, lon, T0, T0 + 3600.0, range(codes.CHANNEL_COUNT))
    assert fields.values.dtype == np.float32
    assert fields.values.flags.c_contiguous
    assert (np.diff(fields.times) > 0).all()
    assert fields.times[0] <= T0
    assert fields.channel_index.shape == (codes.CHANNEL_COUNT,)
    present = np.flatnonzero(fields.channel_index >= 0)
    assert sorted(fields.channel_index[present]) == list(range(fields.values.shape[2]))
    assert {nm.CHANNEL_VARIABLES[int(c)] for c in present} <= sea.variables
    for channel in present:
        name = nm.CHANNEL_VARIABLES[int(channel)]
        got = sea.sample([name], fields.times[None], lat[:, None], lon[:, None])[name]
        frozen = fields.values[:, :, fields.channel_index[channel]]
        assert frozen == pytest.approx(got, rel=1e-5, abs=1e-5, nan_ok=True)
    grid = sea.freeze_grid(10.0, 12.0, 20.0, 22.0, T0, T0 + 3600.0, [4, 0], spacing_deg=0.5)
    assert grid.values.shape[:3] == (grid.times.size, 5, 5)
    assert grid.values.flags.c_contiguous
    box = BoundingBox(10.0, 12.0, 20.0, 22.0)
    boxed = sea.freeze_grid(box, T0, T0 + 3600.0, [4, 0], spacing_deg=0.5)
    sides = {"south": 10.0, "north": 12.0, "west": 20.0, "east": 22.0}
    named = sea.freeze_grid(**sides, start=T0, end=T0 + 3600.0, channels=[4, 0], spacing_deg=0.5)
    for other in (boxed, named):
        assert np.array_equal(other.values, grid.values, equal_nan=True)


def test_times_increase_and_reach_over_the_window(sea) -> None:
    times = sea.times(T0 + 600.0, T0 + 3000.0)
    assert (np.diff(times) > 0).all()
    assert times[0] <= T0 + 600.0
    assert times[-1] >= T0 + 3000.0


def test_coverage_rows_name_every_variable(sea) -> None:
    rows = sea.coverage()
    assert {r.variable for r in rows} == sea.variables
    for row in rows:
        assert row.south <= row.north
        assert row.west <= row.east
        assert row.source


def test_provenance_is_plain_and_fingerprint_stable(sea, request) -> None:
    text = json.dumps(sea.provenance())
    assert sea.fingerprint() in text
    kind = request.node.callspec.params["sea"]
    assert LAYERS[kind]().fingerprint() == sea.fingerprint()


def test_seas_cannot_be_changed(sea) -> None:
    with pytest.raises(AttributeError):
        sea.layers = ()
    before = sea.fingerprint()
    other = sea + Sea.calm()
    assert sea.fingerprint() == before
    assert other.fingerprint() != before


def test_missing_data_never_become_calm_weather() -> None:
    sea = Sea.open(regular().assign_coords(time=clock([0.0, 1.0, 3.0])))
    unknown = sea.sample(["eastward_wind", "sea_water_speed", "wind_speed"], T0, 11.0, 21.0)
    assert all(np.isnan(v) for v in unknown.values())
