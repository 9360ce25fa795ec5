"""Checks of an order before it becomes a job: what is known to be impossible.

The known facts are those of its ship and seas.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache
from typing import Any

from thalweg.core.errors import InputError, OutsidePeriodError, errors_about
from thalweg.core.given_numbers import shortened_repr
from thalweg.core.time import format_time, parse_time
from thalweg.core.units import KNOT
from thalweg.operations.dredging import Project
from thalweg.planning.request.ordered_speed import with_exact_speed, with_order
from thalweg.planning.voyage import Voyage
from thalweg.sea.fill_policies import variables_filled
from thalweg.service.jobs.named_uploads import ESTUARY, named_uploads
from thalweg.service.jobs.plan_request import EvaluationRequest, PlanRequest, ShipAndSea
from thalweg.service.jobs.request_objects import open_seas, open_ship_of
from thalweg.service.jobs.sea_facts import sea_facts
from thalweg.service.problem_details import ServiceError
from thalweg.service.service_state import ServiceState
from thalweg.studies import Study
from thalweg.studies.study_axes import fill_policies

_WITHOUT_TIMES = ("sea_floor_depth",)  # begins the names of variables that do not change


def check_plan(request: PlanRequest, state: ServiceState) -> dict[str, Any]:
    """Return the request of a plan as plain data, after all checks that are quick."""
    voyage = request.checked_voyage()
    given = with_files(request, state)
    check_plan_order(request, voyage, state)
    return given


def check_evaluation(request: EvaluationRequest, state: ServiceState) -> dict[str, Any]:
    """Return the request of an evaluation as plain data, after all checks that are quick."""
    request.check()
    given = with_files(request, state)
    check_evaluation_order(request, state)
    return given


def with_files(request: ShipAndSea, state: ServiceState) -> dict[str, Any]:
    """Return a request as plain data, with the variables that were named with its seas."""
    given = request.model_dump(mode="json")
    check_files(given, state)
    given["variables"] = state.named_variables(request.seas) | given["variables"]
    return given


def check_files(request: dict[str, Any], state: ServiceState) -> None:
    """Raise an error at its field for a ship, sea or route that does not exist."""
    library = state.library_ships
    for ship in named_uploads(request).ships:
        if ship in library:
            continue
        try:
            state.ships.get(ship)
        except ServiceError:
            raise InputError(
                f"There is no ship {ship[:100]!r}.",
                f"Known: {', '.join(library)}, and uploaded ships.",
                "Choose one of these, or upload a ship file.",
                field="ship",
            ) from None
    try:
        state.files_of(request)
    except ServiceError as error:
        kinds = {"route": "route", "traffic": "traffic", "history network": "history"}
        missing = (kinds[kind] for kind in kinds if error.asked.startswith(f"There is no {kind} "))
        error.details["field"] = next(missing, "seas")
        raise


def check_plan_order(request: PlanRequest, voyage: Voyage, state: ServiceState) -> None:
    """Check that a voyage is at sea, the ship has its speed and the seas its departure.

    Raises
    ------
    InputError : If a place cannot be reached on the chart, or the ship does not have the speed.
    OutsidePeriodError : If no sea has data at the departure.
    """
    places = request.model_dump(mode="json", include={"voyage", "coast", "areas"})
    state.place_worker.do("check_places", **places)
    if voyage.speed_kn is not None:
        with errors_about("speed_kn"):
            with_order(open_ship_of(request, _ship_files(request.ship, state)), voyage)
    if not voyage.departure_is_open:
        times = voyage.earliest_departure, voyage.latest_departure
        filled = variables_filled(request.fill_policies)
        _check_period(times, request.seas, state, "depart", filled)


def check_evaluation_order(request: EvaluationRequest, state: ServiceState) -> None:
    """Check that the ship has the speed and the seas the departure of a route.

    Raises
    ------
    InputError : If the ship does not have the speed, or the route has no departure.
    OutsidePeriodError : If no sea has data at the departure.
    """
    if request.speed_kn is not None:
        with errors_about("speed_kn"):
            ship = open_ship_of(request, _ship_files(request.ship, state))
            with_exact_speed(ship, request.speed_kn, request.hold)
    given = request.depart or state.routes.get(request.route).facts.get("depart")
    if given is not None:
        filled = variables_filled(request.fill_policies)
        _check_period((parse_time(given),) * 2, request.seas, state, "depart", filled)


def check_project_order(project: Project, sea: str | Sequence[str], state: ServiceState) -> None:
    """Check that a sea of a project has data at its start.

    Raises
    ------
    OutsidePeriodError : If none has.
    """
    seas = [sea] if isinstance(sea, str) else sea
    _check_period((project.start, project.start), seas, state, "start")


def check_study_order(study: Study, state: ServiceState) -> None:
    """Check that the seas of a study have data at the departure of one of its voyages at least.

    Voyages that cannot be planned are rows with a refusal; a study of nothing else is refused.

    Raises
    ------
    InputError : If no ship of the study reaches one of its speeds.
    OutsidePeriodError : If no voyage departs within the data.
    """
    _check_speeds(study, state)
    first: OutsidePeriodError | None = None
    tried = set()
    for row in study.rows():
        sea, depart = row.request.get("sea"), row.request["voyage"].get("depart")
        if sea is None or depart is None:
            return
        seas, filled = _sea_names(sea), variables_filled(fill_policies(row.request.get("fill")))
        if (seas, depart, filled) in tried:
            continue
        tried.add((seas, depart, filled))
        try:
            _check_period((parse_time(depart),) * 2, seas, state, "depart", filled)
        except OutsidePeriodError as error:
            first = first or error
        else:
            return
    if first is not None:
        raise first


def _sea_names(given: Any) -> tuple[str, ...]:
    """Return the names of the sea of a row: one, or a list by priority."""
    names = given if isinstance(given, list) else [given]
    if not names or not all(isinstance(name, str) for name in names):
        raise InputError(
            f"The sea of a voyage of the study is {shortened_repr(given)}.",
            "It is calm, storm, the id of an uploaded sea, or a list of them by priority.",
            "Correct it: Thalweg never assumes calm weather.",
            field="sea",
        )
    return tuple(names)


def _check_speeds(study: Study, state: ServiceState) -> None:
    """Check that for every speed of a study one of its ships is as fast.

    Raises
    ------
    InputError : If no ship of the study reaches one of the speeds.
    """
    from thalweg.studies.row_runner import ship_of_request
    from thalweg.studies.study_checks import canonical_json

    refusals: dict[float, InputError] = {}
    reached, tried = set(), set()
    for row in study.rows():
        request, given = row.request, row.request["voyage"]
        speed, named = given.get("speed_kn"), request.get("ship")
        key = canonical_json([named, request.get("load_factor"), speed, given.get("hold")])
        if speed is None or key in tried:
            continue
        tried.add(key)
        files = _ship_files(named, state) if isinstance(named, str) else {}
        try:
            ship = ship_of_request({**request, "ship": files.get(str(named), named)}, "")
            voyage = Voyage.from_dict(given)
            if (voyage.speed_kn or 0.0) * KNOT > max(ship.speeds):  # slower ones: refusals of rows
                with errors_about("speed_kn"):
                    with_order(ship, voyage)
            reached.add(speed)
        except InputError as refusal:
            refusals.setdefault(speed, refusal)
    for speed, why in refusals.items():
        if speed not in reached:
            raise why


def _ship_files(ship: str, state: ServiceState) -> dict[str, str]:
    if ship in state.library_ships:
        return {}
    return {ship: str(state.ships.get(ship).path)}


def _check_period(
    departure: tuple[float, float],
    seas: Sequence[str],
    state: ServiceState,
    field: str,
    filled: frozenset[str] = frozenset(),
) -> None:
    """Check that seas have data at the earliest and the latest departure.

    A sea without times, which holds always, makes every departure possible. Variables that are
    ``filled`` at all times need no data.
    """
    periods = []
    for name in seas:
        facts = _facts(name, state)
        needed = set(facts["variables"]) - filled
        if all(one.startswith(_WITHOUT_TIMES) for one in needed):
            continue
        if facts["start"] is None or facts["end"] is None:
            return
        periods.append((parse_time(facts["start"]), parse_time(facts["end"])))
    end = max((last for _, last in periods), default=math.inf)
    begun = any(first <= departure[0] < last for first, last in periods)
    if not periods or (begun and departure[1] < end):
        return
    outside = departure[1] if departure[1] >= end else departure[0]
    known = [f"{format_time(first)} to {format_time(last)}" for first, last in sorted(periods)]
    raise OutsidePeriodError(
        f"Departure {format_time(outside)} is outside the data.",
        f"The data run from {', and from '.join(known)}.",
        "Choose a departure in that period, or add data.",
        field=field,
    )


def _facts(name: str, state: ServiceState) -> dict[str, Any]:
    if name == ESTUARY:
        return {"variables": [name], "start": None, "end": None}
    if name in ("calm", "storm"):
        return _embedded_facts(name)
    return state.seas.get(name).facts


@cache
def _embedded_facts(name: str) -> dict[str, Any]:
    return sea_facts(open_seas([name], {}))
