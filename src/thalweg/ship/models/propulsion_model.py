"""From resistance to brake power in a composed ship, by the name of the method."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Final

import numpy as np

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.types import FloatArray
from thalweg.ship.hull.estimate import Estimate
from thalweg.ship.hull.hull import Hull
from thalweg.ship.hull.hull_estimates import estimate_or_raise
from thalweg.ship.methods.propulsion.b_series import Propeller, b_series_validity
from thalweg.ship.methods.propulsion.hull_propeller_interaction import (
    hull_efficiency,
    relative_rotative_single,
    relative_rotative_twin,
    thrust_deduction_single,
    thrust_deduction_twin,
    viscous_coefficient,
    wake_fraction_single,
    wake_fraction_twin,
)
from thalweg.ship.methods.propulsion.propulsion_factors import (
    Efficiencies,
    constant_efficiency_power,
    propulsion,
)
from thalweg.ship.methods.resistance.friction_lines import ittc_1957, reynolds_number
from thalweg.ship.methods.resistance.holtrop_form import HullForm, form_factor_1984
from thalweg.ship.methods.validity import RangeNote
from thalweg.ship.models.calm_water_model import FORM_KEYS, hull_form_of, stern_shape
from thalweg.ship.schema.ship_schema import PropulsionSection, ShipFile


@dataclass(frozen=True, eq=False)
class PropulsionModel:
    """Brake power from resistance.

    Attributes
    ----------
    brake_power : [W] from speed [m/s] and resistance [N]; zero where wind or waves push.
    notes : Where the propeller is outside its series.
    """

    method: str
    brake_power: Callable[[FloatArray, FloatArray], FloatArray]
    estimated: tuple[Estimate, ...] = ()
    notes: tuple[RangeNote, ...] = ()


def _efficiencies(hull: Hull, given: PropulsionSection) -> PropulsionModel:
    idle = unused_efficiencies(given)
    known = given.model_dump(exclude_unset=True, exclude={*idle})
    if "propulsive_efficiency" in known:
        known |= {"relative_rotative_efficiency": 1.0, "hull_efficiency": 1.0}
        known["open_water_efficiency"] = known["propulsive_efficiency"]
    if "wake_fraction" in known:
        known["hull_efficiency"] = hull_efficiency(
            known["wake_fraction"], known["thrust_deduction"]
        )
    usual = Efficiencies()
    names = {
        "open_water_efficiency": usual.open_water,
        "relative_rotative_efficiency": usual.relative_rotative,
        "hull_efficiency": usual.hull,
        "shaft_efficiency": usual.transmission,
        "gear_efficiency": usual.gear,
    }
    values = {key: float(known.get(key, usual_value)) for key, usual_value in names.items()}
    chain = Efficiencies(*values.values())
    guessed = tuple(
        Estimate(key, value, "usual value, Schless (2023)")
        for key, value in values.items()
        if key not in known
    )

    def power(speed: FloatArray, resistance: FloatArray) -> FloatArray:
        return constant_efficiency_power(speed, resistance, efficiencies=chain)

    return PropulsionModel("efficiencies", power, guessed)


_NO_GEAR: Final = Estimate(
    "gear_efficiency", 1.0, "no gear: slow-speed engines drive the propeller directly"
)
_HULL_INTERACTION_KEYS: Final = ("wake_fraction", "thrust_deduction")
_EFFICIENCY_KEYS: Final = (
    "open_water_efficiency",
    "relative_rotative_efficiency",
    "hull_efficiency",
)


def unused_efficiencies(given: PropulsionSection, method: str = "efficiencies") -> tuple[str, ...]:
    """Return the efficiencies under 'propulsion' that the others make redundant.

    All in one (``propulsive_efficiency``) goes before its parts, a hull efficiency before wake and
    thrust deduction, which make one only together; a propeller of the B-series makes its own.

    Parameters
    ----------
    given : Propulsion of the ship file.
    method : Method of propulsion of the file.

    Returns
    -------
    tuple of str : Keys without effect.
    """
    idle: tuple[str, ...] = ()
    if method == "wageningen_b":
        idle = ("open_water_efficiency", "hull_efficiency", "propulsive_efficiency")
    elif given.gives("propulsive_efficiency"):
        idle = (*_EFFICIENCY_KEYS, *_HULL_INTERACTION_KEYS)
    elif given.gives("hull_efficiency") or not given.model_fields_set.issuperset(
        _HULL_INTERACTION_KEYS
    ):
        idle = _HULL_INTERACTION_KEYS
    return tuple(key for key in idle if given.gives(key))


def _b_series(hull: Hull, given: PropulsionSection) -> PropulsionModel:
    screw, count = _propeller(given), given.propellers
    wanted = (*FORM_KEYS, "wetted_surface_m2")
    hull = estimate_or_raise(hull, wanted, "wageningen_b", instead="propulsion: efficiencies")
    form = hull_form_of(hull)
    factors, guessed = _hull_propeller_interaction(hull, form, given, screw, count)
    losses, lost = _transmission_losses(given)

    def power(speed: FloatArray, resistance: FloatArray) -> FloatArray:
        wake, deduction, rotative = factors(speed)
        state = propulsion(
            speed,
            resistance,
            screw,
            wake_fraction=wake,
            thrust_deduction=deduction,
            relative_rotative=rotative,
            propellers=count,
            **losses,
        )
        return state.brake_power

    notes = tuple(b_series_validity(screw))
    return PropulsionModel("wageningen_b", power, (*guessed, *lost), notes)


def _propeller(given: PropulsionSection) -> Propeller:
    """Return the propeller of a ship file.

    Raises
    ------
    InputError : If the file does not give all that the B-series needs.
    """
    diameter, pitch = given.propeller_diameter_m, given.propeller_pitch_ratio
    area, blades = given.propeller_area_ratio, given.propeller_blades
    if diameter is None or pitch is None or area is None or blades is None:
        keys = (
            *("propeller_diameter_m", "propeller_pitch_ratio"),
            *("propeller_area_ratio", "propeller_blades"),
        )
        missing = [key for key in keys if not given.gives(key)]
        raise InputError(
            f"The B-series propeller needs {', '.join(missing)} under 'propulsion'.",
            f"It needs {', '.join(keys)}.",
            f"Add {'it' if len(missing) == 1 else 'them'}, or choose propulsion: efficiencies.",
            missing=missing,
        )
    return Propeller(diameter=diameter, pitch_ratio=pitch, area_ratio=area, blades=blades)


def _transmission_losses(given: PropulsionSection) -> tuple[dict[str, float], tuple[Estimate, ...]]:
    usual = {"shaft_efficiency": 0.98, "gear_efficiency": 1.0}
    guessed = tuple(
        Estimate(key, value, "usual value") for key, value in usual.items() if not given.gives(key)
    )
    known = given.model_dump(include={*usual}, exclude_unset=True)
    return usual | known, guessed


def _hull_propeller_interaction(
    hull: Hull, form: HullForm, given: PropulsionSection, screw: Propeller, count: int
) -> tuple[Callable[[FloatArray], tuple[FloatArray, float, float]], tuple[Estimate, ...]]:
    """Wake fraction by speed, thrust deduction and relative rotative efficiency."""
    size, stern = screw.diameter, stern_shape(hull)
    single = count == 1
    if single:
        deduction = float(
            thrust_deduction_single(form, propeller_diameter=size, stern_shape=stern, year=1984)
        )
        rotative = float(relative_rotative_single(form, area_ratio=screw.area_ratio))
    else:
        deduction = float(thrust_deduction_twin(form, propeller_diameter=size))
        rotative = float(relative_rotative_twin(form, pitch_ratio=screw.pitch_ratio))
    guesses = {"thrust_deduction": deduction, "relative_rotative_efficiency": rotative}
    guessed = [
        Estimate(key, value, "Holtrop (1984)")
        for key, value in guesses.items()
        if not given.gives(key)
    ]
    if given.thrust_deduction is not None:
        deduction = given.thrust_deduction
    if given.relative_rotative_efficiency is not None:
        rotative = given.relative_rotative_efficiency
    if given.wake_fraction is not None:
        fixed = np.asarray(given.wake_fraction)
        return lambda speed: (fixed, deduction, rotative), tuple(guessed)
    wake = _wake(hull, form, size, single=single)
    typical = 0.2 * np.sqrt(9.81 * float(form.length))
    guessed.append(
        Estimate("wake_fraction", float(wake(np.asarray(typical))), "Holtrop (1984), at Fn 0.2")
    )
    return lambda speed: (wake(speed), deduction, rotative), tuple(guessed)


def _wake(
    hull: Hull, form: HullForm, size: float, *, single: bool
) -> Callable[[FloatArray], FloatArray]:
    """Holtrop's wake fraction by speed, between 0 and 0.6."""
    stern, aft = stern_shape(hull), float(hull.values["draught_aft_m"])
    area = float(hull.values["wetted_surface_m2"])
    factor = form_factor_1984(form, stern_shape=stern)

    def wake(speed: FloatArray) -> FloatArray:
        line = ittc_1957(reynolds_number(speed, length=form.length))
        viscous = viscous_coefficient(line, form_factor=factor, correlation=0.0004)
        if not single:
            fraction = wake_fraction_twin(form, propeller_diameter=size, viscous=viscous)
        else:
            fraction = wake_fraction_single(
                form,
                draught_aft=aft,
                propeller_diameter=size,
                wetted_surface_area=area,
                viscous=viscous,
                stern_shape=stern,
                year=1984,
            )
        return np.clip(fraction, 0.0, 0.6)

    return wake


PROPULSION_METHODS: Final[Mapping[str, Callable[[Hull, PropulsionSection], PropulsionModel]]] = (
    MappingProxyType({"efficiencies": _efficiencies, "wageningen_b": _b_series})
)


def build_propulsion(file: ShipFile, hull: Hull) -> PropulsionModel:
    """Return the propulsion chosen in a ship file; constant efficiencies when none is named.

    ``engine.sea_margin_percent`` raises the power of every speed by that much.

    Returns
    -------
    PropulsionModel : From resistance to brake power.

    Raises
    ------
    InputError
    """
    name = file.models.propulsion
    if name not in PROPULSION_METHODS:
        raise unknown_name_error("propulsion method", name, PROPULSION_METHODS)
    given = file.propulsion
    is_direct = file.engine.type == "slow_speed_diesel" and not given.gives("gear_efficiency")
    if is_direct and name == "efficiencies":
        chain = PROPULSION_METHODS[name](hull, given.model_copy(update={"gear_efficiency": 1.0}))
        chain = replace(chain, estimated=(*chain.estimated, _NO_GEAR))
    else:
        chain = PROPULSION_METHODS[name](hull, given)
    margin = file.engine.sea_margin_percent
    return _with_sea_margin(chain, 1.0 + margin / 100.0) if margin > 0.0 else chain


def _with_sea_margin(chain: PropulsionModel, factor: float) -> PropulsionModel:
    """The propulsion with a sea margin on its power."""

    def power(speed: FloatArray, resistance: FloatArray) -> FloatArray:
        return factor * chain.brake_power(speed, resistance)

    return replace(chain, brake_power=power)
