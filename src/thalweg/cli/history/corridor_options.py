"""The option for plans in the water that ships usually use, and its value."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from thalweg.core.errors import InputError

if TYPE_CHECKING:
    from thalweg.network.history.history_corridor import HistoryCorridor


def add_corridor_option(parser: argparse.ArgumentParser) -> None:
    """Add ``--corridor-gain``."""
    parser.add_argument(
        "--corridor-gain",
        type=float,
        metavar="PERCENT",
        help="with --network history:NET: leave the usual water where that saves more than this "
        "share of the objective [%%]; default: never",
    )


def requested_network(arguments: argparse.Namespace) -> str | HistoryCorridor:
    """Return the network that the options ask for.

    Raises
    ------
    InputError : If a gain is given without a history network.
    """
    from dataclasses import replace

    from thalweg.planning.request.network_choice import history_corridor

    if arguments.corridor_gain is None:
        return str(arguments.network)
    corridor = history_corridor(arguments.network)
    if corridor is None:
        raise InputError(
            f"--corridor-gain is given with --network {arguments.network}.",
            "It states for what gain a plan leaves the water that ships usually use.",
            "Give --network history:NET, or leave it out.",
        )
    return replace(corridor, gain=arguments.corridor_gain / 100.0)
