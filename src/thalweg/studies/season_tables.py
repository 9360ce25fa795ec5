"""Departures of a study by month and hour: weather windows, waiting days, choices, heat maps."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
import pandas as pd

from thalweg.core.units import HOUR
from thalweg.studies.fidelity_table import FIDELITY_AXES

_DAY: Final = 24.0 * HOUR
#: A route with at least this share of its length inshore counts as inshore [%].
INSHORE_PERCENT: Final = 50.0
#: Figures by which one value of an axis is chosen over another, the first that the rows have.
_CHOSEN_BY: Final = {
    "time": "time_h", "distance": "distance_nm", "fuel": "fuel_t", "co2": "co2_t",
    "energy": "energy_mwh", "comfort": "comfort",
}  # fmt: skip
#: Axes that are no choice of a master.
_NO_CHOICE: Final = (*FIDELITY_AXES, "coast", "detail", "member", "method", "sea", "seed")
_MOST_TOGETHER_H: Final = 6  # hours of the day in one row of a heat map of random departures
_TIE: Final = 1e-6  # share by which figures differ that count as equal
_ENOUGH: Final = 5  # routes in the middle cell of such a heat map


def departure_windows(frame: pd.DataFrame, usable: pd.Series) -> dict[str, float | None]:
    """Return how long departures without a route have to wait, of rows that share other axes.

    Parameters
    ----------
    frame : pandas.DataFrame
        With ``depart``.
    usable : pandas.Series of bool
        Rows with a route.

    Returns
    -------
    dict
        ``waiting_days_mean`` and ``waiting_days_max``: until the next departure with a route, 0 for
        those that have one; departures after the last one count in neither. None without any.
    """
    times = _seconds(frame["depart"])
    order = np.argsort(times, kind="stable")
    times, good = times[order], usable.to_numpy(bool)[order]
    following = np.searchsorted(times[good], times)
    known = following < int(good.sum())
    if not known.any():
        return {"waiting_days_mean": None, "waiting_days_max": None}
    days = (times[good][following[known]] - times[known]) / _DAY
    return {"waiting_days_mean": float(days.mean()), "waiting_days_max": float(days.max())}


def inshore_share(routes: pd.DataFrame) -> float | None:
    """Return the share of routes that are inshore; None where that is not known."""
    if "inshore_percent" not in routes:
        return None
    known = routes["inshore_percent"].dropna().to_numpy(float)
    return float((known >= INSHORE_PERCENT).mean()) if len(known) else None


def choices_by_axis(frame: pd.DataFrame, usable: pd.Series, axes: list[str]) -> pd.DataFrame:
    """Return how often each value of an axis is the best of its departure.

    Parameters
    ----------
    frame : pandas.DataFrame
        Rows of a study with ``depart`` and, perhaps, ``month``.
    usable : pandas.Series of bool
        Rows with a route.
    axes : list of str
        Axes other than the departure; those with one value, and those of the accuracy, are left
        out.

    Returns
    -------
    pandas.DataFrame
        ``axis``, ``value``, ``month``, ``departures``, ``chosen`` (share of the departures with any
        route, by the figure of the objective; a departure in which several values are equally good
        is divided among them), ``tied`` (share of the departures in which the value is one of
        several that are equally good) and ``persistence`` (share of successive departures of the
        month with the same choice). Empty where departures have no such choice, or for a
        single departure.
    """
    objective = str(frame.get("objective", pd.Series(dtype=object)).dropna().iloc[:1].squeeze())
    figure = _CHOSEN_BY.get(objective, "time_h")
    if "depart" not in frame or figure not in frame or frame["depart"].nunique() < 2:
        return pd.DataFrame()
    found: list[dict[str, Any]] = []
    good = frame[usable & frame[figure].notna()]
    for axis in (name for name in axes if good[name].nunique() > 1 and name not in _NO_CHOICE):
        best = _best_of_departures(good, axis, [name for name in axes if name != axis], figure)
        for number in sorted(best["month"].unique()):
            of_month = best[best["month"] == number]
            once = of_month[of_month["first"]]
            successive = int(once["follows"].sum())
            for value, of_value in of_month.groupby("value", sort=False):
                found.append(
                    {
                        "axis": axis,
                        "value": value,
                        "month": int(number) or None,
                        "departures": len(once),
                        "chosen": float(of_value["share"].sum()) / len(once),
                        "tied": float((of_value["share"] < 1.0).sum()) / len(once),
                        "persistence": (
                            float((once["same"] & once["follows"]).sum() / successive)
                            if successive
                            else None
                        ),
                    }
                )
    return pd.DataFrame(found)


def _best_of_departures(
    good: pd.DataFrame, axis: str, others: list[str], figure: str
) -> pd.DataFrame:
    """Return a row for each value of an axis that is best in a departure, several where they tie.

    Returns
    -------
    pandas.DataFrame
        ``value``; ``share``: one over the number of values that tie; ``month`` (0 where unknown);
        ``first``: in one row of each departure; ``follows``: whether it is after another departure
        of the month; ``same``: whether the same values are best there.
    """
    keys = [*others, "depart"]
    rows = good.assign(value=good[axis].astype(str)).sort_values(
        [*keys, "value"], kind="stable", key=_as_sortable
    )
    least = rows.groupby(keys, dropna=False)[figure].transform("min")
    tied = rows[rows[figure] <= least * (1.0 + _TIE)].drop_duplicates([*keys, "value"])
    of_departure = tied.groupby(keys, dropna=False)["value"]
    count = of_departure.transform("size")
    together = tied["value"].copy()
    if (count > 1).any():
        together[count > 1] = of_departure.transform(lambda names: "\n".join(names))[count > 1]
    best = tied.assign(share=1.0 / count, together=together, first=~tied.duplicated(keys))
    best["month"] = best.get("month", 0)
    once = best[best["first"]]
    before = once.shift()
    follows = once["month"] == before["month"]
    for name in others:
        follows &= (once[name] == before[name]) | (once[name].isna() & before[name].isna())
    best["follows"] = follows.reindex(best.index, fill_value=False)
    same = once["together"] == before["together"]
    best["same"] = same.reindex(best.index, fill_value=False)
    return best


def month_by_hour(frame: pd.DataFrame, figures: list[str]) -> pd.DataFrame:
    """Return the medians of figures by month and hour (UTC) of the departure.

    Parameters
    ----------
    frame : pandas.DataFrame
        Rows with a route, with ``depart`` and ``month``.
    figures : list of str
        Columns.

    Returns
    -------
    pandas.DataFrame
        ``month``, ``hour``, ``hours``, ``routes`` and the figures; empty with a single month or
        hour. A row is of departures from ``hour`` until ``hours`` later: 1, or, for departures at
        random times, up to 6 so that most rows have five routes.
    """
    if "month" not in frame or frame.empty:
        return pd.DataFrame()
    hour = pd.to_datetime(frame["depart"], utc=True, format="ISO8601").dt.hour
    if hour.nunique() < 2 or frame["month"].nunique() < 2:
        return pd.DataFrame()
    together = 1
    if (_seconds(frame["depart"]) % HOUR != 0.0).any():
        for together in (1, 2, 3, 4, _MOST_TOGETHER_H):
            cells = frame.groupby([frame["month"], hour // together]).size()
            if cells.median() >= _ENOUGH:
                break
    groups = frame.assign(hour=hour // together * together).groupby(["month", "hour"])
    table = groups[figures].median()
    table.insert(0, "routes", groups.size())
    table.insert(0, "hours", together)
    return table.reset_index()


def _seconds(departs: pd.Series) -> np.ndarray:
    stamps = pd.to_datetime(departs, utc=True, format="ISO8601")
    return (stamps - pd.Timestamp(0, tz="UTC")).dt.total_seconds().to_numpy()


def _as_sortable(column: pd.Series) -> pd.Series:
    return column if pd.api.types.is_numeric_dtype(column) else column.astype(str)
