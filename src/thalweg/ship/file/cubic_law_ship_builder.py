"""Build the parts of a ship of which one power at a speed is known, for wind and waves to act."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray
from thalweg.core.units import KNOT
from thalweg.ship.file.part_builders import resistance_methods
from thalweg.ship.hull.estimate import CALM_WATER_ASSUMPTION, Estimate
from thalweg.ship.hull.hull import Hull
from thalweg.ship.methods.engine.specific_consumption import GRAM_PER_KILOWATT_HOUR
from thalweg.ship.methods.validity import RangeNote
from thalweg.ship.models.added_resistance_model import build_wind_resistance
from thalweg.ship.models.calm_water_model import CALM_WATER_COMPONENTS, CalmWaterResistance
from thalweg.ship.models.engine_plant import EnginePlant, build_engine_plant
from thalweg.ship.models.propulsion_model import build_propulsion
from thalweg.ship.models.speed_power_laws import fuel_of_engines, reference_point
from thalweg.ship.schema.ship_schema import ShipFile

_POSSIBLE_METHODS = {"waves", "wind", "propulsion"}


def cubic_law_resistance(hull: Hull, file: ShipFile) -> CalmWaterResistance:
    r"""Return the calm-water resistance that takes the power of the cubic law.

    .. math:: R(V) = \eta P(V) / V - R_{AA}(V), \quad P(V) = P_0 (V / V_0)^3

    with the propulsive efficiency :math:`\eta` of the ship file (its usual value when not given)
    and the air resistance :math:`R_{AA}` of the ship's own speed, which a power in calm weather
    contains. In calm weather the power is that of the law whatever the efficiency; added
    resistance takes power in proportion to 1 / efficiency.

    Parameters
    ----------
    file : With one point of power over speed.

    Raises
    ------
    InputError
        If the point is not known, or a method is chosen that needs the parts of the resistance.
    """
    beyond = [name for name in resistance_methods(file) if name not in _POSSIBLE_METHODS]
    if beyond or file.models.propulsion != "efficiencies":
        raise InputError(
            f"The ship file chooses {', '.join(f'models.{n}' for n in beyond or ['propulsion'])} "
            "with the cubic law.",
            "The law knows no parts of the resistance: waves and wind can act on it, with constant "
            "efficiencies.",
            "Leave it out, or choose a calm_water method for the hull, such as holtrop_1984.",
            key=f"models.{(beyond or ['propulsion'])[0]}",
        )
    speed_at_point, power_at_point = _reference_power(file)
    words = (
        f"Calm-water power is taken by the cubic law through {power_at_point / 1e3:g} kW at "
        f"{speed_at_point / KNOT:g} kn, and turned into resistance by a constant efficiency; wind "
        "and waves add to it."
    )
    propulsion = build_propulsion(file, hull)
    wind = build_wind_resistance(file.models, hull)

    def deep(
        speed: FloatArray, waves: FloatArray, line: FloatArray | None
    ) -> dict[str, FloatArray]:
        unit = propulsion.brake_power(np.maximum(speed, 1e-6), np.ones(np.shape(speed)))
        force = power_at_point * (speed / speed_at_point) ** 3 / unit
        if wind is not None:
            still = np.zeros(np.shape(speed))
            force = np.maximum(force - wind.force(speed, still, still), 0.0)
        return {
            name: force if name == "residuary" else 0.0 * force for name in CALM_WATER_COMPONENTS
        }

    def notes(speed: FloatArray) -> list[RangeNote]:
        return []

    taken = Estimate(CALM_WATER_ASSUMPTION, "cubic law", words)
    return CalmWaterResistance("cubic", hull.with_estimates(taken), deep, notes)


def _reference_power(file: ShipFile) -> tuple[float, float]:
    """Return the speed [m/s] and the power [W] that the cubic law goes through.

    Raises
    ------
    InputError : If the ship file does not give them.
    """
    point = reference_point(file)
    if point.power_kw is None or point.speed_kn is None:
        raise InputError(
            "Waves and wind act on a power, and the ship file gives no power at a speed.",
            "The cubic law goes through engine.reference_power_kw at engine.reference_speed_kn.",
            "Add both, or choose speed_loss: kwon_2008 for a ship with known speeds.",
            missing=["engine.reference_power_kw", "engine.reference_speed_kn"],
        )
    return point.speed_kn * KNOT, point.power_kw * 1000.0


def cubic_law_plant(file: ShipFile) -> EnginePlant:
    """Return the engines of a ship with the cubic law: of constant specific consumption.

    It is ``engine.sfoc_g_per_kwh``, else that of ``fuel.reference_t_per_day`` (the whole ship's)
    without the hotel load.
    The power is limited to ``engine.power_kw``, else to the largest that the file names.
    """
    plant, point = build_engine_plant(file), reference_point(file)
    speed, power = _reference_power(file)
    if point.fuel_t_per_day is not None and file.engine.sfoc_g_per_kwh is None:
        sfoc = fuel_of_engines(file, point.fuel_t_per_day) / power / GRAM_PER_KILOWATT_HOUR
        plant = replace(plant, sfoc=sfoc, curve=((0.0, 1.0), (sfoc, sfoc)))
    elif file.engine.sfoc_g_per_kwh is not None and not plant.curve[0]:
        plant = replace(plant, curve=((0.0, 1.0), (plant.sfoc, plant.sfoc)))
    if np.isfinite(plant.rating):
        return plant
    named = [power, *(1000.0 * one for one in file.powers_kw or ())]
    named += [power * (one * KNOT / speed) ** 3 for one in file.speeds_kn or ()]
    limit = Estimate("engine.power_kw", max(named) / 1000.0, "largest power in the ship file")
    return replace(plant, rating=max(named), count=1, estimated=(*plant.estimated, limit))
