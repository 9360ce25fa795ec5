"""`ServiceState`: the stores and processes of a running service, which all endpoints share."""

from __future__ import annotations

import asyncio
import contextlib
import os
from collections.abc import Sequence
from functools import cached_property
from typing import Annotated, Any, Final

from fastapi import Depends, Request

from thalweg.core.errors import InputError, ThalwegError
from thalweg.core.file_writing import taken_lock
from thalweg.service.coast_map import remove_old_drafts
from thalweg.service.jobs.job_runner import JobRunner
from thalweg.service.jobs.job_store import JobStore
from thalweg.service.jobs.named_uploads import named_uploads
from thalweg.service.jobs.plan_request import EMBEDDED_SEAS
from thalweg.service.service_settings import ServiceSettings
from thalweg.service.upload_store import UploadStore
from thalweg.service.worker.worker_client import WorkerClient

SEA_ENDINGS: Final = (".nc", ".nc4", ".cdf", ".grb", ".grb2", ".grib", ".grib1", ".grib2", ".gri")
SHIP_ENDINGS: Final = (".yaml", ".yml", ".json")
TRAFFIC_ENDINGS: Final = (".geojson", ".json", ".nc", ".nc4")
HISTORY_ENDINGS: Final = (".json",)
ROUTE_ENDINGS: Final = (
    ".rtz",
    ".rtzp",
    ".gml",
    ".gpx",
    ".geojson",
    ".json",
    ".kml",
    ".csv",
    ".txt",
)


class JobChanges:
    """Wakes the streams of events when a job has changed.

    The store calls `notify` from any thread; streams wait in the loop of the server.
    """

    def __init__(self) -> None:
        self._waiting: dict[str, set[asyncio.Event]] = {}
        self._loop: asyncio.AbstractEventLoop | None = None

    def attach(self) -> None:
        """Remember the loop in which streams wait."""
        self._loop = asyncio.get_running_loop()

    def notify(self, job_id: str) -> None:
        """Wake the streams of a job."""
        if self._loop is not None:
            with contextlib.suppress(RuntimeError):  # the loop has ended
                self._loop.call_soon_threadsafe(self._wake, job_id)

    def _wake(self, job_id: str) -> None:
        for waiting in self._waiting.get(job_id, ()):
            waiting.set()

    @contextlib.contextmanager
    def waiting_for(self, job_id: str) -> Any:
        """Give an event that is set whenever the job changes."""
        event = asyncio.Event()
        self._waiting.setdefault(job_id, set()).add(event)
        try:
            yield event
        finally:
            self._waiting[job_id].discard(event)
            if not self._waiting[job_id]:
                del self._waiting[job_id]


class ServiceState:
    """The stores and processes of a service."""

    def __init__(self, settings: ServiceSettings) -> None:
        self.settings = settings
        limits = settings.limits
        self._lock = _folder_lock(settings)
        small = limits.small_upload_bytes
        remove_old_drafts()
        self.seas = UploadStore(
            settings.subfolder("seas"), "sea", SEA_ENDINGS,
            largest=limits.upload_bytes, total=limits.store_bytes,
        )  # fmt: skip
        self.ships = UploadStore(
            settings.subfolder("ships"), "ship", SHIP_ENDINGS, largest=small, total=100 * small
        )
        self.routes = UploadStore(
            settings.subfolder("routes"), "route", ROUTE_ENDINGS, largest=small, total=100 * small
        )
        self.traffic = UploadStore(
            settings.subfolder("traffic"), "traffic", TRAFFIC_ENDINGS,
            largest=small, total=100 * small,
        )  # fmt: skip
        self.histories = UploadStore(
            settings.subfolder("histories"), "history network", HISTORY_ENDINGS,
            largest=small, total=100 * small,
        )  # fmt: skip
        self.store = JobStore(settings.folder / "jobs.sqlite")
        self.runner = JobRunner(self.store, settings, self.files_of)
        self.changes = JobChanges()
        self.store.listen(self.changes.notify)
        self.embedded_facts: dict[str, dict[str, Any]] = {}  # of the seas of the package, by id
        self.map_worker = WorkerClient(limits.worker_seconds)
        self.file_worker = WorkerClient(limits.worker_seconds)
        self.download_worker = WorkerClient(limits.worker_seconds)
        self.place_worker = WorkerClient(limits.worker_seconds)

    def files_of(self, request: dict[str, Any]) -> dict[str, str]:
        """Return the paths of the uploaded files that a request names, by their ids."""
        named = named_uploads(request)
        found = {name: str(self.seas.get(name).path) for name in named.seas}
        library = self.library_ships
        for ship in named.ships:
            if ship not in library:
                found[ship] = str(self.ships.get(ship).path)
        for names, store in (
            (named.routes, self.routes),
            (named.traffic, self.traffic),
            (named.histories, self.histories),
        ):
            found |= {name: str(store.get(name).path) for name in names}
        return found

    def named_variables(self, seas: Sequence[str]) -> dict[str, str]:
        """Return the variables that were named when seas were uploaded, by quantity."""
        stored = [self.seas.get(name) for name in reversed(seas) if name not in EMBEDDED_SEAS]
        return {key: name for sea in stored for key, name in sea.facts.get("named", {}).items()}

    @cached_property
    def library_ships(self) -> tuple[str, ...]:
        """The names of the ships that need no file."""
        from thalweg.ship import library_names, plugin_names

        return (*library_names(), *plugin_names())

    def load_places(self) -> None:
        """Load the coast that the places of requests are checked on, before it is needed."""
        with contextlib.suppress(ThalwegError):
            self.place_worker.do("check_places")

    def close(self) -> None:
        """End all processes and close the files."""
        self.runner.stop()
        self.map_worker.close()
        self.file_worker.close()
        self.download_worker.close()
        self.place_worker.close()
        self.store.close()
        if self._lock is not None:
            os.close(self._lock)


def state_of(request: Request) -> ServiceState:
    """Return the state of the service that answers a request."""
    state: ServiceState = request.app.state.service
    return state


#: The state as a parameter of an endpoint.
State = Annotated[ServiceState, Depends(state_of)]


def _folder_lock(settings: ServiceSettings) -> int | None:
    """Take the data folder for this process; the system frees it when the process ends."""
    try:
        return taken_lock(settings.subfolder("") / "lock")
    except BlockingIOError:
        raise InputError(
            f"Another service uses the folder {str(settings.folder)!r}.",
            "Each service needs a folder of its own.",
            "End the other one, or give another folder with --data.",
            field="data",
        ) from None
