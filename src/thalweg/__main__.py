"""The entry of the command line: ``thalweg`` and ``python -m thalweg``."""

import signal
import sys


def run() -> int:
    """Run the command line of this process and return its exit code.

    Ctrl-C while the libraries are still being loaded ends the process without a trace of Python.
    """
    usual = signal.getsignal(signal.SIGINT)
    if usual is signal.default_int_handler:  # not where the process was started to ignore it
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from thalweg.cli.main import main

    signal.signal(signal.SIGINT, usual)
    return main()


if __name__ == "__main__":
    sys.exit(run())
