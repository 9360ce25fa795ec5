"""The application: all endpoints, the pages, access control and errors."""

from __future__ import annotations

import gzip
import os
import threading
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any, Final

from anyio.to_thread import current_default_thread_limiter
from fastapi import FastAPI
from fastapi.responses import FileResponse
from fastapi.staticfiles import StaticFiles
from starlette.datastructures import Headers
from starlette.middleware.gzip import GZipMiddleware
from starlette.responses import Response
from starlette.types import ASGIApp, Receive, Scope, Send

from thalweg.core.file_reading import too_large
from thalweg.service.access_control import AccessControl
from thalweg.service.api_description import describe_answers
from thalweg.service.endpoints.catalogue_endpoints import catalogue
from thalweg.service.endpoints.chart_endpoints import chart_router
from thalweg.service.endpoints.chart_file_endpoints import chart_files_router
from thalweg.service.endpoints.fault_list import faults_of_request
from thalweg.service.endpoints.job_endpoints import jobs_router
from thalweg.service.endpoints.route_endpoints import routes_router
from thalweg.service.endpoints.sea_endpoints import seas_router
from thalweg.service.problem_details import ServiceError, add_problem_handlers, problem_response
from thalweg.service.service_settings import ServiceSettings
from thalweg.service.service_state import ServiceState

STATIC: Final = Path(__file__).parent / "static"
_DESCRIPTION: Final = """Plan voyages of ships. Plans are jobs: `POST /api/v1/plans` answers at once
with an id; `GET /api/v1/plans/{id}/events` streams the progress, `GET /api/v1/plans/{id}/result`
returns `plan.json`. Every request states the token: `Authorization: Bearer TOKEN`. Errors are
problem details (RFC 9457) with `asked`, `possible`, `remedy` and `field`. Not for navigation."""

_SECONDS_BEFORE_PLACES: Final = 4.0  # the page is drawn first
#: Requests at work at the same time: many may wait for a worker while others are answered.
_THREADS: Final = 200


class CompressedFiles(StaticFiles):
    """The files of the page, each compressed once."""

    def __init__(self, directory: Path) -> None:
        super().__init__(directory=directory)
        self._packed: dict[tuple[str, int], bytes] = {}

    def file_response(
        self,
        full_path: str | os.PathLike[str],
        stat_result: os.stat_result,
        scope: Scope,
        status_code: int = 200,
    ) -> Response:
        """Return a file, compressed for clients that take it so."""
        answer = super().file_response(full_path, stat_result, scope, status_code)
        accepted = Headers(scope=scope).get("accept-encoding", "")
        if answer.status_code != 200 or scope["method"] != "GET" or "gzip" not in accepted:
            return answer
        key = (str(full_path), stat_result.st_mtime_ns)
        if key not in self._packed:
            self._packed[key] = gzip.compress(Path(full_path).read_bytes(), 9, mtime=0)
        headers = {"Content-Encoding": "gzip", "Vary": "Accept-Encoding"}
        headers |= {name: answer.headers[name] for name in ("etag", "last-modified")}
        return Response(self._packed[key], media_type=answer.media_type, headers=headers)


class BodyLimit:
    """ASGI middleware that refuses bodies above a size, but for uploads of seas.

    Parameters
    ----------
    largest : [bytes].
    """

    def __init__(self, application: ASGIApp, largest: int) -> None:
        self.application = application
        self.largest = largest

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request or refuse its body."""
        if scope["type"] != "http" or scope["path"] == "/api/v1/seas":
            await self.application(scope, receive, send)
            return
        stated = dict(scope["headers"]).get(b"content-length", b"0")
        if not stated.isdigit() or int(stated) > self.largest:
            error = ServiceError(413, *too_large("request", self.largest), "Send less.")
            await problem_response(error)(scope, receive, send)
            return
        await self.application(scope, self._limited(receive), send)

    def _limited(self, receive: Receive) -> Receive:
        size = 0

        async def limited() -> Any:
            nonlocal size
            message = await receive()
            size += len(message.get("body", b""))
            if size > self.largest:
                return {"type": "http.disconnect"}
            return message

        return limited


def create_application(settings: ServiceSettings) -> FastAPI:
    """Return the application of a service; its processes start with it.

    Raises
    ------
    InputError
        If the folder cannot be used, or another service uses it.
    """
    import thalweg

    state = ServiceState(settings)

    @asynccontextmanager
    async def lifespan(application: FastAPI) -> AsyncIterator[None]:
        state.changes.attach()
        current_default_thread_limiter().total_tokens = _THREADS
        state.runner.start()
        places = threading.Timer(_SECONDS_BEFORE_PLACES, state.load_places)
        places.daemon = True
        places.start()
        try:
            yield
        finally:
            places.cancel()
            state.close()

    application = FastAPI(
        title="Thalweg",
        version=thalweg.__version__,
        description=_DESCRIPTION,
        lifespan=lifespan,
        docs_url=None,  # its page loads files from other sites
        redoc_url=None,
    )
    application.state.service = state
    add_problem_handlers(application, faults_of_request)
    for router in (
        catalogue,
        chart_router,
        chart_files_router,
        seas_router,
        jobs_router,
        routes_router,
    ):
        application.include_router(router, prefix="/api/v1")
    _add_pages(application)
    describe_answers(application)
    application.add_middleware(BodyLimit, largest=settings.limits.small_upload_bytes)
    application.add_middleware(GZipMiddleware, minimum_size=1000, compresslevel=4)
    application.add_middleware(AccessControl, settings=settings)
    return application


def _add_pages(application: FastAPI) -> None:
    @application.get("/", include_in_schema=False)
    def first_page() -> FileResponse:
        return FileResponse(STATIC / "index.html", media_type="text/html")

    application.mount("/static", CompressedFiles(STATIC), name="static")
