"""`summarise_study`: quantiles of key figures by month and axis, refusals, and the best month."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import numpy as np
import pandas as pd
from scipy.stats import binom

from thalweg.core.errors import InputError
from thalweg.core.file_writing import make_folder, write_csv_rows
from thalweg.route.indicator_columns import INDICATORS
from thalweg.ship import Ship
from thalweg.studies.annual_figures import annual_figures, share_of_voyage
from thalweg.studies.fidelity_table import FIDELITY_AXES, fidelity_table
from thalweg.studies.front_statistics import draw_front_statistics, front_statistics
from thalweg.studies.row_runner import ship_of_request
from thalweg.studies.season_plots import draw_heat_map, draw_months
from thalweg.studies.season_tables import (
    choices_by_axis,
    departure_windows,
    inshore_share,
    month_by_hour,
)
from thalweg.studies.study import Study
from thalweg.studies.study_notes import study_notes
from thalweg.studies.study_parts import read_parts, read_study

#: Figures with quantiles, where rows have them; then the indicators and the savings.
FIGURES: Final = (
    "time_h", "fuel_t", "co2_t", "distance_nm", "waiting_h", "waiting_above_limits_h",
    "waves_filled_percent",
)  # fmt: skip
_SAVINGS: Final = (
    "saved_time_h", "saved_fuel_t", "saved_sick_percent", "saved", "saved_by_route",
    "saved_by_speed",
)  # fmt: skip
_LEAST_IS_BEST: Final = ("time_h", "fuel_t", "sick_percent")
QUANTILES: Final = (0.1, 0.5, 0.9)
_CONFIDENCE: Final = 0.9
_ALIKE: Final = 200  # characters in which the reasons of refusals that count as one are the same


@dataclass(frozen=True)
class StudySummary:
    """Statistics of a study.

    Attributes
    ----------
    table : pandas.DataFrame
        One row per group (axes but the departure, and the month): ``voyages``, ``routes``,
        ``without_route`` (share); ``waiting_days_mean`` and ``waiting_days_max`` until a departure
        with a route, ``inshore_share`` of routes; and of each key figure and indicator ``_p10``,
        ``_p50``, ``_p90`` and the confidence limits of the median ``_p50_low`` and ``_p50_high``.
    refusals : pandas.DataFrame
        ``refusal``, ``reason`` (of the first of those that begin alike) and ``voyages``, most
        frequent first.
    best : pandas.DataFrame
        The month with the least median time of each group of the other axes.
    fronts : pandas.DataFrame
        Indicators of fronts of time and fuel (`front_statistics`); empty without.
    annual : pandas.DataFrame
        Figures of a year (`annual_figures`); empty if the study has no entry ``annual``.
    voyages : pandas.DataFrame
        One row per voyage, by its axes: departure, arrival, key figures, and why there is no route.
    choices : pandas.DataFrame
        How often each value of an axis is the best of a departure (`choices_by_axis`).
    hours : pandas.DataFrame
        Medians by month and hour of the departure (`month_by_hour`).
    best_months : pandas.DataFrame
        The month with the least median of time, fuel and share of people sick, by the other axes.
    fidelity : pandas.DataFrame
        Networks, distances between nodes or samplings against the finest (`fidelity_table`); empty
        without an axis ``network``, ``resolution_nm`` or ``sampling``.
    left : int
        Voyages of the study that have no result yet: until it is 0, shares and choices compare
        parts of the study only.
    notes : tuple of str
        On weather that has no effect on the ship, and on methods that are compared.
    """

    table: pd.DataFrame
    refusals: pd.DataFrame
    best: pd.DataFrame
    fronts: pd.DataFrame
    annual: pd.DataFrame
    voyages: pd.DataFrame
    choices: pd.DataFrame = field(default_factory=pd.DataFrame)
    hours: pd.DataFrame = field(default_factory=pd.DataFrame)
    best_months: pd.DataFrame = field(default_factory=pd.DataFrame)
    fidelity: pd.DataFrame = field(default_factory=pd.DataFrame)
    left: int = 0
    notes: tuple[str, ...] = ()

    def write(self, folder: str | Path) -> list[Path]:
        """Write ``summary.csv``, ``voyages.csv``, and the tables and plots that are not empty.

        ``refusals.csv``, ``best_months.csv`` and ``months.png`` with several months, ``hours.csv``
        and ``hours.png`` (heat map of the median time), ``choices.csv``, ``fidelity.csv``,
        ``fronts.csv`` and ``fronts.png`` with fronts, ``annual.csv``.

        Parameters
        ----------
        folder : path

        Returns
        -------
        list of Path
        """
        folder = make_folder(folder)
        files = []
        tables = {
            "summary": self.table, "voyages": self.voyages, "refusals": self.refusals,
            "fronts": self.fronts, "annual": self.annual, "choices": self.choices,
            "hours": self.hours, "best_months": self.best_months, "fidelity": self.fidelity,
        }  # fmt: skip
        for name, frame in tables.items():
            path = folder / f"{name}.csv"
            if frame.empty and name not in ("summary", "voyages"):
                path.unlink(missing_ok=True)  # of an earlier summary
                continue
            rows = frame.astype(object).where(frame.notna(), None).to_numpy().tolist()
            write_csv_rows(path, [list(frame.columns), *rows])
            files.append(path)
        if (
            "month" in self.table
            and self.table.loc[self.table["routes"] > 0, "month"].nunique() > 1
        ):
            files.append(draw_months(self.table, folder / "months.png"))
        if not self.hours.empty and "time_h" in self.hours:
            files.append(draw_heat_map(self.hours, "time_h", folder / "hours.png"))
        if not self.fronts.empty:
            files.append(draw_front_statistics(self.fronts, folder / "fronts.png"))
        return files


def study_rows(folder: str | Path) -> pd.DataFrame:
    """Return the results of a study, one row per voyage.

    Parameters
    ----------
    folder : path
        Of the study.

    Returns
    -------
    pandas.DataFrame
        With ``id``, the axes, the key figures, ``refusal`` and ``reason``; ``saved_time_h``,
        ``saved_fuel_t`` and ``saved_sick_percent`` against the route that ignores the weather,
        where it was compared.

    Raises
    ------
    InputError
        If the folder has no study or no results.
    """
    study = read_study(folder)
    frame = read_parts(folder)
    wanted = {row.id for row in study.rows()}
    frame = frame[frame["id"].isin(wanted)].reset_index(drop=True)
    if frame.empty:
        raise InputError(
            f"The study in {str(folder)!r} has no results yet.",
            "thalweg study run makes them.",
            "Run the study first.",
        )
    for name in ("time_h", "fuel_t", "sick_percent"):
        if f"blind_{name}" in frame and name in frame:
            kept = frame["blind_feasible"].fillna(False).astype(bool)
            frame[f"saved_{name}"] = (frame[f"blind_{name}"] - frame[name]).where(kept)
    return frame


def summarise_study(folder: str | Path) -> StudySummary:
    """Return the statistics of a study.

    Parameters
    ----------
    folder : path
        Of the study.

    Returns
    -------
    StudySummary

    Raises
    ------
    InputError
        If the folder has no study or no results.

    Notes
    -----
    The confidence interval of a median is that of its order statistics: with n voyages the ranks
    follow the binomial distribution B(n, 1/2), whatever the distribution of the figure (Conover
    1999, Practical Nonparametric Statistics, sec. 3.2; not compared with the source). It covers
    90 %.
    Departures close in time are not independent, so the true interval is wider.
    """
    study = read_study(folder)
    frame = study_rows(folder)
    times = ("depart", "arrive")
    by = [name for name in study.axes if name in frame and name not in times]
    departs = frame.get("depart")
    if departs is not None and departs.notna().any() and departs.nunique() > 1:
        stamp = pd.to_datetime(departs, utc=True, format="ISO8601")
        frame = frame.assign(month=stamp.dt.month)
        by = [*by, "month"]
    if "feasible" in frame:
        usable = frame["refusal"].isna() & frame["feasible"].fillna(False).astype(bool)
    else:
        usable = pd.Series(False, index=frame.index)
    costs = [name for name in map(str, frame) if name.startswith("cost_")]  # by currency
    wanted = dict.fromkeys([*FIGURES, *costs, *INDICATORS, *_SAVINGS])
    figures = [name for name in wanted if name in frame and frame[name].notna().any()]
    groups = frame.groupby(by, sort=True, dropna=False) if by else [((), frame)]
    rows = []
    for key, group in groups:
        keys = key if isinstance(key, tuple) else (key,)
        good = group[usable[group.index]]
        row: dict[str, Any] = dict(zip(by, keys))
        row |= {"voyages": len(group), "routes": len(good)}
        row["without_route"] = 1.0 - len(good) / len(group)
        if "month" in frame:
            row |= departure_windows(group, usable[group.index])
        row["inshore_share"] = inshore_share(good)
        for name in figures:
            row |= _quantiles(name, good[name].astype(float).dropna().to_numpy())
        rows.append(row)
    table = pd.DataFrame(rows)
    axes = [name for name in study.axes if name in frame]
    ways = [name for name in axes if name not in times]
    fine = next((name for name in FIDELITY_AXES if len(study.axes.get(name, ())) > 1), "")
    return StudySummary(
        table,
        _refusals(frame, usable),
        _best(table, by),
        front_statistics(frame[usable], axes),
        _annual(study, frame[usable], ways),
        _voyages(frame, [*study.axes, *study.sample], figures),
        choices_by_axis(frame, usable, ways),
        month_by_hour(frame[usable], figures),
        _best_months(table, by),
        fidelity_table(frame[usable], study.axes.get(fine, ()), fine),
        len({row.id for row in study.rows()}) - len(frame),
        tuple(study_notes(study, frame)),
    )


def _voyages(frame: pd.DataFrame, axes: list[str], figures: list[str]) -> pd.DataFrame:
    """Return one row per voyage in order of departure (of an axis) and axes; no empty columns."""
    first = [name for name in axes if name in frame]
    wanted = [*first, "depart", "arrive", *figures, "feasible", "first_violation", "refusal"]
    names = [name for name in dict.fromkeys([*wanted, "reason"]) if name in frame]
    leading = ["depart"] if "depart" in first or not first else []
    order = [name for name in dict.fromkeys([*leading, *first]) if name in frame]
    rows = frame.sort_values(order, kind="stable", key=_sortable) if order else frame
    return rows[names].dropna(axis="columns", how="all").reset_index(drop=True)


def _sortable(column: pd.Series) -> pd.Series:
    numbers = pd.to_numeric(column, errors="coerce")
    return numbers if numbers.notna().any() else column.astype(str)


def _annual(study: Study, usable: pd.DataFrame, by: list[str]) -> pd.DataFrame:
    if not study.annual or usable.empty:
        return pd.DataFrame()
    planned = set(usable["id"])  # other rows may have no ship: they state why
    ships: dict[Any, Ship] = {}
    shares: dict[str, float] = {}
    charged: dict[str, bool] = {}
    for row in study.rows():
        label = row.labels.get("ship")
        if label not in ships and row.id in planned:
            ships[label] = ship_of_request(row.request, str(study.folder))
        shares[row.id] = share_of_voyage(row.request.get("voyage", {}), study.annual)
        charged[row.id] = bool(row.request.get("charges"))
    rows = usable.assign(
        eu_share=usable["id"].map(shares).astype(float), charged=usable["id"].map(charged)
    )
    return annual_figures(rows, by, ships, study.annual)


def _quantiles(name: str, values: np.ndarray) -> dict[str, float | None]:
    if not values.size:
        return {f"{name}_{part}": None for part in ("p10", "p50", "p90", "p50_low", "p50_high")}
    found = {f"{name}_p{round(100 * q)}": float(np.quantile(values, q)) for q in QUANTILES}
    low, high = median_interval(values)
    return {**found, f"{name}_p50_low": low, f"{name}_p50_high": high}


def median_interval(values: np.ndarray) -> tuple[float, float]:
    """Return the confidence interval of a median by order statistics.

    Parameters
    ----------
    values : float array (n,)

    Returns
    -------
    tuple of float
        NaN where n is too small for the coverage.
    """
    ordered = np.sort(values)
    n = len(ordered)
    rank = int(binom.ppf(0.5 * (1.0 - _CONFIDENCE), n, 0.5))
    if rank < 1:
        return float("nan"), float("nan")
    return float(ordered[rank - 1]), float(ordered[n - rank])


def _refusals(frame: pd.DataFrame, usable: pd.Series) -> pd.DataFrame:
    lost = frame[~usable]
    broken = lost.get("first_violation", pd.Series(index=lost.index, dtype=object))
    reasons = pd.DataFrame(
        {
            "refusal": lost["refusal"].fillna("limit exceeded"),
            "reason": lost["reason"].fillna(broken).astype(str),
        }
    )
    alike = ["refusal", reasons["reason"].str.slice(0, _ALIKE)]
    counted = reasons.groupby(alike).agg(reason=("reason", "first"), voyages=("reason", "size"))
    counted = counted.droplevel(1).reset_index()
    return counted.sort_values("voyages", ascending=False, kind="stable", ignore_index=True)


def _best_months(table: pd.DataFrame, by: list[str]) -> pd.DataFrame:
    """Return the month with the least median of each of `_LEAST_IS_BEST`, by the other axes.

    A figure that is the same in all months has none.
    """
    if "month" not in table or table["month"].nunique() < 2:
        return pd.DataFrame()
    others, found = [name for name in by if name != "month"], []
    for figure in (name for name in _LEAST_IS_BEST if f"{name}_p50" in table):
        known = table.dropna(subset=[f"{figure}_p50"])
        for key, group in known.groupby(others, dropna=False) if others else [((), known)]:
            if np.ptp(group[f"{figure}_p50"].to_numpy(float)) > 0.0:
                best = group.iloc[int(np.argmin(group[f"{figure}_p50"].to_numpy(float)))]
                labels = dict(zip(others, key if isinstance(key, tuple) else (key,)))
                value = float(best[f"{figure}_p50"])
                found.append(
                    {**labels, "figure": figure, "month": int(best["month"]), "median": value}
                )
    return pd.DataFrame(found)


def _best(table: pd.DataFrame, by: list[str]) -> pd.DataFrame:
    if "month" not in table or "time_h_p50" not in table:
        return pd.DataFrame()
    known = table.dropna(subset=["time_h_p50"])
    others = [name for name in by if name != "month"]
    if known.empty:
        return known
    if not others:
        return known.loc[[known["time_h_p50"].idxmin()]]
    return known.loc[known.groupby(others, dropna=False)["time_h_p50"].idxmin()]
