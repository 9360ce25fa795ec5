"""Ctrl-C while a kernel is compiled: the kernel is complete, then the interrupt is raised."""

import signal
import threading

import pytest
from numba import int64
from numba.core.caching import NullCache
from numba.extending import overload

from thalweg.kernels.compilation.jit import jit
from thalweg.kernels.compilation.whole_compilation import compiled_whole


def _pressed_while_compiled(number):
    raise NotImplementedError(number)


@overload(_pressed_while_compiled)
def _press(number):
    del number
    signal.raise_signal(signal.SIGINT)
    return lambda number: number + 1


def test_an_interrupt_waits_until_the_kernel_is_compiled_with_those_it_calls():
    @jit
    def inner(number):
        return 2 * _pressed_while_compiled(number)

    @jit
    def outer(number):
        return inner(number) + 1

    inner._cache = outer._cache = NullCache()  # code of an earlier run is not compiled
    with pytest.raises(KeyboardInterrupt):
        outer(3)
    assert outer.signatures == inner.signatures == [(int64,)]  # both are complete
    assert outer(3) == 9
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_a_request_to_stop_is_noted_after_compiling():
    steps = []
    before = signal.signal(signal.SIGINT, lambda *_: steps.append("stop"))
    try:

        def work():
            signal.raise_signal(signal.SIGINT)
            steps.append("compiled")
            return 4

        assert compiled_whole(work)() == 4
    finally:
        signal.signal(signal.SIGINT, before)
    assert steps == ["compiled", "stop"]


def test_other_threads_compile_as_usual():
    found = []
    thread = threading.Thread(target=lambda: found.append(compiled_whole(abs)(-2)))
    thread.start()
    thread.join()
    assert found == [2]
