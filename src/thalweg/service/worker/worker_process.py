"""The worker: a process that reads tasks from its input and writes results to its output.

Run with ``python -m thalweg.service.worker.worker_process BYTES``. A file that crashes a decoder,
or needs too much memory, ends this process and not the service.
"""

from __future__ import annotations

import json
import os
import struct
import sys
import traceback
import warnings
from typing import Any, Final

from thalweg.core.errors import ThalwegError, ThalwegWarning
from thalweg.service.problem_details import problem_of

HEADER: Final = struct.Struct("<II")  #: lengths of the JSON and of the bytes of an answer


def main() -> int:
    """Do tasks until the input ends."""
    output = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    _limit_memory(int(sys.argv[1]) if len(sys.argv) > 1 else 0)
    for line in sys.stdin.buffer:
        answer, data = _done(json.loads(line))
        text = json.dumps(answer, allow_nan=False).encode()
        output.write(HEADER.pack(len(text), len(data)) + text + data)
        output.flush()
    return 0


def _limit_memory(size: int) -> None:
    if size and sys.platform != "win32":
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (size, size))


def _done(task: dict[str, Any]) -> tuple[dict[str, Any], bytes]:
    from thalweg.service.worker.worker_tasks import TASKS

    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", ThalwegWarning)
            result, data = TASKS[task["task"]](task)
    except ThalwegError as error:
        return {"problem": problem_of(error)}, b""
    except MemoryError:
        return {"problem": None, "fault": "it needs too much memory"}, b""
    except Exception as error:  # noqa: BLE001 one task fails, not the worker
        traceback.print_exc()
        return {"problem": None, "fault": type(error).__name__}, b""
    notes = [str(w.message) for w in caught if issubclass(w.category, ThalwegWarning)]
    return {"result": result, "notes": notes}, data


if __name__ == "__main__":
    sys.exit(main())
