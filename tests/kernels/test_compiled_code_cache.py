"""Compiled kernels have one writable folder for each version of their source."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from thalweg.kernels.compilation import compiled_code_cache


def _hash_of(monkeypatch, folder, text):
    (folder / "leg").mkdir(parents=True, exist_ok=True)
    (folder / "leg" / "a.py").write_text(text)
    monkeypatch.setattr(compiled_code_cache, "PACKAGE", folder)
    return compiled_code_cache._source_hash()


def test_the_hash_follows_the_text_and_neither_place_nor_time(tmp_path, monkeypatch):
    first = _hash_of(monkeypatch, tmp_path / "one", "1")
    os.utime(tmp_path / "one" / "leg" / "a.py", (1, 1))
    assert compiled_code_cache._source_hash() == first
    assert _hash_of(monkeypatch, tmp_path / "two", "1") == first
    assert _hash_of(monkeypatch, tmp_path / "two", "2") != first
    changed = tmp_path / "ellipsoid.py"
    changed.write_text("FLATTENING = 0.0")
    monkeypatch.setattr(compiled_code_cache, "_CONSTANTS", changed)
    assert _hash_of(monkeypatch, tmp_path / "two", "1") != first


@pytest.mark.slow
def test_two_checkouts_share_compiled_code(tmp_path):
    code = (
        "from thalweg.kernels.network.lattice_edges import LatticeRows, find_point\n"
        "import numpy as np\n"
        "one = np.array([0, 1])\nassert find_point(0, 0, LatticeRows(0, one, one, 0)) == 0\n"
        "print(sum(find_point.stats.cache_hits.values()))"
    )
    source = Path(compiled_code_cache.PACKAGE).parents[1]
    hits = []
    for name in ("one", "two"):
        shutil.copytree(source / "thalweg" / "kernels", tmp_path / name / "thalweg" / "kernels")
        shutil.copytree(source / "thalweg" / "core", tmp_path / name / "thalweg" / "core")
        (tmp_path / name / "thalweg" / "__init__.py").write_text("")
        environment = {
            **os.environ,
            "THALWEG_CACHE": str(tmp_path / "cache"),
            "PYTHONPATH": str(tmp_path / name),
        }
        environment.pop("NUMBA_CACHE_DIR", None)
        done = subprocess.run(
            [sys.executable, "-c", code],
            env=environment,
            check=True,
            capture_output=True,
            text=True,
        )
        hits.append(int(done.stdout))
    assert hits == [0, 1]


def test_old_folders_are_forgotten(tmp_path):
    for number in range(7):
        path = tmp_path / str(number)
        path.mkdir()
        os.utime(path, (number, number))
    compiled_code_cache._remove_old_folders(tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["3", "4", "5", "6"]


def test_a_home_that_cannot_be_written_is_no_obstacle(tmp_path):
    (tmp_path / "file").write_text("")
    environment = {**os.environ, "THALWEG_CACHE": str(tmp_path / "file" / "below")}
    environment.pop("NUMBA_CACHE_DIR", None)
    module = "thalweg.kernels.compilation.compiled_code_cache"
    code = f"from {module} import COMPILED_FOLDER; print(COMPILED_FOLDER)"
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, check=True, capture_output=True, text=True
    )
    assert Path(done.stdout.strip()).is_dir()
