"""The work of a download of a forecast: fetch, inspect, keep as a sea."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

from thalweg.core.time import format_time
from thalweg.service.jobs.batch_requests import FetchOrder
from thalweg.service.jobs.job_order import JobOrder, StageMessages
from thalweg.service.jobs.sea_facts import sea_facts
from thalweg.service.upload_store import UploadStore, file_identity


def fetch_sea(order: JobOrder, stages: StageMessages) -> dict[str, Any]:
    """Download a forecast and keep its files among the uploaded seas; return the key figures."""
    from thalweg.forecasts.fetching import fetch_forecast
    from thalweg.sea import Sea

    request = FetchOrder.model_validate(order.request)
    out = Path(order.workspace) / "forecast.nc"
    done = fetch_forecast(request.forecast_request(), request.source, out, progress=stages)
    stages("reading what has arrived")
    seas = []
    for path in done.files:
        facts = sea_facts(Sea.open(path), in_detail=True)
        if done.run is not None:
            facts["run"] = format_time(done.run)
        seas.append(_kept(path, request, facts, order))
    facts = {
        "source": request.source,
        "run": None if done.run is None else format_time(done.run),
        "start": format_time(done.first),
        "end": format_time(done.last),
        "bytes": done.bytes,
        "seas": seas,
        "notes": list(done.notes),
    }
    order.write_json("forecast.json", facts)
    return {"title": request.source, "feasible": True, "seconds": stages.seconds(), **facts}


def _kept(path: Path, request: FetchOrder, facts: dict[str, Any], order: JobOrder) -> str:
    """Keep a file among the uploaded seas; return its id."""
    name = f"{request.source} {request.start[:13]}{path.stem.removeprefix('forecast')}.nc"
    name = name.replace(":", "").replace("/", "-")
    folder = Path(order.seas_folder)
    store = UploadStore(folder, "sea", (".nc",), largest=2**40, total=2**60, clean=False)
    part = folder / f".part-{path.stem}-{Path(order.workspace).name}.nc"
    shutil.copyfile(path, part)
    return store.keep(part, file_identity(part), name, facts).id
