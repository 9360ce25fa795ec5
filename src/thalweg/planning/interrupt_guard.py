"""Ctrl-C while a front is planned: what has been found by then is kept."""

from __future__ import annotations

from contextlib import ExitStack
from types import TracebackType

from thalweg.core.interrupt import interrupt_requested


class InterruptGuard:
    """Tells whether Ctrl-C was pressed since there is something to keep.

    Before `begin` it interrupts as usual, and so it does when pressed again.
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
        """Take over Ctrl-C: a route has been found."""
        if not self._active:
            self._pressed, self._active = self._stack.enter_context(interrupt_requested()), True

    def stopped(self) -> bool:
        """Whether Ctrl-C was pressed since."""
        return self._pressed()


class SearchInterrupted(Exception):
    """Raised out of a search that is given up; never leaves the planning of a front."""
