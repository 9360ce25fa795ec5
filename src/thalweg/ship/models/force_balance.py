"""Forces on a ship at one draught: power at a speed, and speed at a power."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from thalweg.core.types import FloatArray
from thalweg.ship.methods.current_triangle import LARGEST_RUDDER_ANGLE, rudder_drag
from thalweg.ship.methods.validity import RangeNote
from thalweg.ship.models.added_resistance_model import AddedWaveResistance, WindResistance
from thalweg.ship.models.calm_water_model import CalmWaterResistance
from thalweg.ship.models.propulsion_model import PropulsionModel
from thalweg.ship.models.root_finding import bracketed_root

FlatConditions = Mapping[str, FloatArray]
_STOPPED_SPEED: Final = 0.01  #: below this the weather may stop the ship altogether [m/s]
CALM_CONDITIONS: Final = {
    "wind_speed": 0.0,
    "wind_angle": 0.0,
    "wave_height": 0.0,
    "wave_angle": 0.0,
    "wave_period": 10.0,
    "depth": np.inf,
}


@dataclass(frozen=True, eq=False)
class ForceBalance:
    """Forces on a ship at one draught, and the power that overcomes them.

    Attributes
    ----------
    rudder_area : For the optional rudder drag [m2]; 0 without. It needs the angle between heading
        and course (``crab_angle``), which depends on the current and on the speed itself: it counts
        where that is known, on performance sheets and for the referee, and is not in tables, so
        that no route is chosen by it.
    """

    calm: CalmWaterResistance
    propulsion: PropulsionModel
    waves: AddedWaveResistance | None = None
    wind: WindResistance | None = None
    rudder_area: float = 0.0

    @property
    def reads(self) -> frozenset[str]:
        """The conditions that the forces depend on."""
        depth = {"depth"} if self.calm.reads_depth else set()
        blown = {"wind_speed", "wind_angle"} if self.wind else set()
        return frozenset(depth | blown) | (self.waves.reads if self.waves else frozenset())

    def resistance(self, at: FlatConditions, speed: FloatArray) -> FloatArray:
        """Total resistance [N] at speeds through water [m/s]."""
        total = self.calm.total(speed, at["depth"])
        if self.waves is not None:
            total = total + self.waves.force(speed, *_wave_conditions(at))
        if self.wind is not None:
            total = total + self.wind.force(speed, at["wind_speed"], at["wind_angle"])
        return total + self._rudder(at, speed)

    def components(self, at: FlatConditions, speed: FloatArray) -> dict[str, FloatArray]:
        """Resistance by component [N]; ``total`` is their sum."""
        zero = np.zeros(speed.shape)
        parts = self.calm.components(speed, at["depth"])
        parts["waves"] = (
            zero if self.waves is None else self.waves.force(speed, *_wave_conditions(at))
        )
        parts["wind"] = zero
        if self.wind is not None:
            parts["wind"] = self.wind.force(speed, at["wind_speed"], at["wind_angle"])
        parts["rudder"] = zero + self._rudder(at, speed)
        return {"total": np.sum(np.broadcast_arrays(*parts.values()), axis=0), **parts}

    def brake_power(self, at: FlatConditions, speed: FloatArray) -> FloatArray:
        """Brake power [W] at speeds through water [m/s]."""
        return self.propulsion.brake_power(speed, self.resistance(at, speed))

    def speed_at_power(
        self, at: FlatConditions, power: FloatArray, highest: FloatArray
    ) -> FloatArray:
        """Speed through water [m/s] at brake powers [W], at most ``highest``; 1-D arrays."""
        target = np.cbrt(power)

        def excess(speed: FloatArray, index: NDArray[np.intp]) -> FloatArray:
            here = {name: values[index] for name, values in at.items()}
            return np.cbrt(self.brake_power(here, speed)) - target[index]

        low = np.zeros(power.shape)
        # at rest only a propeller at the bollard takes power: less than ordered, unless stopped
        root = bracketed_root(excess, low, highest, at_low=-target, tolerance=1e-4)
        slow = np.flatnonzero(root < _STOPPED_SPEED)
        root[slow] = np.where(excess(low[slow], slow) >= 0.0, 0.0, root[slow])
        return root

    def notes(self, at: FlatConditions, speed: FloatArray) -> list[RangeNote]:
        """Where methods are outside their ranges."""
        found = [*self.calm.notes(speed, at["depth"]), *self.propulsion.notes]
        rough = at["wave_height"] > 0.0
        if self.waves is not None and rough.any():
            height, angle = at["wave_height"][rough], at["wave_angle"][rough]
            found += self.waves.validity_notes(speed[rough], height, angle)
        return found

    def _rudder(self, at: FlatConditions, speed: FloatArray) -> FloatArray | float:
        if self.rudder_area <= 0.0 or "crab_angle" not in at:
            return 0.0
        turned = np.minimum(np.abs(at["crab_angle"]), LARGEST_RUDDER_ANGLE)
        return rudder_drag(speed, turned, rudder_area=self.rudder_area)


def calm_conditions(count: int) -> dict[str, FloatArray]:
    """Return calm, deep conditions, ``count`` of each."""
    return {name: np.full(count, value) for name, value in CALM_CONDITIONS.items()}


def _wave_conditions(at: FlatConditions) -> tuple[FloatArray, FloatArray, FloatArray]:
    return at["wave_height"], at["wave_period"], at["wave_angle"]
