"""What a client asks for: the schema of plans and evaluations."""

from __future__ import annotations

from typing import Annotated, Any, Final, Literal

from pydantic import BaseModel, ConfigDict, Field

from thalweg.chart.ports import PORTS
from thalweg.core.errors import InputError
from thalweg.core.geodesy import parse_position
from thalweg.planning.voyage import Voyage

EMBEDDED_SEAS: Final = ("calm", "storm")

PLAN_EXAMPLE: Final[dict[str, Any]] = {
    "title": "Halifax to Bishop Rock",
    "voyage": {
        "start": "Halifax",
        "goal": "49.7N 6.5W",
        "depart": "1998-08-31T12:00Z",
        "objective": "time",
    },
    "ship": "handysize-bulker",
    "seas": ["storm"],
}

FilledQuantity = Literal["currents", "wind", "waves"]
FileId = Annotated[str, Field(pattern=r"^[0-9a-f]{16,64}$|^calm$|^storm$")]


class RequestedLimits(BaseModel):
    """Limits that replace those of the ship file; left out: those of the file."""

    model_config = ConfigDict(extra="forbid")

    wave_height_m: Annotated[
        float | None, Field(gt=0, le=40, description="significant wave height")
    ] = None
    wind_speed_kn: Annotated[float | None, Field(gt=0, le=200, description="wind at 10 m")] = None
    motion_sickness_percent: Annotated[
        float | None, Field(gt=0, le=100, description="people sick after two hours")
    ] = None


class ShipAndSea(BaseModel):
    """The ship, the sea and the chart of a plan or an evaluation."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"examples": [PLAN_EXAMPLE]})

    title: str = Field("", max_length=200, description="a name for people")
    ship: str = Field(max_length=100, description="a ship of /ships", examples=["handysize-bulker"])
    seas: list[FileId] = Field(
        min_length=1, max_length=20, description="`calm`, `storm` or ids of /seas, by priority"
    )
    fill: dict[FilledQuantity, float | str] = Field(
        default_factory=dict,
        description="what unknown values are taken as: a number, `wind`, `head_seas`, `nearest:NM`",
        examples=[{"waves": 0.0}],
    )
    depths: list[FileId] = Field(default_factory=list, max_length=10, description="ids of /seas")
    areas: dict[str, Any] | None = Field(
        None, description="GeoJSON areas with the property `kind`: no-go, penalty, price, eca"
    )
    limits: RequestedLimits = RequestedLimits()
    coast: Literal["c", "l", "i", "h", "f"] = Field("i", description="resolution of GSHHG")
    load_factor: float | None = Field(None, ge=0, le=1, description="0 empty to 1 full")

    def check_embedded(self) -> None:
        """Raise `InputError` if a calm sea stands beside another."""
        if "calm" in self.seas and len(self.seas) > 1:
            raise InputError(
                "A calm sea is given together with another.",
                "A calm sea has no wind, waves and currents anywhere.",
                "Choose one.",
                field="seas",
            )


class PlanRequest(ShipAndSea):
    """A voyage to plan, with its ship, sea and chart."""

    voyage: dict[str, Any] = Field(
        description="entries of a voyage file: start, goal, depart, objective, ..."
    )
    network: Literal["auto", "lattice", "mesh", "globe"] = "auto"
    resolution_nm: float | None = Field(None, ge=0.001, le=300)
    proof_s: float | None = Field(
        None, ge=0, le=3600, description="time for the proof of the lower bound [s]"
    )

    def checked_voyage(self) -> Voyage:
        """Return the voyage; all checks that need neither chart nor data are made here.

        Raises
        ------
        InputError
            With the entry of the voyage in ``details["field"]``.
        """
        self.check_embedded()
        voyage = Voyage.from_dict(self.voyage)
        places = [("start", voyage.start), ("goal", voyage.goal)]
        places += [(f"via.{i}", place) for i, place in enumerate(voyage.via)]
        for name, place in places:
            if isinstance(place, str) and parse_position(place) is None:
                try:
                    PORTS.lookup(place)
                except InputError as error:
                    error.details["field"] = name
                    raise
        return voyage


class EvaluationRequest(ShipAndSea):
    """A route from a file to sail in given weather."""

    route: Annotated[str, Field(pattern=r"^[0-9a-f]{16,64}$")] = Field(
        description="id of a route of POST /routes"
    )
    depart: str | None = Field(None, max_length=40, description="ISO 8601; default: of the file")
    speed_kn: float | None = Field(None, gt=0, lt=100)
    min_ukc_m: float = Field(0.0, ge=0, lt=100)
