"""Hydrostatics: particulars estimated by published regressions when they are not given."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.ship.methods.arrays import Floats, floats
from thalweg.ship.methods.loading import block_coefficient_of, displacement_volume

#: Published ranges: function -> quantity -> (low, high).
VALIDITY: Final[dict[str, dict[str, tuple[float, float]]]] = {
    "block_from_froude": {"froude": (0.15, 0.32)},
    "lcb_from_froude": {"froude": (0.10, 0.25)},
    "lcb_from_prismatic": {"prismatic_coefficient": (0.55, 0.85)},
    "midship_from_block": {"block_coefficient": (0.45, 0.90)},
    "waterplane_from_block": {"block_coefficient": (0.45, 0.90)},
}


def block_from_froude(froude: ArrayLike) -> Floats:
    """Return a usual block coefficient at a design Froude number.

    C_B = -4.22 + 27.8 sqrt(Fn) - 39.1 Fn + 46.6 Fn^3, for 0.15 < Fn < 0.32.

    Parameters
    ----------
    froude : array_like
        V / sqrt(g L) at design speed [-].

    Returns
    -------
    ndarray
        Block coefficient [-], NaN outside the range.

    References
    ----------
    H. Schneekluth, V. Bertram, "Ship design for efficiency and economy", 2nd ed. (1998),
    section 1.5 (after Jensen).
    """
    fn = floats(froude)
    fn = np.where((fn >= 0.15) & (fn <= 0.32), fn, np.nan)
    return -4.22 + 27.8 * np.sqrt(fn) - 39.1 * fn + 46.6 * fn**3


def midship_from_block(block_coefficient: ArrayLike) -> Floats:
    """Return a usual midship section coefficient: 1 / (1 + (1 - C_B)^3.5).

    Parameters
    ----------
    block_coefficient : array_like
        Block coefficient [-].

    Returns
    -------
    ndarray
        Midship section coefficient [-].

    References
    ----------
    Schneekluth and Bertram (1998), section 1.6 (after Jensen, HSVA).
    """
    return 1.0 / (1.0 + (1.0 - floats(block_coefficient)) ** 3.5)


def midship_kerlen(block_coefficient: ArrayLike) -> Floats:
    """Return a usual midship section coefficient: 1.006 - 0.0056 C_B^-3.56.

    Parameters
    ----------
    block_coefficient : array_like
        Block coefficient [-].

    Returns
    -------
    ndarray
        Midship section coefficient [-].

    References
    ----------
    Kerlen (1970) as given by Schneekluth and Bertram (1998), section 1.6.
    """
    return 1.006 - 0.0056 * floats(block_coefficient) ** -3.56


def waterplane_from_block(block_coefficient: ArrayLike) -> Floats:
    """Return a usual waterplane coefficient of average sections: (1 + 2 C_B) / 3.

    Parameters
    ----------
    block_coefficient : array_like
        Block coefficient [-].

    Returns
    -------
    ndarray
        Waterplane coefficient [-].

    References
    ----------
    Schneekluth and Bertram (1998), section 1.6.
    """
    return (1.0 + 2.0 * floats(block_coefficient)) / 3.0


def waterplane_u_sections(prismatic_coefficient: ArrayLike) -> Floats:
    """Return a usual waterplane coefficient of U sections: 0.95 C_P + 0.17 (1 - C_P)^(1/3).

    Parameters
    ----------
    prismatic_coefficient : array_like
        C_P = C_B / C_M [-].

    Returns
    -------
    ndarray
        Waterplane coefficient [-].

    References
    ----------
    Schneekluth and Bertram (1998), section 1.6.
    """
    cp = floats(prismatic_coefficient)
    return 0.95 * cp + 0.17 * np.cbrt(1.0 - cp)


def lcb_from_prismatic(prismatic_coefficient: ArrayLike) -> Floats:
    """Return a usual centre of buoyancy, percent of length forward of midship: 19.4 C_P - 13.5.

    Parameters
    ----------
    prismatic_coefficient : array_like
        C_P = C_B / C_M [-].

    Returns
    -------
    ndarray
        Longitudinal centre of buoyancy [% of length, + forward].

    References
    ----------
    Schneekluth and Bertram (1998), section 1.5, the line for cargo ships in general.
    """
    return 19.4 * floats(prismatic_coefficient) - 13.5


def lcb_from_froude(froude: ArrayLike) -> Floats:
    """Return a usual centre of buoyancy of tankers and bulkers: 8.80 - 38.9 Fn [% forward].

    Parameters
    ----------
    froude : array_like
        Froude number at design speed [-].

    Returns
    -------
    ndarray
        Longitudinal centre of buoyancy [% of length, + forward].

    References
    ----------
    Schneekluth and Bertram (1998), section 1.5.
    """
    return 8.80 - 38.9 * floats(froude)


def wetted_surface_denny_mumford(
    length: ArrayLike, *, draught: ArrayLike, displacement: ArrayLike
) -> Floats:
    """Return the wetted surface 1.7 L T + V / T [m2].

    Parameters
    ----------
    length : array_like
        Waterline length [m].
    draught : array_like
        Mean draught [m].
    displacement : array_like
        Displaced volume [m3].

    Returns
    -------
    ndarray
        Wetted surface [m2].

    References
    ----------
    Denny and Mumford, as given by A. F. Molland, S. R. Turnock, D. A. Hudson, "Ship resistance
    and propulsion" (2011).
    """
    t = floats(draught)
    return 1.7 * floats(length) * t + floats(displacement) / t


def waterline_from_perpendiculars(length_between_perpendiculars: ArrayLike) -> Floats:
    """Return a usual waterline length: 1.02 L_PP [m] (1.01 for container ships).

    Parameters
    ----------
    length_between_perpendiculars : array_like
        [m].

    Returns
    -------
    ndarray
        Waterline length [m].

    References
    ----------
    H. O. Kristensen, M. Lützen, "Prediction of resistance and propulsion power of ships" (2012).
    """
    return 1.02 * floats(length_between_perpendiculars)


def perpendiculars_from_waterline(length_waterline: ArrayLike) -> Floats:
    """Return a usual length between perpendiculars: L_WL / 1.02 [m].

    Parameters
    ----------
    length_waterline : array_like
        [m].

    Returns
    -------
    ndarray
        Length between perpendiculars [m].

    References
    ----------
    Kristensen and Lützen (2012), inverted.
    """
    return floats(length_waterline) / 1.02


def length_over_surface_no_bulb(length_waterline: ArrayLike) -> Floats:
    """Return the length over wetted surface of a hull without bulb: the waterline length [m].

    Parameters
    ----------
    length_waterline : array_like
        [m].

    Returns
    -------
    ndarray
        Length over wetted surface [m]; a bulb adds what it stands out before the waterline.

    References
    ----------
    Definition in U. Hollenbach, "Estimating resistance and propulsion" (1998).
    """
    return floats(length_waterline)


def propeller_diameter_from_draught(draught: ArrayLike) -> Floats:
    """Return a usual propeller diameter of tankers and bulkers: 0.395 T + 1.30 [m].

    Parameters
    ----------
    draught : array_like
        Largest draught [m].

    Returns
    -------
    ndarray
        Diameter [m].

    References
    ----------
    Kristensen and Lützen (2012).
    """
    return 0.395 * floats(draught) + 1.30


@dataclass(frozen=True)
class Estimator:
    """A regression that can supply a particular which a ship file does not give.

    Parameters
    ----------
    function : callable
        Takes the inputs by position, in the order of ``inputs``.
    inputs : tuple of str
        Names of the quantities it needs.
    source : str
        Where the regression was published.
    typical_error : float
        Relative error to reckon with [-] (absolute, in percent of length, for the centre of
        buoyancy), our judgement.
    """

    function: Callable[..., Floats]
    inputs: tuple[str, ...]
    source: str
    typical_error: float


_SB = "Schneekluth and Bertram (1998)"
_KL = "Kristensen and Lützen (2012)"

#: Quantity -> the regressions that can supply it, best first.
ESTIMATORS: Final[Mapping[str, tuple[Estimator, ...]]] = MappingProxyType(
    {
        "length_waterline_m": (
            Estimator(
                waterline_from_perpendiculars, ("length_between_perpendiculars_m",), _KL, 0.02
            ),
        ),
        "length_between_perpendiculars_m": (
            Estimator(perpendiculars_from_waterline, ("length_waterline_m",), _KL, 0.02),
        ),
        "length_over_surface_m": (
            Estimator(
                length_over_surface_no_bulb,
                ("length_waterline_m",),
                "Hollenbach (1998), definition, no bulb",
                0.03,
            ),
        ),
        "displacement_m3": (
            Estimator(
                lambda length, breadth, draught, block: displacement_volume(
                    length, breadth, draught=draught, block_coefficient=block
                ),
                ("length_waterline_m", "breadth_m", "draught_m", "block_coefficient"),
                "definition of the block coefficient",
                0.0,
            ),
        ),
        "block_coefficient": (
            Estimator(
                lambda volume, length, breadth, draught: block_coefficient_of(
                    volume, length=length, breadth=breadth, draught=draught
                ),
                ("displacement_m3", "length_waterline_m", "breadth_m", "draught_m"),
                "definition of the block coefficient",
                0.0,
            ),
            Estimator(block_from_froude, ("design_froude",), f"{_SB}, after Jensen", 0.05),
        ),
        "midship_coefficient": (
            Estimator(midship_from_block, ("block_coefficient",), f"{_SB}, after Jensen", 0.01),
        ),
        "waterplane_coefficient": (
            Estimator(waterplane_from_block, ("block_coefficient",), _SB, 0.04),
        ),
        "lcb_percent": (
            Estimator(
                lambda block, midship: lcb_from_prismatic(floats(block) / midship),
                ("block_coefficient", "midship_coefficient"),
                _SB,
                1.5,
            ),
            Estimator(lcb_from_froude, ("design_froude",), f"{_SB}, tankers and bulkers", 1.5),
        ),
        "wetted_surface_m2": (
            Estimator(
                lambda length, draught, volume: wetted_surface_denny_mumford(
                    length, draught=draught, displacement=volume
                ),
                ("length_waterline_m", "draught_m", "displacement_m3"),
                "Denny and Mumford, in Molland et al. (2011)",
                0.04,
            ),
        ),
        "propeller_diameter_m": (
            Estimator(propeller_diameter_from_draught, ("draught_m",), _KL, 0.15),
        ),
    }
)
