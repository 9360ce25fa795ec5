"""Jobs of the service: results as of the library, progress, cancelling, kills."""

from __future__ import annotations

import json
import os
import signal
import time
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from tests.service.conftest import LONG_S, SHORT, ended, result_of_stop_after_kill

pytest.importorskip("fastapi", reason='the extra "serve" is not installed')

from thalweg.service.jobs import job_work
from thalweg.service.jobs.job_order import JobOrder
from thalweg.service.jobs.plan_request import PlanRequest

pytestmark = pytest.mark.slow

CROSSING: dict[str, Any] = {
    "voyage": {
        "start": "47.0N 20.0W",
        "goal": "47.0N 6.0W",
        "depart": "1998-08-31T12:00Z",
        "objective": "front",
    },
    "ship": "handysize-bulker",
    "seas": ["storm"],
    "coast": "c",
}


@pytest.fixture(scope="module")
def done(client):
    answer = client.post("/api/v1/plans", json=SHORT, headers={"Idempotency-Key": "one"})
    assert answer.status_code == 202
    job = ended(client.get, answer.json()["id"])
    assert job["state"] == "done", job["problem"]
    return job


def test_the_result_is_the_plan_of_the_library(client, done):
    from thalweg import Chart, Sea, Ship, Voyage, plan

    result = client.get(f"/api/v1/plans/{done['id']}/result").json()
    found = plan(
        Voyage.from_dict(SHORT["voyage"]),
        ship=Ship.load("handysize-bulker"),
        sea=Sea.calm(),
        chart=Chart.gshhg("c"),
        resolution=4.0 * 1852.0,
        proof=0.0,
    )
    wanted = json.loads(found.to_json())
    for answer in (result, wanted):
        answer.pop("lower_bound_kind")  # names the raster of the proof, which tests make smaller
    assert result == wanted


def test_the_same_key_is_the_same_job(client, done):
    again = client.post("/api/v1/plans", json=SHORT, headers={"Idempotency-Key": "one"})
    assert again.status_code == 202 and again.json()["id"] == done["id"]
    other = {**SHORT, "title": "another"}
    refused = client.post("/api/v1/plans", json=other, headers={"Idempotency-Key": "one"})
    assert refused.status_code == 409


def events_of(text: str) -> list[tuple[int, str, dict[str, Any]]]:
    found = []
    for block in text.strip().split("\n\n"):
        rows = dict(line.split(": ", 1) for line in block.split("\n") if not line.startswith(":"))
        found.append((int(rows["id"]), rows["event"], json.loads(rows["data"])))
    return found


def test_events_resume_after_the_last_one(client, done):
    path = f"/api/v1/plans/{done['id']}/events"
    every = events_of(client.get(path).text)
    assert [n for n, _, _ in every] == list(range(1, len(every) + 1))
    assert [data["state"] for _, kind, data in every if kind == "state"] == [
        "queued",
        "running",
        "done",
    ]
    assert any(kind == "stage" and data["text"] == "searching" for _, kind, data in every)
    rest = events_of(client.get(path, headers={"Last-Event-ID": "3"}).text)
    assert rest == every[3:]


def test_files_and_profile_of_a_route(client, done):
    base = f"/api/v1/plans/{done['id']}"
    rtz = client.get(f"{base}/routes/1.rtz")
    name = f"thalweg_{done['id'][:6]}_01"  # the name of the file is that of the route in it
    assert rtz.text.startswith("<?xml") and f'routeName="{name}"' in rtz.text
    assert f'filename="{name}.rtz"' in rtz.headers["content-disposition"]
    track = client.get(f"{base}/routes/1.geojson").json()
    assert track["type"] == "FeatureCollection"
    profile = client.get(f"{base}/profiles/1").json()
    columns = {len(values) for values in profile.values()}
    assert len(columns) == 1
    assert profile["lat"][0] == pytest.approx(47.0, abs=1e-4)
    assert profile["time"] == sorted(profile["time"])
    absent = client.get(f"{base}/routes/2.rtz")
    assert absent.status_code == 404 and "It has 1, numbered from 1" in absent.json()["detail"]
    blind = client.get(f"{base}/beside.json")
    assert blind.status_code == 404 and "no weather-blind route (number 0)" in blind.text


def test_an_exported_route_is_evaluated_and_compared(client, done):
    rtz = client.get(f"/api/v1/plans/{done['id']}/routes/1.rtz").content
    route = client.post("/api/v1/routes", files={"file": ("r.rtz", rtz, "application/xml")}).json()
    given = {name: SHORT[name] for name in ("ship", "seas", "coast")}
    started = client.post("/api/v1/evaluate", json={**given, "route": route["id"]}).json()
    job = ended(client.get, started["id"])
    assert job["state"] == "done", job["problem"]
    body = {"routes": [{"job": done["id"]}, {"job": job["id"]}]}
    rows = client.post("/api/v1/compare", json=body).json()["routes"]
    assert rows[1]["time_h"] == pytest.approx(rows[0]["time_h"], rel=1e-3)
    assert rows[1]["difference"]["fuel_t"] == pytest.approx(rows[1]["fuel_t"] - rows[0]["fuel_t"])
    assert rows[1]["broken"] == []
    assert rows[0]["notes"] == rows[1]["notes"] == []
    assert [(row["approach_nm"], row["approach_h"]) for row in rows] == [(0.0, 0.0)] * 2


def test_a_route_over_land_is_compared_with_the_place_of_the_land(client, done):
    over_land = b"lat,lon\n47.0,-5.0\n48.0,-3.0\n49.0,-4.0\n"  # through Brittany
    route = client.post("/api/v1/routes", files={"file": ("r.csv", over_land)}).json()
    given = {name: SHORT[name] for name in ("ship", "seas", "coast")}
    order = {**given, "route": route["id"], "depart": "2026-01-01T00:00Z"}
    job = ended(client.get, client.post("/api/v1/evaluate", json=order).json()["id"])
    body = {"routes": [{"job": done["id"]}, {"job": job["id"]}]}
    row = client.post("/api/v1/compare", json=body).json()["routes"][1]
    (note,) = row["notes"]  # both begin at 47 N 5 W
    assert note.startswith("It ends") and "same stretch" in note
    assert not row["feasible"] and row["violations"] == len(row["broken"]) >= 1
    result = client.get(f"/api/v1/plans/{job['id']}/result").json()
    assert any("under-keel clearance was not checked" in text for text in result["assumptions"])
    of_member = client.post("/api/v1/evaluate", json={**order, "member": 1}).json()
    refused = ended(client.get, of_member["id"])  # the sea has no members
    assert refused["state"] == "failed" and "ensemble" in refused["problem"]["detail"]
    land = [one for one in row["broken"] if one["reason"].startswith("land")]
    assert land and all(47.0 < one["lat"] < 49.0 for one in land)


def test_a_voyage_without_a_route_fails_with_its_reasons(client):
    outer = [[-6, 46.5], [-4, 46.5], [-4, 47.2], [-6, 47.2], [-6, 46.5]]
    inner = [[-5.1, 46.9], [-5.1, 47.1], [-4.9, 47.1], [-4.9, 46.9], [-5.1, 46.9]]
    areas = {
        "type": "Feature",
        "properties": {"kind": "no-go"},
        "geometry": {"type": "Polygon", "coordinates": [outer]},
    }
    refused = client.post("/api/v1/plans", json={**SHORT, "areas": areas})
    assert refused.status_code == 422 and refused.json()["field"] == "start"
    areas["geometry"] = {"type": "Polygon", "coordinates": [outer, inner]}  # around the start
    started = client.post("/api/v1/plans", json={**SHORT, "areas": areas}).json()
    job = ended(client.get, started["id"])
    assert job["state"] == "failed" and not job["result"]
    assert job["problem"]["asked"] and job["problem"]["remedy"]
    assert client.get(f"/api/v1/plans/{job['id']}/result").status_code == 409


def test_a_waiting_job_is_cancelled_at_once_and_lists_are_paged(client, done):
    first = client.post("/api/v1/plans", json=CROSSING).json()
    second = client.post("/api/v1/plans", json=SHORT).json()
    assert client.delete(f"/api/v1/plans/{second['id']}").json()["state"] == "cancelled"
    client.delete(f"/api/v1/plans/{first['id']}")
    assert ended(client.get, first["id"])["state"] == "cancelled"
    page = client.get("/api/v1/plans", params={"size": 1}).json()
    assert len(page["jobs"]) == 1
    more = client.get("/api/v1/plans", params={"size": 1, "cursor": page["cursor"]}).json()
    assert more["jobs"][0]["number"] < page["jobs"][0]["number"]


def test_cancelling_keeps_the_route_found_so_far(client):
    job = client.post("/api/v1/plans", json=CROSSING).json()["id"]
    limit = time.monotonic() + LONG_S
    while time.monotonic() < limit:
        rows = events_of(_events(client, job))
        if any(kind == "route" for _, kind, _ in rows):
            break
        time.sleep(0.1)
    client.delete(f"/api/v1/plans/{job}")
    found = ended(client.get, job)
    assert found["state"] == "cancelled" and found["result"]
    result = client.get(f"/api/v1/plans/{job}/result").json()
    assert result["cancelled"] is True and result["routes"][0]["feasible"]


class Messages(list):
    """What a child sends to the server."""

    def send(self, kind, data):
        self.append((kind, data))


@pytest.mark.parametrize("press_at", [1, 2], ids=["first route", "whole plan"])
def test_a_job_stopped_while_it_writes_a_result_keeps_it_whole(tmp_path, monkeypatch, press_at):
    written = []
    write = job_work.write_plan_result

    def write_and_press(*given, **options):
        written.append(given[1])
        if len(written) == press_at:
            signal.raise_signal(signal.SIGINT)
        return write(*given, **options)

    monkeypatch.setattr(job_work, "write_plan_result", write_and_press)
    request = {**SHORT, "voyage": {**SHORT["voyage"], "objective": "cost"}}
    request = PlanRequest.model_validate(request).model_dump(mode="json")
    messages = Messages()
    order = JobOrder("plan", request, str(tmp_path), {})
    if press_at == 1:
        with pytest.raises(KeyboardInterrupt):
            job_work.run_order(order, messages)
        sent = [data for kind, data in messages if kind == "route" and "summary" in data]
        parts, folder = sent[-1]["summary"]["parts"], order.first_path
    else:
        state, summary = job_work.run_order(order, messages)
        assert state == "done"
        parts, folder = summary["parts"], tmp_path
    assert parts and folder == written[-1]
    assert json.loads((folder / "plan.json").read_text())["routes"]


def test_a_job_that_is_queued_again_and_stopped_keeps_its_first_route(server):
    request = {**CROSSING, "voyage": {**CROSSING["voyage"], "objective": "front"}}
    job = server.http.post("/api/v1/plans", json=request).json()["id"]
    first = _until_first_route(server, job)
    kept = result_of_stop_after_kill(server, job)
    assert kept["routes"][0]["time_h"] == pytest.approx(first, abs=1e-3)


def _until_first_route(server, job):
    """Wait until the fastest route of a job is kept; return its time [h]."""
    with server.http.stream("GET", f"/api/v1/plans/{job}/events") as stream:
        for line in stream.iter_lines():
            if line.startswith("data: "):
                data = json.loads(line[6:])
                if "summary" in data:
                    return data["route"]["time_h"]
    raise AssertionError("the job ended without a first route")


def test_a_stopped_front_keeps_the_faster_route_that_was_shown_first():
    from thalweg import Chart, Sea, Ship, Voyage, plan

    ship, chart = Ship.load("handysize-bulker"), Chart.open_water(46.0, 49.0, -22.0, -18.0)
    ends = {"start": (47.0, -20.0), "goal": (47.0, -19.0), "depart": "1998-08-31T12:00Z"}
    given = {"ship": ship, "sea": Sea.storm(), "chart": chart, "resolution": 8000.0, "proof": 0.0}
    first = plan(Voyage(**ends), **given).best
    whole = plan(Voyage(**ends, objective="front"), **given)
    slow = [k for k, route in enumerate(whole.routes) if route.time_h > first.time_h + 0.2]
    part = replace(
        whole, routes=tuple(whole.routes[k] for k in slow), cancelled=True,
        front=replace(
            whole.front, values=whole.front.values[slow],
            stages=tuple(whole.front.stages[k] for k in slow),
            ways=tuple(whole.front.ways[k] for k in slow),
        ),
    )  # fmt: skip
    found = job_work.with_faster_route(part, first)
    assert found.routes[0] is first and found.routes[1:] == part.routes
    assert found.front.values[0] == pytest.approx(found.front.objective.value(first))
    assert (np.diff(found.front.values) < 0.0).all()
    assert len(found.to_dict()["front"]["points"]) == len(found.routes)
    assert job_work.with_faster_route(whole, whole.routes[1]) is whole  # not faster


def test_the_route_beside_a_front_is_one_that_keeps_the_limits_if_there_is_one():
    world = SimpleNamespace(sea=SimpleNamespace(members=0))
    request = SimpleNamespace(seas=["storm"])
    fast, slow = SimpleNamespace(feasible=False), SimpleNamespace(feasible=True)

    def beside(*routes):
        front = SimpleNamespace(comparison=SimpleNamespace(routes=routes))
        return job_work._beside(SimpleNamespace(front=front), world, request, None)

    assert beside(fast, slow) is slow
    assert beside(fast) is fast  # the page says that it breaks a limit
    assert beside() is None


def test_a_front_is_sent_while_it_is_searched(client):
    voyage = {**SHORT["voyage"], "objective": "fuel"}
    job = client.post("/api/v1/plans", json={**SHORT, "voyage": voyage}).json()["id"]
    assert ended(client.get, job)["state"] == "done"
    sent = events_of(_events(client, job))
    fronts = [data for _, kind, data in sent if kind == "front"]
    assert len(fronts) >= 2
    for front in fronts:
        hours, tonnes = zip(*front["points"])
        assert front["unit"] == "t"
        assert list(hours) == sorted(hours) and list(tonnes) == sorted(tonnes, reverse=True)
    routes = [data for _, kind, data in sent if kind == "route"]
    assert [data["final"] for data in routes].count(True) == 1 and not routes[0]["final"]


def _events(client, job: str) -> str:
    store = client.app.state.service.store
    rows = store.events(job)
    return "\n\n".join(f"id: {e.n}\nevent: {e.kind}\ndata: {json.dumps(e.data)}" for e in rows)


def test_an_empty_key_is_no_key(tmp_path):
    from thalweg.service.jobs.job_store import JobStore

    store = JobStore(tmp_path / "jobs.sqlite")
    added = [store.add(name, "plan", {}, key="", queue=9)[1] for name in "ab"]
    assert added == [True, True]
    store.close()


def test_a_queue_that_is_full_says_so(tmp_path):
    from thalweg.service.jobs.job_store import JobStore
    from thalweg.service.problem_details import ServiceError

    store = JobStore(tmp_path / "jobs.sqlite")
    for name in "ab":
        store.add(name, "plan", {}, key=None, queue=2)
    with pytest.raises(ServiceError) as refused:
        store.add("c", "plan", {}, key=None, queue=2)
    assert refused.value.status == 429
    store.close()


def test_a_job_survives_a_kill_of_its_process_and_of_the_service(server):
    started = server.http.post("/api/v1/plans", json=CROSSING).json()["id"]
    waiting = server.http.post("/api/v1/plans", json=SHORT).json()["id"]
    _until_running(server, started)
    os.kill(_working_child(server), signal.SIGKILL)
    limit = time.monotonic() + LONG_S
    while server.http.get(f"/api/v1/plans/{started}").json()["attempt"] < 2:
        assert time.monotonic() < limit
        time.sleep(0.05)
    server.kill()
    server.start()
    assert server.http.get(f"/api/v1/plans/{waiting}").json()["state"] == "queued"
    server.http.delete(f"/api/v1/plans/{started}")
    assert ended(server.http.get, started)["state"] == "cancelled"
    short = ended(server.http.get, waiting)
    assert short["state"] == "done" and short["attempt"] == 1
    kinds = events_of(server.http.get(f"/api/v1/plans/{started}/events").text)
    assert [n for n, _, _ in kinds] == list(range(1, len(kinds) + 1))
    left = [path.name for path in (server.folder / "results").iterdir()]
    assert all((server.folder / "results" / name / "end.json").exists() for name in left)


def _until_running(server, job: str) -> None:
    limit = time.monotonic() + LONG_S
    while server.http.get(f"/api/v1/plans/{job}").json()["state"] != "running":
        assert time.monotonic() < limit
        time.sleep(0.05)


def _working_child(server) -> int:
    """Return the child that was started first: it took the first job, and the other waits."""
    return min(server.children())


def test_a_second_service_on_the_same_data_is_refused(client):
    from thalweg.core.errors import InputError
    from thalweg.service.application import create_application

    with pytest.raises(InputError, match="Another service"):
        create_application(client.app.state.service.settings)


#: Zones of traffic across the short voyage.
FERRIES = {
    "type": "FeatureCollection",
    "elsewhere": {"encounters_per_h": 0.5},
    "features": [
        {
            "type": "Feature",
            "properties": {"name": "ferries", "encounters_per_h": 4.0},
            "geometry": {
                "type": "Polygon",
                "coordinates": [
                    [[-5.2, 47.1], [-5.1, 47.1], [-5.1, 47.2], [-5.2, 47.2], [-5.2, 47.1]]
                ],
            },
        }
    ],
}


def test_alternatives_are_routes_with_names_and_figures(client):
    file = {"file": ("ferries.geojson", json.dumps(FERRIES).encode())}
    traffic = client.post("/api/v1/traffic", files=file).json()["id"]
    request = {**SHORT, "traffic": [traffic], "most": 2}
    answer = client.post("/api/v1/alternatives", json=request)
    assert answer.status_code == 202 and answer.json()["kind"] == "alternatives"
    job = ended(client.get, answer.json()["id"])
    assert job["state"] == "done", job["problem"]
    found = client.get(f"/api/v1/plans/{job['id']}/result").json()
    rows = found["alternatives"]
    assert 1 <= len(rows) == job["summary"]["routes"] <= 2
    assert rows[0]["difference"] == "the fastest" and not found["cancelled"]
    assert all(row["figures"]["encounters"] > 0.0 for row in rows)
    assert client.get(f"/api/v1/plans/{job['id']}/routes/1.rtz").status_code == 200
    profile = client.get(f"/api/v1/plans/{job['id']}/profiles/1").json()
    assert len(profile["time"]) == len(profile["lat"])
    pair = [{"job": job["id"], "number": 1}] * 2
    assert client.post("/api/v1/compare", json={"routes": pair}).status_code == 200


def test_a_plan_keeps_limits_of_indicators_and_states_encounters(client):
    file = {"file": ("ferries.geojson", json.dumps(FERRIES).encode())}
    traffic = client.post("/api/v1/traffic", files=file).json()["id"]
    voyage = {**SHORT["voyage"], "layered": {"layers": 5, "fan": 3, "offset_nm": 2.0}}
    request = {**SHORT, "voyage": {**voyage, "at_most": {"encounters": 50}}, "traffic": [traffic]}
    job = ended(client.get, client.post("/api/v1/plans", json=request).json()["id"])
    assert job["state"] == "done", job["problem"]
    plan = client.get(f"/api/v1/plans/{job['id']}/result").json()
    assert 0.0 < plan["routes"][0]["indicators"]["encounters"] < 50.0
    assert plan["voyage"]["at_most"] == {"encounters": 50.0}


def test_an_evaluation_requires_the_clearance_of_the_ship_unless_it_gives_one(client, tmp_path):
    import xarray as xr

    axes = {"lat": np.linspace(46.5, 47.5, 11), "lon": np.linspace(-6.0, -4.5, 16)}
    attrs = {"standard_name": "height_above_mean_sea_level", "units": "m"}
    bed = xr.DataArray(np.full((11, 16), -12.0), axes, ("lat", "lon"), attrs=attrs)
    xr.Dataset({"elevation": bed}).to_netcdf(tmp_path / "depth.nc")
    content = (tmp_path / "depth.nc").read_bytes()
    depth = client.post("/api/v1/seas", params={"name": "depth.nc"}, content=content).json()["id"]
    line = b"lat,lon\n47.0,-5.0\n47.1,-5.2\n"
    route = client.post("/api/v1/routes", files={"file": ("r.csv", line)}).json()["id"]
    text = (
        b"name: coaster\nspeeds_kn: [10]\nhull: {draught_m: 9.5}\nmodels: {calm_water: none}\n"
        b"limits: {min_under_keel_clearance_m: 3}\n"
    )
    ship = client.post("/api/v1/ships", files={"file": ("own.yaml", text)}).json()["id"]
    order = {"ship": ship, "seas": ["calm"], "coast": "c", "depths": [depth], "route": route}
    order["depart"] = "2026-01-01T00:00Z"
    for given, feasible in (({}, False), ({"min_ukc_m": 2}, True)):
        started = client.post("/api/v1/evaluate", json=order | given).json()
        job = ended(client.get, started["id"])
        assert job["state"] == "done", job["problem"]
        result = client.get(f"/api/v1/plans/{job['id']}/result").json()
        assert result["feasible"] is feasible and result["min_ukc_m"] == pytest.approx(2.5)
