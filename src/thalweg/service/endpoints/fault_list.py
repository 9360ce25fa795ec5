"""All faults of a request: each is repaired in a copy, and the copy is checked again."""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping
from typing import Any, Final

from fastapi import Request
from pydantic import BaseModel, ValidationError

from thalweg.core.errors import ThalwegError
from thalweg.planning.voyage import Voyage
from thalweg.service.endpoints.order_checks import check_evaluation, check_plan
from thalweg.service.jobs.plan_request import AlternativesRequest, EvaluationRequest, PlanRequest
from thalweg.service.problem_details import shape_faults
from thalweg.service.service_state import ServiceState

_MOST: Final = 20  # faults of one request
#: What takes the place of a faulty entry that a request must have.
_NEEDED: Final[Mapping[str, Any]] = {
    "ship": "handysize-bulker",
    "seas": ["calm"],
    "voyage": {"start": "47.0N 20.0W", "goal": "47.2N 19.5W", "depart": "1998-08-31T12:00Z"},
}
#: Entries that mean nothing without the one that was faulty.
_FOLLOWERS: Final[Mapping[str, tuple[str, ...]]] = {
    "ship": ("load_factor", "limits", "voyage.speed_kn", "voyage.hold", "speed_kn", "hold"),
    "seas": ("fill", "variables", "sampling", "average_over_m"),
    "voyage.depart": ("voyage.depart_window", "voyage.arrive_by", "voyage.arrive"),
    "voyage.start": ("voyage.via", "charges"),
    "voyage.goal": ("voyage.via", "charges"),
}
_CHECKS: Final[Mapping[str, tuple[type[BaseModel], Callable[[Any, ServiceState], object]]]] = {
    "/plans": (PlanRequest, check_plan),
    "/alternatives": (AlternativesRequest, check_plan),
    "/evaluate": (EvaluationRequest, check_evaluation),
}


def faults_of_request(request: Request, given: Any) -> list[ThalwegError]:
    """Return every fault of a request that can be found without doing the job.

    Parameters
    ----------
    given : Body of the request as plain data.

    Returns
    -------
    list of ThalwegError
        Each with its ``field`` in the details, as a path in the body such as ``voyage.speed_kn``;
        empty for requests of other kinds.
    """
    kind = next((name for name in _CHECKS if request.url.path.endswith(name)), None)
    if kind is None or not isinstance(given, dict):
        return []
    model, check = _CHECKS[kind]
    body, found = copy.deepcopy(given), dict[str, ThalwegError]()
    while len(found) < _MOST:
        faults = _faults_now(model, check, body, request.app.state.service)
        fresh = {path: fault for path, fault in faults.items() if path not in found}
        found |= fresh
        if not fresh or not all(_repaired(body, path) for path in fresh):
            break
    return list(found.values())


def _faults_now(
    model: type[BaseModel],
    check: Callable[[Any, ServiceState], object],
    body: dict[str, Any],
    state: ServiceState,
) -> dict[str, ThalwegError]:
    """Return the faults of one check by their paths."""
    try:
        check(model.model_validate(body), state)
    except ValidationError as error:
        return {str(fault.details["field"]): fault for fault in shape_faults(error.errors(), model)}
    except ThalwegError as fault:
        path = _path_of(str(fault.details.get("field") or ""), body)
        fault.details["field"] = path or None
        return {path: fault}
    return {}


def _path_of(field: str, body: Mapping[str, Any]) -> str:
    """Return the path of a field in the body: entries of a voyage are inside ``voyage``."""
    voyage = body.get("voyage")
    given = isinstance(voyage, Mapping) and field in voyage
    name = field if given else {"speed": "speed_kn"}.get(field, field)
    first = name.partition(".")[0]
    inside = isinstance(voyage, Mapping) and (first in voyage or first in _VOYAGE_ENTRIES)
    return f"voyage.{name}" if inside and first not in body else name


_VOYAGE_ENTRIES: Final = frozenset(Voyage.__dataclass_fields__)


def _repaired(body: dict[str, Any], path: str) -> bool:
    """Take the faulty entry of a body away, or put a possible one in its place."""
    if not path:
        return False
    for name in _FOLLOWERS.get(path.partition(".")[0] if path.startswith("seas") else path, ()):
        _take(body, name.split("."))
    parts = path.split(".")
    if parts[0] in _NEEDED and parts[0] != "voyage":
        body[parts[0]] = copy.deepcopy(_NEEDED[parts[0]])
        return True
    if parts[0] == "voyage" and not isinstance(body.get("voyage"), dict):
        body["voyage"] = dict(_NEEDED["voyage"])
        return True
    if parts[0] == "voyage" and len(parts) > 1 and parts[1] in _NEEDED["voyage"]:
        body["voyage"][parts[1]] = _NEEDED["voyage"][parts[1]]
        return True
    return _take(body, parts)


def _take(body: dict[str, Any], parts: list[str]) -> bool:
    """Remove an entry, or the nearest one around it that can be removed."""
    place: Any = body
    for depth, part in enumerate(parts):
        if not isinstance(place, dict) or part not in place:
            return False
        inner = place[part]
        if depth == len(parts) - 1 or not isinstance(inner, dict):
            del place[part]
            return True
        place = inner
    return False
