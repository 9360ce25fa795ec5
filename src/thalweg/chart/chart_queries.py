"""Tests of positions and legs on a chart, and its fingerprint."""

from __future__ import annotations

import hashlib
from functools import lru_cache, partial
from typing import Final, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.chart import canals as canal_data
from thalweg.chart.approaches import PortApproaches
from thalweg.chart.canals import Canal
from thalweg.chart.coast.coast_index_builder import empty_index
from thalweg.chart.coast.coastline import Coastline
from thalweg.chart.coast.leg_status import leg_status, point_status
from thalweg.chart.coast.snapping import is_joined_to_sea, nearest_navigable
from thalweg.chart.depth.depth_layers import DepthLayers
from thalweg.chart.offing import Offing, sea_room
from thalweg.chart.passages import Passage
from thalweg.chart.zones.ship_traffic import ShipTraffic
from thalweg.chart.zones.zone_set import Zones
from thalweg.core.bounding_box import WORLD, BoundingBox
from thalweg.core.types import FloatArray
from thalweg.kernels.codes import LAND, OFFING, OK
from thalweg.kernels.geometry.coast_index import CoastArrays
from thalweg.kernels.geometry.offing_along_legs import OffingArrays

_OPEN_SEA: Final = 10_000.0  # water this far from land is open sea without a test [m]


class ChartParts(Protocol):
    """What the tests need of a chart."""

    @property
    def coastline(self) -> Coastline:
        """Land: its polygons and the distance to the shore."""
        ...

    @property
    def area(self) -> BoundingBox:
        """Box that no leg may leave."""
        ...

    @property
    def zones(self) -> Zones:
        """Zones that are closed, that cost more, or where a ship may or may not wait."""
        ...

    @property
    def depths(self) -> DepthLayers:
        """Charted depth."""
        ...

    @property
    def canals(self) -> tuple[Canal, ...]:
        """Ship canals that are open."""
        ...

    @property
    def approaches(self) -> PortApproaches | None:
        """Lines from the berths of ports to open sea."""
        ...

    @property
    def passages(self) -> tuple[Passage, ...]:
        """Passages in which ships may come nearer to land than the offing."""
        ...

    @property
    def closed_passages(self) -> tuple[Passage, ...]:
        """Passages that no leg crosses."""
        ...

    @property
    def offing(self) -> Offing:
        """How far from land ships stay."""
        ...

    @property
    def traffic(self) -> ShipTraffic | None:
        """How often other ships are met."""
        ...

    @property
    def offing_arrays(self) -> OffingArrays:
        """The offing as arrays."""
        ...

    @property
    def arrays(self) -> CoastArrays:
        """Land, closed zones, area and offing as arrays."""
        ...


def chart_canal_of_legs(
    chart: ChartParts, lat1: ArrayLike, lon1: ArrayLike, lat2: ArrayLike, lon2: ArrayLike
) -> NDArray[np.int64]:
    """Return the canal that each leg passes from one end to the other.

    The ends of the leg lie within 2 m of those of the canal, in either direction.

    Parameters
    ----------
    lat1, lon1 : array_like
        Starts of legs [deg].
    lat2, lon2 : array_like
        Ends of legs [deg]; all four are broadcast together.

    Returns
    -------
    int64 array
        Index in `canals`, or -1; the broadcast shape.
    """
    return canal_data.canal_index_of_legs(chart.canals, lat1, lon1, lat2, lon2)


def chart_is_navigable(chart: ChartParts, lat: ArrayLike, lon: ArrayLike) -> NDArray[np.bool_]:
    """Return where positions are water in the area, in no no-go zone, as far off land as needed.

    Parameters
    ----------
    lat, lon : array_like
        Positions [deg]; broadcast together.

    Returns
    -------
    bool array
        False also for positions that are not numbers.
    """
    return np.asarray(point_status(chart.arrays, lat, lon) == OK)


def chart_leg_status(
    chart: ChartParts, lat1: ArrayLike, lon1: ArrayLike, lat2: ArrayLike, lon2: ArrayLike
) -> NDArray[np.int8]:
    """Return the status of each geodesic leg.

    A leg that touches an outline is blocked, unless it runs from one end of a canal to the
    other (`canal_of_legs`).

    Parameters
    ----------
    lat1, lon1 : array_like
        Starts of legs [deg].
    lat2, lon2 : array_like
        Ends of legs [deg]; all four are broadcast together.

    Returns
    -------
    int8 array
        Codes of `thalweg.kernels.codes` in the broadcast shape: OK, LAND, NO_GO (a
        no-go zone, or the leg leaves the chart's area), OFFING (nearer to land than
        the offing) or NO_DATA (a position that is not a number).
    """
    status = leg_status(chart.arrays, lat1, lon1, lat2, lon2)
    near_land = (status == LAND) | (status == OFFING)
    if chart.canals and near_land.any():
        ends = np.broadcast_arrays(lat1, lon1, lat2, lon2)
        status[near_land] = np.where(
            chart_canal_of_legs(chart, *(np.asarray(x)[near_land] for x in ends)) >= 0,
            OK,
            status[near_land],
        )
    return status


def chart_legs_blocked(
    chart: ChartParts, lat1: ArrayLike, lon1: ArrayLike, lat2: ArrayLike, lon2: ArrayLike
) -> NDArray[np.bool_]:
    """Return which geodesic legs may not be sailed (see `leg_status`).

    Parameters
    ----------
    lat1, lon1 : array_like
        Starts of legs [deg].
    lat2, lon2 : array_like
        Ends of legs [deg]; all four are broadcast together.

    Returns
    -------
    bool array
        In the broadcast shape.
    """
    return np.asarray(chart_leg_status(chart, lat1, lon1, lat2, lon2) != OK)


def chart_crosses_no_go_zone(
    chart: ChartParts, lat1: ArrayLike, lon1: ArrayLike, lat2: ArrayLike, lon2: ArrayLike
) -> NDArray[np.bool_]:
    """Return which geodesic legs touch a no-go zone, whatever land is there.

    Parameters
    ----------
    lat1, lon1 : array_like
        Starts of legs [deg].
    lat2, lon2 : array_like
        Ends of legs [deg]; all four are broadcast together.

    Returns
    -------
    bool array
        In the broadcast shape.
    """
    zones = CoastArrays(empty_index(), chart.zones.index, WORLD.array())
    return np.asarray(leg_status(zones, lat1, lon1, lat2, lon2) != OK)


def chart_is_joined_to_sea(chart: ChartParts, lat: float, lon: float) -> bool:
    """Return whether water at a position leads to the open sea.

    Charts without approaches (of the user's own) are not tested: any water counts.

    Parameters
    ----------
    lat, lon : float
        Position on water [deg].

    Returns
    -------
    bool
        False for enclosed water.
    """
    if chart.approaches is None or chart.coastline.shore_distance(lat, lon) >= _OPEN_SEA:
        return True
    return is_joined_to_sea(
        float(lat),
        float(lon),
        is_navigable=partial(chart_is_navigable, chart),
        legs_blocked=partial(chart_legs_blocked, chart),
        shore_distance=chart.coastline.shore_distance,
    )


def chart_sea_room(chart: ChartParts, lat: ArrayLike, lon: ArrayLike, *, cap: float) -> FloatArray:
    """Return by how much positions are farther from land than is required.

    Without an offing this is the distance to land (`Coastline.shore_distance`).

    Parameters
    ----------
    lat, lon : array_like
        Positions [deg]; broadcast together.
    cap : float
        Greatest value returned [m].

    Returns
    -------
    ndarray
        [m], not below 0.
    """
    if chart.offing.distance <= 0.0:
        return chart.coastline.shore_distance(lat, lon, cap=cap)
    y, x = np.broadcast_arrays(*(np.atleast_1d(np.asarray(v, float)) for v in (lat, lon)))
    return sea_room(chart.coastline, chart.offing_arrays, y, x, cap)


def chart_may_wait(chart: ChartParts, lat: ArrayLike, lon: ArrayLike) -> NDArray[np.bool_]:
    """Return at which positions a ship may wait (see `Zones.may_wait`).

    Parameters
    ----------
    lat, lon : array_like
        Positions [deg]; broadcast together.

    Returns
    -------
    bool array
        In the broadcast shape.
    """
    return chart.zones.may_wait(lat, lon)


def chart_nearest_navigable(
    chart: ChartParts, lat: float, lon: float, *, largest: float = 50_000.0
) -> tuple[float, float, float] | None:
    """Return the nearest water that is joined to the open sea.

    Parameters
    ----------
    lat, lon : float
        Position [deg].
    largest : float
        Greatest distance [m].

    Returns
    -------
    (lat, lon, distance) : tuple of float or None
        Position [deg] and distance [m]; None if there is no such water within
        ``largest``.
    """
    return nearest_navigable(
        float(lat),
        float(lon),
        largest=float(largest),
        is_navigable=partial(chart_is_navigable, chart),
        legs_blocked=partial(chart_legs_blocked, chart),
        accepts=partial(chart_is_joined_to_sea, chart),
    )


def chart_fingerprint(chart: ChartParts) -> str:
    """Return a short digest of everything on the chart.

    Returns
    -------
    str
        16 hexadecimal digits.
    """
    digest = _coastline_digest(chart.coastline).copy()
    digest.update(chart.area.array().tobytes())
    layers = (layer.fingerprint() for layer in chart.depths.layers)
    off_land = [f"closed {passage.name}" for passage in chart.closed_passages]
    if chart.offing.distance > 0.0:
        off_land += [repr(chart.offing), *(passage.name for passage in chart.passages)]
    if chart.traffic is not None:
        off_land.append(f"traffic {chart.traffic.fingerprint()}")
    for text in (*chart.zones.texts(), *layers, *map(repr, chart.canals), *off_land):
        digest.update(text.encode())
    return digest.hexdigest()[:16]


@lru_cache(maxsize=2)
def _coastline_digest(coastline: Coastline) -> hashlib._Hash:
    digest = hashlib.sha256(coastline.name.encode())
    for array in coastline.index[1:]:
        digest.update(np.ascontiguousarray(array).reshape(-1).view(np.uint8).data)
    return digest
