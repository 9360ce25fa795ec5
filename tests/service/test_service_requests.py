"""Requests of the service: access, errors at their field, catalogue, fields, coast, routes."""

from __future__ import annotations

import gzip
import json
import math
import os
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.service.conftest import SHORT, TOKEN
from thalweg.core.errors import OutsidePeriodError

pytest.importorskip("fastapi", reason='the extra "serve" is not installed')


def problem(answer: Any, status: int) -> dict[str, Any]:
    assert answer.status_code == status, answer.text
    assert answer.headers["content-type"].startswith("application/problem+json")
    found: dict[str, Any] = answer.json()
    assert found["status"] == status and found["asked"]
    return found


def test_a_request_without_the_token_is_refused(client):
    found = problem(client.get("/api/v1/health", headers={"Authorization": "Bearer wrong"}), 401)
    assert "token" in found["asked"] and found["remedy"]
    assert client.get("/static/app/main.js", headers={"Authorization": ""}).status_code == 401


def test_the_first_page_turns_the_token_into_a_cookie_for_its_own_pages(client):
    plain = {"Authorization": ""}
    assert client.get("/", headers=plain).status_code == 401
    assert 'name="token"' in client.get("/", headers=plain).text  # a field to type it in
    wrong = client.get("/?token=wrong", headers=plain, follow_redirects=False)
    assert wrong.status_code == 401 and "not the token" in wrong.text
    right = client.get(f"/?token={TOKEN}", headers=plain, follow_redirects=False)
    assert right.status_code == 303 and right.headers["location"] == "/"
    cookie = right.headers["set-cookie"]
    assert "HttpOnly" in cookie and "SameSite=lax" in cookie
    client.cookies.clear()


def test_another_host_or_origin_is_refused(client):
    problem(client.get("/api/v1/health", headers={"Host": "evil.example:8765"}), 403)
    problem(client.get("/api/v1/health", headers={"Origin": "http://evil.example"}), 403)
    own = client.get("/api/v1/health", headers={"Origin": "http://127.0.0.1:8765"})
    assert own.status_code == 200


def test_pages_load_nothing_from_other_sites(client):
    page = client.get("/")
    assert "default-src 'self'" in page.headers["content-security-policy"]
    assert "unsafe" not in page.headers["content-security-policy"]
    assert "http://" not in page.text and "https://" not in page.text


def test_health_ships_and_ports(client):
    assert client.get("/api/v1/health").json()["status"] == "ok"
    ships = {ship["id"]: ship for ship in client.get("/api/v1/ships").json()}
    assert ships["handysize-bulker"]["library"] is True
    best = client.get("/api/v1/ports", params={"q": "rotter", "count": 1}).json()[0]
    assert best["locode"] == "NLRTM"
    listed = client.get("/api/v1/ports", params={"q": "Dover"}).json()
    assert listed[0]["label"] == "Dover Harbor, GB"  # as the name alone is understood
    for beginning in ("hodeid", "hudayd", "al ahm"):  # names of one port
        found = client.get("/api/v1/ports", params={"q": beginning}).json()
        assert "Hodeidah, YE" in [port["label"] for port in found]
    near = client.get("/api/v1/ports", params={"near": "51.9,4.1", "count": 3}).json()
    assert [p["distance_nm"] for p in near] == sorted(p["distance_nm"] for p in near)


def test_a_place_is_shown_as_it_is_understood(client):
    found = client.get("/api/v1/places", params={"text": "51 57.3N 004 02.1E"}).json()
    assert found["lat"] == pytest.approx(51.955) and found["lon"] == pytest.approx(4.035)
    unknown = problem(client.get("/api/v1/places", params={"text": "Rotterdamm"}), 422)
    assert "Rotterdam" in unknown["possible"]


def test_a_port_states_where_a_route_to_it_ends(client):
    from thalweg.chart.approaches import PORT_APPROACHES
    from thalweg.chart.ports import PORTS

    found = client.get("/api/v1/places", params={"text": "Rotterdam"}).json()
    way = PORT_APPROACHES.of(PORTS.lookup("Rotterdam"))
    assert tuple(found["approach"]["berth"]) == way.berth == way.line[0]
    assert tuple(found["approach"]["sea_end"]) == way.line[-1]
    assert found["approach"]["length_nm"] == pytest.approx(way.length / 1852.0, abs=0.05)
    without = next(port for port in PORTS.all if PORT_APPROACHES.reason(port))
    found = client.get("/api/v1/places", params={"text": without.label}).json()
    assert found["kind"] == "port" and found["approach"] is None


@pytest.mark.parametrize(
    ("change", "field", "word"),
    [
        ({"voyage": {**SHORT["voyage"], "start": "Nowhere at all"}}, "start", "port"),
        ({"voyage": {**SHORT["voyage"], "goal": "Rotterdamm"}}, "goal", "port"),
        ({"voyage": {**SHORT["voyage"], "speed_kn": -3}}, "speed_kn", "range"),
        ({"voyage": {**SHORT["voyage"], "speed_kn": 45}}, "speed_kn", "10.3"),
        ({"voyage": {**SHORT["voyage"], "speed_kn": 45}, "ship": "jbc"}, "speed_kn", "engines"),
        ({"voyage": {**SHORT["voyage"], "goal": SHORT["voyage"]["start"]}}, "goal", "same place"),
        ({"voyage": {**SHORT["voyage"], "start": "Hull", "goal": "GBHUL"}}, "goal", "same place"),
        ({"voyage": {**SHORT["voyage"], "via": ["47N 5W"]}}, "via.0", "same place"),
        ({"voyage": {**SHORT["voyage"], "avoid": ["swez"]}}, "avoid", "suez"),
        ({"voyage": {**SHORT["voyage"], "forbid": ["panamax"]}}, "forbid", "panama"),
        ({"voyage": {**SHORT["voyage"], "open": ["Beagel"]}}, "open", "Beagle"),
        ({"seas": ["storm"]}, "depart", "1998-09-08"),
        ({"ship": "titanic"}, "ship", "titanic"),
        ({"seas": ["0123456789abcdef"]}, "seas", "sea"),
        ({"seas": ["calm", "storm"]}, "seas", "calm"),
        ({"seas": ["../../etc/passwd"]}, "seas.0", "uploaded sea"),
        ({"voyage": {**SHORT["voyage"], "depart": "tomorrow"}}, "depart", "time"),
        ({"voyage": {**SHORT["voyage"], "start": [91, 0]}}, "start", "latitude"),
        ({"voyage": {**SHORT["voyage"], "goal": "95N 5W"}}, "goal", "latitude"),
        ({"voyage": {**SHORT["voyage"], "via": ["95, 5"]}}, "via.0", "latitude"),
        ({"voyage": {**SHORT["voyage"], "goal": [48.0, 2.0]}}, "goal", "navigable water"),
        ({"voyage": {**SHORT["voyage"], "via": ["48N 2E"]}}, "via.0", "navigable water"),
        ({"voyage": {**SHORT["voyage"], "speeed_kn": 9}}, "speeed_kn", "speed_kn"),
        ({"voyage": {**SHORT["voyage"], "wait": "maybe"}}, "wait", "true or false"),
        ({"voyage": {"start": "47N 5W", "depart": "2026-01-01"}}, "goal", "no goal"),
        ({"voyage": {"start": "47N 5W", "goal": "48N 5W"}}, "depart", "departure"),
        ({"areas": {"type": "Point", "coordinates": [0, 0]}}, "areas", "areas only"),
        ({"voyage": {**SHORT["voyage"], "speed_kn": "fast"}}, "speed_kn", "number"),
        ({"voyage": {**SHORT["voyage"], "arrive_by": "1990-01-01"}}, "arrive_by", "after"),
        ({"surprise": 1}, "surprise", "known"),
        ({"min_ukc": 1.0}, "min_ukc", "Did you mean voyage.min_ukc_m"),
        ({"resolution": 1.0}, "resolution", "Did you mean resolution_nm?"),
        ({"depart": "2026-01-01"}, "depart", "Did you mean voyage.depart?"),
        ({"voyage": {**SHORT["voyage"], "min_ukc": 1.0}}, "min_ukc", "'min_ukc_m'"),
        ({"voyage": {**SHORT["voyage"], "load_factor": 1.0}}, "load_factor", "beside voyage"),
        ({"voyage": {**SHORT["voyage"], "start": "51,45"}}, "start", "decimal comma"),
        ({"voyage": {**SHORT["voyage"], "at_most": {"sickness": 3}}}, "at_most", "sick_percent"),
        ({"voyage": {**SHORT["voyage"], "objective": "weighted"}}, "weights", "weights"),
        ({"voyage": {**SHORT["voyage"], "layered": {"fan": 3}}}, "layered", "layers"),
        ({"voyage": {**SHORT["voyage"], "layered": {"near_coast_nm": -1}}}, "layered", "0"),
        (
            {"voyage": {**SHORT["voyage"], "layered": {"near_coast_nm": 3}}, "network": "globe"},
            "network",
            "layered",
        ),
        ({"network": "history"}, "network", "layered"),
        ({"history": "0123456789abcdef"}, "history", "history network"),
        ({"history": "0123456789abcdef", "network": "mesh"}, "network", "history"),
        ({"corridor_gain_percent": 5}, "corridor_gain_percent", "history"),
        ({"traffic": ["0123456789abcdef"]}, "traffic", "traffic"),
        ({"traffic": ["../../etc/passwd"]}, "traffic.0", "pattern"),
        ({"charges": {"ets_price": 80}}, "charges.share_percent", "ports"),
        ({"sampling": "nearest:soon"}, "sampling", "nearest:HOURS"),
        ({"sampling": "nearest:0"}, "sampling", "apart"),
        ({"fill": {"waves": "nearest:500"}}, "fill", "nearest:NM"),
        ({"fill": {"wind": 5}}, "fill", "direction"),
        ({"fill": {"waves": ["nearest:25", -1]}}, "fill", "range"),
        ({"variables": {"eastward_wind": "u"}}, "variables", "file"),
        ({"route_files": {"legs": "curve"}}, "route_files.legs", "rhumb"),
        ({"route_files": {"cross_track_nm": 0}}, "route_files.cross_track_nm", "0.001 or more"),
        ({"route_files": {"max_waypoints": 1}}, "route_files.max_waypoints", "or more"),
    ],
)
def test_an_impossible_request_is_refused_at_its_field(client, change, field, word):
    answer = client.post("/api/v1/plans", json={**SHORT, **change})
    absent = "0123456789abcdef" in (*change.get("seas", ()), *change.get("traffic", ()))
    absent |= change.get("history") is not None and "network" not in change
    found = problem(answer, 404 if absent else 422)
    assert found["field"] == field
    assert word in found["detail"]


def test_all_faults_of_a_request_are_stated_at_once(client):
    voyage = {"start": "Rotterdamm", "goal": "47.2N 19.5W", "objective": "times", "speed": 9}
    given = {"ship": "nosuch", "seas": ["stormy"], "foo": 1, "voyage": voyage, "coast": "z"}
    found = problem(client.post("/api/v1/plans", json=given), 422)
    assert {one["field"] for one in found["errors"]} == {
        "ship", "seas.0", "foo", "coast", "voyage.start", "voyage.objective", "voyage.speed",
        "voyage.depart",
    }  # fmt: skip
    assert all(one["asked"] and one["remedy"] for one in found["errors"])
    assert found["asked"] in [one["asked"] for one in found["errors"]]
    (unknown,) = [one for one in found["errors"] if one["field"] == "foo"]
    assert "proof_s" in unknown["possible"]


def test_the_faults_of_an_evaluation_are_stated_at_once(client):
    given = {"route": "0123456789abcdef", "ship": "nosuch", "seas": ["calm"], "depart": "soon"}
    found = problem(client.post("/api/v1/evaluate", json=given), 422)
    assert [one["field"] for one in found["errors"]] == ["depart", "ship", "route"]


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"depart": "soon"}, "depart"),
        ({"hold": "speed"}, "hold"),
        ({"charges": {"ets_price": 80}}, "charges.share_percent"),
        ({"sampling": "nearest:0"}, "sampling"),
    ],
)
def test_an_impossible_evaluation_is_refused_at_its_field(client, change, field):
    given = {"route": "0123456789abcdef", "ship": "handysize-bulker", "seas": ["calm"], **change}
    found = problem(client.post("/api/v1/evaluate", json=given), 422)
    assert found["field"] == field and found["remedy"]


@pytest.mark.parametrize(
    ("change", "field", "word"),
    [
        ({"speed_kn": 45}, "speed_kn", "kW"),
        ({"speed_kn": 45, "hold": "speed"}, "speed_kn", "kW"),
        ({"seas": ["storm"]}, "depart", "1998-09-08"),
        ({"seas": ["storm"], "depart": "1998-01-01"}, "depart", "1998-08-24"),
    ],
)
def test_an_evaluation_that_its_ship_or_sea_cannot_do_is_refused(client, change, field, word):
    route = b"lat,lon,time\n50,-10,2026-01-01T00:00Z\n50,-11,\n"
    sent = client.post("/api/v1/routes", files={"file": ("a.csv", route)}).json()
    given = {"route": sent["id"], "ship": "jbc", "seas": ["calm"], **change}
    found = problem(client.post("/api/v1/evaluate", json=given), 422)
    assert found["field"] == field and word in found["detail"] and found["remedy"]


@pytest.mark.slow
def test_a_departure_within_one_of_several_seas_is_taken(client):
    import xarray as xr

    times = np.array(["2026-01-01", "2026-01-03"], "M8[ns]")
    axes = {"time": times, "latitude": [40.0, 50.0], "longitude": [-20.0, 0.0]}
    calm = xr.DataArray(np.zeros((2, 2, 2)), axes, list(axes), attrs={"units": "m s-1"})
    parts = {"u10": calm, "v10": calm}
    path = client.app.state.service.settings.folder / "wind.nc"
    xr.Dataset(parts).to_netcdf(path)
    sent = client.post("/api/v1/seas", params={"name": "wind.nc"}, content=path.read_bytes())
    assert all(not key.startswith(".part") for key in sent.json()["missing_fraction"])
    from thalweg.planning import Voyage
    from thalweg.service.endpoints.order_checks import check_plan_order
    from thalweg.service.jobs.plan_request import PlanRequest

    for day, refused in (("2026-01-02", False), ("1998-09-01", False), ("2026-01-03", True)):
        given = {**SHORT, "seas": [sent.json()["id"], "storm"]}
        voyage = Voyage.from_dict({**SHORT["voyage"], "depart": day})
        request = PlanRequest.model_validate(given)
        if refused:
            with pytest.raises(OutsidePeriodError, match="outside the data"):
                check_plan_order(request, voyage, client.app.state.service)
        else:
            check_plan_order(request, voyage, client.app.state.service)


def test_too_few_routes_to_compare_are_named_in_plain_words(client):
    found = problem(client.post("/api/v1/compare", json={"routes": []}), 422)
    assert found["asked"] == "routes has 0 entries." and found["possible"] == "It has at least 2."
    found = problem(client.post("/api/v1/plans", json={**SHORT, "seas": ["calm"] * 21}), 422)
    assert found["asked"] == "seas has 21 entries." and found["possible"] == "It has at most 20."


def test_messages_advise_entries_of_the_request_and_no_options():
    from thalweg.core.errors import InputError
    from thalweg.service.problem_details import problem_of

    error = InputError(
        "No depth (--depth FILE).",
        "Load less (--load-factor), require less clearance (--ukc), or --depart-window.",
        "Start it with --allow-host NAME; plan without waits (--no-wait).",
    )
    found = problem_of(error)
    assert found["asked"] == "No depth (depths)."
    assert found["possible"] == (
        "Load less (load_factor), require less clearance (voyage.min_ukc_m), or "
        "voyage.depart_window."
    )
    assert found["remedy"] == (
        "Start it with --allow-host NAME; plan without waits (voyage.wait: false)."
    )
    assert found["detail"] == " ".join(found[key] for key in ("asked", "possible", "remedy"))


@pytest.mark.parametrize(
    ("fill", "refused"),
    [
        ({"waves": 0}, True),
        ({"wind": "nearest:20"}, True),
        ({"wind": [0, "nearest:20"]}, False),
        ({"wind": 0, "waves": 0}, False),
    ],
)
def test_departures_beyond_the_data_are_refused_unless_all_of_them_is_filled(client, fill, refused):
    import xarray as xr

    times = np.array(["2026-01-01", "2026-01-03"], "M8[ns]")
    axes = {"time": times, "latitude": [40.0, 50.0], "longitude": [-20.0, 0.0]}
    calm = xr.DataArray(np.zeros((2, 2, 2)), axes, list(axes), attrs={"units": "m s-1"})
    path = client.app.state.service.settings.folder / "beyond.nc"
    xr.Dataset({"u10": calm, "v10": calm}).to_netcdf(path)
    url = "/api/v1/seas"
    sent = client.post(url, params={"name": "beyond.nc"}, content=path.read_bytes()).json()
    from thalweg.planning import Voyage
    from thalweg.service.endpoints.order_checks import check_plan_order
    from thalweg.service.jobs.plan_request import PlanRequest

    voyage = Voyage.from_dict({**SHORT["voyage"], "depart": "2027-01-01"})
    request = PlanRequest.model_validate({**SHORT, "seas": [sent["id"]], "fill": fill})
    if refused:
        with pytest.raises(OutsidePeriodError, match="outside the data"):
            check_plan_order(request, voyage, client.app.state.service)
    else:
        check_plan_order(request, voyage, client.app.state.service)


@pytest.mark.slow
def test_variables_that_are_named_with_an_upload_are_used(client):
    import xarray as xr

    axes = {
        "time": np.array(["2026-01-01", "2026-01-03"], "M8[ns]"),
        "latitude": [46.0, 48.0],
        "longitude": [-6.0, -4.0],
    }
    parts = {
        name: xr.DataArray(np.full((2, 2, 2), value), axes, list(axes), attrs={"units": "m s-1"})
        for name, value in (("eastish", 3.0), ("northish", 4.0))
    }
    path = client.app.state.service.settings.folder / "own.nc"
    xr.Dataset(parts).to_netcdf(path)
    content = path.read_bytes()
    send = {"url": "/api/v1/seas", "content": content}
    refused = problem(client.post(params={"name": "own.nc"}, **send), 422)
    assert "variables in a request" in refused["remedy"]
    wrong = {"name": "own.nc", "variables": ["eastward_wind"]}
    assert problem(client.post(params=wrong, **send), 422)["field"] == "variables"
    named = {"eastward_wind": "eastish", "northward_wind": "northish"}
    query = {"name": "own.nc", "variables": [f"{key}={value}" for key, value in named.items()]}
    sent = client.post(params=query, **send)
    assert sent.status_code == 201 and sent.json()["frames"] == ["wind"]
    name = sent.json()["id"]
    frame = {"variable": "wind", "time": "2026-01-02T00:00Z", "box": "46,48,-6,-4"}
    data = client.get(f"/api/v1/seas/{name}/frames", params=frame).content
    assert (np.frombuffer(data, "<i2", offset=32) > 0).all()
    job = client.post("/api/v1/plans", json={**SHORT, "seas": [name], "fill": {"waves": 0.0}})
    assert job.json()["request"]["variables"] == named
    client.delete(f"/api/v1/plans/{job.json()['id']}")


@pytest.mark.parametrize(
    ("kind", "change", "field"),
    [
        ("studies", {"voyage": {"start": "Hull", "goal": "GBHUL", "depart": "1998-09-01"}}, "goal"),
        ("studies", {"voyage": {"start": "Hull", "goal": "Halifax", "depart": "2020"}}, "depart"),
        ("studies", {"axes": {"depart": ["2020-01-01", "2021-01-01"]}}, "depart"),
        ("studies", {"sample": {"speed_kn": {"normal": [12, -1]}}}, "speed_kn"),
        ("projects", {"start": "2026-05-01"}, "start"),
    ],
)
def test_a_study_or_project_without_data_at_any_departure_is_refused(client, kind, change, field):
    pytest.importorskip("pyarrow", reason='the extra "studies" is not installed')
    from thalweg.service.jobs.batch_requests import PROJECT_EXAMPLE, STUDY_EXAMPLE

    if kind == "studies":
        body = {"study": {**STUDY_EXAMPLE["study"], "axes": {"speed_kn": [12]}, **change}}
    else:
        body = {"project": {**PROJECT_EXAMPLE["project"], "sea": "storm", **change}}
    found = problem(client.post(f"/api/v1/{kind}", json=body), 422)
    assert found["field"] == field and found["remedy"]


def test_unknown_jobs_and_paths_are_problems(client):
    problem(client.get("/api/v1/plans/0123456789abcdef"), 404)
    for found in (client.get("/api/v1/plans/nosuch"), client.delete("/api/v1/plans/nosuch")):
        stated = problem(found, 404)
        assert stated["asked"] == "There is no job 'nosuch'." and "/plans" in stated["remedy"]
    named = problem(client.post("/api/v1/compare", json={"routes": [{"job": "no"}] * 2}), 422)
    assert "the id of a job" in named["detail"] and "0-9a-f" not in named["detail"]
    problem(client.get("/api/v1/plans/..%2f..%2fetc"), 404)
    problem(client.get("/api/v1/nothing"), 404)
    problem(client.put("/api/v1/plans"), 405)


def test_a_body_above_the_limit_is_refused(client):
    answer = client.post("/api/v1/plans", content=b"x" * 1_100_000)
    assert problem(answer, 413)["possible"]


def test_the_interface_is_described_with_an_example(client):
    schema = client.get("/openapi.json").json()
    assert set(schema["paths"]) >= {
        "/api/v1/plans",
        "/api/v1/plans/{job_id}/events",
        "/api/v1/seas",
        "/api/v1/evaluate",
        "/api/v1/compare",
    }
    body = schema["paths"]["/api/v1/plans"]["post"]["requestBody"]["content"]["application/json"]
    assert body["examples"] if "examples" in body else body["schema"]


def test_every_operation_states_its_errors_as_problem_details(client):
    schema = client.get("/openapi.json").json()
    for path, methods in schema["paths"].items():
        for method, operation in methods.items():
            assert operation["description"], (path, method)
            errors = {k: v for k, v in operation["responses"].items() if int(k) >= 400}
            assert {"401", "403"} <= set(errors), (path, method)
            for error in errors.values():
                assert list(error["content"]) == ["application/problem+json"]
    posted = schema["paths"]["/api/v1/plans"]["post"]["responses"]
    assert {"202", "404", "409", "413", "422", "429"} <= set(posted)
    assert "HTTPValidationError" not in json.dumps(schema)
    given = client.post("/api/v1/plans", json={}).json()
    assert set(schema["components"]["schemas"]["Problem"]["required"]) <= set(given)


def test_every_body_has_examples_that_it_takes(client):
    from thalweg.service.endpoints import job_endpoints, route_endpoints

    schema = client.get("/openapi.json").json()
    checked = 0
    for path, methods in schema["paths"].items():
        content = methods.get("post", {}).get("requestBody", {}).get("content", {})
        if "application/json" not in content:
            continue
        body = content["application/json"]
        name = body["schema"]["$ref"].rpartition("/")[2]
        model = getattr(job_endpoints, name, None) or getattr(route_endpoints, name)
        examples = [
            *(one.get("value", one) for one in _listed(body.get("examples"))),
            *_listed(body["schema"].get("examples")),
            *schema["components"]["schemas"][name].get("examples", ()),
        ]
        assert examples, path
        for example in examples:
            taken = model.model_validate(example)
            if isinstance(taken, job_endpoints.PlanRequest):
                taken.checked_voyage()
            checked += 1
    assert checked >= 10


def _listed(given: Any) -> list[Any]:
    return list(given.values()) if isinstance(given, dict) else list(given or ())


def test_the_names_of_seas_are_those_of_the_documentation(client):
    page = (Path(__file__).parents[2] / "docs" / "howto" / "service_client.md").read_text("utf-8")
    embedded = [row["id"] for row in client.get("/api/v1/seas").json() if row.get("embedded")]
    assert sorted(embedded) == ["calm", "storm"]
    for name in (*embedded, "synthetic-estuary"):
        assert f'`"{name}"`' in page
    behind = {"seas": ["storm", "0123456789abcdef"]}
    problem(client.post("/api/v1/plans", json={**SHORT, **behind}), 404)
    estuary = {"seas": ["synthetic-estuary"]}
    found = problem(client.post("/api/v1/plans", json={**SHORT, **estuary}), 422)
    assert found["field"] == "seas.0"


def test_a_frame_holds_the_field_of_the_sea(client):
    from thalweg import Sea

    query = {"variable": "waves", "time": "1998-09-03T00:00Z", "box": "30,60,-70,-10"}
    answer = client.get("/api/v1/seas/storm/frames", params={**query, "nx": 31, "ny": 16})
    data = answer.content
    magic, nx, ny, fields, _, scale, south, north, west, east = struct.unpack_from(
        "<4sHHHHf4f", data
    )
    assert (magic, nx, ny, fields) == (b"TWF1", 31, 16, 3)
    assert (south, north, west, east) == (30.0, 60.0, -70.0, -10.0)
    values = np.frombuffer(data, "<i2", offset=32).reshape(fields, ny, nx) * scale
    low, high = (math.log(math.tan(math.pi / 4 + math.radians(lat) / 2)) for lat in (30.0, 60.0))
    y = np.linspace(high, low, ny)[5]
    lat = math.degrees(2 * math.atan(math.exp(y)) - math.pi / 2)
    lon = np.linspace(-70.0, -10.0, nx)[7]
    name = "sea_surface_wave_significant_height"
    true = Sea.storm().sample([name], 904780800.0, lat, lon)[name]
    assert values[0, 5, 7] == pytest.approx(float(true), abs=0.006)


def test_unknown_values_of_a_frame_stay_unknown(client):
    query = {"variable": "waves", "time": "1990-01-01T00:00Z", "box": "30,60,-70,-10"}
    data = client.get("/api/v1/seas/storm/frames", params=query).content
    assert (np.frombuffer(data, "<i2", offset=32) == -32768).all()


def test_the_depth_of_the_chart_is_that_of_the_global_layer(client):
    from thalweg.chart.depth.global_depth import coarse_depth

    query = {"box": "50,60,-5,10", "nx": 7, "ny": 5}
    answer = client.get("/api/v1/chart/depth", params=query)
    data = answer.content
    magic, nx, ny, fields, _, scale, *box = struct.unpack_from("<4sHHHHf4f", data)
    assert (magic, nx, ny, fields) == (b"TWF1", 7, 5, 1)
    assert box == [50.0, 60.0, -5.0, 10.0]
    values = np.frombuffer(data, "<i2", offset=32).reshape(5, 7) * scale
    lon = np.linspace(-5.0, 10.0, 7)
    wanted = coarse_depth(np.full(7, 60.0), lon)  # the first row is the north of the box
    known = np.isfinite(wanted)
    np.testing.assert_allclose(values[0][known], wanted[known], atol=0.3)
    assert (values[0][~known] == -32768 * scale).all()
    problem(client.get("/api/v1/chart/depth", params={**query, "box": "60,50,-5,10"}), 422)


def test_coast_cells_are_the_land_of_the_chart(client):
    import shapely

    from thalweg.chart import Chart

    index = client.get("/api/v1/coast/c").json()
    area = 0.0
    for name in index["cells"]:
        cell = client.get(f"/api/v1/coast/c/{name}.json").json()
        column, row = (int(part) for part in name.split("_"))
        side = index["side"]
        west, south = -180 + column * side, -90 + row * side
        box = shapely.box(west, south, west + side, south + side).buffer(0.03)
        for rings in cell["land"]:
            outer, *holes = (np.reshape(ring, (-1, 2)) for ring in rings)
            polygon = shapely.Polygon(outer, holes)
            assert box.contains(polygon)
            area += polygon.area
    whole = sum(p.area for p in Chart.gshhg("c").coastline.polygons(-90, 90, -180, 180))
    assert area == pytest.approx(whole, rel=2e-3)


def test_drafts_of_cells_that_were_left_long_ago_are_removed(tmp_path, monkeypatch):
    from thalweg.service.coast_map import cells_folder, remove_old_drafts

    monkeypatch.setenv("THALWEG_CACHE", str(tmp_path))
    folder = cells_folder("c").parent
    old, new = folder / ".part-old", folder / ".part-new"
    for draft in (old, new):
        draft.mkdir()
        (draft / "0_0.json.gz").write_bytes(b"")
    os.utime(old, (0, 0))
    remove_old_drafts()
    assert [path.name for path in folder.iterdir()] == [".part-new"]


def sea_file(folder: Path) -> Path:
    import xarray as xr

    lat, lon = np.arange(45.0, 50.1, 1.0), np.arange(-10.0, -1.9, 1.0)
    time = np.array(["2026-01-01", "2026-01-05"], dtype="datetime64[ns]")
    shape = (2, len(lat), len(lon))
    waves = "sea_surface_wave_significant_height"
    height = (("time", "lat", "lon"), np.full(shape, 2.5), {"units": "m", "standard_name": waves})
    axes = {
        "time": time,
        "lat": ("lat", lat, {"units": "degrees_north"}),
        "lon": ("lon", lon, {"units": "degrees_east"}),
    }
    one = xr.Dataset({"hs": height}, coords=axes)
    path = folder / "waves.nc"
    one.to_netcdf(path)
    return path


def test_an_uploaded_forecast_says_when_its_run_started(client, tmp_path):
    import xarray as xr

    path = tmp_path / "forecast.nc"
    fields = xr.load_dataset(sea_file(tmp_path))
    fields.assign_attrs(forecast_reference_time="2025-12-31T18:00:00Z").to_netcdf(path)
    kept = client.post("/api/v1/seas", params={"name": path.name}, content=path.read_bytes())
    assert kept.json()["run"] == "2025-12-31T18:00:00Z"


def test_an_uploaded_sea_is_inspected_and_kept_once(client, tmp_path):
    data = sea_file(tmp_path).read_bytes()
    first = client.post("/api/v1/seas", params={"name": "../waves.nc"}, content=data)
    assert first.status_code == 201, first.text
    found = first.json()
    assert found["name"] == "waves.nc" and found["frames"] == ["waves"]
    assert found["box"] == [45.0, 50.0, -10.0, -2.0] and found["start"].startswith("2026-01-01")
    assert "run" not in found
    again = client.post("/api/v1/seas", params={"name": "waves.nc"}, content=data).json()
    assert again["id"] == found["id"]
    query = {"variable": "waves", "time": "2026-01-02T00:00Z", "box": "46,49,-9,-3"}
    frame = client.get(f"/api/v1/seas/{found['id']}/frames", params=query).content
    assert np.frombuffer(frame, "<i2", offset=32)[: 96 * 64].max() == 250
    assert client.delete(f"/api/v1/seas/{found['id']}").status_code == 204
    kept = problem(client.delete("/api/v1/seas/storm"), 409)
    assert "'storm' is part of the package" in kept["asked"]
    problem(client.get(f"/api/v1/seas/{found['id']}"), 404)


def test_broken_uploads_are_refused_with_what_to_do(client, tmp_path):
    broken = sea_file(tmp_path).read_bytes()[:2000]
    found = problem(client.post("/api/v1/seas", params={"name": "a.nc"}, content=broken), 422)
    assert found["remedy"] and "/tmp" not in json.dumps(found)
    problem(client.post("/api/v1/seas", params={"name": "a.exe"}, content=b"x"), 415)
    problem(client.post("/api/v1/seas", params={"name": "a.nc"}, content=b""), 422)
    ship = {"file": ("ship.yaml", b"name: [", "text/yaml")}
    problem(client.post("/api/v1/ships", files=ship), 422)


def test_an_imported_route_has_the_waypoints_of_its_file(client):
    text = b"lat,lon\n47.0,-5.0\n47.2,-5.1\n47.3,-5.3\n"
    found = client.post("/api/v1/routes", files={"file": ("route.csv", text, "text/csv")}).json()
    assert found["waypoints"] == [[47.0, -5.0], [47.2, -5.1], [47.3, -5.3]]
    assert found["depart"] is None
    assert found["notes"] == []
    rtz = (
        '<route xmlns="http://www.cirm.org/RTZ/1/2" version="1.2"><routeInfo routeName="Other"/>'
        '<waypoints><waypoint id="1" revision="-1"><position lat="47" lon="-5"/></waypoint>'
        '<waypoint id="2" revision="0"><position lat="47.2" lon="-5"/></waypoint>'
        "</waypoints></route>"
    )
    notes = client.post("/api/v1/routes", files={"file": ("bay.rtz", rtz, "text/xml")}).json()[
        "notes"
    ]
    assert "revision '-1'" in notes[0] and "named 'Other'" in notes[1]
    packed = gzip.compress(text)
    problem(client.post("/api/v1/routes", files={"file": ("r.gpx", packed, "text/xml")}), 422)


def test_a_plan_of_a_ship_file_that_was_uploaded(client):
    from importlib import resources

    text = (resources.files("thalweg.ship") / "library" / "handysize-bulker.yaml").read_bytes()
    ship = client.post("/api/v1/ships", files={"file": ("own.yaml", text, "text/yaml")}).json()
    assert ship["name"].startswith("Handysize")
    sheet = client.get(f"/api/v1/ships/{ship['id']}").json()
    assert sheet["limits"]["wave_height_m"] == 8.0
    assert sheet["limits"]["wind_speed_m_s"] is None


def test_vendored_scripts_are_those_of_their_checksums():
    import hashlib

    from thalweg.service.application import STATIC

    vendor = STATIC / "vendor"
    rows = [line.split() for line in (vendor / "SHA256SUMS").read_text().splitlines()]
    assert {name for _, name in rows} == {
        p.name for p in vendor.iterdir() if p.suffix in (".mjs", ".css")
    }
    for digest, name in rows:
        assert hashlib.sha256((vendor / name).read_bytes()).hexdigest() == digest
    assert {p.stem for p in (vendor / "licences").iterdir()} >= {"ol", "uplot"}
    assert sum(p.stat().st_size for p in STATIC.rglob("*") if p.is_file()) < 850_000


def test_a_voyage_file_is_read_as_a_request(client):
    text = "start: Halifax\ngoal: 49.7N 6.5W\ndepart: 1998-08-31T12:00Z\n"
    found = client.post("/api/v1/voyages/read", json={"text": text}).json()
    assert found["voyage"]["goal"] == "49.7N 6.5W"
    whole = json.dumps(SHORT)
    assert client.post("/api/v1/voyages/read", json={"text": whole}).json() == SHORT
    wrong = client.post("/api/v1/voyages/read", json={"text": "start: Halifax\nspeed: 12\n"})
    assert "speed" in problem(wrong, 422)["asked"]
    assert problem(client.post("/api/v1/voyages/read", json={"text": "- a"}), 422)["remedy"]


TRAFFIC = {
    "type": "FeatureCollection",
    "elsewhere": {"encounters_per_h": 0.0},
    "features": [
        {
            "type": "Feature",
            "properties": {"name": "ferries", "encounters_per_h": 2.0},
            "geometry": {
                "type": "Polygon",
                "coordinates": [[[-6, 46], [-4, 46], [-4, 48], [-6, 48], [-6, 46]]],
            },
        }
    ],
}


def test_files_of_traffic_are_checked_when_they_arrive(client):
    def upload(name: str, content: bytes) -> Any:
        return client.post("/api/v1/traffic", files={"file": (name, content)})

    kept = upload("ferries.geojson", json.dumps(TRAFFIC).encode())
    assert kept.status_code == 201 and kept.json()["zones"] == ["ferries"]
    assert kept.json()["id"] in [row["id"] for row in client.get("/api/v1/traffic").json()]
    nothing = {**TRAFFIC, "features": [{**TRAFFIC["features"][0], "properties": {"name": "x"}}]}
    found = problem(upload("broken.geojson", json.dumps(nothing).encode()), 422)
    assert found["field"] == "file" and "encounters_per_h" in found["possible"]
    assert "no traffic" in problem(upload("empty.json", b"[]"), 422)["asked"]
    problem(upload("ferries.txt", b"x"), 415)
    assert client.delete(f"/api/v1/traffic/{kept.json()['id']}").status_code == 204
    problem(client.delete("/api/v1/traffic/0123456789abcdef"), 404)


@pytest.mark.slow
def test_history_networks_are_checked_when_they_arrive(client):
    answer = client.post("/api/v1/histories", files={"file": ("net.json", b'{"format": "other"}')})
    assert "history network" in problem(answer, 422)["asked"]
    assert client.get("/api/v1/histories").json() == []
    problem(client.delete("/api/v1/histories/0123456789abcdef"), 404)


def test_a_request_that_is_not_json_states_the_content_type_that_is_needed(client):
    sent = client.post(
        "/api/v1/plans", content=json.dumps(SHORT), headers={"Content-Type": "text/plain"}
    )
    found = problem(sent, 415)
    assert found["asked"] == "The body has the content type text/plain."
    assert "Content-Type: application/json" in found["remedy"]
    found = problem(client.post("/api/v1/plans", json=[SHORT]), 422)
    assert found["asked"] == "The body is no mapping of entries."


def test_a_missing_entry_is_described(client):
    sent = client.post("/api/v1/plans", json={k: SHORT[k] for k in SHORT if k != "seas"})
    found = problem(sent, 422)
    assert found["asked"] == "seas is missing." and found["remedy"] == "Add seas."
    assert found["possible"] == "It is needed: `calm`, `storm` or ids of /seas, by priority."
