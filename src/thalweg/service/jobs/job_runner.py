"""`JobRunner`: starts a child process for each job, follows it, and keeps its result."""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any, Final

from thalweg.core.errors import InputError, ThalwegError
from thalweg.core.file_writing import make_folder, write_text
from thalweg.service.jobs.job_order import FIRST_FOLDER, FIRST_SUMMARY, STUDY_FOLDER
from thalweg.service.jobs.job_store import FINAL_STATES, Job, JobStore
from thalweg.service.problem_details import problem_of
from thalweg.service.service_settings import ServiceLimits, ServiceSettings

_CHECK_SECONDS: Final = 0.5  # between checks of time and memory
_FIRST_ROUTE_SECONDS: Final = 20.0  # a job has the processor to itself so long for a first route
_LOG: Final = "log.txt"


@dataclass
class RunningChild:
    """A child process and what is known of it."""

    process: subprocess.Popen[bytes]
    log: Path
    started: float = field(default_factory=time.monotonic)
    stop_asked: float | None = None
    stopped_why: ThalwegError | None = None
    has_shown: bool = False  # a route or a front

    @property
    def seeks_first_route(self) -> bool:
        """Whether it calculates, and people have seen nothing of it yet."""
        return not self.has_shown and time.monotonic() - self.started < _FIRST_ROUTE_SECONDS

    def kill(self) -> None:
        """End the process at once."""
        self.process.kill()


class JobRunner:
    """Runs the jobs of a store, each in a child process of its own.

    One further child waits with the libraries loaded, so that a job starts at once; where no job
    could start, it begins to load when those that run have shown something. A job whose
    child dies is started again, up to a limit; a job found running at the start of the service
    always is.

    Parameters
    ----------
    files_of : Returns the paths of the uploaded files of a request by id.
    """

    def __init__(
        self,
        store: JobStore,
        settings: ServiceSettings,
        files_of: Callable[[dict[str, Any]], dict[str, str]],
    ) -> None:
        self._store = store
        self._files_of = files_of
        self._results = settings.subfolder("results")
        self._drafts = settings.subfolder("drafts")
        self._workspaces = settings.subfolder("workspaces")
        self._seas = settings.subfolder("seas")
        self._limits: ServiceLimits = settings.limits
        self._children: dict[str, RunningChild] = {}
        self._waiting_child: RunningChild | None = None
        self._changed = threading.Condition()
        self._ending = False

    def start(self) -> None:
        """Return interrupted jobs to the queue, and begin."""
        for job in self._store.in_state("running"):
            self._recover(job)
        for left in self._drafts.iterdir():
            shutil.rmtree(left, ignore_errors=True)
        for left in self._workspaces.iterdir():
            self._clear_workspace(left.name)
        for work in (self._dispatch, self._watch):
            threading.Thread(target=work, daemon=True).start()

    def stop(self) -> None:
        """End all children; their jobs return to the queue for the next start."""
        with self._changed:
            self._ending = True
            self._changed.notify_all()
            children = [*self._children.values()]
            if self._waiting_child is not None:
                children.append(self._waiting_child)
        for child in children:
            child.kill()
        deadline = time.monotonic() + 10.0
        with self._changed:
            while self._children and time.monotonic() < deadline:
                self._changed.wait(0.2)
        for child in children:
            child.process.wait()

    def wake(self) -> None:
        """Look for a job in the queue."""
        with self._changed:
            self._changed.notify_all()

    def cancel(self, job_id: str) -> Job:
        """Ask a job to stop; what it has found so far is kept."""
        job = self._store.ask_to_stop(job_id, has_results=self._has_results(job_id))
        with self._changed:
            child = self._children.get(job_id)
            if child is not None and child.stop_asked is None:
                child.stop_asked = time.monotonic()
                child.process.send_signal(signal.SIGINT)
        return job

    def result_folder(self, job_id: str) -> Path:
        """Return the folder of the result of a job; it exists when the job has one."""
        return self._results / job_id

    def discard(self, job_id: str) -> None:
        """Remove the result of a job."""
        shutil.rmtree(self._results / job_id, ignore_errors=True)

    def _has_results(self, job_id: str) -> bool:
        """Return whether earlier starts of a job left results that its next start can write."""
        left = self._workspaces / job_id
        is_first = (left / FIRST_FOLDER / FIRST_SUMMARY).exists()
        return is_first or any((left / STUDY_FOLDER).glob("parts/part-*"))

    def _clear_workspace(self, job_id: str) -> None:
        """Remove what the attempts of a job share, when there will be no further attempt."""
        if self._store.state_of(job_id) in (*FINAL_STATES, None):
            shutil.rmtree(self._workspaces / job_id, ignore_errors=True)

    def _recover(self, job: Job) -> None:
        """Give a job that was running when the service ended its result, or another start."""
        kept = self._results / job.id / "end.json"
        if kept.exists():
            end = json.loads(kept.read_text("utf-8"))
            self._store.finish(job.id, end["state"], summary=end["summary"])
        elif job.cancelling and not self._has_results(job.id):
            self._store.finish(job.id, "cancelled")
        else:  # not the fault of the job
            self._store.requeue(job.id, "the service was stopped", count_attempt=False)

    def _again_or_fail(self, job: Job, why: str) -> None:
        if job.attempt < self._limits.attempts:
            self._store.requeue(job.id, why)
            return
        error = ThalwegError(
            f"The job was started {job.attempt} times, and each time its process ended: {why}.",
            "A job is tried again when its process is stopped from outside.",
            "Look at the memory of this computer; a coarser resolution needs less.",
        )
        self._store.finish(job.id, "failed", problem=problem_of(error, 500))

    def _dispatch(self) -> None:
        """Start jobs while there are free places, in the order of their arrival."""
        while True:
            with self._changed:
                if self._ending:
                    return
                free = self._limits.workers - len(self._children)
                queued = self._store.in_state("queued") if free > 0 else []
                for job in queued[:free]:
                    if self._store.start(job.id):
                        self._launch(self._store.get(job.id))
                child = self._waiting_child
                if (child is None or child.process.poll() is not None) and self._may_load():
                    self._waiting_child = self._new_child()
                self._changed.wait(2.0)

    def _may_load(self) -> bool:
        """Return whether the next child may load its libraries beside those that calculate."""
        children = self._children.values()
        full = len(children) >= self._limits.workers
        return not (full and any(child.seeks_first_route for child in children))

    def _launch(self, job: Job) -> None:
        """Send a job to the child that waits; the lock is held."""
        child = self._waiting_child
        if child is None or child.process.poll() is not None:
            child = self._new_child()
        self._waiting_child = None
        child.started = time.monotonic()
        if job.cancelling:
            child.stop_asked = child.started
        self._children[job.id] = child
        threading.Thread(target=self._follow, args=(job, child), daemon=True).start()

    def _new_child(self) -> RunningChild:
        log = self._drafts / f"child-{time.monotonic_ns()}.log"
        with log.open("wb") as errors:
            process = subprocess.Popen(
                [sys.executable, "-m", "thalweg.service.jobs.job_child"],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=errors,
                start_new_session=True,  # Ctrl-C in the terminal of the server is not for it
            )
        return RunningChild(process, log)

    def _follow(self, job: Job, child: RunningChild) -> None:
        """Send a job to its child, store its events, and keep its result."""
        folder = self._drafts / f"{job.id}-{job.attempt}"
        end: dict[str, Any] | None = None
        try:
            folder.mkdir(exist_ok=True)
            self._send_order(job, child, folder)
            for message in _messages_of(child.process.stdout):
                kind = message.pop("kind")
                if kind == "end":
                    end = message
                else:
                    self._store.add_event(job.id, kind, message)
                    if kind in ("route", "front") and not child.has_shown:
                        child.has_shown = True
                        self.wake()
            child.process.wait()
            self._end(job, child, folder, end)
        except ThalwegError as error:
            child.kill()
            self._store.finish(job.id, "failed", problem=problem_of(error))
        finally:
            child.process.wait()
            for stream in (child.process.stdin, child.process.stdout):
                if stream is not None:
                    with contextlib.suppress(OSError, ValueError):
                        stream.close()
            child.log.unlink(missing_ok=True)
            shutil.rmtree(folder, ignore_errors=True)
            self._clear_workspace(job.id)
            with self._changed:
                self._children.pop(job.id, None)
                self._changed.notify_all()

    def _send_order(self, job: Job, child: RunningChild, folder: Path) -> None:
        order = {
            "kind": job.kind,
            "request": job.request,
            "folder": str(folder),
            "files": self._files_of(job.request),
            "workspace": str(make_folder(self._workspaces / job.id)),
            "seas_folder": str(self._seas),
            "stopped": job.cancelling,
        }
        assert child.process.stdin is not None
        with contextlib.suppress(OSError, ValueError):
            child.process.stdin.write(json.dumps(order, allow_nan=False).encode() + b"\n")
            child.process.stdin.flush()

    def _end(
        self,
        job: Job,
        child: RunningChild,
        folder: Path,
        end: dict[str, Any] | None,
    ) -> None:
        """Keep the result of a child that has ended, and give its job the next state."""
        if self._ending and end is None:
            self._store.requeue(job.id, "the service was stopped", count_attempt=False)
            return
        if end is not None and "summary" in end:
            self._keep(job, child, folder, end["state"], end["summary"])
        elif end is not None and end["state"] == "failed" and child.stop_asked is None:
            self._keep_log(job, child)
            self._store.finish(job.id, "failed", problem=end["problem"])
        elif child.stopped_why is not None:
            self._store.finish(job.id, "failed", problem=problem_of(child.stopped_why))
        elif child.stop_asked is not None:
            if end is not None and end["state"] == "failed":  # a fault while it stopped
                self._keep_log(job, child)
            first = self._workspaces / job.id / FIRST_FOLDER
            if (first / FIRST_SUMMARY).exists():  # of this start, or of an earlier one
                summary = json.loads((first / FIRST_SUMMARY).read_text("utf-8"))
                self._keep(job, child, first, "cancelled", summary)
            elif not job.cancelling and self._has_results(job.id):  # stopped while it started
                self._store.requeue(job.id, "its results are written", count_attempt=False)
            else:
                self._store.finish(job.id, "cancelled")
        else:
            code = child.process.returncode
            self._again_or_fail(self._store.get(job.id), f"its process ended with {code}")

    def _keep(
        self, job: Job, child: RunningChild, folder: Path, state: str, summary: dict[str, Any]
    ) -> None:
        """Give a complete result its place, then state that the job has ended."""
        shutil.copyfile(child.log, folder / _LOG)
        end = folder / "end.json"
        write_text(end, json.dumps({"state": state, "summary": summary}, allow_nan=False))
        for path in (*folder.iterdir(), folder):
            _synchronise(path)
        place = self._results / job.id
        if not place.exists():
            os.rename(folder, place)
        _synchronise(self._results)
        self._store.finish(job.id, state, summary=summary)

    def _keep_log(self, job: Job, child: RunningChild) -> None:
        logs = self._results.parent / "logs"
        logs.mkdir(exist_ok=True)
        shutil.copyfile(child.log, logs / f"{job.id}.txt")

    def _watch(self) -> None:
        """End children that take too long, need too much memory, or do not stop when asked."""
        while not self._ending:
            time.sleep(_CHECK_SECONDS)
            with self._changed:
                children = list(self._children.values())
            for child in children:
                self._check(child)

    def _check(self, child: RunningChild) -> None:
        now, limits = time.monotonic(), self._limits
        if child.process.poll() is not None:
            return
        if child.stop_asked is not None and now - child.stop_asked > limits.cancel_seconds:
            child.kill()
        elif now - child.started > limits.job_seconds:
            child.stopped_why = InputError(
                f"The job took more than {limits.job_seconds:g} s.",
                "Jobs are ended after this time.",
                "Give a coarser resolution or a shorter voyage, or start the service with a longer "
                "--job-time.",
            )
            child.kill()
        elif _resident_bytes(child.process.pid) > limits.job_bytes:
            child.stopped_why = InputError(
                f"The job needed more than {limits.job_bytes / 1e9:.1f} GB of memory.",
                "Jobs that need more are ended.",
                "Give a coarser resolution, or data of a smaller area and period.",
            )
            child.kill()


def _messages_of(stream: IO[bytes] | None) -> Any:
    assert stream is not None
    for line in stream:
        try:
            message = json.loads(line)
        except ValueError:  # half a line of a process that was killed
            continue
        yield message


def _synchronise(path: Path) -> None:
    """Wait until a file or folder is on the disk."""
    try:
        handle = os.open(path, os.O_RDONLY)
    except OSError:  # folders cannot be opened on every system
        return
    with contextlib.suppress(OSError):
        os.fsync(handle)
    os.close(handle)


def _resident_bytes(process: int) -> int:
    """Return the resident memory of a process [bytes]; 0 where the system does not state it."""
    try:
        pages = int(Path(f"/proc/{process}/statm").read_text().split()[1])
    except (OSError, ValueError, IndexError):
        return 0
    return pages * os.sysconf("SC_PAGE_SIZE")
