"""Compiled kernels have one writable folder for each version of their source."""

import os
import subprocess
import sys
from pathlib import Path

from thalweg.kernels.compilation import compiled_code_cache


def test_the_stamp_follows_the_files(tmp_path, monkeypatch):
    (tmp_path / "leg").mkdir()
    (tmp_path / "leg" / "a.py").write_text("1")
    monkeypatch.setattr(compiled_code_cache, "PACKAGE", tmp_path)
    first = compiled_code_cache._source_hash()
    assert compiled_code_cache._source_hash() == first
    (tmp_path / "leg" / "a.py").write_text("12")
    assert compiled_code_cache._source_hash() != first


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
