"""Messages on stderr about what a command is doing, for commands that take longer than a second."""

from __future__ import annotations

import contextlib
import sys
import threading
import time
from types import TracebackType

_SILENT = 1.0  # nothing is printed before [s]
_REPEAT = 30.0  # a stage that takes longer is mentioned again after [s]


class ProgressMessages:
    """Prints the stages of a command on stderr, each when it begins.

    Stages of the first second are not printed, except the one that lasts beyond it. Long stages are
    repeated every half minute with the time so far. Used as a context manager; a call states what
    begins.

    Parameters
    ----------
    quiet : Whether to print nothing.
    """

    def __init__(self, *, quiet: bool = False) -> None:
        self.quiet = quiet
        self._stage = ""
        self._printed = True
        self._start = time.monotonic()
        self._lock = threading.Lock()
        self._ended = threading.Event()

    def __enter__(self) -> ProgressMessages:
        if not self.quiet:
            threading.Thread(target=self._watch, daemon=True).start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.end()

    def end(self) -> None:
        """Print nothing any more: the command has begun to serve, or has ended."""
        self._ended.set()

    def __call__(self, stage: str) -> None:
        """State what begins now, such as ``reading waves.nc``."""
        with self._lock:
            if self.quiet or self._ended.is_set() or stage == self._stage:
                return
            self._stage, self._printed = stage, False
            if self._seconds() >= _SILENT:
                self._print(stage)

    def _watch(self) -> None:
        """Print the stage that lasts beyond the first second, and long ones again."""
        wait = _SILENT
        while not self._ended.wait(wait):
            with self._lock:
                if not self._ended.is_set() and self._stage:
                    again = f"{self._stage}, after {self._seconds():.0f} s"
                    self._print(again if self._printed else self._stage)
            wait = _REPEAT

    def _print(self, text: str) -> None:
        self._printed = True
        with contextlib.suppress(OSError, ValueError):
            print(f"{text} ...", file=sys.stderr, flush=True)

    def _seconds(self) -> float:
        return time.monotonic() - self._start
