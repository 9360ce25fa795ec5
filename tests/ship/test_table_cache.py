"""The cache of tables: equal numbers, rebuilt when damaged, optional."""

import numpy as np
import pytest

from thalweg.ship import PerformanceTable, TableError, TablePart
from thalweg.ship.tables.output_curve import OutputCurve
from thalweg.ship.tables.table_cache import MAX_FILES, cached_table


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("THALWEG_CACHE", str(tmp_path))
    return tmp_path / "ship-tables"


def _table(calls=None):
    if calls is not None:
        calls.append(1)
    grid = np.linspace(0.0, 10.0, 5)
    part = TablePart((2,), (grid,), np.arange(10.0).reshape(5, 2))
    table = PerformanceTable((part,), np.array([5.0, 9.0]), "", TableError(0.1, 0.2, 0.3, 40))
    return table, np.array([5.0, 9.0])


def test_a_cached_table_is_read_without_building(folder):
    calls = []
    first = cached_table({"ship": 1}, lambda: _table(calls))
    again = cached_table({"ship": 1}, lambda: _table(calls))
    assert len(calls) == 1
    assert again[0].error == first[0].error and again[1].tolist() == [5.0, 9.0]
    (kept,), (built,) = again[0].parts, first[0].parts
    assert kept.axes == (2,) and again[0].finish is None
    assert np.array_equal(kept.values, built.values)
    assert np.array_equal(kept.grids[0], built.grids[0])
    assert np.isnan(kept.squared_height_limit)


@pytest.mark.parametrize("kind", ["curve", "crossing"])
def test_the_output_curve_is_cached(folder, kind):
    grid = np.linspace(0.0, 10.0, 5)
    part = TablePart((3,), (grid,), np.ones((5, 2)), 6.0)
    ends = np.array([5.0, 9.0])
    guess = np.array([0, 1])
    points = np.linspace(9.0, 0.0, 9)[None].repeat(2, axis=0)
    finish = OutputCurve(kind, np.zeros(2), np.full(2, 0.5), points, ends, guess)
    table = PerformanceTable((part,), ends, "", TableError(0, 0, 0), finish)
    for _ in range(2):
        kept, _ = cached_table({"kind": kind}, lambda: (table, ends))
    assert kept.finish.kind == kind and kept.parts[0].squared_height_limit == 6.0
    for name in ("start", "step", "points", "top", "guess"):
        assert np.array_equal(getattr(kept.finish, name), getattr(finish, name))
    where = {"wave_height": [0.0, 1.0, 2.5, 7.0], "wave_angle": 4.0}
    assert kept.lookup(where, 0).tolist()[:3] == table.lookup(where, 0).tolist()[:3]
    assert np.isnan(kept.lookup(where, 0)[3])


def test_another_ship_has_its_own_table(folder):
    calls = []
    cached_table({"ship": 1}, lambda: _table(calls))
    cached_table({"ship": 2}, lambda: _table(calls))
    assert len(calls) == 2


@pytest.mark.parametrize("damage", [b"", b"PK\x03\x04 broken", b"\x93NUMPY"])
def test_a_damaged_file_is_rebuilt(folder, damage):
    calls = []
    cached_table({"ship": 1}, lambda: _table(calls))
    (path,) = folder.glob("*.npz")
    path.write_bytes(damage)
    cached_table({"ship": 1}, lambda: _table(calls))
    assert len(calls) == 2
    cached_table({"ship": 1}, lambda: _table(calls))
    assert len(calls) == 2


def test_old_tables_are_removed(folder):
    for ship in range(MAX_FILES + 3):
        cached_table({"ship": ship}, _table)
    assert len(list(folder.glob("*"))) == MAX_FILES


def test_a_disk_that_is_full_only_costs_time(folder, monkeypatch):
    def full(*arguments, **options):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("thalweg.ship.tables.table_cache.np.savez", full)
    calls = []
    for _ in range(2):
        found = cached_table({"ship": 1}, lambda: _table(calls))
        assert found[1].tolist() == [5.0, 9.0]
    assert len(calls) == 2
