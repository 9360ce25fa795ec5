"""Options of the network that is searched, and their values."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from thalweg.core.errors import InputError

if TYPE_CHECKING:
    from thalweg.network.history.history_corridor import HistoryCorridor


def add_network_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of the kind of network, its shape and how fine it is."""
    parser.add_argument(
        "--network",
        default="auto",
        metavar="auto|lattice|mesh|globe|layered|history:NET",
        help="network to search: a regular grid around the route (lattice), the mesh of the sea "
        "data (mesh), a global grid (globe), layers between every two places (layered), or the "
        "water that ships usually use, from a file of thalweg history build (history:NET); "
        "default: auto",
    )
    for name, letter, unit, kind in (
        ("layers", "S", "N", "layers between two places of a layered network"),
        ("fan", "H", "N", "segments that leave a node of it towards the next layer"),
        ("layer-offset", "d", "NM", "by how much [nm] a layer is wider than the one before, to "
         "either side"),
    ):  # fmt: skip
        parser.add_argument(
            f"--{name}",
            metavar=f"{unit}[,...]",
            help=f"{kind} ({letter}); one value, or one for each section between via points; "
            "default: chosen",
        )
    parser.add_argument(
        "--near-coast", type=float, metavar="NM",
        help="within this distance of land the nodes of a layered network are twice as close",
    )  # fmt: skip
    parser.add_argument(
        "--contain", nargs="+", action="extend", metavar="LAT,LON",
        help="straits that a layered network of chosen shape must contain",
    )  # fmt: skip
    parser.add_argument(
        "--within", type=float, metavar="PERCENT",
        help="by how much its shortest path may be longer than that of the finest network tried "
        "(default: 1)",
    )  # fmt: skip
    parser.add_argument(
        "--corridor-gain", type=float, metavar="PERCENT",
        help="with --network history:NET: leave the usual water where that saves more than this "
        "share of the objective [%%]; default: never",
    )  # fmt: skip
    parser.add_argument(
        "--resolution", type=float, metavar="NM",
        help="spacing of the network [nm], 0.001 to 300; default: from the length of the voyage",
    )  # fmt: skip
    parser.add_argument(
        "--proof", type=float, metavar="SECONDS",
        help="time for the proof of the lower bound, 0 to 3600 s; default: as long as the search, "
        "1 s or more, and 15 s or more where a strait of trade is closed to the ship",
    )  # fmt: skip


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


def layered_request(arguments: argparse.Namespace) -> dict[str, Any] | None:
    """Return the shape of a layered network that the options give, or None.

    Raises
    ------
    InputError : If only some of the three options are given, or one is no list of numbers.
    """
    given = {
        "layers": arguments.layers,
        "fan": arguments.fan,
        "offset_nm": arguments.layer_offset,
    }
    stated = {name: text for name, text in given.items() if text is not None}
    more = {"near_coast_nm": arguments.near_coast, "within_percent": arguments.within}
    more["contain"] = arguments.contain and [_place(text) for text in arguments.contain]
    more = {name: value for name, value in more.items() if value is not None}
    if not stated and not more:
        return None
    if arguments.network != "layered":
        raise InputError(
            f"Options of layered networks were given with --network {arguments.network}.",
            "--layers, --fan, --layer-offset, --near-coast, --contain and --within shape the "
            "network 'layered'.",
            "Give --network layered, or leave them out.",
        )
    return {name: _numbers_of_sections(name, text) for name, text in stated.items()} | more


def _place(text: str) -> list[float]:
    numbers = _numbers_of_sections("contain", text)
    return numbers if isinstance(numbers, list) else [numbers]


def _numbers_of_sections(name: str, text: str) -> float | list[float]:
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        raise InputError(
            f"{name} of a layered network is {text!r}.",
            "It is one number, or numbers with commas between them, one for each section.",
            "Correct it, for example 1,15,20.",
            field=name,
        ) from None
    return numbers[0] if len(numbers) == 1 else numbers
