"""Projects, studies and forecasts as jobs of the service."""

from __future__ import annotations

import csv
import io
import json
import os
import signal
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from tests.service.conftest import LONG_S, ended, result_of_stop_after_kill
from tests.service.test_service_jobs import events_of
from tests.service.test_service_requests import problem

pytest.importorskip("fastapi", reason='the extra "serve" is not installed')

STUDY: dict[str, Any] = {
    "title": "Two speeds",
    "study": {
        "ship": "handysize-bulker",
        "sea": "calm",
        "coast": "none",
        "resolution_nm": 4.0,
        "voyage": {"start": [47.0, -5.0], "goal": [47.3, -5.3], "depart": "2026-01-01T00:00Z"},
        "axes": {"speed_kn": [10, 12]},
    },
}


def small_project(client: Any, **changes: Any) -> dict[str, Any]:
    entries = client.get("/api/v1/projects/example").json()["project"]
    entries |= {"volume_m3": 9_000, "days": 3, "spacing_m": 900.0, "rings": 2, "margin_m": 0.02}
    return {"project": {**entries, "load_factors": [0.5, 1.0], **changes}}


@pytest.fixture(scope="module")
def project(client):
    answer = client.post("/api/v1/projects", json=small_project(client))
    assert answer.status_code == 202, answer.text
    job = ended(client.get, answer.json()["id"])
    assert job["state"] == "done", job["problem"]
    return job


@pytest.mark.slow
def test_a_project_is_that_of_the_library(client, project):
    from thalweg.operations.dredging import Project, open_project_inputs, run_project

    entries = Project.from_dict(small_project(client)["project"])
    ship, sea, chart = open_project_inputs(entries)
    found = run_project(entries, ship=ship, sea=sea, chart=chart)
    result = client.get(f"/api/v1/plans/{project['id']}/result").json()
    assert result == json.loads(found.to_json())
    assert project["title"] == "Nourishment behind the bank"
    assert project["summary"]["production_gain"] == pytest.approx(found.gains()["production_gain"])
    diagrams = client.get(f"/api/v1/plans/{project['id']}/diagrams.json").json()
    assert diagrams["table"] == found.table()
    text = client.get(f"/api/v1/plans/{project['id']}/tables/cycles.csv").text
    rows = list(csv.DictReader(io.StringIO(text)))
    assert len(rows) == sum(len(run.cycles) for run in found.runs)


@pytest.mark.slow
def test_every_cycle_of_a_project_is_an_event(client, project):
    text = client.get(f"/api/v1/plans/{project['id']}/events").text
    cycles = [data for _, kind, data in events_of(text) if kind == "progress"]
    moved = sum(row["cycle"]["volume_m3"] for row in cycles if row["run"] == "optimised")
    assert moved == pytest.approx(9_000.0) and cycles[0]["whole"] == 9_000


@pytest.mark.slow
def test_the_diagram_of_place_and_time_agrees_with_the_waits(client, project):
    diagrams = client.get(f"/api/v1/plans/{project['id']}/diagrams.json").json()
    for run in diagrams["runs"].values():
        found = run["space_time"]
        shape = len(found["distance_m"]), len(found["times"])
        assert [len(row) for row in found["closed"]] == [shape[1]] * shape[0]
        assert found["lines"]
        for line in found["lines"]:  # no ship sails where and when the water is too shallow
            at = np.searchsorted(found["distance_m"], line["distance_m"]).clip(0, shape[0] - 1)
            when = np.searchsorted(found["times"], line["times"]).clip(0, shape[1] - 1)
            closed = [found["closed"][i][k] != "0" for i, k in zip(at, when)]
            assert np.mean(closed) < 0.1  # at the edge of a period within a step of the raster
        activities = run["activities"]
        assert len(activities["loading"]) == len(activities["unloading"])
    base = diagrams["runs"]["base case"]
    assert "1" in "".join(base["space_time"]["closed"])


def test_a_project_states_what_is_wrong_at_its_entry(client):
    wrong = {"volume_m3": -1.0}
    found = problem(client.post("/api/v1/projects", json=small_project(client, **wrong)), 422)
    assert "volume_m3" in found["detail"]
    for entries in ({"sea": "/etc/passwd"}, {"ship": "/etc/passwd"}, {"depth": ["../jobs.sqlite"]}):
        answer = client.post("/api/v1/projects", json=small_project(client, **entries))
        assert answer.status_code in (404, 422), entries
        assert answer.json()["field"] in ("ship", "seas")
    found = problem(
        client.post("/api/v1/projects", json=small_project(client, zones="a.json")), 422
    )
    assert found["field"] == "zones"
    assert problem(client.post("/api/v1/projects", json={"project": "a: [b"}), 422)["asked"]


@pytest.mark.slow
def test_a_study_is_planned_and_summarised(client):
    job = client.post("/api/v1/studies", json=STUDY).json()
    job = ended(client.get, job["id"])
    assert job["state"] == "done", job["problem"]
    assert job["summary"]["voyages"] == 2 and job["summary"]["refused"] == 0
    result = client.get(f"/api/v1/plans/{job['id']}/result").json()
    assert result["axes"] == ["speed_kn"]
    rows = [dict(zip(result["columns"], row)) for row in result["rows"]]
    hours = {row["speed_kn"]: row["time_h"] for row in rows}
    assert hours[10] == pytest.approx(1.2 * hours[12], rel=1e-3)
    assert len(result["groups"]) == 2
    events = events_of(client.get(f"/api/v1/plans/{job['id']}/events").text)
    progress = [data for _, kind, data in events if kind == "progress"]
    assert progress[-1]["done"] == progress[-1]["total"] == 2
    assert sum(len(data["rows"]) for data in progress) == 2
    text = client.get(f"/api/v1/plans/{job['id']}/tables/voyages.csv").text
    assert len(list(csv.DictReader(io.StringIO(text)))) == 2


def test_a_study_states_what_is_wrong(client):
    hidden = {"speed_kn": {"choice": [{"name": "a", "sea": "/etc/passwd"}]}}
    places = [{"name": "a", "areas": "/etc/passwd"}]
    for entries in (
        {"sea": "/etc/passwd"},
        {"ship": "../x.yaml"},
        {"track": "route.rtz"},
        {"depths": ["/etc/passwd"]},
        {"traffic": ["/etc/passwd"]},
        {"areas": "/etc/passwd"},
        {"axes": {"where": places}},
        {"sample": hidden},
    ):
        answer = client.post("/api/v1/studies", json={"study": {**STUDY["study"], **entries}})
        assert answer.status_code in (404, 422), answer.text
    for entry, value in (("sea", 3), ("sea", [["calm"]]), ("compare", True), ("compare", [[]])):
        answer = client.post("/api/v1/studies", json={"study": {**STUDY["study"], entry: value}})
        assert problem(answer, 422)["field"] == entry
    wrong = {**STUDY["study"], "limits": {"wave_height_m": -1}}
    found = problem(client.post("/api/v1/studies", json={"study": wrong}), 422)
    assert found["field"] == "limits.wave_height_m" and "above 0" in found["possible"]
    many = {**STUDY["study"], "axes": {"speed_kn": {"from": 1, "to": 30000, "step": 1}}}
    found = problem(client.post("/api/v1/studies", json={"study": many}), 422)
    assert "20,000" in found["possible"] and found["field"] == "axes"
    fast = {**STUDY["study"], "axes": {"speed_kn": [10, 90]}}
    found = problem(client.post("/api/v1/studies", json={"study": fast}), 422)
    assert found["field"] == "speed_kn" and "90" in found["asked"]


@pytest.mark.slow
def test_a_killed_study_keeps_its_voyages(server):
    study = {**STUDY["study"], "axes": {"speed_kn": {"from": 8, "to": 13.9, "step": 0.1}}}
    job = server.http.post("/api/v1/studies", json={"study": study}).json()["id"]
    _until_progress(server, job, 3)
    server.kill()
    server.start()
    _until_progress(server, job, 6)
    os.kill(min(server.children()), signal.SIGKILL)
    reached = _until_queued_again(server, job, times=2)  # by the server and by its child
    _until_progress(server, job, reached + 3)
    server.http.delete(f"/api/v1/plans/{job}")
    found = ended(server.http.get, job)
    assert found["state"] == "cancelled" and found["result"]
    events = events_of(server.http.get(f"/api/v1/plans/{job}/events").text)
    done = [data["done"] for _, kind, data in events if kind == "progress"]
    assert done == sorted(set(done))  # no voyage was planned twice
    result = server.http.get(f"/api/v1/plans/{job}/result").json()
    assert len(result["rows"]) == done[-1] < result["total"] == 60
    limit = time.monotonic() + LONG_S
    while any((server.folder / "workspaces").iterdir()):  # emptied after the state is set
        assert time.monotonic() < limit
        time.sleep(0.05)


@pytest.mark.slow
def test_a_study_that_is_queued_again_and_stopped_keeps_its_voyages(server):
    study = {**STUDY["study"], "axes": {"speed_kn": {"from": 8, "to": 13.9, "step": 0.1}}}
    job = server.http.post("/api/v1/studies", json={"study": study}).json()["id"]
    _until_progress(server, job, 3)
    result = result_of_stop_after_kill(server, job)
    assert 3 <= len(result["rows"]) < result["total"] == 60


def _until_queued_again(server: Any, job: str, times: int) -> int:
    """Wait until a job was returned to the queue so often; return how many voyages it had done."""
    reached = 0
    with server.http.stream("GET", f"/api/v1/plans/{job}/events") as stream:
        for line in stream.iter_lines():
            if line.startswith("data: "):
                data = json.loads(line[6:])
                reached = max(reached, data.get("done", 0))
                times -= "why" in data
                if times == 0:
                    return reached
    raise AssertionError("the job was not started again")


def _until_progress(server: Any, job: str, count: int) -> None:
    limit = time.monotonic() + LONG_S
    while time.monotonic() < limit:
        with server.http.stream("GET", f"/api/v1/plans/{job}/events") as stream:
            for line in stream.iter_lines():
                if line.startswith("data: ") and json.loads(line[6:]).get("done", 0) >= count:
                    return
                assert '"state": "failed"' not in line, line
    raise AssertionError("no progress")


def test_a_forecast_becomes_a_sea(tmp_path, monkeypatch):
    from thalweg.forecasts import FetchedForecast, fetching
    from thalweg.service.jobs.fetch_work import fetch_sea
    from thalweg.service.jobs.job_order import JobOrder, StageMessages
    from thalweg.service.upload_store import UploadStore

    class Silent:
        def send(self, kind: str, data: dict[str, Any]) -> None:
            pass

    axes = ("time", "latitude", "longitude")

    def fetched(request: Any, source: str, out: Path, *, progress: Any) -> FetchedForecast:
        wind = np.full((2, 3, 3), 5.0)
        xr.Dataset(
            {
                name: (axes, wind, {"standard_name": name, "units": "m s-1"})
                for name in ("eastward_wind", "northward_wind")
            },
            {
                "time": np.array(["2026-11-22T00", "2026-11-22T03"], "M8[ns]"),
                "latitude": ("latitude", [40.0, 41.0, 42.0], {"units": "degrees_north"}),
                "longitude": ("longitude", [-10.0, -9.0, -8.0], {"units": "degrees_east"}),
            },
        ).to_netcdf(out)  # fmt: skip
        return FetchedForecast((out,), request.start, request.start, request.end, ("wind",), 99)

    monkeypatch.setattr(fetching, "fetch_forecast", fetched)
    folders = [tmp_path / name for name in ("draft", "work", "seas")]
    for folder in folders:
        folder.mkdir()
    request = {
        "source": "gfs", "box": [40, 42, -10, -8], "start": "2026-11-22T00:00Z",
        "end": "2026-11-22T03:00Z", "quantities": ["wind"],
    }  # fmt: skip
    order = JobOrder("forecast", request, str(folders[0]), {}, *map(str, folders[1:]))
    summary = fetch_sea(order, StageMessages(Silent()))  # type: ignore[arg-type]
    (kept,) = UploadStore(folders[2], "sea", (".nc",), largest=9, total=9).all()
    assert summary["seas"] == [kept.id]
    assert kept.facts["frames"] == ["wind"] and kept.facts["run"] == "2026-11-22T00:00:00Z"


@pytest.mark.slow
def test_a_forecast_that_is_not_possible_is_refused(client):
    request = {"source": "gfs", "box": [60, 40, -10, -8], "start": "2026-11-22T00:00Z"}
    given = {**request, "end": "2026-11-23T00:00Z"}
    assert problem(client.post("/api/v1/forecasts", json=given), 422)["field"] == "box"
    given = {**given, "box": [40, 60, -10, -8], "quantities": ["current"]}
    assert "current" in problem(client.post("/api/v1/forecasts/estimate", json=given), 422)["asked"]
    assert problem(client.post("/api/v1/forecasts", json={**given, "source": "x"}), 422)


@pytest.mark.slow
def test_ready_studies_are_requests_that_start(client):
    found = client.get("/api/v1/studies/ready").json()
    assert {"season", "speeds", "step-length"} <= {one["name"] for one in found}
    one = next(one for one in found if one["name"] == "network-fidelity")
    answer = client.post("/api/v1/studies", json=one["request"])
    assert answer.status_code == 202 and one["voyages"] == 6
    client.delete(f"/api/v1/plans/{answer.json()['id']}")
