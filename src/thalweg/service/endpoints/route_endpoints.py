"""Routes and voyages from files, and the comparison of routes."""

from __future__ import annotations

import json
from itertools import pairwise
from typing import Any, Final

from fastapi import APIRouter, UploadFile
from pydantic import BaseModel, ConfigDict, Field

from thalweg.core.errors import InputError
from thalweg.core.geodesy import distance
from thalweg.core.time import parse_time
from thalweg.core.units import HOUR, NAUTICAL_MILE
from thalweg.service.endpoints.job_endpoints import result_file
from thalweg.service.endpoints.upload_reading import chunks_of, kept_upload
from thalweg.service.jobs.named_uploads import entries_of
from thalweg.service.service_state import ServiceState, State
from thalweg.studies.study_axes import plain_data

routes_router = APIRouter(tags=["routes"])
_MOST_BROKEN = 1000  # limits of a route that are listed
_SAME_END_NM: Final = 1.0  # between ends that are taken as the same place
_FIGURES = (
    "time_h",
    "distance_nm",
    "fuel_t",
    "co2_t",
    "energy_mwh",
    "waiting_h",
    "min_ukc_m",
)


class ComparedRoute(BaseModel):
    """A route of a result: number 1 and up; 0 is the one that ignores the weather."""

    model_config = ConfigDict(extra="forbid")

    job: str = Field(pattern=r"^[0-9a-f]{16}$")
    number: int = Field(1, ge=0, le=9999)


class Comparison(BaseModel):
    """Routes to compare with the first of them."""

    model_config = ConfigDict(
        extra="forbid",
        json_schema_extra={
            "examples": [
                {
                    "routes": [
                        {"job": "0123456789abcdef", "number": 1},
                        {"job": "0123456789abcdef", "number": 0},
                    ]
                }
            ]
        },
    )

    routes: list[ComparedRoute] = Field(min_length=2, max_length=12)


@routes_router.post("/routes", status_code=201)
async def add_route(state: State, file: UploadFile) -> dict[str, Any]:
    """Upload a route as RTZ, RTZP, S-421, GPX, GeoJSON, KML or CSV.

    Returns its waypoints [lat, lon]. ``notes`` names what the file has otherwise than its format,
    and how it was read.
    """

    def facts(path: str) -> dict[str, Any]:
        found, _ = state.file_worker.do("import_route", path=path, name=file.filename or "")
        return found

    stored = await kept_upload(state.routes, file.filename or "", chunks_of(file), facts)
    return stored.as_dict()


@routes_router.get("/routes/{route_id}")
def get_route(state: State, route_id: str) -> dict[str, Any]:
    """Return an uploaded route."""
    return state.routes.get(route_id).as_dict()


class VoyageText(BaseModel):
    """The text of a voyage file."""

    model_config = ConfigDict(
        extra="forbid",
        json_schema_extra={
            "examples": [{"text": "start: Halifax\ngoal: 49.7N 6.5W\ndepart: 1998-08-31T12:00Z\n"}]
        },
    )

    text: str = Field(max_length=1_000_000, description="YAML or JSON")


@routes_router.post("/voyages/read")
def read_voyage(given: VoyageText) -> dict[str, Any]:
    """Return the request of a voyage file: entries of a voyage, or a whole request with them."""
    from thalweg.planning.voyage import Voyage

    data = plain_data(entries_of(given.text, "voyage"))
    request = data if isinstance(data.get("voyage"), dict) else {"voyage": data}
    Voyage.from_dict(request["voyage"])
    return request


@routes_router.post("/compare")
def compare(state: State, request: Comparison) -> dict[str, Any]:
    """Return key figures of routes, and their differences to the first; unknown is null.

    ``notes`` say where a route begins or ends elsewhere than the first, as a route from the berth
    of a port and one from the sea off it do: their figures are not of the same stretch.
    ``approach_nm`` and ``approach_h`` are the part of a route in the approaches of ports.
    """
    rows = [_row(one, state) for one in request.routes]
    first = rows[0]
    for row in rows:
        row["difference"] = {
            name: None if row[name] is None or first[name] is None else row[name] - first[name]
            for name in (*_FIGURES, "cost")
        }
        if row["currency"] != first["currency"]:
            row["difference"]["cost"] = None
        row["notes"] = _other_stretch(row["ends"], first["ends"])
    return {"routes": rows}


def _other_stretch(ends: list[list[float]], first: list[list[float]]) -> list[str]:
    """Return notes on the ends of a route that are not those of the first."""
    notes = []
    for verb, here, there in zip(("begins", "ends"), ends, first):
        apart = float(distance(*here, *there)) / NAUTICAL_MILE
        if apart > _SAME_END_NM:
            notes.append(
                f"It {verb} {apart:.1f} nm from where the first route {verb}: their figures are "
                "not of the same stretch."
            )
    return notes


def _row(one: ComparedRoute, state: ServiceState) -> dict[str, Any]:
    job = state.store.get(one.job)
    route = _route(one, job.kind, state)
    figures = {name: route.get(name) for name in _FIGURES}
    currency = route.get("currency")
    worst = _worst(one, state)
    return {
        "job": one.job,
        "number": one.number,
        "title": job.request.get("title") or "",
        "depart": route["depart"],
        "arrive": route["arrive"],
        "feasible": route["feasible"],
        "violations": len(route["violations"]),
        "broken": [
            {name: one[name] for name in ("reason", "lat", "lon")}
            for one in route["violations"][:_MOST_BROKEN]
        ],
        "ends": [[route["waypoints"][k][name] for name in ("lat", "lon")] for k in (0, -1)],
        "currency": currency,
        "cost": route.get(f"cost_{str(currency).casefold()}"),
        **figures,
        **_in_approaches(route),
        **worst,
    }


def _route(one: ComparedRoute, kind: str, state: ServiceState) -> dict[str, Any]:
    if one.number == 0:
        beside: dict[str, Any] = json.loads(result_file(one.job, "beside.json", state).read_text())
        return beside
    if kind == "evaluation":
        evaluated: dict[str, Any] = json.loads(
            result_file(one.job, "route.json", state).read_text()
        )
        return evaluated
    if kind == "alternatives":
        found = json.loads(result_file(one.job, "alternatives.json", state).read_text())
        routes = [choice["route"] for choice in found["alternatives"]]
    else:
        routes = json.loads(result_file(one.job, "plan.json", state).read_text())["routes"]
    if one.number > len(routes):
        raise InputError(
            f"The plan {one.job} has no route {one.number}.",
            f"It has {len(routes)}.",
            "Choose one of them.",
            field="routes",
        )
    chosen: dict[str, Any] = routes[one.number - 1]
    return chosen


def _in_approaches(route: dict[str, Any]) -> dict[str, float]:
    """Return the length and time of a route in the approaches of ports."""
    rows = route.get("waypoints", ())
    legs = [(a, b) for a, b in pairwise(rows) if a.get("leg_kind") == "approach"]
    timed = [(a["time"], b["time"]) for a, b in legs if a["time"] and b["time"]]
    return {
        "approach_nm": sum(b["distance_nm"] - a["distance_nm"] for a, b in legs),
        "approach_h": sum(parse_time(b) - parse_time(a) for a, b in timed) / HOUR,
    }


def _worst(one: ComparedRoute, state: ServiceState) -> dict[str, float | None]:
    """Return the highest waves and the strongest wind along a route."""
    if one.number == 0:
        profile = json.loads(result_file(one.job, "beside.json", state).read_text())["profile"]
    else:
        name = f"profile_{one.number:02d}.json"
        profile = json.loads(result_file(one.job, name, state).read_text())

    def most(column: str) -> float | None:
        known = [value for value in profile.get(column, ()) if value is not None]
        return max(known) if known else None

    return {
        "highest_waves_m": most("wave_height_m"),
        "strongest_wind_kn": most("wind_speed_kn"),
    }
