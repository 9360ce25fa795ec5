"""A child process for one job: it loads the libraries, waits for its order, and does it.

Run with ``python -m thalweg.service.jobs.job_child``.
"""

from __future__ import annotations

import json
import sys
import threading
import traceback
from typing import Any

from thalweg.core.errors import InputError, ThalwegError
from thalweg.service.jobs.child_messages import (
    MessageWriter,
    end_with_the_server,
    take_over_output,
)
from thalweg.service.problem_details import problem_of


def main() -> int:
    """Read one order from the standard input, do it, and send how it ended."""
    messages = take_over_output()
    order_read = threading.Event()
    threading.Thread(target=_load_libraries, args=(order_read,), daemon=True).start()
    line = sys.stdin.buffer.readline()
    order_read.set()
    if not line:
        return 0
    end_with_the_server()
    try:
        end = _ended(json.loads(line), messages)
    except KeyboardInterrupt:
        end = {"state": "cancelled"}
    messages.send("end", end)
    return 0


def _load_libraries(order_read: threading.Event) -> None:
    """Load what every plan needs while no order has come: imports, coastline, kernels."""
    import thalweg.planning  # noqa: F401
    from thalweg.chart import Chart

    if not order_read.is_set():
        Chart.gshhg("i")


def _ended(order: dict[str, Any], messages: MessageWriter) -> dict[str, Any]:
    from thalweg.service.jobs.job_order import JobOrder
    from thalweg.service.jobs.job_work import run_order

    job = JobOrder(**order)
    try:
        state, summary = run_order(job, messages)
        return {"state": state, "summary": summary}
    except ThalwegError as error:
        problem = json.dumps(problem_of(error), allow_nan=False)
        return {"state": "failed", "problem": json.loads(job.without_paths(problem))}
    except MemoryError:
        return {"state": "failed", "problem": problem_of(_memory_error())}
    except Exception as error:  # noqa: BLE001 a fault of the program ends one job, not the service
        traceback.print_exc()
        return {"state": "failed", "problem": problem_of(_program_error(error))}


def _memory_error() -> ThalwegError:
    return InputError(
        "The job needs more memory than there is.",
        "Memory grows with the length of the voyage and the fineness of the network.",
        "Give a coarser resolution, or fewer data.",
    )


def _program_error(error: Exception) -> ThalwegError:
    return ThalwegError(
        f"The program has a fault: {type(error).__name__}.",
        "The request itself may be right; the log file of the job holds the details.",
        "Please report it with the log file.",
    )


if __name__ == "__main__":
    sys.exit(main())
