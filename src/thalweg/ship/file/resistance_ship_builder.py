"""Build the model of a ship with a resistance from the methods that its file names."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.units import GRAVITY, KNOT
from thalweg.ship.file.cubic_law_ship_builder import cubic_law_plant, cubic_law_resistance
from thalweg.ship.file.part_builders import (
    build_limits,
    build_speed_loss,
    lightship_estimate,
    resistance_methods,
)
from thalweg.ship.hull.estimate import Estimate
from thalweg.ship.hull.hull import Hull, required_particulars
from thalweg.ship.hull.hull_estimates import estimate_particulars, hull_at_load_factor
from thalweg.ship.loading_state import Loading
from thalweg.ship.models.added_resistance_model import build_wave_resistance, build_wind_resistance
from thalweg.ship.models.calm_water_model import CALM_WATER_METHODS, build_calm_water
from thalweg.ship.models.engine_plant import EngineOrders, EnginePlant, build_engine_plant
from thalweg.ship.models.force_balance import ForceBalance
from thalweg.ship.models.kwon_resistance_model import KwonResistanceModel
from thalweg.ship.models.kwon_speed_loss import KwonSpeedLoss
from thalweg.ship.models.prestegardshus_speed_loss import PrestegardshusSpeedLoss
from thalweg.ship.models.propulsion_model import build_propulsion
from thalweg.ship.models.resistance_model import ResistanceModel
from thalweg.ship.models.speed_power_laws import speed_power_law_name
from thalweg.ship.models.squat_model import build_squat_model
from thalweg.ship.schema.ship_schema import ModelsSection, ShipFile

RUDDER_METHODS = ("none", "schless_2023")
_MODEL_SECTIONS = {"hull", "propulsion", "engine", "loading", "models", "water"}


def build_resistance_model(
    file: ShipFile, hull: Hull, loading: Loading
) -> ResistanceModel | KwonResistanceModel:
    """Return the model of a ship file that chooses a calm-water resistance.

    Raises
    ------
    InputError
        For unknown methods (with near matches), methods that do not go together, and missing data.
    """
    calm = file.models.calm_water or speed_power_law_name(file)
    if calm == "cubic" or calm in CALM_WATER_METHODS:
        return _assemble_resistance_model(file, hull, loading)
    if calm not in ("none", "cubic", "table"):
        raise unknown_name_error(
            "calm-water model", calm, ("none", "cubic", "table", *CALM_WATER_METHODS)
        )
    idle = resistance_methods(file)
    raise InputError(
        f"The ship file chooses {', '.join(f'models.{name}' for name in idle)}, but has no "
        "resistance they could act on.",
        f"They go with models.calm_water among {', '.join(CALM_WATER_METHODS)}; waves and wind "
        "also with cubic.",
        "Choose one of those, or speed_loss: kwon_2008 for a ship with known speeds.",
        key=f"models.{idle[0]}",
    )


def _assemble_resistance_model(
    file: ShipFile, hull: Hull, loading: Loading
) -> ResistanceModel | KwonResistanceModel:
    """Return the model of a ship file whose methods go together."""
    loss = build_speed_loss(file, hull, loading)
    loss = _checked_speed_loss(file.models, loss)
    _check_squat_and_rudder(file, hull, loading)
    full = _full_hull(hull, loading)
    balance_at = _force_balance_by_loading(file, full, loading)
    plant = cubic_law_plant(file) if _is_cubic(file) else build_engine_plant(file)
    orders, guessed = _build_engine_orders(file, balance_at(1.0), plant)
    light = hull_at_load_factor(full, loading, 0.0).number("displacement_m3")
    guessed = (*guessed, *lightship_estimate(file.loading, light or np.nan))
    plant = replace(plant, estimated=(*plant.estimated, *guessed))
    facts = file.model_dump(include=_MODEL_SECTIONS, exclude_unset=True)
    model = ResistanceModel(balance_at, plant, orders, facts, build_limits(file))
    with np.errstate(all="ignore"):
        speeds = model.speeds(1.0)
    _check_calm_water_power(model.balance(1.0), speeds, 1.0)
    if orders.kind == "speed":
        model.with_speeds(model.speeds(1.0), 1.0)  # refuses speeds beyond the engines
    return model if loss is None else KwonResistanceModel(model, loss)


def _checked_speed_loss(
    models: ModelsSection, loss: KwonSpeedLoss | PrestegardshusSpeedLoss | None
) -> KwonSpeedLoss | None:
    """Return Kwon's speed loss; refuse it with a method for waves or wind, and other rules."""
    weather = {"waves": models.waves, "wind": models.wind}
    twice = [name for name, method in weather.items() if method != "none"]
    if isinstance(loss, PrestegardshusSpeedLoss):
        raise InputError(
            "speed_loss: prestegardshus_2020 is chosen for a ship with a resistance.",
            "That rule is for ships with known speeds.",
            "Choose methods for waves and wind, or kwon_2008.",
            key="models.speed_loss",
        )
    if loss is not None and twice:
        raise InputError(
            f"speed_loss: {models.speed_loss} is chosen together with "
            f"{' and '.join(f'models.{name}' for name in twice)}.",
            "Kwon's loss includes wind and waves; with both the weather would count twice.",
            "Leave out one of them.",
            key="models.speed_loss",
        )
    return loss


def _check_squat_and_rudder(file: ShipFile, hull: Hull, loading: Loading) -> None:
    """Refuse a squat that limits the speed, and unknown rudder methods."""
    models = file.models
    if build_squat_model(file, hull, loading) is not None:
        raise InputError(
            f"squat: {models.squat} is for ships with known calm-water speeds.",
            "For ships with a resistance the bed acts through models.shallow_water.",
            "Leave squat out; the sinkage is shown for every ship whose particulars are known.",
            key="models.squat",
        )
    if models.rudder not in RUDDER_METHODS:
        raise unknown_name_error("rudder method", models.rudder, RUDDER_METHODS)


def _full_hull(hull: Hull, loading: Loading) -> Hull:
    """The hull at full draught, with estimated lengths and displacement."""
    full = estimate_particulars(hull, ("length_waterline_m", "length_between_perpendiculars_m"))
    if full.number("draught_m") is None:
        deep = loading.draught_full
        ends = {"draught_m": deep, "draught_fore_m": deep, "draught_aft_m": deep}
        full = Hull({**full.values, **ends}, full.estimated)
    return _with_loading_displacement(full, loading)


def _force_balance_by_loading(
    file: ShipFile, full: Hull, loading: Loading
) -> Callable[[float], ForceBalance]:
    """Return the function that makes the force balance at a load factor."""
    draughts = {loading.draught_full, loading.draught_empty, float(full.values["draught_m"])}

    def balance_at(load_factor: float) -> ForceBalance:
        floated = full
        with np.errstate(all="ignore"):
            if len(draughts) > 1:
                wanted = ("waterplane_coefficient", "displacement_m3", "midship_coefficient")
                floated = hull_at_load_factor(
                    estimate_particulars(full, wanted), loading, load_factor
                )
            balance = _build_force_balance(file, floated)
        _check_calm_water_power(balance, _moderate_speed(balance), load_factor)
        return balance

    return balance_at


def _moderate_speed(balance: ForceBalance) -> NDArray[np.float64]:
    """A speed [m/s] within the range of every method: a Froude number of 0.18."""
    length = float(balance.calm.hull.values["length_between_perpendiculars_m"])
    return np.array([0.18 * np.sqrt(GRAVITY * length)])


def _check_calm_water_power(
    balance: ForceBalance, speeds: NDArray[np.float64], load_factor: float
) -> None:
    """Refuse a hull for which the chosen methods give no power in calm water."""
    calm = {
        "depth": np.full(speeds.shape, np.inf),
        **{name: np.zeros(speeds.shape) for name in ("wind_speed", "wind_angle")},
        **{name: np.zeros(speeds.shape) for name in ("wave_height", "wave_angle", "wave_period")},
    }
    with np.errstate(all="ignore"):
        power = balance.brake_power(calm, np.where(np.isfinite(speeds), speeds, 5.0))
    if (np.isfinite(speeds) & (speeds > 0.0) & np.isfinite(power) & (power > 0.0)).all():
        return
    outside = [str(note) for note in balance.calm.notes(np.array([5.0]), np.array([np.inf]))]
    loaded = "" if load_factor == 1.0 else f" at load factor {load_factor:g}"
    raise InputError(
        f"{balance.calm.method} has no resistance for this hull{loaded}.",
        "; ".join(outside) or "Its particulars are outside the range of the method.",
        "Check the particulars, or choose another calm_water method.",
    )


def _with_loading_displacement(hull: Hull, loading: Loading) -> Hull:
    """The hull with the full displacement of the loading, when it gives none itself."""
    volume = loading.displacement_full
    if hull.number("displacement_m3") is not None or not np.isfinite(volume):
        return estimate_particulars(hull, ("displacement_m3", "block_coefficient"))
    deeper = loading.draught_full - float(hull.values["draught_m"])
    values = {**hull.values, "displacement_m3": volume}
    for key in ("draught_m", "draught_fore_m", "draught_aft_m"):
        values[key] = float(hull.values[key]) + deeper
    return estimate_particulars(Hull(values, hull.estimated), ("block_coefficient",))


def _is_cubic(file: ShipFile) -> bool:
    """Return whether the calm-water power is by the cubic law."""
    return (file.models.calm_water or speed_power_law_name(file)) == "cubic"


def _build_force_balance(file: ShipFile, hull: Hull) -> ForceBalance:
    calm = cubic_law_resistance(hull, file) if _is_cubic(file) else build_calm_water(file, hull)
    rudder = file.models.rudder
    if rudder != "none":
        required_particulars(hull, ("rudder_area_m2",), rudder, instead="rudder: none")
    return ForceBalance(
        calm=calm,
        propulsion=build_propulsion(file, calm.hull),
        waves=build_wave_resistance(file.models, calm.hull),
        wind=build_wind_resistance(file.models, calm.hull),
        rudder_area=(hull.number("rudder_area_m2") or 0.0) if rudder != "none" else 0.0,
    )


def _build_engine_orders(
    file: ShipFile, balance: ForceBalance, plant: EnginePlant
) -> tuple[EngineOrders, tuple[Estimate, ...]]:
    """Return the powers or speeds that can be ordered, and estimates if none are given."""
    powers, speeds = file.powers_kw, file.speeds_kn
    file.check_one_kind_of_order()
    if powers is not None:
        _check_powers(powers, plant)
        return EngineOrders("power", tuple(sorted(p * 1000.0 for p in powers))), ()
    if speeds is not None:
        _check_distinct(speeds, "speeds_kn", "speed")
        return EngineOrders("speed", tuple(sorted(s * KNOT for s in speeds))), ()
    if np.isfinite(plant.largest_power):
        least = plant.loads[0] * plant.rating / plant.largest_power
        shares = [share for share in (0.25, 0.4, 0.55, 0.7, 0.85) if share >= least] or [1.0]
        powers = tuple(share * plant.largest_power for share in shares)
        words = f"{100 * shares[0]:g} to {100 * shares[-1]:g} % of what the engines give"
        return EngineOrders("power", powers), (Estimate("powers_kw", powers[-1] / 1e3, words),)
    usual = float(_moderate_speed(balance)[0])
    return EngineOrders("speed", (usual,)), (
        Estimate("speeds_kn", usual / KNOT, "Froude number 0.18"),
    )


def _check_distinct(values: tuple[float, ...], key: str, words: str) -> None:
    """Refuse settings that are the same."""
    if len(set(values)) != len(values):
        raise InputError(
            f"{key} has a {words} twice.",
            f"Each {words} is one setting.",
            "Remove one of them.",
            key=key,
        )


def _check_powers(powers: tuple[float, ...], plant: EnginePlant) -> None:
    _check_distinct(powers, "powers_kw", "power")
    least = plant.loads[0] * plant.rating
    if np.isfinite(least) and min(powers) * 1000.0 < least * (1 - 1e-9):
        raise InputError(
            f"powers_kw requests {min(powers):g} kW.",
            f"One engine gives no less than {least / 1000:g} kW (engine.least_load).",
            "Raise it, or correct engine.least_load.",
            key="powers_kw",
        )
    if max(powers) * 1000.0 > plant.largest_power * (1 + 1e-9):
        raise InputError(
            f"powers_kw requests {max(powers):g} kW.",
            f"The engines give {plant.largest_power / 1000:g} kW.",
            "Lower it, or correct engine.power_kw.",
            key="powers_kw",
        )
