"""A child process for one job: it loads the libraries, waits for its order, and does it.

Run with ``python -m thalweg.service.jobs.job_child``.
"""

from __future__ import annotations

import json
import os
import sys
import threading
import traceback
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Final

from thalweg.core.errors import InputError, ThalwegError
from thalweg.core.interrupt import SearchInterrupted, held_interrupt
from thalweg.service.jobs.child_messages import (
    MessageWriter,
    end_with_the_server,
    take_over_output,
)
from thalweg.service.problem_details import problem_of

if TYPE_CHECKING:
    from thalweg.chart import Chart

_NICENESS: Final = 5
_SPACING_M: Final = 3700.0  # of the network of the short voyage


def main() -> int:
    """Read one order from the standard input, do it, and send how it ended."""
    messages = take_over_output()
    order_read = threading.Event()
    _yield_to_the_server()
    loading = threading.Thread(target=_load_libraries, args=(order_read,), daemon=True)
    loading.start()
    line = sys.stdin.buffer.readline()
    order_read.set()
    if not line:
        return 0
    end_with_the_server()
    order = json.loads(line)
    try:
        with held_interrupt() as stopped:
            loading.join()  # two threads that import the same modules can each find half of one
        if stopped.is_set():
            order["stopped"] = True
        if order["stopped"] and order["kind"] != "study":
            raise KeyboardInterrupt
        end = _ended(order, messages)
    except KeyboardInterrupt:
        end = {"state": "cancelled"}
    messages.send("end", end)
    return 0


def _yield_to_the_server() -> None:
    """Leave the processor to the server where both want it: it answers while jobs calculate."""
    if hasattr(os, "nice"):
        os.nice(_NICENESS)


def _load_libraries(order_read: threading.Event) -> None:
    """Load what every plan needs while no order has come: imports, coastline, kernels.

    The voyage that is planned for this is short, on a coarse network; it loads the compiled
    kernels, the control areas and the traffic lanes, which take longer than itself.
    """
    import thalweg.planning
    import thalweg.service.jobs.job_work  # noqa: F401
    from thalweg.chart import Chart

    if order_read.is_set():
        return
    chart = Chart.gshhg("i")
    if not order_read.is_set():
        with suppress(ThalwegError, SearchInterrupted):
            _plan_short_voyage(chart, order_read)


def _plan_short_voyage(chart: Chart, order_read: threading.Event) -> None:
    """Plan a voyage of 25 nm; it ends as soon as there is an order."""
    from thalweg.planning import Voyage, plan
    from thalweg.sea import Sea
    from thalweg.ship import Ship

    voyage = Voyage(start=(47.0, -20.0), goal=(47.3, -19.5), depart="1998-08-31T12:00Z")
    ship = Ship.load("handysize-bulker")

    def stop_for_order(_: str) -> None:
        if order_read.is_set():
            raise SearchInterrupted

    sea = Sea.storm()
    plan(
        voyage, ship=ship, sea=sea, chart=chart, resolution=_SPACING_M, proof=0.0,
        progress=stop_for_order,
    )  # fmt: skip


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
    code = main()
    sys.stderr.flush()
    os._exit(code)  # at an ordinary end Python aborts: a thread still reads the input
