"""What happens when in a project: the periods of each activity, and the tide at a site."""

from __future__ import annotations

from typing import Final

import numpy as np

from thalweg.core.types import FloatArray
from thalweg.operations.dredging.project_result import ProjectResult, ProjectRun
from thalweg.sea import standard_names as nm

ACTIVITIES: Final = ("loading", "sailing full", "unloading", "sailing empty", "waiting")


def activity_periods(run: ProjectRun) -> dict[str, list[tuple[float, float]]]:
    """Return start and end of each activity of a run; waits on a route when they take place.

    Returns
    -------
    dict of str to list of (float, float) : By `ACTIVITIES`, in this order [s since 1970].
    """
    spans: dict[str, list[tuple[float, float]]] = {name: [] for name in ACTIVITIES}
    for cycle in run.cycles:
        spans["loading"].append((cycle.start, cycle.out.depart))
        spans["unloading"].append((cycle.out.arrive, cycle.back.depart))
        for name, leg in (("sailing full", cycle.out), ("sailing empty", cycle.back)):
            spans[name].append((leg.depart, leg.arrive))
            track, arrive = leg.route.track, leg.route.legs["arrive"]
            for k in np.flatnonzero(track.wait):
                begin = leg.depart if k == 0 else float(arrive[k - 1])
                spans["waiting"].append((begin, begin + float(track.wait[k])))
    return spans


def site_water_level(result: ProjectResult, times: FloatArray) -> FloatArray:
    """Return the water level at the unloading site.

    Parameters
    ----------
    times : float array (n,) [s since 1970]

    Returns
    -------
    float array (n,) : [m above datum]; NaN where unknown.
    """
    sea, (lat, lon) = result.environment.sea, result.project.sites.unload
    if nm.WATER_LEVEL not in sea.variables:
        return np.full(times.shape, np.nan)
    where = np.full(times.shape, lat), np.full(times.shape, lon)
    return np.asarray(sea.sample([nm.WATER_LEVEL], times, *where)[nm.WATER_LEVEL])
