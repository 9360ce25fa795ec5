"""Estimate missing particulars of a hull by regressions; the hull at another draught."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from thalweg.ship.hull.estimate import Estimate
from thalweg.ship.hull.hull import Hull, required_particulars, volume_at
from thalweg.ship.hull.particulars_regressions import ESTIMATORS, ESTIMATORS_IF_FITTED, Estimator
from thalweg.ship.loading_state import Loading

_MIDSHIP_FROM_PRISMATIC: Final = Estimator(
    lambda block, prismatic: np.minimum(block / prismatic, 1.0),
    ("block_coefficient", "prismatic_coefficient"),
    "C_B over C_P",
    0.01,
)
#: who names the one has the other
_PAIRED_KEYS: Final = {
    "bulb_area_m2": "bulb_centre_height_m",
    "bulb_centre_height_m": "bulb_area_m2",
}
#: what a calm-water method without a regression of its own may take as zero, and says so
_ZERO_WHEN_ABSENT: Final = {
    "bulb_area_m2": "taken as no bulb",
    "bulb_centre_height_m": "no bulb",
    "transom_area_m2": "taken as no immersed transom",
    "appendage_area_m2": "taken as no appendages",
}


def estimate_particulars(hull: Hull, keys: tuple[str, ...]) -> Hull:
    """Return the hull with missing particulars filled by regressions where one exists.

    Parameters
    ----------
    keys : What is wanted, by key of the ship file. Keys without a usable regression stay missing.

    Returns
    -------
    Hull : Its ``estimated`` lists the estimates with their sources.
    """
    for key in keys:
        hull = _estimate_particular(hull, key, ())
    return hull


def _estimate_particular(hull: Hull, key: str, above: tuple[str, ...]) -> Hull:
    if hull.number(key) is not None or key in above:
        return hull
    fitted = bool(hull.number(_PAIRED_KEYS.get(key, "")))
    if key in _ZERO_WHEN_ABSENT and not fitted:
        return hull.with_estimates(Estimate(key, 0.0, _ZERO_WHEN_ABSENT[key]))
    for estimator in _estimators_for(key):
        filled = hull
        for name in estimator.inputs:
            filled = _estimate_particular(filled, name, (*above, key))
        inputs = [filled.number(name) for name in estimator.inputs]
        if all(value is not None for value in inputs):
            value = float(estimator.function(*inputs))
            if np.isfinite(value):
                return filled.with_estimates(Estimate(key, value, estimator.source))
    return hull


def _estimators_for(key: str) -> tuple[Estimator, ...]:
    """The regressions for a particular, best first."""
    own = (_MIDSHIP_FROM_PRISMATIC,) if key == "midship_coefficient" else ()
    return (*own, *ESTIMATORS.get(key, ()), *ESTIMATORS_IF_FITTED.get(key, ()))


def estimate_or_raise(hull: Hull, keys: tuple[str, ...], method: str, *, instead: str) -> Hull:
    """Return the hull with all keys known, or raise an error that names those that are not.

    Parameters
    ----------
    keys : Keys of a ship file.
    method : Name of the method, for the message.
    instead : Remedy of the message.

    Returns
    -------
    Hull : With estimates of missing keys.

    Raises
    ------
    InputError
    """
    filled = estimate_particulars(hull, keys)
    required_particulars(filled, keys, method, instead=instead)
    return filled


def hull_at_load_factor(hull: Hull, loading: Loading, load_factor: float) -> Hull:
    """Return the hull floated at the draught of a load factor.

    Parameters
    ----------
    hull : At its full draught, with estimates made.
    loading : Draughts, and displacements where known.
    load_factor : 0 to 1.

    Returns
    -------
    Hull : Trim kept; displaced volume from the loading, or by the block coefficient there; midship
        coefficient from the same bilge; wetted surface with the draught by Denny and Mumford.

    Raises
    ------
    InputError : If the displacement would not be positive.
    """
    full, draught = hull.number("draught_m"), float(loading.draught_at(load_factor))
    if full is None or np.isnan(draught) or abs(draught - full) < 1e-9:
        return hull
    values = dict(hull.values)
    volume = _volume_at(hull, loading, load_factor, draught)
    values["displacement_m3"], values["draught_m"] = volume, draught
    for end in ("fore", "aft"):
        values[f"draught_{end}_m"] = float(values[f"draught_{end}_m"]) + draught - full
    length, breadth = hull.number("length_waterline_m"), hull.number("breadth_m")
    lpp = hull.number("length_between_perpendiculars_m") or length
    if lpp and breadth:
        values["block_coefficient"] = volume / (lpp * breadth * draught)
    midship, surface = hull.number("midship_coefficient"), hull.number("wetted_surface_m2")
    if midship is not None:  # the same bilge; a section is no finer than the hull
        block = float(values.get("block_coefficient", 0.0))
        values["midship_coefficient"] = min(1.0, max(block, 1.0 - (1.0 - midship) * full / draught))
    if surface is not None and length:
        change = 1.7 * length * (draught - full) + volume / draught
        values["wetted_surface_m2"] = (
            surface + change - float(hull.values["displacement_m3"]) / full
        )
    return replace(hull, values=values)


def _volume_at(hull: Hull, loading: Loading, load_factor: float, draught: float) -> float:
    known = float(loading.displacement_at(load_factor))
    if np.isfinite(known):
        return known
    (volume,) = required_particulars(
        hull, ("displacement_m3",), "another draught", instead="one draught"
    )
    return volume_at(hull, volume, at=float(hull.values["draught_m"]), draught=draught)
