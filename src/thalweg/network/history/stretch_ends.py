"""Where stretches of tracks begin and end: at nodes, or where ships leave an approach early."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from thalweg.chart.approaches import dense_line
from thalweg.core.geodesy import distance, geocentric_positions
from thalweg.core.types import BoolArray, FloatArray, IntArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.history.junction_visits import OFF_LINE, ArcOccurrences
from thalweg.network.history.voyage_tracks import HistoryPort, VoyageTracks

if TYPE_CHECKING:
    from thalweg.chart import Chart

_SHORT: Final = 0.5 * NAUTICAL_MILE
_MOVED: Final = 3.0 * NAUTICAL_MILE  # to water, where the coastline does not show the river


@dataclass(frozen=True, eq=False)
class StretchEnds:
    """Ends of m stretches.

    Parameters
    ----------
    lat, lon : Positions of the first and the last place [deg], (m, 2).
    approach : Length between these and the berths of ports [m], (m, 2); 0 at junctions.
    """

    lat: FloatArray
    lon: FloatArray
    approach: FloatArray


@dataclass(frozen=True, eq=False)
class EndFinder:
    """Finds where stretches of tracks begin and end.

    A ship that turns into a canal does not come near the sea end of the approach. Where a track is
    on the line of the approach, and not near its sea end, or farther from it than the stretch is
    long, the stretch begins there, and so much of the approach is sailed as lies before.

    Parameters
    ----------
    chart : Shows where water is.
    tracks : VoyageTracks
    places : Positions of the nodes [deg], (lat, lon): junctions, then ports.
    ports : The ports.
    canal_ends : How many of the first nodes are ends of canals, two of each (`Junctions`).
    """

    chart: Chart
    tracks: VoyageTracks
    places: tuple[FloatArray, FloatArray]
    ports: Sequence[HistoryPort]
    canal_ends: int = 0

    def through_canal(self, stretches: ArcOccurrences) -> BoolArray:
        """Return which stretches lead from one end of a canal to the other."""
        tail, head = stretches.tail, stretches.head
        return (np.maximum(tail, head) < self.canal_ends) & (tail // 2 == head // 2)

    @property
    def node_approach(self) -> FloatArray:
        """Length of the approach of every node [m]; 0 at junctions."""
        junctions = np.zeros(len(self.places[0]) - len(self.ports))
        return np.append(junctions, [port.approach_m for port in self.ports])

    def ends(self, stretches: ArcOccurrences) -> StretchEnds:
        """Return the ends of stretches."""
        nodes = np.stack([stretches.tail, stretches.head], axis=1)
        lat, lon = self.places[0][nodes], self.places[1][nodes]
        approach = self.node_approach[nodes]
        along = np.stack([stretches.begin, stretches.end], axis=1)
        track = geocentric_positions(self.tracks.vectors_at(along.ravel()))
        track_lat, track_lon = (np.asarray(part).reshape(along.shape) for part in track)
        apart = distance(lat, lon, track_lat, track_lon)
        short = np.maximum(stretches.end - stretches.begin, _SHORT)[:, None]  # as before a canal
        far = (approach > 0.0) & (apart > np.minimum(OFF_LINE, short))
        for row, side in np.argwhere(far).tolist():
            found = self._left_early(
                int(nodes[row, side]), float(track_lat[row, side]), float(track_lon[row, side])
            )
            if found is not None:
                lat[row, side], lon[row, side] = found[:2]
                sailed = self._from_berth(stretches.take(np.array([row])), side)
                approach[row, side] = min(found[2], sailed)
        return StretchEnds(lat, lon, approach)

    def _from_berth(self, stretch: ArcOccurrences, side: int) -> float:
        """Return the length between a berth and one end of a stretch (1,), by its track [m].

        It is infinite where the voyage did not begin, or end, at the port of that end.
        """
        tracks, voyage = self.tracks, int(stretch.voyage[0])
        port = int(stretch.head[0] if side else stretch.tail[0]) - (
            len(self.places[0]) - len(self.ports)
        )
        if port != int((tracks.goal if side else tracks.start)[voyage]):
            return np.inf
        stop = int(tracks.ptr[voyage + 1]) - 1 if side else int(tracks.ptr[voyage])
        sailed = abs(float((stretch.end if side else stretch.begin)[0] - tracks.along[stop]))
        berth = self.ports[port].places[0]
        return sailed + float(distance(tracks.lat[stop], tracks.lon[stop], *berth))

    def _left_early(self, node: int, lat: float, lon: float) -> tuple[float, float, float] | None:
        """Return the water where a track leaves an approach, and the length of it from the berth.

        None where the track is not on the line of the approach.
        """
        port = self.ports[node - (len(self.places[0]) - len(self.ports))]
        if len(port.places) < 3:
            return None
        line = dense_line(port.places[1:])
        apart = np.asarray(distance(lat, lon, line[:, 0], line[:, 1]))
        nearest = int(np.argmin(apart))
        if apart[nearest] > OFF_LINE:
            return None
        water = self.chart.nearest_navigable(lat, lon, largest=_MOVED)
        if water is None:
            return None
        return float(water[0]), float(water[1]), float(line[nearest, 2] + apart[nearest])


def ends_at_nodes(tail: IntArray, head: IntArray, node_approach: FloatArray) -> FloatArray:
    """Return the lengths of whole approaches at the ends of arcs (A, 2) [m]."""
    return np.asarray(node_approach[np.stack([tail, head], axis=1)], float).reshape(-1, 2)
