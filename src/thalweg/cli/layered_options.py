"""Options of layered networks, and their values."""

from __future__ import annotations

import argparse
from typing import Any

from thalweg.core.errors import InputError


def add_layered_options(parser: argparse.ArgumentParser) -> None:
    """Add ``--layers``, ``--fan`` and ``--layer-offset``."""
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
    if not stated:
        return None
    if arguments.network not in ("auto", "layered"):
        raise InputError(
            f"--layers, --fan and --layer-offset are given with --network {arguments.network}.",
            "They shape the network 'layered'.",
            "Give --network layered, or leave them out.",
        )
    return {name: _numbers_of_sections(name, text) for name, text in stated.items()}


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
