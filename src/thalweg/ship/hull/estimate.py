"""`Estimate`: a particular that a ship file does not give, with its source."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

#: Key of the estimate that states how a resistance in calm water was assumed.
CALM_WATER_ASSUMPTION: Final = "calm-water resistance"


@dataclass(frozen=True)
class Estimate:
    """A particular that was not given and was estimated.

    Attributes
    ----------
    key : str
        Its key in a ship file, with the unit.
    value : float or str
        Text if the particular is a choice.
    method : str
        The regression or rule of the estimate.
    """

    key: str
    value: float | str
    method: str


def method_assumptions(estimated: Iterable[Estimate]) -> list[str]:
    """Return the assumptions of a ship's methods that every result must state, in sentences."""
    return [one.method for one in estimated if one.key == CALM_WATER_ASSUMPTION]
