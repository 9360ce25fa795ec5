"""`Limits`: the least depth, greatest waves and wind, and least distance from land of a ship."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray

DEEPEST_DRAUGHT: Final = 30.0  #: of ships that are taken; no ship was deeper than 29 m [m]


@dataclass(frozen=True)
class Tightening:
    """One step of the tightening schedule: how much stricter than requested the limits are.

    Attributes
    ----------
    depth : float
        Added to the required depth [m].
    share : float
        Taken off the limits of wave height and wind speed, as a share of them.
    """

    depth: float = 0.0
    share: float = 0.0


#: Steps tried one after the other while the referee, which checks limits in small steps, finds
#: violations on a route that searches and refinement allow.
TIGHTENING: Final = (
    Tightening(),
    Tightening(depth=0.05, share=0.005),
    Tightening(depth=0.1, share=0.02),
    Tightening(depth=0.3, share=0.05),
    Tightening(depth=1.0, share=0.1),
)

#: The steps of `TIGHTENING` for searches on networks: their stations can be kilometres apart, so
#: that the smallest step seldom helps and an attempt takes long.
NETWORK_STEPS: Final = (0, 2, 3, 4)


@dataclass(frozen=True)
class Limits:
    """Limits that hold at every point of a route.

    Limits of motions are part of the ship's table; those of the chart (land, zones, offing) are
    part of the network.

    Attributes
    ----------
    required_depth : float
        Least water depth [m]: draught plus under-keel clearance; -inf if depth is not checked.
    wave_height : float
        Greatest significant wave height [m]; inf if there is no limit.
    wind_speed : float
        Greatest wind speed at 10 m, over the ground [m/s]; inf if there is no limit.
    offing : float
        Least distance from charted land [m]; 0 if there is no limit. The chart holds it
        (`thalweg.chart.Chart.with_offing`), and no step of a schedule changes it.

    Raises
    ------
    InputError
        If a limit is not a number.
    """

    required_depth: float = -math.inf
    wave_height: float = math.inf
    wind_speed: float = math.inf
    offing: float = 0.0

    def __post_init__(self) -> None:
        for name in ("required_depth", "wave_height", "wind_speed", "offing"):
            value = float(getattr(self, name))
            object.__setattr__(self, name, value)
            if math.isnan(value):
                raise InputError(
                    f"The limit {name} is not a number.",
                    "Depth, wave height and offing are in m, the wind speed in m/s.",
                    "Leave out what is not limited.",
                )

    @property
    def array(self) -> FloatArray:
        """The limits as kernels take them, in the order of ``LIMIT_*`` in `thalweg.kernels.codes`.

        float64[3], a new array at each call.
        """
        return np.array([self.required_depth, self.wave_height, self.wind_speed])

    @property
    def depth_checked(self) -> bool:
        """Whether a water depth is required."""
        return math.isfinite(self.required_depth)

    def tightened(self, step: Tightening) -> Limits:
        """Return limits that are stricter by one step of a schedule.

        Parameters
        ----------
        step : Tightening
            How much stricter.

        Returns
        -------
        Limits
            With a larger required depth, and smaller limits of wave height and wind
            speed.
        """
        return Limits(
            self.required_depth + step.depth,
            self.wave_height * (1.0 - step.share),
            self.wind_speed * (1.0 - step.share),
            self.offing,
        )

    def relaxed(self, share: float) -> Limits:
        """Return limits that are looser by a share of themselves, for lower bounds.

        Parameters
        ----------
        share : float
            Share of each limit [-], 0 or more.

        Returns
        -------
        Limits
            With a smaller required depth, and larger limits of wave height and wind
            speed.
        """
        depth = self.required_depth
        factor = 1.0 + share
        return Limits(
            depth - share * abs(depth),
            self.wave_height * factor,
            self.wind_speed * factor,
            self.offing,
        )

    def with_required_depth(self, depth: float) -> Limits:
        """Return the same limits with another required depth.

        Parameters
        ----------
        depth : float
            Least water depth [m]; -inf if depth is not checked.

        Returns
        -------
        Limits
            Otherwise unchanged.
        """
        return replace(self, required_depth=depth)
