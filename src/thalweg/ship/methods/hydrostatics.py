"""Hydrostatics: loading, and particulars estimated by published regressions when not given."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.ship.methods.arrays import Floats, floats

#: Published ranges: function -> quantity -> (low, high).
VALIDITY: Final[dict[str, dict[str, tuple[float, float]]]] = {
    "block_from_froude": {"froude": (0.15, 0.32)},
    "lcb_from_froude": {"froude": (0.10, 0.25)},
    "lcb_from_prismatic": {"prismatic_coefficient": (0.55, 0.85)},
    "midship_from_block": {"block_coefficient": (0.45, 0.90)},
    "waterplane_from_block": {"block_coefficient": (0.45, 0.90)},
    "block_at_draught": {"draught_ratio": (0.4, 1.1)},
}


# --- loading -------------------------------------------------------------------------------


def between_empty_and_full(load_factor: ArrayLike, *, empty: ArrayLike, full: ArrayLike) -> Floats:
    """Return a quantity that runs in a straight line from the empty to the full ship.

    Draught, weight and service speed are treated so by van Halem (2019).

    Parameters
    ----------
    load_factor : array_like
        r = (W - W_empty) / (W_full - W_empty), 0 empty to 1 full.
    empty, full : array_like
        The quantity of the empty and of the full ship, in any unit.

    Returns
    -------
    ndarray
        The quantity, NaN outside 0 <= r <= 1.

    References
    ----------
    J. P. van Halem, "Route optimization in dynamic currents", TU Delft (2019), section 3.2.3.
    """
    r = floats(load_factor)
    inside = (r >= 0.0) & (r <= 1.0)
    return (1.0 - np.where(inside, r, np.nan)) * floats(empty) + r * floats(full)


def load_factor_of(value: ArrayLike, *, empty: ArrayLike, full: ArrayLike) -> Floats:
    """Return the load factor at which `between_empty_and_full` gives ``value``.

    Parameters
    ----------
    value : array_like
        Draught, weight or speed.
    empty, full : array_like
        The same quantity of the empty and of the full ship; they must differ.

    Returns
    -------
    ndarray
        Load factor [-], NaN where it would lie outside 0 to 1.
    """
    low = floats(empty)
    with np.errstate(divide="ignore", invalid="ignore"):
        r = (floats(value) - low) / (floats(full) - low)
        return np.where((r >= -1e-12) & (r <= 1.0 + 1e-12), np.clip(r, 0.0, 1.0), np.nan)


def displacement_volume(
    length: ArrayLike, breadth: ArrayLike, *, draught: ArrayLike, block_coefficient: ArrayLike
) -> Floats:
    """Return the displaced volume C_B L B T [m3] (definition of the block coefficient).

    Parameters
    ----------
    length, breadth, draught : array_like
        Length to which C_B belongs, breadth and mean draught [m].
    block_coefficient : array_like
        Block coefficient [-].

    Returns
    -------
    ndarray
        Volume [m3].
    """
    return floats(block_coefficient) * floats(length) * floats(breadth) * floats(draught)


def block_coefficient_of(
    displacement: ArrayLike, *, length: ArrayLike, breadth: ArrayLike, draught: ArrayLike
) -> Floats:
    """Return the block coefficient of a displaced volume [m3]: volume / (L B T).

    Parameters
    ----------
    displacement : array_like
        Displaced volume [m3], not tonnes.
    length, breadth, draught : array_like
        [m].

    Returns
    -------
    ndarray
        Block coefficient [-].
    """
    return floats(displacement) / (floats(length) * floats(breadth) * floats(draught))


def block_at_draught(
    draught: ArrayLike, *, design_draught: ArrayLike, design_block: ArrayLike
) -> Floats:
    """Return the block coefficient at another draught: 1 - (1 - C_B)(T_design / T)^(1/3).

    Parameters
    ----------
    draught, design_draught : array_like
        Mean draughts [m].
    design_block : array_like
        Block coefficient at the design draught [-].

    Returns
    -------
    ndarray
        Block coefficient [-].

    References
    ----------
    Riddlesworth's method as given by J.-P. Jalkanen et al., "Extension of an assessment model of
    ship traffic exhaust emissions", Atmos. Chem. Phys. 12 (2012) (from memory).
    """
    ratio = floats(design_draught) / floats(draught)
    return 1.0 - (1.0 - floats(design_block)) * np.cbrt(ratio)


def displacement_at_draught(
    draught: ArrayLike,
    *,
    design_draught: ArrayLike,
    design_displacement: ArrayLike,
    waterplane_area: ArrayLike,
) -> Floats:
    """Return the displaced volume near the design draught, wall-sided: V + A_WP (T - T_design).

    Parameters
    ----------
    draught, design_draught : array_like
        Mean draughts [m].
    design_displacement : array_like
        Displaced volume at the design draught [m3].
    waterplane_area : array_like
        C_WP L B [m2].

    Returns
    -------
    ndarray
        Volume [m3], NaN where it would not be positive.
    """
    change = floats(draught) - floats(design_draught)
    volume = floats(design_displacement) + floats(waterplane_area) * change
    return np.where(volume > 0.0, volume, np.nan)


# --- regressions ---------------------------------------------------------------------------


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
