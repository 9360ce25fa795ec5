"""`Plan`: the answer to a voyage, with its plots and files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from thalweg.planning.plan_data import PlanData
from thalweg.planning.plots.voyage_map import draw_map
from thalweg.planning.report.output_files import write_plan


@dataclass(frozen=True)
class Plan(PlanData):
    """The answer to a voyage: routes, proof, notes and provenance (`PlanData`), to plot and write.

    `PlanData` describes the attributes: ``voyage``, ``routes``, ``proof``, ``rejections``,
    ``notes``, ``provenance``, ``front``, ``ensemble`` and ``cancelled``.
    """

    def plot(self, path: str | Path | None = None) -> Any:
        """Draw the map of the plan.

        Parameters
        ----------
        path : path, optional
            Where to save it (PNG).

        Returns
        -------
        matplotlib.figure.Figure
        """
        return draw_map(self, path)

    def write(self, folder: str | Path) -> list[Path]:
        """Write plan.json, route.geojson, route.gpx, route.csv, map.png and profile.png.

        Where the tide matters st.png as well. A plan with a front also writes front.csv, front.png,
        comparison.csv and, in ``routes``, each route.

        Parameters
        ----------
        folder : path
            Made where it does not exist.

        Returns
        -------
        list of Path
            The files written.

        Raises
        ------
        InputError
            If the folder cannot be written.
        """
        return write_plan(self, folder)
