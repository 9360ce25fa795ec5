"""Squat, motions and stability at one speed, for the performance sheet."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from thalweg.core.given_numbers import finite_or_none
from thalweg.ship.conditions import Conditions
from thalweg.ship.hull.hull import Hull, complete_hull
from thalweg.ship.methods.seakeeping.motion_sickness import (
    motion_sickness_dose,
    motion_sickness_percent_iso,
    weighted_acceleration,
)
from thalweg.ship.methods.seakeeping.ship_motions import MotionHull, motions_validity, ship_response
from thalweg.ship.methods.seakeeping.stability_msc1_circ1228 import dangerous_situations
from thalweg.ship.methods.shallow_water.barrass_squat import squat_validity
from thalweg.ship.methods.shallow_water.squat import dynamic_under_keel_clearance
from thalweg.ship.models.resistance_protocol import ResistanceBased
from thalweg.ship.models.squat_model import SquatModel, squat_model_of
from thalweg.ship.seaway_limits import (
    EXPOSURE_TIME,
    MEAN_TO_PEAK_PERIOD_RATIO,
    natural_roll_period,
)
from thalweg.ship.ship import Ship

_DANGER_WORDS: Final = {
    "surf_riding": "surf-riding and broaching-to",
    "successive_high_waves": "successive high waves",
    "synchronous_roll": "synchronous roll",
    "parametric_roll": "parametric roll",
}


def squat_of_sheet(ship: Ship) -> SquatModel | None:
    """Return the squat that the sheet shows; None where the particulars do not suffice."""
    hull = ShipInSeaway.of(ship, Conditions()).hull
    return squat_model_of(ship.file, hull, ship.loading)


@dataclass(frozen=True)
class ShipInSeaway:
    """A ship in given water and waves.

    Attributes
    ----------
    conditions : One of each, SI.
    """

    ship: Ship
    hull: Hull
    conditions: Conditions

    @classmethod
    def of(cls, ship: Ship, conditions: Conditions) -> ShipInSeaway:
        """Use the particulars of the hull as in the ship's model, at the draught of the ship."""
        if isinstance(ship.model, ResistanceBased):
            return cls(ship, ship.model.balance(ship.loading.load_factor).calm.hull, conditions)
        hull = complete_hull(ship.file.hull.plain())
        afloat, sunk = {"draught_m": ship.draught}, squat_model_of(ship.file, hull, ship.loading)
        if sunk is not None and ship.draught > 0.0:
            afloat["block_coefficient"] = sunk.block_coefficient
        return cls(ship, Hull({**hull.values, **afloat}), conditions)

    def squat(self, speed: float) -> tuple[dict[str, Any] | None, list[str]]:
        """Squat and clearance [m] at a speed [m/s] where the depth is known, and warnings."""
        squat: SquatModel | None = squat_model_of(self.ship.file, self.hull, self.ship.loading)
        depth = float(self.conditions.depth)
        if squat is None or not np.isfinite(depth):
            return None, []
        sunk = float(squat.sinkage(speed, depth, self.ship.loading.load_factor))
        left = float(dynamic_under_keel_clearance(depth, self.ship.draught, squat=sunk))
        least = squat.clearance
        notes = [
            str(n)
            for n in squat_validity(
                depth, draught=self.ship.draught, block_coefficient=squat.block_coefficient
            )
        ]
        if not left >= least:
            notes.append(f"{left:.2f} m of water under the keel with squat, less than {least:g} m")
        return {
            "squat_m": finite_or_none(sunk),
            "under_keel_clearance_m": finite_or_none(left),
        }, notes

    def motions(self, speed: float) -> tuple[dict[str, Any] | None, list[str]]:
        """Motions by Jensen, Mansour and Olsen at a speed [m/s], and MSC.1/Circ.1228."""
        at, keys = self.conditions, ("breadth_m", "draught_m", "block_coefficient")
        length = self.hull.number("length_waterline_m") or self.hull.number(
            "length_between_perpendiculars_m"
        )
        sizes = [length, *(self.hull.number(key) for key in keys)]
        if not float(at.wave_height) > 0.0 or any(size is None for size in sizes):
            return None, []
        hull = MotionHull(*(float(size or 0.0) for size in sizes))
        common: dict[str, Any] = {
            "height": at.wave_height,
            "period": at.wave_period,
            "speed": speed,
        }
        middle = ship_response(**common, wave_angle=at.wave_angle, hull=hull)
        bow = ship_response(
            **common, wave_angle=at.wave_angle, hull=hull, forward=0.5 * hull.length
        )
        weighted = weighted_acceleration(middle.acceleration_parts, middle.encounter_frequency)
        dose = motion_sickness_dose(weighted, duration=EXPOSURE_TIME)
        values: Mapping[str, Any] = {
            "significant_heave_m": middle.heave.significant_amplitude,
            "significant_pitch_deg": np.degrees(middle.pitch.significant_amplitude),
            "largest_heave_3h_m": middle.heave.most_probable_maximum(),
            "largest_pitch_3h_deg": np.degrees(middle.pitch.most_probable_maximum()),
            "bow_acceleration_rms_m_s2": np.sqrt(bow.acceleration.m0),
            "motion_sickness_2h_percent": motion_sickness_percent_iso(dose),
        }
        notes = [str(note) for note in motions_validity(speed, hull)]
        return {k: finite_or_none(v) for k, v in values.items()}, [
            *notes,
            *self._dangers(speed, hull),
        ]

    def _dangers(self, speed: float, hull: MotionHull) -> list[str]:
        """The warnings of MSC.1/Circ.1228 at a speed [m/s]."""
        own = natural_roll_period(self.hull, hull)
        checks = dangerous_situations(
            speed=speed,
            wave_angle=self.conditions.wave_angle,
            wave_height=self.conditions.wave_height,
            wave_period=MEAN_TO_PEAK_PERIOD_RATIO * self.conditions.wave_period,
            length=hull.length,
            roll_period=own,
            harmless_wave_height=0.01 * hull.length,
        )
        return [
            f"MSC.1/Circ.1228: {words} may occur"
            for name, words in _DANGER_WORDS.items()
            if bool(getattr(checks, name))
        ]
