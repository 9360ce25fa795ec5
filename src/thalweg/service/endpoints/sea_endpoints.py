"""Seas: uploads, what they hold, and frames of their fields."""

from __future__ import annotations

import gzip
from pathlib import Path
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Query, Request, Response

from thalweg.core.errors import InputError
from thalweg.core.time import parse_time
from thalweg.service.endpoints.upload_reading import kept_upload
from thalweg.service.jobs.plan_request import EMBEDDED_SEAS
from thalweg.service.problem_details import ServiceError
from thalweg.service.service_state import State

seas_router = APIRouter(tags=["seas"])
_NAMES = {
    "calm": "Calm sea: no wind, waves and currents anywhere",
    "storm": "Storm of 1998: wind and waves modelled from the track of Danielle",
}


@seas_router.get("/seas")
def seas(state: State) -> list[dict[str, Any]]:
    """List the embedded seas and the uploaded ones."""
    embedded = [sea(state, name) for name in EMBEDDED_SEAS]
    return [*embedded, *(file.as_dict() for file in state.seas.all())]


@seas_router.get("/seas/{sea_id}")
def sea(state: State, sea_id: str) -> dict[str, Any]:
    """Say what a sea holds: variables, box, period."""
    if sea_id in EMBEDDED_SEAS:
        if sea_id not in state.embedded_facts:
            state.embedded_facts[sea_id], _ = state.map_worker.do(
                "inspect", seas=[sea_id], files={}
            )
        facts = state.embedded_facts[sea_id]
        return {"id": sea_id, "name": _NAMES[sea_id], "embedded": True, **facts}
    return state.seas.get(sea_id).as_dict()


@seas_router.post(
    "/seas",
    status_code=201,
    openapi_extra={
        "requestBody": {
            "required": True,
            "content": {
                "application/octet-stream": {"schema": {"type": "string", "format": "binary"}}
            },
        }
    },
)
async def add_sea(
    state: State,
    request: Request,
    name: str = Query(max_length=255, examples=["waves.nc"], description="name of the file"),
    variables: Annotated[
        list[str],
        Query(max_length=30, description="QUANTITY=VARIABLE, where names are not recognised"),
    ] = [],  # noqa: B006 FastAPI copies it
) -> dict[str, Any]:
    """Upload a NetCDF or GRIB file as the body of the request.

    It is written to the disk while it arrives, and inspected in a process of its own. Variables
    that are named with it need not be named in the requests that use it.
    """
    named = _named_variables(variables)

    def facts(path: str) -> dict[str, Any]:
        found, _ = state.file_worker.do(
            "inspect", seas=["file"], files={"file": path}, variables=named, in_detail=True
        )
        if named:
            found["named"] = named
        own = f"{Path(path).name}: "  # the name of the file while it arrives
        missing = found["missing_fraction"].items()
        found["missing_fraction"] = {key.removeprefix(own): share for key, share in missing}
        return found

    stored = await kept_upload(state.seas, name, request.stream(), facts)
    return stored.as_dict()


@seas_router.delete("/seas/{sea_id}", status_code=204)
def delete_sea(state: State, sea_id: str) -> None:
    """Remove an uploaded sea."""
    if sea_id in EMBEDDED_SEAS:
        raise ServiceError(
            409,
            f"The sea {sea_id!r} is part of the package.",
            "Uploaded seas can be removed.",
            "Leave it; it takes no room.",
        )
    state.seas.delete(sea_id)


@seas_router.get(
    "/seas/{sea_ids}/frames",
    response_class=Response,
    responses={200: {"content": {"application/octet-stream": {}}}},
)
def sea_frame(
    state: State,
    sea_ids: str,
    variable: Literal["waves", "wind", "current", "ice", "depth"],
    time: str = Query(max_length=40, examples=["1998-08-31T12:00Z"]),
    box: str = Query(max_length=80, examples=["30,60,-80,10"], description="south,north,west,east"),
    nx: int = Query(96, ge=2, le=512),
    ny: int = Query(64, ge=2, le=512),
) -> Response:
    """Return a field at one time on a raster of Mercator rows, as 16-bit integers.

    The header has 32 bytes: ``TWF1``, nx, ny, number of fields, 0 (16-bit each), scale, south,
    north, west, east (32-bit floats). Rows run from north to south; -32768 is unknown.
    """
    names = sea_ids.split("+")[:20]
    files = {n: str(state.seas.get(n).path) for n in names if n not in EMBEDDED_SEAS}
    named = state.named_variables(names)
    _, data = state.map_worker.do(
        "frame",
        seas=names,
        files=files,
        variables=named,
        variable=variable,
        time=parse_time(time),
        box=parsed_box(box),
        nx=nx,
        ny=ny,
    )
    return packed_frame(data)


def _named_variables(given: list[str]) -> dict[str, str]:
    """Return the variable of each quantity that an upload names."""
    found = {}
    for text in given:
        quantity, equals, variable = (part.strip() for part in text.partition("="))
        if not (quantity and equals and variable):
            raise InputError(
                f"variables is {text[:100]!r}.",
                "It is QUANTITY=VARIABLE, such as eastward_wind=u, once for each quantity.",
                "Correct it.",
                field="variables",
            )
        found[quantity] = variable
    return found


def packed_frame(data: bytes) -> Response:
    """Return the answer that holds a frame."""
    headers = {"Content-Encoding": "gzip", "Cache-Control": "private, max-age=86400, immutable"}
    packed = gzip.compress(data, 4, mtime=0)
    return Response(packed, media_type="application/octet-stream", headers=headers)


def parsed_box(text: str) -> list[float]:
    """Return south, north, west and east [deg] of a text.

    Raises
    ------
    InputError
        If it holds no box that is possible.
    """
    try:
        south, north, west, east = (float(part) for part in text.split(","))
    except ValueError:
        south = north = west = east = float("nan")
    if not (-89.0 <= south < north <= 89.0 and -720.0 <= west < east <= west + 360.0 <= 1080.0):
        raise InputError(
            f"The box {text!r} is not possible.",
            "It is south,north,west,east in degrees: within 89 S to 89 N, at most 360 wide.",
            "Correct it.",
            field="box",
        )
    return [south, north, west, east]
