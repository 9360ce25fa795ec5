"""Motions at the named places of a ship, and the tasks that they allow."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.types import BoolArray, FloatArray
from thalweg.ship.hull.hull import complete_hull
from thalweg.ship.hull.hull_checks import check_aboard
from thalweg.ship.methods.seakeeping.motion_sickness import weighted_acceleration
from thalweg.ship.methods.seakeeping.roll_motion import ROLL_DAMPING, roll_rms
from thalweg.ship.methods.seakeeping.ship_motions import MotionHull, ship_response
from thalweg.ship.seaway_limits import (
    LONGEST_PERIOD,
    SHORTEST_PERIOD,
    make_motion_hull,
    natural_roll_period,
)

if TYPE_CHECKING:
    from thalweg.ship.schema.ship_schema import TaskSection
    from thalweg.ship.ship import Ship

_BLOCK_SIZE: Final = 20_000  # conditions that are worked at once
ROLL_NOTE: Final = (
    "Roll is not known: give hull.roll_period_s or hull.metacentric_height_m in the ship file."
)


@dataclass(frozen=True)
class PlaceMotions:
    """Root mean squares of the vertical motion at a place.

    Attributes
    ----------
    displacement, velocity, acceleration : [m], [m/s], [m/s2].
    weighted : Acceleration weighted by W_f of ISO 2631-1, a_w [m/s2].
    """

    displacement: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    weighted: FloatArray


@dataclass(frozen=True)
class ShipMotions:
    """Motions of a ship in given conditions: root mean squares; NaN where unknown.

    Attributes
    ----------
    heave : At midship [m].
    pitch : float64 array [rad]
    roll : [rad]; NaN everywhere where the ship has no natural roll period.
    places : By the names of the ship file; on the centre line, so that roll does not move them.
    """

    heave: FloatArray
    pitch: FloatArray
    roll: FloatArray
    places: dict[str, PlaceMotions]


@dataclass(frozen=True)
class OnboardMotions:
    """The hull and the places of a ship, for her motions.

    Attributes
    ----------
    places : Distance ahead of midship on the centre line [m], by name; the first is that which the
        objective comfort counts.
    tasks : Limits of motions by task.
    roll_period : Natural period [s]; None where the ship file gives neither it nor GM.
    roll_damping : Share of the critical damping.
    """

    hull: MotionHull
    places: Mapping[str, float]
    tasks: Mapping[str, TaskSection]
    roll_period: float | None = None
    roll_damping: float = ROLL_DAMPING

    @property
    def first_place(self) -> str:
        """The place that the objective comfort counts."""
        return next(iter(self.places))

    def at(
        self,
        speed: ArrayLike,
        *,
        wave_angle: ArrayLike,
        wave_height: ArrayLike,
        wave_period: ArrayLike,
    ) -> ShipMotions:
        """Return the motions in conditions.

        Parameters
        ----------
        speed : Through the water [m/s].
        wave_angle : Between the bow and where the waves come from [rad], 0 head to pi following.
        wave_height, wave_period : array_like
            Significant height [m] and peak period [s]; periods are taken within 2 to 30 s.

        Returns
        -------
        ShipMotions : In the broadcast shape; zero without waves, NaN where a value is unknown.

        References
        ----------
        J. J. Jensen, A. E. Mansour, A. S. Olsen, Ocean Engineering 31 (2004), with strip decay
        (`thalweg.ship.methods.seakeeping.ship_motions`); ISO 2631-1:1997 for the weighting; roll
        by `thalweg.ship.methods.seakeeping.roll_motion`.
        """
        given = np.broadcast_arrays(
            *(np.asarray(x, float) for x in (speed, wave_angle, wave_height, wave_period))
        )
        shape = given[0].shape
        flat = [np.ravel(x) for x in given]
        names, count = list(self.places), flat[0].size
        forward = np.array([[self.places[name]] for name in names])
        rows = np.empty((4, len(names), count))
        common = np.empty((3, count))
        for first in range(0, count, _BLOCK_SIZE):
            part = slice(first, first + _BLOCK_SIZE)
            v, angle, height, period = (x[part] for x in flat)
            state = ship_response(
                height=height,
                period=np.clip(period, SHORTEST_PERIOD, LONGEST_PERIOD),
                wave_angle=angle,
                speed=v,
                hull=self.hull,
                forward=forward,
            )
            rows[0][:, part] = np.sqrt(state.motion.m0)
            rows[1][:, part] = np.sqrt(state.motion.m2)
            rows[2][:, part] = np.sqrt(state.acceleration.m0)
            rows[3][:, part] = weighted_acceleration(
                state.acceleration_parts, state.encounter_frequency
            )
            common[0, part] = np.sqrt(state.heave.m0[0])
            common[1, part] = np.sqrt(state.pitch.m0[0])
            common[2, part] = self._roll(v, angle, height, period)
        places = {
            name: PlaceMotions(*(row[k].reshape(shape) for row in rows))
            for k, name in enumerate(names)
        }
        heave, pitch, roll = (row.reshape(shape) for row in common)
        return ShipMotions(heave, pitch, roll, places)

    def _roll(
        self, speed: FloatArray, angle: FloatArray, height: FloatArray, period: FloatArray
    ) -> FloatArray:
        if self.roll_period is None:
            return np.full(len(speed), np.nan)
        return roll_rms(
            height=height,
            period=np.clip(period, SHORTEST_PERIOD, LONGEST_PERIOD),
            wave_angle=angle,
            speed=speed,
            hull=self.hull,
            natural_period=self.roll_period,
            damping=self.roll_damping,
        )

    def workable(self, task: str, motions: ShipMotions) -> tuple[BoolArray, BoolArray]:
        """Return where a task can be done, and where that is known.

        Parameters
        ----------
        task : Name of the ship file.
        motions : Motions in conditions.

        Returns
        -------
        workable, known : A limit that is exceeded decides, even where another motion is unknown.

        Raises
        ------
        InputError : If the ship file has no such task.
        """
        if task not in self.tasks:
            raise unknown_name_error("task of the ship", task, self.tasks)
        limits = self.tasks[task]
        at = motions.places[limits.place]
        checks = (
            (at.acceleration, limits.max_vertical_acceleration_m_s2, 1.0),
            (at.velocity, limits.max_vertical_velocity_m_s, 1.0),
            (motions.pitch, limits.max_pitch_deg, 180.0 / np.pi),
            (motions.roll, limits.max_roll_deg, 180.0 / np.pi),
        )
        good, known = np.ones(motions.heave.shape, bool), np.ones(motions.heave.shape, bool)
        for values, most, factor in checks:
            if most is None:
                continue
            with np.errstate(invalid="ignore"):
                good &= ~(values * factor > most)
            known &= np.isfinite(values)
        return good & known, known | ~good


def onboard_motions(ship: Ship) -> OnboardMotions | None:
    """Return what the motions on board of a ship follow from; None where its file has no places.

    Raises
    ------
    InputError : If a place is off the ship, or a task names a place that the file does not have.
    """
    file = ship.file
    if not file.places:
        if file.tasks:
            raise InputError(
                f"The ship {ship.name!r} has tasks but no places.",
                "A task has limits at a place of the ship.",
                "Add places to the ship file, such as places: {laboratory: -4.0}.",
                key="places",
            )
        return None
    complete = complete_hull(file.hull.plain())
    hull = make_motion_hull(complete, ship.loading)
    for name, forward in file.places.items():
        key = f"places.{name}"
        check_aboard(
            f"The place {name!r} is", forward, hull.length, remedy=f"Correct {key}.", key=key
        )
    for name, task in file.tasks.items():
        if task.place not in file.places:
            raise unknown_name_error(f"place for the task {name!r}", task.place, file.places)
    damping = file.hull.roll_damping
    return OnboardMotions(
        hull,
        dict(file.places),
        dict(file.tasks),
        natural_roll_period(complete, hull),
        ROLL_DAMPING if damping is None else damping,
    )


def required_motions(ship: Ship) -> OnboardMotions:
    """Return `onboard_motions`, or raise `InputError` where the ship has no places."""
    motions = onboard_motions(ship)
    if motions is None:
        raise InputError(
            f"The comfort on board of {ship.name!r} is not known: she has no named places.",
            "Motions are computed at places of the ship file, such as places: {bridge: 10.0, "
            "mess: -5.0} (ahead of midship [m]), from hull particulars and waves.",
            "Add places, or choose a ship that has them, such as gunnerus-2019.",
            key="places",
        )
    return motions
