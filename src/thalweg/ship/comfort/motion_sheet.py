"""Motions and motion sickness by place and heading in one sea state."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from thalweg.core.units import HOUR, KNOT
from thalweg.ship.comfort.onboard_motions import onboard_motions
from thalweg.ship.methods.seakeeping.motion_sickness import (
    motion_sickness_dose,
    motion_sickness_percent_iso,
)
from thalweg.ship.methods.seakeeping.ship_motions import motions_validity

if TYPE_CHECKING:
    from thalweg.ship.ship import Ship

EXPOSURE_H: Final = 4.0  #: after which the share of people sick is stated [h]
HEADINGS_DEG: Final = tuple(range(0, 181, 15))  #: off the waves: 0 head, 180 following


def motion_sheet(
    ship: Ship, *, wave_height: float, wave_period: float, speed_kn: float | None = None
) -> dict[str, Any] | None:
    """Return motions and sickness at every place and heading, as plain data.

    Parameters
    ----------
    wave_height, wave_period : Significant height [m] and peak period [s] of long-crested waves.
    speed_kn : float, optional
        Speed through water [kn]; by default the highest of the ship in calm water. It is held on
        every heading.

    Returns
    -------
    dict or None
        ``headings_deg`` between bow and waves; ``heave_rms_m``, ``pitch_rms_deg`` by heading;
        ``places``: for each name root mean squares by heading and the percentage of people sick
        after `EXPOSURE_H`; ``tasks``: by heading whether each can be done. None where the ship
        file has no places.

    Raises
    ------
    InputError
        If a place is off the ship.
    """
    own = onboard_motions(ship)
    if own is None:
        return None
    speed = float(np.max(ship.speeds)) if speed_kn is None else speed_kn * KNOT
    angles = np.radians(HEADINGS_DEG)
    found = own.at(speed, wave_angle=angles, wave_height=wave_height, wave_period=wave_period)
    places = {}
    for name, at in found.places.items():
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
        good, known = own.workable(task, found)
        tasks[task] = [bool(g) if k else None for g, k in zip(good, known)]
    return {
        "speed_kn": speed / KNOT,
        "wave_height_m": wave_height,
        "wave_period_s": wave_period,
        "exposure_h": EXPOSURE_H,
        "headings_deg": list(HEADINGS_DEG),
        "heave_rms_m": _plain(found.heave),
        "pitch_rms_deg": _plain(np.degrees(found.pitch)),
        "places": places,
        "tasks": tasks,
        "warnings": [str(note) for note in motions_validity(speed, own.hull)],
    }


def _plain(values: Any) -> list[float | None]:
    return [float(v) if math.isfinite(v) else None for v in np.asarray(values, float)]
