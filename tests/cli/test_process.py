"""The command line as a process: closed and full outputs, other encodings, Ctrl-C at the start."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from thalweg import __main__ as entry

COMMAND = [sys.executable, "-m", "thalweg"]
LIST, UNKNOWN = ["ship", "--list"], ["ship", "nonesuch"]


def _run(words, redirect="", **variables):
    line = " ".join(f"'{word}'" for word in [*COMMAND, *words])
    return subprocess.run(
        ["bash", "-c", f"{line} {redirect}; exit ${{PIPESTATUS[0]}}"],
        env={**os.environ, **variables},
        capture_output=True,
        check=False,
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "redirect", "code"),
    [
        (LIST, ">&-", 0),
        ([*UNKNOWN, "--json"], ">&-", 2),
        (UNKNOWN, "2>&-", 2),
        (UNKNOWN, "2>/dev/full", 2),
        (UNKNOWN, ">&- 2>&-", 2),
        (["ship", "handysize-bulker", "--json"], "| head -1", 0),
    ],
)
def test_closed_outputs_do_not_change_the_result(words, redirect, code):
    done = _run(words, redirect)
    assert done.returncode == code
    assert b"Traceback" not in done.stderr and b"Exception" not in done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("words", [LIST, [*UNKNOWN, "--json"]])
def test_a_full_output_is_an_error_with_a_cause(words):
    done = _run(words, "> /dev/full")
    assert done.returncode == 2
    assert b"error: The operating system" in done.stderr and b"No space left" in done.stderr
    assert b"Traceback" not in done.stderr


@pytest.mark.slow
def test_texts_can_be_written_in_any_encoding():
    done = _run(
        ["ship", "n\N{LATIN SMALL LETTER E WITH ACUTE}", "--json", "--quiet"],
        PYTHONIOENCODING="ascii",
    )
    assert done.returncode == 2 and b"nonesuch" not in done.stderr
    assert done.stderr == b""


def test_ctrl_c_while_libraries_are_loaded_has_no_trace(monkeypatch):
    found = []

    class Main:
        @staticmethod
        def main():
            found.append(signal.getsignal(signal.SIGINT))
            return 0

    usual = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        monkeypatch.setitem(sys.modules, "thalweg.cli.main", Main)
        assert entry.run() == 0
    finally:
        signal.signal(signal.SIGINT, usual)
    assert found == [signal.default_int_handler]
    code = (
        "import builtins, os, signal, sys\n"
        "from thalweg import __main__ as entry\n"
        "load = builtins.__import__\n"
        "def slow(name, *rest):\n"
        "    if name == 'thalweg.cli.main':\n"
        "        os.kill(os.getpid(), signal.SIGINT)\n"
        "    return load(name, *rest)\n"
        "builtins.__import__ = slow\n"
        "entry.run()"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False)
    assert done.returncode == -signal.SIGINT and done.stderr == b""


@pytest.mark.slow
def test_names_that_are_not_utf_8(tmp_path):
    name = os.fsencode(tmp_path) + b"/sea-\xff.nc"
    Path(os.fsdecode(name)).write_bytes(b"CDF\x01")
    done = _run(["inspect", os.fsdecode(name)])
    assert done.returncode == 2 and b"Rename the file" in done.stderr
    route = os.fsencode(tmp_path) + b"/route-\xff.csv"
    Path(os.fsdecode(route)).write_text("lat,lon\n")
    words = ["evaluate", os.fsdecode(route), "--ship", "handysize-bulker", "--calm"]
    done = _run([*words, "--depart", "2026-01-01"], PYTHONIOENCODING="ascii")
    assert done.returncode == 2 and b"holds 0 waypoints" in done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("words", [
    ["plan", "Atlantis", "London", "--ship", "handysize-bulker", "--calm"],
    ["distance", "Rotterdam", "95.0,3.0"],
])  # fmt: skip
def test_unknown_places_are_refused_before_the_numerical_libraries_are_loaded(words):
    code = (
        "import sys; from thalweg.cli.main import main; "
        f"code = main({words!r}); sys.exit(10 * code + ('numba' in sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False)
    assert done.returncode == 20, done.stderr.decode()[-400:]
