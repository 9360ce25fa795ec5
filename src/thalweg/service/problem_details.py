"""Errors as problem details (RFC 9457), with what was asked, what is possible and what to do."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

from fastapi import FastAPI, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from pydantic import BaseModel
from starlette.exceptions import HTTPException

from thalweg.core.errors import (
    CoverageError,
    InputError,
    NoRouteError,
    ThalwegError,
    close_matches,
)
from thalweg.core.given_numbers import shortened_repr
from thalweg.planning.voyage import Voyage

MEDIA_TYPE: Final = "application/problem+json"
_TITLES: Final = {
    400: "Bad request",
    401: "Not authorised",
    403: "Not allowed",
    404: "Not found",
    405: "Not possible here",
    409: "In conflict",
    413: "Too large",
    415: "Kind of content not known",
    422: "Not possible",
    429: "Too many jobs",
    507: "Storage full",
}
_PARTS: Final = ("asked", "possible", "remedy")
#: What a number or text in a request must be, by the kind of fault that pydantic states.
_SHAPES: Final = {
    "missing": "is missing",
    "extra_forbidden": "is not a known entry",
    "model_attributes_type": "is no mapping of entries",
    "dict_type": "is no mapping of entries",
}
#: What a value may be, by the kind of fault, with the entries of its context.
_BOUNDS: Final = {
    "greater_than": "It is above {gt:g}.",
    "greater_than_equal": "It is {ge:g} or more.",
    "less_than": "It is below {lt:g}.",
    "less_than_equal": "It is {le:g} or less.",
    "literal_error": "It is {expected}.",
    "float_parsing": "It is a number.",
    "float_type": "It is a number.",
    "int_parsing": "It is a whole number.",
    "int_type": "It is a whole number.",
    "int_from_float": "It is a whole number.",
    "bool_parsing": "It is true or false.",
    "bool_type": "It is true or false.",
    "string_type": "It is a text.",
}
#: What texts of a form may be, by the last name of their place.
_FORMS: Final = {
    "job": "the id of a job (GET /plans lists them)",
    "route": "the id of an uploaded route (POST /routes returns it)",
    "seas": "'calm', 'storm', or the id of an uploaded sea (GET /seas lists them)",
    "sampling": "nearest, nearest:HOURS or step",
}
#: Entries of a request in place of options of the command line, which errors advise.
_ENTRIES: Final = {
    "--arrive": "voyage.arrive",
    "--avoid": "voyage.avoid",
    "--depart": "voyage.depart",
    "--depart-window": "voyage.depart_window",
    "--depth": "depths",
    "--fill": "fill",
    "--fuel-price": "voyage.fuel_price_usd",
    "--hold": "voyage.hold",
    "--load-factor": "load_factor",
    "--no-eca": "eca: false",
    "--no-wait": "voyage.wait: false",
    "--offing": "voyage.offing_nm",
    "--open": "voyage.open",
    "--resolution": "resolution_nm",
    "--speed": "voyage.speed_kn",
    "--traffic": "traffic",
    "--ukc": "voyage.min_ukc_m",
}
_OPTION: Final = re.compile(r"(--[a-z]+(?:-[a-z]+)*)( (?:FILE|NAME|USD)\b)?")


class ServiceError(ThalwegError):
    """An error of the service itself.

    Parameters
    ----------
    status : HTTP status.
    asked, possible, remedy : As in `ThalwegError`.
    """

    def __init__(
        self, status: int, asked: str, possible: str = "", remedy: str = "", **details: Any
    ) -> None:
        self.status = status
        super().__init__(asked, possible, remedy, **details)


def not_found(kind: str, name: str, remedy: str) -> ServiceError:
    """Return the error for something that does not exist."""
    return ServiceError(404, f"There is no {kind} {name!r}.", "", remedy)


def problem_of(error: ThalwegError, status: int = 422) -> dict[str, Any]:
    """Return an error as problem details.

    Parameters
    ----------
    status : HTTP status, if the error states none.

    Returns
    -------
    dict
        ``type``, ``title``, ``status``, ``detail``, ``asked``, ``possible``, ``remedy``,
        ``field`` (of the request, or None), ``reasons`` and ``nearest`` (where no route exists),
        and ``details``.
    """
    plain = error.as_dict()
    plain |= {key: with_entries(plain[key]) for key in _PARTS}
    status = getattr(error, "status", status)
    details = plain["details"]
    problem = {
        "type": f"/problems/{plain['error']}",
        "title": _TITLES.get(status, plain["error"]),
        "status": status,
        "detail": " ".join(plain[key] for key in ("asked", "possible", "remedy") if plain[key]),
        "asked": plain["asked"],
        "possible": plain["possible"],
        "remedy": plain["remedy"],
        "field": details.get("field"),
        "details": details,
    }
    if isinstance(error, NoRouteError):
        problem |= {"reasons": details.get("reasons", {}), "nearest": details.get("nearest")}
    if isinstance(error, (InputError, CoverageError)) and status == 422:
        problem["title"] = "Bad input" if isinstance(error, InputError) else "Not covered by data"
    return problem


def with_entries(text: str) -> str:
    """Return a message with the entries of a request in place of command line options."""
    return _OPTION.sub(lambda found: _ENTRIES.get(found[1], found[0]), text)


def problem_response(
    error: ThalwegError,
    headers: Mapping[str, str] | None = None,
    faults: Sequence[ThalwegError] = (),
) -> JSONResponse:
    """Return an error as a response, with all faults that are known of the request."""
    problem = problem_of(error, 422)
    if problem["status"] in (404, 422) and problem["field"]:
        problem["errors"] = [
            {"field": one.details.get("field")}
            | {key: with_entries(getattr(one, key)) for key in _PARTS}
            for one in faults or [error]
        ]
    return JSONResponse(
        problem, problem["status"], media_type=MEDIA_TYPE, headers=dict(headers or {})
    )


def add_problem_handlers(
    application: FastAPI, faults_of: Callable[[Request, Any], list[ThalwegError]]
) -> None:
    """Make an application answer every error with problem details.

    Parameters
    ----------
    faults_of : Finds all faults of a request with a body; empty for kinds it does not know.
    """

    @application.exception_handler(ThalwegError)
    async def _of_library(request: Request, error: ThalwegError) -> JSONResponse:
        if getattr(error, "status", 0) == 429:
            return problem_response(error, headers={"Retry-After": "10"})
        faults: list[ThalwegError] = []
        if error.details.get("field") and request.method == "POST":
            faults = await run_in_threadpool(faults_of, request, await _body_of(request))
        return problem_response(error, faults=faults)

    @application.exception_handler(RequestValidationError)
    def _of_shape(request: Request, error: RequestValidationError) -> JSONResponse:
        for fault in error.errors():
            if fault["loc"][0] == "path" and fault["type"] == "string_pattern_mismatch":
                return problem_response(_unknown_path(str(fault["loc"][-1]), fault["input"]))
        if (unread := _unread_content(request, error)) is not None:
            return problem_response(unread)
        faults: Sequence[ThalwegError] = faults_of(request, error.body)
        faults = faults or shape_faults(error.errors())
        first = _shape_error(error)
        alike = (one for one in faults if one.details.get("field") == first.details.get("field"))
        first = next(alike, first)  # knows the entries of the request
        first.details["faults"] = len(error.errors())
        return problem_response(first, faults=faults)

    @application.exception_handler(HTTPException)
    def _of_path(request: Request, error: HTTPException) -> JSONResponse:
        asked = {404: f"There is nothing at {request.url.path}."}.get(
            error.status_code, f"{request.method} {request.url.path}: {error.detail}."
        )
        remedy = "The paths are listed at /api/docs and in /openapi.json."
        return problem_response(ServiceError(error.status_code, asked, "", remedy))


def _unread_content(request: Request, error: RequestValidationError) -> ServiceError | None:
    """Return the error for a body that was not read as JSON because of its content type."""
    kind = request.headers.get("content-type", "").partition(";")[0].strip()
    whole = any(tuple(fault["loc"]) == ("body",) for fault in error.errors())
    if not whole or kind == "application/json" or kind.endswith("+json"):
        return None
    return ServiceError(
        415,
        f"The body has the content type {kind[:80]}." if kind else "The body has no content type.",
        "Requests are JSON.",
        "Send it with the header Content-Type: application/json.",
    )


def _unknown_path(name: str, given: str) -> ServiceError:
    """Return the error for a name in a path that nothing can have."""
    kind = name.removesuffix("_id")
    remedy = "Jobs are listed at /api/v1/plans." if kind == "job" else "Correct the path."
    return not_found(kind, given[:80], remedy)


async def _body_of(request: Request) -> Any:
    """Return the body of a request as plain data; None where it is not JSON or was not kept."""
    if not request.headers.get("content-type", "").startswith("application/json"):
        return None
    try:
        return await request.json()
    except (ValueError, RuntimeError):
        return None


def shape_faults(faults: Sequence[Any], model: type[BaseModel] | None = None) -> list[ServiceError]:
    """Return all faults of a request that has not the form of its schema.

    Parameters
    ----------
    faults : As pydantic states them.
    model : Schema of the request, to name the entries that it knows.
    """
    return [_fault_of_shape(one, model) for one in faults]


def _shape_error(error: RequestValidationError) -> ThalwegError:
    """Return the first fault of a request that has not the form of its schema."""
    return _fault_of_shape(error.errors()[0])


def _meant(name: str, model: type[BaseModel]) -> str:
    """Return a question on the entries that an unknown entry of a request may mean, or nothing."""
    near = close_matches(name, model.model_fields)
    if "voyage" in model.model_fields:
        entries = list(Voyage.__dataclass_fields__)
        of_voyage = [name] if name in entries else close_matches(name, entries)
        near = [f"voyage.{one}" for one in of_voyage] or near
    return f"Did you mean {' or '.join(near)}?" if near else ""


def _fault_of_shape(first: Any, model: type[BaseModel] | None = None) -> ServiceError:
    place = [str(part) for part in first["loc"] if part not in ("body", "query", "path", "header")]
    if first["type"] == "json_invalid":
        why = (first.get("ctx") or {}).get("error", first["msg"])
        return ServiceError(
            422,
            f"The body of the request is not JSON: {why} at character {place[-1]}.",
            "The form of requests is in /openapi.json, with examples.",
            "Correct the request.",
        )
    name = ".".join(place) or "The body"
    what = _SHAPES.get(first["type"], f"is not possible: {first['msg']}")
    possible = "The form of requests is in /openapi.json, with examples."
    remedy = f"Correct {name}." if place else "Correct the request."
    if first["type"] == "missing":
        remedy = f"Add {name if place else 'it'}."
        entry = None if model is None or len(place) != 1 else model.model_fields.get(place[0])
        if entry is not None and entry.description:
            possible = f"It is needed: {entry.description}."
    if first["type"] == "extra_forbidden" and model is not None and len(place) == 1:
        remedy = _meant(place[0], model) or f"Leave {name} out."
        possible = f"A request has the entries {', '.join(sorted(model.model_fields))}."
    if first["type"] in ("too_short", "too_long"):
        given, context = first["input"], first["ctx"]
        least, most = context.get("min_length"), context.get("max_length")
        what = f"has {len(given)} {'entry' if len(given) == 1 else 'entries'}"
        possible = (
            f"It has at least {least}."
            if first["type"] == "too_short"
            else (f"It has at most {most}.")
        )
    if first["type"] in _BOUNDS:
        what = f"is {shortened_repr(first['input'])}"
        possible = _BOUNDS[first["type"]].format(**first.get("ctx") or {})
        if first["type"] == "string_type" and place[-1:] == ["ship"]:
            possible = "It is the id of a ship (GET /ships lists them, POST /ships adds a file)."
    if first["type"] == "string_pattern_mismatch":
        kind = next((part for part in reversed(place) if not part.isdigit()), "")
        known = _FORMS.get(kind, f"a text of the pattern {first['ctx']['pattern']}")
        what = f"is {shortened_repr(first['input'])}; it is {known}"
    return ServiceError(
        422,
        f"{name} {what}.",
        possible,
        remedy,
        field=name if place else None,
    )
