"""`JobStore`: jobs and their events in one SQLite file that survives a kill of the process."""

from __future__ import annotations

import json
import sqlite3
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from thalweg.service.problem_details import ServiceError, not_found

FINAL_STATES: Final = ("done", "failed", "cancelled")
STATES: Final = ("queued", "running", *FINAL_STATES)
_SCHEMA: Final = """
CREATE TABLE IF NOT EXISTS jobs (
    number INTEGER PRIMARY KEY AUTOINCREMENT,
    id TEXT NOT NULL UNIQUE, key TEXT UNIQUE, kind TEXT NOT NULL, state TEXT NOT NULL,
    request TEXT NOT NULL, attempt INTEGER NOT NULL DEFAULT 0,
    cancelling INTEGER NOT NULL DEFAULT 0, created REAL NOT NULL,
    started REAL, finished REAL, problem TEXT, summary TEXT
);
CREATE INDEX IF NOT EXISTS jobs_by_state ON jobs (state, number);
CREATE TABLE IF NOT EXISTS events (
    job TEXT NOT NULL, n INTEGER NOT NULL, at REAL NOT NULL, kind TEXT NOT NULL, data TEXT NOT NULL,
    PRIMARY KEY (job, n)
) WITHOUT ROWID;
"""
_COLUMNS: Final = (
    "number, id, kind, state, request, attempt, cancelling, created, started, finished, problem, "
    "summary"
)


@dataclass(frozen=True)
class Job:
    """One job as it is stored.

    Attributes
    ----------
    number : Order of arrival.
    kind : ``plan``, ``alternatives``, ``evaluation``, ``project``, ``study`` or ``forecast``.
    request : What was asked.
    attempt : How often it was started.
    cancelling : Whether it was asked to stop.
    created, started, finished : [s since 1970].
    problem : Why it failed, as problem details.
    summary : Key figures of its result; None where there is no result.
    """

    number: int
    id: str
    kind: str
    state: str
    request: dict[str, Any]
    attempt: int
    cancelling: bool
    created: float
    started: float | None
    finished: float | None
    problem: dict[str, Any] | None
    summary: dict[str, Any] | None


@dataclass(frozen=True)
class JobEvent:
    """One event of a job: its number, time [s since 1970], kind and data."""

    n: int
    at: float
    kind: str
    data: dict[str, Any]


class JobStore:
    """Jobs and events in SQLite, with a write-ahead log and complete synchronisation.

    Every method is one transaction, and can be called from any thread. What a method has returned
    from is on the disk. Reading has a connection of its own, and does not wait for the disk.

    Parameters
    ----------
    path : The database file.
    """

    def __init__(self, path: Path) -> None:
        self._lock = threading.Lock()
        self._reading_lock = threading.Lock()
        self._listeners: list[Callable[[str], None]] = []
        self._database = sqlite3.connect(path, check_same_thread=False, isolation_level=None)
        self._database.execute("PRAGMA journal_mode=WAL")
        self._database.execute("PRAGMA synchronous=FULL")
        self._database.executescript(_SCHEMA)
        self._reader = sqlite3.connect(path, check_same_thread=False, isolation_level=None)
        self._reader.execute("PRAGMA query_only=ON")

    def close(self) -> None:
        """Close the database."""
        with self._lock, self._reading_lock:
            self._reader.close()
            self._database.close()

    def _read(self, query: str, values: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
        with self._reading_lock:
            return self._reader.execute(query, values).fetchall()

    def listen(self, listener: Callable[[str], None]) -> None:
        """Call a function with the id of a job after each of its events."""
        self._listeners.append(listener)

    def _write(self, work: Callable[[sqlite3.Connection], Any], job: str) -> Any:
        with self._lock:
            self._database.execute("BEGIN IMMEDIATE")
            try:
                result = work(self._database)
            except BaseException:
                self._database.execute("ROLLBACK")
                raise
            self._database.execute("COMMIT")
        for listener in self._listeners:
            listener(job)
        return result

    def add(
        self, job_id: str, kind: str, request: dict[str, Any], *, key: str | None, queue: int
    ) -> tuple[Job, bool]:
        """Add a job to the queue.

        Parameters
        ----------
        key : Idempotency key: a second request with it returns the first job.
        queue : Most jobs that may wait.

        Returns
        -------
        job : Job
        new : bool
            Whether it was added now.

        Raises
        ------
        ServiceError
            409 if the key was used for another request, 429 if the queue is full.
        """
        try:
            text = json.dumps(request, sort_keys=True, allow_nan=False)
        except ValueError:
            raise ServiceError(
                422, "A number of the request is infinite or no number.", "", "Correct it."
            ) from None
        key = key or None  # an empty header is none

        def work(database: sqlite3.Connection) -> bool:
            found = (
                key
                and database.execute(
                    "SELECT request, kind FROM jobs WHERE key = ?", (key,)
                ).fetchone()
            )
            if found:
                if found != (text, kind):
                    raise ServiceError(
                        409,
                        "The idempotency key was used for another request.",
                        "Use each key for one request only.",
                        "Send another key, or none.",
                    )
                return False
            count = "SELECT count(*) FROM jobs WHERE state = 'queued'"
            if database.execute(count).fetchone()[0] >= queue:
                raise ServiceError(
                    429, f"{queue} jobs are waiting.", "No more are taken.", "Try again later."
                )
            now = time.time()
            database.execute(
                "INSERT INTO jobs (id, key, kind, state, request, created) "
                "VALUES (?, ?, ?, 'queued', ?, ?)",
                (job_id, key, kind, text, now),
            )
            _insert_event(database, job_id, "state", {"state": "queued"})
            return True

        new = self._write(work, job_id)
        return (self.get(job_id) if new else self._by_key(str(key))), new

    def get(self, job_id: str) -> Job:
        """Return a job.

        Raises
        ------
        ServiceError
            404 if there is none of this id.
        """
        return self._one("id = ?", job_id)

    def state_of(self, job_id: str) -> str | None:
        """Return the state of a job; None if there is none of this id."""
        rows = self._read("SELECT state FROM jobs WHERE id = ?", (job_id,))
        return str(rows[0][0]) if rows else None

    def _by_key(self, key: str) -> Job:
        return self._one("key = ?", key)

    def _one(self, where: str, value: str) -> Job:
        rows = self._read(f"SELECT {_COLUMNS} FROM jobs WHERE {where}", (value,))
        if not rows:
            raise not_found("job", value, "Jobs are listed at /api/v1/plans.")
        return _job(rows[0])

    def page(
        self, *, state: str | None = None, kind: str | None = None, before: int = 0, size: int = 50
    ) -> list[Job]:
        """Return jobs, the newest first.

        Parameters
        ----------
        state, kind : Only these.
        before : Only jobs with a smaller number; 0: all.
        size : Most jobs to return.
        """
        rows = self._read(
            f"SELECT {_COLUMNS} FROM jobs WHERE (? IS NULL OR state = ?) "
            "AND (? IS NULL OR kind = ?) AND (? = 0 OR number < ?) "
            "ORDER BY number DESC LIMIT ?",
            (state, state, kind, kind, before, before, size),
        )
        return [_job(row) for row in rows]

    def in_state(self, state: str) -> list[Job]:
        """Return all jobs of a state, the oldest first."""
        query = f"SELECT {_COLUMNS} FROM jobs WHERE state = ? ORDER BY number"
        return [_job(row) for row in self._read(query, (state,))]

    def counts(self) -> dict[str, int]:
        """Return the number of jobs in each state."""
        rows = self._read("SELECT state, count(*) FROM jobs GROUP BY state")
        return dict.fromkeys(STATES, 0) | {state: count for state, count in rows}

    def events(self, job_id: str, after: int = 0) -> list[JobEvent]:
        """Return the events of a job with a number above ``after``, in order."""
        rows = self._read(
            "SELECT n, at, kind, data FROM events WHERE job = ? AND n > ? ORDER BY n",
            (job_id, after),
        )
        return [JobEvent(n, at, kind, json.loads(data)) for n, at, kind, data in rows]

    def add_event(self, job_id: str, kind: str, data: dict[str, Any]) -> None:
        """Add an event to a job."""
        self._write(lambda database: _insert_event(database, job_id, kind, data), job_id)

    def start(self, job_id: str) -> bool:
        """Take a job out of the queue; return False if it is not there any more."""

        def work(database: sqlite3.Connection) -> bool:
            changed = database.execute(
                "UPDATE jobs SET state = 'running', started = ?, attempt = attempt + 1 "
                "WHERE id = ? AND state = 'queued'",
                (time.time(), job_id),
            ).rowcount
            if changed:
                _insert_event(database, job_id, "state", {"state": "running"})
            return bool(changed)

        return bool(self._write(work, job_id))

    def requeue(self, job_id: str, why: str, *, count_attempt: bool = True) -> None:
        """Return a running job to the queue, and state why in an event."""

        def work(database: sqlite3.Connection) -> None:
            database.execute(
                "UPDATE jobs SET state = 'queued', attempt = attempt - ? "
                "WHERE id = ? AND state = 'running'",
                (0 if count_attempt else 1, job_id),
            )
            _insert_event(database, job_id, "state", {"state": "queued", "why": why})

        self._write(work, job_id)

    def ask_to_stop(self, job_id: str, *, has_results: bool = False) -> Job:
        """Note that a job is to stop; one that waits is cancelled at once.

        Parameters
        ----------
        has_results : Whether it has results of an earlier start: it waits for a child that writes
            them.
        """

        def work(database: sqlite3.Connection) -> None:
            database.execute(
                "UPDATE jobs SET cancelling = 1 WHERE id = ? AND state IN ('queued', 'running')",
                (job_id,),
            )
            if has_results:
                return
            changed = database.execute(
                "UPDATE jobs SET state = 'cancelled', finished = ? WHERE id = ? AND state = "
                "'queued'",
                (time.time(), job_id),
            ).rowcount
            if changed:
                _insert_event(database, job_id, "state", {"state": "cancelled", "result": False})

        self._write(work, job_id)
        return self.get(job_id)

    def finish(
        self,
        job_id: str,
        state: str,
        *,
        summary: dict[str, Any] | None = None,
        problem: dict[str, Any] | None = None,
    ) -> None:
        """Give a running job its final state, with its last event, in one transaction."""

        def work(database: sqlite3.Connection) -> None:
            changed = database.execute(
                "UPDATE jobs SET state = ?, finished = ?, summary = ?, problem = ? "
                "WHERE id = ? AND state = 'running'",
                (state, time.time(), _text(summary), _text(problem), job_id),
            ).rowcount
            if changed:
                last = {"state": state, "result": summary is not None}
                if problem is not None:
                    last["problem"] = problem
                _insert_event(database, job_id, "state", last)

        self._write(work, job_id)

    def forget(self, job_id: str) -> None:
        """Remove a finished job and its events."""

        def work(database: sqlite3.Connection) -> None:
            database.execute("DELETE FROM events WHERE job = ?", (job_id,))
            database.execute("DELETE FROM jobs WHERE id = ?", (job_id,))

        self._write(work, job_id)


def _insert_event(database: sqlite3.Connection, job: str, kind: str, data: dict[str, Any]) -> None:
    database.execute(
        "INSERT INTO events (job, n, at, kind, data) VALUES "
        "(?, (SELECT coalesce(max(n), 0) + 1 FROM events WHERE job = ?), ?, ?, ?)",
        (job, job, time.time(), kind, json.dumps(data, allow_nan=False)),
    )


def _text(data: dict[str, Any] | None) -> str | None:
    return None if data is None else json.dumps(data, allow_nan=False)


def _job(row: tuple[Any, ...]) -> Job:
    number, name, kind, state, request, attempt, cancelling, created, started, finished = row[:10]
    problem, summary = (None if text is None else json.loads(text) for text in row[10:])
    return Job(
        number, name, kind, state, json.loads(request), attempt, bool(cancelling), created,
        started, finished, problem, summary,
    )  # fmt: skip
