"""Tables kept on disk: the same numbers, rebuilt when damaged, and no need of a disk."""

import numpy as np
import pytest

from thalweg.ship import TableError, TablePart
from thalweg.ship.table_store import MOST_FILES, kept_table


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("THALWEG_CACHE", str(tmp_path))
    return tmp_path / "ship-tables"


def _table(calls=None):
    if calls is not None:
        calls.append(1)
    grid = np.linspace(0.0, 10.0, 5)
    part = TablePart((2,), (grid,), np.arange(10.0).reshape(5, 2))
    return (part,), TableError(0.1, 0.2, 0.3, 40), np.array([5.0, 9.0])


def test_a_kept_table_is_read_back_without_building(folder):
    calls = []
    first = kept_table({"ship": 1}, lambda: _table(calls))
    again = kept_table({"ship": 1}, lambda: _table(calls))
    assert len(calls) == 1
    assert again[1] == first[1] and again[2].tolist() == [5.0, 9.0]
    assert again[0][0].axes == (2,)
    assert np.array_equal(again[0][0].values, first[0][0].values)
    assert np.array_equal(again[0][0].grids[0], first[0][0].grids[0])


def test_another_ship_has_its_own_table(folder):
    calls = []
    kept_table({"ship": 1}, lambda: _table(calls))
    kept_table({"ship": 2}, lambda: _table(calls))
    assert len(calls) == 2


@pytest.mark.parametrize("damage", [b"", b"PK\x03\x04 broken", b"\x93NUMPY"])
def test_a_damaged_file_is_built_anew(folder, damage):
    calls = []
    kept_table({"ship": 1}, lambda: _table(calls))
    (path,) = folder.glob("*.npz")
    path.write_bytes(damage)
    kept_table({"ship": 1}, lambda: _table(calls))
    assert len(calls) == 2
    kept_table({"ship": 1}, lambda: _table(calls))
    assert len(calls) == 2


def test_old_tables_are_removed(folder):
    for ship in range(MOST_FILES + 3):
        kept_table({"ship": ship}, _table)
    assert len(list(folder.glob("*"))) == MOST_FILES


def test_a_disk_that_is_full_only_costs_time(folder, monkeypatch):
    def full(*arguments, **options):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("thalweg.ship.table_store.np.savez", full)
    calls = []
    for _ in range(2):
        found = kept_table({"ship": 1}, lambda: _table(calls))
        assert found[2].tolist() == [5.0, 9.0]
    assert len(calls) == 2
