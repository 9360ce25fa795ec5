"""The description of the interface: `/openapi.json` with answers and errors of every operation."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi

from thalweg.service.answers.answer_descriptions import answer_content, answer_schemas
from thalweg.service.endpoints.job_endpoints import ROUTE_MEDIA_TYPES
from thalweg.service.problem_details import MEDIA_TYPE

_TEXT: Final = {"type": "string"}
_PROBLEM: Final[dict[str, Any]] = {
    "type": "object",
    "description": "Problem details (RFC 9457).",
    "required": ["type", "title", "status", "detail", "asked", "possible", "remedy", "field"],
    "properties": {
        "type": _TEXT,
        "title": _TEXT,
        "status": {"type": "integer"},
        "detail": {**_TEXT, "description": "asked, possible and remedy as one text"},
        "asked": {**_TEXT, "description": "what was requested"},
        "possible": {**_TEXT, "description": "what is possible"},
        "remedy": {**_TEXT, "description": "what to do"},
        "field": {
            "type": ["string", "null"],
            "description": "entry of the request that is wrong",
        },
        "errors": {
            "type": "array",
            "description": "every fault of the request that can be found at once; its field is a "
            "path in the body, such as voyage.speed_kn",
            "items": {
                "type": "object",
                "properties": {
                    "field": {"type": ["string", "null"]},
                    "asked": _TEXT,
                    "possible": _TEXT,
                    "remedy": _TEXT,
                },
            },
        },
        "details": {"type": "object"},
        "reasons": {"type": "object", "description": "why there is no route, by count"},
        "nearest": {"description": "how far a route comes, where there is none"},
    },
    "examples": [
        {
            "type": "/problems/InputError",
            "title": "Bad input",
            "status": 422,
            "detail": "There is no ship 'titanic'. Known: handysize-bulker. Choose one of these.",
            "asked": "There is no ship 'titanic'.",
            "possible": "Known: handysize-bulker.",
            "remedy": "Choose one of these.",
            "field": "ship",
            "details": {"field": "ship"},
        }
    ],
}
_MEANINGS: Final = {
    "401": "The token is missing or wrong.",
    "403": "The host or the origin is not the service's own.",
    "404": "It does not exist, or the request names something that does not.",
    "409": "The job has no result yet, or another request uses this key.",
    "413": "The body is too large.",
    "415": "The ending of the file, or the content type of the request, is not known.",
    "422": "The request is not possible; `field` names the entry.",
    "429": "The queue of jobs is full; `Retry-After` says when to try again.",
    "507": "The storage is full.",
}
#: Operations that start jobs, by the end of their path.
_STARTS: Final = ("plans", "alternatives", "evaluate", "projects", "studies", "forecasts")
_UPLOADS: Final = ("ships", "seas", "routes", "traffic", "histories")


def describe_answers(application: FastAPI) -> None:
    """Make an application state the answers of every operation, with examples and its errors."""

    def described() -> dict[str, Any]:
        if application.openapi_schema is None:
            found = get_openapi(
                title=application.title,
                version=application.version,
                description=application.description,
                routes=application.routes,
            )
            components = found.setdefault("components", {})
            schemas = components.setdefault("schemas", {})
            for name in ("HTTPValidationError", "ValidationError"):
                schemas.pop(name, None)
            schemas |= {"Problem": _PROBLEM, **answer_schemas()}
            components["securitySchemes"] = {"token": {"type": "http", "scheme": "bearer"}}
            found["security"] = [{"token": []}]
            for path, methods in found["paths"].items():
                for method, operation in methods.items():
                    _describe_success(f"{method} {path.removeprefix('/api/v1')}", operation)
                    for status in _errors_of(path, method, operation):
                        operation["responses"][status] = _answer(status)
            application.openapi_schema = found
        return application.openapi_schema

    application.openapi = described  # type: ignore[method-assign]


def _describe_success(name: str, operation: dict[str, Any]) -> None:
    """State the form and examples of the answer of an operation; one of 204 has none."""
    status = next(code for code in operation["responses"] if code.startswith("2"))
    if status != "204":
        content = answer_content(name)
        if name.endswith("/routes/{number}.{form}"):
            others = set(ROUTE_MEDIA_TYPES.values()) - set(content)
            content |= {kind: {"schema": {"type": "string"}} for kind in sorted(others)}
        operation["responses"][status]["content"] = content


def _answer(status: str) -> dict[str, Any]:
    schema = {"$ref": "#/components/schemas/Problem"}
    return {"description": _MEANINGS[status], "content": {MEDIA_TYPE: {"schema": schema}}}


def _errors_of(path: str, method: str, operation: Mapping[str, Any]) -> list[str]:
    """Return the error statuses of an operation."""
    last = path.rpartition("/")[2]
    found = ["401", "403"]
    if "{" in path or "requestBody" in operation:
        found.append("404")
    if operation.get("parameters") or "requestBody" in operation:
        found.append("422")
    if method == "post":
        found.append("413")
        if last in _STARTS:
            found += ["409", "415", "429"]
        if last in _UPLOADS:
            found += ["415", "507"]
    elif (method == "delete" and path.startswith("/api/v1/seas/")) or (
        path.startswith("/api/v1/plans/{job_id}/") and last != "events"
    ):
        found.append("409")
    return found
