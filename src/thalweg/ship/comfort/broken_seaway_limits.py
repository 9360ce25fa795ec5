"""Which limit of safety or comfort in waves a ship breaks, with its value and what is allowed."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from thalweg.core.types import BoolArray, FloatArray
from thalweg.core.units import HOUR
from thalweg.ship.comfort.seaway_limit_names import (
    ACCELERATION_NAME,
    HIGH_WAVES_NAME,
    PARAMETRIC_ROLL_NAME,
    SICKNESS_NAME,
    SURF_RIDING_NAME,
    SYNCHRONOUS_ROLL_NAME,
)
from thalweg.ship.methods.seakeeping.motion_sickness import (
    motion_sickness_dose,
    motion_sickness_percent_iso,
)
from thalweg.ship.methods.seakeeping.stability_msc1_circ1228 import (
    HIGH_WAVE_SHARE,
    DangerousSituations,
    surf_riding_speed,
)
from thalweg.ship.seaway_limits import (
    AccelerationLimit,
    DangerousSituationLimits,
    SafetyLimits,
)


@dataclass(frozen=True)
class BrokenSeawayLimit:
    """One limit in waves, in some conditions.

    Attributes
    ----------
    name : With place and exposure, such as "motion sickness in 2 h amidships".
    broken : Where the ship breaks it.
    value, limit : What is limited, and the limit: people sick [%], root mean square of the
        acceleration [m/s2], speed through water [m/s], wave height [m], or period of encounter and
        the nearest one that is allowed [s].
    """

    name: str
    broken: BoolArray
    value: FloatArray
    limit: FloatArray


def broken_seaway_limits(
    safety: SafetyLimits,
    *,
    speed: FloatArray,
    wave_angle: FloatArray,
    wave_height: FloatArray,
    wave_period: FloatArray,
) -> list[BrokenSeawayLimit]:
    """Return the limits that a ship breaks somewhere in conditions, which are flat arrays.

    Parameters
    ----------
    speed : Through the water [m/s].
    wave_angle : Between the bow and where the waves come from [rad], 0 head to pi following.
    wave_height, wave_period : Significant height, above 0 [m], and peak period [s].
    """
    found = [
        _of_motion(
            limit,
            limit.ratio_to_limit(
                safety.hull, speed=speed, angle=wave_angle, height=wave_height, period=wave_period
            ),
        )
        for limit in safety.motions
    ]
    own = safety.situation_limits
    if own is not None:
        met = own.in_waves(speed, wave_angle, wave_height, wave_period, safety.hull.length)
        near = (
            f"encounter period within {own.roll_tolerance:.0%} of the roll period of "
            f"{own.roll_period:.3g} s"
        )
        known = {
            "surf_riding": (
                SURF_RIDING_NAME,
                speed,
                surf_riding_speed(wave_angle, length=safety.hull.length),
            ),
            "successive_high_waves": (
                HIGH_WAVES_NAME,
                wave_height,
                np.full(speed.shape, HIGH_WAVE_SHARE * safety.hull.length),
            ),
            "synchronous_roll": (
                f"{SYNCHRONOUS_ROLL_NAME}, {near}",
                *_periods(own, met, halved=False),
            ),
            "parametric_roll": (
                f"{PARAMETRIC_ROLL_NAME}, {near} or half of it",
                *_periods(own, met, halved=True),
            ),
        }
        found += [
            BrokenSeawayLimit(known[danger][0], getattr(met, danger), *known[danger][1:])
            for danger in own.dangers
        ]
    return [one for one in found if one.broken.any()]


def sickness_limit_text(safety: SafetyLimits | None) -> str:
    """Return the limit of motion sickness, such as ``40 % in 2 h amidships``; empty without one."""
    for limit in safety.motions if safety is not None else ():
        if limit.weighted:
            return f"{_percent(limit, 1.0):.3g} %{_exposure(limit)}"
    return ""


def _of_motion(limit: AccelerationLimit, ratio: FloatArray) -> BrokenSeawayLimit:
    """Return a limit of acceleration or of sickness, from the acceleration over its limit."""
    if limit.weighted:
        name, value = f"{SICKNESS_NAME}{_exposure(limit)}", _percent(limit, ratio)
        allowed = _percent(limit, 1.0)
    else:
        name, value = f"{ACCELERATION_NAME} {_place(limit.forward)}", limit.greatest * ratio
        allowed = np.asarray(limit.greatest)
    return BrokenSeawayLimit(name, ratio > 1.0, value, np.full(ratio.shape, float(allowed)))


def _percent(limit: AccelerationLimit, ratio: FloatArray | float) -> FloatArray:
    dose = motion_sickness_dose(limit.greatest * np.asarray(ratio), duration=limit.exposure)
    return motion_sickness_percent_iso(dose)


def _exposure(limit: AccelerationLimit) -> str:
    return f" in {limit.exposure / HOUR:g} h {_place(limit.forward)}"


def _place(forward: float) -> str:
    """Return a place on the centre line, by its distance ahead of midship [m]."""
    if math.isclose(forward, 0.0, abs_tol=0.05):
        return "amidships"
    return f"at {abs(forward):.3g} m {'ahead of' if forward > 0.0 else 'abaft'} midship"


def _periods(
    own: DangerousSituationLimits, met: DangerousSituations, *, halved: bool
) -> tuple[FloatArray, FloatArray]:
    """Return the periods of encounter, and the nearest that are no resonance [s]."""
    encounter, rolls, width = met.encounter_period, own.roll_period, own.roll_tolerance
    near = np.full(encounter.shape, rolls)
    if halved:
        near = np.where(np.abs(encounter / rolls - 1.0) < width, rolls, 0.5 * rolls)
    return encounter, near * np.where(encounter >= near, 1.0 + width, 1.0 - width)
