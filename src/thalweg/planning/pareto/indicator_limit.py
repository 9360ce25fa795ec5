"""A limit of an indicator over the whole route."""

from __future__ import annotations

import math
from dataclasses import dataclass

from thalweg.planning.voyage import Voyage
from thalweg.route import Route
from thalweg.route.indicator_columns import INDICATOR_WORDS, INDICATORS, indicator_value


@dataclass(frozen=True)
class IndicatorLimit:
    """A limit of an indicator of the whole route.

    Attributes
    ----------
    name, at : Indicator, and place or task (None for the first).
    value : [unit of the indicator].
    sense : 1 for at most, -1 for at least.
    """

    name: str
    at: str | None
    value: float
    sense: int

    @classmethod
    def of_voyage(cls, voyage: Voyage) -> tuple[IndicatorLimit, ...]:
        """Return the limits of a voyage."""
        found = []
        for sense, given in ((1, voyage.at_most), (-1, voyage.at_least)):
            for key, value in given.items():
                name, _, at = key.partition(":")
                found.append(cls(name, at or None, float(value), sense))
        return tuple(found)

    def excess(self, route: Route) -> float:
        """Return by how much a route breaks the limit; 0 where it keeps it, inf where unknown."""
        value = indicator_value(route, self.name, self.at)
        return max(self.sense * (value - self.value), 0.0) if math.isfinite(value) else math.inf

    def text(self, route: Route | None = None) -> str:
        """Return the limit, and the value of a route, in words."""
        unit = INDICATORS[self.name][0]
        sense = "most" if self.sense > 0 else "least"
        words = f"{self._words} at {sense} {self.value:g} {unit}".rstrip()
        if route is None:
            return words
        value = indicator_value(route, self.name, self.at)
        return (
            f"{words} (this route: {value:.3g})" if math.isfinite(value) else f"{words} (not known)"
        )

    def value_text(self, route: Route) -> str:
        """Return the value of a route in words."""
        value = indicator_value(route, self.name, self.at)
        unit = INDICATORS[self.name][0]
        known = f"{value:.3g} {unit}".rstrip() if math.isfinite(value) else "not known"
        return f"{self._words} {known}"

    @property
    def _words(self) -> str:
        """The indicator in words, with its name and its place."""
        name = f"{self.name}:{self.at}" if self.at else self.name
        words = INDICATOR_WORDS.get(self.name, "")
        return f"{words} ({name})" if words else name
