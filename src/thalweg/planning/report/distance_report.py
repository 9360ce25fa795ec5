"""Notes on distances by sea: water too shallow, miles that shoals add, ways far round."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

import numpy as np

from thalweg.chart.approaches import PortApproach
from thalweg.chart.depth.global_depth import NAME
from thalweg.chart.depth.shoals import EXCESS
from thalweg.core.geodesy import Position, densify, distance
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.seaways import Seaways

#: Ways without a draught have a note where they do not keep off water shallower than this [m].
LEAST_DEPTH: Final = 2.5
_CLEARLY_LONGER: Final = 1.05
#: Ways so much longer than the straight line, up to so long [m], may miss a channel.
_ROUNDABOUT: Final = 2.5
_LONGEST_STRAIGHT: Final = 100.0 * NAUTICAL_MILE


def shoal_notes(seas: Seaways, path: Sequence[Position], draught: float | None) -> tuple[str, ...]:
    """Return how many miles of a way have less water than the draught, as a note.

    Parameters
    ----------
    seas : With the shoals of the draught; without shoals there is no note.
    path : Positions (lat, lon) [deg].
    draught : [m]; None: not known.
    """
    miles = shoal_miles(seas, path)
    if miles < 1.0:
        return ()
    depth = "the draught" if draught is not None else f"{LEAST_DEPTH:g} m"
    return (
        f"{miles:.0f} nm of the way have less water than {depth}, by the {NAME}: this graph of "
        "all seas is coarse near shoals, and a plan may find a longer way round.",
    )


def shoal_detour_notes(
    length: float, without: float, finest: Callable[[], float]
) -> tuple[str, ...]:
    """Return how much longer shoals make a way, as a note.

    Parameters
    ----------
    length : Of the way [m].
    without : Length of the way over shoals, on the graph of all seas [m].
    finest : Gives the same, sailed to the offing [m]; asked only where it may matter.
    """
    if _CLEARLY_LONGER * without >= length:
        return ()
    direct = finest()
    longer = (length - direct) / NAUTICAL_MILE
    if _CLEARLY_LONGER * direct >= length or longer < 1.0:
        return ()
    return (
        f"Keeps off shoal water by the {NAME}, which is coarse: the shortest way for this draught "
        f"is {longer:.0f} nm shorter, over that water. See the chart.",
    )


def roundabout_notes(line: Sequence[Position], length: float) -> tuple[str, ...]:
    """Return a note on a way [m] much longer than the straight line between its ends."""
    straight = float(distance(*line[0], *line[-1]))
    if straight > _LONGEST_STRAIGHT or length < _ROUNDABOUT * straight:
        return ()
    return (
        f"{length / NAUTICAL_MILE:.0f} nm by sea for {straight / NAUTICAL_MILE:.0f} nm in a "
        "straight line: narrow channels that are not in the table of passages are closed. See on "
        "the chart whether there is one.",
    )


def shoal_miles(seas: Seaways, path: Sequence[Position]) -> float:
    """Return how many miles of a way have less water than required.

    Parameters
    ----------
    seas : With shoals; 0 without.
    path : Positions (lat, lon) [deg].
    """
    if seas.shoals is None or len(path) < 2:
        return 0.0
    way = np.array(path, float)
    lat, lon, leg = densify(way[:, 0], way[:, 1], NAUTICAL_MILE)
    legs = lat[:-1], lon[:-1], lat[1:], lon[1:]
    counted = np.asarray(seas.chart.canal_of_legs(*way[:-1].T, *way[1:].T))[leg] < 0
    shallow = (seas.shoals.excess(*legs) > EXCESS[0]) & counted
    return float(np.sum(distance(*legs)[shallow])) / NAUTICAL_MILE


def avoided_on_approach_notes(
    seas: Seaways, straits: Sequence[str], approaches: Sequence[PortApproach]
) -> tuple[str, ...]:
    """Return a note on passages to avoid that the approach of a port leads through.

    Parameters
    ----------
    seas : With what the request avoids.
    straits : Names of the passages of the way.
    approaches : Of the way.
    """
    names = [name for name in straits if name in seas.passages]
    if not names or not approaches:
        return ()
    return (
        f"Not avoided: {', '.join(names)}: the approach of a port leads through it. Approaches are "
        "lines of a table; what is to avoid closes only the way between them.",
    )
