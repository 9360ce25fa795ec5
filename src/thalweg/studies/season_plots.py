"""Plots of a study by month: medians with quantiles, and a heat map of month and hour."""

from __future__ import annotations

import calendar
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from thalweg.core.file_writing import save_figure

_MONTHS: Final = tuple(calendar.month_abbr)[1:]


def draw_heat_map(table: pd.DataFrame, figure_name: str, path: Path) -> Path:
    """Draw the medians of a figure by month and hour of departure; months without any are left out.

    Parameters
    ----------
    table : Of `thalweg.studies.season_tables.month_by_hour`.
    figure_name : Column.
    """
    from matplotlib.figure import Figure

    grid = table.pivot(index="hour", columns="month", values=figure_name)
    width = max(4.5, 2.0 + 0.5 * grid.shape[1])
    figure = Figure(figsize=(width, 0.8 + 0.45 * max(len(grid), 4)), layout="constrained")
    axes = figure.subplots()
    cells = np.ma.masked_invalid(grid.to_numpy(float))
    image = axes.imshow(cells, aspect="auto", cmap="cividis")
    months = grid.columns.to_numpy(int)
    axes.set_xticks(range(len(months)), [_MONTHS[month - 1] for month in months])
    together = int(table["hours"].iloc[0])
    until = "" if together == 1 else "-{:02d}"
    names = [f"{hour:02d}{until.format(hour + together)}" for hour in grid.index]
    axes.set_yticks(range(len(grid)), names)
    axes.set_ylabel("hour of departure (UTC)")
    figure.colorbar(image, label=f"median {figure_name}")
    save_figure(figure, path, dpi=120)
    return path


def draw_months(table: pd.DataFrame, path: Path) -> Path:
    """Draw the median time by month with its quantiles, and the share without a route."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, 4.5), layout="constrained")
    top, bottom = figure.subplots(2, 1, sharex=True, height_ratios=(3, 1))
    others = [
        name
        for name in table.columns[: list(table.columns).index("month")]
        if table[name].nunique() > 1
    ]
    groups = table.groupby(others, dropna=False) if others else [((), table)]
    for key, group in groups:
        label = ", ".join(map(str, key if isinstance(key, tuple) else (key,)))
        (line,) = top.plot(group["month"], group["time_h_p50"], marker="o", label=label)
        if "time_h_p10" in group:
            low, high = group["time_h_p10"].astype(float), group["time_h_p90"].astype(float)
            top.fill_between(group["month"], low, high, alpha=0.15, color=line.get_color())
        bottom.plot(group["month"], 100.0 * group["without_route"], color=line.get_color())
    top.set_ylabel("passage [h]\nmedian, 10 to 90 %")
    bottom.set_ylabel("without\nroute [%]")
    bottom.set_ylim(0.0, 100.0)
    bottom.set_xticks(range(1, 13), _MONTHS)
    if others:
        top.legend(fontsize="small")
    for axes in (top, bottom):
        axes.grid(alpha=0.3)
    save_figure(figure, path, dpi=120)
    return path
