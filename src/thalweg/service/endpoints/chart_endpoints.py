"""The chart of the map: cells of the coastline, emission control areas, canals, passages."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any, Final, Literal

import numpy as np
from fastapi import APIRouter, Path, Query, Response

from thalweg.core.units import HOUR
from thalweg.service.coast_map import CELL_SIDES, cell_names, cells_folder
from thalweg.service.endpoints.sea_endpoints import packed_frame, parsed_box
from thalweg.service.problem_details import not_found
from thalweg.service.service_state import State

chart_router = APIRouter(tags=["chart"])
Level = Literal["c", "l", "i"]
#: Where the map names each emission control area: open water in its middle (lon, lat) [deg].
_LABELS: Final[Mapping[str, tuple[float, float]]] = {
    "baltic-sea": (19.2, 56.2),
    "north-sea": (3.2, 56.4),
    "north-america-pacific": (-129.5, 44.0),
    "north-america-atlantic": (-71.0, 37.5),
    "north-america-hawaii": (-158.5, 23.6),
    "us-caribbean": (-65.8, 19.2),
    "mediterranean": (18.3, 34.6),
    "canadian-arctic": (-75.0, 72.5),
    "norwegian-sea": (3.0, 67.0),
    "north-east-atlantic": (-20.0, 58.0),
}
_FOREVER = {"Cache-Control": "private, max-age=31536000, immutable"}


@chart_router.get("/coast/{level}")
def coast_index(state: State, level: Level) -> dict[str, Any]:
    """Return the side of the cells [deg], and the names of those with land.

    The first request of a resolution cuts the coastline, which takes up to half a minute.
    """
    folder = cells_folder(level)
    if not folder.exists():
        state.map_worker.do("coast_cells", level=level)
    return {"side": CELL_SIDES[level], "cells": cell_names(folder)}


@chart_router.get("/coast/{level}/{cell}.json")
def coast_cell(level: Level, cell: str = Path(pattern=r"^\d{1,3}_\d{1,3}$")) -> Response:
    """Return the land of a cell: ``land`` (polygons) and ``coast`` (lines), flat lon, lat [deg]."""
    path = cells_folder(level) / f"{cell}.json.gz"
    if not path.exists():
        raise not_found("cell", cell, "The cells with land are listed at /coast/{level}.")
    headers = {**_FOREVER, "Content-Encoding": "gzip"}
    return Response(path.read_bytes(), media_type="application/json", headers=headers)


@chart_router.get(
    "/chart/depth",
    response_class=Response,
    responses={200: {"content": {"application/octet-stream": {}}}},
)
def chart_depth_frame(
    state: State,
    box: str = Query(max_length=80, examples=["30,60,-80,10"], description="south,north,west,east"),
    nx: int = Query(96, ge=2, le=512),
    ny: int = Query(64, ge=2, le=512),
) -> Response:
    """Return the depth of the global layer [m] as a frame, in the form of /seas/{sea_ids}/frames.

    Points of ETOPO1 at every tenth of a degree, at most 254 m: a picture, no clearance.
    """
    _, data = state.map_worker.do("chart_depth", box=parsed_box(box), nx=nx, ny=ny)
    return packed_frame(data)


@chart_router.get("/chart")
def chart_features() -> dict[str, Any]:
    """Return emission control areas, canals and passages as lines, for the map."""
    return _features()


@cache
def _features() -> dict[str, Any]:
    from thalweg.chart.canals import CANALS
    from thalweg.chart.chart import control_areas_in_force
    from thalweg.chart.zones.emission_control_areas import emission_control_areas

    titles = {area.name: area.title for area in emission_control_areas()}
    areas = []
    for zone in control_areas_in_force().eca:
        rings = [
            np.round(np.column_stack([zone.rings.lon[a:b], zone.rings.lat[a:b]]), 3).tolist()
            for a, b in zip(zone.rings.start[:-1], zone.rings.start[1:])
        ]
        title, label = titles.get(zone.name, zone.name), _LABELS.get(zone.name)
        areas.append({"name": zone.name, "title": title, "rings": rings, "label": label})
    canals = [
        {
            "name": canal.name,
            "title": canal.title,
            "path": [[lon, lat] for lat, lon in canal.path],
            "hours": canal.transit_time / HOUR,
            "fee_usd": canal.fee,
        }
        for canal in CANALS
    ]
    return {"control_areas": areas, "canals": canals}
