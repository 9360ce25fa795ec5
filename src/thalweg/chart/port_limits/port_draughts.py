"""Largest draughts of ports where those of the World Port Index do not hold.

The table is ``data/port_draughts.csv``: UN/LOCODE (or name and country), largest draught, source.
An empty draught means that the index gives that of another part of the port and none is known for
the whole.
"""

from __future__ import annotations

from functools import cache

from thalweg.core.file_reading import table_rows


@cache
def port_draughts() -> dict[str, dict[str, str]]:
    """Return the columns that replace those of the table of approaches, by UN/LOCODE or label."""
    return {
        row["unlocode"]: {"max_draught_m": row["max_draught_m"], "draught_source": row["source"]}
        for row in table_rows("thalweg.chart", "port_draughts.csv")
    }
