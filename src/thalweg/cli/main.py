"""The command line ``thalweg`` with its commands."""

from __future__ import annotations

import argparse
import os
import re
import sys
import warnings
from collections.abc import Sequence
from typing import NoReturn

from thalweg.cli import (
    demo_command,
    evaluate_command,
    inspect_command,
    plan_command,
    project_command,
    ship_command,
    tides_command,
    tracks_command,
    waiting_command,
)
from thalweg.cli.exit_codes import INTERRUPTED, print_error
from thalweg.core.errors import InputError, ThalwegError, ThalwegWarning

_COMMANDS = (
    plan_command.add_command,
    evaluate_command.add_command,
    inspect_command.add_command,
    ship_command.add_ship_command,
    tides_command.add_command,
    project_command.add_command,
    waiting_command.add_command,
    tracks_command.add_command,
    demo_command.add_command,
)


class Parser(argparse.ArgumentParser):
    """A parser whose complaints are errors like all others."""

    def error(self, message: str) -> NoReturn:
        """Raise `InputError` in place of leaving the process."""
        raise InputError(
            f"The command line is not understood: {message}.",
            " ".join(self.format_usage().split()),
            f"See {self.prog} --help.",
        )


def build_parser() -> Parser:
    """Return the parser of the whole command line."""
    parser = Parser(
        prog="thalweg",
        description="Voyage optimisation for ships: routes and speeds through moving water.",
    )
    parser.add_argument("--version", action="version", version=f"thalweg {_version()}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for add_command in _COMMANDS:
        add_command(commands)
    for sub in commands.choices.values():
        # A position such as -33.9,151.2 is an argument, not an option.
        sub._negative_number_matcher = re.compile(r"^-\d[\d.]*([,;\s].*)?$")
    return parser


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code.

    Parameters
    ----------
    argv : sequence of str, optional
        Arguments; those of the process when not given.

    Returns
    -------
    int
        0 done, 2 bad input, 3 no coverage, 4 no route.
    """
    as_json = "--json" in (sys.argv[1:] if argv is None else argv)
    try:
        arguments = build_parser().parse_args(argv)
    except InputError as error:
        return print_error(error, as_json=as_json)
    with warnings.catch_warnings():
        warnings.filterwarnings("default", category=ThalwegWarning)
        warnings.showwarning = _show_warning
        try:
            code = int(arguments.run(arguments))
            sys.stdout.flush()
            return code
        except ThalwegError as error:
            return print_error(error, as_json=as_json or getattr(arguments, "json", False))
        except BrokenPipeError:
            # nobody reads on: what is still to be flushed must not complain at the exit
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            return 0
        except KeyboardInterrupt:
            print("stopped", file=sys.stderr)
            return INTERRUPTED


def _show_warning(message, category, filename, lineno, file=None, line=None):  # type: ignore[no-untyped-def]
    if issubclass(category, ThalwegWarning):
        print(f"warning: {message}", file=sys.stderr)


def _version() -> str:
    from importlib.metadata import version

    return version("thalweg")


if __name__ == "__main__":
    sys.exit(main())
