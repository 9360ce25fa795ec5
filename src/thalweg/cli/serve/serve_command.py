"""``thalweg serve``: the web application."""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

from thalweg.cli.first_run import announce_compilation

DEFAULT_PORT = 8765


def add_command(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "serve",
        help="the web application: plan on a map in the browser",
        description="Serve the web application and its interface for programs on this computer. "
        "It needs no internet and no account. The address that is printed contains the token that "
        "every request states.",
        epilog="Example: thalweg serve --open",
    )
    parser.add_argument(
        "--port", type=int, default=DEFAULT_PORT, metavar="N", help="port (default: 8765)"
    )
    parser.add_argument(
        "--host",
        default="127.0.0.1",
        metavar="ADDRESS",
        help="address to listen on; default: 127.0.0.1, this computer only",
    )
    parser.add_argument(
        "--allow-host",
        action="append",
        default=[],
        metavar="NAME",
        help="name under which other computers open it; needed with --host; may be repeated",
    )
    parser.add_argument(
        "--data", metavar="DIR", help="folder of jobs, results and uploads; default: of the user"
    )
    parser.add_argument(
        "--token", metavar="TEXT", help="token of 16 characters or more; default: one is made"
    )
    parser.add_argument(
        "--workers", type=int, metavar="N", help="plans at the same time; default: half the cores"
    )
    parser.add_argument(
        "--job-time", type=float, metavar="S", help="longest time of a plan [s]; default: 3600"
    )
    parser.add_argument("--open", action="store_true", help="open the page in the browser")
    parser.add_argument(
        "--demo", action="store_true", help="open it with the voyage of 'thalweg demo' filled in"
    )
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Serve until Ctrl-C."""
    from thalweg.service.server import run_server

    announce_compilation(search=True, quiet=arguments.quiet)
    arguments.progress.end()
    page = "demo" if arguments.demo else ""
    run_server(settings_of(arguments), _announce, open_page=arguments.open, page=page)
    return 0


def _announce(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def settings_of(arguments: argparse.Namespace) -> Any:
    """Return the settings that the options give."""
    from thalweg.core.errors import InputError
    from thalweg.service.service_settings import (
        ServiceLimits,
        ServiceSettings,
        default_data_folder,
        stored_token,
    )

    if not 1 <= arguments.port <= 65535:
        raise InputError(
            f"The port is {arguments.port}.", "A port is 1 to 65535.", "Correct --port."
        )
    folder = default_data_folder() if arguments.data is None else Path(arguments.data)
    limits = ServiceLimits()
    for name, value in (("workers", arguments.workers), ("job_seconds", arguments.job_time)):
        if value is None:
            continue
        if not value > 0:
            raise InputError(
                f"{name} is {value:g}.", "It is a positive number.", "Correct the option."
            )
        limits = replace(limits, **{name: value})
    return ServiceSettings(
        folder=folder.expanduser().resolve(),
        token=arguments.token or stored_token(folder.expanduser()),
        host=arguments.host,
        port=arguments.port,
        allowed_hosts=tuple(arguments.allow_host),
        limits=limits,
    )
