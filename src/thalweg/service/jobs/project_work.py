"""The work of a dredging project in its child process, with the files of its result."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np

from thalweg.core.file_writing import write_csv_rows
from thalweg.core.given_numbers import rounded_or_none
from thalweg.core.units import HOUR
from thalweg.service.jobs.child_messages import MessageWriter
from thalweg.service.jobs.closure_facts import PLACES, TIMES, closure_facts
from thalweg.service.jobs.job_order import JobOrder, StageMessages

if TYPE_CHECKING:
    from thalweg.operations.dredging import ProjectResult, ProjectRun
    from thalweg.operations.dredging.cycle_records import DredgingCycle
    from thalweg.route import Route

_LEVEL_STEP: Final = 600.0  # between values of the water level [s]
_AROUND: Final = 7.0 * HOUR  # shown before and after the leg in that diagram [s]
_KEY_FIGURES: Final = (
    "production_m3_week", "duration_days", "cycles", "fuel_t", "co2_t", "waiting_share",
)  # fmt: skip


def simulate_project(
    order: JobOrder, messages: MessageWriter, stages: StageMessages
) -> dict[str, Any]:
    """Simulate a project, send each cycle, and write its files; return the key figures."""
    from thalweg.operations.dredging import Project, open_project_inputs, run_project

    stages("reading the ship, the sea and the chart")
    project = Project.from_dict(order.with_paths(order.request["project"]))
    ship, sea, chart = open_project_inputs(project)

    def on_cycle(run: str, cycle: DredgingCycle) -> None:
        messages.send("progress", {"run": run, "cycle": _cycle_facts(cycle), "whole": whole})

    whole = project.work.volume
    result = run_project(
        project, ship=ship, sea=sea, chart=chart, progress=stages, on_cycle=on_cycle
    )
    stages("writing the files")
    order.write_json("project.json", result.as_dict())
    order.write_json("diagrams.json", project_diagrams(result))
    _write_cycles(result, order)
    best = result.optimised
    return {
        "title": project.name,
        "feasible": best.feasible,
        "seconds": stages.seconds(),
        "parts": ["diagrams"],
        **{key: best.totals.get(key) for key in _KEY_FIGURES},
        **result.gains(),
    }


def _cycle_facts(cycle: DredgingCycle) -> dict[str, Any]:
    """Return what the page shows of a cycle while the project is simulated."""
    return {
        "number": cycle.number,
        "end": cycle.end,
        "volume_m3": cycle.volume,
        "load_factor": cycle.load_factor,
        "waiting_h": sum(leg.waiting for leg in cycle.legs) / HOUR,
        "out": _points(cycle.out.route),
    }


def _points(route: Route) -> list[list[float]]:
    track = route.track
    points: list[list[float]] = np.round(np.column_stack([track.lon, track.lat]), 5).tolist()
    return points


def project_diagrams(result: ProjectResult) -> dict[str, Any]:
    """Return the table, the activities, the tide, the routes and the diagrams of place and time.

    Returns
    -------
    dict
        ``table`` (of van Halem 2019, Table 5.1), ``level`` at the unloading site and, by name,
        ``runs`` with ``activities`` [s since 1970], ``tracks`` [lon, lat] and ``space_time``.
    """
    from thalweg.operations.dredging.project_timeline import activity_periods, site_water_level

    end = max(run.cycles[-1].end for run in result.runs)
    times = np.arange(result.project.start, end + _LEVEL_STEP, _LEVEL_STEP)
    level = site_water_level(result, times)
    runs = {
        run.name: {
            "activities": {
                name: [[round(a), round(b)] for a, b in spans]
                for name, spans in activity_periods(run).items()
            },
            "tracks": [
                {"out": _points(cycle.out.route), "back": _points(cycle.back.route)}
                for cycle in run.cycles
            ],
            "space_time": space_time_facts(result, run),
        }
        for run in result.runs
    }
    known = bool(np.isfinite(level).any())
    tide = (
        {
            "start": times[0],
            "step_s": _LEVEL_STEP,
            "level_m": [rounded_or_none(v, 3) for v in level.tolist()],
        }
        if known
        else None
    )
    return {"table": result.table(), "level": tide, "runs": runs}


def space_time_facts(result: ProjectResult, run: ProjectRun) -> dict[str, Any]:
    """Return where and when the way out of a run is closed, and the ship's lines on it.

    The leg is the one that waits longest, else that with the least clearance.

    Returns
    -------
    dict
        As of `closure_facts`, with the number of the ``cycle``.
    """
    from thalweg.planning.plots.channel_closures import find_closures

    # the choice of the leg to draw: one without a known clearance comes last
    cycle = max(run.cycles, key=lambda c: (c.out.waiting, -np.nan_to_num(c.out.clearance, nan=1e9)))
    route = cycle.out.route
    environment = result.environment
    times = np.linspace(route.depart - _AROUND, route.arrive + _AROUND, TIMES)
    times = times[(times >= result.project.start) & (times <= result.project.end)]
    found = find_closures(
        route,
        ship=environment.loaded(cycle.load_factor).ship,
        sea=environment.sea,
        chart=environment.chart,
        min_ukc=environment.min_ukc,
        times=times,
        places=PLACES,
    )
    along = [c.out.route for c in run.cycles if _same_track(c.out.route, route)]
    lines = [one for one in along if times[0] <= one.arrive and one.depart <= times[-1]]
    return {"cycle": cycle.number, **closure_facts(found, lines)}


def _same_track(one: Route, other: Route) -> bool:
    a, b = one.track, other.track
    return len(a.lat) == len(b.lat) and bool(
        np.allclose(a.lat, b.lat, atol=1e-6) and np.allclose(a.lon, b.lon, atol=1e-6)
    )


def _write_cycles(result: ProjectResult, order: JobOrder) -> None:
    from thalweg.operations.dredging.cycle_records import CYCLE_COLUMNS, cycle_record

    records = [(run.name, cycle_record(cycle)) for run in result.runs for cycle in run.cycles]
    rows = [[name, *(record[key] for key in CYCLE_COLUMNS)] for name, record in records]
    write_csv_rows(order.path / "cycles.csv", [("run", *CYCLE_COLUMNS), *rows])
