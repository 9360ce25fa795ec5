"""Times of the waypoints in a route file, against those at which the ship is there."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from thalweg.core.time import duration_text
from thalweg.core.types import BoolArray, FloatArray
from thalweg.core.units import KNOT, MINUTE

if TYPE_CHECKING:
    from thalweg.route.formats.parsed_track import ParsedTrack
    from thalweg.route.route import Route

TIMES_UNUSED: Final = "Times of the route file after the first are not used"  #: a note begins so
_LEAST_DIFFERENCE: Final = 5.0 * MINUTE  # smaller ones are not stated ...
_LEAST_SHARE: Final = 0.02  # ... nor those that are a smaller share of the time sailed


def stated_time_notes(contents: ParsedTrack, route: Route) -> list[str]:
    """Return a note where the times in a route file differ clearly from those of the ship.

    Times count from the first that the file states, so that another departure is no difference.

    Parameters
    ----------
    contents : Of the file.
    route : The evaluated route of it.

    Returns
    -------
    list of str : One note, on the leg whose time differs most and on the waypoint that is reached
        most too early or too late; empty where the file has fewer than two times.
    """
    stated = np.array(contents.times, float)
    sailed = _arrivals(route, len(stated))
    known = np.flatnonzero(np.isfinite(stated) & np.isfinite(sailed))
    if len(known) < 2:
        return []
    wanted, taken = (np.diff(times[known]) for times in (stated, sailed))
    late = np.cumsum(taken - wanted)
    of_legs = _clearly_differs(taken - wanted, taken)
    of_waypoints = _clearly_differs(late, np.cumsum(taken))
    if not (of_legs.any() or of_waypoints.any()):
        return []
    texts = []
    if of_legs.any():
        too_slow = of_legs & (taken > wanted)  # the ship cannot keep these; in others she is early
        stated_legs = too_slow if too_slow.any() else of_legs
        k = int(np.argmax(np.where(stated_legs, abs(taken - wanted), 0)))
        miles = _lengths(route, len(stated))[known[k] + 1 : known[k + 1] + 1].sum()
        text = _leg_text(known[k] + 1, known[k + 1], float(miles), wanted[k], taken[k])
        more = int(stated_legs.sum()) - 1
        text += f", and {more} more {'leg' if more == 1 else 'legs'} as well" if more > 0 else ""
        texts.append(text + (" (waits count)" if np.any(route.track.wait > 0.0) else ""))
    if of_waypoints.any():
        k = int(np.argmax(np.where(of_waypoints, np.abs(late), 0.0)))
        word = "later" if late[k] > 0.0 else "earlier"
        texts.append(
            f"waypoint {known[k + 1] + 1} is reached {duration_text(abs(float(late[k])))} {word}"
        )
    return [f"{TIMES_UNUSED}: {'; '.join(texts)}."]


def _leg_text(first: int, last: int, length: float, wanted: float, taken: float) -> str:
    """Return the speed over ground that the times of a leg [s] need, and the sailed one."""
    one = first == last
    legs = f"leg {first}" if one else f"legs {first} to {last}"
    if wanted <= 0.0:
        return f"{legs} would take no time, not {duration_text(float(taken))}"
    needed, sailed = length / wanted / KNOT, length / taken / KNOT
    is_word = "is" if one else "are"
    return f"{legs} would need {needed:.1f} kn and {is_word} sailed at {sailed:.1f} kn"


def _clearly_differs(difference: FloatArray, taken: FloatArray) -> BoolArray:
    return np.abs(difference) > np.maximum(_LEAST_DIFFERENCE, _LEAST_SHARE * np.abs(taken))


def _arrivals(route: Route, count: int) -> FloatArray:
    """Return when the ship is at each waypoint of the file [s since 1970-01-01T00:00Z]."""
    found = np.full(count, math.nan)
    found[:1] = route.depart
    number = np.asarray(route.track.leg_numbers)
    known = (number > 0) & (number < count)
    # of the parts of a leg the last one ends at the waypoint: later assignments hold
    found[number[known]] = np.asarray(route.legs["arrive"], float)[known]
    return found


def _lengths(route: Route, count: int) -> FloatArray:
    """Return the length of the leg that ends at each waypoint of the file [m]."""
    number = np.asarray(route.track.leg_numbers)
    total = np.bincount(number, weights=route.legs["length"], minlength=count)[:count]
    return np.asarray(total, float)
