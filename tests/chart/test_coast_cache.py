"""The coast index on disk: used when valid, replaced when damaged."""

from __future__ import annotations

import numpy as np
import pytest

from thalweg.chart import Chart
from thalweg.chart.coast import coast_cache, coastline
from thalweg.chart.coast.coast_index_builder import build_index, empty_index
from thalweg.chart.rings import Rings

SQUARE = Rings.from_lists([([(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0)], False)])


@pytest.mark.parametrize("harm", ["cut", "junk", "empty", "other arrays"])
def test_a_broken_file_is_replaced(tmp_path, harm):
    path = tmp_path / "index.npz"
    made = []

    def make():
        made.append(1)
        return build_index(SQUARE, 16)

    first = coast_cache.load_or_build(path, make)
    assert coast_cache.load_or_build(path, make).side == 16
    assert len(made) == 1
    content = path.read_bytes()
    if harm == "other arrays":
        with path.open("wb") as file:
            np.savez(file, **(first._asdict() | {"first": np.zeros(3, np.uint8)}))
    else:
        path.write_bytes(
            {"cut": content[: len(content) // 2], "junk": b"x" * 99, "empty": b""}[harm]
        )
    again = coast_cache.load_or_build(path, make)
    assert len(made) == 2
    for a, b in zip(first, again):
        assert np.array_equal(a, b)
    assert list(tmp_path.iterdir()) == [path]


def test_a_folder_that_cannot_be_written_is_no_harm(tmp_path):
    path = tmp_path / "missing" / "index.npz"
    assert coast_cache.load_or_build(path, empty_index).side == 1
    assert not path.exists()


@pytest.mark.slow
def test_gshhg_is_cached(tmp_path, monkeypatch):
    monkeypatch.setenv("THALWEG_CACHE", str(tmp_path))
    coastline.shared_coastline.cache_clear()
    first = Chart.gshhg("c")
    assert len(list((tmp_path / "coast").glob("gshhg-c-*.npz"))) == 1
    assert Chart.gshhg("c").coastline is first.coastline  # shared, and not read again
    assert Chart.gshhg("c").fingerprint() == first.fingerprint()
    assert Chart.gshhg("l").fingerprint() != first.fingerprint()
    assert first.within(0, 1, 0, 1).fingerprint() != first.fingerprint()
