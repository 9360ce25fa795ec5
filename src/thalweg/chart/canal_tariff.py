"""Dues of ship canals by the size of the ship."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

import numpy as np

if TYPE_CHECKING:
    from thalweg.ship.schema.ship_schema import HullSection

_OLD_LOCKS_BEAM: Final = 32.31  # largest beam in the old locks of Panama [m]
_GROSS_PER_DEADWEIGHT: Final = 0.5  # [1/t], Kadmar: Suez net tonnage, close to the gross tonnage
_DEADWEIGHT_SHARE: Final = 0.8  # of the displacement of a loaded cargo ship
_BLOCK_COEFFICIENT: Final = 0.7  # where the hull does not give it
_SEA_WATER: Final = 1.025  # [t/m3]
#: Words of a type of ship, and its kind in the Suez tariff; the first that matches.
_KINDS: Final = (
    (("dredger", "research", "tug", "yacht", "fishing", "supply", "navy"),
     "special floating units"),
    (("lpg",), "LPG carriers"),
    (("lng", "chemical", "gas"), "chemical tankers, LNG carriers"),
    (("product",), "product tankers"),
    (("tanker", "crude", "vlcc"), "crude oil tankers"),
    (("bulk",), "dry bulk carriers"),
    (("container", "vehicle", "car carrier"), "container ships, vehicle carriers"),
)  # fmt: skip


@dataclass(frozen=True)
class CanalTariff:
    """Dues of a canal as a function of tonnage, beam and kind of ship.

    Parameters
    ----------
    tonnage : The key of a ship file with the tonnage that counts, such as ``"suez_net_tonnage"``.
    tons_per_gross_ton : float
        That tonnage per gross ton, for ships of whom only the gross tonnage is known.
    usd : US dollars per unit of the tariff.
    fixed : tuple of (beam, amount)
        Part of the dues up to a beam [m], ascending.
    bands : Widths of the first bands of tonnage; one more follows without an end.
    rates : Amount per ton in each band, by kind of ship.
    mean : Mean dues [USD], for ships of unknown size.
    source : Sources and assumptions.
    """

    tonnage: str
    tons_per_gross_ton: float
    usd: float
    fixed: tuple[tuple[float, float], ...]
    bands: tuple[float, ...]
    rates: Mapping[str, tuple[float, ...]] = field(hash=False)
    mean: float
    source: str = ""

    @classmethod
    def from_row(cls, row: Mapping[str, Any], mean: float) -> CanalTariff:
        """Return the tariff of an entry of ``canals.json``.

        Parameters
        ----------
        row : Its ``tariff``.
        mean : Mean dues [USD].
        """
        return cls(
            row["tonnage"],
            row["tons_per_gross_ton"],
            row["usd"],
            tuple((math.inf if beam is None else beam, paid) for beam, paid in row["fixed"]),
            tuple(row["bands_t"]),
            {kind: tuple(rates) for kind, rates in row["rates"].items()},
            mean,
            row["source"],
        )

    def dues(self, tons: float, *, beam: float | None = None, kind: str = "") -> float:
        """Return the dues of one transit.

        Parameters
        ----------
        tons : Tonnage that counts.
        beam : Breadth [m]; without it the smallest fixed part counts.
        kind : Kind of ship, a key of ``rates``; others pay as the last one.

        Returns
        -------
        float [USD]
        """
        paid = next(amount for limit, amount in self.fixed if (beam or 0.0) <= limit)
        rates = self.rates.get(kind, list(self.rates.values())[-1])
        edges = np.concatenate([[0.0], np.cumsum(self.bands), [math.inf]])
        in_band = np.clip(tons - edges[:-1], 0.0, np.diff(edges))
        return self.usd * (paid + float(np.dot(in_band, rates)))


def tariff_kind(ship_type: str, beam: float | None) -> dict[str, str]:
    """Return the kind of a ship in each tariff, by the key of its tonnage.

    Parameters
    ----------
    ship_type : Type in the ship file, such as ``"bulk carrier"``.
    beam : Breadth [m].
    """
    plain = ship_type.casefold()
    kinds = (kind for words, kind in _KINDS if any(word in plain for word in words))
    locks = "old" if (beam or 0.0) <= _OLD_LOCKS_BEAM else "new"
    return {
        "suez_net_tonnage": next(kinds, "other ships"),
        "panama_net_tonnage": f"ships in the {locks} locks",
    }


def known_gross_tonnage(hull: HullSection) -> tuple[float | None, str]:
    """Return the gross tonnage of a hull, or an estimate.

    Parameters
    ----------
    hull : Of a ship file.

    Returns
    -------
    tonnage : None where the size of the hull is not known.
    assumption : How it was estimated; empty where the file gives it.

    Notes
    -----
    The estimate is half the deadweight [t]; an unknown deadweight is 0.8 of the displacement, and
    an unknown displacement is that of the length, breadth, draught and block coefficient (0.7
    where it is not given).
    """
    if hull.gross_tonnage is not None:
        return hull.gross_tonnage, ""
    if hull.deadweight_t is not None:
        return _GROSS_PER_DEADWEIGHT * hull.deadweight_t, "half the deadweight"
    displacement = hull.displacement_t
    if displacement is None and hull.displacement_m3 is not None:
        displacement = _SEA_WATER * hull.displacement_m3
    how = "0.4 of the displacement"
    length = hull.length_between_perpendiculars_m or hull.length_waterline_m
    length = length or hull.length_overall_m
    if displacement is None and length and hull.breadth_m and hull.draught_m:
        block = hull.block_coefficient or _BLOCK_COEFFICIENT
        displacement = _SEA_WATER * block * length * hull.breadth_m * hull.draught_m
        how = "0.4 of a displacement from length, breadth and draught"
    if displacement is None:
        return None, "the size of the ship is not known"
    return _GROSS_PER_DEADWEIGHT * _DEADWEIGHT_SHARE * displacement, how
