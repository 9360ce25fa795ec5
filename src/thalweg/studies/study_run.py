"""`run_study`: all rows of a study, here, in processes of this computer, or on a Dask cluster.

Finished rows are on disk: a study that was stopped, killed or extended does only what is missing.
Results do not depend on the number of workers.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from thalweg.chart.ports import place_positions
from thalweg.core.errors import InputError
from thalweg.core.file_writing import make_folder, taken_lock
from thalweg.planning.voyage import Voyage
from thalweg.studies.row_runner import run_rows, ship_of_request
from thalweg.studies.study import Study, StudyRow
from thalweg.studies.study_checks import canonical_json
from thalweg.studies.study_parts import read_parts, require_parquet, write_part, write_study

LOCK_FILE = "lock"  #: of a folder in which a study runs
CHUNK = 20  #: rows of a part
ATTEMPTS = 3  #: of a chunk whose worker dies
_AHEAD = 3  # chunks per worker that wait in a cluster
_SHARES = 4  # least number of chunks for each process, so that short studies use all of them
_CLUSTER = 16  # processes of a cluster that short studies are cut for
_KEEP_S = 20.0  # rows are written at least this often, but for the one under way

Chunk = list[StudyRow]


@dataclass(frozen=True)
class StudyProgress:
    """How far a study is.

    Attributes
    ----------
    done, total : int
        Rows with a result, and all rows.
    refused : int
        Rows of this run without a route, or whose route exceeds a limit.
    seconds : float
        Since the start of this run [s].
    new : int
        Rows done in this run.
    rows : tuple of mapping
        Results of the rows just done, as `run_rows` returns them.
    """

    done: int
    total: int
    refused: int
    seconds: float
    new: int
    rows: tuple[Mapping[str, Any], ...] = ()

    @property
    def seconds_left(self) -> float | None:
        """Estimate of the time that the rest takes [s]; None before the first result."""
        return self.seconds / self.new * (self.total - self.done) if self.new else None


def run_study(
    study: Study,
    out: str | Path,
    *,
    workers: int = 0,
    scheduler: str | None = None,
    chunk: int = CHUNK,
    progress: Callable[[StudyProgress], None] | None = None,
) -> StudyProgress:
    """Run the rows of a study that have no result yet.

    Parameters
    ----------
    study : Study
    out : path
        Folder of the results: ``study.json`` and Parquet files in ``parts``.
    workers : int
        Processes of this computer; 0: in this process.
    scheduler : str, optional
        Address of a Dask scheduler, such as ``tcp://host:8786``, whose workers have Thalweg and
        the files of the study.
    chunk : int
        Rows that are done together, 1 or more (fewer where there are fewer for each process);
        finished chunks survive a stop.
    progress : callable, optional
        Called after each chunk.

    Returns
    -------
    StudyProgress
        The state at the end.

    Raises
    ------
    InputError
        If a place of the study is no port; the folder cannot be written, holds results of another
        study only, or another process runs a study there; or pyarrow or distributed is not
        installed.
    """
    require_parquet()
    if chunk < 1 or workers < 0:
        raise InputError(
            f"{workers} workers with chunks of {chunk} were requested.",
            "Workers are 0 or more, chunks hold 1 row or more.",
            "Correct the numbers.",
        )
    folder = Path(out)
    with _taken(make_folder(folder)):
        return _run_missing(study, folder, (workers, scheduler, chunk), progress)


@contextlib.contextmanager
def _taken(folder: Path) -> Iterator[None]:
    """Hold the folder of a study, so that no other process plans the same rows."""
    try:
        lock = taken_lock(folder / LOCK_FILE)
    except BlockingIOError:
        raise InputError(
            f"Another process runs a study in {str(folder)!r}.",
            "Each study has one driver at a time; --workers gives it more processes.",
            "Wait for it, stop it, or give another folder.",
            field="out",
        ) from None
    try:
        yield
    finally:
        if lock is not None:
            os.close(lock)


def _run_missing(
    study: Study,
    folder: Path,
    how: tuple[int, str | None, int],
    progress: Callable[[StudyProgress], None] | None,
) -> StudyProgress:
    """Run the rows without a result by some workers, or a scheduler, in chunks."""
    workers, scheduler, chunk = how
    rows = list({row.id: row for row in study.rows()}.values())
    _check_voyages(study, rows)
    _check_single_ship(study, rows)
    known = set(read_parts(folder, ["id"])["id"])
    if known and known.isdisjoint(row.id for row in rows):
        raise InputError(
            f"The folder {str(folder)!r} holds {len(known)} results of another study.",
            "None of them is a row of this study, and the summary would hide them.",
            "Give another folder, or remove this one.",
            field="out",
        )
    write_study(study, folder)
    missing = [row for row in rows if row.id not in known]
    processes = workers if scheduler is None else _CLUSTER
    if processes:
        chunk = min(chunk, -(-len(missing) // (_SHARES * processes)) or 1)
    chunks = study.chunks(missing, chunk)
    begin, refused, done = time.monotonic(), 0, 0
    state = StudyProgress(len(rows) - len(missing), len(rows), 0, 0.0, 0)
    for results in _results(chunks, str(study.folder), workers, scheduler):
        write_part(results, folder)
        done += len(results)
        refused += sum(not has_route(result) for result in results)
        state = StudyProgress(
            len(rows) - len(missing) + done, len(rows), refused, time.monotonic() - begin, done,
            tuple(results),
        )  # fmt: skip
        if progress is not None:
            progress(state)
    return state


def has_route(result: Mapping[str, Any]) -> bool:
    """Return whether a row has a route that keeps the limits."""
    feasible = result.get("feasible")
    return result["refusal"] is None and (feasible is None or bool(feasible))


def _check_voyages(study: Study, rows: list[StudyRow]) -> None:
    """Raise the error of a voyage that is none, before any is planned; a sample may draw some.

    A start or goal that is no port is an error in any case.
    """
    for row in rows if not study.sample else ():
        Voyage.from_dict(row.request["voyage"])
    ends = (row.request["voyage"].get(end) for row in rows for end in ("start", "goal"))
    place_positions(dict.fromkeys(end for end in ends if isinstance(end, str)))


def _check_single_ship(study: Study, rows: list[StudyRow]) -> None:
    """Raise the error of a ship that all rows share; one of several is a refusal of its rows."""
    names = ("ship", "load_factor", "limits", "charges")
    ships = {canonical_json([row.request.get(name) for name in names]) for row in rows}
    if len(ships) == 1:
        ship_of_request(rows[0].request, str(study.folder))


def _results(
    chunks: list[Chunk], folder: str, workers: int, scheduler: str | None
) -> Iterator[list[dict[str, Any]]]:
    if not chunks:
        return iter(())
    if scheduler is not None:
        return _on_cluster(chunks, folder, scheduler)
    if workers > 0:
        return _in_processes(chunks, folder, workers)
    return _in_this_process(chunks, folder)


def _in_this_process(chunks: list[Chunk], folder: str) -> Iterator[list[dict[str, Any]]]:
    """Yield the results of chunks, of long ones in parts; after Ctrl-C those that are finished."""
    for chunk in chunks:
        left = chunk
        while left:
            done: list[dict[str, Any]] = []
            try:
                for results in _in_turns(left, folder):
                    done += results
            except KeyboardInterrupt:
                if done:
                    yield done
                raise
            yield done
            left = left[len(done) :]


def run_for_a_while(rows: Chunk, folder: str) -> list[dict[str, Any]]:
    """Return the results of the first rows of a chunk: as many as are done in 20 seconds."""
    return [result for results in _in_turns(rows, folder) for result in results]


def _in_turns(rows: Chunk, folder: str) -> Iterator[list[dict[str, Any]]]:
    """Yield the results of rows one by one for `_KEEP_S`, or those of one network together."""
    if all(row.request.get("detail") == "network" for row in rows):
        yield run_rows(rows, folder)
        return
    begin = time.monotonic()
    for row in rows:
        yield run_rows([row], folder)
        if time.monotonic() - begin >= _KEEP_S:
            return


def _in_processes(chunks: list[Chunk], folder: str, workers: int) -> Iterator[list[dict[str, Any]]]:
    """Yield the results of chunks, of long ones in parts, as processes finish them.

    A chunk whose process dies is tried again, and in the end refused.
    """
    waiting, attempts = list(reversed(chunks)), Counter[str]()
    while waiting:
        pool = ProcessPoolExecutor(
            workers, multiprocessing.get_context("spawn"), _prepare_worker, (os.getpid(),)
        )
        running: dict[Future[list[dict[str, Any]]], Chunk] = {}
        try:
            while waiting or running:
                while waiting and len(running) < workers:
                    one = waiting[-1]  # a pool whose process died raises here too
                    running[pool.submit(run_for_a_while, one, folder)] = one
                    waiting.pop()
                finished, _ = wait(running, return_when=FIRST_COMPLETED)
                for future in finished:
                    results = future.result()
                    left = running.pop(future)[len(results) :]
                    if left:
                        waiting.append(left)
                    yield results
        except BrokenProcessPool:
            for one in running.values():
                attempts[one[0].id] += 1
                if attempts[one[0].id] < ATTEMPTS:
                    waiting.append(one)
                else:
                    yield _refused(one)
        finally:
            _stop(pool, at_once=bool(waiting or running))


def _stop(pool: ProcessPoolExecutor, *, at_once: bool) -> None:
    """End the processes of a pool, and its thread; at once: after Ctrl-C no row goes on."""
    if at_once:
        for process in list((pool._processes or {}).values()):
            process.terminate()
    pool.shutdown(wait=True, cancel_futures=True)  # else its thread may fail as Python ends


def _refused(chunk: Chunk) -> list[dict[str, Any]]:
    """Return the results of rows whose process died every time."""
    reason = f"The process that planned this voyage died {ATTEMPTS} times (out of memory?)."
    return [
        {"id": row.id, **row.labels, "refusal": "WorkerDied", "reason": reason} for row in chunk
    ]


def _prepare_worker(parent: int) -> None:
    """Let Ctrl-C reach the driver alone, and end this process when the driver has died."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(1.0)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


def _on_cluster(chunks: list[Chunk], folder: str, scheduler: str) -> Iterator[list[dict[str, Any]]]:
    """Yield the results of chunks as the workers of a Dask cluster finish them."""
    try:
        from distributed import Client, as_completed
    except ImportError as error:
        raise InputError(
            "A cluster needs the package distributed.",
            "Without it, --workers uses the processors of this computer.",
            "pip install 'thalweg[cluster]'",
        ) from error
    try:
        client = Client(scheduler, timeout="20s")
    except (OSError, ValueError, TimeoutError) as error:
        raise InputError(
            f"The scheduler {scheduler} cannot be reached: {error}.",
            "A Dask scheduler has an address such as tcp://host:8786.",
            "Check the address, or start one with dask scheduler.",
        ) from error
    with client:
        workers = max(len(client.scheduler_info()["workers"]), 1)
        left = iter(chunks)
        first = [chunk for _, chunk in zip(range(_AHEAD * workers), left)]

        def submit(chunk: Chunk) -> Any:
            return client.submit(run_rows, chunk, folder, pure=False, retries=ATTEMPTS - 1)

        pending = {submit(chunk): chunk for chunk in first}
        completed = as_completed(pending)
        for future in completed:
            chunk = pending.pop(future)
            yield future.result() if future.status == "finished" else _refused(chunk)
            following = next(left, None)
            if following is not None:
                another = submit(following)
                pending[another] = following
                completed.add(another)
