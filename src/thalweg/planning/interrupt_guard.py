"""Interrupt handling: on Ctrl-C the best front so far is returned."""

from __future__ import annotations

from contextlib import ExitStack
from types import TracebackType

from thalweg.core.interrupt import interrupt_requested


class InterruptGuard:
    """Records Ctrl-C once there is a result to return.

    Before `begin` Ctrl-C interrupts as usual, and so does a second Ctrl-C.
    """

    def __init__(self) -> None:
        self._stack, self._pressed = ExitStack(), lambda: False
        self._active = False

    def __enter__(self) -> InterruptGuard:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._stack.close()

    def begin(self) -> None:
        """Handle Ctrl-C from now on: a route has been found."""
        if not self._active:
            self._pressed, self._active = self._stack.enter_context(interrupt_requested()), True

    def stopped(self) -> bool:
        """Return whether Ctrl-C was pressed after `begin`."""
        return self._pressed()


class SearchInterrupted(Exception):
    """Raised inside a search to abandon it; planning of a front catches it."""
