"""`ShipLimits`: the weather in which a ship does not sail."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.types import BoolArray, FloatArray
from thalweg.ship.condition_variables import (
    EASTWARD_WIND,
    NORTHWARD_WIND,
    WAVE_EAST,
    WAVE_HEIGHT,
    WAVE_NORTH,
    WAVE_PERIOD,
)

if TYPE_CHECKING:
    from thalweg.ship.seaway_limits import SafetyLimits


@dataclass(frozen=True)
class ShipLimits:
    """Hard limits of a ship; infinite where there is none.

    Attributes
    ----------
    wave_height : float
        Greatest significant wave height [m].
    wind_speed : float
        Greatest wind speed at 10 m, over the ground [m/s].
    safety : SafetyLimits, optional
        Limits of safety and comfort in waves.
    """

    wave_height: float = math.inf
    wind_speed: float = math.inf
    safety: SafetyLimits | None = None

    def __post_init__(self) -> None:
        for name, value in (("wave height", self.wave_height), ("wind speed", self.wind_speed)):
            if not value > 0.0:
                raise InputError(
                    f"The limit of {name} is {value:g}.",
                    "A limit is a positive number.",
                    "Leave it out when there is none.",
                    value=value,
                )

    @property
    def needs(self) -> frozenset[str]:
        """The sea variables that finite limits depend on."""
        needed = frozenset(self.limited_weather)
        if self.safety is not None:
            needed |= {WAVE_HEIGHT, WAVE_EAST, WAVE_NORTH, WAVE_PERIOD}
        return needed

    @property
    def limited_weather(self) -> tuple[str, ...]:
        """The sea variables that finite limits of wave height and wind speed depend on, sorted."""
        waves = (WAVE_HEIGHT,) if math.isfinite(self.wave_height) else ()
        wind = (EASTWARD_WIND, NORTHWARD_WIND) if math.isfinite(self.wind_speed) else ()
        return tuple(sorted((*waves, *wind)))

    def keeps_weather_limits(self, sampled: Mapping[str, FloatArray]) -> BoolArray:
        """Return where waves and wind keep the limits of wave height and wind speed.

        Where they are unknown they do not. Limits of safety in waves are not tested.

        Parameters
        ----------
        sampled : The variables of `limited_weather` at least [m], [m/s], of one shape.

        Returns
        -------
        bool ndarray : In their shape; True alone where there are no limits.
        """
        kept: BoolArray = np.asarray(True)
        with np.errstate(invalid="ignore"):
            if math.isfinite(self.wave_height):
                kept = kept & (sampled[WAVE_HEIGHT] <= self.wave_height)
            if math.isfinite(self.wind_speed):
                wind = np.hypot(sampled[EASTWARD_WIND], sampled[NORTHWARD_WIND])
                kept = kept & (wind <= self.wind_speed)
        return np.asarray(kept)
