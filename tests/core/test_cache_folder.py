"""The cache folder falls back to a private folder that all processes of a user share."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from thalweg.core import cache_folder as module
from thalweg.core.cache_folder import cache_folder, is_usable, private_temporary_folder


@pytest.fixture
def temporary(tmp_path, monkeypatch):
    """Return the path of the private folder, in a folder for temporary files of this test."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setenv("THALWEG_CACHE", str(tmp_path / "cache"))
    return tmp_path / f"thalweg-{os.getuid()}"


def test_the_folder_of_the_environment_is_used(temporary, tmp_path):
    assert cache_folder("tables") == tmp_path / "cache" / "tables"
    assert cache_folder() == tmp_path / "cache"
    assert not list((tmp_path / "cache" / "tables").iterdir())


def test_a_full_disk_is_noticed_by_writing(temporary, monkeypatch):
    class Full:
        def __init__(self, **_):
            raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(tempfile, "NamedTemporaryFile", Full)
        assert not is_usable(temporary.parent / "another")


def test_a_cache_without_space_falls_back_to_one_private_folder(temporary, monkeypatch):
    usual = module._takes_files
    monkeypatch.setattr(module, "_takes_files", lambda f: "cache" not in f.parts and usual(f))
    assert cache_folder("tables") == temporary / "tables" == cache_folder("tables")
    assert stat.S_IMODE(temporary.stat().st_mode) == 0o700


@pytest.mark.parametrize("kind", ["link", "open", "file", "foreign"])
def test_a_folder_that_others_control_is_not_used(temporary, tmp_path, kind):
    if kind == "link":
        (tmp_path / "elsewhere").mkdir(mode=0o700)
        temporary.symlink_to(tmp_path / "elsewhere")
    elif kind == "file":
        temporary.write_text("")
    else:
        temporary.mkdir(mode=0o700)
        if kind == "open":
            temporary.chmod(0o777)
        elif os.getuid() == 0:
            os.chown(temporary, 12345, 12345)
        else:
            pytest.skip("only root can give a folder away")
    folder = private_temporary_folder()
    assert folder != temporary and folder.parent == tmp_path
    assert folder.is_dir() and stat.S_IMODE(folder.stat().st_mode) == 0o700


def test_a_folder_of_one_process_is_removed_at_its_end(temporary, tmp_path):
    temporary.write_text("in the way")
    code = (
        "from thalweg.core.cache_folder import private_temporary_folder as f\n"
        "print(f()); assert f() == f() and f().is_dir()"
    )
    environment = {**os.environ, "TMPDIR": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True
    )
    assert not Path(done.stdout.strip()).exists()


def test_kernels_find_a_folder_for_a_user_without_a_home(tmp_path):
    code = (
        "import pathlib\n"
        "def home(*_):\n    raise RuntimeError('Could not determine home directory.')\n"
        "pathlib.Path.home = home\n"
        "from thalweg.kernels.compilation.compiled_code_cache import COMPILED_FOLDER as f\n"
        "print(f)"
    )
    environment = {**os.environ, "TMPDIR": str(tmp_path)}
    for name in ("HOME", "THALWEG_CACHE", "NUMBA_CACHE_DIR", "XDG_CACHE_HOME", "LOCALAPPDATA"):
        environment.pop(name, None)
    runs = [
        subprocess.run(
            [sys.executable, "-c", code],
            env=environment,
            capture_output=True,
            text=True,
            check=True,
        )
        for _ in range(2)
    ]
    first, second = (Path(run.stdout.strip()) for run in runs)
    assert first == second and first.is_dir() and tmp_path in first.parents
