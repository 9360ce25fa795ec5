"""`WorkerClient`: gives tasks to a worker process, and starts another when one dies."""

from __future__ import annotations

import json
import subprocess
import sys
import threading
from typing import IO, Any, Final

from thalweg.core.errors import DatasetError
from thalweg.service.problem_details import ServiceError
from thalweg.service.worker.worker_process import HEADER

_MEMORY: Final = 12 * 2**30  # address space of a worker [bytes]


class ReportedProblem(ServiceError):
    """An error that the worker found, as it stated it."""

    def __init__(self, problem: dict[str, Any]) -> None:
        details = dict(problem.get("details") or {})
        details["field"] = problem.get("field")
        super().__init__(
            problem["status"], problem["asked"], problem["possible"], problem["remedy"], **details
        )
        self.name = problem["type"].rpartition("/")[2]

    def as_dict(self) -> dict[str, Any]:
        """Return the error with the class that it had in the worker."""
        return {**super().as_dict(), "error": self.name}


class WorkerClient:
    """One worker process, one task at a time; callers wait for their turn.

    Parameters
    ----------
    seconds : Longest time of a task [s]; then the process is ended.
    """

    def __init__(self, seconds: float) -> None:
        self._seconds = seconds
        self._turn = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None

    def do(self, task: str, **given: Any) -> tuple[dict[str, Any], bytes]:
        """Do a task.

        Parameters
        ----------
        task : A name of `thalweg.service.worker.worker_tasks.TASKS`.
        **given : Its values.

        Returns
        -------
        result : dict
            With ``notes``, the warnings of the library, where there are any.
        data : bytes

        Raises
        ------
        ThalwegError
            What the library raised, or that the file is too slow, too large or breaks its reader.
        """
        with self._turn:
            answer, data = self._exchange({"task": task, **given})
        if "result" in answer:
            notes = {"notes": answer["notes"]} if answer["notes"] else {}
            return {**answer["result"], **notes}, data
        if answer["problem"] is not None:
            raise ReportedProblem(answer["problem"])
        raise _unreadable(answer["fault"])

    def close(self) -> None:
        """End the process."""
        process = self._process
        if process is not None:
            process.kill()
            process.wait()

    def _exchange(self, task: dict[str, Any]) -> tuple[dict[str, Any], bytes]:
        process = self._running()
        late = threading.Event()

        def end_late() -> None:
            late.set()
            process.kill()

        timer = threading.Timer(self._seconds, end_late)
        timer.start()
        try:
            assert process.stdin is not None and process.stdout is not None
            process.stdin.write(json.dumps(task, allow_nan=False).encode() + b"\n")
            process.stdin.flush()
            sizes = HEADER.unpack(_read(process.stdout, HEADER.size))
            text, data = (_read(process.stdout, size) for size in sizes)
            return json.loads(text), data
        except (OSError, EOFError):
            process.kill()
            process.wait()
            self._process = None
            why = (
                f"it takes more than {self._seconds:g} s" if late.is_set() else "it ends its reader"
            )
            raise _unreadable(why) from None
        finally:
            timer.cancel()

    def _running(self) -> subprocess.Popen[bytes]:
        if self._process is None or self._process.poll() is not None:
            self._process = subprocess.Popen(
                [sys.executable, "-m", "thalweg.service.worker.worker_process", str(_MEMORY)],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                start_new_session=True,
            )
        return self._process


def _read(stream: IO[bytes], size: int) -> bytes:
    data = stream.read(size)
    if len(data) < size:
        raise EOFError
    return data


def _unreadable(why: str) -> DatasetError:
    return DatasetError(
        f"The file or field cannot be read: {why}.",
        "Files are read within limits of time and memory.",
        "Check the file with 'thalweg inspect', or cut it to a smaller area and period.",
        field="file",
    )
