"""Ctrl-C as a request to stop: long calculations end with the best result so far."""

from __future__ import annotations

import signal
import threading
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from types import TracebackType
from typing import Any, Protocol, TypeVar

from thalweg.core.errors import ThalwegWarning


class SearchInterrupted(Exception):
    """Raised out of a search that is stopped; the calculation that started it catches it."""


class InterruptGuard:
    """A context that notes Ctrl-C as a request to stop, from the call of `begin` on.

    Before `begin`, and when it is pressed a second time, Ctrl-C raises `KeyboardInterrupt` as
    usual. Only the main thread handles Ctrl-C, and only while no other handler is installed; in
    all other cases no request is ever noted.
    """

    def __init__(self) -> None:
        self._pressed = threading.Event()
        self._installed = False

    def __enter__(self) -> InterruptGuard:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._installed:
            signal.signal(signal.SIGINT, signal.default_int_handler)

    def begin(self) -> None:
        """Handle Ctrl-C from now on as a request to stop: there is a result to return."""
        main = threading.current_thread() is threading.main_thread()
        usual = signal.getsignal(signal.SIGINT) is signal.default_int_handler
        if self._installed or not (main and usual):
            return
        signal.signal(signal.SIGINT, self._note)
        self._installed = True

    def stopped(self) -> bool:
        """Return whether Ctrl-C has been pressed since `begin`."""
        return self._pressed.is_set()

    def _note(self, *_: Any) -> None:
        self._pressed.set()
        signal.signal(signal.SIGINT, signal.default_int_handler)


@contextmanager
def held_interrupt() -> Iterator[threading.Event]:
    """Hold Ctrl-C back in a context, so that what it writes is complete; only in the main thread.

    Yields
    ------
    threading.Event : It is set when Ctrl-C is pressed; what follows is up to the caller.
    """
    pressed = threading.Event()
    if threading.current_thread() is not threading.main_thread():
        yield pressed
        return
    before = signal.signal(signal.SIGINT, lambda *_: pressed.set())
    try:
        yield pressed
    finally:
        signal.signal(signal.SIGINT, before)


class _CancellableResult(Protocol):
    @property
    def cancelled(self) -> bool: ...


_ResultType = TypeVar("_ResultType", bound=_CancellableResult)


def cancel_on_interrupt(function: Callable[..., _ResultType]) -> Callable[..., _ResultType]:
    """Decorate a function with an argument ``cancel``: without it Ctrl-C cancels, with a warning.

    The result of the function has an attribute ``cancelled``.
    """

    @wraps(function)
    def run(*given: Any, **options: Any) -> _ResultType:
        if options.get("cancel") is not None:
            return function(*given, **options)
        with InterruptGuard() as guard:
            guard.begin()
            result = function(*given, **{**options, "cancel": guard.stopped})
        if result.cancelled:
            message = (
                "Stopped by Ctrl-C: the best result so far is kept; more time may find better."
            )
            warnings.warn(ThalwegWarning(message), stacklevel=2)
        return result

    return run
