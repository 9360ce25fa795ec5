"""Ships that other packages offer in the entry-point group ``thalweg.ships``."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any, Final

from thalweg.core.errors import InputError

ENTRY_POINT_GROUP: Final = "thalweg.ships"


def plugin_names() -> list[str]:
    """Return the names of the ships that other packages offer.

    Returns
    -------
    list of str
        In alphabetical order.
    """
    from importlib.metadata import entry_points

    return sorted({entry.name for entry in entry_points(group=ENTRY_POINT_GROUP)})


def load_plugin(name: str) -> Any:
    """Return what another package offers under a name, or None.

    It is a `Ship`, a mapping like a ship file, a model as in
    `thalweg.ship.model_protocol.ShipModel`, a function of conditions that returns speeds, or a
    callable without arguments that returns one of these.

    Raises
    ------
    InputError : If its package cannot be imported, or does not hold it.
    """
    from importlib.metadata import entry_points

    for entry in entry_points(group=ENTRY_POINT_GROUP):
        if entry.name != name:
            continue
        try:
            found = entry.load()
        except (ImportError, AttributeError) as problem:
            raise InputError(
                f"The plug-in ship {name!r} cannot be loaded: {problem}.",
                f"Its package states that it is at {entry.value}.",
                "Repair or remove the package that offers it.",
                name=name,
            ) from None
        return found() if callable(found) and _takes_nothing(found) else found
    return None


def _takes_nothing(function: Callable[..., Any]) -> bool:
    """Whether a callable can be called without arguments."""
    kinds = (inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD)
    wanted = inspect.signature(function).parameters.values()
    return all(p.default is not p.empty or p.kind in kinds for p in wanted)
