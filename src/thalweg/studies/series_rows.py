"""Rows of a study with the detail ``network``: many departures of one voyage at once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from thalweg.chart import Chart
from thalweg.core.errors import InputError, ThalwegError
from thalweg.core.time import parse_time
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning import Voyage
from thalweg.planning.departures.departure_series import DepartureSeries
from thalweg.sea import Sea
from thalweg.ship import Ship
from thalweg.studies.study_checks import canonical_json

_KEPT = 4  # series, each with the sea of two windows


@dataclass(frozen=True)
class SeriesInputs:
    """What the voyages of a series share.

    Attributes
    ----------
    folder : Files are relative to it.
    """

    ship: Ship
    sea: Sea
    chart: Chart
    folder: str


_prepared: dict[str, tuple[DepartureSeries, DepartureSeries | None]] = {}


def series_key(request: Mapping[str, Any]) -> str:
    """Return what rows share that differ in their departure only."""
    voyage = {key: value for key, value in request["voyage"].items() if key != "depart"}
    return canonical_json({**request, "voyage": voyage})


def series_figures(
    requests: Sequence[Mapping[str, Any]], inputs: SeriesInputs
) -> list[dict[str, Any] | Exception]:
    """Return the figures of requests that differ in their departure only, or their refusals.

    Parameters
    ----------
    requests : One or more.

    Raises
    ------
    ThalwegError
        If none of them can be planned.
    """
    departs = [request["voyage"].get("depart") for request in requests]
    if any(depart is None for depart in departs):
        raise InputError(
            "The detail 'network' was requested for a voyage without a departure.",
            "It finds the least time of each departure.",
            "Give depart, or leave out detail.",
            field="detail",
        )
    series, blind = _series_of(requests[0], inputs)
    times = [parse_time(depart) for depart in departs]
    size = {
        "nodes": sum(one.n_nodes for one in series.networks),
        "segments": sum(one.n_edges for one in series.networks),
    }
    found: list[dict[str, Any] | Exception] = [
        one if isinstance(one, ThalwegError) else one | {"objective": "time", **size}
        for one in series.figures(times)
    ]
    if blind is None:
        return found
    return [
        one if isinstance(one, Exception) else one | _blind_figures(other)
        for one, other in zip(found, blind.figures(times))
    ]


def _blind_figures(other: Any) -> dict[str, Any]:
    if isinstance(other, ThalwegError):
        return {"blind_feasible": False}
    names = ("time_h", "fuel_t", "distance_nm", "sick_percent")
    return {f"blind_{name}": other[name] for name in names} | {"blind_feasible": True}


def _series_of(
    request: Mapping[str, Any], inputs: SeriesInputs
) -> tuple[DepartureSeries, DepartureSeries | None]:
    """Return the series of a request, and that along its weather-blind route if it is compared."""
    key = canonical_json([series_key(request), inputs.folder])
    if key not in _prepared:
        resolution = request.get("resolution_nm")
        series = DepartureSeries.prepare(
            Voyage.from_dict(request["voyage"]),
            ship=inputs.ship,
            sea=inputs.sea,
            chart=inputs.chart,
            network=request.get("network", "auto"),
            resolution=None if resolution is None else float(resolution) * NAUTICAL_MILE,
        )
        while len(_prepared) >= _KEPT:
            _prepared.pop(next(iter(_prepared)))
        compared = "weather_blind" in request.get("compare", ())
        _prepared[key] = series, series.weather_blind() if compared else None
    return _prepared[key]
