"""Fronts of time and fuel in a study: hypervolume and coverage by method (Seuren 2023, ch. 5.6)."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from thalweg.core.file_writing import save_figure
from thalweg.core.types import FloatArray
from thalweg.evolution.indicators import c_metric, hypervolume, non_dominated

#: Axes over which fronts of the same problem are compared.
OF_METHOD: Final = ("method", "seed")
_BEYOND: Final = 0.01  # the reference point is this share of the range beyond the worst values


def front_statistics(rows: pd.DataFrame, axes: list[str]) -> pd.DataFrame:
    """Return indicators of each front against all fronts of the same problem.

    Parameters
    ----------
    rows : pandas.DataFrame
        Of `study_rows`; those with a ``front`` count.
    axes : list of str
        Axes of the study. Those other than ``method`` and ``seed`` tell problems apart.

    Returns
    -------
    pandas.DataFrame
        The axes; ``routes``; ``hypervolume`` (h t) and ``hypervolume_ratio``: that over the
        hypervolume of all fronts of the problem together; ``covered_by_NAME``: mean share of the
        front that the fronts of a method cover (Zitzler and Thiele 1999). The reference point is
        1 % of the range beyond the worst time and fuel of the problem. Empty without fronts.
    """
    if "front" not in rows or rows["front"].isna().all():
        return pd.DataFrame()
    rows = rows[rows["front"].notna()]
    problem = [name for name in axes if name not in OF_METHOD and name in rows]
    found = []
    for _, group in rows.groupby(problem, dropna=False) if problem else [((), rows)]:
        fronts = [np.array(json.loads(text), float) for text in group["front"]]
        fronts = [front[np.isfinite(front).all(axis=1)] for front in fronts]
        every = np.concatenate(fronts)
        if not len(every):
            continue
        reference = every.max(axis=0) + _BEYOND * np.ptp(every, axis=0) + 1e-9
        union = hypervolume(every[non_dominated(every)], reference)
        unnamed = pd.Series("default", index=group.index)
        methods = group["method"].astype(str) if "method" in group else unnamed
        for position, (_, row) in enumerate(group.iterrows()):
            volume = hypervolume(fronts[position], reference) if len(fronts[position]) else 0.0
            values = {name: row[name] for name in axes if name in row}
            values |= {"routes": len(fronts[position]), "hypervolume": volume}
            values["hypervolume_ratio"] = volume / union if union > 0.0 else np.nan
            for method in sorted(set(methods)):
                others = [
                    front
                    for k, front in enumerate(fronts)
                    if methods.iloc[k] == method and k != position and len(front)
                ]
                values[f"covered_by_{method}"] = _covered(fronts[position], others)
            found.append(values)
    return pd.DataFrame(found)


def _covered(front: FloatArray, others: list[FloatArray]) -> float:
    if not len(front) or not others:
        return float("nan")
    return float(np.mean([c_metric(other, front) for other in others]))


def draw_front_statistics(table: pd.DataFrame, path: Path) -> Path:
    """Draw a box plot of the hypervolume ratios by method.

    Parameters
    ----------
    table : Of `front_statistics`.
    """
    from matplotlib.figure import Figure

    groups = table.groupby("method") if "method" in table else [("all", table)]
    names, values = zip(*((str(name), group["hypervolume_ratio"]) for name, group in groups))
    figure = Figure(figsize=(6.4, 4.0), layout="constrained")
    axes = figure.subplots()
    axes.boxplot([series.dropna().to_numpy() for series in values])
    axes.set_xticks(range(1, len(names) + 1), names)
    axes.set_ylabel("hypervolume over that of all fronts together")
    axes.grid(alpha=0.3, axis="y")
    save_figure(figure, path, dpi=120)
    return path
