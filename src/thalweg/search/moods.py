"""Bounds for some hours: what the tide allows then, in place of what it allows ever.

Bounds of the time to go rest on the highest water and the strongest currents. Over the few hours of
one passage both are often less: at low water a bank is shut for certain, on the ebb nobody is
carried up. The hours of a passage are put into a class (a `Mood`, rounded up in coarse steps); the
tide comes back to the same classes again and again, and each has its bounds.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from thalweg.kernels import profile as kernel
from thalweg.kernels.codes import LIMIT_REQUIRED_DEPTH
from thalweg.kernels.edges import ShipArrays

if TYPE_CHECKING:
    from thalweg.search.waters import Waters

FloatArray = NDArray[np.float64]
#: Lowering of the water in steps of `LOWER_STEP`, shares of the currents in `SHARE_STEP`.
Key: TypeAlias = tuple[int, ...]

LOWER_STEP, SHARE_STEP = 0.2, 0.25
SPARE_CURRENT = 0.05  #: currents below this are no reason to tell hours apart [m/s]
MOST_HOURS = 6.0  #: over longer times the tide has been everywhere
_WORTH = 2  # from this request on a class gets its bounds
_KEPT = 40  # classes


def key_of(mood: kernel.Mood) -> Key:
    """Return the class of a mood: rounded up, so that the bounds of the class hold for it."""
    whole = round(1.0 / SHARE_STEP)
    shares = np.clip(np.ceil(mood.share / SHARE_STEP - 1e-9), -whole, whole)
    return (int(np.ceil(mood.lower / LOWER_STEP - 1e-9)), *shares.astype(int).tolist())


def mood_of_key(key: Key) -> kernel.Mood:
    """Return the most that the hours of a class allow."""
    share = SHARE_STEP * np.array(key[1:], float)
    return kernel.Mood(min(LOWER_STEP * key[0], 0.0), share, SPARE_CURRENT)


def ever() -> kernel.Mood:
    """Return the mood without any lowering."""
    return kernel.Mood(0.0, np.ones(kernel.SECTORS), 0.0)


@dataclass(frozen=True, eq=False)
class Bounds:
    """Lower bounds of the time to go to one goal, for one ship.

    Attributes
    ----------
    waters : Waters
    ship : ShipArrays
    goal : int
    caps : float64[C]
        Greatest speeds through water by depth, see `thalweg.kernels.profile.least_times`.
    """

    waters: Waters
    ship: ShipArrays
    goal: int
    caps: FloatArray

    @cached_property
    def ever(self) -> kernel.Ahead:
        """The bounds that hold always."""
        return self.of(ever())

    @cached_property
    def _classes(self) -> dict[Key, kernel.Ahead | int]:
        return {}

    def over(self, depart: float, last: float) -> kernel.Ahead:
        """Return bounds that hold for all that is sailed between two times [s]."""
        if last - depart > MOST_HOURS * 3600.0:
            return self.ever
        key = self.waters.class_of(depart, last)
        if key[0] == 0 and min(key[1:]) * SHARE_STEP >= 1.0:
            return self.ever
        known = self._classes.pop(key, 0)
        if isinstance(known, int):
            known = known + 1 if known + 1 < _WORTH else self.of(mood_of_key(key))
        while len(self._classes) >= _KEPT:
            self._classes.pop(next(iter(self._classes)), None)
        self._classes[key] = known
        return self.ever if isinstance(known, int) else known

    def of(self, mood: kernel.Mood) -> kernel.Ahead:
        """Return the bounds in a mood."""
        waters = self.waters
        times = np.empty(len(waters.tails))
        required = float(self.ship.limits[LIMIT_REQUIRED_DEPTH])
        kernel.least_times(
            waters.network, waters.tails, waters.sea, waters.strongest, mood, self.caps, required,
            times,
        )  # fmt: skip
        count = len(waters.network.can_wait)
        ahead = np.empty(count)
        memory = np.empty(count, np.int32), np.empty(count), np.full(count, -1, np.int32)
        kernel.backward_bounds(
            waters.arriving_ptr, waters.arriving, waters.tails, times, self.goal, ahead, memory
        )
        return kernel.Ahead(ahead, times)
