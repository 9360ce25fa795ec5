"""`ShipLimits`: the weather in which a ship does not sail."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from thalweg.core.errors import InputError
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
        waves = {WAVE_HEIGHT} if math.isfinite(self.wave_height) else set()
        wind = {EASTWARD_WIND, NORTHWARD_WIND} if math.isfinite(self.wind_speed) else set()
        if self.safety is not None:
            waves = {WAVE_HEIGHT, WAVE_EAST, WAVE_NORTH, WAVE_PERIOD}
        return frozenset(waves | wind)
