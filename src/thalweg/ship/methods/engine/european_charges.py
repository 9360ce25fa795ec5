"""Charges of the European Union on the fuel of a voyage: emission allowances and FuelEU Maritime.

The shares of voyages are those of Directive 2003/87/EC, article 3ga, and of Regulation (EU)
2023/1805, article 2: all of a voyage between two ports of the Union (and of the European Economic
Area), half of one that begins or ends outside, nothing of others.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from types import MappingProxyType
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.errors import InputError
from thalweg.core.types import FloatArray
from thalweg.core.units import TONNE

VOYAGE_SHARES: Final = (0.0, 0.5, 1.0)  #: outside, to or from, and within the Union
#: ISO 3166 codes of countries whose ports are in scope: the member states with a coast, their
#: outermost regions with a code of their own (Treaty on the Functioning of the European Union,
#: article 349), and of the European Economic Area Iceland and Norway (Council Decision (EU)
#: 2023/2754), without Svalbard. Overseas territories such as Greenland, the Faroes, Aruba or
#: French Polynesia are not in scope. The lists were compared with a part of the decision only.
PORTS_IN_SCOPE: Final = frozenset(
    (
        *("BE", "BG", "CY", "DE", "DK", "EE", "ES", "FI", "FR", "GR", "HR", "IE", "IT", "LT"),
        *("LV", "MT", "NL", "PL", "PT", "RO", "SE", "SI"),
        *("GF", "GP", "MF", "MQ", "RE", "YT", "IS", "NO"),
    )
)
#: Gross tonnage from which emission allowances (Directive 2003/87/EC, annex I, by Regulation (EU)
#: 2015/757, article 2), FuelEU (Regulation (EU) 2023/1805, article 2) and the rating of carbon
#: intensity (MARPOL Annex VI, regulation 28) apply; the texts were not compared.
LEAST_GROSS_TONNAGE: Final = 5000.0
REFERENCE_INTENSITY: Final = 91.16  #: Regulation (EU) 2023/1805, article 4(2) [gCO2eq/MJ]
_PENALTY_EUR_PER_T: Final = 2400.0  # annex IV, part B, per tonne of VLSFO
_VLSFO_HEAT: Final = 41_000.0  # annex IV, part B [MJ/t]
#: reduction of the intensity from a year on, article 4(2); the latest first
_REDUCTIONS: Final = (
    *((2050, 0.80), (2045, 0.62), (2040, 0.31)),
    *((2035, 0.145), (2030, 0.06), (2025, 0.02)),
)


class WellToWake(NamedTuple):
    """Intensity [gCO2eq/MJ] and lower heating value [MJ/kg] of a fuel."""

    intensity: float
    heat: float


#: By the default factors of Regulation (EU) 2023/1805, annex II (well to tank, CO2, CH4, N2O with
#: warming potentials 1, 25 and 298) of slow and medium speed Diesel engines.
WELL_TO_WAKE: Final[Mapping[str, WellToWake]] = MappingProxyType(
    {
        "hfo": WellToWake(13.5 + (3.114 + 25 * 5e-5 + 298 * 1.8e-4) / 0.0405, 40.5),
        "lfo": WellToWake(13.2 + (3.151 + 25 * 5e-5 + 298 * 1.8e-4) / 0.0410, 41.0),
        "mgo": WellToWake(14.4 + (3.206 + 25 * 5e-5 + 298 * 1.8e-4) / 0.0427, 42.7),
    }
)


def voyage_share_between(departure: str, destination: str) -> float:
    """Return the share of a voyage in scope: 1 within the Union, 0.5 to or from it, else 0.

    Directive 2003/87/EC, article 3ga, and Regulation (EU) 2023/1805, article 2.

    Parameters
    ----------
    departure, destination : ISO 3166 codes of the countries of the two ports.
    """
    return 0.5 * sum(code.upper() in PORTS_IN_SCOPE for code in (departure, destination))


def ets_phase_in(year: int) -> float:
    """Return the share of verified emissions for which allowances are surrendered.

    40 % of those of 2024, 70 % of 2025, all from 2026: Directive 2003/87/EC, article 3gb, as
    amended by Directive (EU) 2023/959.
    """
    return {2024: 0.4, 2025: 0.7}.get(year, 1.0 if year >= 2026 else 0.0)


def other_greenhouse_gases(fuel_name: str, year: int) -> float:
    """Return the methane and nitrous oxide that need allowances [kg of CO2 equivalent per kg fuel].

    From 2026 on (Directive 2003/87/EC, annex I, as amended by Directive (EU) 2023/959), by the
    factors of `WELL_TO_WAKE` at sea and the warming potentials 28 and 265 of Delegated Regulation
    (EU) 2020/1044; these potentials were not compared with the source. 0 for fuels that are not in
    that table: their factors depend on the engine.
    """
    if year < 2026 or fuel_name not in WELL_TO_WAKE:
        return 0.0
    return 28.0 * 5e-5 + 265.0 * 1.8e-4


def fueleu_target(year: int) -> float:
    """Return the greatest intensity of the energy used on board [gCO2eq/MJ]; inf before 2025.

    Reductions of 2 % (2025), 6, 14.5, 31, 62 and 80 % (2050) from 91.16: Regulation (EU)
    2023/1805, article 4(2).
    """
    for first, reduction in _REDUCTIONS:
        if year >= first:
            return REFERENCE_INTENSITY * (1.0 - reduction)
    return math.inf


def fueleu_penalty(energy: ArrayLike, *, intensity: float, year: int) -> FloatArray:
    r"""Return the FuelEU penalty of energy at an intensity above the target [EUR].

    .. math:: \frac{(g - g_{target}) E}{g \cdot 41\,000} \cdot 2400

    Regulation (EU) 2023/1805, annex IV, part B; for a first year above the target. No surplus is
    paid out.

    Parameters
    ----------
    energy : Energy E in scope [MJ].
    intensity : Well-to-wake intensity g [gCO2eq/MJ].
    """
    excess = max(intensity - fueleu_target(year), 0.0) / intensity
    return np.asarray(energy, float) * excess / _VLSFO_HEAT * _PENALTY_EUR_PER_T


@dataclass(frozen=True)
class EuropeanCharges:
    """Prices of the European Union on the fuel of a voyage.

    Attributes
    ----------
    voyage_share : float
        1 between ports of the Union, 0.5 to or from one, 0 otherwise.
    allowance_price : float
        Of a tonne of CO2 equivalent [currency of the ship's prices]; 0: not counted.
    euro_price : float
        Of a euro in that currency, for the FuelEU penalty; 0: not counted.
    year : int
        Of the emissions.
    share_source : str
        Where the share comes from.

    Raises
    ------
    InputError
        For prices below zero and other shares.
    """

    voyage_share: float
    allowance_price: float = 0.0
    euro_price: float = 0.0
    year: int = 2026
    share_source: str = "given"

    def __post_init__(self) -> None:
        prices = (self.allowance_price, self.euro_price)
        if self.voyage_share in VOYAGE_SHARES and all(0.0 <= p < math.inf for p in prices):
            return
        raise InputError(
            f"Charges of the European Union by a voyage share of {self.voyage_share!r}, an "
            f"allowance price of {prices[0]!r} and a price of the euro of {prices[1]!r}.",
            "The share is 0, 0.5 or 1; prices are numbers of zero or more.",
            "Correct them.",
            field="voyage_share",
        )

    def for_tonnage(self, gross_tonnage: float | None) -> EuropeanCharges:
        """Return the charges of a ship: none below `LEAST_GROSS_TONNAGE`.

        Parameters
        ----------
        gross_tonnage : float or None
            [GT]; None if it is not known: the charges stay.

        Returns
        -------
        EuropeanCharges
            With a share of 0 for a smaller ship, and ``share_source`` states why.
        """
        if gross_tonnage is None or gross_tonnage >= LEAST_GROSS_TONNAGE:
            return self
        why = f"0 % for a ship of {gross_tonnage:,.0f} GT; they apply from 5,000 GT on"
        return replace(self, voyage_share=0.0, share_source=why)

    def per_kg(self, fuel_name: str, co2: float, part: str = "") -> float:
        """Return the charge of a kilogram of fuel.

        Parameters
        ----------
        fuel_name : str
            Short name of the fuel (`thalweg.ship.methods.engine.fuel_properties.FUELS`).
        co2 : float
            Its CO2 [kg/kg].
        part : {"", "allowances", "penalty"}
            Both charges, or one of them.

        Returns
        -------
        float
            In the currency of the prices; NaN where the charge of the fuel is not
            known.
        """
        if self.voyage_share == 0.0:
            return 0.0
        charge = 0.0
        if self.allowance_price > 0.0 and part != "penalty":
            gases = co2 + other_greenhouse_gases(fuel_name, self.year)
            charge += self.allowance_price * ets_phase_in(self.year) * gases / TONNE
        if self.euro_price > 0.0 and part != "allowances":
            known = WELL_TO_WAKE.get(fuel_name)
            if known is None:
                return math.nan
            penalty = fueleu_penalty(known.heat, intensity=known.intensity, year=self.year)
            charge += self.euro_price * float(penalty)
        return self.voyage_share * charge


def european_prices(charges: EuropeanCharges | None) -> dict[str, Any]:
    """Return the prices of charges as plain data, with what does not count for want of a price.

    Returns
    -------
    dict
        The fields of `EuropeanCharges`, ``source``, and ``not_counted``: a sentence for each charge
        without a price.
    """
    reasons = {
        "allowance_price": "emission allowances: no price of an allowance was given",
        "euro_price": "FuelEU penalty: no price of a euro was given",
    }
    if charges is None:
        return {"source": None, "not_counted": list(reasons.values())}
    if math.isinf(fueleu_target(charges.year)):  # no penalty in that year
        del reasons["euro_price"]
    missing = [text for name, text in reasons.items() if not getattr(charges, name)]
    return {**asdict(charges), "source": "request", "not_counted": missing}
