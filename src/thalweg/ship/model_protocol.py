"""What a ship model must offer: the protocol that built-in and third-party models follow."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray
from thalweg.ship.conditions import Conditions
from thalweg.ship.methods.validity import RangeNote
from thalweg.ship.tables.output_curve import OutputCurve
from thalweg.ship.tables.performance_table import TableError, TablePart


@dataclass(frozen=True)
class Estimate:
    """A particular that was not given and was estimated.

    Attributes
    ----------
    key : str
        Its key in a ship file, with the unit.
    value : float or str
        A word for choices.
    method : str
        What it was estimated by.
    """

    key: str
    value: float | str
    method: str


class ShipModel(Protocol):
    """How fast a ship goes, what it burns and what power it takes, in given conditions.

    All arrays are SI. A model never changes, reads only the conditions it declares and answers
    arrays of conditions with arrays of their shape; NaN conditions give NaN.
    """

    @property
    def reads(self) -> frozenset[str]:
        """Names of the conditions it reads, ``load_factor`` aside (see `Conditions`)."""
        ...

    @property
    def identity(self) -> Mapping[str, object]:
        """Plain data that tell this model from any other; goes into the fingerprint."""
        ...

    def speeds(self, load_factor: float) -> FloatArray:
        """Calm-water speed of every setting [m/s], ascending."""
        ...

    def speed_through_water(self, conditions: Conditions, setting: ArrayLike) -> FloatArray:
        """Speed through water [m/s], at least 0."""
        ...

    def power(self, conditions: Conditions, setting: ArrayLike) -> FloatArray:
        """Brake power [W]; NaN when the model does not know."""
        ...

    def fuel_rate(self, conditions: Conditions, setting: ArrayLike) -> FloatArray:
        """Fuel rate [kg/s]; NaN when the model does not know."""
        ...

    def top_speed(self, setting: int, load_factor: float) -> float | None:
        """Upper bound of the speed through water [m/s]; None when unknown."""
        ...

    def tabulate(
        self, load_factor: float, tolerance: float
    ) -> (
        tuple[tuple[TablePart, ...], TableError]
        | tuple[tuple[TablePart, ...], TableError, OutputCurve | None]
    ):
        """Parts whose sum is, or leads to, the speed through water [m/s]; their measured error.

        Third comes what follows the sum, if anything does. A model whose fuel does not follow from
        its setting alone may offer ``tabulate_fuel`` in the same form, and ``tabulate_power`` for
        its brake power; one that finds both together may offer ``power_and_fuel``.
        """
        ...

    def notes(self, conditions: Conditions, setting: ArrayLike) -> list[RangeNote]:
        """Where a method is used outside its range."""
        ...


def setting_index(setting: ArrayLike, count: int) -> NDArray[np.intp]:
    """Return settings as an index array, or raise `InputError` for one that does not exist."""
    index = np.asarray(setting)
    if not np.issubdtype(index.dtype, np.integer):
        raise InputError(
            f"A setting is an index, not {index.dtype}.",
            f"The ship has settings 0 to {count - 1}.",
            "Give the index of an ordered speed.",
        )
    if index.size and (index.min() < 0 or index.max() >= count):
        raise InputError(
            f"There is no setting {int(index.max() if index.max() >= count else index.min())}.",
            f"The ship has settings 0 to {count - 1}.",
            "Give the index of an ordered speed.",
        )
    return index.astype(np.intp)
