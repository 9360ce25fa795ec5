"""Files and key figures of one route of a result."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from thalweg.core.file_writing import write_text
from thalweg.service.jobs.route_profiles import first_look, route_profile

if TYPE_CHECKING:
    from thalweg.planning import Plan
    from thalweg.route import Route


def write_route_result(
    route: Route,
    folder: Path,
    number: int,
    options: Any,
    *,
    plan: Plan | None = None,
    stem: str = "route",
) -> None:
    """Write one route in every format, and its profile."""
    from thalweg.planning.report.output_files import keeping_limits
    from thalweg.route import write_route_files

    kept = route
    if plan is not None:
        kept, options = keeping_limits(plan, route, options)
    write_route_files(kept, folder, f"{stem}_{number:02d}", options)
    write_json_file(folder / f"profile_{number:02d}.json", route_profile(route))


def write_json_file(path: Path, data: Mapping[str, Any] | None) -> None:
    """Write plain data, if there are any."""
    if data is not None:
        write_text(path, json.dumps(data, allow_nan=False))


def route_totals(route: Route) -> dict[str, Any]:
    """Return the totals of a route for lists of jobs."""
    first = first_look(route)
    del first["points"]
    return {**first, "co2_t": route.co2_t}
