"""What a client asks for beyond one voyage: the schema of projects, studies and forecasts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Final, Literal

from pydantic import BaseModel, ConfigDict, Field

from thalweg.core.bounding_box import BoundingBox
from thalweg.core.errors import InputError
from thalweg.core.units import HOUR
from thalweg.service.jobs.named_uploads import entries_of, refuse_paths
from thalweg.studies.study_axes import plain_data

if TYPE_CHECKING:
    from thalweg.forecasts import ForecastRequest
    from thalweg.operations.dredging import Project
    from thalweg.studies import Study

MOST_VOYAGES: Final = 20_000  #: of a study of the service

PROJECT_EXAMPLE: Final[dict[str, Any]] = {
    "title": "Nourishment behind the bank",
    "project": {
        "ship": "hopper-dredger",
        "sea": "synthetic-estuary",
        "load": [51.7449, 3.579],
        "unload": [51.6596, 3.6514],
        "volume_m3": 12000,
        "hopper_m3": 3000,
        "loading": 1.5,
        "unloading": 1.5,
        "start": "2026-05-01T00:00Z",
        "days": 4,
        "min_ukc_m": 1.0,
    },
}
STUDY_EXAMPLE: Final[dict[str, Any]] = {
    "title": "Halifax to Bishop Rock, by departure",
    "study": {
        "ship": "handysize-bulker",
        "sea": "storm",
        "voyage": {"start": "Halifax", "goal": "49.7N 6.5W"},
        "axes": {
            "depart": {"from": "1998-08-30T00:00Z", "to": "1998-09-01T00:00Z", "step_h": 24},
            "speed_kn": [12, 14],
        },
    },
}
FORECAST_EXAMPLE: Final[dict[str, Any]] = {
    "source": "gfs",
    "box": [40.0, 60.0, -75.0, 5.0],
    "start": "2026-11-22T12:00Z",
    "end": "2026-12-02T12:00Z",
}


class ProjectOrder(BaseModel):
    """A dredging project to simulate."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"examples": [PROJECT_EXAMPLE]})

    title: Annotated[str, Field(max_length=200, description="a name for people")] = ""
    project: dict[str, Any] | str = Field(
        description="entries of a project file, or its text; `sea` and `depth` hold ids of /seas "
        "or `synthetic-estuary`, `ship` a ship of /ships or the content of a ship file, `zones` "
        "GeoJSON"
    )

    def checked_project(self) -> tuple[dict[str, Any], Project]:
        """Return the entries as plain data, and the project of them.

        Raises
        ------
        InputError
            With the entry in ``details["field"]``.
        """
        from thalweg.operations.dredging import Project

        data: dict[str, Any] = plain_data(entries_of(self.project, "project"))
        refuse_paths(data, ("zones", "map"), "project")
        if not data.get("sea"):
            raise InputError(
                "The project names no sea.",
                "sea: ids of uploaded files, or synthetic-estuary.",
                "Choose one: weather and tides are never assumed.",
                field="sea",
            )
        return data, Project.from_dict(data)


class StudyOrder(BaseModel):
    """Many voyages to plan."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"examples": [STUDY_EXAMPLE]})

    title: Annotated[str, Field(max_length=200, description="a name for people")] = ""
    study: dict[str, Any] | str = Field(
        description="entries of a study file, or its text; `sea` holds `calm`, `storm` or ids of "
        "/seas, `depths` ids of /seas, `ship` ships of /ships, `track` ids of /routes, `traffic` "
        "ids of /traffic; `areas`, `limits`, `charges` and `eca` are those of a plan"
    )

    def checked_study(self) -> tuple[dict[str, Any], Study]:
        """Return the entries as plain data, and the study of them.

        Raises
        ------
        InputError
            With the entry in ``details["field"]``.
        """
        from thalweg.planning.request.itinerary_check import check_itinerary
        from thalweg.planning.voyage import Voyage
        from thalweg.studies import Study
        from thalweg.studies.study_parts import require_parquet

        require_parquet()
        data: dict[str, Any] = plain_data(entries_of(self.study, "study"))
        study = Study.from_dict(data)
        refuse_paths(data, ("map", "areas"), "study")
        if study.size > MOST_VOYAGES:
            raise InputError(
                f"The study has {study.size:,} voyages.",
                f"The service plans at most {MOST_VOYAGES:,} in one study.",
                "Use fewer values, or 'thalweg study run' on the command line.",
                field="axes",
            )
        check_itinerary(Voyage.from_dict(study.rows()[0].request["voyage"]))
        return data, study


Quantities = Annotated[
    list[Literal["wind", "waves", "current", "level", "ice", "pressure"]],
    Field(min_length=1, max_length=5),
]


class FetchOrder(BaseModel):
    """A forecast to download; it becomes a sea."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"examples": [FORECAST_EXAMPLE]})

    title: Annotated[str, Field(max_length=200, description="a name for people")] = ""
    source: Literal["gfs", "ecmwf", "open-meteo", "matroos", "rws", "copernicus", "era5"]
    box: Annotated[
        list[float],
        Field(min_length=4, max_length=4, description="south, north, west, east [deg]"),
    ]
    start: str = Field(max_length=40, description="ISO 8601")
    end: str = Field(max_length=40, description="ISO 8601")
    quantities: Quantities | None = Field(
        None,
        description="left out: current of matroos and copernicus, level of rws, else wind and "
        "waves",
    )
    step_h: int = Field(3, ge=1, le=24, description="hours between fields")
    members: int = Field(0, ge=0, le=200, description="members of the ensemble (ecmwf)")

    def forecast_request(self) -> ForecastRequest:
        """Return the request to the source.

        Raises
        ------
        InputError
            If box or period is not possible.
        """
        from thalweg.forecasts import ForecastRequest
        from thalweg.forecasts.source_table import usual_quantities

        try:
            box = BoundingBox.checked(*self.box)
        except InputError as error:
            error.details["field"] = "box"
            raise
        return ForecastRequest(
            box,
            self.start,  # type: ignore[arg-type]  # becomes seconds
            self.end,  # type: ignore[arg-type]
            tuple(dict.fromkeys(self.quantities or usual_quantities(self.source))),
            self.step_h * HOUR,
            None,
            self.members,
        )
