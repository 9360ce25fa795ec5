"""Files that a plan or a route leaves in a folder."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import TYPE_CHECKING

from thalweg.core.errors import InputError
from thalweg.planning.profile_picture import draw_profile
from thalweg.route import Route, write_csv, write_geojson, write_gpx

if TYPE_CHECKING:
    from thalweg.planning.plan import Plan


def check_folder(folder: str | Path) -> Path:
    """Make a folder if needed and return it.

    Raises
    ------
    InputError
        If it cannot be made or written.
    """
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        writable = os.access(folder, os.W_OK)
    except OSError as error:
        raise _unwritable(folder, error.strerror or str(error)) from error
    if not writable:
        raise _unwritable(folder, "permission denied")
    return folder


def _unwritable(folder: Path, why: str) -> InputError:
    return InputError(
        f"The folder {folder} cannot be written: {why}.", "", "Choose another with --out."
    )


def write_plan(plan: Plan, folder: str | Path) -> list[Path]:
    """Write plan.json, the best route in three formats, and both pictures."""
    folder = check_folder(folder)
    plan.to_json(folder / "plan.json")
    files = [folder / "plan.json", *_write_formats(plan.best, folder)]
    plan.plot(folder / "map.png")
    draw_profile(plan.best, folder / "profile.png")
    return [*files, folder / "map.png", folder / "profile.png"]


def write_route(route: Route, folder: str | Path) -> list[Path]:
    """Write a route as route.json, in three formats, and its profile."""
    folder = check_folder(folder)
    text = json.dumps(route.as_dict(), indent=2, allow_nan=False)
    (folder / "route.json").write_text(text + "\n", encoding="utf-8")
    files = [folder / "route.json", *_write_formats(route, folder)]
    draw_profile(route, folder / "profile.png")
    return [*files, folder / "profile.png"]


def _write_formats(route: Route, folder: Path) -> list[Path]:
    writers = {"geojson": write_geojson, "gpx": write_gpx, "csv": write_csv}
    for suffix, write in writers.items():
        write(route, folder / f"route.{suffix}")
    return [folder / f"route.{suffix}" for suffix in writers]
