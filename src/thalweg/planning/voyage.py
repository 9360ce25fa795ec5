"""`Voyage`: what is asked, in plain data that a YAML or JSON file can hold."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from numbers import Integral
from pathlib import Path
from typing import Any, Literal, TypeAlias

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.geodesy import Position, check_position
from thalweg.core.time import TimeLike, format_time, parse_time

Place: TypeAlias = "Position | str"
Objective: TypeAlias = Literal["time", "distance", "fuel", "energy", "cost", "co2", "front"]

OBJECTIVES: tuple[Objective, ...] = ("time", "distance", "fuel", "energy", "cost", "co2", "front")
#: Objectives for which the ship's speed is chosen leg by leg.
TRADE_OFF_OBJECTIVES: tuple[Objective, ...] = ("fuel", "energy", "cost", "co2", "front")
METHODS = ("default", "exact", "nsga2", "spea2", "mpaes")
RISK_MEASURES = ("mean", "cvar")
_LARGEST_FILE = 1_000_000


@dataclass(frozen=True, kw_only=True)
class Voyage:
    """A voyage to plan.

    Parameters
    ----------
    start, goal : (lat, lon) or str
        Where from and where to: degrees, or text (``"52.0N 4.1E"``, ``"52.0,4.1"``, a port's name
        or its UN/LOCODE).
    depart : str, datetime or float, optional
        Time of departure, ISO 8601 in UTC (or seconds since 1970). Not needed with a window.
    depart_window : pair of times, optional
        Earliest and latest departure; the one with the shortest passage is chosen (with via points
        the shortest passage to the first of them).
    objective : {"time", "distance", "fuel", "energy", "cost", "co2", "front"}
        What to make least; energy is that of propulsion and the hotel load, at rest too; the cost
        is fuel, time and dues, or of time and cubed speed (``costs`` of the ship file) where fuel
        has no price. ``"front"`` asks for the whole trade of time against fuel, or against
        cost where a price is given. For all but the first two the speed is chosen leg by leg.
    via : sequence of places
        Places to pass, in this order.
    arrive_by : time, optional
        Latest arrival.
    wait : bool
        Whether the ship may stop and wait (for a tide, for weather).
    speed_kn : float, optional
        Ordered speed through water in calm water [kn]; the ship's highest when not given.
    min_ukc_m : float, optional
        Least under-keel clearance [m]; when not given, the limit of the ship file, else zero. Where
        the chart or the sea tells any depth, water of unknown depth is forbidden; where nothing
        tells depth, a clearance cannot be asked, and the plan notes that none was checked.
    seed : int
        Seed of everything random.
    fuel_price_usd : float, optional
        Price of a tonne of fuel; the ship file's when not given.
    eca_price_factor : float, optional
        Price of fuel inside emission control areas over the price outside.
    time_price_usd_per_h : float, optional
        What an hour of the voyage costs besides fuel; the ship file's hire when not given.
    forbid : sequence of str
        Canals that may not be used (``"suez"``, ``"panama"``, ``"kiel"``, ``"corinth"``, or
        ``"all"``).
    method : {"default", "exact", "nsga2", "spea2", "mpaes"}
        How a trade is searched: the exact front of a network, refined by evolution (default); the
        exact front alone; or an evolutionary method from a few routes, to compare.
    ensemble : {"mean", "cvar"}, optional
        With a sea of several forecast members: choose the route with the least expected value, or
        the least mean of the worst tenth.

    Raises
    ------
    InputError
        For places, times, speeds or names that cannot be.
    """

    start: Place
    goal: Place
    depart: TimeLike | None = None
    depart_window: tuple[TimeLike, TimeLike] | None = None
    objective: Objective = "time"
    via: Sequence[Place] = ()
    arrive_by: TimeLike | None = None
    wait: bool = True
    speed_kn: float | None = None
    min_ukc_m: float | None = None
    seed: int = 0
    fuel_price_usd: float | None = None
    eca_price_factor: float | None = None
    time_price_usd_per_h: float | None = None
    forbid: Sequence[str] = ()
    method: str = "default"
    ensemble: str | None = None

    def __post_init__(self) -> None:
        if isinstance(self.via, str) or not isinstance(self.via, Sequence):
            raise InputError(
                f"The via points are {self.via!r}, which is no list of places.",
                "They are places in order, such as via=[(51.0, 2.0), 'Dover'].",
                "Put a single place in brackets, too.",
                field="via",
            )
        places = [_place(place, f"via point {i + 1}") for i, place in enumerate(self.via)]
        object.__setattr__(self, "start", _place(self.start, "start"))
        object.__setattr__(self, "goal", _place(self.goal, "goal"))
        object.__setattr__(self, "via", tuple(places))
        if self.objective not in OBJECTIVES:
            raise unknown_name_error("objective", str(self.objective), OBJECTIVES)
        self._normalise_times()
        _check_number("speed_kn", self.speed_kn, above=0.0, below=100.0, unit="kn")
        _check_number("min_ukc_m", self.min_ukc_m, above=-1e-9, below=100.0, unit="m")
        self._check_trade_off()

    def _check_trade_off(self) -> None:
        """Check what concerns prices, canals and methods."""
        price, nothing = "fuel_price_usd", -1e-9
        _check_number(price, self.fuel_price_usd, above=nothing, below=1e5, unit="USD/t")
        _check_number("eca_price_factor", self.eca_price_factor, above=0.0, below=100.0, unit="")
        _check_number(
            "time_price_usd_per_h", self.time_price_usd_per_h, above=nothing, below=1e7, unit="USD"
        )
        forbidden = (self.forbid,) if isinstance(self.forbid, str) else _as_list(self.forbid)
        if not isinstance(self.seed, Integral) or self.seed < 0:
            raise InputError(
                f"The seed is {self.seed!r}.", "It is a whole number of zero or more.", "Give one.",
                field="seed",
            )  # fmt: skip
        object.__setattr__(self, "forbid", tuple(str(name).casefold() for name in forbidden))
        if self.method not in METHODS:
            raise unknown_name_error("method", str(self.method), METHODS)
        if self.ensemble is not None and self.ensemble not in RISK_MEASURES:
            raise unknown_name_error("choice over an ensemble", str(self.ensemble), RISK_MEASURES)
        if self.objective in TRADE_OFF_OBJECTIVES and self.depart_window is not None:
            raise InputError(
                f"A departure window cannot be asked with the objective {self.objective!r}.",
                "Windows are for the objectives 'time' and 'distance'; waiting at the start is "
                "part of every other plan.",
                "Give a departure, and the latest arrival with arrive_by.",
                field="depart_window",
            )

    def _normalise_times(self) -> None:
        if (self.depart is None) == (self.depart_window is None):
            raise InputError(
                "A voyage needs a departure: a time or a window, and not both.",
                "Either depart=... or depart_window=(earliest, latest).",
                "Give one of them.",
            )
        if self.depart_window is not None:
            if isinstance(self.depart_window, str) or len(_as_list(self.depart_window)) != 2:
                raise InputError("A departure window is two times.", "", "Give (earliest, latest).")
            first, last = (parse_time(t) for t in self.depart_window)
            if not first <= last:
                raise InputError(
                    f"The departure window ends ({format_time(last)}) before it begins "
                    f"({format_time(first)}).",
                    "",
                    "Give the earlier time first.",
                )
            object.__setattr__(self, "depart_window", (first, last))
        else:
            assert self.depart is not None  # settled by the check above
            object.__setattr__(self, "depart", parse_time(self.depart))
        if self.arrive_by is not None:
            latest = parse_time(self.arrive_by)
            object.__setattr__(self, "arrive_by", latest)
            if latest <= self.earliest_departure:
                raise InputError(
                    f"Arrive by {format_time(latest)} is not after the departure "
                    f"({format_time(self.earliest_departure)}).",
                    "",
                    "Give a later arrival or an earlier departure.",
                )

    @property
    def earliest_departure(self) -> float:
        """The departure, or the beginning of its window [s since 1970]."""
        first = self.depart if self.depart_window is None else self.depart_window[0]
        return parse_time(first)  # type: ignore[arg-type]

    @property
    def latest_departure(self) -> float:
        """The departure, or the end of its window [s since 1970]."""
        last = self.depart if self.depart_window is None else self.depart_window[1]
        return parse_time(last)  # type: ignore[arg-type]

    def to_dict(self) -> dict[str, Any]:
        """Return plain data: times as ISO 8601 text, places as text or [lat, lon]."""
        data: dict[str, Any] = {}
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            if value is None or (field.name in ("via", "forbid") and not value):
                continue
            if field.name == "method" and value == "default":
                continue
            data[field.name] = _plain_value(field.name, value)
        return data

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Voyage:
        """Build a voyage from plain data; unknown keys are an error with near matches."""
        known = [field.name for field in dataclasses.fields(cls)]
        for key in data:
            if key not in known:
                raise unknown_name_error("voyage entry", str(key), known)
        missing = [key for key in ("start", "goal") if key not in data]
        if missing:
            raise InputError(f"The voyage lacks {' and '.join(missing)}.", "", "Add them.")
        return cls(**dict(data))

    @classmethod
    def load(cls, path: str | Path) -> Voyage:
        """Read a voyage from a YAML or JSON file.

        Raises
        ------
        InputError
            If the file is missing, too large, not YAML/JSON, or says something impossible.
        """
        from thalweg.core.strict_yaml import parse_yaml

        path = Path(path)
        if not path.is_file():
            raise InputError(f"There is no voyage file {path}.", "", "Check the path.")
        if path.stat().st_size > _LARGEST_FILE:
            raise InputError(f"{path} is too large for a voyage file.", "At most 1 MB.", "")
        try:
            text = path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            raise InputError(f"{path} is not text in UTF-8.", "", "Save it as UTF-8.") from None
        data = parse_yaml(text, "voyage", path.name)
        if not isinstance(data, dict):
            raise InputError(f"{path} holds no voyage.", "A mapping with start and goal.", "")
        return cls.from_dict(data)

    def save(self, path: str | Path) -> None:
        """Write the voyage as YAML, or as JSON when the name ends in .json."""
        from thalweg.core.strict_yaml import dump_yaml

        path = Path(path)
        data = self.to_dict()
        as_json = path.suffix == ".json"
        text = json.dumps(data, indent=2, allow_nan=False) if as_json else dump_yaml(data)
        path.write_text(text, encoding="utf-8")


def _as_list(given: Any) -> tuple[Any, ...]:
    """Return what is given as a list; a single thing as a list of it."""
    try:
        return tuple(given)
    except TypeError:
        return (given,)


def _place(place: Any, what: str) -> Place:
    if isinstance(place, str):
        if not place.strip():
            raise InputError(f"The {what} is empty.", "", "Give lat, lon or a port.")
        return place.strip()
    try:
        lat, lon = place
        return check_position(float(lat), float(lon), what)
    except (TypeError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(
            f"The {what} {place!r} is not a place.",
            'A place is (lat, lon) in degrees or text such as "52.0N 4.1E" or a port.',
            "Write it that way.",
        ) from None


def _check_number(name: str, value: Any, *, above: float, below: float, unit: str) -> None:
    if value is None:
        return
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise InputError(f"{name} must be a number, not {value!r}.", "", f"Give it in {unit}.")
    if not above < value < below:
        raise InputError(
            f"{name} = {value:g} {unit} cannot be.",
            f"It lies between {max(above, 0):g} and {below:g} {unit}.",
            "Correct it.",
            field=name,
            value=value,
        )


def _plain_value(name: str, value: Any) -> Any:
    if name in ("depart", "arrive_by"):
        return format_time(value)
    if name == "depart_window":
        return [format_time(t) for t in value]
    if name == "via":
        return [_plain_value("place", place) for place in value]
    return list(value) if isinstance(value, tuple) else value
