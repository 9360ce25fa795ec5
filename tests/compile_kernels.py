"""Compilation of the kernels once, before workers would each compile the same."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

from thalweg.kernels.compilation import warm_up
from thalweg.kernels.compilation.compiled_code_cache import COMPILED_FOLDER

_MARKER = COMPILED_FOLDER / "compiled-for-tests"


def compile_once(say: Callable[[str], None]) -> None:
    """Compile what most tests need, unless that has been done for this text of the kernels."""
    if _MARKER.exists():
        return
    say(
        "Compiling the numerical kernels for this computer, once for this version of their text: "
        f"1 to 3 minutes. They are kept in {COMPILED_FOLDER.parent}."
    )
    command = [sys.executable, "-c", f"import {__name__} as kernels; kernels.compile_all()"]
    if subprocess.run(command, cwd=Path(__file__).resolve().parent.parent).returncode == 0:
        _MARKER.touch()
    else:
        say("The compilation failed; each test compiles what it needs.")


def compile_all() -> None:
    """Plan small voyages, which compiles the kernels in the cache on disk."""
    _compile_searches()
    warm_up.compile_in_child("thalweg.planning.compile_kernels")  # marks it as done for commands
    _compile_fronts()


def _compile_searches() -> None:
    """Compile the searches, the refinement and the kernels of charts, by planning a voyage."""
    from thalweg import Chart, Ship, Voyage, plan

    ship = Ship.simple(speed_kn=8.0, draught_m=5.0)
    hours = ("2026-01-01T00:00Z", "2026-01-01T02:00Z")
    for departure in ({"depart": hours[0]}, {"depart_window": hours}):
        plan(
            Voyage(start=(51.0, 2.0), goal=(51.0, 2.2), **departure),
            ship=ship, sea=_tidal_sea(), chart=Chart.open_water(50.9, 51.1, 1.9, 2.3),
            resolution=4000.0,
        )  # fmt: skip


def _compile_fronts() -> None:
    """Compile the searches of fronts, their bounds, and evolution, by planning a small front."""
    from thalweg import Chart, Ship, Voyage, plan

    data = {
        "name": "x", "hull": {"draught_m": 5.0}, "speeds_kn": [8.0, 10.0],
        "fuel": {"reference_t_per_day": 24.0}, "models": {"calm_water": "cubic"},
    }  # fmt: skip
    voyage = Voyage(
        start=(51.0, 2.0), goal=(51.0, 2.2), depart="2026-01-01T00:00Z", objective="front"
    )
    plan(
        voyage, ship=Ship.from_dict(data), sea=_tidal_sea(),
        chart=Chart.open_water(50.9, 51.1, 1.9, 2.3), resolution=4000.0,
    )  # fmt: skip


def _tidal_sea():
    import numpy as np

    from thalweg import Sea

    def east(time, lat, lon):
        return 0.5 * np.sin(time / 7000.0) + 0.0 * lat

    return Sea.from_functions(
        {"eastward_sea_water_velocity": east, "northward_sea_water_velocity": east}
    )
