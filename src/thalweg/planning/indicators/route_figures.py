"""Key figures of routes beside each other: what each is best in, and how it differs, in words."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Final, NamedTuple

import numpy as np

from thalweg.planning.report.waiting_report import LEAST_WAIT_H, waits_without_fuel
from thalweg.route import Route
from thalweg.route.indicator_columns import INDICATORS, indicator_value, named_columns
from thalweg.route.number_texts import amount_text, decimals


class ComparedFigure(NamedTuple):
    """A figure by which routes are compared.

    Attributes
    ----------
    best : "least" or "greatest".
    words : Of the route that is best in it.
    short : Name in a table.
    digits : Least number of decimals in words and tables.
    """

    best: str
    words: str
    short: str
    digits: int


#: By importance: the first in which a route is best gives it its name.
COMPARED_FIGURES: Final = {
    "time": ComparedFigure("least", "fastest", "time", 1),
    "sick_percent": ComparedFigure("least", "least motion sickness", "sick", 0),
    "fuel": ComparedFigure("least", "least fuel", "fuel", 2),
    "cost": ComparedFigure("least", "cheapest", "cost", 0),
    "encounters": ComparedFigure("least", "fewest encounters", "encounters", 1),
    "land_distance_nm": ComparedFigure("greatest", "farthest from land", "off land at sea", 1),
    "near_ground_h": ComparedFigure("least", "least time near the ground", "near ground", 1),
    "workable_percent": ComparedFigure("greatest", "most time to work", "workable", 0),
    "distance": ComparedFigure("least", "shortest", "length", 0),
    "max_acceleration": ComparedFigure("least", "least acceleration", "acceleration", 2),
    "worst_hour_percent": ComparedFigure("least", "mildest worst hour", "worst hour", 0),
    "contour_distance_nm": ComparedFigure("greatest", "farthest from shoals", "off shoals", 1),
    "inshore_percent": ComparedFigure("greatest", "most sheltered by land", "inshore", 0),
}
_OF_PLACES: Final = (
    "comfort", "sick_percent", "worst_hour_percent", "max_acceleration", "uncomfortable_percent"
)  # fmt: skip
_MOST_DIGITS: Final = {"time": 2, "distance": 1, "fuel": 5, "cost": 2}  # of small values
_EQUAL: Final = 1e-2  # figures that differ by less than this share are the same
_READ_AS_SUMS: Final = ("fuel", "cost")
_EQUAL_SUMS: Final = 1e-3  # the same for these, of the least
_EQUAL_POINTS: Final = 0.5  # ... as are those in per cent of the time, by so many points ...
_EQUAL_SHELTER: Final = 5.0  # ... and those in per cent of the length near land
_WORTH_WORDS: Final = 0.03  # smaller differences are not put into words ...
_WORTH_WORDS_OF_TIME: Final = 0.005  # ... but those of time are
_IN_WORDS: Final = ("time", "sick_percent", "fuel", "encounters", "distance")


def compared_values(route: Route) -> dict[str, float]:
    """Return the compared figures of a route; NaN where one is not known."""
    return {name: indicator_value(route, name) for name in COMPARED_FIGURES}


def all_figures(route: Route) -> dict[str, float | None]:
    """Return every indicator of a route with its unit in its name, for tables; None unknown.

    Those with places or tasks have a column for each.
    """
    found: dict[str, float | None] = {}
    places = list(named_columns(route.legs, "squared_dose"))
    tasks = list(named_columns(route.legs, "workable_time"))
    for name, (unit, _) in INDICATORS.items():
        column = _with_unit(name, unit or (route.currency if name == "cost" else ""))
        names: list[str | None] = [None]
        if name in _OF_PLACES or name == "workable_percent":
            names = [*(places if name in _OF_PLACES else tasks)] or [None]
        for at in names:
            value = indicator_value(route, name, at)
            key = column if at is None else f"{column}:{at}"
            found[key] = value if math.isfinite(value) else None
    return found


def _with_unit(name: str, unit: str) -> str:
    ending = unit.lower().replace("%", "percent").replace("/", "_")
    return name if not ending or name.endswith(ending) else f"{name}_{ending}"


def champions(values: Sequence[dict[str, float]]) -> dict[str, int]:
    """Return for each figure the route that is best in it, where routes differ in it.

    Parameters
    ----------
    values : Compared figures of each route.
    """
    found = {}
    for name, figure in COMPARED_FIGURES.items():
        column = np.array([one[name] for one in values])
        if not np.isfinite(column).all():
            continue
        signed = column if figure.best == "least" else -column
        equal = _tolerance(name, column)
        if name in _READ_AS_SUMS:  # a route with the larger sum is not called the cheapest
            equal = min(equal, _EQUAL_SUMS * float(np.abs(column).min()))
        shown = np.round(signed, figure_digits(name, column))  # as in the table
        if np.ptp(column) > equal and np.ptp(shown) > 0.0:  # of equal ones the fastest
            near = signed <= signed.min() + equal
            near |= shown == shown[np.argmin(signed)]
            near = np.flatnonzero(near if name != "time" else signed <= signed.min())
            times = np.array([one["time"] for one in values])
            found[name] = int(near[np.argmin(times[near])])
    return found


def figure_digits(name: str, values: Iterable[float]) -> int:
    """Return with how many decimals a figure of routes is compared and written, in its own unit.

    Parameters
    ----------
    values : Of the routes beside each other; small and near values have more decimals.
    """
    digits = COMPARED_FIGURES[name].digits
    most = _MOST_DIGITS.get(name)
    return digits if most is None else decimals(values, least=digits, most=most)


def _tolerance(name: str, values: np.ndarray) -> float:
    """Return by how much values of a figure differ that are the same."""
    if name == "workable_percent":  # what is missing to 100 % counts
        return _EQUAL_POINTS
    if name == "inshore_percent":
        return _EQUAL_SHELTER
    return _EQUAL * max(float(np.nanmax(np.abs(values))), 1e-12)


def best_of_all(
    values: Sequence[dict[str, float]], candidates: Sequence[dict[str, float]]
) -> dict[str, int]:
    """Return `champions` of some routes, in what no other candidate is clearly better in.

    Parameters
    ----------
    values, candidates : Compared figures of the routes, and of these and all others.
    """
    best = champions(values)
    for name, at in list(best.items()):
        every = np.array([one[name] for one in candidates])
        signed = every if COMPARED_FIGURES[name].best == "least" else -every
        own = values[at][name] * (1.0 if COMPARED_FIGURES[name].best == "least" else -1.0)
        digits = figure_digits(name, every)
        equal = _tolerance(name, every)
        least = float(np.nanmin(signed))
        if own > least + equal and round(own, digits) > round(least, digits):
            del best[name]
    return best


def difference_in_words(values: dict[str, float], reference: dict[str, float]) -> str:
    """Return how a route differs from another, such as ``+31 min, -60 % sick``."""
    words = []
    for name in _IN_WORDS:
        own, other = values[name], reference[name]
        if not (math.isfinite(own) and math.isfinite(other)):
            continue
        change = own - other
        worth = _WORTH_WORDS_OF_TIME if name == "time" else _WORTH_WORDS
        if abs(change) <= worth * max(abs(other), abs(own), 1e-12):
            continue
        sign = "+" if change > 0.0 else "-"
        if name == "time":
            words.append(f"{sign}{_duration(abs(change))}")
        elif name == "distance":
            words.append(f"{sign}{abs(change):.{0 if abs(change) >= 3.0 else 1}f} nm")
        elif name == "sick_percent":
            digits = 0 if abs(change) >= 1.0 else 1
            words.append(f"{own:.{digits}f} % sick instead of {other:.{digits}f} %")
        elif name == "encounters":
            words.append(f"{own:.1f} encounters instead of {other:.1f}")
        else:
            share = f" ({sign}{abs(change) / other:.0%})" if other > 0.0 else ""
            words.append(f"{sign}{amount_text(abs(change), 't')} fuel{share}".replace("%)", " %)"))
    return ", ".join(words) or "nearly the same figures"


def waiting_in_words(route: Route) -> str:
    """Return how long a route waits, such as ``; 4.4 h of it waiting``; empty below 6 minutes."""
    if not route.waiting_h > LEAST_WAIT_H:
        return ""
    free = ", which takes no fuel (no hotel load in the ship file)"
    free = free if waits_without_fuel(route) else ""
    return f"; {_duration(route.waiting_h)} of it waiting{free}"


def _duration(hours: float) -> str:
    return f"{60.0 * hours:.0f} min" if hours < 2.0 else f"{hours:.1f} h"
