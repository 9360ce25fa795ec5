"""The parts of a voyage, each with its checks: places, schedule, prices and search."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from numbers import Integral
from typing import Any, Literal, TypeAlias

import numpy as np

from thalweg.core.errors import InputError, errors_about, unknown_name_error
from thalweg.core.geodesy import Position, check_position
from thalweg.core.given_numbers import shortened_repr, to_number
from thalweg.core.objective import OBJECTIVE_NAMES, ObjectiveName
from thalweg.core.time import TimeLike, format_time, parse_time
from thalweg.network.layered.layered_request import LayeredRequest
from thalweg.route.indicator_columns import INDICATORS

Place: TypeAlias = "Position | str"
VoyageObjective: TypeAlias = ObjectiveName | Literal["front", "weighted"]

OBJECTIVES: tuple[VoyageObjective, ...] = (
    "time", "distance", "fuel", "energy", "cost", "co2", "comfort", "encounters", "inshore",
    "weighted", "front",
)  # fmt: skip
#: Objectives for which the ship's speed is chosen leg by leg.
TRADE_OFF_OBJECTIVES: tuple[VoyageObjective, ...] = (
    "fuel", "energy", "cost", "co2", "comfort", "encounters", "inshore", "weighted", "front",
)  # fmt: skip
METHODS = ("default", "exact", "nsga2", "spea2", "mpaes")
RISK_MEASURES = ("mean", "cvar")
HELD = ("speed", "power", "ground")
#: Indicators of motions on board, which need waves.
_OF_MOTIONS = (
    "comfort", "sick_percent", "worst_hour_percent", "max_acceleration", "uncomfortable_percent",
    "workable_percent",
)  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Itinerary:
    """Where a voyage goes.

    Parameters
    ----------
    start, goal : (lat, lon) or str
    forbid : Canals that may not be used.
    open, avoid : Passages that are opened, and passages and canals that may not be used.
    """

    start: Place
    goal: Place
    via: Sequence[Place] = ()
    forbid: Sequence[str] = ()
    open: Sequence[str] = ()
    avoid: Sequence[str] = ()

    def _check_itinerary(self) -> None:
        """Check places and canals, and bring them to one form."""
        if isinstance(self.via, str) or not isinstance(self.via, Sequence):
            raise InputError(
                f"The via points are {self.via!r}, which is not a list of places.",
                "They are places in order, such as via=[(51.0, 2.0), 'Dover'].",
                "Put a single place in brackets as well.",
                field="via",
            )
        vias = enumerate(self.via)
        places = [checked_place(place, f"via point {i + 1}", f"via.{i}") for i, place in vias]
        forbidden = (self.forbid,) if isinstance(self.forbid, str) else _as_list(self.forbid)
        for entry in ("start", "goal"):
            object.__setattr__(self, entry, checked_place(getattr(self, entry), entry, entry))
        object.__setattr__(self, "via", tuple(places))
        object.__setattr__(self, "forbid", tuple(str(name).casefold() for name in forbidden))
        for entry in ("open", "avoid"):
            given = getattr(self, entry)
            names = (given,) if isinstance(given, str) else _as_list(given)
            object.__setattr__(self, entry, tuple(str(name) for name in names))


@dataclass(frozen=True, kw_only=True)
class Schedule:
    """When a voyage departs and arrives, and whether it may wait on the way."""

    depart: TimeLike | None = None
    depart_window: tuple[TimeLike, TimeLike] | None = None
    arrive_by: TimeLike | None = None
    arrive: TimeLike | None = None
    wait: bool = True

    @property
    def departure_is_open(self) -> bool:
        """Whether the departure follows from the time of arrival."""
        return self.depart is None and self.depart_window is None

    @property
    def earliest_departure(self) -> float:
        """The departure, or the start of its window [s since 1970]."""
        first = self.depart if self.depart_window is None else self.depart_window[0]
        return parse_time(first)  # type: ignore[arg-type]

    @property
    def latest_departure(self) -> float:
        """The departure, or the end of its window [s since 1970]."""
        last = self.depart if self.depart_window is None else self.depart_window[1]
        return parse_time(last)  # type: ignore[arg-type]

    def _check_schedule(self) -> None:
        """Check the times, and turn them into seconds since 1970."""
        _check_flag("wait", self.wait)
        if self.arrive is not None:
            self._check_arrival()
        elif (self.depart is None) == (self.depart_window is None):
            raise InputError(
                "A voyage needs a departure: a time or a window, and not both.",
                "Either depart=... or depart_window=(earliest, latest).",
                "Give one of them.",
                field="depart",
            )
        if self.depart_window is not None:
            with errors_about("depart_window"):
                object.__setattr__(self, "depart_window", _window(self.depart_window))
        elif self.depart is not None:
            with errors_about("depart"):
                object.__setattr__(self, "depart", parse_time(self.depart))
        for name, words in (("arrive_by", "The latest arrival"), ("arrive", "The arrival")):
            given = getattr(self, name)
            if given is None:
                continue
            with errors_about(name):
                latest = parse_time(given)
            object.__setattr__(self, name, latest)
            if not self.departure_is_open and latest <= self.earliest_departure:
                raise InputError(
                    f"{words} {format_time(latest)} is not after the departure "
                    f"({format_time(self.earliest_departure)}).",
                    "A voyage arrives after it departs.",
                    "Give a later arrival or an earlier departure.",
                    field=name,
                )

    def _check_arrival(self) -> None:
        """Check that a time of arrival stands beside what it can be combined with."""
        for name in ("arrive_by", "depart_window"):
            if getattr(self, name) is not None:
                raise InputError(
                    f"Both arrive and {name} are given.",
                    "arrive is a time of arrival, met by the speed (with depart) or by the "
                    "departure (without).",
                    "Give one of them.",
                    field="arrive",
                )


@dataclass(frozen=True, kw_only=True)
class VoyagePrices:
    """Prices that replace those of the ship file.

    Parameters
    ----------
    fuel_price_usd : [USD/t].
    time_price_usd_per_h : [USD/h].
    """

    fuel_price_usd: float | None = None
    eca_price_factor: float | None = None
    time_price_usd_per_h: float | None = None

    @property
    def any_price(self) -> bool:
        """Whether a price is given."""
        given = (self.fuel_price_usd, self.eca_price_factor, self.time_price_usd_per_h)
        return any(value is not None for value in given)

    def _check_prices(self) -> None:
        low = -1e-9  # zero is allowed
        _check_number("fuel_price_usd", self.fuel_price_usd, above=low, below=1e5, unit="USD/t")
        _check_number("eca_price_factor", self.eca_price_factor, above=0.0, below=100.0, unit="")
        _check_number(
            "time_price_usd_per_h", self.time_price_usd_per_h, above=low, below=1e7, unit="USD/h"
        )


@dataclass(frozen=True, kw_only=True)
class SearchRequest:
    """The objective, the method of the search, and the limits of the ship.

    Parameters
    ----------
    objective : Among `OBJECTIVES`.
    method : {"default", "exact", "nsga2", "spea2", "mpaes"}
    ensemble : {"mean", "cvar"}, optional
    speed_kn, speed_step_kn : [kn].
    hold : {"speed", "power", "ground"}, optional
    min_ukc_m : [m].
    speed_block_h, offing_nm : [h], [nm].
    layered : Shape of a layered network.
    """

    objective: VoyageObjective = "time"
    method: str = "default"
    ensemble: str | None = None
    seed: int = 0
    speed_kn: float | None = None
    hold: str | None = None
    min_ukc_m: float | None = None
    speed_step_kn: float | None = None
    speed_block_h: float | None = None
    offing_nm: float | None = None
    ignore_shoals: bool = False
    ignore_lanes: bool = False
    layered: LayeredRequest | None = None

    @property
    def least_speed_block_h(self) -> float:
        """Least time that a speed is held [h]: 6 where none is given, 0 for the method "exact"."""
        if self.speed_block_h is not None:
            return float(self.speed_block_h)
        return 0.0 if self.method == "exact" else 6.0

    @property
    def chooses_speeds(self) -> bool:
        """Whether the speed is chosen leg by leg (all objectives but time and distance)."""
        return self.objective in TRADE_OFF_OBJECTIVES

    def _check_search(self) -> None:
        if self.objective not in OBJECTIVES:
            raise unknown_name_error(
                "objective", str(self.objective), OBJECTIVES, field="objective"
            )
        _check_number("speed_kn", self.speed_kn, above=0.0, below=100.0, unit="kn")
        _check_number("speed_step_kn", self.speed_step_kn, above=0.0999, below=100.0, unit="kn")
        _check_number("speed_block_h", self.speed_block_h, above=-1e-9, below=1000.0, unit="h")
        _check_number("min_ukc_m", self.min_ukc_m, above=-1e-9, below=100.0, unit="m")
        _check_number("offing_nm", self.offing_nm, above=-1e-9, below=50.0, unit="nm")
        for name in ("ignore_shoals", "ignore_lanes"):
            _check_flag(name, getattr(self, name))
        if not isinstance(self.seed, Integral) or self.seed < 0:
            raise InputError(
                f"The seed is {self.seed!r}.",
                "A seed is a whole number of zero or more.",
                "Give such a number.",
                field="seed",
            )
        if self.hold is not None and self.hold not in HELD:
            raise unknown_name_error("quantity to hold", str(self.hold), HELD, field="hold")
        if self.layered is not None:
            object.__setattr__(self, "layered", LayeredRequest.from_dict(self.layered))
        if self.method not in METHODS:
            raise unknown_name_error("method", str(self.method), METHODS, field="method")
        if self.ensemble is not None and self.ensemble not in RISK_MEASURES:
            raise unknown_name_error(
                "risk measure of an ensemble", str(self.ensemble), RISK_MEASURES, field="ensemble"
            )


@dataclass(frozen=True, kw_only=True)
class IndicatorRequest:
    """Weights of key figures, and limits of indicators over the whole route.

    Parameters
    ----------
    weights : mapping of str to float
        For the objective "weighted".
    at_most, at_least : mapping of str to float
        By indicator, as ``NAME`` or ``NAME:PLACE``.
    """

    weights: Mapping[str, float] = field(default_factory=dict)
    at_most: Mapping[str, float] = field(default_factory=dict)
    at_least: Mapping[str, float] = field(default_factory=dict)

    @property
    def has_indicator_limits(self) -> bool:
        """Whether an indicator of the whole route is limited."""
        return bool(self.at_most or self.at_least)

    @property
    def asks_for_motions(self) -> bool:
        """Whether weights or limits need the motions of the ship."""
        names = {name.partition(":")[0] for name in (*self.weights, *self.at_most, *self.at_least)}
        return bool(names & set(_OF_MOTIONS))

    def _check_indicators(self, objective: str) -> None:
        for name in ("weights", "at_most", "at_least"):
            given = getattr(self, name)
            if not isinstance(given, Mapping):
                raise InputError(
                    f"{name} is {shortened_repr(given)}.",
                    "It is a mapping of names to numbers.",
                    "Correct it, or leave it out.",
                    field=name,
                )
            known: Any = OBJECTIVE_NAMES if name == "weights" else INDICATORS
            checked = {str(k): _checked_indicator(name, str(k), v, known) for k, v in given.items()}
            object.__setattr__(self, name, checked)
        weighted = objective == "weighted"
        if weighted != bool(self.weights) or (weighted and not sum(self.weights.values()) > 0.0):
            raise InputError(
                f"The objective is {objective!r}, with "
                + (f"the weights {dict(self.weights)}." if self.weights else "no weights."),
                "The objective 'weighted' needs weights, one of them above zero; others have none.",
                "Give the objective 'weighted' with weights such as {'fuel': 1, 'comfort': 1}.",
                field="weights",
            )


def _checked_indicator(kind: str, name: str, value: Any, known: Any) -> float:
    plain = name if kind == "weights" else name.partition(":")[0]
    if plain not in known:
        what = "key figure of a weighted sum" if kind == "weights" else "indicator"
        raise unknown_name_error(what, plain, known, field=kind)
    number, highest, range_ = to_number(value), math.inf, ""
    if kind != "weights" and known[plain][0] == "%":
        highest, range_ = 100.0, " in per cent, 0 to 100"
    elif plain != "min_ukc":  # the only one that may be below zero
        range_ = " of zero or more"
    if not (math.isfinite(number) and (not range_ or 0.0 <= number <= highest)):
        raise InputError(
            f"{kind} of {name} is {shortened_repr(value)}.",
            f"It is a number{range_}.",
            "Correct it.",
            field=kind,
        )
    return number


def _window(given: Any) -> tuple[float, float]:
    """Return a departure window as seconds since 1970."""
    if isinstance(given, str) or len(_as_list(given)) != 2:
        raise InputError(
            f"The departure window is {given!r}.",
            "A departure window is two times.",
            "Give depart_window=(earliest, latest).",
        )
    first, last = map(parse_time, given)
    if not first <= last:
        raise InputError(
            f"The departure window ends ({format_time(last)}) before it begins "
            f"({format_time(first)}).",
            "The first time is the earliest departure.",
            "Give the earlier time first.",
        )
    return first, last


def _as_list(given: Any) -> tuple[Any, ...]:
    """Return an iterable as a tuple; a single value as a tuple of one."""
    return tuple(given) if hasattr(given, "__iter__") else (given,)


def checked_place(place: Any, what: str, field: str) -> Place:
    """Return a place as a checked position [deg] or a text; `InputError` for anything else."""
    form = 'A place is (lat, lon) in degrees or text such as "52.0N 4.1E" or a port.'
    if isinstance(place, str):
        if not place.strip():
            raise InputError(f"The {what} is empty.", form, "Give a place.", field=field)
        return place.strip()
    try:
        lat, lon = place
        with errors_about(field):
            return check_position(lat, lon, what)
    except InputError:
        raise
    except (TypeError, ValueError):
        asked = f"The {what} {shortened_repr(place)} is not a place."
        raise InputError(asked, form, "Give it in one of these forms.", field=field) from None


def _check_flag(name: str, value: Any) -> None:
    if not isinstance(value, (bool, np.bool_)):
        raise InputError(
            f"{name} is {shortened_repr(value)}.",
            "It is true or false.",
            "Correct it, or leave it out.",
            field=name,
        )


def _check_number(name: str, value: Any, *, above: float, below: float, unit: str) -> None:
    if value is None:
        return
    if isinstance(value, bool) or not math.isfinite(to_number(value)) or isinstance(value, str):
        raise InputError(
            f"{name} must be a number, not {shortened_repr(value)}.",
            f"It is between {max(above, 0):g} and {below:g} {unit}.",
            f"Give it in {unit}." if unit else "Give a number.",
            field=name,
        )
    if not above < value < below:
        raise InputError(
            f"{name} = {value:g} {unit} is out of range.",
            f"It is between {max(above, 0):g} and {below:g} {unit}.",
            "Correct it.",
            field=name,
            value=value,
        )
