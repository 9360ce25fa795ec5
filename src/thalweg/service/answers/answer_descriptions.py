"""The answer of each operation in `/openapi.json`: its media type, form and examples."""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any, Final, NamedTuple

from pydantic import TypeAdapter

from thalweg.service.answers import answer_models as answers
from thalweg.service.answers import result_models as results

JSON: Final = "application/json"
_TEMPLATE: Final = "#/components/schemas/{model}"


class OperationAnswer(NamedTuple):
    """The answer of an operation.

    Attributes
    ----------
    form : Its type; None where it is no JSON.
    examples : Names of its examples.
    media_type : Of the body.
    """

    form: Any
    examples: tuple[str, ...]
    media_type: str = JSON


_RESULTS = ("plan", "alternatives", "evaluation", "project", "study", "forecast")
_JOB = OperationAnswer(answers.JobAnswer, ("queued job",))
#: By method and path behind /api/v1.
ANSWERS: Final[Mapping[str, OperationAnswer]] = {
    "get /health": OperationAnswer(answers.HealthAnswer, ("health",)),
    "get /ships": OperationAnswer(list[answers.ShipEntry], ("ships",)),
    "post /ships": OperationAnswer(answers.ShipEntry, ("uploaded ship",)),
    "get /ships/{ship_id}": OperationAnswer(answers.ShipSheetAnswer, ("ship sheet",)),
    "get /ports": OperationAnswer(list[answers.PortAnswer], ("ports by name", "ports nearby")),
    "get /places": OperationAnswer(answers.PlaceAnswer, ("port", "position")),
    "get /coast/{level}": OperationAnswer(answers.CoastIndexAnswer, ("coast index",)),
    "get /coast/{level}/{cell}.json": OperationAnswer(answers.CoastCellAnswer, ("coast cell",)),
    "get /chart": OperationAnswer(answers.ChartAnswer, ("chart",)),
    "get /chart/depth": OperationAnswer(None, ("frame as base64",), "application/octet-stream"),
    "get /traffic": OperationAnswer(list[answers.TrafficAnswer], ("traffic files",)),
    "post /traffic": OperationAnswer(answers.TrafficAnswer, ("traffic file",)),
    "get /histories": OperationAnswer(list[answers.HistoryAnswer], ("history networks",)),
    "post /histories": OperationAnswer(answers.HistoryAnswer, ("history network",)),
    "get /seas": OperationAnswer(list[answers.SeaAnswer], ("seas",)),
    "post /seas": OperationAnswer(answers.SeaAnswer, ("uploaded sea",)),
    "get /seas/{sea_id}": OperationAnswer(answers.SeaAnswer, ("storm", "uploaded sea")),
    "get /seas/{sea_ids}/frames": OperationAnswer(
        None, ("frame as base64",), "application/octet-stream"
    ),
    "post /plans": _JOB,
    "get /plans": OperationAnswer(answers.JobListAnswer, ("jobs",)),
    "post /alternatives": _JOB,
    "post /evaluate": _JOB,
    "post /projects": _JOB,
    "get /projects/example": OperationAnswer(answers.ProjectExampleAnswer, ("example project",)),
    "get /studies/ready": OperationAnswer(list[answers.ReadyStudyAnswer], ("ready studies",)),
    "post /studies": _JOB,
    "post /forecasts": _JOB,
    "post /forecasts/estimate": OperationAnswer(answers.DownloadSizeAnswer, ("download size",)),
    "get /plans/{job_id}": OperationAnswer(answers.JobAnswer, ("finished job", "failed job")),
    "delete /plans/{job_id}": OperationAnswer(answers.JobAnswer, ("cancelled job",)),
    "get /plans/{job_id}/events": OperationAnswer(None, ("events",), "text/event-stream"),
    "get /plans/{job_id}/result": OperationAnswer(results.JobResult, _RESULTS),
    "get /plans/{job_id}/tables/{name}.csv": OperationAnswer(None, ("voyages",), "text/csv"),
    "get /plans/{job_id}/{part}.json": OperationAnswer(
        results.ResultPart, ("isochrones", "beside", "space_time", "limits", "diagrams")
    ),
    "get /plans/{job_id}/profiles/{number}": OperationAnswer(results.ProfileAnswer, ("profile",)),
    "get /plans/{job_id}/routes/{number}.{form}": OperationAnswer(None, ("csv",), "text/csv"),
    "post /routes": OperationAnswer(answers.RouteAnswer, ("uploaded route",)),
    "get /routes/{route_id}": OperationAnswer(answers.RouteAnswer, ("uploaded route",)),
    "post /voyages/read": OperationAnswer(answers.VoyageRequestAnswer, ("voyage of a file",)),
    "post /compare": OperationAnswer(answers.ComparisonAnswer, ("comparison",)),
}


@cache
def answer_examples() -> dict[str, Any]:
    """Return the examples of answers by name."""
    path = Path(__file__).with_name("answer_examples.json")
    found: dict[str, Any] = json.loads(path.read_text("utf-8"))
    return found


@cache
def _schemas() -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the schema of each operation's answer, and those that they refer to by name."""
    forms = [
        (name, "validation", TypeAdapter(answer.form))
        for name, answer in ANSWERS.items()
        if answer.form is not None
    ]
    found, shared = TypeAdapter.json_schemas(forms, ref_template=_TEMPLATE)  # type: ignore[arg-type]
    return {name: schema for (name, _), schema in found.items()}, shared["$defs"]


def answer_schemas() -> dict[str, Any]:
    """Return the schemas that those of the answers refer to, by name."""
    return _schemas()[1]


def answer_content(operation: str) -> dict[str, Any]:
    """Return the content of the answer of an operation, by media type.

    Parameters
    ----------
    operation : Method and path, as in `ANSWERS`.
    """
    form, names, media_type = ANSWERS[operation]
    schema: dict[str, Any] = {"type": "string"} if form is None else _schemas()[0][operation]
    if media_type == "application/octet-stream":
        schema = schema | {"format": "binary"}
    examples = {name: {"value": answer_examples()[name]} for name in names}
    return {media_type: {"schema": schema, "examples": examples}}
