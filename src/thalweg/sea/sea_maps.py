"""Maps of the fields of a sea, one panel for each main quantity."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from thalweg.core.arrays.shown_arrows import shown_arrows
from thalweg.core.bounding_box import BoundingBox
from thalweg.core.errors import InputError
from thalweg.core.file_writing import new_figure, save_figure
from thalweg.core.geodesy import longitude_difference
from thalweg.core.time import TimeLike, format_time, parse_time
from thalweg.core.types import FloatArray
from thalweg.sea import standard_names as nm
from thalweg.sea.argument_checks import parse_area
from thalweg.sea.ensemble_layer import check_not_ensemble
from thalweg.sea.grids.gridded_layer import GridLayer
from thalweg.sea.layer import Layer
from thalweg.sea.layer_stack import (
    sample_stack,
    series_of_stack,
    stack_period,
    stack_provides,
    stack_times,
    stack_variables,
)

RASTER_POINTS: Final = 320  #: raster points along the longer side of a panel
ARROWS_ALONG_SIDE: Final = 20  #: arrows along the longer side
TRIAL_TIMES: Final = 25  #: times compared to find the largest values
SMALLEST_LINE: Final = 500  #: lines smaller than this part of the longer side are not drawn
TEXT_COLOUR, BACKGROUND_COLOUR, UNKNOWN_COLOUR = "#1f2a37", "#ffffff", "#e3e6ea"
_UNIFORM = 1e-3  # share by which values differ that count as one
_AROUND_UNIFORM = 0.1  # of one value everywhere, so that the scale round it can be read

CoastlinePart = tuple[FloatArray, FloatArray]


@dataclass(frozen=True)
class MapPanel:
    """How one quantity is drawn.

    Attributes
    ----------
    title, unit : Title of the panel and unit of the colour bar.
    values : Canonical name of the quantity that is coloured.
    arrows : Names of the components drawn as arrows; empty for none.
    colours : Matplotlib colour map.
    around_zero : Whether colours are centred on zero.
    """

    title: str
    unit: str
    values: str
    arrows: tuple[str, ...]
    colours: str
    around_zero: bool = False


MAP_PANELS: Final = (
    MapPanel("Significant wave height", "m", nm.WAVE_HEIGHT, nm.WAVES.pair, "YlGnBu"),
    MapPanel("Wind at 10 m", "m/s", "wind_speed", nm.WIND.pair, "BuPu"),
    MapPanel("Surface current", "m/s", "sea_water_speed", nm.CURRENT.pair, "GnBu"),
    MapPanel("Water level", "m", nm.WATER_LEVEL, (), "RdBu_r", True),
    MapPanel("Peak wave period", "s", nm.WAVE_PERIOD, (), "PuBuGn"),
    MapPanel("Sea ice", "fraction", nm.ICE, (), "Blues_r"),
    MapPanel("Depth below datum", "m", nm.BED_DEPTH, (), "Blues"),
    MapPanel("Air pressure", "hPa", nm.PRESSURE, (), "cividis"),
)


def draw_maps(
    layers: Sequence[Layer],
    path: str | os.PathLike[str],
    *,
    time: TimeLike | None = None,
    area: tuple[float, float, float, float] | BoundingBox | None = None,
    coastline: Sequence[tuple[ArrayLike, ArrayLike]] = (),
) -> None:
    """Draw a map of each main quantity to one PNG file.

    Parameters
    ----------
    path : path-like
        File to write.
    time : time, optional
        By default the time when the waves (otherwise the wind, the current) are largest.
    area : tuple of float or BoundingBox, optional
        (south, north, west, east) [deg]; by default that of the smallest layer of files.
    coastline : sequence of (lat, lon), optional
        Lines [deg] drawn on top.

    Raises
    ------
    InputError
        If the sea is an ensemble, or holds no quantity that can be drawn.
    """
    check_not_ensemble(layers)
    panels = [p for p in MAP_PANELS if stack_provides(layers, p.values)]
    if not panels:
        raise InputError(
            "The sea holds no quantity that can be drawn.",
            f"It holds {', '.join(sorted(stack_variables(layers))) or 'nothing'}.",
            "Open a file with wind, waves, currents, level or depth.",
        )
    box = map_area(layers) if area is None else parse_area(area)
    lat, lon = _raster_axes(box, RASTER_POINTS)
    when = _time_of_largest_values(layers, panels, lat, lon) if time is None else parse_time(time)
    lines = [(np.asarray(a, np.float64), np.asarray(o, np.float64)) for a, o in coastline]
    columns = min(len(panels), 3 if len(panels) > 4 else 2)
    rows = math.ceil(len(panels) / columns)
    shape = _aspect_ratio(box)
    width = 5.2 * columns
    height = (4.2 * shape + 0.75) * rows + 0.45
    figure = new_figure(width, height, facecolor=BACKGROUND_COLOUR)
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    for axis, panel in zip(axes, panels):
        _draw_panel(figure, axis, layers, panel, (when, lat, lon), box)
        _draw_coastline(axis, lines, box)
    for axis in axes[len(panels) :]:
        axis.set_axis_off()
    sources = ", ".join(dict.fromkeys(row.source for layer in layers for row in layer.coverage()))
    title = (
        f"{format_time(when).replace('T', '  ').replace(':00Z', ' UTC')}     {_shortened(sources)}"
    )
    figure.suptitle(title, x=0.012, ha="left", fontsize=10, color=TEXT_COLOUR)
    save_figure(figure, path, format="png")


def _shortened(text: str) -> str:
    return text if len(text) <= 90 else text[:87] + "..."


def map_area(layers: Sequence[Layer]) -> BoundingBox:
    """Return the box of the smallest layer of files; of all layers if there are only formulas."""
    boxes = [layer.area for layer in layers if isinstance(layer, GridLayer)]
    boxes = boxes or [layer.area for layer in layers]
    return min(boxes, key=lambda a: (a.north - a.south) * (a.east - a.west))


def _aspect_ratio(area: BoundingBox) -> float:
    """Return height over width of the map, limited to what fits on a page."""
    width = (area.east - area.west) * math.cos(math.radians(0.5 * (area.south + area.north)))
    return min(2.0, max(0.35, (area.north - area.south) / max(width, 1e-6)))


def _raster_axes(area: BoundingBox, count: int) -> tuple[FloatArray, FloatArray]:
    shape = _aspect_ratio(area)
    ny, nx = (count, int(count / shape)) if shape > 1.0 else (int(count * shape), count)
    return np.linspace(area.south, area.north, max(ny, 8)), np.linspace(
        area.west, area.east, max(nx, 8)
    )


def _time_of_largest_values(
    layers: Sequence[Layer], panels: Sequence[MapPanel], lat: FloatArray, lon: FloatArray
) -> float:
    """Return the time at which the first quantity that varies in time is largest."""
    for panel in panels:
        start, end = stack_period(layers, [panel.values])
        if not (np.isfinite(start) and np.isfinite(end)):
            continue
        native = stack_times(layers, start, end, names=[panel.values])
        native = native[(native >= start) & (native <= end)]
        trials = native[np.unique(np.linspace(0, native.size - 1, TRIAL_TIMES).round().astype(int))]
        grid = np.meshgrid(lat[::8], lon[::8], indexing="ij")
        values = series_of_stack(layers, [panel.values], trials, grid[0].ravel(), grid[1].ravel())[
            panel.values
        ]
        if np.isfinite(values).any():
            return float(trials[np.argmax(np.fmax.reduce(values, axis=0))])
    return 0.0


def _draw_panel(
    figure: Any,
    axis: Any,
    layers: Sequence[Layer],
    panel: MapPanel,
    points: tuple[float, FloatArray, FloatArray],
    area: BoundingBox,
) -> None:
    """Draw one quantity: colours, arrows, a colour bar and a grid of positions."""
    time, lat, lon = points
    values = sample_stack(layers, [panel.values], time, lat[:, None], lon[None, :])[panel.values]
    if panel.unit == "hPa":
        values = values / 100.0
    low, high = _colour_limits(values, panel)
    colours = axis.pcolormesh(
        lon,
        lat,
        values,
        cmap=panel.colours,
        vmin=low,
        vmax=high,
        shading="nearest",
        rasterized=True,
    )
    axis.set_facecolor(UNKNOWN_COLOUR)
    if panel.arrows and stack_provides(layers, panel.arrows[0]):
        _draw_arrows(axis, layers, panel, time, area)
    bar = figure.colorbar(colours, cax=axis.inset_axes([1.02, 0.0, 0.028, 1.0]))
    bar.outline.set_visible(False)
    bar.ax.tick_params(labelsize=8, colors=TEXT_COLOUR, length=2)
    bar.set_label(panel.unit, fontsize=8, color=TEXT_COLOUR)
    _set_axes(axis, panel, area)
    if not np.isfinite(values).any():
        axis.text(
            0.5,
            0.5,
            "no data at this time",
            transform=axis.transAxes,
            ha="center",
            color=TEXT_COLOUR,
        )


def _set_axes(axis: Any, panel: MapPanel, area: BoundingBox) -> None:
    """Set title, limits, position labels and grid lines of a panel."""
    axis.set_title(panel.title, fontsize=10, loc="left", color=TEXT_COLOUR)
    axis.set_xlim(area.west, area.east)
    axis.set_ylim(area.south, area.north)
    axis.set_aspect(1.0 / math.cos(math.radians(0.5 * (area.south + area.north))))
    axis.xaxis.set_major_formatter(lambda x, _: _degree_label((x + 180.0) % 360.0 - 180.0, "EW"))
    axis.yaxis.set_major_formatter(lambda y, _: _degree_label(y, "NS"))
    axis.locator_params(nbins=6)
    axis.tick_params(labelsize=8, colors=TEXT_COLOUR, length=2)
    axis.grid(color="white", linewidth=0.4, alpha=0.6)
    for side in axis.spines.values():
        side.set_linewidth(0.5)
        side.set_color("#9aa3af")


def _colour_limits(values: FloatArray, panel: MapPanel) -> tuple[float, float]:
    known = values[np.isfinite(values)]
    if known.size == 0:
        return 0.0, 1.0
    whole = panel.values in (nm.WAVE_HEIGHT, "wind_speed", nm.WAVE_PERIOD)
    low, high = np.percentile(known, [0.0, 100.0] if whole else [0.5, 99.5])
    if panel.around_zero:
        reach = max(abs(float(low)), abs(float(high)), 0.05)
        return -reach, reach
    starts_at_zero = bool(panel.arrows) or panel.values in (nm.ICE, nm.BED_DEPTH)
    low, high = 0.0 if starts_at_zero else float(low), float(high)
    if high and high - low <= _UNIFORM * abs(high):
        return low - _AROUND_UNIFORM * abs(high), high + _AROUND_UNIFORM * abs(high)
    return low, max(high, low + 1e-3)


def _draw_arrows(
    axis: Any, layers: Sequence[Layer], panel: MapPanel, time: float, area: BoundingBox
) -> None:
    lat, lon = _raster_axes(area, ARROWS_ALONG_SIDE)
    lat, lon = 0.5 * (lat[1:] + lat[:-1]), 0.5 * (lon[1:] + lon[:-1])
    samples = sample_stack(layers, list(panel.arrows), time, lat[:, None], lon[None, :])
    u, v = (samples[n] for n in panel.arrows)
    speed = np.hypot(u, v)
    if panel.values == nm.WAVE_HEIGHT:  # directions, all of one length
        shown, typical = speed > 1e-6, 1.0
        u, v = u / np.where(shown, speed, 1.0), v / np.where(shown, speed, 1.0)
    else:
        shown, _ = shown_arrows(u, v)
        typical = float(np.percentile(speed[shown], 95)) if shown.any() else 0.0
    if not shown.any():
        return
    rows, columns = np.nonzero(shown)
    axis.quiver(
        lon[columns], lat[rows], u[shown], v[shown],
        scale=typical * ARROWS_ALONG_SIDE * 1.25,
        color=TEXT_COLOUR, alpha=0.9, width=0.0028, headwidth=3.6, headlength=4.2,
        headaxislength=3.8, edgecolor="white", linewidth=0.3,
        pivot="middle",
    )  # fmt: skip


def _draw_coastline(axis: Any, lines: Sequence[CoastlinePart], area: BoundingBox) -> None:
    """Draw lines as one artist; those too small to be seen are left out."""
    from matplotlib.collections import LineCollection

    smallest = max(area.north - area.south, area.east - area.west) / SMALLEST_LINE
    middle, parts = 0.5 * (area.west + area.east), []
    for lat, lon in lines:
        if lat.size < 2 or (np.ptp(lat) < smallest and np.ptp(lon) < smallest):
            continue
        lon = longitude_difference(lon, middle) + middle
        cuts = np.flatnonzero(np.abs(np.diff(lon)) > 180.0) + 1
        parts += np.split(np.column_stack([lon, lat]), cuts)
    axis.add_collection(LineCollection(parts, colors="#6b7280", linewidths=0.6), autolim=False)


def _degree_label(value: float, letters: str) -> str:
    if abs(value) < 1e-9:
        return "0°"
    return f"{abs(value):g}°{letters[0] if value > 0 else letters[1]}"
