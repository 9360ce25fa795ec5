"""Messages between the server and its child processes: one line of JSON each.

The child writes messages to the standard output with which it was started; whatever libraries
print goes to the error output. When the server ends, the child's input ends, and the child with it.
"""

from __future__ import annotations

import json
import os
import signal
import sys
import threading
import time
from collections.abc import Mapping
from typing import IO, Any


class MessageWriter:
    """Writes messages as lines of JSON; from any thread."""

    def __init__(self, stream: IO[str]) -> None:
        self._stream = stream
        self._lock = threading.Lock()

    def send(self, kind: str, data: Mapping[str, Any]) -> None:
        """Write one message."""
        line = json.dumps({"kind": kind, **data}, allow_nan=False)
        with self._lock:
            self._stream.write(line + "\n")
            self._stream.flush()


def take_over_output() -> MessageWriter:
    """Return a writer on the standard output, and send all other prints to the error output."""
    own = os.fdopen(os.dup(sys.stdout.fileno()), "w", encoding="utf-8")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    return MessageWriter(own)


def end_with_the_server() -> None:
    """End this process when its input ends: the server has gone, by whatever death."""
    signal.signal(signal.SIGINT, signal.default_int_handler)  # may be ignored by inheritance

    def watch() -> None:
        while sys.stdin.buffer.read(4096):
            time.sleep(0.01)
        os._exit(3)

    threading.Thread(target=watch, daemon=True).start()
