"""Ctrl-C ends an evolution as cancelling it does: with the best so far."""

from __future__ import annotations

import signal
import threading
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from typing import Any, Protocol, TypeVar

from thalweg.core.errors import ThalwegWarning


class _CancellableResult(Protocol):
    @property
    def cancelled(self) -> bool: ...


_ResultType = TypeVar("_ResultType", bound=_CancellableResult)


@contextmanager
def interrupt_requested() -> Iterator[Callable[[], bool]]:
    """Give a function that tells whether Ctrl-C was pressed; pressed again, it interrupts.

    Only in the main thread, and only where nobody else handles Ctrl-C; else it is never true.
    """
    pressed = threading.Event()
    ours = threading.current_thread() is threading.main_thread()
    if not (ours and signal.getsignal(signal.SIGINT) is signal.default_int_handler):
        yield pressed.is_set
        return

    def note(*_: Any) -> None:
        pressed.set()
        signal.signal(signal.SIGINT, signal.default_int_handler)

    signal.signal(signal.SIGINT, note)
    try:
        yield pressed.is_set
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def cancel_on_interrupt(function: Callable[..., _ResultType]) -> Callable[..., _ResultType]:
    """Let Ctrl-C cancel a run that nothing else can cancel, with a warning."""

    @wraps(function)
    def run(*given: Any, **options: Any) -> _ResultType:
        if options.get("cancel") is not None:
            return function(*given, **options)
        with interrupt_requested() as cancel:
            found = function(*given, **{**options, "cancel": cancel})
        if found.cancelled:
            message = "Stopped by Ctrl-C: the best so far is kept; more time may find better."
            warnings.warn(ThalwegWarning(message), stacklevel=2)
        return found

    return run
