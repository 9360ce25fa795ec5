"""What finer networks are worth: the routes of a study by network, against the finest."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np
import pandas as pd

#: Column of rows that holds the value of an objective.
_VALUE_OF: Final = {
    "time": "time_h", "distance": "distance_nm", "fuel": "fuel_t", "comfort": "comfort",
    "cost": "cost_usd", "co2": "co2_t", "energy": "energy_mwh",
}  # fmt: skip
_SHOWN: Final = ("segments", "nodes", "distance_nm", "time_h", "fuel_t", "sick_percent")


def fidelity_table(rows: pd.DataFrame, networks: Sequence[Any]) -> pd.DataFrame:
    """Return medians of the routes of each network, and their gap to those of the finest.

    Parameters
    ----------
    rows : pandas.DataFrame
        Of `study_rows`, those with a usable route.
    networks : sequence
        Values of the axis ``network``, in the order of the study.

    Returns
    -------
    pandas.DataFrame
        ``network``, ``routes``, ``segments`` and ``nodes`` of the network, ``distance_nm``,
        ``time_h``, ``fuel_t``, ``sick_percent``, ``gap_percent`` (of the objective over that of the
        network with most segments) and ``seconds``; empty for fewer than two networks. Known
        figures only; a network without a route has no figures.
    """
    if "network" not in rows or len(networks) < 2 or rows.empty:
        return pd.DataFrame()
    objective = rows["objective"].iloc[0] if "objective" in rows else "time"
    value = _VALUE_OF.get(objective, "time_h")
    columns = [name for name in (*_SHOWN, "seconds") if name in rows and rows[name].notna().any()]
    found = []
    for name in (one["name"] if isinstance(one, Mapping) else one for one in networks):
        group = rows[rows["network"].astype(str) == str(name)]
        row: dict[str, Any] = {"network": str(name), "routes": len(group)}
        for column in dict.fromkeys((*columns, value)):
            known = group[column].to_numpy(float) if column in group else np.empty(0)
            known = known[np.isfinite(known)]
            row[column] = float(np.median(known)) if len(known) else None
        found.append(row)
    table = pd.DataFrame(found)
    values = table[value].to_numpy(float)
    finest = len(table) - 1
    if "segments" in table:
        finest = int(np.nanargmax(table["segments"].to_numpy(float)))
    table["gap_percent"] = 100.0 * (values / values[finest] - 1.0)
    order = ["network", "routes", *(c for c in columns if c != "seconds"), "gap_percent"]
    return table[[*order, *(["seconds"] if "seconds" in columns else [])]]
