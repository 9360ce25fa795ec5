"""Land, enclosed water, zones, control areas and storm tracks on a map."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from thalweg.chart.zones.traffic_schemes import TRAFFIC_SCHEMES
from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.geodesy import Position, wrap_longitude
from thalweg.core.units import DAY
from thalweg.planning.plots.map_extent import MapExtent
from thalweg.planning.plots.map_labels import LabelPlacer, marked_times, time_label
from thalweg.sea.models.cyclone_layer import StormLayer

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.planning.plan_data import PlotContext
    from thalweg.sea.models.cyclone_track import BestTrack

_LAND, _SHORE, _STORM = "#e2d6b5", "#6f6650", "#4a148c"
_NO_GO, _PENALTY, _CONTROL, _LANE = "#c62828", "#ef6c00", "#00796b", "#ad1457"
_SHOAL, _SHOAL_EDGE, _SHOAL_LABEL = "#9cc3d5", "#5f93ab", "shoal water kept off"
_NOT_SEARCHED, _NOT_SEARCHED_LABEL = "#8f8468", "water not searched"
_LEAST_CELLS, _OPENING = 4, 0.15  # of enclosed water; part of its outline that may be open
_ARROWS = 15.0  # height of maps [deg] from which on arrows of lanes would cover them
_LINE_POINTS = 300  # on a line as long as the map is wide, to see which part of it shows
_DOTS = 4_000.0  # details of land smaller than the width of the map over this are not drawn
_NEAR = 2.5  # spacings of the network within which water counts as searched


def draw_land(axes: Any, chart: Chart, box: MapExtent) -> None:
    """Draw the land of a chart, without what is too small to be seen on the map."""
    import shapely
    from matplotlib.collections import PathCollection

    detail = (box.east - box.west) / _DOTS
    land: Any = chart.coastline.polygons(box.south, box.north, box.west, box.east)
    shapes = np.array(land, dtype=object)
    west, south, east, north = shapely.bounds(shapes).reshape(-1, 4).T
    is_seen = np.maximum(east - west, box_stretch(box) * (north - south)) >= detail
    drawn = shapely.simplify(shapes[is_seen], detail / box_stretch(box))
    outlines = [_outline(polygon) for polygon in drawn]
    axes.add_collection(
        PathCollection(outlines, fc=_LAND, ec=_SHORE, lw=0.5, zorder=3), autolim=False
    )


def draw_enclosed_water(
    axes: Any, context: PlotContext, box: MapExtent, on_water: np.ndarray, grid: tuple[Any, Any]
) -> np.ndarray:
    """Hatch water inside the map that the search did not reach, such as lakes behind dams.

    Parameters
    ----------
    on_water : Where there is water, (rows, columns).
    grid : Latitudes and longitudes of the raster [deg], (ndarray, ndarray).

    Returns
    -------
    bool array (rows, columns) : Where it was hatched.
    """
    from scipy.ndimage import label
    from scipy.spatial import cKDTree

    lat, lon = grid
    reached = np.isfinite(context.arrival)
    places = np.column_stack([context.lat, box.unwrapped(context.lon) / box_stretch(box)])[reached]
    none = np.zeros(lat.shape, bool)
    if len(places) < 10:
        return none
    tree = cKDTree(places)
    sample = places[:: max(1, len(places) // 500)]
    spacing = float(np.median(tree.query(sample, k=2)[0][:, 1]))
    away, _ = tree.query(np.column_stack([lat.ravel(), lon.ravel() / box_stretch(box)]))
    lonely = on_water & (away.reshape(lat.shape) > _NEAR * spacing)
    enclosed = none.copy()
    pieces, count = label(lonely, np.ones((3, 3), int))
    for number in range(1, count + 1):
        piece = pieces == number
        if not (piece[[0, -1]].any() or piece[:, [0, -1]].any()):
            enclosed |= piece if _is_enclosed(piece, on_water) else False
    if enclosed.any():
        drawn = axes.contourf(
            lon, lat, enclosed.astype(float), levels=[0.5, 1.5], colors=[_LAND], hatches=["////"],
            zorder=2,
        )  # fmt: skip
        drawn.set(edgecolor=_NOT_SEARCHED, linewidth=0.0)  # the colour of the hatching
        style = {"fc": _LAND, "ec": _NOT_SEARCHED, "hatch": "////", "lw": 0.5}
        axes.fill([], [], label=_NOT_SEARCHED_LABEL, **style)  # for the legend
    return np.asarray(enclosed)


def _is_enclosed(piece: np.ndarray, on_water: np.ndarray) -> bool:
    """Return whether a piece of water has land around it, up to a narrow opening."""
    from scipy.ndimage import binary_dilation

    around = binary_dilation(piece, np.ones((3, 3), bool)) & ~piece
    return int(piece.sum()) >= _LEAST_CELLS and float(on_water[around].mean()) <= _OPENING


def box_stretch(box: MapExtent) -> float:
    """Return degrees of longitude that are as long as one of latitude, in the middle of a map."""
    return 1.0 / max(0.05, float(np.cos(np.radians(0.5 * (box.south + box.north)))))


def draw_zones(axes: Any, chart: Chart, box: MapExtent) -> list[tuple[str, float, float]]:
    """Draw the areas of a chart; return the labels of control areas with their positions."""
    for shapes, colour, hatch in (
        (chart.zones.no_go, _NO_GO, "xxx"),
        ([shape for shape, _ in chart.zones.penalty], _PENALTY, "..."),
        ([shape for shape, _ in chart.zones.price], _CONTROL, ""),
    ):
        for shape in shapes:
            for turn in (-360.0, 0.0, 360.0):
                style = {"fc": "none", "ec": colour, "hatch": hatch, "lw": 0.9, "zorder": 4}
                axes.add_patch(_patch(shape, turn, **style))
    _draw_closed_shoals(axes, chart, box)
    _draw_lanes(axes, chart, box)
    return _draw_control_areas(axes, chart, box)


def _draw_closed_shoals(axes: Any, chart: Chart, box: MapExtent) -> None:
    """Draw the shoal water that the plan kept off, by depth layer and named areas."""
    import shapely
    from matplotlib.collections import PathCollection

    closed = chart.zones.closed_shoals
    if closed is None:
        return
    tree, outlines = shapely.STRtree(closed.shapes), []
    for turn in (-360.0, 0.0, 360.0):
        sides = box.west - turn, box.south, box.east - turn, box.north
        near = tree.geometries[tree.query(shapely.box(*sides))]
        pieces = shapely.get_parts(shapely.clip_by_rect(shapely.union_all(near), *sides))
        outlines += [_outline(one, turn) for one in pieces if one.geom_type == "Polygon"]
    if outlines:
        style: dict[str, Any] = {
            "fc": _SHOAL,
            "ec": _SHOAL_EDGE,
            "alpha": 0.45,
            "lw": 0.6,
            "zorder": 1.5,
        }
        axes.add_collection(PathCollection(outlines, **style), autolim=False)
        axes.fill([], [], label=_SHOAL_LABEL, **style)  # for the legend


def _draw_lanes(axes: Any, chart: Chart, box: MapExtent) -> None:
    """Draw separation zones with arrows along their lanes, and the outlines of a user's lanes."""
    names = {lane.name.partition(",")[0] for lane in chart.zones.lanes}
    schemes = [scheme for scheme in TRAFFIC_SCHEMES if scheme.name in names]
    known = {scheme.name for scheme in schemes}
    own = [lane for lane in chart.zones.lanes if lane.name.partition(",")[0] not in known]
    for turn in (-360.0, 0.0, 360.0):
        for scheme in schemes:
            band = _patch(scheme.separation, turn, fc=_LANE, ec="none", alpha=0.35, zorder=2.6)
            axes.add_patch(band)
            arrows = scheme.arrows if box.north - box.south < _ARROWS else ()
            for start, end in arrows:
                _draw_arrow(axes, start, end, turn)
        for lane in own:
            for part in getattr(lane.shape, "geoms", [lane.shape]):
                style = {"fc": "none", "ec": _LANE, "ls": (0, (4, 3)), "lw": 0.7, "zorder": 2.6}
                axes.add_patch(_patch(part, turn, **style))
            centre, course = lane.shape.centroid, np.radians(lane.direction)
            half = 0.2 * float(np.sqrt(lane.shape.area))
            north, east = half * np.cos(course), half * np.sin(course)
            east /= max(0.05, float(np.cos(np.radians(centre.y))))
            start, end = (centre.y - north, centre.x - east), (centre.y + north, centre.x + east)
            _draw_arrow(axes, start, end, turn)


def _draw_arrow(axes: Any, start: Position, end: Position, turn: float) -> None:
    """Draw an arrow between two positions (lat, lon) on the map."""
    arrow = axes.annotate(
        "", (end[1] + turn, end[0]), (start[1] + turn, start[0]), annotation_clip=False, zorder=2.7,
        arrowprops={"arrowstyle": "->", "color": _LANE, "lw": 0.7, "shrinkA": 2, "shrinkB": 2},
    )  # fmt: skip
    arrow.arrow_patch.set_clip_path(axes.patch)
    arrow.set_in_layout(False)


def _draw_control_areas(axes: Any, chart: Chart, box: MapExtent) -> list[tuple[str, float, float]]:
    """Draw the emission control areas that count; return their labels with positions."""
    labels = []
    areas = chart.control_areas or chart.zones
    for area in areas.eca:
        for first, last in zip(area.rings.start[:-1], area.rings.start[1:]):
            lat, lon = area.rings.lat[first:last], area.rings.lon[first:last]
            for turn in (-360.0, 0.0, 360.0):
                if not (
                    lon.max() + turn > box.west
                    and lon.min() + turn < box.east
                    and lat.max() > box.south
                    and lat.min() < box.north
                ):
                    continue
                axes.plot(lon + turn, lat, color=_CONTROL, lw=0.9, ls=(0, (6, 3)), zorder=2.5)
                place = _visible_place(chart, box, lat, lon + turn)
                if place is not None:
                    labels.append((f"ECA {_plain(area.name)}", *place))
    return list({name: (name, x, y) for name, x, y in labels}.values())


def _visible_place(
    chart: Chart, box: MapExtent, lat: np.ndarray, lon: np.ndarray
) -> tuple[float, float] | None:
    """Return the middle (lon, lat) of the part of a line that a map shows; None without one."""
    detail = max(box.east - box.west, box.north - box.south) / _LINE_POINTS
    steps = np.ceil(np.maximum(np.abs(np.diff(lat)), np.abs(np.diff(lon))) / detail)
    number = cumulative_sums(np.maximum(steps, 1.0))
    close = np.arange(number[-1] + 1.0)
    y, x = np.interp(close, number, lat), np.interp(close, number, lon)
    inside = (x > box.west) & (x < box.east) & (y > box.south) & (y < box.north)
    y, x = y[inside], x[inside]
    # land is drawn over the line
    seen = np.flatnonzero(np.asarray(chart.is_navigable(y, wrap_longitude(x)), bool))
    if not seen.size:
        return None
    middle = seen[seen.size // 2]
    return float(x[middle]), float(y[middle])


def storm_track(context: PlotContext) -> BestTrack | None:
    """Return the track of the modelled storm of a sea; None if there is none."""
    tracks = [layer.track for layer in context.sea.layers if isinstance(layer, StormLayer)]
    return tracks[0] if tracks else None


def draw_storm(
    axes: Any, track: BestTrack, box: MapExtent, start: float, end: float
) -> list[tuple[str, float, float]]:
    """Draw the track of a storm during a voyage; return labels of its days with positions."""
    first, last = max(start, float(track.time[0])), min(end, float(track.time[-1]))
    if last <= first:
        return []
    lat, lon = track.position(np.linspace(first, last, 200))
    axes.plot(
        box.line(lon), lat, color=_STORM, lw=1.3, ls=(0, (2, 1.5)), zorder=6,
        label=f"track of {track.name}",
    )  # fmt: skip
    times, _ = marked_times(first, last, 7)
    lat, lon = track.position(times)
    x = box.unwrapped(lon)
    axes.plot(x, lat, "v", color=_STORM, ms=4, zorder=6)
    step = DAY if len(times) < 2 else float(times[1] - times[0])
    labels = [(time_label(float(t), step), float(a), float(b)) for t, a, b in zip(times, x, lat)]
    return [
        item for item in labels
        if box.west < item[1] < box.east and box.south < item[2] < box.north
    ]  # fmt: skip


def place_labels(placer: LabelPlacer, labels: list[tuple[str, float, float]]) -> None:
    """Place small labels, as far as there is room."""
    for text, lon, lat in labels:
        placer.place(text, lon, lat, fontsize=6.5, color=_CONTROL if "ECA" in text else _STORM)


def _patch(polygon: Any, turn: float = 0.0, **style: Any) -> Any:
    from matplotlib.patches import PathPatch

    return PathPatch(_outline(polygon, turn), **style)


def _outline(polygon: Any, turn: float = 0.0) -> Any:
    """Return a polygon as a path of matplotlib, shifted by ``turn`` [deg] of longitude."""
    from matplotlib.path import Path as Outline

    rings = [np.asarray(ring.coords) for ring in (polygon.exterior, *polygon.interiors)]
    shifted = [np.column_stack([ring[:, 0] + turn, ring[:, 1]]) for ring in rings]
    return Outline.make_compound_path(*(Outline(ring, closed=True) for ring in shifted))


def _plain(name: str) -> str:
    return name.replace("-", " ").title().replace("Us ", "US ")
