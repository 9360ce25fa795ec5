"""A child process compiles once, and removes its marker when it fails."""

import gc
import os

import pytest

from thalweg.kernels.certificate.barrier_solver import solve_barrier
from thalweg.kernels.compilation import warm_up
from thalweg.planning import compile_kernels

WRITES = "from pathlib import Path\n\n\ndef compile_search():\n    Path({!r}).write_text('done')\n"


@pytest.fixture
def marks(tmp_path, monkeypatch):
    monkeypatch.setenv("THALWEG_CACHE", str(tmp_path))
    monkeypatch.setenv("PYTHONPATH", str(tmp_path), prepend=os.pathsep)
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    monkeypatch.setattr(warm_up, "_COMPILED_MARKER", tmp_path / "warm")
    monkeypatch.setattr(warm_up, "_COMPILING_MARKER", tmp_path / "warming")
    before = gc.get_threshold()
    yield tmp_path
    gc.set_threshold(*before)


def _module(folder, name, text):
    (folder / f"{name}.py").write_text(text)
    return name


def test_a_child_process_compiles_and_the_parent_waits(marks):
    warm_up.start_compiling(_module(marks, "does_it", WRITES.format(str(marks / "proof"))))
    warm_up.wait_until_compiled()
    assert (marks / "proof").read_text() == "done"


def test_no_process_starts_if_all_is_compiled_or_another_compiles(marks):
    name = _module(marks, "is_late", WRITES.format(str(marks / "proof")))
    for mark in ("warm", "warming"):
        (marks / mark).touch()
        warm_up.start_compiling(name)
        assert not warm_up._children
        (marks / mark).unlink()


def test_a_failed_child_process_is_silent_and_leaves_no_marker(marks, monkeypatch):
    with pytest.raises(RuntimeError, match="no compiler"):
        warm_up.compile_in_child(_here(marks, monkeypatch, "raise RuntimeError('no compiler')"))
    assert not (marks / "warm").exists()
    assert not (marks / "warming").exists()


def test_work_marks_what_is_compiled(marks, monkeypatch):
    warm_up.compile_in_child(_here(marks, monkeypatch, "pass"))
    assert (marks / "warm").exists()


def _here(folder, monkeypatch, body):
    monkeypatch.syspath_prepend(str(folder))
    name = f"works_{abs(hash(body))}"
    return _module(folder, name, f"def compile_search():\n    {body}\n")


def test_another_process_compiles_the_certificate(monkeypatch):
    done = []

    class Process:
        def __init__(self, command, **quiet):
            done.append(command[-1])

        def wait(self):
            done.append("waited")

    monkeypatch.setattr(compile_kernels.subprocess, "Popen", Process)
    monkeypatch.setattr(compile_kernels, "_search_and_smooth", lambda: done.append("searched"))
    compile_kernels.compile_search()
    assert done[0].endswith(".compile_certificate()")
    assert done[1:] == ["searched", "waited"]


def test_a_small_certificate_compiles_its_kernels():
    compile_kernels.compile_certificate()
    assert solve_barrier.signatures
