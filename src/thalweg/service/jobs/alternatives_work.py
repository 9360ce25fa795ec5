"""The work of a job that compares routes of a voyage that differ."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from thalweg.core.errors import NoRouteError
from thalweg.service.jobs.job_order import JobOrder, StageMessages
from thalweg.service.jobs.plan_request import AlternativesRequest
from thalweg.service.jobs.request_objects import network_of, open_world
from thalweg.service.jobs.route_results import route_totals, write_route_result

if TYPE_CHECKING:
    from thalweg.planning import Plan, Voyage

_WORDS: Final = {
    "time": "least time",
    "distance": "the shortest distance",
    "fuel": "least fuel",
    "comfort": "least motion sickness",
    "encounters": "fewest encounters",
    "inshore": "the least length near land",
    "weighted": "a weighted sum",
}


def plan_alternatives(order: JobOrder, stages: StageMessages) -> tuple[str, dict[str, Any]]:
    """Plan routes that differ, and write their files.

    Returns
    -------
    state : str
        ``done``, or ``cancelled`` with the routes found until then.
    summary : dict
        Key figures of the fastest one.
    """
    from thalweg.planning import alternative_plans
    from thalweg.route import RouteFileOptions
    from thalweg.route.formats import ROUTE_FORMATS

    request = AlternativesRequest.model_validate(order.request)
    voyage = request.checked_voyage()
    planner = AlternativePlanner(order, request, stages)
    found = alternative_plans(voyage, planner, most=request.most)
    stages("writing the files")
    ends = planner.ends
    options = RouteFileOptions(start=ends[0], goal=ends[1], formats=ROUTE_FORMATS)
    for number, choice in enumerate(found.choices, start=1):
        write_route_result(choice.route, order.path, number, options)
    provenance = {"from": ends[0], "to": ends[1]}
    result = {**found.to_dict(), "cancelled": planner.stopped, "provenance": provenance}
    order.write_json("alternatives.json", result)
    best = found.choices[0].route
    summary = {
        **provenance,
        "routes": len(found.choices),
        "feasible": best.feasible,
        "cancelled": planner.stopped,
        "seconds": stages.seconds(),
        **route_totals(best),
    }
    return "cancelled" if planner.stopped else "done", summary


class AlternativePlanner:
    """Plans the voyages that `alternative_plans` requests; when stopped, it plans no more.

    Attributes
    ----------
    stopped : Whether the job was stopped after a first route.
    ends : Start and goal in words.
    """

    def __init__(
        self, order: JobOrder, request: AlternativesRequest, stages: StageMessages
    ) -> None:
        stages("reading the ship, the sea and the coastline")
        self._world = open_world(request, order.files)
        self._network = network_of(request, order.files)
        self._request = request
        self._stages = stages
        self.stopped = False
        self.ends = ("", "")

    def __call__(self, voyage: Voyage) -> Plan:
        """Return a plan.

        Raises
        ------
        NoRouteError
            If there is no route, or the job was stopped.
        KeyboardInterrupt
            If it was stopped before the first route.
        """
        from thalweg.planning import plan

        if self.stopped:
            raise _stopped()
        self._stages(f"planning for {_WORDS[voyage.objective]}")
        try:
            found = plan(
                voyage,
                ship=self._world.ship,
                sea=self._world.sea,
                chart=self._world.chart,
                network=self._network,
                resolution=self._request.resolution_m,
                proof=0.0,
                progress=self._stages,
            )
        except KeyboardInterrupt:
            if not self.ends[0]:
                raise
            self.stopped = True
            raise _stopped() from None
        self.stopped = found.cancelled
        start, goal = (str(found.provenance.get(key) or "") for key in ("from", "to"))
        self.ends = (start, goal)
        return found


def _stopped() -> NoRouteError:
    return NoRouteError("the job was stopped before.", "", "")
