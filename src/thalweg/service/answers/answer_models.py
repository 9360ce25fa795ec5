"""The form of answers about ships, ports, seas, files and jobs, for `/openapi.json`."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field


class AnswerModel(BaseModel):
    """An answer with these entries and no others."""

    model_config = ConfigDict(extra="forbid")


class OpenAnswer(BaseModel):
    """An answer with these entries and perhaps more."""

    model_config = ConfigDict(extra="allow")


class ServiceLimitsAnswer(AnswerModel):
    """What the service takes at most."""

    workers: int = Field(description="jobs at work at the same time")
    queue: int = Field(description="jobs that wait")
    job_seconds: float
    upload_bytes: int = Field(description="of the file of a sea")
    small_upload_bytes: int = Field(description="of every other file or body")


class HealthAnswer(AnswerModel):
    """The version, and how many jobs there are in each state."""

    status: Literal["ok"]
    version: str
    jobs: dict[str, int]
    limits: ServiceLimitsAnswer


class ShipEntry(AnswerModel):
    """A ship of the library, or an uploaded one."""

    id: str
    name: str
    library: bool


class ShipSheetAnswer(OpenAnswer):
    """The performance sheet of a ship; a ship of a speed field has its limits alone."""

    id: str
    name: str
    limits: dict[str, float | None]
    conditions: list[dict[str, Any]] = Field([], description="fuel and power by speed")
    settings: list[dict[str, Any]] = []
    missing: list[str] = Field([], description="what the ship file lacks, and for what")


class PortAnswer(AnswerModel):
    """A port."""

    name: str
    display_name: str
    label: str
    country: str
    locode: str | None
    lat: float
    lon: float
    size: str
    importance: int
    distance_nm: float | None = Field(None, description="from `near`; otherwise left out")


class ApproachAnswer(AnswerModel):
    """The main way from the berth of a port to the open sea, positions as [lat, lon]."""

    berth: tuple[float, float]
    sea_end: tuple[float, float]
    length_nm: float


class PlaceAnswer(OpenAnswer):
    """How a place is understood: a position or a port."""

    kind: Literal["position", "port"]
    label: str
    lat: float
    lon: float
    approach: ApproachAnswer | None = Field(None, description="of ports; null where none is known")


class CoastIndexAnswer(AnswerModel):
    """The cells of the coastline."""

    side: float = Field(description="of a cell [deg]")
    cells: list[str]


class CoastCellAnswer(AnswerModel):
    """The land of a cell; flat lists of longitude and latitude [deg]."""

    land: list[list[list[float]]]
    coast: list[list[float]]


class ChartAnswer(AnswerModel):
    """Emission control areas and canals as lines [lon, lat]."""

    control_areas: list[dict[str, Any]]
    canals: list[dict[str, Any]]


class UploadedFile(OpenAnswer):
    """An uploaded file: its id, name and size, and what was found in it."""

    id: str
    name: str
    bytes: int


class TrafficAnswer(UploadedFile):
    """A file of ship traffic."""

    zones: list[str]
    grids: int


class HistoryAnswer(UploadedFile):
    """A history network."""

    ports: int
    junctions: int
    arcs: int


class RouteAnswer(UploadedFile):
    """An uploaded route."""

    waypoints: list[tuple[float, float]] = Field(description="[lat, lon]")
    depart: str | None
    notes: list[str]


class SeaAnswer(OpenAnswer):
    """What a sea holds; `bytes` of an uploaded one, `embedded` of one of the service."""

    id: str
    name: str
    variables: list[str]
    frames: list[str] = Field(description="what /frames draws")
    members: int
    box: list[float] | None = Field(description="south, north, west, east [deg]")
    start: str | None
    end: str | None
    step_s: float | None
    assumptions: list[str]


class JobAnswer(AnswerModel):
    """A job: `summary` holds its key figures, `problem` why it failed."""

    id: str
    number: int
    kind: Literal["plan", "alternatives", "evaluation", "project", "study", "forecast"]
    state: Literal["queued", "running", "done", "failed", "cancelled"]
    title: str
    attempt: int
    cancelling: bool
    created: str | None
    started: str | None
    finished: str | None
    problem: dict[str, Any] | None
    result: bool = Field(description="whether GET /plans/{id}/result has an answer")
    summary: dict[str, Any] | None
    request: dict[str, Any]


class JobListAnswer(AnswerModel):
    """Jobs, the newest first; `cursor` gives the next page."""

    jobs: list[JobAnswer]
    cursor: int | None


class ProjectExampleAnswer(AnswerModel):
    """A body for POST /projects."""

    title: str
    project: dict[str, Any]


class ReadyStudyAnswer(AnswerModel):
    """A study that is ready to run; `request` is a body for POST /studies."""

    name: str
    about: str
    voyages: int
    request: dict[str, Any]


class DownloadSizeAnswer(AnswerModel):
    """What a forecast would download."""

    source: str
    title: str
    licence: str
    run: str | None
    times: int
    bytes: int | None
    notes: list[str]


class VoyageRequestAnswer(OpenAnswer):
    """A body for POST /plans, or the voyage of one."""

    voyage: dict[str, Any]


class BrokenLimit(AnswerModel):
    """Where a route breaks a limit."""

    reason: str
    lat: float | None
    lon: float | None


class ComparedRouteAnswer(AnswerModel):
    """Key figures of a route; `difference` to the first."""

    job: str
    number: int
    title: str
    depart: str
    arrive: str | None
    feasible: bool
    violations: int
    broken: list[BrokenLimit]
    ends: list[tuple[float, float]]
    notes: list[str]
    currency: str | None
    cost: float | None
    time_h: float | None
    distance_nm: float | None
    fuel_t: float | None
    co2_t: float | None
    energy_mwh: float | None
    waiting_h: float | None
    min_ukc_m: float | None
    approach_nm: float
    approach_h: float
    highest_waves_m: float | None
    strongest_wind_kn: float | None
    difference: dict[str, float | None]


class ComparisonAnswer(AnswerModel):
    """Routes compared with the first of them."""

    routes: list[ComparedRouteAnswer]
