"""Routes joined end to end: the passages of a voyage with via points or calls."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence

import numpy as np

from thalweg.core.errors import InputError
from thalweg.core.geodesy import longitude_difference
from thalweg.core.types import FloatArray, IntArray
from thalweg.route.route import Route
from thalweg.route.track import Track

_POSITION_TOLERANCE = 1e-9  # degrees between the end of a route and the start of the next
_TIME_TOLERANCE = 1e-3  # seconds between them that do not count as a wait
_QUANTITIES_OF_WAITS = {"waiting_fuel", "waiting_energy", "fuel_in_eca", "co2", "cost"} | {
    "encounters",
    "dense_traffic_time",
}


def join(routes: Sequence[Route]) -> Route:
    """Return one route from several that follow each other in place and time.

    Parameters
    ----------
    routes : sequence of Route
        Each starts where the one before ends, and not before its arrival; the time between becomes
        a wait. Fuel, energy, CO2 and cost of such a wait are unknown: evaluate the joined track
        with the referee to get them.

    Returns
    -------
    Route
        With the legs, samples and violations of all.

    Raises
    ------
    InputError
        If no route is given, or they do not follow each other.
    """
    if not routes:
        raise InputError(
            "No routes are given.", "One or more routes can be joined.", "Give at least one."
        )
    for before, after in itertools.pairwise(routes):
        _check_consecutive(before, after)
    if len({route.currency for route in routes}) > 1:
        raise InputError(
            f"The costs of the routes are in {' and '.join({r.currency for r in routes})}.",
            "They can be added in one currency only.",
            "Evaluate all of them with the same terms.",
        )
    first = np.cumsum([0, *(len(route.legs["length"]) for route in routes)])
    length = np.cumsum([0.0, *(route.legs["length"].sum() for route in routes)])
    legs = {name: np.concatenate([route.legs[name] for route in routes]) for name in routes[0].legs}
    waits = [
        after.depart - before.arrive > _TIME_TOLERANCE
        for before, after in itertools.pairwise(routes)
    ]
    doses = {name for name in legs if name.startswith("squared_dose:")}
    for name in (_QUANTITIES_OF_WAITS & legs.keys()) | doses:
        legs[name][first[1:-1][waits]] = np.nan
    samples = _joined_samples([route.samples for route in routes], first, length)
    waiting = [route.wait_samples or _without_rows(route.samples) for route in routes]
    return Route(
        _joined_track(routes),
        legs,
        samples,
        tuple(violation for route in routes for violation in route.violations),
        sum(route.tolerance_s for route in routes),
        tuple(dict.fromkeys(text for route in routes for text in route.assumptions)),
        _summed_by_name([route.fuel_zones for route in routes]),
        routes[0].prices,
        routes[0].engine_order,
        _joined_samples(waiting, first, length),
    )


def _joined_samples(
    parts: Sequence[Mapping[str, FloatArray]], first: IntArray, length: FloatArray
) -> dict[str, FloatArray]:
    """Return the samples of routes one after the other; ``first`` leg and distance of each."""
    names = [name for name in parts[0] if all(name in part for part in parts)]
    samples = {name: np.concatenate([part[name] for part in parts]) for name in names}
    sizes = [len(part["leg"]) for part in parts]
    samples["leg"] = samples["leg"] + np.repeat(first[:-1], sizes)
    samples["distance"] = samples["distance"] + np.repeat(length[:-1], sizes)
    return samples


def _without_rows(samples: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
    return {name: values[:0] for name, values in samples.items()}


def _summed_by_name(parts: Sequence[Mapping[str, float]]) -> dict[str, float]:
    """Return sums by name."""
    names = dict.fromkeys(name for part in parts for name in part)
    return {name: sum(part.get(name, 0.0) for part in parts) for name in names}


def _check_consecutive(before: Route, after: Route) -> None:
    a, b = before.track, after.track
    turn = abs(longitude_difference(a.lon[-1], b.lon[0]))
    if (
        abs(a.lat[-1] - b.lat[0]) > _POSITION_TOLERANCE
        or turn > _POSITION_TOLERANCE
        or not b.depart >= before.arrive - 1e-6
    ):
        raise InputError(
            "Two routes do not follow each other.",
            "Each must start where the one before ends, at or after its arrival.",
            "Give them in order, each departing when the one before arrives.",
        )


def _joined_track(routes: Sequence[Route]) -> Track:
    tracks = [route.track for route in routes]
    wait = [tracks[0].wait]
    for before, track in zip(routes, tracks[1:]):
        wait[-1] = wait[-1].copy()
        wait[-1][-1] = max(track.depart - before.arrive, 0.0) + track.wait[0]
        wait.append(track.wait[1:])
    return Track(
        np.concatenate([tracks[0].lat, *(t.lat[1:] for t in tracks[1:])]),
        np.concatenate([tracks[0].lon, *(t.lon[1:] for t in tracks[1:])]),
        tracks[0].depart,
        np.concatenate(wait),
        np.concatenate([t.setting for t in tracks]),
    )
