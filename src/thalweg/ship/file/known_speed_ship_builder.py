"""Build the model of a ship whose file gives its calm-water speeds."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray
from thalweg.core.units import DAY, TONNE
from thalweg.ship.file.part_builders import build_speed_loss, hull_for_kwon, lightship_estimate
from thalweg.ship.hull.estimate import Estimate
from thalweg.ship.hull.hull import Hull
from thalweg.ship.loading_state import Loading
from thalweg.ship.models.known_speed_model import (
    KnownSpeedModel,
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
from thalweg.ship.schema.ship_schema import ShipFile


def build_known_speed_model(file: ShipFile, hull: Hull, loading: Loading) -> KnownSpeedModel:
    """Return the model of a ship that gives its calm-water speeds.

    Raises
    ------
    InputError : If there are no speeds, several kinds of them, or they contradict each other.
    """
    law = speed_power_law_name(file)
    _check_sea_margin(file)
    if law == "table":
        check_table(file.table)
    full, empty = calm_speeds(file, law)
    fuel, power = SPEED_POWER_LAWS[law](file, full)
    power_to_fuel_rate = None if law == "none" else _fuel_rate_of_power(file)
    if power_to_fuel_rate is not None:
        fuel = power_to_fuel_rate(power)
    check_table_rises(full, {"fuel_t_per_day": fuel * DAY / TONNE, "power_kw": power / 1000.0})
    loss, squat = build_speed_loss(file, hull, loading), build_squat_model(file, hull, loading)
    of_speed = SpeedPowerLaw(
        law, power_to_fuel_rate, hotel_fuel=file.engine.hotel_fuel_rate if law == "cubic" else 0.0
    )
    model = KnownSpeedModel(full, empty, fuel, power, of_speed, loss, squat)
    return with_settings(model, file)


def _check_sea_margin(file: ShipFile) -> None:
    """Refuse a sea margin where there is no power that it could raise."""
    if file.engine.sea_margin_percent > 0.0:
        raise InputError(
            "engine.sea_margin_percent is given for a ship with known speeds.",
            "It raises the power that a resistance takes; here power and fuel are given.",
            "Leave it out, and give figures that hold the margin.",
            key="engine.sea_margin_percent",
        )


def estimates_of_known_speeds(file: ShipFile, hull: Hull, loading: Loading) -> tuple[Estimate, ...]:
    """Return the estimated particulars of a ship that gives its speeds."""
    if file.models.speed_loss == "kwon_2008":
        hull = hull_for_kwon(hull, loading)
    light = lightship_estimate(file.loading, loading.displacement_empty)
    return (*hull.estimated, *light, *_fuel_estimates(file))


def _fuel_rate_of_power(file: ShipFile) -> Callable[[FloatArray], FloatArray] | None:
    """Return the fuel rate [kg/s] of a brake power [W], hotel load included.

    None when the file gives fuel itself, which is the whole ship's, or nothing to burn by. A single
    ``engine.sfoc_g_per_kwh`` holds at every power; by ``engine.type`` or a curve consumption
    follows the load.
    """
    engine = file.engine
    in_table = file.table is not None and file.table.daily_fuel is not None
    if in_table or file.fuel.reference_t_per_day is not None:
        return None
    if engine.sfoc_g_per_kwh is not None:
        sfoc, hotel = engine.sfoc_g_per_kwh, engine.hotel_fuel_rate
        return lambda power: np.asarray(power * sfoc / 3.6e9 + hotel)
    if engine.gives("type", "sfoc_curve_g_per_kwh"):
        from thalweg.ship.models.engine_plant import build_engine_plant  # reads methods of engines

        return build_engine_plant(file).fuel
    return None


def _fuel_estimates(file: ShipFile) -> tuple[Estimate, ...]:
    """Return what `_fuel_rate_of_power` estimated."""
    if _fuel_rate_of_power(file) is None or file.engine.sfoc_g_per_kwh is not None:
        return ()
    from thalweg.ship.models.engine_plant import build_engine_plant

    return build_engine_plant(file).estimated
