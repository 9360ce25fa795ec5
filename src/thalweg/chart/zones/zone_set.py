"""Zones: where a ship may not sail, where a mile counts more, where fuel has another price.

A GeoJSON feature has the properties ``kind`` ("no-go", "penalty", "price" or "eca") and, for
penalty and price, ``factor``. Where zones of one kind overlap, the largest factor counts. An "eca"
zone without a factor is an emission control area: the ship file states what fuel costs there;
with one it is a price zone. A "no-go" zone may have ``keep_clear_nm``, the distance by which routes
keep clear of it. A "lane" has a ``direction_deg`` (`thalweg.chart.zones.traffic_lanes`).
Where there are "anchorage" zones a ship may wait in these only, and never in "no-waiting" zones.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.chart import geojson_polygons
from thalweg.chart.anchorages import waiting_allowed
from thalweg.chart.coast.coast_cache import load_or_build
from thalweg.chart.coast.coast_index_builder import build_index, empty_index
from thalweg.chart.depth.closed_shoals import ClosedShoals, closed_water_index
from thalweg.chart.depth.shoals import Shoals
from thalweg.chart.zones.emission_control_areas import EcaZone
from thalweg.chart.zones.leg_fractions import (
    CROSSING_TOLERANCE,
    fractions_inside,
    outlines_only,
    points_inside,
    straight_pieces,
)
from thalweg.chart.zones.traffic_lanes import LaneGroup, TrafficLane
from thalweg.chart.zones.zone_properties import (
    with_margin,
    zone_factor,
    zone_kind,
    zone_margin,
)
from thalweg.core.cache_folder import cache_folder
from thalweg.core.types import FloatArray
from thalweg.kernels.geometry.coast_index import outlines_touched
from thalweg.kernels.geometry.cube_sphere import IndexArrays

ZONE_INDEX_CELLS: Final = 128  # cells along a face of the index of no-go zones
KINDS_WITHOUT_FACTOR: Final = ("no-go", "anchorage", "no-waiting")  # kinds without a factor


@dataclass(frozen=True, eq=False)
class ZoneGroup:
    """Zones of one kind, each on three turns of longitude, their factors and their outlines."""

    tree: Any
    factors: FloatArray
    outlines: IndexArrays

    @classmethod
    def of(cls, zones: tuple[tuple[Any, float], ...]) -> ZoneGroup:
        """Prepare (polygon, factor) pairs."""
        import shapely.affinity

        shapes = [
            shapely.affinity.translate(shape, turn)
            for shape, _ in zones
            for turn in (-360.0, 0.0, 360.0)
        ]
        shapely.prepare(shapes)
        parts = [part for shape, _ in zones for part in shapely.get_parts(shape)]
        areas = [part for part in parts if part.geom_type == "Polygon"]
        outlines = build_index(geojson_polygons.rings_from_polygons(areas), ZONE_INDEX_CELLS)
        factors = np.repeat([factor for _, factor in zones], 3)
        return cls(shapely.STRtree(shapes), factors, outlines)

    def at(self, lat: FloatArray, lon: FloatArray) -> FloatArray:
        """Return the excess (factor - 1) at positions [deg]."""
        import shapely

        which, zone = self.tree.query(shapely.points(lon, lat), predicate="intersects")
        excess = np.zeros(len(lat))
        excess[which] = self.factors[zone] - 1.0
        return excess

    def along(self, lines: Any) -> FloatArray:
        """Return for each line the sum of (factor - 1) times the share of it inside."""
        import shapely

        which, zone = self.tree.query(lines, predicate="intersects")
        if not len(which):
            return np.zeros(len(lines))
        whole = shapely.length(lines[which])
        part = shapely.length(shapely.intersection(lines[which], self.tree.geometries[zone]))
        share = np.where(whole > 0.0, part / np.where(whole > 0.0, whole, 1.0), 1.0)
        excess = np.bincount(which, share * (self.factors[zone] - 1.0), minlength=len(lines))
        return excess.astype(np.float64)


@dataclass(frozen=True)
class Zones:
    """Zones of a chart.

    Attributes
    ----------
    penalty, price : tuple of (shapely polygon, factor)
        They do not overlap.
    eca : Emission control areas; they may overlap.
    anchorages, no_waiting : tuple of shapely polygons
        Where alone a ship may wait (anywhere if there are none), and where it may not.
    lanes : Where ships sail in one direction only.
    shoals : Shoal water, in which a mile counts more besides the penalty zones.
    closed_shoals : Shoal water that no leg may cross.
    margins : By how much no-go zones were widened [m], one for each feature that asks for it.
    """

    no_go: tuple[Any, ...] = ()
    penalty: tuple[tuple[Any, float], ...] = ()
    price: tuple[tuple[Any, float], ...] = ()
    eca: tuple[EcaZone, ...] = ()
    anchorages: tuple[Any, ...] = ()
    no_waiting: tuple[Any, ...] = ()
    lanes: tuple[TrafficLane, ...] = ()
    shoals: Shoals | None = None
    closed_shoals: ClosedShoals | None = None
    margins: tuple[float, ...] = ()

    @classmethod
    def read(cls, source: geojson_polygons.GeoJsonSource) -> Zones:
        """Read zones from a GeoJSON file or plain data.

        Raises
        ------
        InputError : If it is not GeoJSON of areas, an outline crosses itself, or a kind or factor
            is missing or not possible.
        """
        found: dict[str, list[tuple[Any, float]]] = {
            kind: [] for kind in (*KINDS_WITHOUT_FACTOR, "penalty", "price")
        }
        eca: list[EcaZone] = []
        lanes: list[TrafficLane] = []
        margins: list[float] = []
        for geometry, properties in geojson_polygons.read_features(source, "zones"):
            kind = zone_kind(properties)
            margin = zone_margin(kind, properties)
            shapes = geojson_polygons.parse_polygons(geometry, "zones", repair=False)
            if kind == "eca":
                eca.append(
                    EcaZone(
                        str(properties.get("name") or "eca"),
                        geojson_polygons.rings_from_polygons(shapes),
                    )
                )
                continue
            if kind == "lane":
                lanes += [TrafficLane.of_feature(shape, properties) for shape in shapes]
                continue
            factor = 1.0 if kind in KINDS_WITHOUT_FACTOR else zone_factor(kind, properties)
            found[kind] += [(shape, factor) for shape in with_margin(shapes, margin)]
            margins += [margin] if margin else []
        no_go, anchorages, barred = (
            tuple(shape for shape, _ in found[kind]) for kind in KINDS_WITHOUT_FACTOR
        )
        factors = _without_overlaps(found["penalty"]), _without_overlaps(found["price"])
        rest = anchorages, barred, tuple(lanes)
        return cls(no_go, *factors, tuple(eca), *rest, margins=tuple(margins))

    def joined(self, other: Zones) -> Zones:
        """Return these zones and another chart's."""
        return Zones(
            self.no_go + other.no_go,
            _without_overlaps([*self.penalty, *other.penalty]),
            _without_overlaps([*self.price, *other.price]),
            self.eca + tuple(zone for zone in other.eca if zone not in self.eca),
            self.anchorages + other.anchorages,
            self.no_waiting + other.no_waiting,
            self.lanes + other.lanes,
            self.shoals or other.shoals,
            self.closed_shoals or other.closed_shoals,
            self.margins + other.margins,
        )

    @property
    def has_penalty(self) -> bool:
        """Whether a mile counts more somewhere: in penalty zones, shoals or against lanes."""
        return bool(self.penalty or self.lanes) or self.shoals is not None

    @cached_property
    def lane_group(self) -> LaneGroup:
        """The traffic lanes ready for legs."""
        return LaneGroup.of(self.lanes)

    @cached_property
    def index(self) -> IndexArrays:
        """The grid of the edges of the no-go zones."""
        if not self.no_go:
            return empty_index()
        return build_index(geojson_polygons.rings_from_polygons(list(self.no_go)), ZONE_INDEX_CELLS)

    @cached_property
    def closed_shapes(self) -> tuple[Any, ...]:
        """The no-go zones and the closed shoals as shapely polygons; they may overlap."""
        return self.no_go + (self.closed_shoals.shapes if self.closed_shoals else ())

    @cached_property
    def closed_index(self) -> IndexArrays:
        """The grid of the edges of the no-go zones and the closed shoals."""
        if self.closed_shoals is None:
            return self.index
        return closed_water_index(self.closed_shoals, self.no_go, ZONE_INDEX_CELLS)

    @cached_property
    def eca_index(self) -> IndexArrays:
        """The emission control areas for kernels: ``cube.inside(index, *unit_vector(lat, lon))``.

        Cached on disk.
        """
        if not self.eca:
            return empty_index()
        rings = self.eca[0].rings
        for zone in self.eca[1:]:
            rings = rings.joined(zone.rings)
        path = cache_folder("coast") / f"eca-{rings.fingerprint()}-{ZONE_INDEX_CELLS}-v1.npz"
        return load_or_build(path, lambda: build_index(rings, ZONE_INDEX_CELLS))

    @cached_property
    def _eca_outlines(self) -> IndexArrays:
        return outlines_only(self.eca_index)

    def eca_fraction(
        self,
        lat1: ArrayLike,
        lon1: ArrayLike,
        lat2: ArrayLike,
        lon2: ArrayLike,
        *,
        finest: float = CROSSING_TOLERANCE,
    ) -> FloatArray:
        """Return the share of the length of legs [deg] inside any emission control area.

        Crossings of outlines are found to ``finest`` [m].
        """
        ends = np.broadcast_arrays(*(np.asarray(x, float) for x in (lat1, lon1, lat2, lon2)))
        if not self.eca:
            return np.where(np.isfinite(sum(ends)), 0.0, np.nan)
        legs = [x.flatten() for x in ends]
        lat1, lon1, lat2, lon2 = legs
        found = fractions_inside(
            self.eca_index, self._eca_outlines, lat1, lon1, lat2, lon2, finest=finest
        )
        return found.reshape(ends[0].shape)

    def in_eca(self, lat: ArrayLike, lon: ArrayLike) -> NDArray[np.bool_]:
        """Return which positions [deg] lie inside any emission control area."""
        a, b = np.broadcast_arrays(np.asarray(lat, float), np.asarray(lon, float))
        if not self.eca:
            return np.zeros(a.shape, np.bool_)
        return points_inside(self.eca_index, a.flatten(), b.flatten()).reshape(a.shape)

    def may_wait(self, lat: ArrayLike, lon: ArrayLike) -> NDArray[np.bool_]:
        """Return at which positions [deg] a ship may wait.

        In zones of the kind "anchorage" where there are any, else at any place; never in zones of
        the kind "no-waiting".
        """
        y, x = np.broadcast_arrays(np.asarray(lat, float), np.asarray(lon, float))
        return waiting_allowed(self.anchorages, self.no_waiting, y, x)

    @cached_property
    def _groups(self) -> tuple[ZoneGroup, ZoneGroup]:
        """Penalty and price zones ready for legs."""
        return ZoneGroup.of(self.penalty), ZoneGroup.of(self.price)

    def factors(
        self, lat1: ArrayLike, lon1: ArrayLike, lat2: ArrayLike, lon2: ArrayLike
    ) -> tuple[FloatArray, FloatArray]:
        """Return the penalty and the price factor of legs [deg], weighted by length.

        Sailing against traffic lanes counts as a penalty. NaN where a position is not a number.
        """
        ends = np.broadcast_arrays(*(np.asarray(x, float) for x in (lat1, lon1, lat2, lon2)))
        penalty, price, legs, known = self._undirected_factors(ends)
        if self.lanes:
            penalty.reshape(-1)[known] += self.lane_group.excess(*legs)
        return penalty, price

    def factors_both_ways(
        self, lat1: ArrayLike, lon1: ArrayLike, lat2: ArrayLike, lon2: ArrayLike
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the penalty factor of legs [deg], that of the legs back, and the price factor."""
        ends = np.broadcast_arrays(*(np.asarray(x, float) for x in (lat1, lon1, lat2, lon2)))
        penalty, price, legs, known = self._undirected_factors(ends)
        back = penalty.copy()
        if self.lanes:
            for factor, more in zip((penalty, back), self.lane_group.excess_both_ways(*legs)):
                factor.reshape(-1)[known] += more
        return penalty, back, price

    def _undirected_factors(
        self, ends: Sequence[FloatArray]
    ) -> tuple[FloatArray, FloatArray, list[FloatArray], NDArray[np.bool_]]:
        """Return the factors of legs without lanes; the legs whose ends are known, and which."""
        shape = ends[0].shape
        legs = np.stack([x.ravel() for x in ends])
        known = np.asarray(np.isfinite(legs).all(axis=0))
        whole = list(np.ascontiguousarray(legs[:, known]))
        penalty: FloatArray = np.full(known.size, np.nan)
        price: FloatArray = np.full(known.size, np.nan)
        if self.penalty or self.price:
            penalty[known], price[known] = (self._weighted(whole, group) for group in self._groups)
        else:
            penalty[known] = price[known] = 1.0
        if self.shoals is not None:
            penalty += self.shoals.excess(*legs)
        return penalty.reshape(shape), price.reshape(shape), whole, known

    def _weighted(self, legs: list[FloatArray], group: ZoneGroup) -> FloatArray:
        """Return the factors of legs of one group: at once where no outline is touched."""
        excess = np.zeros(len(legs[0]))
        if not len(group.factors):
            return 1.0 + excess
        touched = np.empty(len(excess), np.bool_)
        outlines_touched(group.outlines, *legs, touched)
        whole = np.flatnonzero(~touched)
        excess[whole] = group.at(legs[0][whole], legs[1][whole])
        cut = np.flatnonzero(touched)
        if len(cut):
            lines, leg, pieces = straight_pieces(*(x[cut] for x in legs))
            shares = np.bincount(leg, group.along(lines), minlength=len(cut))
            excess[cut] = shares / pieces
        return 1.0 + excess

    def texts(self) -> list[str]:
        """Return everything as text, for a fingerprint."""
        pairs = [*self.penalty, ("price", 0.0), *self.price]
        return (
            [shape.wkb_hex for shape in self.no_go]
            + [f"{getattr(shape, 'wkb_hex', shape)}*{factor}" for shape, factor in pairs]
            + [f"eca {zone.name} {zone.rings.fingerprint()}" for zone in self.eca]
            + [f"anchorage {shape.wkb_hex}" for shape in self.anchorages]
            + [f"no waiting {shape.wkb_hex}" for shape in self.no_waiting]
            + [
                f"lane {lane.shape.wkb_hex} {lane.direction} {lane.tolerance} {lane.factor}"
                f"{lane.crossing or ''}"
                for lane in self.lanes
            ]
            + [one.text() for one in (self.shoals, self.closed_shoals) if one is not None]
        )


def _without_overlaps(zones: list[tuple[Any, float]]) -> tuple[tuple[Any, float], ...]:
    """Return zones clipped so that none overlap; the common part gets the largest factor."""
    import shapely

    disjoint: list[tuple[Any, float]] = []
    for shape, factor in sorted(zones, key=lambda zone: -zone[1]):
        remainder = shape
        for other, _ in disjoint:
            if shapely.intersects(remainder, other):
                remainder = shapely.difference(remainder, other)
        if not shapely.is_empty(remainder):
            disjoint.append((remainder, factor))
    return tuple(disjoint)
