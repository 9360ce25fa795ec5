"""Types of ship that ``hull.type`` may name: those of the CII rating, and others in words."""

from __future__ import annotations

from typing import Final

from thalweg.core.errors import InputError
from thalweg.ship.methods.carbon_intensity import SHIP_TYPES

#: One of these is in every other type, such as "crude oil tanker" or "research vessel".
TYPE_WORDS: Final = (
    "aframax", "ahts", "barge", "boat", "bulk", "cable", "capesize", "cargo", "carrier",
    "catamaran", "cement", "coaster", "combination", "container", "crane", "crew", "cruise",
    "dredg", "drill", "feeder", "ferry", "fishing", "fpso", "frigate", "fso", "gas", "handy",
    "heavy lift", "high speed", "hopper", "icebreaker", "installation", "livestock", "lng",
    "lpg", "mpp", "multi", "naval", "navy", "offshore", "osv", "other", "panamax", "passenger",
    "patrol", "pctc", "pilot", "pipe", "psv", "pusher", "reefer", "refrigerated", "rescue",
    "research", "ro pax", "ro ro", "ropax", "roro", "sail", "suezmax", "supply", "survey",
    "tanker", "tender", "training", "trawler", "tshd", "tug", "ulcc", "ulcv", "vehicle", "vlcc",
    "vlcs", "vlgc", "work", "yacht",
)  # fmt: skip


def check_hull_type(given: str | None) -> None:
    """Raise `InputError` for an unknown type of ship, which would be taken for a cargo ship.

    Parameters
    ----------
    given : ``hull.type`` of a ship file.
    """
    words = plain_hull_type(given).replace("_", " ")
    if not words or any(word in words for word in TYPE_WORDS):
        return
    raise InputError(
        f"The type of ship {given!r} is not known.",
        f"The types of the CII rating are {', '.join(SHIP_TYPES)}; other types have one of the "
        f"words {', '.join(TYPE_WORDS)}.",
        "Give the type in such words, or leave out hull.type.",
        key="hull.type",
        value=given,
    )


def plain_hull_type(given: str | None) -> str:
    """Return a type of ship in small letters, with underscores, as the CII rating has it."""
    return (given or "").casefold().strip().replace(" ", "_").replace("-", "_")
