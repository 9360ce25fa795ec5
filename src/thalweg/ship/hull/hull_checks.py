"""Validate hull particulars: inconsistent lengths, bulb and transom, wetted surface."""

from __future__ import annotations

from typing import Final, Protocol

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.units import FOOT

_LENGTH_WORDS: Final = {
    "length_waterline_m": "waterline",
    "length_over_surface_m": "surface under water",
}
_ABOARD: Final = 0.55  #: share of the length from midship to the ends, with a bow or a stern
_LENGTH_RATIO_RANGE: Final = (0.75, 1.3)  #: shares of the length between perpendiculars
_LARGEST_SURFACE_RATIO: Final = 1.5  #: most wetted surface, as a share of that of a box


class _HullNumbers(Protocol):
    def number(self, key: str) -> float | None: ...


def check_lengths(hull: _HullNumbers) -> None:
    """Refuse lengths a third off that between perpendiculars, and ships broader than long."""
    lpp, breadth = hull.number("length_between_perpendiculars_m"), hull.number("breadth_m")
    if lpp is not None and breadth is not None and breadth > lpp:
        raise InputError(
            f"The breadth of {breadth:g} m is more than the length of {lpp:g} m.",
            "A ship is longer than broad.",
            "Correct them: are they swapped?",
            key="hull.breadth_m",
        )
    for key, words in _LENGTH_WORDS.items():
        other = hull.number(key)
        if (
            lpp is None
            or other is None
            or _LENGTH_RATIO_RANGE[0] < other / lpp < _LENGTH_RATIO_RANGE[1]
        ):
            continue
        raise InputError(
            f"The {words} is {other:g} m long and the length between perpendiculars {lpp:g} m.",
            "They differ by a few per cent.",
            "Correct one of them.",
            key=f"hull.{key}",
        )


def check_depth(hull: _HullNumbers, draught: float | None, key: str) -> None:
    """Refuse a draught [m] that is more than the depth of the hull."""
    depth = hull.number("depth_m")
    if depth is not None and draught is not None and draught > depth:
        raise InputError(
            f"The draught of {draught:g} m is more than the depth of the hull, {depth:g} m.",
            "A ship floats with part of its side above the water.",
            f"Correct {key} or hull.depth_m; {draught:g} feet are {FOOT * draught:.3g} m.",
            key=key,
        )


def check_prismatic(hull: _HullNumbers) -> None:
    """Refuse a prismatic coefficient that is not C_B / C_M within a few per cent.

    It often refers to the length of the waterline, and the block coefficient on that between
    perpendiculars: a difference of a tenth is accepted.
    """
    prismatic, block = hull.number("prismatic_coefficient"), hull.number("block_coefficient")
    midship = hull.number("midship_coefficient")
    if prismatic is None or block is None:
        return
    ratio = block / (prismatic * (midship or 1.0))
    if ratio < 1.1 and (midship is None or ratio > 0.9):
        return
    raise InputError(
        f"prismatic_coefficient {prismatic:g} does not fit block_coefficient {block:.4g}"
        + (f" and midship_coefficient {midship:g}." if midship else "."),
        "C_P is C_B / C_M: no less than C_B.",
        "Correct or leave out one of them.",
        key="hull.prismatic_coefficient",
    )


def check_ends_and_surface(hull: _HullNumbers) -> None:
    """Refuse a bulb or transom larger than the midship section, and impossible wetted surfaces."""
    breadth, draught = hull.number("breadth_m"), hull.number("draught_m")
    if not breadth or not draught:
        return
    section = breadth * draught * (hull.number("midship_coefficient") or 1.0)
    for key, words in (("bulb_area_m2", "bulb's section"), ("transom_area_m2", "immersed transom")):
        area = hull.number(key)
        if area is not None and area > section:
            raise InputError(
                f"The {words} of {area:g} m2 is larger than the midship section, {section:.4g} m2.",
                "No section of a hull is larger than its midship section.",
                f"Correct {key}.",
                key=f"hull.{key}",
            )
    centre, fore = hull.number("bulb_centre_height_m"), hull.number("draught_fore_m") or draught
    if centre is not None and hull.number("bulb_area_m2") and centre >= fore:
        raise InputError(
            f"The centre of the bulb is {centre:g} m above the keel, the draught there {fore:g} m.",
            "The section at the fore perpendicular is the part of the bulb below the water.",
            "Correct bulb_centre_height_m or draught_fore_m.",
            key="hull.bulb_centre_height_m",
        )
    _check_wetted_surface(hull, breadth, draught)


def check_aboard(what: str, forward: float, length: float, *, remedy: str, key: str) -> None:
    """Raise `InputError` for a place further from midship [m] than the ends of the ship.

    Parameters
    ----------
    what : Beginning of the message, such as "A limit is set".
    remedy, key : What to correct, and its key in the ship file.
    """
    if abs(forward) > _ABOARD * length:
        raise InputError(
            f"{what} {forward:g} m ahead of midship, off the ship.",
            f"Half of its length is {0.5 * length:g} m; abaft midship is negative.",
            remedy,
            key=key,
        )


def _check_wetted_surface(hull: _HullNumbers, breadth: float, draught: float) -> None:
    """Check that the wetted surface is between that of a hemisphere and that of a box."""
    surface, volume = hull.number("wetted_surface_m2"), hull.number("displacement_m3")
    lengths = (hull.number("length_waterline_m"), hull.number("length_between_perpendiculars_m"))
    length = max(known or 0.0 for known in lengths)
    if surface is None or volume is None or not length:
        return
    least = (18.0 * np.pi) ** (1.0 / 3.0) * volume ** (2.0 / 3.0)
    most = _LARGEST_SURFACE_RATIO * (length * (breadth + 2.0 * draught) + 2.0 * breadth * draught)
    if not least <= surface <= most:
        raise InputError(
            f"A wetted surface of {surface:g} m2 is not that of a hull of {volume:g} m3, "
            f"{length:g} m long.",
            f"It is more than {least:.0f} m2, a hemisphere's, and less than {most:.0f} m2.",
            "Correct wetted_surface_m2, or leave it out: it is estimated.",
            key="hull.wetted_surface_m2",
        )
