"""Files that are larger than the memory: read in parts of time, with the same values."""

import numpy as np
import pytest

from tests.sea.small_datasets import EAST, NORTH, T0, regular
from thalweg.sea import Sea
from thalweg.sea.grids import block_cache, gridded_layer
from thalweg.sea.grids.gridded_layer import GridLayer

LIMIT = 200_000  # bytes; the file has 8 bytes times 40 x 60 x 60 values


@pytest.fixture(scope="module")
def sea():
    fields = {name: {"standard_name": name, "units": "m s-1"} for name in (EAST, NORTH)}
    lat, lon = np.linspace(0.0, 6.0, 60), np.linspace(0.0, 6.0, 60)
    return Sea.open(regular(lat, lon, np.arange(40.0), fields=fields))


def grid_layer(sea):
    return next(layer for layer in sea.layers if isinstance(layer, GridLayer))


@pytest.fixture
def small_windows(monkeypatch, sea):
    layer = grid_layer(sea)
    monkeypatch.setattr(gridded_layer, "MAX_WINDOW_BYTES", LIMIT)
    monkeypatch.setattr(block_cache, "MAX_UNION_BYTES", 1)
    layer.cache.blocks.clear()
    return layer


def held_bytes(cache):
    return sum(v.nbytes for block in cache.blocks.values() for v in block.values.values())


def asked():
    rng = np.random.default_rng(1)
    time = T0 + 3600.0 * rng.uniform(-1.0, 41.0, 300)
    return time, rng.uniform(-0.5, 6.5, 300), rng.uniform(-0.5, 6.5, 300)


def test_samples_and_series_are_those_of_one_window(sea, small_windows, monkeypatch):
    time, lat, lon = asked()
    times = np.sort(time[:50])
    names = (EAST, NORTH)
    in_parts = small_windows.sample(names, time, lat, lon)
    assert 0 < held_bytes(small_windows.cache) <= LIMIT
    series = small_windows.series(names, times, lat, lon)
    assert 0 < held_bytes(small_windows.cache) <= LIMIT
    monkeypatch.setattr(gridded_layer, "MAX_WINDOW_BYTES", 10**9)
    small_windows.cache.blocks.clear()
    at_once = small_windows.sample(names, time, lat, lon)
    assert held_bytes(small_windows.cache) > 5 * LIMIT
    assert np.isfinite(at_once[EAST]).sum() > 200
    for name in names:
        np.testing.assert_array_equal(in_parts[name], at_once[name])
        whole = small_windows.series(names, times, lat, lon)[name]
        np.testing.assert_array_equal(series[name], whole)


def test_one_level_is_read_even_if_it_is_larger_than_the_limit(sea, small_windows, monkeypatch):
    monkeypatch.setattr(gridded_layer, "MAX_WINDOW_BYTES", 1)
    time, lat, lon = asked()
    found = small_windows.sample((EAST,), time, lat, lon)[EAST]
    assert np.isfinite(found).sum() > 200
    assert held_bytes(small_windows.cache) <= 2 * 60 * 60 * 2 * 8  # two levels of both components
