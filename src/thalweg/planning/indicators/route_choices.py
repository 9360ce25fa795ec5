"""Names of alternative routes, what each is best in and how it differs, in words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.passage_crossings import names_passed
from thalweg.chart.passages import PASSAGES
from thalweg.planning.indicators.route_differences import line_at_shares, lines_differ
from thalweg.planning.indicators.route_figures import (
    COMPARED_FIGURES,
    all_figures,
    best_of_all,
    compared_values,
    difference_in_words,
    waiting_in_words,
)
from thalweg.planning.report.route_summary import canals_passed
from thalweg.route import Route
from thalweg.route.indicator_columns import indicator_value

SLOWER: Final = 0.05  #: routes on the same way differ where one takes this share longer
_INSHORE, _OFFSHORE = 50.0, 15.0  # share of the length near land above and below which [%]


@dataclass(frozen=True, eq=False)
class RouteChoice:
    """One of several routes of a voyage.

    Attributes
    ----------
    name, best_in : Such as ``"inshore by the Naeroysund"``; what it is best in, in words.
    difference : From the fastest one, in words.
    passes : Named passages and capes that it passes, in order.
    """

    name: str
    route: Route
    best_in: tuple[str, ...]
    difference: str
    passes: tuple[str, ...]

    def to_dict(self) -> dict[str, Any]:
        """Return plain data, ready for JSON."""
        return {
            "name": self.name,
            "best_in": list(self.best_in),
            "difference": self.difference,
            "passes": list(self.passes),
            "figures": all_figures(self.route),
            "route": self.route.as_dict(),
        }


def named_routes(
    chosen: Sequence[Route], candidates: Sequence[Route], chart: Chart
) -> tuple[RouteChoice, ...]:
    """Return the chosen routes with names, what each is best in, and differences in words.

    None is called best in what a candidate that was not chosen is better in.
    """
    values = [compared_values(route) for route in chosen]
    best = best_of_all(values, [compared_values(route) for route in candidates])
    passes = [_passes(route, chart) for route in chosen]
    common = set.intersection(*(set(names) for names in passes))
    labels = [
        _label(route, [name for name in names if name not in common])
        for route, names in zip(chosen, passes)
    ]
    found, lines = [], [line_at_shares(route) for route in chosen]
    canals = [[canal.name for canal in canals_passed(route, chart)] for route in chosen]
    for k, route in enumerate(chosen):
        words = tuple(COMPARED_FIGURES[name].words for name, j in best.items() if j == k)
        name = labels[k]
        if labels.count(name) > 1:
            name = f"{name}, {words[0] if words else f'number {k + 1}'}"
        words_of_it = difference_in_words(values[k], values[0]) if k else "the fastest"
        difference = words_of_it + waiting_in_words(route)
        alike = (j for j in range(k) if canals[k] == canals[j])
        same = next((j for j in alike if not lines_differ(lines[k], lines[j])), None)
        if same is not None:
            speeds = [chosen[j].distance_nm / chosen[j].time_h for j in (k, same)]
            how = "slower" if speeds[0] < (1.0 - SLOWER) * speeds[1] else "with more miles"
            difference = f"the way of route {same + 1}, {how}: {difference}"
        found.append(RouteChoice(name, route, words, difference, passes[k]))
    return tuple(found)


def name_with_limits(name: str) -> str:
    """Return the name of a passage or cape with the limits of ships there."""
    limits = next((p.limits for p in PASSAGES if p.name == name), "")
    return f"{name} ({limits})" if limits else name


def _passes(route: Route, chart: Chart) -> tuple[str, ...]:
    lat, lon = np.asarray(route.track.lat, float), np.asarray(route.track.lon, float)
    return names_passed(chart.coastline, chart.passages, lat, lon)


def _label(route: Route, names: Sequence[str]) -> str:
    """Return how a route goes: near land or far from it, and by which passages."""
    share = indicator_value(route, "inshore_percent")
    where = (
        "inshore" if share >= _INSHORE else "offshore" if share <= _OFFSHORE else "along the coast"
    )
    where = "direct" if not np.isfinite(share) else where
    by = " and the ".join(filter(None, (", the ".join(names[:-1]), *names[-1:])))
    return f"{where} by the {by}" if by else where
