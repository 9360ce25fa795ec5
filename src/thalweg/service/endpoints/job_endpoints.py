"""Plans, evaluations, projects, studies and forecasts as jobs: start, follow, stop, results."""

from __future__ import annotations

import asyncio
import json
import re
import secrets
from collections.abc import AsyncIterator
from typing import Annotated, Any, Final, Literal

from fastapi import APIRouter, Body, Header, Path, Query, Request, Response
from fastapi.responses import FileResponse, StreamingResponse
from starlette.concurrency import run_in_threadpool

from thalweg.core.time import format_time
from thalweg.service.endpoints.order_checks import (
    check_evaluation,
    check_files,
    check_plan,
    check_project_order,
    check_study_order,
)
from thalweg.service.jobs.batch_requests import (
    FORECAST_EXAMPLE,
    PROJECT_EXAMPLE,
    STUDY_EXAMPLE,
    FetchOrder,
    ProjectOrder,
    StudyOrder,
)
from thalweg.service.jobs.job_order import route_file_stem
from thalweg.service.jobs.job_store import FINAL_STATES, Job
from thalweg.service.jobs.plan_request import (
    ALTERNATIVES_EXAMPLE,
    EVALUATION_EXAMPLE,
    LAYERED_EXAMPLE,
    PLAN_EXAMPLE,
    AlternativesRequest,
    EvaluationRequest,
    PlanRequest,
)
from thalweg.service.problem_details import ServiceError, not_found
from thalweg.service.service_state import ServiceState, State

jobs_router = APIRouter(tags=["jobs"])
JobId = Annotated[str, Path(pattern=r"^[0-9a-f]{16}$")]
Kind = Literal["plan", "alternatives", "evaluation", "project", "study", "forecast"]
JobState = Literal["queued", "running", "done", "failed", "cancelled"]
KEEP_ALIVE_SECONDS: Final = 15.0
#: Of route files, by their ending.
ROUTE_MEDIA_TYPES: Final = {
    "rtz": "application/xml",
    "rtzp": "application/zip",
    "gml": "application/gml+xml",
    "gpx": "application/gpx+xml",
    "geojson": "application/geo+json",
    "kml": "application/vnd.google-earth.kml+xml",
    "csv": "text/csv",
}
_NUMBER_OF_FILE: Final = re.compile(r"_(\d{2,4})\.[a-z]+$")  # of a route, in names of files


def job_dict(job: Job) -> dict[str, Any]:
    """Return a job as plain data for JSON."""

    def text(seconds: float | None) -> str | None:
        return None if seconds is None else format_time(seconds)

    return {
        "id": job.id,
        "number": job.number,
        "kind": job.kind,
        "state": job.state,
        "title": job.request.get("title") or "",
        "attempt": job.attempt,
        "cancelling": job.cancelling,
        "created": text(job.created),
        "started": text(job.started),
        "finished": text(job.finished),
        "problem": job.problem,
        "result": job.summary is not None,
        "summary": job.summary,
        "request": job.request,
    }


@jobs_router.post("/plans", status_code=202)
def start_plan(
    state: State,
    response: Response,
    request: Annotated[PlanRequest, Body(examples=[PLAN_EXAMPLE, LAYERED_EXAMPLE])],
    idempotency_key: str | None = Header(None, max_length=200),
) -> dict[str, Any]:
    """Start planning a voyage; the answer comes at once, with the address of the job."""
    return _start("plan", check_plan(request, state), response, idempotency_key, state)


@jobs_router.post("/alternatives", status_code=202)
def start_alternatives(
    state: State,
    response: Response,
    request: Annotated[AlternativesRequest, Body(examples=[ALTERNATIVES_EXAMPLE])],
    idempotency_key: str | None = Header(None, max_length=200),
) -> dict[str, Any]:
    """Start planning routes that differ, each the best in something; a job like that of a plan."""
    return _start("alternatives", check_plan(request, state), response, idempotency_key, state)


@jobs_router.post("/evaluate", status_code=202)
def start_evaluation(
    state: State,
    response: Response,
    request: Annotated[EvaluationRequest, Body(examples=[EVALUATION_EXAMPLE])],
    idempotency_key: str | None = Header(None, max_length=200),
) -> dict[str, Any]:
    """Sail an imported route in given weather; the answer is a job like that of a plan."""
    return _start("evaluation", check_evaluation(request, state), response, idempotency_key, state)


@jobs_router.post("/projects", status_code=202)
def start_project(
    state: State,
    response: Response,
    request: Annotated[ProjectOrder, Body(examples=[PROJECT_EXAMPLE])],
    idempotency_key: str | None = Header(None, max_length=200),
) -> dict[str, Any]:
    """Start the simulation of a dredging project; the answer is a job like that of a plan."""
    entries, project = request.checked_project()
    given = {"title": request.title or project.name, "project": entries}
    check_files(given, state)
    check_project_order(project, entries["sea"], state)
    return _start("project", given, response, idempotency_key, state)


@jobs_router.get("/projects/example")
def example_project() -> dict[str, Any]:
    """Return the example project: a nourishment behind a bank that dries, in a made-up estuary."""
    from thalweg.operations.dredging import example_file

    entries, project = ProjectOrder(project=example_file().read_text("utf-8")).checked_project()
    return {"title": project.name, "project": entries}


@jobs_router.get("/studies/ready")
def list_ready_studies() -> list[dict[str, Any]]:
    """Return the studies that are ready to run, each as the body of a request to start it."""
    from thalweg.studies import ready_studies, ready_study

    found = []
    for name, about in ready_studies().items():
        entries, study = StudyOrder(study=ready_study(name)).checked_study()
        title = study.name or name
        request = {"title": title[:1].upper() + title[1:], "study": entries}
        found.append({"name": name, "about": about, "voyages": study.size, "request": request})
    return found


@jobs_router.post("/studies", status_code=202)
def start_study(
    state: State,
    response: Response,
    request: Annotated[StudyOrder, Body(examples=[STUDY_EXAMPLE])],
    idempotency_key: str | None = Header(None, max_length=200),
) -> dict[str, Any]:
    """Start planning many voyages; the answer is a job like that of a plan.

    Voyages that are planned are kept when the job is stopped, or its process dies.
    """
    entries, study = request.checked_study()
    given = {"title": request.title or study.name, "study": entries}
    check_files(given, state)
    check_study_order(study, state)
    return _start("study", given, response, idempotency_key, state)


@jobs_router.post("/forecasts", status_code=202)
def start_forecast(
    state: State,
    response: Response,
    request: Annotated[FetchOrder, Body(examples=[FORECAST_EXAMPLE])],
    idempotency_key: str | None = Header(None, max_length=200),
) -> dict[str, Any]:
    """Start the download of a forecast; when the job is done, its ``seas`` can be planned with."""
    request.forecast_request()
    return _start("forecast", request.model_dump(mode="json"), response, idempotency_key, state)


@jobs_router.post("/forecasts/estimate")
def estimate_download(
    state: State, request: Annotated[FetchOrder, Body(examples=[FORECAST_EXAMPLE])]
) -> dict[str, Any]:
    """State the size of a download, and the run that the source has now."""
    request.forecast_request()
    facts, _ = state.download_worker.do("forecast_size", request=request.model_dump(mode="json"))
    return facts


def _start(
    kind: str, request: dict[str, Any], response: Response, key: str | None, state: ServiceState
) -> dict[str, Any]:
    job, _ = state.store.add(
        secrets.token_hex(8), kind, request, key=key, queue=state.settings.limits.queue
    )
    state.runner.wake()
    response.headers["Location"] = f"/api/v1/plans/{job.id}"
    return job_dict(job)


@jobs_router.get("/plans")
def list_jobs(
    state: State,
    job_state: Annotated[JobState | None, Query(alias="state")] = None,
    kind: Kind | None = None,
    cursor: int = Query(0, ge=0, lt=2**62, description="of the page before"),
    size: int = Query(50, ge=1, le=200),
) -> dict[str, Any]:
    """List jobs, the newest first; ``cursor`` of the answer gives the next page."""
    found = state.store.page(state=job_state, kind=kind, before=cursor, size=size)
    more = found[-1].number if len(found) == size else None
    return {"jobs": [job_dict(job) for job in found], "cursor": more}


@jobs_router.get("/plans/{job_id}")
def get_job(state: State, job_id: JobId) -> dict[str, Any]:
    """State of a job: queued, running, done, failed or cancelled; request and key figures."""
    return job_dict(state.store.get(job_id))


@jobs_router.delete("/plans/{job_id}", status_code=202)
def stop_job(
    state: State,
    job_id: JobId,
    forget: bool = Query(False, description="remove a finished job and its result"),
) -> dict[str, Any]:
    """Ask a job to stop; the best result so far is kept. A finished job stays as it is."""
    job = state.store.get(job_id)
    if job.state not in FINAL_STATES:
        job = state.runner.cancel(job_id)
    elif forget:
        state.store.forget(job_id)
        state.runner.discard(job_id)
    return job_dict(job)


@jobs_router.get(
    "/plans/{job_id}/events",
    response_class=StreamingResponse,
    responses={200: {"content": {"text/event-stream": {}}}},
)
def job_events(
    state: State,
    request: Request,
    job_id: JobId,
    last_event_id: str | None = Header(None, max_length=20),
    after: int = Query(0, ge=0, lt=2**62),
) -> StreamingResponse:
    """Progress as server-sent events, from the first, or after ``Last-Event-ID``.

    Events: ``state`` (queued, running, done, failed, cancelled), ``stage`` (what is done now),
    ``route`` (the best route so far), ``progress`` (a cycle of a project; voyages of a study). The
    stream ends with the final state.
    """
    state.store.get(job_id)
    if last_event_id is not None and last_event_id.isascii() and last_event_id.isdigit():
        after = max(after, int(last_event_id))
    stream = _event_stream(job_id, after, state)
    return StreamingResponse(
        stream, media_type="text/event-stream", headers={"X-Accel-Buffering": "no"}
    )


async def _event_stream(job_id: str, after: int, state: ServiceState) -> AsyncIterator[str]:
    with state.changes.waiting_for(job_id) as changed:
        while True:
            changed.clear()
            events = await run_in_threadpool(state.store.events, job_id, after)
            for event in events:
                after = event.n
                data = json.dumps({**event.data, "at": event.at}, allow_nan=False)
                yield f"id: {event.n}\nevent: {event.kind}\ndata: {data}\n\n"
                if event.kind == "state" and event.data.get("state") in FINAL_STATES:
                    return
            if not events:
                try:
                    await asyncio.wait_for(changed.wait(), KEEP_ALIVE_SECONDS)
                except TimeoutError:
                    yield ": still working\n\n"
                    if (await run_in_threadpool(state.store.state_of, job_id)) in (
                        *FINAL_STATES,
                        None,
                    ):
                        return


def result_file(job_id: str, name: str, state: ServiceState) -> Any:
    """Return the path of a file of the result of a job.

    Raises
    ------
    ServiceError
        404 if there is no such job or file, 409 if the job has no result yet.
    """
    job = state.store.get(job_id)
    path = state.runner.result_folder(job_id) / name
    if path.exists():
        return path
    if job.summary is None:
        raise ServiceError(
            409,
            f"The job has no result: it is {job.state}.",
            "Results are there when a job is done, or cancelled after a first route.",
            "Follow its events, or look at its problem.",
        )
    raise _missing_file(job, name)


def _missing_file(job: Job, name: str) -> ServiceError:
    """Return the error for a file that a result does not have, in words of the request."""
    if name == "beside.json":
        return ServiceError(
            404,
            f"The plan {job.id} has no weather-blind route (number 0).",
            "Plans that choose speeds leg by leg, in weather, have one.",
            "Choose another route.",
        )
    number = _NUMBER_OF_FILE.search(name)
    routes = (job.summary or {}).get("routes")
    if number and isinstance(routes, int) and not 1 <= int(number[1]) <= routes:
        return ServiceError(
            404,
            f"The plan {job.id} has no route {int(number[1])}.",
            f"It has {routes}, numbered from 1.",
            "Choose one of them.",
        )
    return not_found("file", name, "The result of the job has no such file.")


@jobs_router.get("/plans/{job_id}/result")
def job_result(state: State, job_id: JobId) -> FileResponse:
    """Return the result: of a plan exactly the file ``plan.json``, of an evaluation its route, of
    alternatives the routes with their names and figures.
    """
    kind = state.store.get(job_id).kind
    name = "route.json" if kind == "evaluation" else f"{kind}.json"
    return FileResponse(result_file(job_id, name, state), media_type="application/json")


@jobs_router.get("/plans/{job_id}/tables/{name}.csv")
def job_table(
    state: State, name: Literal["cycles", "voyages", "summary", "refusals"], job_id: JobId
) -> FileResponse:
    """Return a table: the cycles of a project; the voyages, summary or refusals of a study."""
    path = result_file(job_id, f"{name}.csv", state)
    return FileResponse(path, media_type="text/csv", filename=f"thalweg_{job_id[:6]}_{name}.csv")


@jobs_router.get("/plans/{job_id}/{part}.json")
def job_part(
    state: State,
    part: Literal["isochrones", "beside", "space_time", "limits", "diagrams"],
    job_id: JobId,
) -> FileResponse:
    """Return a further file of a result: isochrones, the route that ignores the weather, place and
    time (where and when the track is closed by the tide), or the diagrams of a project.
    """
    return FileResponse(result_file(job_id, f"{part}.json", state), media_type="application/json")


@jobs_router.get("/plans/{job_id}/profiles/{number}")
def job_profile(state: State, job_id: JobId, number: int = Path(ge=1, le=9999)) -> FileResponse:
    """Return a route along time: positions, speeds, waves, wind, power, under-keel clearance."""
    path = result_file(job_id, f"profile_{number:02d}.json", state)
    return FileResponse(path, media_type="application/json")


@jobs_router.get("/plans/{job_id}/routes/{number}.{form}")
def job_route_file(
    state: State,
    form: Literal["rtz", "rtzp", "gml", "gpx", "geojson", "kml", "csv"],
    job_id: JobId,
    number: int = Path(ge=1, le=9999),
) -> FileResponse:
    """Return a route of a result as a file for other programs."""
    path = result_file(job_id, f"{route_file_stem(job_id)}_{number:02d}.{form}", state)
    return FileResponse(path, media_type=ROUTE_MEDIA_TYPES[form], filename=path.name)
