"""The order of a job as its child process receives it, and what all kinds of work share."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from thalweg.core.file_writing import write_text
from thalweg.core.units import HOUR
from thalweg.service.jobs.child_messages import MessageWriter
from thalweg.service.jobs.route_profiles import first_look

if TYPE_CHECKING:
    from thalweg.route import Route

#: Of the workspace: the result if the job is stopped before its own, complete with its summary.
FIRST_FOLDER: Final = "first"
FIRST_SUMMARY: Final = "summary.json"
STUDY_FOLDER: Final = "study"  #: of the workspace, with the voyages that are planned
_MOST_SHOWN: Final = 40  # stretches of a voyage whose routes are shown before the end


def route_file_stem(job_id: str) -> str:
    """Return the beginning of the names of the route files of a job."""
    return f"thalweg_{job_id[:6]}"


@dataclass(frozen=True)
class JobOrder:
    """What the server sends to a child.

    Attributes
    ----------
    kind : ``plan``, ``alternatives``, ``evaluation``, ``project``, ``study`` or ``forecast``.
    folder : Draft folder of the result, which exists.
    files : Paths of uploaded files by id.
    workspace : Folder that the attempts of the job share; it is removed when the job has ended.
    seas_folder : Folder of the uploaded seas.
    stopped : Whether the job is to stop at once, with the results of its earlier starts.
    """

    kind: str
    request: dict[str, Any]
    folder: str
    files: dict[str, str]
    workspace: str = ""
    seas_folder: str = ""
    stopped: bool = False

    @property
    def path(self) -> Path:
        """The draft folder."""
        return Path(self.folder)

    @property
    def first_path(self) -> Path:
        """Folder of the result that the job keeps if it is stopped before its own."""
        return Path(self.workspace or self.folder) / FIRST_FOLDER

    @property
    def stem(self) -> str:
        """Beginning of the names of route files, and so of the routes in them."""
        return route_file_stem(self.path.name)

    def write_json(self, name: str, data: Mapping[str, Any] | None) -> None:
        """Write a file of the result, if there are data; ids stand in place of paths."""
        if data is not None:
            write_text(self.path / name, self.without_paths(json.dumps(data, allow_nan=False)))

    def with_paths(self, data: Any) -> Any:
        """Return plain data in which the ids of uploaded files have become their paths."""
        if isinstance(data, Mapping):
            return {key: self.with_paths(value) for key, value in data.items()}
        if isinstance(data, list):
            return [self.with_paths(value) for value in data]
        return self.files.get(data, data) if isinstance(data, str) else data

    def without_paths(self, text: str) -> str:
        """Return a text in which no path of an uploaded file stands."""
        for name, path in self.files.items():
            for written in (json.dumps(path, allow_nan=False)[1:-1], path):
                text = text.replace(written, name)
        return text


class StageMessages:
    """Sends the stages of the work with the time since the start, and what is found until then."""

    def __init__(self, messages: MessageWriter) -> None:
        self._messages = messages
        self._start = time.monotonic()
        self._last = ""
        self._shown: dict[tuple[float, ...], float] = {}
        self.route: Route | None = None  # the one shown last

    def __call__(self, text: str) -> None:
        """State what begins now."""
        if text != self._last:
            self._last = text
            self._messages.send("stage", {"text": text, "after_s": self.seconds()})

    def show_route(self, route: Route) -> None:
        """Send a route found so far, if it is faster than those between the same places."""
        track = route.track
        ends = tuple(round(float(line[k]), 3) for line in (track.lat, track.lon) for k in (0, -1))
        if route.time_h < self._shown.get(ends, math.inf) and len(self._shown) < _MOST_SHOWN:
            self._shown[ends] = route.time_h
            self.route = route
            self._messages.send("route", {"route": first_look(route), "final": False})

    def show_front(self, points: Sequence[tuple[float, float]], unit: str) -> None:
        """Send a front found so far: hours and values."""
        rows = [[round(t / HOUR, 4), round(value, 4)] for t, value in sorted(points)]
        self._messages.send("front", {"points": rows, "unit": unit})

    def seconds(self) -> float:
        """Return the time since the start [s]."""
        return round(time.monotonic() - self._start, 2)
