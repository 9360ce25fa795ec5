"""Numbers of a ship file that do not fit each other: impossible ones, and unusual ones.

The ranges are those of displacement ships in service, from tugs to tankers; they find units that
were mixed up (feet, tonnes, kilograms) and slips of a decimal.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray
from thalweg.core.units import DAY, HOUR, KNOT, TONNE
from thalweg.ship.schema.ship_schema import ShipFile

UNUSUAL: Final = "Unusual ship"  #: a warning begins so
_GRAVITY: Final = 9.81  # [m/s2]
_LONGEST: Final = 460.0  #: [m]; no longer ship was ever in service
_LENGTH_TO_BREADTH: Final = (2.5, 12.0)
_BREADTH_TO_DRAUGHT: Final = (1.2, 8.0)
_BLOCK: Final = (0.3, 0.95)
_FROUDE: Final = (0.05, 0.5)  #: of the highest speed
_SPECIFIC: Final = (120.0, 400.0)  #: [g/kWh]
_FUEL_TO_POWER: Final = (0.75, 1.35)  #: of fuel a day to power times specific consumption
_ADMIRALTY: Final = (40.0, 2000.0)  #: displacement [t]^(2/3) speed [kn]^3 / power [kW]
_WRONG_UNIT: Final = 10.0  #: so far outside that range a power is in another unit
_FULL: Final = 0.7  #: block coefficient of full ships ...
_FROUDE_OF_FULL: Final = (0.05, 0.33)  #: ... and the Froude numbers of their highest speed
_LEAST_SPECIFIC: Final = 60.0  #: [g/kWh]; no fuel with carbon holds as much energy
_DEEPEST: Final = 1.5  #: draught as a share of the breadth
_COMMON_SPECIFIC: Final = 190.0  #: [g/kWh] where a power is estimated from fuel
_SEA_WATER: Final = 1.025  # [t/m3]
_LEAST_FROUDE: Final = 0.02  #: of the greatest power: 1.9 kn for 234 m, 0.5 kn for 15 m
_LEAST_DEADWEIGHT: Final = 0.02  #: of cargo ships, as a share of the displacement
_CARGO_SHIPS: Final = ("tanker", "bulk", "container", "cargo", "carrier")
_FULLER: Final = 1.1  #: by which a block coefficient may rise between two draughts


def check_possible_numbers(file: ShipFile) -> None:
    """Raise `InputError` for particulars, power or specific consumption that no ship has.

    Parameters
    ----------
    file : Contents of a ship file.
    """
    breadth, draught = file.hull.breadth_m, file.hull.draught_m
    if breadth is not None and draught is not None and draught > _DEEPEST * breadth:
        raise InputError(
            f"The draught of {draught:g} m is {draught / breadth:.1f} times the breadth of "
            f"{breadth:g} m.",
            f"Breadths are usually {_words(_BREADTH_TO_DRAUGHT)} times the draught.",
            "Correct hull.draught_m or hull.breadth_m.",
            key="hull.draught_m",
        )
    length = file.hull.length_m
    if breadth is not None and length is not None and breadth > length:
        raise InputError(
            f"The breadth of {breadth:g} m is greater than the length of {length:g} m.",
            f"Lengths are usually {_words(_LENGTH_TO_BREADTH)} times the breadth.",
            "Correct hull.breadth_m or hull.length_m; are they swapped?",
            key="hull.breadth_m",
        )
    _check_length_overall(file)
    _check_deadweight(file)
    _check_unit_of_power(file)
    engine = file.engine
    curve = [("sfoc_curve_g_per_kwh", value) for value in engine.sfoc_curve_g_per_kwh]
    for key, value in [("sfoc_g_per_kwh", engine.sfoc_g_per_kwh), *curve]:
        if value is not None and value < _LEAST_SPECIFIC:
            raise InputError(
                f"The specific fuel consumption engine.{key} is {value:g} g/kWh.",
                f"Engines of ships use {_words(_SPECIFIC)} g/kWh; 0.185 kg/kWh is 185.",
                f"Correct engine.{key}.",
                key=f"engine.{key}",
            )


def check_speeds_of_powers(file: ShipFile, speeds: FloatArray) -> None:
    """Raise `InputError` where every power of a ship file gives next to no speed for the length.

    Parameters
    ----------
    file : Contents of a ship file, with ``powers_kw``.
    speeds : Speeds through calm water at its powers [m/s].
    """
    length, powers, highest = file.hull.length_m, file.powers_kw, float(np.max(speeds))
    if not (length and powers) or not highest < _LEAST_FROUDE * math.sqrt(_GRAVITY * length):
        return
    raise InputError(
        f"With powers_kw of at most {max(powers):g} kW, a ship of {length:g} m makes "
        f"{highest / KNOT:.2g} kn at most.",
        f"Even dead slow is more than {_LEAST_FROUDE * math.sqrt(_GRAVITY * length) / KNOT:.2g} kn "
        "for this length.",
        "Give kilowatts, not megawatts (6 MW are 6000), or correct the hull.",
        key="powers_kw",
    )


def _check_length_overall(file: ShipFile) -> None:
    """Raise `InputError` for a length overall below that of a part of the ship."""
    hull = file.hull
    overall = hull.length_overall_m
    for key, words, part in (
        ("length_between_perpendiculars_m", "between perpendiculars",
         hull.length_between_perpendiculars_m),
        ("length_waterline_m", "on the waterline", hull.length_waterline_m),
    ):  # fmt: skip
        if overall is not None and part is not None and overall < part:
            raise InputError(
                f"The length overall of {overall:g} m is less than that {words}, {part:g} m.",
                "It is the greatest of all lengths of a ship.",
                f"Correct hull.length_overall_m or hull.{key}; are they swapped?",
                key="hull.length_overall_m",
            )


def _check_deadweight(file: ShipFile) -> None:
    """Raise `InputError` for a deadweight above the displacement, or far too small for cargo."""
    deadweight, displacement = file.hull.deadweight_t, _greatest_displacement(file)
    if deadweight is None or displacement is None:
        return
    if deadweight > displacement:
        raise InputError(
            f"The deadweight of {deadweight:g} t is more than the displacement of the ship, "
            f"{displacement:.0f} t.",
            "The displacement is the deadweight and the weight of the empty ship.",
            "Correct hull.deadweight_t (in tonnes) or the hull; for a hull at a ballast draught, "
            "give loading.condition: ballast or the laden ship in loading.",
            key="hull.deadweight_t",
        )
    # a note would not do: the carbon intensity is per tonne of deadweight
    kind = (file.hull.type or "").casefold()
    cargo = any(word in kind for word in _CARGO_SHIPS)
    if cargo and deadweight < _LEAST_DEADWEIGHT * displacement:
        raise InputError(
            f"The deadweight of {deadweight:g} t is {100.0 * deadweight / displacement:.2g} % of "
            f"the displacement of {displacement:.0f} t.",
            f"No {file.hull.type} carries less than {100.0 * _LEAST_DEADWEIGHT:g} % of it.",
            "Give hull.deadweight_t in tonnes, not in thousands of tonnes, or correct the hull.",
            key="hull.deadweight_t",
        )


def _greatest_displacement(file: ShipFile) -> float | None:
    """Return the displacement of the full ship [t]; None if unknown, and for hulls in ballast."""
    volume, loading, draught = _volume(file), file.loading, file.hull.draught_m
    if not volume or loading.condition == "ballast":
        return None
    full = loading.draught_full_m
    if full and draught and full > draught:
        volume *= _FULLER * full / draught
    volume = max(volume, loading.displacement_full_m3 or 0.0)
    return max(_SEA_WATER * volume, loading.weight_full_t or 0.0)


def _check_unit_of_power(file: ShipFile) -> None:
    """Raise `InputError` for a power that is thousands of times too small or large for a ship."""
    volume, engine = _volume(file), file.engine
    power, speed = engine.reference_power_kw, engine.reference_speed_kn
    if not (volume and power and speed):
        return
    displacement = _SEA_WATER * volume
    work = displacement ** (2.0 / 3.0) * speed**3
    if not _ADMIRALTY[0] / _WRONG_UNIT < work / power < _ADMIRALTY[1] * _WRONG_UNIT:
        raise InputError(
            f"engine.reference_power_kw is {power:g} kW for {displacement:.4g} t at {speed:g} kn.",
            f"Ships of this size need {work / _ADMIRALTY[1]:.3g} to {work / _ADMIRALTY[0]:.3g} kW.",
            "Give kilowatts, not megawatts or watts; or correct the speed or the hull.",
            key="engine.reference_power_kw",
        )


def unusual_numbers(file: ShipFile) -> list[str]:
    """Return warnings about numbers of a ship file outside what is usual, a sentence each.

    Parameters
    ----------
    file : Contents of a ship file.

    Returns
    -------
    list of str : Each names both numbers and the usual range; empty for most ships.
    """
    return [*_of_hull(file), *_of_speed(file), *_of_fuel(file)]


def _of_hull(file: ShipFile) -> list[str]:
    hull = file.hull
    length = hull.length_between_perpendiculars_m or hull.length_m
    breadth, draught = hull.breadth_m, hull.draught_m
    notes = []
    if length and length > _LONGEST:
        notes.append(
            f"Unusual ship: a length of {length:g} m; no ship was longer than {_LONGEST:g} m "
            "(are these feet?)."
        )
    if length and breadth:
        notes += _outside(
            length / breadth, _LENGTH_TO_BREADTH,
            f"a length of {length:g} m is {{value:.3g}} times the breadth of {breadth:g} m",
        )  # fmt: skip
    if breadth and draught:
        notes += _outside(
            breadth / draught, _BREADTH_TO_DRAUGHT,
            f"a breadth of {breadth:g} m is {{value:.3g}} times the draught of {draught:g} m",
        )  # fmt: skip
    volume, block = _volume(file), hull.block_coefficient
    if block is not None:
        notes += _outside(block, _BLOCK, "hull.block_coefficient is {value:.3g}")
    elif volume and length and breadth and draught:
        notes += _outside(
            volume / (length * breadth * draught), _BLOCK,
            f"a displacement of {volume:.4g} m3 on {length:g} x {breadth:g} x {draught:g} m is a "
            "block coefficient of {value:.3g}",
        )  # fmt: skip
    return notes


def _of_speed(file: ShipFile) -> list[str]:
    """Return a warning about the highest speed for the length."""
    table = file.table.speed_kn if file.table is not None else None
    speeds = [*(file.speeds_kn or ()), *(table or ())]
    speeds += [file.engine.reference_speed_kn] if file.engine.reference_speed_kn else []
    length = file.hull.length_m
    if not speeds or not length:
        return []
    froude = max(speeds) * KNOT / math.sqrt(_GRAVITY * length)
    words = f"{max(speeds):g} kn on a length of {length:g} m is a Froude number of {{value:.2g}}"
    block = file.hull.block_coefficient
    usual = _FROUDE_OF_FULL if block is not None and block >= _FULL else _FROUDE
    return _outside(froude, usual, words)


def _of_fuel(file: ShipFile) -> list[str]:
    """Return warnings about fuel and power for each other and for the size of the ship."""
    engine, daily = file.engine, file.fuel.reference_t_per_day
    power, speed, given = (
        engine.reference_power_kw, engine.reference_speed_kn, engine.sfoc_g_per_kwh,
    )  # fmt: skip
    notes = []
    if given is not None:
        notes += _outside(given, _SPECIFIC, "engine.sfoc_g_per_kwh is {value:g} g/kWh")
    if daily and power:
        burnt = max(daily * TONNE - engine.hotel_fuel_rate * DAY, 0.0)  # without the hotel load
        specific = burnt * 1000.0 / (power * DAY / HOUR)
        words = f"{daily:g} t of fuel a day at {power:g} kW are {{value:.0f}} g/kWh"
        if given is None:
            notes += _outside(specific, _SPECIFIC, words)
        elif not _FUEL_TO_POWER[0] < specific / given < _FUEL_TO_POWER[1]:
            notes.append(
                f"Unusual ship: {words.format(value=specific)}, and engine.sfoc_g_per_kwh is "
                f"{given:g}; the fuel a day counts. Correct one of the three."
            )
    volume = _volume(file)
    if daily and not power:
        power = daily * TONNE * 1000.0 / (_COMMON_SPECIFIC * DAY / HOUR)
    if volume and power and speed:
        words = f"{power:.4g} kW for {_SEA_WATER * volume:.4g} t at {speed:g} kn is an Admiralty "
        notes += _outside(
            (_SEA_WATER * volume) ** (2.0 / 3.0) * speed**3 / power, _ADMIRALTY,
            words + "coefficient of {value:.3g}",
        )  # fmt: skip
    return notes


def _volume(file: ShipFile) -> float | None:
    """Return the displaced volume [m3], given or from the block coefficient; None if unknown."""
    hull = file.hull
    if hull.displacement_m3 or hull.displacement_t:
        return hull.displacement_m3 or (hull.displacement_t or 0.0) / _SEA_WATER
    length = hull.length_between_perpendiculars_m or hull.length_m
    sides = (length, hull.breadth_m, hull.draught_m, hull.block_coefficient)
    return None if any(side is None for side in sides) else math.prod(s or 0.0 for s in sides)


def _outside(value: float, usual: tuple[float, float], words: str) -> list[str]:
    """Return a warning if a value is outside the usual range, else nothing."""
    if usual[0] <= value <= usual[1]:
        return []
    return [f"{UNUSUAL}: {words.format(value=value)}; {_words(usual)} is usual. Check both."]


def _words(usual: tuple[float, float]) -> str:
    return f"{usual[0]:g} to {usual[1]:g}"
