"""`/openapi.json`: examples of every operation's answer, and answers of the stated form."""

from __future__ import annotations

import base64
import json
import struct

import pytest
from pydantic import TypeAdapter

from tests.service.conftest import SHORT, ended

pytest.importorskip("fastapi", reason='the extra "serve" is not installed')

from thalweg.service.answers.answer_descriptions import ANSWERS, answer_examples


def test_every_operation_has_examples_of_its_answer(client):
    schema = client.get("/openapi.json").json()
    known = set(ANSWERS)
    for path, methods in schema["paths"].items():
        for method, operation in methods.items():
            status, found = next(iter(operation["responses"].items()))
            assert status in ("200", "201", "202", "204")
            if status == "204":
                continue
            name = f"{method} {path.removeprefix('/api/v1')}"
            known.remove(name)
            media_type, content = next(iter(found["content"].items()))
            assert media_type == ANSWERS[name].media_type
            assert content["examples"] and content["schema"], name
    assert not known


def test_every_reference_of_the_description_exists(client):
    schema = client.get("/openapi.json").json()
    names = set(schema["components"]["schemas"])
    text = json.dumps(schema)
    used = {part.split('"')[0] for part in text.split("#/components/schemas/")[1:]}
    assert used <= names


@pytest.mark.parametrize("name", ANSWERS)
def test_examples_have_the_form_that_is_stated(name):
    form, examples, _ = ANSWERS[name]
    for example in examples:
        if form is None:
            assert isinstance(answer_examples()[example], str)
        else:
            TypeAdapter(form).validate_python(answer_examples()[example])


def test_the_examples_of_results_are_each_of_their_own_form():
    from thalweg.service.answers import result_models

    by_kind = {
        "plan": "PlanResult",
        "alternatives": "AlternativesResult",
        "evaluation": "RouteResult",
        "project": "ProjectAnswer",
        "study": "StudyAnswer",
        "forecast": "ForecastAnswer",
        "isochrones": "IsochronesAnswer",
        "beside": "BesideAnswer",
        "space_time": "SpaceTimeAnswer",
        "limits": "LimitsAnswer",
        "diagrams": "DiagramsAnswer",
    }
    for example, model in by_kind.items():
        getattr(result_models, model).model_validate(answer_examples()[example])


def test_the_frame_of_the_example_has_the_header_that_is_described():
    data = base64.b64decode(answer_examples()["frame as base64"])
    magic, nx, ny, fields, *_ = struct.unpack_from("<4sHHHHf4f", data)
    assert magic == b"TWF1" and len(data) == 32 + 2 * nx * ny * fields


def _check(name, answer):
    assert answer.status_code < 300, answer.text
    form = ANSWERS[name].form
    assert answer.headers["content-type"].startswith(ANSWERS[name].media_type)
    if form is not None:
        TypeAdapter(form).validate_python(answer.json())
    return answer


@pytest.mark.slow
def test_answers_of_the_catalogue_have_the_form_that_is_stated(client):
    for name, path in {
        "get /health": "health",
        "get /ships": "ships",
        "get /ships/{ship_id}": "ships/handysize-bulker",
        "get /ports": "ports?near=52,4&count=2",
        "get /places": "places?text=52N 4E",
        "get /coast/{level}": "coast/c",
        "get /coast/{level}/{cell}.json": "coast/c/0_0.json",
        "get /chart": "chart",
        "get /traffic": "traffic",
        "get /histories": "histories",
        "get /seas": "seas",
        "get /seas/{sea_id}": "seas/storm",
        "get /projects/example": "projects/example",
        "get /studies/ready": "studies/ready",
    }.items():
        _check(name, client.get(f"/api/v1/{path}"))
    body = {"text": "start: Halifax\ngoal: 49.7N 6.5W\ndepart: 1998-08-31T12:00Z\n"}
    _check("post /voyages/read", client.post("/api/v1/voyages/read", json=body))


@pytest.mark.slow
def test_answers_of_a_job_have_the_form_that_is_stated(client):
    started = _check("post /plans", client.post("/api/v1/plans", json=SHORT)).json()["id"]
    assert ended(client.get, started)["state"] == "done"
    at = f"/api/v1/plans/{started}"
    for name, path in {
        "get /plans": "/api/v1/plans",
        "get /plans/{job_id}": at,
        "get /plans/{job_id}/events": f"{at}/events",
        "get /plans/{job_id}/result": f"{at}/result",
        "get /plans/{job_id}/{part}.json": f"{at}/isochrones.json",
        "get /plans/{job_id}/profiles/{number}": f"{at}/profiles/1",
        "get /plans/{job_id}/routes/{number}.{form}": f"{at}/routes/1.csv",
    }.items():
        _check(name, client.get(path))
    route = client.get(f"{at}/routes/1.rtz").content
    _check("post /routes", client.post("/api/v1/routes", files={"file": ("a.rtz", route)}))
    pair = {"routes": [{"job": started, "number": 1}] * 2}
    _check("post /compare", client.post("/api/v1/compare", json=pair))
    _check("delete /plans/{job_id}", client.delete(at))
