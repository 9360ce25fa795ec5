"""Published regressions that estimate lengths and areas of a hull from others."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, TypeVar

from numpy.typing import ArrayLike

from thalweg.core.errors import unknown_name_error
from thalweg.core.types import FloatArray
from thalweg.ship.methods.array_conversion import as_float_array

_WATERLINE: Final = {"tanker": 1.02, "container": 1.01, "ro_ro": 1.035}
_PROPELLER: Final = {"tanker": (0.395, 1.30), "container": (0.623, -0.16), "ro_ro": (0.713, -0.08)}
_T = TypeVar("_T")


def _value_for_ship_type(kind: str, table: Mapping[str, _T]) -> _T:
    if kind not in table:
        raise unknown_name_error("kind of ship", kind, table)
    return table[kind]


def wetted_surface_denny_mumford(
    length: ArrayLike, *, draught: ArrayLike, displacement: ArrayLike
) -> FloatArray:
    """Return the wetted surface 1.7 L T + V / T [m2].

    Parameters
    ----------
    length : Waterline length [m].
    draught : Mean draught [m].
    displacement : Displaced volume [m3].

    Returns
    -------
    ndarray : Wetted surface [m2].

    References
    ----------
    Denny and Mumford, as given by A. F. Molland, S. R. Turnock, D. A. Hudson, "Ship resistance
    and propulsion" (2011).
    """
    t = as_float_array(draught)
    return 1.7 * as_float_array(length) * t + as_float_array(displacement) / t


def waterline_from_perpendiculars(
    length_between_perpendiculars: ArrayLike, *, kind: str = "tanker"
) -> FloatArray:
    """Return a usual waterline length: 1.02, 1.01 or 1.035 times L_PP [m].

    Parameters
    ----------
    length_between_perpendiculars : array_like [m]
    kind : ``tanker`` (also bulk carriers and general cargo), ``container`` or ``ro_ro`` (also
        passenger ships).

    Returns
    -------
    ndarray : Waterline length [m].

    References
    ----------
    Kristensen and Lützen (2012).
    """
    return _value_for_ship_type(kind, _WATERLINE) * as_float_array(length_between_perpendiculars)


def perpendiculars_from_waterline(
    length_waterline: ArrayLike, *, kind: str = "tanker"
) -> FloatArray:
    """Return a usual length between perpendiculars, the inverse of the waterline rule [m].

    Parameters
    ----------
    length_waterline : array_like [m]
    kind : As in `waterline_from_perpendiculars`.

    Returns
    -------
    ndarray : Length between perpendiculars [m].

    References
    ----------
    Kristensen and Lützen (2012), inverted.
    """
    return as_float_array(length_waterline) / _value_for_ship_type(kind, _WATERLINE)


def length_over_surface_no_bulb(length_waterline: ArrayLike) -> FloatArray:
    """Return the length over wetted surface of a hull without bulb: the waterline length [m].

    Parameters
    ----------
    length_waterline : array_like [m]

    Returns
    -------
    ndarray
        Length over wetted surface [m]; with a bulb, its length forward of the waterline is added.

    References
    ----------
    Definition in U. Hollenbach, "Estimating resistance and propulsion" (1998).
    """
    return as_float_array(length_waterline)


def propeller_diameter_from_draught(draught: ArrayLike, *, kind: str = "tanker") -> FloatArray:
    """Return a usual propeller diameter: 0.395 T + 1.30 for tankers and the like [m].

    0.623 T - 0.16 for container ships, 0.713 T - 0.08 for ro-ro and passenger ships.

    Parameters
    ----------
    draught : Largest draught [m].
    kind : As in `waterline_from_perpendiculars`.

    Returns
    -------
    ndarray : Diameter [m].

    References
    ----------
    Kristensen and Lützen (2012).
    """
    slope, shift = _value_for_ship_type(kind, _PROPELLER)
    return slope * as_float_array(draught) + shift


def bulb_area_rakke(
    midship_coefficient: ArrayLike, *, breadth: ArrayLike, draught: ArrayLike
) -> FloatArray:
    """Return a usual bulb section at the forward perpendicular: 0.08 C_M B T [m2].

    Parameters
    ----------
    midship_coefficient : array_like [-]
    breadth, draught : array_like [m]

    Returns
    -------
    ndarray : Area [m2]. For a ship known to have a bulb; do not invent one.

    References
    ----------
    S. G. Rakke, "Ship emissions calculation from AIS", NTNU (2016).
    """
    return 0.08 * _midship_section(midship_coefficient, breadth, draught)


def bulb_height_rakke(draught: ArrayLike) -> FloatArray:
    """Return a usual height of the centre of the bulb section above the keel: 0.4 T [m].

    Parameters
    ----------
    draught : array_like [m]

    Returns
    -------
    ndarray : Height [m].

    References
    ----------
    Rakke (2016).
    """
    return 0.4 * as_float_array(draught)


def transom_area_rakke(
    midship_coefficient: ArrayLike, *, breadth: ArrayLike, draught: ArrayLike
) -> FloatArray:
    """Return a usual immersed transom: 0.051 C_M B T [m2].

    Parameters
    ----------
    midship_coefficient : array_like [-]
    breadth, draught : array_like [m]

    Returns
    -------
    ndarray : Area [m2].

    References
    ----------
    Rakke (2016).
    """
    return 0.051 * _midship_section(midship_coefficient, breadth, draught)


def _midship_section(
    midship_coefficient: ArrayLike, breadth: ArrayLike, draught: ArrayLike
) -> FloatArray:
    """Return the area of the midship section C_M B T [m2]."""
    return as_float_array(midship_coefficient) * as_float_array(breadth) * as_float_array(draught)
