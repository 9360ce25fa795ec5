"""Compiled kernels are kept apart by the state of their source, in a folder that can be written."""

import os
import subprocess
import sys
from pathlib import Path

from thalweg.kernels import folder


def test_the_stamp_follows_the_files(tmp_path, monkeypatch):
    (tmp_path / "a.py").write_text("1")
    monkeypatch.setattr(folder, "__file__", str(tmp_path / "folder.py"))
    first = folder._stamp()
    assert folder._stamp() == first
    (tmp_path / "a.py").write_text("12")
    assert folder._stamp() != first


def test_old_folders_are_forgotten(tmp_path):
    for number in range(7):
        path = tmp_path / str(number)
        path.mkdir()
        os.utime(path, (number, number))
    folder._forget_old(tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["3", "4", "5", "6"]


def test_a_home_that_cannot_be_written_is_no_obstacle(tmp_path):
    (tmp_path / "file").write_text("")
    environment = {**os.environ, "THALWEG_CACHE": str(tmp_path / "file" / "below")}
    environment.pop("NUMBA_CACHE_DIR", None)
    code = "from thalweg.kernels.folder import COMPILED; print(COMPILED)"
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, check=True, capture_output=True, text=True
    )
    assert Path(done.stdout.strip()).is_dir()
