"""Squat of a ship: its sinkage under way, and the speed that the depth allows."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.errors import unknown_name_error
from thalweg.core.types import FloatArray
from thalweg.ship.hull.hull import Hull, required_particulars
from thalweg.ship.loading_state import Loading
from thalweg.ship.methods.shallow_water.barrass_squat import (
    barrass_2004_speed,
    barrass_2004_squat,
    barrass_squat,
)
from thalweg.ship.methods.shallow_water.squat import (
    shallow_water_speed,
    shallow_water_speed_limit,
)
from thalweg.ship.schema.ship_schema import ShipFile

SQUAT_METHODS: Final = ("none", "van_halem_2019", "barrass_2004")


@dataclass(frozen=True)
class SquatModel:
    """A ship's squat, in open water.

    Attributes
    ----------
    length, breadth : Between perpendiculars (or of the waterline), and breadth [m].
    loading : Draughts [m] and displacements [m3].
    clearance : Water that shall remain under the ship under way [m].
    method : ``van_halem_2019`` sinks as Barrass (1979), ``barrass_2004`` as his later form; both
        slow as van Halem (2019), eq. 2.5, corrected.
    """

    length: float
    breadth: float
    loading: Loading
    clearance: float = 0.0
    method: str = "van_halem_2019"

    @property
    def block_coefficient(self) -> float:
        """At the ship's load factor."""
        return float(self._block(self.loading.load_factor))

    def sinkage(self, speed: ArrayLike, depth: ArrayLike, load_factor: ArrayLike) -> FloatArray:
        """Largest squat [m] at speeds through water [m/s]."""
        formula = barrass_2004_squat if self.method == "barrass_2004" else barrass_squat
        return formula(speed, depth, **self._sizes(load_factor))

    def allowed(self, speed: ArrayLike, depth: ArrayLike, load_factor: ArrayLike) -> FloatArray:
        """Speed [m/s] of a ship with a given deep-water speed; 0 where it would ground."""
        deep, sizes = np.asarray(speed, float), self._sizes(load_factor)
        if self.method == "barrass_2004":
            room = np.asarray(depth, float) - sizes["draught"] - self.clearance
            slowed = shallow_water_speed(
                deep, depth, draught=sizes["draught"], breadth=self.breadth
            )
            left = np.minimum(slowed, barrass_2004_speed(room, depth, **sizes))
        else:
            left = shallow_water_speed_limit(deep, depth, **sizes, clearance=self.clearance)
        return np.minimum(deep, left)

    def _sizes(self, load_factor: ArrayLike) -> dict[str, Any]:
        """Draught, breadth and block coefficient at a load factor."""
        return {
            "draught": self.loading.draught_at(load_factor),
            "breadth": self.breadth,
            "block_coefficient": self._block(load_factor),
        }

    def _block(self, load_factor: ArrayLike) -> FloatArray:
        draught = self.loading.draught_at(load_factor)
        volume = self.loading.displacement_at(load_factor)
        return volume / (self.length * self.breadth * draught)


def squat_model_of(file: ShipFile, hull: Hull, loading: Loading) -> SquatModel | None:
    """Return a ship's squat, or None when its particulars are too few."""
    length = hull.number("length_between_perpendiculars_m") or hull.number("length_waterline_m")
    breadth = hull.number("breadth_m")
    if not (length and breadth) or math.isnan(loading.displacement_full):
        return None
    clearance = file.limits.min_under_keel_clearance_m
    chosen = file.models.squat
    method = chosen if chosen in SQUAT_METHODS[1:] else SQUAT_METHODS[1]
    return SquatModel(float(length), float(breadth), loading, clearance, method)


def build_squat_model(file: ShipFile, hull: Hull, loading: Loading) -> SquatModel | None:
    """Return the squat that limits a ship's speed, by ``models.squat``; None for ``none``.

    Raises
    ------
    InputError : For unknown names, and particulars that are missing.
    """
    name = file.models.squat
    if name not in SQUAT_METHODS:
        raise unknown_name_error("squat method", name, SQUAT_METHODS)
    if name == "none":
        return None
    found = squat_model_of(file, hull, loading)
    if found is None:
        keys = ("length_between_perpendiculars_m", "breadth_m", "displacement_m3")
        required_particulars(hull, keys, name, instead="squat: none")
    return found
