"""What finer networks, steps and weather are worth: routes of a study against the finest."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np
import pandas as pd

#: Axes whose values are accuracies of the computation, not choices of a master.
FIDELITY_AXES: Final = ("network", "resolution_nm", "sampling")
#: Column of rows that holds the value of an objective.
_VALUE_OF: Final = {
    "time": "time_h", "distance": "distance_nm", "fuel": "fuel_t", "comfort": "comfort",
    "cost": "cost_usd", "co2": "co2_t", "energy": "energy_mwh",
}  # fmt: skip
_SHOWN: Final = ("segments", "nodes", "distance_nm", "time_h", "fuel_t", "sick_percent")


def fidelity_table(
    rows: pd.DataFrame, values: Sequence[Any], axis: str = FIDELITY_AXES[0]
) -> pd.DataFrame:
    """Return medians of the routes of each accuracy, and their gap to those of the finest.

    Parameters
    ----------
    rows : pandas.DataFrame
        Of `study_rows`, those with a usable route.
    values : sequence
        Of the axis, in the order of the study.
    axis : str, optional
        One of `FIDELITY_AXES`.

    Returns
    -------
    pandas.DataFrame
        The axis, ``routes``, ``segments`` and ``nodes`` of the network, ``distance_nm``,
        ``time_h``, ``fuel_t``, ``sick_percent``, ``gap_percent`` (of the objective over that of the
        network with most segments, of the least distance between nodes, or of linear interpolation
        of the weather) and ``seconds``; empty for fewer than two values. Known figures only; a
        value without a route has no figures.
    """
    if axis not in rows or len(values) < 2 or rows.empty:
        return pd.DataFrame()
    objective = rows["objective"].iloc[0] if "objective" in rows else "time"
    value = _VALUE_OF.get(objective, "time_h")
    columns = [name for name in (*_SHOWN, "seconds") if name in rows and rows[name].notna().any()]
    found = []
    for name in (str(one["name"] if isinstance(one, Mapping) else one) for one in values):
        group = rows[rows[axis].astype(str) == name]
        row: dict[str, Any] = {axis: name, "routes": len(group)}
        for column in dict.fromkeys((*columns, value)):
            known = group[column].to_numpy(float) if column in group else np.empty(0)
            known = known[np.isfinite(known)]
            row[column] = float(np.median(known)) if len(known) else None
        found.append(row)
    table = pd.DataFrame(found)
    reached = table[value].to_numpy(float)
    table["gap_percent"] = 100.0 * (reached / reached[_finest(table, axis)] - 1.0)
    order = [axis, "routes", *(c for c in columns if c != "seconds"), "gap_percent"]
    return table[[*order, *(["seconds"] if "seconds" in columns else [])]]


def _finest(table: pd.DataFrame, axis: str) -> int:
    """Return the row of the finest value: the last one where that is not known."""
    if axis == "network" and "segments" in table:
        return int(np.nanargmax(table["segments"].to_numpy(float)))
    steps = pd.to_numeric(table[axis].str.rpartition(":")[2], errors="coerce")
    steps = steps.where(table[axis] != "linear", 0.0)
    return int(np.nanargmin(steps)) if steps.notna().any() else len(table) - 1
