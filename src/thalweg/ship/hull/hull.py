"""Particulars of a hull: completed by their definitions, and checked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.units import SEA_WATER_DENSITY, TONNE
from thalweg.ship.hull.estimate import Estimate
from thalweg.ship.hull.hull_checks import (
    check_depth,
    check_ends_and_surface,
    check_lengths,
    check_prismatic,
)
from thalweg.ship.methods.displacement import block_at_draught

#: how keys of a hull end; a regression from anything else cannot be fed by a ship file
_UNITS = ("_m", "_m2", "_m3", "_t", "_coefficient", "_percent")
_DENSITY_TONNE_PER_M3 = SEA_WATER_DENSITY / TONNE  # t/m3


@dataclass(frozen=True)
class Hull:
    """Particulars as in a ship file (units in the names), with what follows from them.

    Attributes
    ----------
    values : By key of the ship file.
    estimated : Those that were not given.
    """

    values: Mapping[str, float | str]
    estimated: tuple[Estimate, ...] = field(default=())

    def number(self, key: str) -> float | None:
        """Return a number, or None when it is neither given nor known."""
        value = self.values.get(key)
        return None if value is None or isinstance(value, str) else value

    def with_estimates(self, *estimates: Estimate) -> Hull:
        """Return the hull with values added for keys that are not there."""
        new = tuple(e for e in estimates if e.key not in self.values)
        return Hull({**self.values, **{e.key: e.value for e in new}}, (*self.estimated, *new))


def complete_hull(given: Mapping[str, float | str]) -> Hull:
    """Return the hull with everything that follows from definitions, after checking it.

    Parameters
    ----------
    given : The section ``hull`` of a ship file, checked.

    Raises
    ------
    InputError : For hulls that cannot be: deeper than their depth, fuller than a box, particulars
        that contradict each other.
    """
    values = dict(given)
    _complete_draughts(values)
    _complete_displacement(values)
    hull = _complete_lengths(Hull(values))
    hull = _complete_block_coefficient(hull)
    _check_feasible(hull)
    return hull


def _complete_draughts(values: dict[str, float | str]) -> None:
    """Mean, fore and aft draught from each other: two of them give the third."""
    if "draught_m" in values and not {"draught_fore_m", "draught_aft_m"} & values.keys():
        values["draught_fore_m"] = values["draught_m"]
    one = values.get("draught_fore_m", values.get("draught_aft_m"))
    if one is None:
        return
    other = max(2.0 * float(values.get("draught_m", one)) - float(one), 0.0)
    values.setdefault("draught_fore_m", other)
    values.setdefault("draught_aft_m", other)
    mean = 0.5 * (float(values["draught_fore_m"]) + float(values["draught_aft_m"]))
    if "draught_m" not in values:
        values["draught_m"] = mean
    elif abs(float(values["draught_m"]) - mean) > 0.02 * max(mean, 0.1):
        raise InputError(
            f"draught_m {values['draught_m']:g} is not the mean of fore and aft, {mean:g}.",
            "The mean draught is half the sum of draught_fore_m and draught_aft_m.",
            "Leave draught_m out, or correct it.",
            key="hull.draught_m",
        )


def _complete_displacement(values: dict[str, float | str]) -> None:
    """Displaced volume from the weight in sea water; both must agree within the water's density."""
    if "displacement_t" not in values:
        return
    weight = float(values["displacement_t"])
    volume = weight / _DENSITY_TONNE_PER_M3
    given = float(values.setdefault("displacement_m3", volume))
    if not 0.95 < given / volume < 1.05:
        raise InputError(
            f"displacement_m3 {given:g} and displacement_t {weight:g} do not fit.",
            f"A tonne of sea water is {1.0 / _DENSITY_TONNE_PER_M3:.4f} m3.",
            "Correct or leave out one of them.",
            key="hull.displacement_t",
        )


def _complete_lengths(hull: Hull) -> Hull:
    """Lengths from the length overall, when it is the only one."""
    lpp, lwl = (hull.number(f"length_{k}_m") for k in ("between_perpendiculars", "waterline"))
    overall = hull.number("length_overall_m")
    if lpp is not None or lwl is not None or overall is None:
        return hull
    return hull.with_estimates(
        Estimate("length_between_perpendiculars_m", 0.96 * overall, "0.96 of length overall"),
        Estimate("length_waterline_m", 0.98 * overall, "0.98 of length overall"),
    )


def _complete_block_coefficient(hull: Hull) -> Hull:
    """Block coefficient from displacement or C_P C_M, displacement from block coefficient."""
    keys = ("length_between_perpendiculars_m", "breadth_m", "draught_m")
    box = [hull.number(key) for key in keys]
    block, volume = hull.number("block_coefficient"), hull.number("displacement_m3")
    prismatic, midship = hull.number("prismatic_coefficient"), hull.number("midship_coefficient")
    if block is None and volume is None and prismatic is not None and midship is not None:
        block = prismatic * midship
        hull = hull.with_estimates(Estimate("block_coefficient", block, "C_P C_M"))
    if any(side is None for side in box):
        return hull
    length, breadth, draught = (float(side or 0.0) for side in box)
    brick = length * breadth * draught
    if brick <= 0.0:
        return hull
    if block is None and volume is not None:
        block = volume / brick
        _check_block_coefficient(block)
        made = Estimate("block_coefficient", block, "displacement over L_PP B T")
        return hull.with_estimates(made)
    if volume is None and block is not None:
        made = Estimate("displacement_m3", block * brick, "C_B L_PP B T")
        return hull.with_estimates(made)
    return hull


def _check_block_coefficient(block: float) -> None:
    if not 0.0 < block <= 1.0:
        raise InputError(
            f"The displacement is {block:.3g} times the box around the hull.",
            "A block coefficient is between 0 and 1.",
            "Check length, breadth, draught and displacement_m3.",
            key="hull.displacement_m3",
        )


def _check_feasible(hull: Hull) -> None:
    check_lengths(hull)
    _check_displacement(hull)
    for key in ("draught_m", "draught_fore_m", "draught_aft_m"):
        check_depth(hull, hull.number(key), f"hull.{key}")
    _check_coefficients(hull)
    check_ends_and_surface(hull)


def _check_displacement(hull: Hull) -> None:
    """The volume must fit a box, and the given block coefficient within ten per cent."""
    lwl, lpp = hull.number("length_waterline_m"), hull.number("length_between_perpendiculars_m")
    sides = (max(lwl or 0.0, lpp or 0.0), hull.number("breadth_m"), hull.number("draught_m"))
    volume, block = hull.number("displacement_m3"), hull.number("block_coefficient")
    length, breadth, draught = sides
    if not (length and breadth and draught and volume):
        return
    ratio = volume / (length * breadth * draught)
    _check_block_coefficient(ratio)
    if block is not None and not 0.85 < ratio / block < 1.10:
        raise InputError(
            f"block_coefficient {block:g} does not fit displacement_m3 {volume:g}: with length "
            f"{length:g}, breadth {breadth:g} and draught {draught:g} m it is {ratio:.3g}.",
            "The displaced volume is block coefficient x length x breadth x draught.",
            "Correct or leave out one of them.",
            key="hull.block_coefficient",
        )


def _check_coefficients(hull: Hull) -> None:
    block, midship = hull.number("block_coefficient"), hull.number("midship_coefficient")
    waterplane = hull.number("waterplane_coefficient")
    for name, other in (("midship", midship), ("waterplane", waterplane)):
        if block is not None and other is not None and other < block - 1e-9:
            raise InputError(
                f"The {name} coefficient {other:g} is less than the block coefficient {block:g}.",
                "The hull's fullest section and its waterplane contain it.",
                "Correct one of them.",
                key=f"hull.{name}_coefficient",
            )
    check_prismatic(hull)


def volume_at(hull: Hull, volume: float, *, at: float, draught: float) -> float:
    """Return the displaced volume [m3] at another draught, by the block coefficient there.

    Parameters
    ----------
    hull : With length and breadth; without them its block coefficient is taken to stay the same.
    volume : Displaced volume [m3] at the draught ``at`` [m].
    at, draught : [m], greater than 0.

    Raises
    ------
    InputError : If nothing would be displaced.
    """
    length = hull.number("length_between_perpendiculars_m") or hull.number("length_waterline_m")
    area = (length or 0.0) * (hull.number("breadth_m") or 0.0)
    if not (area and at and draught and np.isfinite(volume)):
        return volume * draught / at if at else volume
    block = volume / (area * at)
    found = float(block_at_draught(draught, design_draught=at, design_block=block))
    if not found > 0.0:
        raise InputError(
            f"At a draught of {draught:g} m the hull would displace nothing.",
            f"It displaces {volume:g} m3 at {at:g} m.",
            "Give loading.displacement_empty_m3, or a deeper loading.draught_empty_m.",
            key="loading.draught_empty_m",
        )
    return found * area * draught


def required_particulars(
    hull: Hull, keys: tuple[str, ...], method: str, *, instead: str
) -> list[float]:
    """Return the numbers a method needs, or raise an error that names those missing.

    Parameters
    ----------
    keys : Keys of a ship file.
    method : Name of the method, for the message.
    instead : Remedy of the message.

    Returns
    -------
    list of float : Values in the units of the keys.

    Raises
    ------
    InputError
    """
    missing = [key for key in keys if hull.number(key) is None]
    if missing:
        raise InputError(
            f"{method} needs {', '.join(missing)} under 'hull', not given and not estimated.",
            f"It needs {', '.join(keys)}.{_available_regressions(missing)}",
            f"Add {'it' if len(missing) == 1 else 'them'}, or choose {instead}.",
            missing=missing,
        )
    return [float(hull.values[key]) for key in keys]


def _available_regressions(missing: list[str]) -> str:
    """Return text on the regressions that could supply missing particulars, and their inputs."""
    from thalweg.ship.hull.particulars_regressions import ESTIMATORS  # many formulas, seldom needed

    remedies = [
        f"{key} follows from {', '.join(one.inputs)} ({one.source})"
        for key in missing
        for one in ESTIMATORS.get(key, ())
        if all(name.endswith(_UNITS) for name in one.inputs)
    ]
    return f" {'; '.join(remedies)}." if remedies else ""
