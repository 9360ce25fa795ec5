"""Health, ships and ports."""

from __future__ import annotations

from functools import cache
from typing import Any

from fastapi import APIRouter, Query, UploadFile

from thalweg.chart.approaches import PORT_APPROACHES
from thalweg.chart.port_names import normalised_port_name
from thalweg.chart.ports import PORTS, Port
from thalweg.core.errors import InputError
from thalweg.core.geodesy import distance, format_position, parse_position
from thalweg.core.units import NAUTICAL_MILE
from thalweg.service.endpoints.upload_reading import chunks_of, kept_upload
from thalweg.service.service_state import State

catalogue = APIRouter(tags=["catalogue"])


@catalogue.get("/health")
def health(state: State) -> dict[str, Any]:
    """State the version, and how many jobs there are in each state."""
    import thalweg

    limits = state.settings.limits
    return {
        "status": "ok",
        "version": thalweg.__version__,
        "jobs": state.store.counts(),
        "limits": {
            "workers": limits.workers,
            "queue": limits.queue,
            "job_seconds": limits.job_seconds,
            "upload_bytes": limits.upload_bytes,
            "small_upload_bytes": limits.small_upload_bytes,
        },
    }


@catalogue.get("/ships")
def ships(state: State) -> list[dict[str, Any]]:
    """List the ships of the library and the uploaded ones."""
    known = [
        {"id": name, "name": _ship_title(name), "library": True} for name in state.library_ships
    ]
    uploaded = [
        {"id": file.id, "name": file.facts.get("name", file.name), "library": False}
        for file in state.ships.all()
    ]
    return [*known, *uploaded]


@cache
def _ship_title(name: str) -> str:
    from thalweg.ship import Ship, library_names
    from thalweg.ship.file.ship_file import read_ship

    try:
        if name in library_names():
            return str(read_ship(name)[0]["name"])
        return Ship.load(name).name
    except (InputError, ValueError):
        return name


@catalogue.get("/ships/{ship_id}")
def get_ship_sheet(state: State, ship_id: str) -> dict[str, Any]:
    """Return the performance sheet of a ship: power and fuel by speed in calm water, and limits."""
    name = ship_id if ship_id in state.library_ships else str(state.ships.get(ship_id).path)
    sheet, _ = state.file_worker.do("ship_sheet", ship=name)
    return {"id": ship_id, **sheet}


@catalogue.post("/ships", status_code=201)
async def add_ship(state: State, file: UploadFile) -> dict[str, Any]:
    """Upload a ship file (YAML or JSON); it is checked before it is kept."""

    def facts(path: str) -> dict[str, Any]:
        sheet, _ = state.file_worker.do("ship_sheet", ship=path)
        return {"name": sheet["name"]}

    stored = await kept_upload(state.ships, file.filename or "", chunks_of(file), facts)
    return {"id": stored.id, "name": stored.facts["name"], "library": False}


@catalogue.get("/ports")
def ports(
    q: str = Query("", max_length=80, description="beginning or part of a name, or a UN/LOCODE"),
    near: str = Query("", max_length=60, description="latitude,longitude"),
    count: int = Query(12, ge=1, le=4000),
) -> list[dict[str, Any]]:
    """Return ports by name (the best first), or the nearest ones; without both the largest."""
    if near:
        lat, lon = _position(near)
        apart = distance(lat, lon, [p.lat for p in PORTS.all], [p.lon for p in PORTS.all])
        order = sorted(range(len(apart)), key=lambda i: float(apart[i]))[:count]
        return [
            {**_port(PORTS.all[i]), "distance_nm": round(float(apart[i]) / NAUTICAL_MILE, 2)}
            for i in order
        ]
    return [_port(port) for port in _matching(q.strip())[:count]]


def _matching(text: str) -> list[Port]:
    if not text:
        return sorted(PORTS.all, key=lambda port: -port.importance)
    word, code = normalised_port_name(text), text.upper().replace(" ", "")
    meant = PORTS.find(text)  # what the name alone stands for in a request
    ranked = []
    for port, name in _searched_names():
        starts = name.startswith(word)
        if port is meant:
            rank = 0
        elif name == word or port.locode == code:
            rank = 1
        elif starts or (len(word) > 2 and f" {word}" in name):
            rank = 2 if starts else 3
        else:
            continue
        ranked.append((rank, -port.importance, port.name, port))
    return list(dict.fromkeys(row[3] for row in sorted(ranked, key=lambda row: row[:3])))


@cache
def _searched_names() -> list[tuple[Port, str]]:
    named = [(port, normalised_port_name(name)) for name, port, _own in PORTS.names()]
    shown = [(port, normalised_port_name(port.display_name)) for port in PORTS.all]
    return list(dict.fromkeys(named + shown))


def _port(port: Port) -> dict[str, Any]:
    return {
        "name": port.name,
        "display_name": port.display_name,
        "label": port.label,
        "country": port.country_code,
        "locode": port.locode,
        "lat": port.lat,
        "lon": port.lon,
        "size": port.size,
        "importance": port.importance,
    }


def _position(text: str) -> tuple[float, float]:
    position = parse_position(text)
    if position is None:
        raise InputError(
            f"{text!r} is not a position.",
            "A position is LAT,LON in degrees, such as 52.1,3.97.",
            "Give the value in this form.",
            field="near",
        )
    return position


@catalogue.get("/places")
def place(text: str = Query(max_length=120)) -> dict[str, Any]:
    """Say how a place is understood: a position or a port; an error lists the choices."""
    position = parse_position(text)
    if position is not None:
        return {
            "kind": "position",
            "label": format_position(*position),
            "lat": position[0],
            "lon": position[1],
        }
    port = PORTS.lookup(text)
    return {"kind": "port", **_port(port), "approach": _approach(port)}


def _approach(port: Port) -> dict[str, Any] | None:
    """Return the main way from the berth of a port to the open sea; None where it has none."""
    way = PORT_APPROACHES.of(port)
    if way is None:
        return None
    return {
        "berth": way.berth,
        "sea_end": way.sea_end,
        "length_nm": round(way.length / NAUTICAL_MILE, 1),
    }
