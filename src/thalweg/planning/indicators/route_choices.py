"""Names of alternative routes, what each is best in and how it differs, in words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from thalweg.chart import Chart
from thalweg.chart.canals import canals_with_dues
from thalweg.chart.passage_crossings import names_passed
from thalweg.chart.passages import PASSAGES
from thalweg.core.errors import names_in_words
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

if TYPE_CHECKING:
    from thalweg.ship.schema.ship_schema import HullSection

SLOWER: Final = 0.05  #: routes on the same way differ where one takes this share longer
#: Names with one of these words have the article.
_KINDS: Final = frozenset(
    [
        *("Belt", "Canal", "Channel", "Minch", "Narrows", "Passage", "Race", "Sea", "Sound"),
        *("Strait", "Straits", "Trench"),
    ]
)
_INSHORE, _OFFSHORE = 50.0, 15.0  # share of the length near land above and below which [%]
_SAME_LENGTH: Final = 0.01  # share by which the lengths of one way may differ


@dataclass(frozen=True, eq=False)
class RouteChoice:
    """One of several routes of a voyage.

    Attributes
    ----------
    name, best_in : Such as ``"inshore by Naeroysund"``; what it is best in, in words.
    difference : From the fastest one, in words.
    passes : Named passages and capes that it passes, in order.
    canals, canal_dues_usd : Titles of its canals, in order; the dues of the ship there [USD].
    """

    name: str
    route: Route
    best_in: tuple[str, ...]
    difference: str
    passes: tuple[str, ...]
    canals: tuple[str, ...] = ()
    canal_dues_usd: float = 0.0

    def to_dict(self) -> dict[str, Any]:
        """Return plain data, ready for JSON."""
        return {
            "name": self.name,
            "best_in": list(self.best_in),
            "difference": self.difference,
            "passes": list(self.passes),
            "canals": list(self.canals),
            "canal_dues_usd": self.canal_dues_usd,
            "figures": all_figures(self.route),
            "route": self.route.as_dict(),
        }


def named_routes(
    chosen: Sequence[Route], candidates: Sequence[Route], chart: Chart, hull: HullSection
) -> tuple[RouteChoice, ...]:
    """Return the chosen routes with names, what each is best in, and differences in words.

    None is called best in what a candidate that was not chosen is better in.

    Parameters
    ----------
    hull : By which the dues of canals are found.
    """
    values = [compared_values(route) for route in chosen]
    best = best_of_all(values, [compared_values(route) for route in candidates])
    passes = [passages_of(route, chart) for route in chosen]
    used = [canals_with_dues(canals_passed(route, chart), hull) for route in chosen]
    canals = [tuple(canal.title for canal in some) for some in used]
    labels = [
        _label(route, by, bool(sum(canals, ())))
        for route, by in zip(chosen, ways_apart(canals, passes))
    ]
    found, lines = [], [line_at_shares(route) for route in chosen]
    for k, route in enumerate(chosen):
        words = tuple(COMPARED_FIGURES[name].words for name, j in best.items() if j == k)
        name = labels[k]
        if labels.count(name) > 1:
            name = f"{name}, {words[0] if words else f'number {k + 1}'}"
        words_of_it = difference_in_words(values[k], values[0]) if k else "the fastest"
        difference = words_of_it + waiting_in_words(route)
        alike = (j for j in range(k) if (canals[k], passes[k]) == (canals[j], passes[j]))
        near = [j for j in alike if not lines_differ(lines[k], lines[j])]
        miles = route.distance_nm  # of several, the way is that of nearest length
        same = min(near, key=lambda j: abs(chosen[j].distance_nm - miles), default=None)
        if same is not None:
            other = chosen[same]
            speeds = [one.distance_nm / one.time_h for one in (route, other)]
            slower = speeds[0] < (1.0 - SLOWER) * speeds[1]
            how = "slower" if slower else "with more miles"
            if slower and abs(miles / other.distance_nm - 1.0) > _SAME_LENGTH:
                how = f"slower and {miles - other.distance_nm:+.0f} nm"
            difference = f"the way of route {same + 1}, {how}: {difference}"
        dues = sum(canal.fee for canal in used[k])
        found.append(RouteChoice(name, route, words, difference, passes[k], canals[k], dues))
    return tuple(found)


def ways_apart(
    canals: Sequence[tuple[str, ...]], passes: Sequence[tuple[str, ...]]
) -> list[tuple[str, ...]]:
    """Return for each way its canals, and the passages that set it apart from the others.

    These are the passages that not all ways by the same canals pass. A way that avoids canals of
    others is also named by the passages that those do not pass, as the Cape of Good Hope.

    Parameters
    ----------
    canals, passes : Titles of canals, and names of passages and capes, of each way.
    """
    found = []
    for own, names in zip(canals, passes):
        alike = [set(passes[j]) for j, other in enumerate(canals) if set(other) == set(own)]
        round_it = [set(passes[j]) for j, other in enumerate(canals) if set(other) > set(own)]
        common = set.intersection(*alike)
        apart = [
            name
            for name in names
            if name not in common or (round_it and name not in set.union(*round_it))
        ]
        found.append((*own, *apart))
    return found


def name_with_limits(name: str) -> str:
    """Return the name of a passage or cape with the limits of ships there."""
    limits = next((p.limits for p in PASSAGES if p.name == name), "")
    return f"{name} ({limits})" if limits else name


def passages_of(route: Route, chart: Chart) -> tuple[str, ...]:
    """Return the named passages and capes that a route passes, in order."""
    lat, lon = np.asarray(route.track.lat, float), np.asarray(route.track.lon, float)
    return names_passed(chart.coastline, chart.passages, lat, lon)


def _with_article(name: str) -> str:
    """Return "the Suez Canal", but "Dover" and "Malacca"."""
    has_kind = name.startswith("Cape ") or not _KINDS.isdisjoint(name.replace("(", "").split())
    return f"the {name}" if has_kind else name


def _label(route: Route, names: Sequence[str], has_canals: bool) -> str:
    """Return how a route goes: by which canals and passages, else how near to land.

    How near to land it runs is left out where canals tell the ways apart.
    """
    share = indicator_value(route, "inshore_percent")
    where = (
        "inshore" if share >= _INSHORE else "offshore" if share <= _OFFSHORE else "along the coast"
    )
    where = "direct" if not np.isfinite(share) else where
    called = [_with_article(name) for name in names]
    by = names_in_words(called) if called else ""
    if by and has_canals:
        return f"by {by}"
    return f"{where} by {by}" if by else where
