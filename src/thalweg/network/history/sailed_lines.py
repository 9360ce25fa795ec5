"""Lines of arcs as they were sailed: from where a voyage passes one junction to the next."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.arrays.numbered_parts import numbered_parts
from thalweg.core.geodesy import Position, distance, geocentric_positions, line_length
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.network.history.arc_lines import ArcLines, GlobeWays, LinesOffLand, repaired_line
from thalweg.network.history.junction_visits import ArcOccurrences
from thalweg.network.history.route_lines import following_arcs, moved_to_each_other
from thalweg.network.history.stretch_ends import EndFinder
from thalweg.network.history.turning_points import stretch_turning_points
from thalweg.network.history.voyage_tracks import VoyageTracks

if TYPE_CHECKING:
    from thalweg.chart import Chart

_FINER: Final = 8.0  # lines keep tracks within this part of the tolerance of turning points
_NEAR_ENDS: Final = 1.5  # radii of a port within which the line may lead straight to it
_PER_OFFSET: Final = 4.0  # such a leg is this many times as long as the track passes off the port
_ROUNDS: Final = 4
_NEAR: Final = 100.0  # waypoints nearer than this to another are one [m]


@dataclass(frozen=True)
class LineRules:
    """Radius of a junction, and tolerance of turning points [m]."""

    radius: float
    tolerance: float


def lines_as_sailed(
    chart: Chart,
    tracks: VoyageTracks,
    stretches: ArcOccurrences,
    tested: LinesOffLand,
    *,
    finder: EndFinder,
    fixed: BoolArray,
    rules: LineRules,
    ways: GlobeWays,
) -> LinesOffLand:
    """Return lines that begin and end where the voyages pass junctions, where the chart allows it.

    Lines through the middle of junctions have corners there that no ship sails. Lines that were
    repaired stay, and those that would be no shorter with their own ends, off land. So do those
    that cannot be joined to the line of a next arc at a junction; of two such arcs the one with
    fewer voyages.

    Parameters
    ----------
    stretches : All stretches of tracks.
    tested : Lines through the middle of junctions, each with its stretch.
    finder : Finds where lines begin and end at ports.
    fixed : Nodes to which lines lead as they are, such as ports and ends of canals, (N,).
    """
    radius = rules.radius
    own = stretches.take(tested.source)
    drawn = _drawn(tracks, own, finder, fixed, radius, rules.tolerance / _FINER)
    keep = (tested.repaired <= 0.0) & ~finder.through_canal(own)
    drawn, repaired = _off_land(chart, drawn, tested.lines.lengths, keep, ways)
    keep &= np.isfinite(repaired)
    voyages = np.bincount(stretches.tail * len(fixed) + stretches.head)  # of pairs of nodes
    weight = voyages[own.tail * len(fixed) + own.head]
    before, after = following_arcs(own.tail, own.head, fixed)
    for _ in range(_ROUNDS):
        lines = _chosen(tested.lines, drawn, keep)
        bad = _blocked_joints(chart, lines, before, after, radius) & (keep[before] | keep[after])
        if not bad.any():
            break
        a, b = before[bad], after[bad]
        weaker = np.where(keep[a] & (~keep[b] | (weight[a] <= weight[b])), a, b)
        keep[weaker] = False
    return replace(
        tested, lines=_chosen(tested.lines, drawn, keep),
        repaired=np.where(keep, repaired, tested.repaired),
    )  # fmt: skip


def _off_land(
    chart: Chart, lines: ArcLines, longest: FloatArray, some: BoolArray, ways: GlobeWays
) -> tuple[ArcLines, FloatArray]:
    """Return lines with shortest ways in place of legs over land, and the share of these.

    The share is NaN where that is not shorter than a given length [m], or there is no way.
    """
    bad = np.zeros(len(lines), bool)
    bad[lines.arc_of_leg[lines.blocked(chart)]] = True
    share = np.where(bad, np.nan, 0.0)
    found: dict[int, list[Position]] = {}
    for arc in np.flatnonzero(bad & some).tolist():
        lat, lon = lines.of(arc)
        line, part = repaired_line(chart, list(zip(lat.tolist(), lon.tolist())), ways)
        if line and line_length(line) < longest[arc]:
            found[arc], share[arc] = line, part
    if not found:
        return lines, share
    other = ArcLines.of_lists(list(found.values()))
    number = np.arange(len(lines))
    number[list(found)] = len(lines) + np.arange(len(found))
    return _joined(lines, other).take(number), share


def _drawn(
    tracks: VoyageTracks,
    stretches: ArcOccurrences,
    finder: EndFinder,
    fixed: BoolArray,
    radius: float,
    tolerance: float,
) -> ArcLines:
    """Return the lines of stretches with their own ends at junctions."""
    ends = finder.ends(stretches)
    begin, end = stretches.begin, stretches.end
    passed = geocentric_positions(tracks.vectors_at(np.stack([begin, end], axis=1)))
    track_lat, track_lon = (np.asarray(part, float) for part in passed)
    at_node = fixed[np.stack([stretches.tail, stretches.head], axis=1)]
    lat, lon = np.where(at_node, ends.lat, track_lat), np.where(at_node, ends.lon, track_lon)
    most = np.minimum(_NEAR_ENDS * radius, 0.25 * (end - begin))[:, None]
    margin = np.minimum(_PER_OFFSET * distance(lat, lon, track_lat, track_lon), most)
    low, high = begin + margin[:, 0], end - margin[:, 1]
    at = np.flatnonzero(stretch_turning_points(tracks, begin, end, tolerance))
    first = np.searchsorted(tracks.along[at], low, side="right")
    inner = np.maximum(np.searchsorted(tracks.along[at], high, side="left") - first, 0)
    ptr = cumulative_sums(inner + 4)
    found = np.empty((2, ptr[-1]))
    for k, edge in enumerate((ptr[:-1], ptr[1:] - 1)):
        found[0, edge], found[1, edge] = lat[:, k], lon[:, k]
    for edge, along in ((ptr[:-1] + 1, low), (ptr[1:] - 2, high)):
        found[:, edge] = geocentric_positions(tracks.vectors_at(along))
    line, rank = numbered_parts(inner)
    to, of = ptr[line] + 2 + rank, at[first[line] + rank]
    found[:, to] = tracks.lat[of], tracks.lon[of]
    use = np.ones(ptr[-1], bool)  # without a margin the second place is the first
    use[ptr[:-1] + 1], use[ptr[1:] - 2] = (margin > 0.0).T
    kept = cumulative_sums(use)[ptr]
    return _without_near(ArcLines(kept, found[0, use], found[1, use]))


def _without_near(lines: ArcLines) -> ArcLines:
    """Return lines without the inner waypoints that are hardly apart from the one before or an end.

    Legs of a few metres have no course.
    """
    end = np.zeros(len(lines.lat), bool)
    end[lines.ptr[:-1]] = end[lines.ptr[1:] - 1] = True
    near = lines.legs[lines.leg_lengths < _NEAR]
    drop = np.zeros(len(lines.lat), bool)
    drop[near + 1] = True
    drop[near[end[near + 1]]] = True
    keep = ~drop | end
    ptr = cumulative_sums(keep)[lines.ptr]
    return ArcLines(ptr, lines.lat[keep], lines.lon[keep])


def _chosen(old: ArcLines, new: ArcLines, use_new: BoolArray) -> ArcLines:
    """Return the new lines where they are used, else the old ones."""
    return _joined(old, new).take(np.arange(len(old)) + np.where(use_new, len(old), 0))


def _joined(first: ArcLines, second: ArcLines) -> ArcLines:
    """Return the lines of two parts, one after the other."""
    return ArcLines(
        np.concatenate([first.ptr, first.ptr[-1] + second.ptr[1:]]),
        np.concatenate([first.lat, second.lat]),
        np.concatenate([first.lon, second.lon]),
    )


def _blocked_joints(
    chart: Chart, lines: ArcLines, before: IntArray, after: IntArray, radius: float
) -> BoolArray:
    """Return which arcs cannot be sailed one after the other when their lines are joined."""
    count = len(before)
    pairs = lines.take(np.stack([before, after], axis=1).ravel())
    first = 2 * np.arange(count)
    joined = moved_to_each_other(pairs, first, first + 1, radius)
    blocked = lines.blocked(chart)  # lines that the chart blocks by themselves are not refused here
    whole = np.bincount(lines.arc_of_leg, blocked, minlength=len(lines)) > 0
    bad = np.zeros(2 * count, bool)
    bad[joined.arc_of_leg[joined.blocked(chart)]] = True
    return (bad[0::2] & ~whole[before]) | (bad[1::2] & ~whole[after])
