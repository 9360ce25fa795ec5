"""Files that belong to the chart of a plan: traffic of other ships, history networks."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter, UploadFile

from thalweg.service.endpoints.upload_reading import chunks_of, kept_upload
from thalweg.service.service_state import ServiceState, State
from thalweg.service.upload_store import UploadStore

chart_files_router = APIRouter(tags=["chart"])


@chart_files_router.get("/traffic")
def list_traffic(state: State) -> list[dict[str, Any]]:
    """List the uploaded files of ship traffic."""
    return [file.as_dict() for file in state.traffic.all()]


@chart_files_router.post("/traffic", status_code=201)
async def add_traffic(state: State, file: UploadFile) -> dict[str, Any]:
    """Upload the traffic of other ships: zones as GeoJSON, or a raster of density as NetCDF.

    Plans that name it in ``traffic`` state the expected encounters.
    """
    return await _kept(state, state.traffic, file, "inspect_traffic")


@chart_files_router.delete("/traffic/{traffic_id}", status_code=204)
def delete_traffic(state: State, traffic_id: str) -> None:
    """Remove a file of ship traffic."""
    state.traffic.delete(traffic_id)


@chart_files_router.get("/histories")
def list_histories(state: State) -> list[dict[str, Any]]:
    """List the uploaded history networks."""
    return [file.as_dict() for file in state.histories.all()]


@chart_files_router.post("/histories", status_code=201)
async def add_history(state: State, file: UploadFile) -> dict[str, Any]:
    """Upload a network of the routes that ships have taken (of ``thalweg history build``).

    Plans that name it in ``history`` stay in the water that ships usually use.
    """
    return await _kept(state, state.histories, file, "inspect_history")


@chart_files_router.delete("/histories/{history_id}", status_code=204)
def delete_history(state: State, history_id: str) -> None:
    """Remove a history network."""
    state.histories.delete(history_id)


async def _kept(
    state: ServiceState, store: UploadStore, file: UploadFile, task: str
) -> dict[str, Any]:
    def facts(path: str) -> dict[str, Any]:
        found, _ = state.file_worker.do(task, path=path)
        return found

    stored = await kept_upload(store, file.filename or "", chunks_of(file), facts)
    return stored.as_dict()
