"""`Plan`: the answer to a voyage, with its plots and files."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from thalweg.planning.plan_data import PlanData
from thalweg.planning.plots.voyage_map import draw_map
from thalweg.planning.report.note_order import danger_first
from thalweg.planning.report.output_files import write_plan
from thalweg.planning.report.plan_summary import one_line, summary_html, summary_with_notes
from thalweg.route import Route, RouteFileOptions


@dataclass(frozen=True)
class Plan(PlanData):
    """The answer to a voyage: routes, proof, notes and provenance (`PlanData`), to plot and write.

    `PlanData` describes the attributes: ``voyage``, ``routes``, ``proof``, ``rejections``,
    ``notes``, ``provenance``, ``front``, ``ensemble`` and ``cancelled``.
    """

    def __repr__(self) -> str:
        return one_line(self)

    def __str__(self) -> str:
        return "\n".join(summary_with_notes(self))

    def _repr_html_(self) -> str:
        """Return the summary as a table for notebooks."""
        return summary_html(self)

    def to_dict(self) -> dict[str, Any]:
        """Return the plan as plain data, ready for JSON (unknown numbers are None).

        Returns
        -------
        dict
            As of `PlanData`; notes on danger come first.
        """
        return super().to_dict() | {"notes": danger_first(self.notes)}

    def with_alternatives(self) -> Plan:
        """Return this plan with the ways round the canals and passages it uses.

        Returns
        -------
        Plan
            With `passage_alternatives`: for each way, the shortest first, what is closed
            (``without``), what it passes, its distance, its time at the mean speed of the plan, and
            its canal dues. It takes some seconds; weather, depth and zones are not considered.
        """
        from thalweg.planning.passage_alternatives import passage_alternatives

        rows = tuple(way.to_dict() for way in passage_alternatives(self))
        return replace(self, passage_alternatives=rows)

    def plot(self, path: str | Path | None = None, *, beside: Route | None = None) -> Any:
        """Draw the map of the plan.

        Parameters
        ----------
        path : path, optional
            Where to save it (PNG).
        beside : Route, optional
            A route to draw beside that of the plan, such as one that ignores the weather.

        Returns
        -------
        matplotlib.figure.Figure
        """
        return draw_map(self, path, beside=beside)

    def write(
        self,
        folder: str | Path,
        options: RouteFileOptions | None = None,
        *,
        beside: Route | None = None,
    ) -> list[Path]:
        """Write plan.json, the route files, map.png and profile.png.

        Where the tide matters st.png as well. A plan with a front also writes front.csv, front.png,
        comparison.csv and, in ``routes``, each route.

        Parameters
        ----------
        folder : path
            Made where it does not exist.
        options : RouteFileOptions, optional
            Formats, cross-track limit, number of waypoints and RTZ version of the route files; by
            default route.rtz, .gpx, .geojson and .csv.
        beside : Route, optional
            A route to draw on the map beside that of the plan.

        Returns
        -------
        list of Path
            The files written.

        Raises
        ------
        InputError
            If the folder cannot be written.
        """
        return write_plan(self, folder, options, beside=beside)
