"""What a client asks for: the schema of plans and evaluations."""

from __future__ import annotations

from functools import partial
from typing import Annotated, Any, Final, Literal

from pydantic import BaseModel, ConfigDict, Field

from thalweg.chart.zones.zone_set import Zones
from thalweg.core.errors import InputError, errors_about
from thalweg.core.time import parse_time
from thalweg.core.units import NAUTICAL_MILE
from thalweg.planning.request.european_scope import share_between_places
from thalweg.planning.request.itinerary_check import check_itinerary
from thalweg.planning.request.voyage_surroundings import (
    CHARGE_YEARS,
    LARGEST_CHARGE,
    LARGEST_LIMITS,
)
from thalweg.planning.voyage import Voyage
from thalweg.route.formats.route_file_options import ROUTE_FORMATS, RouteFileOptions

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

ALTERNATIVES_EXAMPLE: Final[dict[str, Any]] = {
    "title": "Ways along western Norway",
    "voyage": {
        "start": "59.2N 4.4E",
        "goal": "62.6N 5.2E",
        "depart": "1998-08-31T12:00Z",
        "at_most": {"fuel": 30},
    },
    "ship": "handysize-bulker",
    "seas": ["storm"],
    "most": 3,
}
LAYERED_EXAMPLE: Final[dict[str, Any]] = {
    "title": "Fuel and comfort together, on a layered network",
    "voyage": {
        "start": "63.67N 9.30E",
        "goal": "66.57N 11.67E",
        "depart": "1998-08-31T12:00Z",
        "objective": "weighted",
        "weights": {"fuel": 1, "inshore": 0.5},
        "at_least": {"land_distance_nm": 0.5},
        "layered": {"near_coast_nm": 3, "within_percent": 2},
    },
    "ship": "handysize-bulker",
    "seas": ["storm"],
}

EVALUATION_EXAMPLE: Final[dict[str, Any]] = {
    "title": "A route of the master",
    "route": "0123456789abcdef0123456789abcdef",
    "ship": "handysize-bulker",
    "seas": ["storm"],
    "depart": "1998-08-31T12:00Z",
    "speed_kn": 13.0,
}

FilledQuantity = Literal["currents", "wind", "waves"]
FillPolicy = float | Annotated[str, Field(max_length=60)]
UploadId = Annotated[str, Field(pattern=r"^[0-9a-f]{16,64}$")]
FileId = Annotated[str, Field(pattern=r"^[0-9a-f]{16,64}$|^calm$|^storm$")]


class RequestedLimits(BaseModel):
    """Limits that replace those of the ship file; left out: those of the file."""

    model_config = ConfigDict(extra="forbid")

    wave_height_m: Annotated[
        float | None,
        Field(gt=0, le=LARGEST_LIMITS["wave_height_m"], description="significant height"),
    ] = None
    wind_speed_kn: Annotated[
        float | None, Field(gt=0, le=LARGEST_LIMITS["wind_speed_kn"], description="wind at 10 m")
    ] = None
    motion_sickness_percent: Annotated[
        float | None,
        Field(
            gt=0,
            le=LARGEST_LIMITS["motion_sickness_percent"],
            description="people sick after two hours",
        ),
    ] = None


class RequestedCharges(BaseModel):
    """Charges of the European Union, which count in the cost; see the page on money."""

    model_config = ConfigDict(extra="forbid")

    share_percent: Literal[0, 50, 100] | None = Field(
        None,
        description="share of the voyage in their scope: 100 between two ports of the Union, 50 to "
        "or from one; left out of a plan: by the countries of its two ports",
    )
    ets_price: float = Field(
        0.0, ge=0, le=LARGEST_CHARGE, description="of an allowance, per tonne of CO2"
    )
    eur_rate: float = Field(
        0.0, ge=0, le=LARGEST_CHARGE, description="of a euro; 0: no FuelEU penalty"
    )
    year: int | None = Field(
        None,
        ge=CHARGE_YEARS[0],
        le=CHARGE_YEARS[1],
        description="whose rules hold; left out: the year of the departure, 2026 for departures "
        "before 2024",
    )


class RequestedRouteFiles(BaseModel):
    """How the routes of a result are written into files."""

    model_config = ConfigDict(extra="forbid")

    legs: Annotated[
        Literal["rhumb", "great-circle"], Field(description="lines between the waypoints of a file")
    ] = "rhumb"
    cross_track_nm: Annotated[
        float, Field(ge=0.001, le=9.99, description="the lines are closer to the route than this")
    ] = 0.1
    waypoint_spacing_nm: Annotated[
        float | None, Field(ge=0.1, le=10_000, description="longest leg")
    ] = None
    max_waypoints: Annotated[
        int | None,
        Field(ge=2, le=100_000, description="the cross-track limit grows as far as this needs"),
    ] = None
    rtz_version: Literal["1.0", "1.1", "1.2"] = "1.2"

    def options(self, **given: Any) -> RouteFileOptions:
        """Return the options of all formats, with some more."""
        return RouteFileOptions(
            cross_track_nm=self.cross_track_nm,
            spacing_nm=self.waypoint_spacing_nm,
            max_waypoints=self.max_waypoints,
            legs=self.legs,
            rtz_version=self.rtz_version,
            formats=ROUTE_FORMATS,
            **given,
        )


class ShipAndSea(BaseModel):
    """The ship, the sea and the chart of a plan or an evaluation."""

    model_config = ConfigDict(extra="forbid")

    title: str = Field("", max_length=200, description="a name for people")
    ship: str = Field(max_length=100, description="a ship of /ships", examples=["handysize-bulker"])
    seas: list[FileId] = Field(
        min_length=1, max_length=20, description="`calm`, `storm` or ids of /seas, by priority"
    )
    fill: dict[FilledQuantity, FillPolicy | Annotated[list[FillPolicy], Field(max_length=5)]] = (
        Field(
            default_factory=dict,
            description="what unknown values are taken as: a number, `nearest:NM`, for wind also "
            "`waves`, for waves `wind`, `head_seas`, `coastal_shelter`, `fetch_limited`; several "
            "are tried in order",
            examples=[{"waves": ["nearest:25", 0.0]}],
        )
    )
    variables: dict[str, str] = Field(
        default_factory=dict,
        max_length=30,
        description="variable of the uploaded seas that holds a quantity (CF standard name); "
        "`crs` names the projection of their grid",
        examples=[{"eastward_wind": "u"}],
    )
    depths: list[FileId] = Field(default_factory=list, max_length=10, description="ids of /seas")
    areas: dict[str, Any] | None = Field(
        None,
        description="GeoJSON areas with the property `kind`: no-go, penalty, price, eca; a no-go "
        "area may have `keep_clear_nm`, the distance by which routes keep clear of it",
    )
    traffic: list[UploadId] = Field(
        default_factory=list, max_length=10, description="ids of /traffic, for expected encounters"
    )
    eca: bool = Field(True, description="whether emission control areas count in the cost")
    charges: RequestedCharges | None = None
    sampling: str = Field(
        "linear",
        pattern=r"^linear$|^nearest:[0-9]{1,4}(\.[0-9]{1,4})?$",
        description="weather between its times: `linear`, or the nearest update: `nearest:HOURS`",
    )
    average_over_m: float | None = Field(
        None, gt=0, le=1000, description="depth over which currents in layers are averaged"
    )
    limits: RequestedLimits = RequestedLimits()
    coast: Literal["c", "l", "i", "h", "f", "none"] = Field(
        "i", description="resolution of GSHHG; `none`: no land"
    )
    load_factor: float | None = Field(None, ge=0, le=1, description="0 empty to 1 full")
    route_files: RequestedRouteFiles = RequestedRouteFiles()

    @property
    def fill_policies(self) -> list[tuple[str, float | str]]:
        """The quantities to fill, with their values by priority."""
        several = {k: v if isinstance(v, list) else [v] for k, v in self.fill.items()}
        return [(name, value) for name, values in several.items() for value in values]

    def check_sea(self) -> None:
        """Raise `InputError` for areas, fill values, a sampling or a calm sea not possible."""
        self._check_calm()
        if self.areas:
            with errors_about("areas"):
                Zones.read(self.areas)
        from thalweg.sea import Sea
        from thalweg.sea.fill_policies import check_fill

        if self.variables and set(self.seas) <= set(EMBEDDED_SEAS):
            raise InputError(
                "Variables of files are named, and no file is among the seas.",
                "They apply to uploaded seas.",
                "Leave variables out, or add a file to seas.",
                field="variables",
            )
        checks = [("fill", partial(check_fill, *one)) for one in self.fill_policies]
        for field, check in [*checks, ("sampling", partial(Sea.calm().sampled, self.sampling))]:
            try:
                check()
            except InputError as error:
                error.details["field"] = field
                raise

    def _check_calm(self) -> None:
        if "calm" in self.seas and len(self.seas) > 1:
            raise InputError(
                "A calm sea is given together with another.",
                "A calm sea has no wind, waves and currents anywhere.",
                "Choose one.",
                field="seas",
            )


class PlanRequest(ShipAndSea):
    """A voyage to plan, with its ship, sea and chart."""

    model_config = ConfigDict(json_schema_extra={"examples": [PLAN_EXAMPLE, LAYERED_EXAMPLE]})

    voyage: dict[str, Any] = Field(
        description="entries of a voyage file: start, goal, depart, objective (time, distance, "
        "fuel, energy, cost, co2, comfort, encounters, inshore, weighted, front), weights, at_most "
        "and at_least of key performance indicators, layered, ..."
    )
    network: Literal["auto", "lattice", "mesh", "globe", "layered"] = "auto"
    history: UploadId | None = Field(
        None, description="id of /histories: plan in the water that ships usually use"
    )
    corridor_gain_percent: float | None = Field(
        None, ge=0, lt=100, description="gain of the objective for which a plan leaves that water"
    )
    resolution_nm: float | None = Field(None, ge=0.001, le=300)
    proof_s: float | None = Field(
        None, ge=0, le=3600, description="time for the proof of the lower bound [s]"
    )

    @property
    def resolution_m(self) -> float | None:
        """The resolution [m]; None: chosen."""
        return None if self.resolution_nm is None else self.resolution_nm * NAUTICAL_MILE

    def checked_voyage(self) -> Voyage:
        """Return the voyage; all checks that need neither chart nor data are made here.

        Raises
        ------
        InputError
            With the entry of the voyage in ``details["field"]``.
        """
        self.check_sea()
        self._check_places_of_entries()
        voyage = Voyage.from_dict(self.voyage)
        self._check_network(voyage)
        check_itinerary(voyage)
        if self.charges is not None and self.charges.share_percent is None:
            try:
                share_between_places(voyage.start, voyage.goal)
            except InputError as error:
                error.details["field"] = "charges.share_percent"
                raise
        return voyage

    def _check_places_of_entries(self) -> None:
        """Raise `InputError` for entries of the request that are inside the voyage."""
        for name in self.voyage:
            if name in type(self).model_fields and name not in Voyage.__dataclass_fields__:
                raise InputError(
                    f"The entry {name} is inside voyage.",
                    "It is an entry of the request itself, beside voyage.",
                    "Move it there.",
                    field=name,
                )

    def _check_network(self, voyage: Voyage) -> None:
        layered = voyage.layered is not None
        if layered and (self.history is not None or self.network not in ("auto", "layered")):
            raise InputError(
                f"A layered network is described, and the network is "
                f"{'a history network' if self.history else repr(self.network)}.",
                "The entry layered of the voyage shapes the network 'layered'.",
                "Choose this network, or leave the entry out.",
                field="network",
            )
        if self.history is not None and self.network != "auto":
            raise InputError(
                f"Both history and the network {self.network!r} are given.",
                "A history network is searched in place of the others.",
                "Leave one of them out.",
                field="network",
            )
        if self.corridor_gain_percent is not None and self.history is None:
            raise InputError(
                "corridor_gain_percent is given without history.",
                "It states for what gain a plan leaves the water that ships usually use.",
                "Give the id of a history network, or leave it out.",
                field="corridor_gain_percent",
            )


class AlternativesRequest(PlanRequest):
    """A voyage whose routes that differ are wanted; its objective is not used."""

    model_config = ConfigDict(json_schema_extra={"examples": [ALTERNATIVES_EXAMPLE]})

    most: int = Field(5, ge=2, le=5, description="greatest number of routes")


class EvaluationRequest(ShipAndSea):
    """A route from a file to sail in given weather."""

    model_config = ConfigDict(json_schema_extra={"examples": [EVALUATION_EXAMPLE]})

    route: UploadId = Field(description="id of a route of POST /routes")
    depart: str | None = Field(None, max_length=40, description="ISO 8601; default: of the file")
    speed_kn: float | None = Field(None, gt=0, lt=100)
    hold: Literal["power", "speed"] | None = Field(
        None, description="what is held at speed_kn; default: as the ship file orders"
    )
    min_ukc_m: float | None = Field(None, ge=0, lt=100, description="default: of the ship file")
    member: int | None = Field(None, ge=0, lt=1000, description="of an ensemble, from 0")
    fuel_price_usd: float | None = Field(None, ge=0, le=1e5, description="per tonne")
    eca_price_factor: float | None = Field(
        None, gt=0, le=100, description="price of fuel inside control areas over that outside"
    )
    time_price_usd_per_h: float | None = Field(None, ge=0, le=1e7)

    def check(self) -> None:
        """Raise `InputError` for what needs neither route, chart nor data to be refused.

        Raises
        ------
        InputError
            With the entry in ``details["field"]``.
        """
        self.check_sea()
        if self.depart is not None:
            try:
                parse_time(self.depart)
            except InputError as error:
                error.details["field"] = "depart"
                raise
        if self.hold is not None and self.speed_kn is None:
            raise InputError(
                f"hold {self.hold} is given without a speed.",
                "It says what the engine holds at speed_kn.",
                "Add speed_kn, or leave out hold.",
                field="hold",
            )
        if self.charges is not None and self.charges.share_percent is None:
            raise InputError(
                "Charges are given without the share of the voyage.",
                "It is 100 between two ports of the Union, 50 to or from one, else 0; a route has "
                "no ports by which it could be found.",
                "Add share_percent.",
                field="charges.share_percent",
            )
