"""Distances by sea that were found before, kept on disk.

A question is answered from the disk only by the same files of Thalweg and of the coastline as those
that found the answer. What cannot be read or written is found again.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import sqlite3
import sys
from collections.abc import Iterator
from dataclasses import dataclass, fields
from functools import cache
from pathlib import Path
from typing import Any, Final

from thalweg.chart.coast.gshhg import data_files
from thalweg.core.cache_folder import cache_folder
from thalweg.planning.network_selection.sea_distance_data import (
    DistanceRequest,
    SeaDistance,
)

_FILE: Final = "distances.sqlite3"
_MOST_KEPT: Final = 5_000  # the oldest answers are removed
_PATIENCE: Final = 2.0  # that another process may hold the file [s]
_TABLE: Final = "CREATE TABLE IF NOT EXISTS answers (question TEXT PRIMARY KEY, answer TEXT)"
_REMOVE_OLD: Final = (
    "DELETE FROM answers WHERE rowid <= (SELECT MAX(rowid) FROM answers) - ?"  # rows count upwards
)


@dataclass(frozen=True)
class KeptAnswer:
    """An answer from the disk; ``way`` is None where the answer was that there is none."""

    way: SeaDistance | None


@dataclass(frozen=True)
class DistanceQuestion:
    """What was asked, as text; empty for what cannot be written as JSON, which is not kept."""

    text: str

    @classmethod
    def of(cls, kind: str, request: DistanceRequest) -> DistanceQuestion:
        """Return a question of some kind."""
        with contextlib.suppress(TypeError, ValueError, RecursionError):
            return cls(json.dumps([kind, vars(request)], allow_nan=False))
        return cls("")

    def answer(self) -> KeptAnswer | None:
        """Return the answer that was kept; None without one."""
        if not self.text:
            return None
        with contextlib.suppress(OSError, sqlite3.Error, ValueError, TypeError, KeyError):
            with _database() as database:
                row = database.execute(
                    "SELECT answer FROM answers WHERE question = ?", (self._key(),)
                ).fetchone()
            if row is not None:
                found = json.loads(row[0])
                return KeptAnswer(None if found is None else _way_of(found))
        return None

    def keep(self, way: SeaDistance | None) -> None:
        """Keep the answer."""
        if not self.text:
            return
        try:
            text = json.dumps(None if way is None else _facts_of(way), allow_nan=False)
            with _database() as database:
                database.execute(
                    "INSERT OR REPLACE INTO answers (question, answer) VALUES (?, ?)",
                    (self._key(), text),
                )
                database.execute(_REMOVE_OLD, (_MOST_KEPT,))
        except sqlite3.DatabaseError as error:
            if not isinstance(error, sqlite3.OperationalError):  # the file is no database
                (cache_folder() / _FILE).unlink(missing_ok=True)
        except (OSError, ValueError):
            return

    def _key(self) -> str:
        return hashlib.sha256(f"{software_and_data()}\n{self.text}".encode()).hexdigest()


@cache
def software_and_data() -> str:
    """Return a fingerprint of the files of Thalweg and of the usual coastline."""
    package = Path(sys.modules["thalweg"].__path__[0])
    paths = [*_files_below(str(package)), *(os.stat(path) for path in data_files("i"))]
    facts = sorted((facts.st_ino, facts.st_size, facts.st_mtime_ns) for facts in paths)
    return hashlib.sha256(repr((str(package), facts)).encode()).hexdigest()


def _files_below(folder: str) -> Iterator[os.stat_result]:
    """Yield what is known of the files in a folder and its folders, without compiled code."""
    with os.scandir(folder) as entries:
        for entry in entries:
            if not entry.is_dir():
                yield entry.stat()
            elif entry.name != "__pycache__":
                yield from _files_below(entry.path)


@contextlib.contextmanager
def _database() -> Iterator[sqlite3.Connection]:
    """Open the file of answers; the transaction is committed unless an error is raised."""
    database = sqlite3.connect(cache_folder() / _FILE, timeout=_PATIENCE)
    with contextlib.closing(database), database:
        database.execute(_TABLE)
        yield database


def _facts_of(way: SeaDistance) -> dict[str, Any]:
    return {field.name: getattr(way, field.name) for field in fields(SeaDistance)}


def _way_of(facts: dict[str, Any]) -> SeaDistance:
    return SeaDistance(**{
        field.name: _as_tuples(facts[field.name]) for field in fields(SeaDistance)
    })  # fmt: skip


def _as_tuples(value: Any) -> Any:
    return tuple(_as_tuples(one) for one in value) if isinstance(value, list) else value
