"""Motions and motion sickness by place and heading in one sea state."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from thalweg.core.given_numbers import finite_or_none
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR, KNOT
from thalweg.ship.comfort.onboard_motions import ROLL_NOTE, onboard_motions
from thalweg.ship.methods.seakeeping.motion_sickness import (
    motion_sickness_dose,
    motion_sickness_percent_iso,
)
from thalweg.ship.methods.seakeeping.ship_motions import motions_validity
from thalweg.ship.model_protocol import does_hold_speed
from thalweg.ship.performance_sheet_weather import assumed_peak_period, sheet_conditions

if TYPE_CHECKING:
    from thalweg.ship.ship import Ship

EXPOSURE_H: Final = 4.0  #: after which the share of people sick is stated [h]
HEADINGS_DEG: Final = tuple(range(0, 181, 15))  #: off the waves: 0 head, 180 following


def motion_sheet(
    ship: Ship, weather: Mapping[str, float], *, speed_kn: float | None = None
) -> dict[str, Any] | None:
    """Return motions and sickness at every place and heading, as plain data.

    Parameters
    ----------
    weather : As of `thalweg.ship.performance_sheet`, with ``wave_height`` [m]; a wind without an
        angle comes from the direction of the waves.
    speed_kn : float, optional
        Speed through water in calm water [kn]; by default the highest of the ship. The motions are
        those at the speed that she attains in these waves, with the same power or holding her speed
        up to the largest power.

    Returns
    -------
    dict or None : ``headings_deg`` between bow and waves; ``held``: "constant speed" or
        "constant power"; ``attained_speed_kn``, ``heave_rms_m``,
        ``pitch_rms_deg``, ``roll_rms_deg`` by heading; ``places``: for each name root mean squares
        by heading and the percentage of people sick after `EXPOSURE_H`; ``tasks``: by heading
        whether each can be done, none in waves above the limit of the ship. None where the ship
        file has no places.

    Raises
    ------
    InputError : If a place is off the ship.
    """
    own = onboard_motions(ship)
    if own is None:
        return None
    ordered = float(np.max(ship.speeds)) if speed_kn is None else speed_kn * KNOT
    angles = np.radians(HEADINGS_DEG)
    height = weather["wave_height"]
    period = weather.get("wave_period") or assumed_peak_period(height)
    speed = _attained_speed(ship, {**weather, "wave_period": period}, ordered)
    motions = own.at(speed, wave_angle=angles, wave_height=height, wave_period=period)
    places = {}
    for name, at in motions.places.items():
        dose = motion_sickness_dose(at.weighted, duration=EXPOSURE_H * HOUR)
        places[name] = {
            "ahead_of_midship_m": float(own.places[name]),
            "displacement_rms_m": _plain(at.displacement),
            "velocity_rms_m_s": _plain(at.velocity),
            "acceleration_rms_m_s2": _plain(at.acceleration),
            "weighted_acceleration_rms_m_s2": _plain(at.weighted),
            "sick_percent": _plain(motion_sickness_percent_iso(dose)),
        }
    tasks = {}
    for task in own.tasks:
        good, known = own.workable(task, motions)
        kept = height <= ship.limits.wave_height
        tasks[task] = [bool(g) and kept if k or not kept else None for g, k in zip(good, known)]
    return {
        "ordered_speed_kn": ordered / KNOT,
        "held": "constant speed" if does_hold_speed(ship.model) else "constant power",
        "wave_height_m": height,
        "wave_period_s": period,
        "exposure_h": EXPOSURE_H,
        "headings_deg": list(HEADINGS_DEG),
        "attained_speed_kn": _plain(speed / KNOT),
        "heave_rms_m": _plain(motions.heave),
        "pitch_rms_deg": _plain(np.degrees(motions.pitch)),
        "roll_rms_deg": _plain(np.degrees(motions.roll)),
        "places": places,
        "tasks": tasks,
        "warnings": [
            *(str(note) for note in motions_validity(speed, own.hull)),
            *([ROLL_NOTE] if own.roll_period is None else []),
        ],
    }


def _attained_speed(ship: Ship, weather: Mapping[str, float], ordered: float) -> FloatArray:
    """Return the speed [m/s] on each heading; NaN where the ship does not get ahead."""
    sailing = ship.with_speeds([ordered])
    found = []
    for heading in HEADINGS_DEG:
        angle = math.radians(heading)
        here = {"wind_angle": angle, **weather, "wave_angle": angle}
        found.append(float(sailing.speed_through_water(sheet_conditions(ship, here), 0)))
    return np.where(np.array(found) > 0.0, found, np.nan)


def _plain(values: Any) -> list[float | None]:
    return [finite_or_none(v) for v in np.asarray(values, float)]
