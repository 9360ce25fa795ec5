"""Files that are larger than the memory: read in parts of time, with the same values."""

import numpy as np
import pytest

from tests.sea.small_datasets import EAST, NORTH, T0, regular
from thalweg.kernels.codes import CURRENT_EAST, CURRENT_NORTH
from thalweg.sea import Sea
from thalweg.sea.grids import block_cache, gridded_layer
from thalweg.sea.grids.gridded_layer import GridLayer
from thalweg.sea.grids.source_variables import GridWindow, SourceVariable

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


CHUNKS = (6, 10, 20)  # levels, rows, columns


@pytest.fixture
def chunked(tmp_path):
    """Return the path of a compressed file of 24 levels, 40 rows and 60 columns."""
    fields = {name: {"standard_name": name, "units": "m s-1"} for name in (EAST, NORTH)}
    lat, lon = np.linspace(0.0, 4.0, 40), np.linspace(0.0, 6.0, 60)
    dataset = regular(lat, lon, np.arange(24.0), fields=fields)
    path = tmp_path / "chunked.nc"
    encoding = {name: {"zlib": True, "chunksizes": CHUNKS} for name in dataset.data_vars}
    dataset.to_netcdf(path, encoding=encoding)
    return path


@pytest.fixture
def chunks_read(monkeypatch):
    """Return a list that gets, per read of a variable, the number of chunks it touches."""
    counts = []
    original = SourceVariable._levels

    def counted(variable, window, columns):
        sides = ((window.t0, window.t1), (window.y0, window.y1))
        sides += ((window.x0, window.x0 + window.width),)
        touched = [-(-b // c) - a // c for (a, b), c in zip(sides, CHUNKS)]
        counts.append(int(np.prod(touched)))
        return original(variable, window, columns)

    monkeypatch.setattr(SourceVariable, "_levels", counted)
    return counts


def frozen_grid(path):
    sea = Sea.open(path)
    channels = (CURRENT_EAST, CURRENT_NORTH)
    fields = sea.freeze_grid(0.1, 3.9, 0.1, 5.9, T0, T0 + 23 * 3600.0, channels, spacing_deg=0.07)
    return fields.values


def test_each_chunk_of_a_file_is_read_once_where_not_all_fit(chunked, chunks_read, monkeypatch):
    at_once = frozen_grid(chunked)
    chunks_read.clear()
    level = 40 * 60 * 8  # bytes of a level: float32, two components
    monkeypatch.setattr(block_cache, "MAX_UNION_BYTES", 3 * level)
    monkeypatch.setattr(gridded_layer, "MAX_UNION_BYTES", 3 * level)
    monkeypatch.setattr(block_cache, "MAX_CHUNKED_BYTES", 13 * level)
    monkeypatch.setattr("thalweg.sea.grids.source_variables.MAX_VALUES_AT_ONCE", 4000)
    monkeypatch.setattr("thalweg.sea.freeze.POINTS_OF_SOME_TIMES", 2 * at_once[0, ..., 0].size)
    in_parts = frozen_grid(chunked)
    np.testing.assert_array_equal(in_parts, at_once)
    assert len(chunks_read) > 20  # levels and rows apart
    opening = 2 * 4 * 3  # one level of both components
    assert sum(chunks_read) <= opening + 2 * 4 * 4 * 3


def test_blocks_end_with_chunks_and_keep_the_levels_they_hold(chunked):
    sea = Sea.open(chunked)
    layer = grid_layer(sea)
    (quantity,) = layer.quantities
    assert quantity.chunks == CHUNKS
    first = layer.cache.block(quantity, GridWindow(1, 3, 12, 15, 5, 8))
    assert first.window == GridWindow(0, 6, 10, 20, 0, 20)
    later = layer.cache.block(quantity, GridWindow(5, 8, 12, 15, 5, 8))
    assert later.window == GridWindow(0, 12, 10, 20, 0, 20)
    whole = quantity.read(later.window, 60)
    for name, values in later.values.items():
        np.testing.assert_array_equal(values, whole[name])
