"""Build the parts of a ship from the checked data of a ship file."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Final

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.units import DAY, KNOT, SEA_WATER_DENSITY, TONNE
from thalweg.ship.fuel_prices import fuel_terms
from thalweg.ship.hull.hull import Hull, required_particulars, volume_at
from thalweg.ship.hull.hull_checks import check_depth
from thalweg.ship.loading_state import Loading
from thalweg.ship.model_protocol import Estimate, ShipModel
from thalweg.ship.models.fuel_from_power import fuel_estimates, fuel_rate_of_power
from thalweg.ship.models.known_speed_model import (
    KnownSpeedModel,
    KwonSpeedLoss,
    SpeedPowerLaw,
    check_table_rises,
)
from thalweg.ship.models.speed_power_laws import (
    SPEED_POWER_LAWS,
    calm_speeds,
    check_table,
    speed_power_law_name,
    with_settings,
)
from thalweg.ship.models.squat_model import build_squat_model
from thalweg.ship.ship_limits import ShipLimits

ShipData = Mapping[str, Any]
SAFETY_KEYS: Final = frozenset(
    {"msc_circ_1228", "max_vertical_acceleration_m_s2", "max_motion_sickness_percent"}
)


def simple_data(*, name: str, speeds_kn: list[float], **sections: ShipData) -> dict[str, Any]:
    """Return the data of a ship file from sections in which None means not given."""
    given = {
        section: {key: value for key, value in values.items() if value is not None}
        for section, values in sections.items()
    }
    return {"name": name, "speeds_kn": speeds_kn, **given}


def build_limits(data: ShipData) -> ShipLimits:
    """Return the limits of weather in a ship file."""
    given = data.get("limits", {})
    wind = given.get("max_wind_speed_m_s", given.get("max_wind_speed_kn", math.inf))
    if "max_wind_speed_m_s" in given and "max_wind_speed_kn" in given:
        raise InputError(
            "The wind limit is given twice, in knots and in m/s.",
            "One of them is enough; 1 kn is 0.5144 m/s.",
            "Keep max_wind_speed_kn or max_wind_speed_m_s.",
            key="limits.max_wind_speed_kn",
        )
    factor = KNOT if "max_wind_speed_kn" in given else 1.0
    waves = given.get("max_significant_wave_height_m", math.inf)
    return ShipLimits(wave_height=waves, wind_speed=wind * factor)


def with_safety_limits(
    limits: ShipLimits, data: ShipData, hull: Hull, loading: Loading
) -> ShipLimits:
    """Return limits with those of safety and comfort in a ship file.

    Raises
    ------
    InputError
    """
    if not SAFETY_KEYS & data.get("limits", {}).keys():
        return limits
    from thalweg.ship.models.seaway_limits import (
        build_safety_limits,  # reads the methods of motions
    )

    return replace(limits, safety=build_safety_limits(data, hull, loading))


def build_loading(data: ShipData, hull: Hull) -> Loading:
    """Return the loading of a ship file.

    Raises
    ------
    InputError
        If there is no draught.
    """
    given = data.get("loading", {})
    full = given.get("draught_full_m", hull.number("draught_m"))
    if full is None:
        raise _missing_draught_error(data, hull)
    check_depth(hull, full, "loading.draught_full_m")
    empty, own = given.get("draught_empty_m", full), hull.number("draught_m") or full
    volume = hull.number("displacement_m3")
    if volume is not None and own != full:
        volume = volume_at(hull, volume, at=own, draught=full)
    displaced = _displaced_volume(given, "full", volume)
    if volume is not None and not 0.9 < displaced / volume < 1.1:
        raise InputError(
            f"The full ship displaces {displaced:.6g} m3 by 'loading' and {volume:.6g} by 'hull'.",
            "They are the same at loading.draught_full_m.",
            "Correct or leave out one of them.",
            key="loading.displacement_full_m3",
        )
    light = displaced
    if empty != full and not {"displacement_empty_m3", "weight_empty_t"} & given.keys():
        light = volume_at(hull, displaced, at=full, draught=empty)
    return Loading(
        draught_full=full,
        draught_empty=empty,
        displacement_full=displaced,
        displacement_empty=_displaced_volume(given, "empty", light),
        load_factor=given.get("load_factor", 1.0),
        condition=given.get("condition", "loaded"),
        capacity=given.get("capacity_m3", math.nan),
    )


def lightship_estimate(data: ShipData, volume: float) -> tuple[Estimate, ...]:
    """Tell the displacement of the empty ship [m3] where the ship file does not."""
    given = data.get("loading", {})
    told = {"displacement_empty_m3", "weight_empty_t"} & given.keys()
    if told or "draught_empty_m" not in given or not math.isfinite(volume):
        return ()
    how = "by the block coefficient at that draught, Jalkanen et al. (2012)"
    return (Estimate("loading.displacement_empty_m3", volume, how),)


def _missing_draught_error(data: ShipData, hull: Hull) -> InputError:
    """The error for a ship without draught; it names what else a resistance would need."""
    missing = ["hull.draught_m"]
    method = data.get("models", {}).get("calm_water", "none")
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


def _displaced_volume(given: ShipData, state: str, hull_volume: float | None) -> float:
    """Displaced volume [m3] from a volume, or from a weight in sea water."""
    if f"displacement_{state}_m3" in given:
        return float(given[f"displacement_{state}_m3"])
    if f"weight_{state}_t" in given:
        return float(given[f"weight_{state}_t"]) * TONNE / SEA_WATER_DENSITY
    return math.nan if hull_volume is None else hull_volume


def build_model(data: ShipData, hull: Hull, loading: Loading) -> ShipModel:
    """Return the model a ship file asks for.

    Raises
    ------
    InputError
        For unknown methods, methods that do not go together, and missing data.
    """
    fuel_terms(data)  # refuses unknown fuels and two prices for one thing
    models = data.get("models", {})
    acting = [name for name in RESISTANCE_MODEL_KEYS if models.get(name, "none") != "none"]
    if models.get("calm_water", "none") in SPEED_POWER_LAWS and not acting:
        return build_known_speed_model(data, hull, loading)
    from thalweg.ship.file.resistance_ship_builder import (
        build_resistance_model,  # the physics is needed from here on
    )

    return build_resistance_model(data, hull, loading)


def build_known_speed_model(data: ShipData, hull: Hull, loading: Loading) -> KnownSpeedModel:
    """Return the model of a ship that gives its calm-water speeds.

    Raises
    ------
    InputError
        If there are no speeds, several kinds of them, or they contradict each other.
    """
    law = speed_power_law_name(data)
    _check_sea_margin(data)
    if law == "table":
        check_table(data)
    full, empty = calm_speeds(data, law)
    fuel, power = SPEED_POWER_LAWS[law](data, full)
    power_to_fuel_rate = None if law == "none" else fuel_rate_of_power(data)
    if power_to_fuel_rate is not None:
        fuel = power_to_fuel_rate(power)
    check_table_rises(full, {"fuel_t_per_day": fuel * DAY / TONNE, "power_kw": power / 1000.0})
    loss, squat = build_speed_loss(data, hull, loading), build_squat_model(data, hull, loading)
    model = KnownSpeedModel(
        full, empty, fuel, power, SpeedPowerLaw(law, power_to_fuel_rate), loss, squat
    )
    return with_settings(model, data)


def _check_sea_margin(data: ShipData) -> None:
    """Refuse a sea margin where there is no power that it could raise.

    Raises
    ------
    InputError
    """
    if data.get("engine", {}).get("sea_margin_percent", 0.0) > 0.0:
        raise InputError(
            "engine.sea_margin_percent is given for a ship with known speeds.",
            "It raises the power that a resistance takes; here power and fuel are given.",
            "Leave it out, and give figures that hold the margin.",
            key="engine.sea_margin_percent",
        )


def build_speed_loss(data: ShipData, hull: Hull, loading: Loading) -> KwonSpeedLoss | None:
    """Return the speed loss chosen under ``models.speed_loss``."""
    models = data.get("models", {})
    name = models.get("speed_loss", "none")
    if name not in SPEED_LOSSES:
        raise unknown_name_error("speed loss", name, SPEED_LOSSES)
    if name == "none":
        return None
    hull = _hull_for_kwon(hull, loading)
    length, block = required_particulars(
        hull, _KWON_PARTICULARS, "kwon_2008", instead="speed_loss: none"
    )
    if math.isnan(loading.displacement_full):
        required_particulars(hull, ("displacement_m3",), "kwon_2008", instead="speed_loss: none")
    return KwonSpeedLoss(
        length=length,
        block_coefficient=block,
        loading=loading,
        sign="plus" if models.get("kwon_sign", "plus") == "plus" else "printed",
        ship_type=models.get("kwon_ship_type", "other"),
        classes=models.get("kwon_classes", False),
    )


_KWON_PARTICULARS: Final = ("length_between_perpendiculars_m", "block_coefficient")


def _hull_for_kwon(hull: Hull, loading: Loading) -> Hull:
    """The hull with what Kwon's method needs, estimated where that is possible."""
    if hull.number("displacement_m3") is None and not math.isnan(loading.displacement_full):
        deep = {"displacement_m3": loading.displacement_full, "draught_m": loading.draught_full}
        hull = Hull({**hull.values, **deep}, hull.estimated)
    if any(hull.number(key) is None for key in _KWON_PARTICULARS):
        from thalweg.ship.hull.hull_estimates import estimate_particulars  # reads many regressions

        hull = estimate_particulars(hull, _KWON_PARTICULARS)
    return hull


def estimates_of_known_speeds(data: ShipData, hull: Hull, loading: Loading) -> tuple[Estimate, ...]:
    """What was estimated of a ship that gives its speeds."""
    if data.get("models", {}).get("speed_loss", "none") != "none":
        hull = _hull_for_kwon(hull, loading)
    light = lightship_estimate(data, loading.displacement_empty)
    return (*hull.estimated, *light, *fuel_estimates(data))


#: models that act on a resistance
RESISTANCE_MODEL_KEYS: Final = (
    "waves",
    "wind",
    "shallow_water",
    "friction",
    "propulsion",
    "rudder",
)
SPEED_LOSSES: Final = ("none", "kwon_2008")
