"""Fuel, emissions and cost of a sailed track: per piece of a leg, by the zone it is in."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from thalweg.core.types import FloatArray
from thalweg.route.cost_parts import COST_PARTS
from thalweg.route.referee.leg_segments import TrackPoints
from thalweg.route.referee.sailing import SailedTrack
from thalweg.ship.methods.engine.fuel_properties import halem_cost

if TYPE_CHECKING:
    from thalweg.chart.zones.zone_set import Zones
    from thalweg.route.referee.sailing_physics import SailingEnvironment
    from thalweg.ship.fuel_prices import FuelTerms

#: Quantities of `FuelTerms` that are charges of the European Union, by the names of cost parts.
_CHARGES: Final = {"EU ETS": "allowances", "FuelEU": "penalty"}
OUTSIDE_ZONES = "outside"  #: outside all emission control areas, among the zones of `CostBreakdown`


@dataclass(frozen=True)
class CostBreakdown:
    """Fuel, energy, emissions and cost of the legs of a track.

    Attributes
    ----------
    legs : ``fuel`` (of sailing) and ``waiting_fuel`` (of waiting before it) [kg], ``fuel_in_eca``
        (of both) [kg], ``co2`` [kg], ``cost`` [currency] with its parts (`COST_PARTS`), ``energy``
        (of sailing) and ``waiting_energy`` [J], (legs,); NaN where unknown.
    zones : Fuel [kg] by emission control area, and ``outside`` them; empty where no areas count.
    notes : Assumptions where data are missing.
    """

    legs: dict[str, FloatArray]
    zones: dict[str, float]
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class ConsumptionRates:
    """Fuel rate and power at the Gauss points of a track; NaN where unknown.

    Attributes
    ----------
    fuel : [kg/s], of the fuel burnt outside control areas.
    power : Of the brake, without hotel load [W].
    """

    fuel: FloatArray
    power: FloatArray


@dataclass(frozen=True)
class _FuelByPart:
    """Fuel by the model of the ship [kg] and its zones: of pieces, then of waits."""

    fuel: FloatArray
    leg: NDArray[np.int64]
    inside: FloatArray
    price: FloatArray
    zone: NDArray[np.int64]


def cost_breakdown(sailed: SailedTrack, rates: ConsumptionRates, terms: FuelTerms) -> CostBreakdown:
    """Return the fuel, energy, emissions and cost of a track.

    Notes
    -----
    Of every piece (at most half a nautical mile by default) the exact share inside the control
    areas burns at the terms inside; price zones multiply its cost. Cost is fuel, canal dues and the
    price of time, waits included. Where fuel has no price but speed has, the time of sailing counts
    by the cubed ordered speed instead (van Halem 2019). Energy is that of the brake and the hotel
    load. What is unknown makes the sum unknown, never zero.
    """
    count = len(sailed.pieces.length)
    parts = _fuel_by_part(sailed, rates.fuel)
    sailing = np.arange(len(parts.leg)) < len(sailed.pieces)

    def total(values: FloatArray) -> FloatArray:
        return np.bincount(parts.leg, weights=values, minlength=count).astype(np.float64)

    mass, kept = _weighted_fuel(parts, terms, "fuel")
    time = np.concatenate([_integral_over_time(sailed, 1.0), _waits_before_legs(sailed)])
    energy = np.concatenate([_integral_over_time(sailed, rates.power), np.zeros(count)])
    energy += sailed.world.ship.hotel_power * time
    legs = {
        "fuel": total(np.where(sailing, mass, 0.0)),
        "waiting_fuel": total(np.where(sailing, 0.0, mass)),
        "fuel_in_eca": total(kept) if sailed.world.control_areas else np.full(count, math.nan),
        "co2": total(_emitted_co2(sailed, parts, terms, time)),
        "energy": total(np.where(sailing, energy, 0.0)),
        "waiting_energy": total(np.where(sailing, 0.0, energy)),
    }
    if terms.by_speed:
        spent = terms.cubed_speed_price * _cubed_speed_time(sailed, parts, time)
    else:
        spent = _weighted_fuel(parts, terms, "cost")[0]
    charges = {
        name: parts.price * _weighted_fuel(parts, terms, quantity)[0]
        for name, quantity in _charges_with_a_price(terms).items()
    }
    cost = total(parts.price * spent - sum(charges.values(), np.zeros(len(spent))))
    fee, notes = _canal_dues(sailed, terms, cost)
    of_parts = {"fuel": cost, "time": terms.time_price * total(time), "canal dues": fee}
    of_parts |= {name: total(values) for name, values in charges.items()}
    legs["cost"] = sum(of_parts.values(), np.zeros(count))
    unknown = dict.fromkeys(_CHARGES, np.full(count, math.nan))  # without prices: not zero
    legs |= {COST_PARTS[name]: values for name, values in (unknown | of_parts).items()}
    return CostBreakdown(legs, _fuel_by_zone(sailed, parts, mass, kept), notes)


def _charges_with_a_price(terms: FuelTerms) -> dict[str, str]:
    """Return the quantities of charges that have a price, by the names of the parts."""
    given = terms.charges
    if given is None:
        return {}
    prices = given.allowance_price, given.euro_price
    return {name: what for (name, what), price in zip(_CHARGES.items(), prices) if price > 0.0}


def _emitted_co2(
    sailed: SailedTrack, parts: _FuelByPart, terms: FuelTerms, time: FloatArray
) -> FloatArray:
    """Return the CO2 of every part [kg]: of its fuel, else by the cubed speed where that is given.

    The second is eq. 3.5 of van Halem (2019).
    """
    if terms.emits_by_speed:
        return terms.cubed_speed_co2 * _cubed_speed_time(sailed, parts, time)
    return _weighted_fuel(parts, terms, "co2")[0]


def _cubed_speed_time(sailed: SailedTrack, parts: _FuelByPart, time: FloatArray) -> FloatArray:
    """Return time times cubed ordered speed of every part [m3/s2]; 0 for waits."""
    sailing = np.arange(len(parts.leg)) < len(sailed.pieces)
    cubed = halem_cost(time, _ordered_speeds(sailed)[parts.leg], per_second=0.0, per_cube=1.0)
    return np.where(sailing, cubed, 0.0)


def _integral_over_time(sailed: SailedTrack, rate: FloatArray | float) -> FloatArray:
    """Return a rate at the Gauss points, summed over the time of every piece; NaN if not sailed."""
    pieces, passage = sailed.pieces, sailed.passage
    rates = np.broadcast_to(rate, 2 * len(pieces)).reshape(-1, 2)
    found = 0.5 * pieces.step * (rates * passage.slowness).sum(axis=1)
    if passage.first_infeasible < len(pieces):
        found[passage.first_infeasible :] = math.nan
    return np.asarray(found)


def _ordered_speeds(sailed: SailedTrack) -> FloatArray:
    """Return the calm-water speed that every leg is ordered to [m/s]."""
    ship, pieces = sailed.world.ship, sailed.pieces
    speeds = np.asarray(ship.speeds, float)[pieces.track.setting]
    in_canals = pieces.canals.ordered_speed(ship)
    return np.where(np.isnan(in_canals), speeds, in_canals)


def _fuel_by_part(sailed: SailedTrack, rate: FloatArray) -> _FuelByPart:
    """Return the fuel of every piece, and then of the wait before every leg."""
    pieces, world = sailed.pieces, sailed.world
    burnt = _integral_over_time(sailed, rate)
    legs = np.arange(len(pieces.length))
    lying = _waits_before_legs(sailed) * world.ship.waiting_fuel_rate
    low = pieces.points(pieces.leg, pieces.start)
    high = pieces.points(pieces.leg, pieces.start + pieces.step)
    track = pieces.track
    still = (track.lat[:-1], track.lon[:-1])
    inside, price, zone = _zones_of_pieces(world, low, high)
    there = _zones_of_positions(world, *still)
    return _FuelByPart(
        np.concatenate([burnt, lying]),
        np.concatenate([pieces.leg, legs]),
        np.concatenate([inside, there[0]]),
        np.concatenate([price, there[1]]),
        np.concatenate([zone, there[2]]),
    )


def _waits_before_legs(sailed: SailedTrack) -> FloatArray:
    """Return the wait before every leg [s]."""
    return np.asarray(sailed.pieces.track.wait[:-1])


def _weighted_fuel(
    parts: _FuelByPart, terms: FuelTerms, what: str
) -> tuple[FloatArray, FloatArray]:
    """Return a sum of fuel over all parts, and over those inside control areas."""
    return terms.of_fuel(what, parts.fuel, parts.inside)


def _zones_of_pieces(
    world: SailingEnvironment, low: TrackPoints, high: TrackPoints
) -> tuple[FloatArray, FloatArray, NDArray[np.int64]]:
    """Return (share in control areas, price factor, number of the area or -1) of pieces."""
    count = len(low)
    share, price, zone = np.zeros(count), np.ones(count), np.full(count, -1)
    chart, areas = world.chart, world.control_areas
    ends = (low.lat, low.lon, high.lat, high.lon)
    if chart is not None and chart.zones.price:
        price = chart.zones.factors(*ends)[1]
    if areas is not None:
        share = areas.eca_fraction(*ends)
        some = np.flatnonzero(share > 0.0)
        for place in (low, high):
            zone[some] = np.where(
                zone[some] < 0,
                _control_area_of(areas, place.lat[some], place.lon[some]),
                zone[some],
            )
        zone[some] = np.where(zone[some] < 0, 0, zone[some])
    return share, price, zone


def _zones_of_positions(
    world: SailingEnvironment, lat: FloatArray, lon: FloatArray
) -> tuple[FloatArray, FloatArray, NDArray[np.int64]]:
    """Return (share, price factor, number of the area or -1) of positions."""
    share, price, zone = np.zeros(len(lat)), np.ones(len(lat)), np.full(len(lat), -1)
    chart, areas = world.chart, world.control_areas
    if chart is not None and chart.zones.price:
        price = chart.zones.factors(lat, lon, lat, lon)[1]
    if areas is not None:
        share = areas.in_eca(lat, lon).astype(np.float64)
        zone = np.where(share > 0.0, np.maximum(_control_area_of(areas, lat, lon), 0), -1)
    return share, price, zone


def _control_area_of(areas: Zones, lat: FloatArray, lon: FloatArray) -> NDArray[np.int64]:
    """Return the first control area that contains each position; -1 for none."""
    zone = np.full(len(lat), -1)
    for number, area in enumerate(areas.eca):
        remaining = np.flatnonzero(zone < 0)
        if not len(remaining):
            break
        zone[remaining[area.contains(lat[remaining], lon[remaining])]] = number
    return zone


def _fuel_by_zone(
    sailed: SailedTrack, parts: _FuelByPart, mass: FloatArray, kept: FloatArray
) -> dict[str, float]:
    """Return the fuel [kg] by control area and outside."""
    areas = sailed.world.control_areas
    if areas is None:
        return {}
    found: dict[str, float] = {}
    for number, area in enumerate(areas.eca):
        here = parts.zone == number
        if here.any():
            found[area.name] = found.get(area.name, 0.0) + float(kept[here].sum())
    return {OUTSIDE_ZONES: float((mass - kept).sum()), **found}


def _canal_dues(
    sailed: SailedTrack, terms: FuelTerms, cost: FloatArray
) -> tuple[FloatArray, tuple[str, ...]]:
    """Return the dues of every leg [currency], and notes; NaN without the rate of the dollar."""
    fee = sailed.pieces.canals.fee
    canals = (sailed.pieces.canals.of(leg) for leg in sailed.pieces.canals.legs)
    paid = tuple(
        f"Dues of the {canal.title}: {canal.fee:,.0f} USD, by {canal.fee_basis}. "
        f"{canal.source if canal.tariff is None else canal.tariff.source}."
        for canal in dict.fromkeys(canals)
        if canal.fee_basis
    )
    if not np.isfinite(cost).all():
        return fee, paid
    if not terms.currency and (cost.any() or terms.time_price):
        return fee, (*paid, "The prices name no currency: US dollars are assumed.")
    if math.isfinite(terms.dollar_rate) or not fee.any():
        return fee * terms.dollar_rate if fee.any() else fee, paid
    note = (
        f"Canal dues are in USD, prices in {terms.currency}: the cost is not known. Give the price "
        "of a dollar in the ship file (fuel.usd_rate)."
    )
    return np.where(fee > 0.0, math.nan, 0.0), (*paid, note)
