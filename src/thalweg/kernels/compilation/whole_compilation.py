"""Ctrl-C waits until a kernel is compiled or loaded.

LLVM calls back into Python while it emits and loads machine code, and an exception is lost there:
without its `KeyboardInterrupt` numba goes on with a module that has no code, and fails.
"""

import functools
import signal
import threading


def compiled_whole(compile_kernel):
    """Return a function that compiles, and acts on Ctrl-C pressed meanwhile when it has ended."""

    @functools.wraps(compile_kernel)
    def compile_then_interrupt(*given, **options):
        is_main = threading.current_thread() is threading.main_thread()
        if not is_main or signal.getsignal(signal.SIGINT) is None:
            return compile_kernel(*given, **options)  # nothing of Python is interrupted
        pressed = []
        before = signal.signal(signal.SIGINT, lambda *_: pressed.append(True))
        try:
            return compile_kernel(*given, **options)
        finally:
            signal.signal(signal.SIGINT, before)
            if pressed:
                signal.raise_signal(signal.SIGINT)

    return compile_then_interrupt
