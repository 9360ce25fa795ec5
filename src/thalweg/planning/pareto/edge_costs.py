"""Costs of edges that depend on the water they cross: length, land and other ships."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.geodesy import direct, distance, inverse
from thalweg.core.objective import LegPrices
from thalweg.core.types import FloatArray
from thalweg.route.indicator_columns import INSHORE_DISTANCE, LAND_DISTANCE_CAP

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.network import Network

_SAMPLES: Final = 8  # along each edge


def edge_costs(
    network: Network, chart: Chart, prices: LegPrices, *, depart: float, speed: float
) -> FloatArray | None:
    """Return the cost of every edge besides consumption and time; None where there is none.

    It is that of length, land and other ships, and what the penalty factor adds to the price of
    time at the highest speed.

    Parameters
    ----------
    depart : When the ship leaves [s since 1970].
    speed : Over ground [m/s], for the rate and the time of encounters: a search does not know the
        time at which it comes to an edge, so that the ship is taken to come there straight.

    Raises
    ------
    InputError
        If encounters have a price and the traffic on some edge is not known.
    """
    penalty = np.asarray(network.edges.penalty_factor, float) - 1.0
    priced = prices.time > 0.0 and bool(penalty.any())
    if not (prices.counts_water or priced):
        return None
    length = np.asarray(network.edges.length, float)
    cost = prices.length * length + prices.time * penalty * length / speed
    if max(prices.inshore, prices.encounters) <= 0.0:
        return np.asarray(cost)
    tail, head = network.tails(), np.asarray(network.graph.target)
    legs = network.lat[tail], network.lon[tail], network.lat[head], network.lon[head]
    start = float(network.lat[network.meta.start]), float(network.lon[network.meta.start])
    return np.asarray(cost + costs_of_water(legs, chart, prices, start, depart=depart, speed=speed))


def costs_of_water(
    legs: Sequence[FloatArray],
    chart: Chart,
    prices: LegPrices,
    start: tuple[float, float],
    *,
    depart: float,
    speed: float,
    samples: int = _SAMPLES,
) -> FloatArray:
    """Return the cost of land and other ships of legs.

    Parameters
    ----------
    legs : Latitudes and longitudes of their starts and ends [deg], 4 arrays (n,).
    start : Latitude and longitude [deg] of the ship when she leaves.
    depart, speed : As in `edge_costs`.
    samples : Positions on each leg.

    Raises
    ------
    InputError
        If encounters have a price and the traffic on some leg is not known.
    """
    (length, _, _), (lat, lon) = inverse(*legs), _leg_samples(legs, samples)
    cost = np.zeros(len(length))
    if prices.inshore > 0.0:
        shore = chart.coastline.shore_distance(lat, lon, cap=LAND_DISTANCE_CAP)
        near = np.asarray(shore < INSHORE_DISTANCE, float).reshape(-1, samples)
        cost += prices.inshore * length * near.mean(axis=1)
    if prices.encounters > 0.0:
        away = np.asarray(distance(*start, lat, lon))
        times = depart + away / speed
        cost += prices.encounters * _encounters(chart, (lat, lon), times, length, speed)
    return cost


def _leg_samples(legs: Sequence[FloatArray], samples: int) -> tuple[FloatArray, FloatArray]:
    """Return positions on legs [deg], some for each in order, at equal distances."""
    length, course, _ = inverse(*legs)
    share = (np.arange(samples) + 0.5) / samples
    at = [np.repeat(x, samples) for x in (*legs[:2], course, length)]
    lat, lon = direct(at[0], at[1], at[2], at[3] * np.tile(share, len(length)))
    return np.asarray(lat), np.asarray(lon)


def _encounters(
    chart: Chart,
    places: tuple[FloatArray, FloatArray],
    times: FloatArray,
    length: FloatArray,
    speed: float,
) -> FloatArray:
    if chart.traffic is None:
        raise InputError(
            "The objective counts encounters with other ships, but no traffic is given.",
            "Traffic is zones with rates (GeoJSON) or a grid of density.",
            "Give --traffic FILE, or Chart.with_traffic.",
            field="objective",
        )
    lat, lon = places
    rate = chart.traffic.rate(lat, lon, times, speed)
    found = rate.reshape(len(length), -1).mean(axis=1) * length / speed
    unknown = np.flatnonzero(np.isnan(found))
    if len(unknown):
        at = np.flatnonzero(np.isnan(rate))[0]
        raise InputError(
            f"The traffic is not known on {len(unknown)} of {len(found)} legs, such as at "
            f"{lat[at]:.2f}, {lon[at]:.2f}.",
            "Encounters can be minimised where the traffic is known in all water.",
            "Add a zone or a grid there, or a member 'elsewhere' to the GeoJSON of the zones.",
            field="objective",
        )
    return np.asarray(found)
