"""Files of dredging projects, waiting studies and track analyses."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

from thalweg.core.file_writing import make_folder, write_csv_rows, write_text
from thalweg.operations.dredging.cycle_records import CYCLE_COLUMNS, cycle_record
from thalweg.operations.plots import draw_project, draw_routes, draw_tracks, draw_waiting

if TYPE_CHECKING:
    from thalweg.operations.dredging.project_result import ProjectResult
    from thalweg.operations.tracks.track_analysis import TrackAnalysis
    from thalweg.operations.waiting.waiting_study import WaitingStudy

_TIME_FORMAT = "%Y-%m-%dT%H:%M:%SZ"


def write_project_files(result: ProjectResult, folder: str | Path) -> list[Path]:
    """Write project.json, cycles.csv, project.png and routes.png, and return their paths.

    Parameters
    ----------
    folder : Created if it does not exist.

    Raises
    ------
    InputError : If the folder cannot be written.
    """
    folder = make_folder(folder)
    result.to_json(folder / "project.json")
    records = [{"run": run.name, **cycle_record(c)} for run in result.runs for c in run.cycles]
    columns = ("run", *CYCLE_COLUMNS)
    rows = [[record.get(name) for name in columns] for record in records]
    write_csv_rows(folder / "cycles.csv", [columns, *rows])
    draw_project(result, folder / "project.png")
    draw_routes(result, folder / "routes.png")
    names = ("project.json", "cycles.csv", "project.png", "routes.png")
    return [folder / name for name in names]


def write_waiting_files(study: WaitingStudy, folder: str | Path, *, title: str = "") -> list[Path]:
    """Write waiting.csv, waiting.json and waiting.png, and return their paths.

    Parameters
    ----------
    folder : Created if it does not exist.
    title : Title of the plot.

    Raises
    ------
    InputError : If the folder cannot be written.
    """
    folder = make_folder(folder)
    write_text(folder / "waiting.csv", study.to_frame().to_csv(index=False))
    text = json.dumps(study.as_dict(), indent=2, allow_nan=False)
    write_text(folder / "waiting.json", text)
    draw_waiting(study, folder / "waiting.png", title=title)
    return [folder / name for name in ("waiting.csv", "waiting.json", "waiting.png")]


def write_track_files(analysis: TrackAnalysis, folder: str | Path) -> list[Path]:
    """Write activities.csv, legs.csv, cycles.csv, tracks.json and tracks.png; return their paths.

    Parameters
    ----------
    folder : Created if it does not exist.

    Raises
    ------
    InputError : If the folder cannot be written.
    """
    folder = make_folder(folder)
    frames = {
        "activities.csv": analysis.activity_frame(),
        "legs.csv": analysis.leg_frame(),
        "cycles.csv": analysis.cycle_frame(),
    }
    for name, frame in frames.items():
        write_text(folder / name, frame.to_csv(index=False, date_format=_TIME_FORMAT))
    text = json.dumps(analysis.as_dict(), indent=2, allow_nan=False)
    write_text(folder / "tracks.json", text)
    draw_tracks(analysis, folder / "tracks.png")
    return [folder / name for name in (*frames, "tracks.json", "tracks.png")]
