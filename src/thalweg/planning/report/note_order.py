"""Notes of a plan in the order of their weight: those on danger first."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final

from thalweg.network.layered.sections_round_land import OTHER_WAYS
from thalweg.planning.report.approach_report import (
    APPROACH_TOO_SMALL,
    LOW_BRIDGE,
    OVER_LAND,
    PORT_TOO_SHALLOW,
    TURNS_BACK,
)
from thalweg.planning.report.closed_way_report import PASSAGE_CLOSED, PASSAGES_CLOSED
from thalweg.planning.report.depth_report import CHECK_DEPTH, CROSSES_SHOAL
from thalweg.planning.report.distance_report import OFFING_DETOUR, SHOAL_DETOUR
from thalweg.planning.report.filled_weather import FILLED
from thalweg.planning.report.given_route_report import NEAR_LAND, TURNS_ROUND
from thalweg.planning.report.ice_report import REACHES_ICE
from thalweg.planning.report.land_report import (
    ALONG_COAST,
    CLOSE_TO_LAND,
    PASSES,
    TANKER_RULES,
    UNKNOWN_STREAM,
)
from thalweg.planning.report.lane_report import AGAINST_TRAFFIC, INSHORE_USED, LANE_DETOUR
from thalweg.planning.report.squat_report import SQUAT_UNCOUNTED
from thalweg.planning.report.unread_weather import WAVES_UNREAD, WIND_UNREAD
from thalweg.planning.report.waiting_report import (
    DEPARTURES,
    PASSES_TIME,
    STEMS,
    STRONG_STREAM,
    WAITS,
    WAITS_TO_LEAVE,
)
from thalweg.planning.report.wave_report import TOO_STEEP
from thalweg.planning.report.zone_report import FAR_AREAS, OVER_SPEED, WAR_RISK
from thalweg.planning.request.chart_restrictions import EXCLUDED_BY_DUES
from thalweg.planning.request.coverage_check import CHECK_YEAR, UNREAD
from thalweg.planning.request.offing_choice import NO_OFFING_ROUTE
from thalweg.planning.request.shoal_choice import SHOALS_OPENED
from thalweg.planning.request.swapped_degrees import CHECK_POSITION
from thalweg.planning.request.voyage_endpoints import NOT_REACHED, OTHER_NAME
from thalweg.route.referee.method_ranges import (
    OUT_OF_RANGE,
    WAVES_OUT_OF_RANGE,
    WAVES_UNCOUNTED,
)
from thalweg.route.stated_times import TIMES_UNUSED
from thalweg.sea.doubtful_values import NO_TIME, NO_UNITS
from thalweg.ship.schema.unusual_numbers import UNUSUAL
from thalweg.ship.ship_assumptions import BELOW_LOWEST, KWON_FORM

LIMIT_EXCEEDED: Final = "The referee finds a limit exceeded"  #: a note on a limit begins so
#: A note on speeds between those that a plan chooses among begins so.
SPEEDS_CHOSEN: Final = "The plan chooses among"
#: First words of notes that no summary may leave out, the most dangerous first.
_FIRST: Final[tuple[str | tuple[str, ...], ...]] = (
    NOT_REACHED,
    (OVER_LAND, PORT_TOO_SHALLOW, APPROACH_TOO_SMALL, LOW_BRIDGE),
    LIMIT_EXCEEDED,
    SQUAT_UNCOUNTED,
    (WAITS, WAITS_TO_LEAVE),
    PASSES_TIME,
    (STEMS, STRONG_STREAM),
    TOO_STEEP,
    WAVES_UNCOUNTED,
    WAR_RISK,
    REACHES_ICE,
    CHECK_POSITION,
    OTHER_NAME,
    CHECK_DEPTH,
    (CROSSES_SHOAL, SHOALS_OPENED),
    NEAR_LAND,
    CLOSE_TO_LAND,
    (TANKER_RULES, ALONG_COAST, UNKNOWN_STREAM),
    AGAINST_TRAFFIC,
    OVER_SPEED,
    FAR_AREAS,
    NO_OFFING_ROUTE,
    (TURNS_BACK, TURNS_ROUND),
    INSHORE_USED,
    (PASSAGE_CLOSED, PASSAGES_CLOSED),
    EXCLUDED_BY_DUES,
    OTHER_WAYS,
    FILLED,
    CHECK_YEAR,
    TIMES_UNUSED,
    (UNREAD, WAVES_UNREAD, WIND_UNREAD),
    (NO_UNITS, NO_TIME),
    UNUSUAL,
    KWON_FORM,
    WAVES_OUT_OF_RANGE,
    (OUT_OF_RANGE, BELOW_LOWEST),
    SPEEDS_CHOSEN,
    DEPARTURES,
    (SHOAL_DETOUR, OFFING_DETOUR),
    LANE_DETOUR,
)


def danger_first(notes: Iterable[str]) -> list[str]:
    """Return notes with those on danger first, the others in their order."""
    return sorted(notes, key=_weight)


def count_of_dangers(notes: Iterable[str]) -> int:
    """Return how many notes no summary may leave out."""
    return sum(_weight(note) < len(_FIRST) for note in notes)


def notes_of_routes(notes: Iterable[str], of_each: Sequence[Sequence[str]]) -> list[str]:
    """Return notes on all of some routes, and notes on danger and passages of each by its number.

    Parameters
    ----------
    notes : On all routes.
    of_each : Notes of each route; of those that differ only the ones on danger and on named
        passages are returned.
    """
    found = list(notes)
    for number, own in enumerate(of_each, start=1):
        for note in own:
            if all(note in other for other in of_each):
                found.append(note)
            elif count_of_dangers([note]) or note.startswith(PASSES):
                found.append(f"Route {number}: {note}")
    return danger_first(dict.fromkeys(found))


def _weight(note: str) -> int:
    words = note.partition(": ")[2] if note.startswith("Route ") else note
    return next((k for k, begin in enumerate(_FIRST) if words.startswith(begin)), len(_FIRST))
