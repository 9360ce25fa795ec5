"""Loading, limits and speed loss of a ship, from the sections of its file."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Final, Literal

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.units import KNOT, SEA_WATER_DENSITY, TONNE
from thalweg.ship.hull.estimate import Estimate
from thalweg.ship.hull.hull import Hull, required_particulars, volume_at
from thalweg.ship.hull.hull_checks import check_depth
from thalweg.ship.loading_state import Loading
from thalweg.ship.models.kwon_speed_loss import KwonSpeedLoss
from thalweg.ship.models.prestegardshus_speed_loss import PrestegardshusSpeedLoss
from thalweg.ship.models.speed_power_laws import SPEED_POWER_LAWS
from thalweg.ship.schema.ship_schema import LoadingSection, ModelsSection, ShipFile
from thalweg.ship.ship_limits import ShipLimits

SAFETY_KEYS: Final = frozenset(
    {"msc_circ_1228", "max_vertical_acceleration_m_s2", "max_motion_sickness_percent"}
)
#: models that act on a resistance
RESISTANCE_MODEL_KEYS: Final = (
    "waves",
    "wind",
    "shallow_water",
    "friction",
    "propulsion",
    "rudder",
)
SPEED_LOSSES: Final = ("none", "kwon_2008", "prestegardshus_2020")
_KWON_PARTICULARS: Final = ("length_between_perpendiculars_m", "block_coefficient")


def build_limits(file: ShipFile) -> ShipLimits:
    """Return the limits of weather in a ship file.

    Raises
    ------
    InputError : If the wind limit is given in two units.
    """
    given = file.limits
    wind = math.inf if given.max_wind_speed_m_s is None else given.max_wind_speed_m_s
    if given.max_wind_speed_kn is not None and given.max_wind_speed_m_s is not None:
        raise InputError(
            "The wind limit is given twice, in knots and in m/s.",
            "One of them is enough; 1 kn is 0.5144 m/s.",
            "Keep max_wind_speed_kn or max_wind_speed_m_s.",
            key="limits.max_wind_speed_kn",
        )
    if given.max_wind_speed_kn is not None:
        wind = given.max_wind_speed_kn * KNOT
    waves = given.max_significant_wave_height_m
    return ShipLimits(wave_height=math.inf if waves is None else waves, wind_speed=wind)


def with_safety_limits(
    limits: ShipLimits, file: ShipFile, hull: Hull, loading: Loading
) -> ShipLimits:
    """Return limits with those of safety and comfort in a ship file.

    Parameters
    ----------
    limits : Limits of wave height and wind speed.

    Raises
    ------
    InputError
    """
    if not file.limits.gives(*SAFETY_KEYS):
        return limits
    from thalweg.ship.seaway_limits import (
        build_safety_limits,  # reads the methods of motions
    )

    return replace(limits, safety=build_safety_limits(file.limits, hull, loading))


def build_loading(file: ShipFile, hull: Hull) -> Loading:
    """Return the loading of a ship file.

    Returns
    -------
    Loading : Draughts and displacements.

    Raises
    ------
    InputError : If there is no draught.
    """
    given = file.loading
    full = hull.number("draught_m") if given.draught_full_m is None else given.draught_full_m
    if full is None:
        raise _missing_draught_error(file, hull)
    check_depth(hull, full, "loading.draught_full_m")
    empty = full if given.draught_empty_m is None else given.draught_empty_m
    own = hull.number("draught_m") or full
    volume = hull.number("displacement_m3")
    if volume is not None and own != full:
        volume = volume_at(hull, volume, at=own, draught=full)
    displaced = _displaced_volume(given.displacement_full_m3, given.weight_full_t, volume)
    if volume is not None and not 0.9 < displaced / volume < 1.1:
        raise InputError(
            f"The full ship displaces {displaced:.6g} m3 by 'loading' and {volume:.6g} by 'hull'.",
            "They are the same at loading.draught_full_m.",
            "Correct or leave out one of them.",
            key="loading.displacement_full_m3",
        )
    light = displaced
    if empty != full and not given.gives("displacement_empty_m3", "weight_empty_t"):
        light = volume_at(hull, displaced, at=full, draught=empty)
    return Loading(
        draught_full=full,
        draught_empty=empty,
        displacement_full=displaced,
        displacement_empty=_displaced_volume(
            given.displacement_empty_m3, given.weight_empty_t, light
        ),
        load_factor=given.load_factor,
        condition=given.condition,
        capacity=math.nan if given.capacity_m3 is None else given.capacity_m3,
    )


def lightship_estimate(given: LoadingSection, volume: float) -> tuple[Estimate, ...]:
    """Return the displacement of the empty ship [m3] as an estimate, if the file gives none."""
    known = given.gives("displacement_empty_m3", "weight_empty_t")
    if known or given.draught_empty_m is None or not math.isfinite(volume):
        return ()
    how = "by the block coefficient at that draught, Jalkanen et al. (2012)"
    return (Estimate("loading.displacement_empty_m3", volume, how),)


def _missing_draught_error(file: ShipFile, hull: Hull) -> InputError:
    """The error for a ship without draught; it names what else a resistance would need."""
    missing = ["hull.draught_m"]
    method = file.models.calm_water or "none"
    if method not in SPEED_POWER_LAWS:
        lengths = ("length_between_perpendiculars_m", "length_waterline_m", "length_overall_m")
        volumes = ("displacement_m3", "displacement_t", "block_coefficient")
        for keys in (lengths, ("breadth_m",), volumes):
            if all(key not in hull.values for key in keys):
                missing.append(f"hull.{keys[0]}")
    more = f" {method} also needs {', '.join(missing[1:])}." if missing[1:] else ""
    return InputError(
        "The ship file gives no draught.",
        "It is hull.draught_m, the mean of hull.draught_fore_m and hull.draught_aft_m, or "
        f"loading.draught_full_m with loading.draught_empty_m.{more}",
        f"Add {' and '.join(missing)}.",
        missing=missing,
    )


def _displaced_volume(
    volume: float | None, weight_t: float | None, hull_volume: float | None
) -> float:
    """Displaced volume [m3] from a volume, a weight in sea water [t], or the hull's own volume."""
    if volume is not None:
        return volume
    if weight_t is not None:
        return weight_t * TONNE / SEA_WATER_DENSITY
    return math.nan if hull_volume is None else hull_volume


def resistance_methods(file: ShipFile) -> list[str]:
    """Return the keys of 'models' that choose a method which acts on a resistance."""
    given = file.models.model_dump(include=set(RESISTANCE_MODEL_KEYS), exclude_unset=True)
    return [name for name in RESISTANCE_MODEL_KEYS if given.get(name, "none") != "none"]


def build_speed_loss(
    file: ShipFile, hull: Hull, loading: Loading
) -> KwonSpeedLoss | PrestegardshusSpeedLoss | None:
    """Return the speed loss chosen under ``models.speed_loss``."""
    models = file.models
    name = models.speed_loss
    if name not in SPEED_LOSSES:
        raise unknown_name_error("speed loss", name, SPEED_LOSSES)
    if name == "none":
        return None
    if name == "prestegardshus_2020":
        return _rule_of_prestegardshus(models)
    hull = hull_for_kwon(hull, loading)
    length, block = required_particulars(
        hull, _KWON_PARTICULARS, "kwon_2008", instead="speed_loss: none"
    )
    if math.isnan(loading.displacement_full):
        required_particulars(hull, ("displacement_m3",), "kwon_2008", instead="speed_loss: none")
    return KwonSpeedLoss(
        length=length,
        block_coefficient=block,
        loading=loading,
        sign="plus" if models.kwon_sign == "plus" else "printed",
        ship_type=_kwon_form_of(file),
        classes=models.kwon_classes,
    )


def _kwon_form_of(file: ShipFile) -> Literal["other", "container"]:
    """Return the form of Kwon's method that is given, else that of the type of the ship."""
    if file.models.gives("kwon_ship_type"):
        return file.models.kwon_ship_type
    return "container" if "container" in (file.hull.type or "").casefold() else "other"


def _rule_of_prestegardshus(models: ModelsSection) -> PrestegardshusSpeedLoss:
    height, wind = models.largest_wave_height_m, models.largest_wind_speed_m_s
    if height is None or wind is None:
        raise InputError(
            "speed_loss: prestegardshus_2020 needs the largest waves and the strongest wind.",
            "It takes both as shares of the largest of the data.",
            "Add models.largest_wave_height_m and models.largest_wind_speed_m_s, or choose "
            "kwon_2008.",
            key="models.speed_loss",
        )
    return PrestegardshusSpeedLoss(height, wind, models.nothing_lost_in_calm)


def hull_for_kwon(hull: Hull, loading: Loading) -> Hull:
    """The hull with what Kwon's method needs, estimated where that is possible.

    Returns
    -------
    Hull : With a block coefficient, length and displaced volume if possible.
    """
    if hull.number("displacement_m3") is None and not math.isnan(loading.displacement_full):
        deep = {"displacement_m3": loading.displacement_full, "draught_m": loading.draught_full}
        hull = Hull({**hull.values, **deep}, hull.estimated)
    if any(hull.number(key) is None for key in _KWON_PARTICULARS):
        from thalweg.ship.hull.hull_estimates import estimate_particulars  # reads many regressions

        hull = estimate_particulars(hull, _KWON_PARTICULARS)
    return hull
