"""Plots of a study by month: medians with quantiles, and a heat map of month and hour."""

from __future__ import annotations

import calendar
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from thalweg.core.file_writing import save_figure

_BY_MONTH: Final = {"time_h": "passage [h]", "fuel_t": "fuel [t]", "sick_percent": "sick [%]"}
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
    """Draw medians by month with their quantiles, and the share without a route.

    Time, fuel and the share of people who get sick, as far as they are known.
    """
    from matplotlib.figure import Figure

    shown = [name for name in _BY_MONTH if f"{name}_p50" in table]
    figure = Figure(figsize=(8.0, 2.0 + 2.2 * len(shown)), layout="constrained")
    *panels, bottom = figure.subplots(
        len(shown) + 1, 1, sharex=True, height_ratios=[*(3 for _ in shown), 1]
    )
    others = [
        name
        for name in table.columns[: list(table.columns).index("month")]
        if table[name].nunique() > 1
    ]
    groups = table.groupby(others, dropna=False) if others else [((), table)]
    for key, group in groups:
        label = ", ".join(map(str, key if isinstance(key, tuple) else (key,)))
        share = 100.0 * group["without_route"]
        (line,) = bottom.plot(group["month"], share, label=label)
        for name, panel in zip(shown, panels):
            middle, low, high = (group[f"{name}_p{q}"].astype(float) for q in (50, 10, 90))
            panel.plot(group["month"], middle, marker="o", color=line.get_color(), label=label)
            panel.fill_between(group["month"], low, high, alpha=0.15, color=line.get_color())
    for name, panel in zip(shown, panels):
        panel.set_ylabel(f"{_BY_MONTH[name]}\nmedian, 10 to 90 %")
    bottom.set_ylabel("without\nroute [%]")
    bottom.set_ylim(0.0, 100.0)
    bottom.set_xticks(range(1, 13), _MONTHS)
    if others:
        (panels[0] if panels else bottom).legend(fontsize="small")
    for axes in (*panels, bottom):
        axes.grid(alpha=0.3)
    save_figure(figure, path, dpi=120)
    return path
