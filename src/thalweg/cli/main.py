"""The command line ``thalweg`` with its commands."""

from __future__ import annotations

import argparse
import contextlib
import difflib
import gc
import os
import re
import sys
import warnings
from collections.abc import Sequence
from typing import Final, NoReturn

from thalweg.cli import (
    demo_command,
    distance_command,
    evaluate_command,
    fetch_command,
    inspect_command,
    plan_command,
    project_command,
    study_command,
    tracks_command,
    waiting_command,
)
from thalweg.cli.exit_codes import INTERRUPTED, SUCCESS, exit_code, print_error
from thalweg.cli.history import distances_command, history_command
from thalweg.cli.indicators import alternatives_command
from thalweg.cli.options import accept_negative_positions, add_quiet_option
from thalweg.cli.progress import ProgressMessages
from thalweg.cli.serve import serve_command
from thalweg.cli.ship import ship_command
from thalweg.cli.tides import tides_command
from thalweg.core.errors import InputError, ThalwegError, ThalwegWarning

#: New objects until the next search for cycles among them: imports and plans make many that stay.
_GARBAGE_COLLECTION_THRESHOLD = 10_000

_COMMANDS = (
    plan_command.add_command,
    alternatives_command.add_command,
    evaluate_command.add_command,
    distance_command.add_command,
    distances_command.add_command,
    inspect_command.add_command,
    fetch_command.add_command,
    ship_command.add_command,
    tides_command.add_command,
    project_command.add_command,
    study_command.add_command,
    waiting_command.add_command,
    tracks_command.add_command,
    history_command.add_command,
    serve_command.add_command,
    demo_command.add_command,
)


_SHORT_USAGE: Final = 160  # characters


class Parser(argparse.ArgumentParser):
    """A parser that raises `InputError` for a command line that it cannot read."""

    def parse_args(self, args=None, namespace=None):  # type: ignore[no-untyped-def,override]
        """Parse arguments; what is left over is an error of the command, not of all commands."""
        found, left = self.parse_known_args(args, namespace)
        if left:
            command = _subcommands(self).get(getattr(found, "command", ""), self)
            command.error(f"unrecognized arguments: {' '.join(left)}")
        return found

    def error(self, message: str) -> NoReturn:
        """Raise `InputError` instead of ending the process."""
        words = _suggestions(self, message)
        message = re.sub(
            r"invalid (?:float|int) value: ('.*')", r"\1 is not a number without a unit", message
        )
        raise InputError(
            f"The command line is not understood: {message}.",
            _short_usage(self, message),
            (f"Did you mean {' or '.join(words)}? " if words else "") + f"See {self.prog} --help.",
        )


def _short_usage(parser: argparse.ArgumentParser, message: str) -> str:
    """Return what the option of a message is for, else the usage if it is short, else nothing."""
    named = re.match(r"argument ([^:]*):", message)
    if named:
        options = named[1].split("/")
        for action in parser._actions:
            if set(options) & set(action.option_strings):
                value = action.metavar if isinstance(action.metavar, str) else ""
                text = str(action.help or "").partition(";")[0] % vars(action)
                return f"{options[-1]} {value}: {text}.".replace(" :", ":")
    usage = " ".join(parser.format_usage().split())
    return usage if len(usage) <= _SHORT_USAGE else ""


def _suggestions(parser: argparse.ArgumentParser, message: str) -> list[str]:
    """Return options and commands that are spelled like those that are not known."""
    words = [word.partition("=")[0].strip("'\"") for word in message.split()]
    known = _known_words(parser)
    options = [word for word in words if word.startswith("--")]
    match = re.search(r"invalid choice: '([^']*)'", message)
    unknown = options if "unrecognized" in message else [match[1]] if match else []
    found = [near for word in unknown for near in difflib.get_close_matches(word, known, n=2)]
    return list(dict.fromkeys(found))


def _subcommands(parser: argparse.ArgumentParser) -> dict[str, argparse.ArgumentParser]:
    """Return the commands of a parser by name."""
    tables = (action.choices for action in parser._actions if isinstance(action.choices, dict))
    return next(tables, {})


def _known_words(parser: argparse.ArgumentParser) -> list[str]:
    """Return the options of a parser and its commands, and its choices."""
    known: list[str] = []
    for action in parser._actions:
        known += action.option_strings
        if isinstance(action.choices, dict):
            for name, sub in action.choices.items():
                known += [name, *_known_words(sub)]
        elif action.choices:
            known += map(str, action.choices)
    return list(dict.fromkeys(known))


def build_parser() -> Parser:
    """Return the parser of the whole command line."""
    parser = Parser(
        prog="thalweg",
        description="Voyage optimisation for ships: routes and speeds in currents, tides, wind and "
        "waves.",
        epilog="Exit codes: 0 done, 2 bad input, 3 no coverage by the data, 4 no route. "
        "'thalweg COMMAND --help' describes a command.",
    )
    parser.add_argument("--version", action="version", version=f"thalweg {_version()}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for add_command in _COMMANDS:
        add_command(commands)
    for sub in commands.choices.values():
        accept_negative_positions(sub)
        add_quiet_option(sub)
    return parser


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code.

    Parameters
    ----------
    argv : Arguments; default: those of the process.

    Returns
    -------
    int : 0 done, 2 bad input, 3 no coverage, 4 no route.
    """
    as_json = "--json" in (sys.argv[1:] if argv is None else argv)
    gc.set_threshold(_GARBAGE_COLLECTION_THRESHOLD)
    _prepare_streams()
    try:
        code = _run_command(argv, as_json)
        sys.stdout.flush()
        return code
    except BrokenPipeError:  # the reader of the output has closed it
        _discard_output()
        return SUCCESS
    except OSError as error:
        return _report_system_error(error, as_json=as_json)
    except KeyboardInterrupt:
        with contextlib.suppress(OSError):
            print("stopped", file=sys.stderr)
        return INTERRUPTED


def _run_command(argv: Sequence[str] | None, as_json: bool) -> int:
    """Parse and run a command; errors of this package become messages and exit codes."""
    with warnings.catch_warnings():
        warnings.filterwarnings("default", category=ThalwegWarning)
        warnings.showwarning = _show_warning
        try:
            arguments = build_parser().parse_args(argv)
            as_json = as_json or getattr(arguments, "json", False)
            with ProgressMessages(quiet=arguments.quiet) as arguments.progress:
                arguments.progress("loading the libraries")
                return int(arguments.run(arguments))
        except ThalwegError as error:
            try:
                return print_error(error, as_json=as_json)
            except OSError:
                if as_json:
                    raise
                return exit_code(error)  # nothing can be written to stderr


def _prepare_streams() -> None:
    """Give closed outputs a place to write to, and let all texts be written in any encoding."""
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115 to the end
        elif stream is getattr(sys, f"__{name}__") and stream.errors == "strict":
            stream.reconfigure(errors="backslashreplace")


def _discard_output() -> None:
    """Send what is left in the buffer nowhere: the flush at exit must not raise again."""
    with contextlib.suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _report_system_error(error: OSError, *, as_json: bool) -> int:
    """Print an error of the operating system, on stderr if stdout cannot be written."""
    message = _system_error(error)
    try:
        print_error(message, as_json=as_json)
        sys.stdout.flush()
    except OSError:
        _discard_output()
        with contextlib.suppress(OSError):
            print_error(message, as_json=False)
    return exit_code(message)


def _system_error(error: OSError) -> InputError:
    """Return an error of the operating system, such as a full disk, in the three parts."""
    where = f" at {str(error.filename)!r}" if error.filename else ""
    return InputError(
        f"The operating system stopped the work{where}: {error.strerror or error}.",
        "The command reads its files, and writes its results and a cache in your own folder.",
        "Check free space and permissions; THALWEG_CACHE sets another folder for the cache.",
    )


def _show_warning(message, category, filename, lineno, file=None, line=None):  # type: ignore[no-untyped-def]
    if issubclass(category, ThalwegWarning):
        print(f"warning: {message}", file=sys.stderr)


def _version() -> str:
    import thalweg

    return thalweg.__version__


if __name__ == "__main__":
    sys.exit(main())
