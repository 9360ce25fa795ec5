"""The map of alternatives: several routes of one voyage, each with its number and its name."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

from thalweg.chart import Chart
from thalweg.core.file_writing import new_figure, save_figure
from thalweg.core.time import utc_text
from thalweg.planning.plots.map_extent import MapExtent
from thalweg.planning.plots.map_labels import LabelPlacer, drawn_texts
from thalweg.planning.plots.map_overlays import draw_land, draw_zones, place_labels
from thalweg.route import Route
from thalweg.route.number_texts import hours_texts, miles_text

_SEA: Final = "#eaf3fa"
#: Colours of Okabe and Ito (2008), which differ also for the colour-blind.
_COLOURS: Final = ("#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00")


def draw_alternatives_map(
    routes: Sequence[Route],
    names: Sequence[str],
    chart: Chart,
    ends: tuple[str, str],
    path: str | Path | None = None,
) -> Any:
    """Draw the map of alternatives: land, areas and the routes with their numbers.

    Parameters
    ----------
    routes : At most five.
    names : Of the routes, for the legend.
    chart : Its land and zones are drawn.
    ends : Names of the start and the goal.
    path : Where to save it (PNG).
    """
    box = MapExtent.of_routes(routes)
    figure = new_figure(*box.figure_size())
    axes = figure.add_subplot()
    axes.set_facecolor(_SEA)
    box.set_up(axes)
    draw_land(axes, chart, box)
    labels = draw_zones(axes, chart, box)
    hours = hours_texts([route.time_h for route in routes])
    for number, (route, name, colour) in enumerate(zip(routes, names, _COLOURS), start=1):
        text = f"{number}. {name}: {hours[number - 1]} h, {miles_text(route.distance_nm)} nm"
        line = box.line(route.samples["lon"]), route.samples["lat"]
        # the first on top; the others are wider, so that they show beneath it on the same way
        style = {"lw": 1.6 + 0.9 * (number - 1), "zorder": 5.0 - 0.1 * number}
        axes.plot(*line, color=colour, solid_capstyle="butt", label=text, **style)
    axes.set_title(
        f"{ends[0]} to {ends[1]}: alternatives, depart {utc_text(routes[0].depart)}",
        fontsize=9,
        loc="left",
    )
    box.draw_scale(axes)
    axes.legend(
        loc="upper left", bbox_to_anchor=(0.0, -0.04), fontsize=7, frameon=False, borderaxespad=0.0
    )
    _label(figure, axes, routes, box, ends, labels)
    if path is not None:
        save_figure(figure, path)
    return figure


def _label(
    figure: Any,
    axes: Any,
    routes: Sequence[Route],
    box: MapExtent,
    ends: tuple[str, str],
    labels: list[tuple[str, float, float]],
) -> None:
    """Label the ends, each route where it is farthest from the others, and the areas."""
    figure.draw_without_rendering()
    figure.set_layout_engine("none")
    lines = [np.column_stack([box.line(r.samples["lon"]), r.samples["lat"]]) for r in routes]
    shown = [axes.transData.transform(line) for line in lines]
    placer = LabelPlacer(axes, np.concatenate(shown), drawn_texts(axes))
    for index, name in ((0, ends[0]), (-1, ends[1])):
        axes.plot(*lines[0][index], "o", mfc="white", mec="#22303c", mew=1.6, ms=7, zorder=7)
        placer.place(name, *lines[0][index], needed=True, fontsize=8, fontweight="bold")
    for k, colour in enumerate(_COLOURS[: len(lines)]):
        others = [line for j, line in enumerate(shown) if j != k]
        place = lines[k][_farthest(shown[k], others)]
        placer.place(str(k + 1), *place, needed=True, fontsize=9, fontweight="bold", color=colour)
    place_labels(placer, labels)


def _farthest(line: np.ndarray, others: Sequence[np.ndarray]) -> int:
    """Return the number of the point of a line that is farthest from other lines, (n, 2)."""
    if not others:
        return len(line) // 2
    from scipy.spatial import cKDTree

    away, _ = cKDTree(np.concatenate(others)).query(line)
    return int(np.argmax(away))
