"""What a route file has beside its track, carried by that into the files written of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Final, TypeAlias

from thalweg.core.geodesy import Position

#: Latitude and longitude [deg] of a waypoint, and how often the route was there before.
Visit: TypeAlias = tuple[float, float, int]


#: Attributes of a leg of RTZ: limits and draughts, and texts for the bridge.
LEG_NUMBERS: Final = (
    "safetyContour", "safetyDepth", "speedMin", "speedMax", "draughtForward", "draughtAft",
    "staticUKC", "dynamicUKC", "masthead",
)  # fmt: skip
LEG_TEXTS: Final = ("legReport", "legInfo", "legNote1", "legNote2")


def visits_of(positions: Iterable[Position]) -> list[Visit]:
    """Return the visits of positions in order; positions repeated at once are one visit."""
    seen: Counter[Position] = Counter()
    before: Position | None = None
    found = []
    for place in positions:
        seen[place] += place != before
        before = place
        found.append((*place, seen[place] - 1))
    return found


@dataclass(frozen=True)
class CarriedExtensions:
    """Names, cross-track limits and facts of a route file, and extensions of other makers.

    An extension is an XML text: an element that declares the prefixes it uses. Elements of the
    namespace of RTZ have no prefix: they belong to the version of the file they are written into.

    Attributes
    ----------
    general : By element that holds them: ``route``, ``routeInfo``, ``waypoints``,
        ``defaultWaypoint``, ``defaultLeg``, ``schedules``, ``schedule``, ``manual`` and
        ``calculated``.
    at : By visit of a waypoint and by element there: ``waypoint``, ``leg``, ``manualElement``,
        ``calculatedElement``.
    info : Attributes of ``routeInfo``, without the name of the route.
    names : Names of waypoints that were given by other makers.
    corridors : Cross-track limits to port and starboard of the leg that ends at a waypoint [m];
        NaN: none.
    details : Further attributes of RTZ, as texts by name, of a waypoint (``radius``) and of the
        leg that ends there (`LEG_NUMBERS`, `LEG_TEXTS`).
    """

    general: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    at: Mapping[Visit, Mapping[str, tuple[str, ...]]] = field(default_factory=dict)
    info: Mapping[str, str] = field(default_factory=dict)
    names: Mapping[Visit, str] = field(default_factory=dict)
    corridors: Mapping[Visit, tuple[float, float]] = field(default_factory=dict)
    details: Mapping[Visit, Mapping[str, str]] = field(default_factory=dict)

    def __bool__(self) -> bool:
        held = self.general, self.at, self.info, self.names, self.corridors, self.details
        return any(held)

    def of(self, element: str) -> tuple[str, ...]:
        """Return the extensions of an element that the file has once."""
        return self.general.get(element, ())

    def there(self, visit: Visit | None, element: str) -> tuple[str, ...]:
        """Return the extensions of an element at a waypoint."""
        return () if visit is None else self.at.get(visit, {}).get(element, ())


NO_EXTENSIONS = CarriedExtensions()
