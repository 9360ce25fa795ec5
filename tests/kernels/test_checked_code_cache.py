"""Damaged files of compiled code are compiled again."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

KERNEL = """
from thalweg.kernels.compilation.jit import jit

@jit
def double(x):
    return 2.0 * x

if __name__ == "__main__":
    print(double(21.0), sum(double.stats.cache_hits.values()))
"""


@pytest.fixture
def run(tmp_path):
    """Return a function that runs a kernel in a process: its result and the number of hits."""
    script = tmp_path / "kernel.py"
    script.write_text(KERNEL)
    environment = {**os.environ, "THALWEG_CACHE": str(tmp_path / "cache")}
    environment.pop("NUMBA_CACHE_DIR", None)

    def start(before=""):
        code = f"{before}\nimport runpy, sys; runpy.run_path(sys.argv[1], run_name='__main__')"
        done = subprocess.run(
            [sys.executable, "-c", code, script],
            env=environment,
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stderr
        return tuple(float(word) for word in done.stdout.split())

    return start


def _files(tmp_path, ending):
    return list((tmp_path / "cache").rglob(f"*double*.{ending}"))


@pytest.mark.slow
def test_files_cut_short_or_changed_are_compiled_again(run, tmp_path):
    assert run() == (42.0, 0)
    for ending in ("nbi", "nbc"):
        (path,) = _files(tmp_path, ending)
        whole = path.read_bytes()
        changed = bytearray(whole)
        changed[len(whole) // 2] ^= 0xFF
        damaged = whole[: len(whole) // 2] if ending == "nbi" else bytes(changed)
        path.write_bytes(damaged)
        assert run() == (42.0, 0)
        assert path.read_bytes() != damaged
    assert run() == (42.0, 1)


@pytest.mark.slow
def test_code_that_cannot_be_kept_is_used(run, tmp_path):
    limit = (
        "import resource, signal; signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (64, 64))"
    )
    assert run(limit) == (42.0, 0)
    assert _files(tmp_path, "nbc") == []
