"""Check of ship models against their protocol; authors of plug-ins can run it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray
from thalweg.ship.condition_variables import AXIS_OF_CONDITION
from thalweg.ship.conditions import Conditions
from thalweg.ship.model_protocol import ShipModel, Tabulation
from thalweg.ship.models.function_model import FunctionModel
from thalweg.ship.ship import Ship
from thalweg.ship.tables.performance_table import PerformanceTable
from thalweg.ship.tables.tabulate import DEFAULT_AXES

_SAMPLES = 64
_CONDITION_SPANS = {"wind_speed": 20.0, "wave_height": 4.0, "wave_period": 14.0, "depth": 200.0}


def check_ship_model(
    model: ShipModel | Ship, *, tolerance: float = 0.01, load_factor: float | None = None
) -> None:
    """Check that a ship model follows the protocol `thalweg.ship.model_protocol.ShipModel`.

    Parameters
    ----------
    model : ShipModel or Ship
        What to check.
    tolerance : float
        Required accuracy of the table.
    load_factor : float, optional
        Where to check; that of the ship, or full.

    Raises
    ------
    InputError
        Listing every fault: a missing member of the protocol, a condition read without being
        declared, arrays that differ from numbers, unknown conditions that give known speeds,
        negative or not finite speeds, settings that do not ascend, power or fuel that is negative
        or falls with the setting in calm water, a table that differs from the model by more than
        its stated error, a speed above the bound.

    Examples
    --------
    >>> check_ship_model(Ship.simple(speed_kn=8.0, draught_m=5.0))
    """
    ship_model = model.model if isinstance(model, Ship) else model
    if load_factor is None:
        load_factor = model.loading.load_factor if isinstance(model, Ship) else 1.0
    if isinstance(ship_model, FunctionModel) and ship_model.is_speed_field:
        return
    members = [name for name in vars(ShipModel) if not name.startswith("_")]
    missing = [name for name in members if not hasattr(ship_model, name)]
    if missing:
        raise _broken_contract([f"it has no {name}" for name in missing])
    conditions = _conditions(ship_model, load_factor)
    faults: list[str] = []
    checks: tuple[Callable[[ShipModel, Conditions, float], list[str]], ...] = (
        _settings_ascend,
        _settings_keep_their_shape,
        _values_are_valid,
        _scalars_equal_arrays,
        _nan_stays_nan,
        _calm_power_rises,
        _top_speed_holds,
    )
    for check in checks:
        faults += check(ship_model, conditions, load_factor)
        if faults and check in (_settings_keep_their_shape, _values_are_valid):
            break  # what follows needs speeds of the right shape
    else:
        faults += _table_error_holds(ship_model, load_factor, tolerance)
    if faults:
        raise _broken_contract(faults)


def _broken_contract(faults: list[str]) -> InputError:
    return InputError(
        f"The ship model breaks its contract: {'; '.join(faults)}.",
        "The contract is that of thalweg.ship.model_protocol.ShipModel.",
        "Correct the model.",
        faults=faults,
    )


def _conditions(model: ShipModel, load_factor: float) -> Conditions:
    """Moderate random conditions with only the names that the model declares."""
    draw = np.random.default_rng(17)
    values: dict[str, FloatArray | float] = {"load_factor": load_factor}
    for name in sorted(model.reads - {"load_factor"}):
        high = _CONDITION_SPANS.get(name, np.pi if name in AXIS_OF_CONDITION else 1.0)
        low = {"wave_period": 4.0, "depth": 40.0}.get(name, 0.0)
        values[name] = draw.uniform(low, high, _SAMPLES)
    values.setdefault("spare", np.zeros(_SAMPLES))
    return Conditions(values)


def _settings_ascend(model: ShipModel, conditions: Conditions, load_factor: float) -> list[str]:
    speeds = np.asarray(model.speeds(load_factor))
    if speeds.ndim != 1 or speeds.size == 0:
        return ["speeds is not a list of at least one setting"]
    sound = np.isfinite(speeds).all() and (speeds > 0).all() and (np.diff(speeds) > 0).all()
    return [] if sound else ["speeds are not positive and ascending"]


def _settings_keep_their_shape(
    model: ShipModel, conditions: Conditions, load_factor: float
) -> list[str]:
    """Check one condition at several settings, and several conditions at a setting each."""
    count = len(model.speeds(load_factor))
    one = Conditions(
        {name: np.broadcast_to(v, conditions.shape)[0] for name, v in conditions.items()}
    )
    cases = ((one, np.arange(count)), (conditions, np.zeros(conditions.shape, int)))
    faults = []
    for what, rate in (
        ("speed", model.speed_through_water),
        ("power", model.power),
        ("fuel rate", model.fuel_rate),
    ):
        for where, settings in cases:
            wanted = np.broadcast_shapes(where.shape, settings.shape)
            found = np.shape(rate(where, settings))
            if found != wanted:
                faults.append(
                    f"the {what} has shape {found} for conditions of shape {where.shape} and "
                    f"settings of shape {settings.shape}"
                )
                break
    return faults


def _values_are_valid(model: ShipModel, conditions: Conditions, load_factor: float) -> list[str]:
    faults = []
    for setting in range(len(model.speeds(load_factor))):
        speed = np.asarray(model.speed_through_water(conditions, setting))
        if speed.shape != conditions.shape:
            return [f"speed has shape {speed.shape} for conditions of shape {conditions.shape}"]
        if not (np.isfinite(speed) & (speed >= 0)).all():
            faults.append(f"at setting {setting} a speed is negative or not finite")
        for what, values in (
            ("power", model.power(conditions, setting)),
            ("fuel rate", model.fuel_rate(conditions, setting)),
        ):
            if (values < 0).any() or np.isinf(values).any():
                faults.append(f"at setting {setting} a {what} is negative or infinite")
    return faults


def _scalars_equal_arrays(
    model: ShipModel, conditions: Conditions, load_factor: float
) -> list[str]:
    whole = model.speed_through_water(conditions, 0)
    for k in (0, _SAMPLES // 2, _SAMPLES - 1):
        one = Conditions(
            {
                name: np.broadcast_to(values, conditions.shape)[k]
                for name, values in conditions.items()
            }
        )
        single = float(model.speed_through_water(one, 0))
        if not np.isclose(single, whole[k], rtol=1e-4, atol=1e-6):
            return [f"a single condition gives {single:g} m/s, in an array {whole[k]:g} m/s"]
    return []


def _nan_stays_nan(model: ShipModel, conditions: Conditions, load_factor: float) -> list[str]:
    faults = []
    for name in sorted(model.reads - {"load_factor"}):
        unknown = conditions.with_values(**{name: np.full(_SAMPLES, np.nan)})
        if not np.isnan(model.speed_through_water(unknown, 0)).all():
            faults.append(f"an unknown {name} gives a known speed")
    return faults


def _calm_power_rises(model: ShipModel, conditions: Conditions, load_factor: float) -> list[str]:
    """Check that power and fuel rise with the setting in calm, deep water."""
    calm = Conditions(
        {
            **dict.fromkeys(AXIS_OF_CONDITION, 0.0),
            "wave_period": 10.0,
            "depth": 1e4,
            "load_factor": load_factor,
        }
    )
    faults = []
    settings = np.arange(len(model.speeds(load_factor)))
    for what, values in (
        ("power", model.power(calm, settings)),
        ("fuel rate", model.fuel_rate(calm, settings)),
    ):
        if (np.diff(values) < 0).any():
            faults.append(f"{what} falls from one setting to the next in calm water")
    return faults


def _top_speed_holds(model: ShipModel, conditions: Conditions, load_factor: float) -> list[str]:
    for setting in range(len(model.speeds(load_factor))):
        top = model.top_speed(setting, load_factor)
        highest = float(np.nanmax(model.speed_through_water(conditions, setting)))
        if top is not None and highest > top * (1 + 1e-6):
            return [f"at setting {setting} a speed of {highest:g} m/s is above its bound {top:g}"]
    return []


def _table_error_holds(model: ShipModel, load_factor: float, tolerance: float) -> list[str]:
    """Check that the table differs from the model by no more than its stated error."""
    parts, error, curve = Tabulation(*model.tabulate(load_factor, tolerance))
    table = PerformanceTable(parts, model.speeds(load_factor), "", error, curve)
    undeclared = table.axes - model.reads
    if undeclared:
        return [f"the table has axes {', '.join(sorted(undeclared))}, which it does not read"]
    draw = np.random.default_rng(23)
    where: dict[str, FloatArray | float] = {"load_factor": load_factor, "spare": np.zeros(400)}
    for name, (low, high) in sorted(table.ranges.items()):
        usual = _CONDITION_SPANS.get(name, DEFAULT_AXES[name].stop)
        where[name] = draw.uniform(low, max(min(high, usual), low), 400)
    conditions = Conditions(where)
    truth = model.speed_through_water(conditions, 0)
    found = table.lookup(conditions, np.zeros(400, int))
    scale = np.maximum(truth, 0.25 * np.nanmax(truth))
    excess = float(np.nanquantile(np.abs(found - truth) / scale, 0.98))
    if excess > max(2.0 * error.p99, tolerance):
        return [f"the table differs from the model by {excess:.2%}, but states {error.p99:.2%}"]
    return []
