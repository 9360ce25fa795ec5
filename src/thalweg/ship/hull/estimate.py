"""`Estimate`: a particular that a ship file does not give, with its source."""

from __future__ import annotations

from dataclasses import dataclass


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
