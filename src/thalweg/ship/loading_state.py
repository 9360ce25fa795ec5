"""`Loading`: draught and displacement of a ship between empty and full."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal

from numpy.typing import ArrayLike

from thalweg.core.errors import InputError
from thalweg.core.given_numbers import is_number, shortened_repr
from thalweg.core.types import FloatArray
from thalweg.ship.methods.displacement import interpolate_loading


@dataclass(frozen=True)
class Loading:
    """Draught and displacement, linear in the load factor between empty (0) and full (1).

    Attributes
    ----------
    draught_full, draught_empty : float
        [m]; equal when the ship file gives one draught.
    displacement_full, displacement_empty : float
        Displaced volume [m3]; NaN when unknown.
    load_factor : float
        The ship's state, 0 to 1: (W - W_empty) / (W_full - W_empty) of van Halem (2019).
    condition : {"loaded", "normal", "ballast"}
        The condition whose coefficients empirical methods shall take.
    capacity : float
        Volume of cargo at load factor 1 [m3]; NaN when unknown.
    """

    draught_full: float
    draught_empty: float
    displacement_full: float = math.nan
    displacement_empty: float = math.nan
    load_factor: float = 1.0
    condition: Literal["loaded", "normal", "ballast"] = "loaded"
    capacity: float = math.nan

    def __post_init__(self) -> None:
        if not 0.0 <= self.load_factor <= 1.0:
            raise InputError(
                f"The load factor is {self.load_factor:g}.",
                "It is between 0 (empty) and 1 (full).",
                "Give it as a fraction.",
                value=f"{self.load_factor:g}",
            )
        if not 0.0 <= self.draught_empty <= self.draught_full < math.inf:
            raise InputError(
                f"The draught is {self.draught_empty:g} m empty and {self.draught_full:g} m full.",
                "Draughts are not negative, and a full ship is at least as deep as an empty one.",
                "Correct draught_full_m and draught_empty_m.",
            )
        if self.displacement_empty > self.displacement_full:
            raise InputError(
                "The ship displaces more when empty than when full.",
                f"Given: {self.displacement_empty:g} and {self.displacement_full:g} m3.",
                "Correct the displacements or weights under 'loading'.",
            )

    @property
    def same_full_and_empty(self) -> bool:
        """Whether draught and displacement do not depend on the load factor."""
        volumes = self.displacement_full, self.displacement_empty
        same = math.isnan(self.displacement_empty) or volumes[0] == volumes[1]
        return same and self.draught_full == self.draught_empty

    @property
    def draught(self) -> float:
        """Draught at the load factor [m]."""
        return float(self.draught_at(self.load_factor))

    @property
    def displacement(self) -> float:
        """Displaced volume at the load factor [m3]; NaN when unknown."""
        return float(self.displacement_at(self.load_factor))

    def draught_at(self, load_factor: ArrayLike) -> FloatArray:
        """Return the draught at load factors.

        Parameters
        ----------
        load_factor : array_like
            0 empty to 1 full.

        Returns
        -------
        float64 array
            Draught [m].
        """
        return interpolate_loading(load_factor, empty=self.draught_empty, full=self.draught_full)

    def displacement_at(self, load_factor: ArrayLike) -> FloatArray:
        """Return the displaced volume at load factors.

        Parameters
        ----------
        load_factor : array_like
            0 empty to 1 full.

        Returns
        -------
        float64 array
            Volume [m3]; NaN where unknown.
        """
        return interpolate_loading(
            load_factor, empty=self.displacement_empty, full=self.displacement_full
        )

    def at(self, load_factor: float) -> Loading:
        """Return the same ship at another load factor.

        Parameters
        ----------
        load_factor : float
            0 empty to 1 full.

        Returns
        -------
        Loading
            Otherwise unchanged.

        Raises
        ------
        InputError
            If it is not a number from 0 to 1.
        """
        if not is_number(load_factor):
            raise InputError(
                f"The load factor is {shortened_repr(load_factor)}, which is not a number.",
                "It is between 0 (empty) and 1 (full).",
                "Correct it, or leave it out.",
            )
        return replace(self, load_factor=float(load_factor))
