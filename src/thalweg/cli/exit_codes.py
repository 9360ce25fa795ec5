"""Exit codes of the command line, and how errors are printed."""

from __future__ import annotations

import json
import sys

from thalweg.core.errors import CoverageError, NoRouteError, ThalwegError

SUCCESS, BAD_INPUT, NO_COVERAGE, NO_ROUTE = 0, 2, 3, 4
INTERRUPTED = 130  # after Ctrl-C, as shells do


def exit_code(error: ThalwegError) -> int:
    """Return 2 for bad input, 3 for missing coverage, 4 for no route."""
    return exit_code_of_kind(type(error))


def exit_code_of_kind(kind: type[ThalwegError]) -> int:
    """Return the exit code of errors of a class."""
    if issubclass(kind, NoRouteError):
        return NO_ROUTE
    return NO_COVERAGE if issubclass(kind, CoverageError) else BAD_INPUT


def print_error(error: ThalwegError, *, as_json: bool) -> int:
    """Print an error and return its exit code.

    Parameters
    ----------
    as_json : True: one JSON object on stdout. False: text on stderr.
    """
    if as_json:
        print(json.dumps(error.as_dict(), indent=2, allow_nan=False))
        return exit_code(error)
    lines = [f"error: {error.asked}"]
    lines += [text for text in (error.possible, error.remedy) if text]
    if isinstance(error, NoRouteError) and error.reasons:
        lines.append(f"Legs rejected: {error.reasons_text}.")
    print("\n  ".join(lines), file=sys.stderr)
    return exit_code(error)
