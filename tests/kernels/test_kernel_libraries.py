"""Kernels called by kernels alone have no machine code of their own, and are kept on disk."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

KERNELS = """
from thalweg.kernels.compilation.decorators import kernel_only
from thalweg.kernels.compilation.jit import jit


@kernel_only
def squared(x):
    return x * x


@jit
def sum_of_squares(x, y):
    return squared(x) + squared(y)


@jit
def fourth_power(x):
    return squared(squared(x))
"""


@pytest.mark.slow
def test_an_inner_kernel_is_compiled_once_for_all_processes(tmp_path):
    (tmp_path / "some_kernels.py").write_text(KERNELS)
    environment = os.environ | {
        "NUMBA_CACHE_DIR": str(tmp_path / "cache"),
        "PYTHONPATH": os.pathsep.join([str(tmp_path), *sys.path]),
    }

    def run(call: str) -> str:
        code = f"import some_kernels as s; print({call}, sum(s.squared.stats.cache_hits.values()))"
        command = [sys.executable, "-c", code]
        done = subprocess.run(command, capture_output=True, check=True, env=environment, text=True)
        return done.stdout.strip()

    assert run("s.sum_of_squares(3.0, 4.0)") == "25.0 0"
    assert run("s.fourth_power(3.0)") == "81.0 1"  # compiles with the inner kernel of the cache
    assert run("s.fourth_power(2.0)") == "16.0 0"  # loads its machine code alone
