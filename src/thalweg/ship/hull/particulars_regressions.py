"""The regressions that can supply particulars which a ship file does not give."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

from thalweg.core.types import FloatArray
from thalweg.ship.methods.array_conversion import as_float_array
from thalweg.ship.methods.displacement import block_coefficient_of, displacement_volume
from thalweg.ship.methods.hull_coefficients import (
    block_from_froude,
    lcb_from_froude,
    lcb_from_prismatic,
    midship_from_block,
    waterplane_from_block,
)
from thalweg.ship.methods.hull_regressions import (
    bulb_area_rakke,
    bulb_height_rakke,
    length_over_surface_no_bulb,
    perpendiculars_from_waterline,
    propeller_diameter_from_draught,
    transom_area_rakke,
    waterline_from_perpendiculars,
    wetted_surface_denny_mumford,
)


@dataclass(frozen=True)
class Estimator:
    """A regression that can supply a particular which a ship file does not give.

    Parameters
    ----------
    function : Takes the inputs by position, in the order of ``inputs``.
    inputs : Names of the quantities it needs.
    source : Where the regression was published.
    typical_error : Relative error to reckon with [-] (absolute, in percent of length, for the
        centre of buoyancy), our judgement.
    """

    function: Callable[..., FloatArray]
    inputs: tuple[str, ...]
    source: str
    typical_error: float


_LPP = "length_between_perpendiculars_m"
_SB = "Schneekluth and Bertram (1998)"
_KL = "Kristensen and Lützen (2012)"
_RAKKE = "Rakke (2016)"

#: Quantity -> the regressions that can supply it, best first.
ESTIMATORS: Final[Mapping[str, tuple[Estimator, ...]]] = MappingProxyType(
    {
        "length_waterline_m": (Estimator(waterline_from_perpendiculars, (_LPP,), _KL, 0.02),),
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
                (_LPP, "breadth_m", "draught_m", "block_coefficient"),
                "definition of the block coefficient",
                0.0,
            ),
        ),
        "block_coefficient": (
            Estimator(
                lambda volume, length, breadth, draught: block_coefficient_of(
                    volume, length=length, breadth=breadth, draught=draught
                ),
                ("displacement_m3", _LPP, "breadth_m", "draught_m"),
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
                lambda block, midship: lcb_from_prismatic(as_float_array(block) / midship),
                ("block_coefficient", "midship_coefficient"),
                _SB,
                1.5,
            ),
            Estimator(lcb_from_froude, ("design_froude",), f"{_SB}, by design speed", 1.5),
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

#: The same for parts that not every ship has: never add one that a ship file does not name.
ESTIMATORS_IF_FITTED: Final[Mapping[str, tuple[Estimator, ...]]] = MappingProxyType(
    {
        "bulb_area_m2": (
            Estimator(
                lambda midship, breadth, draught: bulb_area_rakke(
                    midship, breadth=breadth, draught=draught
                ),
                ("midship_coefficient", "breadth_m", "draught_m"),
                _RAKKE,
                0.5,
            ),
        ),
        "bulb_centre_height_m": (Estimator(bulb_height_rakke, ("draught_m",), _RAKKE, 0.3),),
        "transom_area_m2": (
            Estimator(
                lambda midship, breadth, draught: transom_area_rakke(
                    midship, breadth=breadth, draught=draught
                ),
                ("midship_coefficient", "breadth_m", "draught_m"),
                _RAKKE,
                1.0,
            ),
        ),
    }
)
