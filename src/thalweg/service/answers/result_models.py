"""The form of results of jobs and their parts, for `/openapi.json`."""

from __future__ import annotations

from typing import Any

from pydantic import Field, RootModel

from thalweg.service.answers.answer_models import AnswerModel, OpenAnswer


class RouteResult(OpenAnswer):
    """A route as the referee sailed it; unknown is null."""

    depart: str
    arrive: str | None
    time_h: float | None
    distance_nm: float
    fuel_t: float | None
    co2_t: float | None
    energy_mwh: float | None
    currency: str
    engine_order: str
    waiting_h: float
    min_ukc_m: float | None
    feasible: bool
    violations: list[dict[str, Any]]
    waypoints: list[dict[str, Any]]


class PlanResult(OpenAnswer):
    """The file plan.json."""

    voyage: dict[str, Any]
    objective: str
    objective_unit: str
    routes: list[RouteResult] = Field(description="the best first")
    lower_bound: float | None
    lower_bound_kind: str
    gap: float | None
    rejections: dict[str, int] = Field(description="why legs were refused, by count")
    notes: list[str]
    provenance: dict[str, Any]


class AlternativesResult(OpenAnswer):
    """Routes that differ, each with what it is best in."""

    voyage: dict[str, Any]
    alternatives: list[dict[str, Any]]
    notes: list[str]
    cancelled: bool


class ProjectAnswer(OpenAnswer):
    """The runs of a dredging project by name, with their cycles and totals."""

    project: dict[str, Any]
    runs: dict[str, Any]
    gains: dict[str, Any]
    prices: dict[str, Any] = Field({}, description="of the cost, each with its value and source")
    provenance: dict[str, Any]


class StudyAnswer(OpenAnswer):
    """The voyages of a study as rows, and what they have in common."""

    study: dict[str, Any]
    axes: list[str]
    columns: list[str]
    rows: list[list[Any]]
    total: int
    groups: list[dict[str, Any]]
    refusals: list[dict[str, Any]]
    best: list[dict[str, Any]]


class ForecastAnswer(AnswerModel):
    """A downloaded forecast: `seas` are ids of /seas."""

    source: str
    run: str | None
    start: str
    end: str
    bytes: int
    seas: list[str]
    notes: list[str]


class JobResult(
    RootModel[
        PlanResult | AlternativesResult | ProjectAnswer | StudyAnswer | ForecastAnswer | RouteResult
    ]
):
    """The result of a job, by its kind; of an evaluation its route."""


class ProfileAnswer(RootModel[dict[str, list[float | None]]]):
    """Columns of a route along time; `time` in seconds since 1970-01-01T00:00Z."""


class IsochronesAnswer(AnswerModel):
    """Where the ship can be after some hours, as points [lon, lat]."""

    step_h: float
    lines: list[dict[str, Any]]


class BesideAnswer(RouteResult):
    """The route that ignores the weather, with its profile."""

    profile: ProfileAnswer


class SpaceTimeAnswer(AnswerModel):
    """When the track of a route is closed by the tide: a row of digits for each distance."""

    distance_m: list[float]
    times: list[float]
    closed: list[str] = Field(description="0 open, 1 too shallow, 2 current too strong, 3 unknown")
    lines: list[dict[str, Any]]


class DiagramsAnswer(AnswerModel):
    """The table and the diagrams of a dredging project."""

    table: list[Any]
    level: dict[str, Any]
    runs: dict[str, Any]


class LimitMet(AnswerModel):
    """A limit that applies to a route: its worst value, and when the route is near it."""

    name: str = Field(description="with its unit")
    limit: float
    worst: float
    time: float = Field(description="of the worst value, in seconds since 1970-01-01T00:00Z")
    near: list[tuple[float, float]] = Field(description="when it is within 5 % of the limit")
    near_h: float


class LimitsAnswer(AnswerModel):
    """The limits that apply to each route of a result."""

    routes: list[list[LimitMet]]


class ResultPart(
    RootModel[BesideAnswer | DiagramsAnswer | SpaceTimeAnswer | LimitsAnswer | IsochronesAnswer]
):
    """A further part of a result."""
