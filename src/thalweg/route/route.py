"""A route: a track with the results of the referee."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from thalweg.core.geodesy import format_position_minutes
from thalweg.core.given_numbers import finite_or_none
from thalweg.core.time import format_time, utc_text
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR, KNOT, MEGAWATT_HOUR, NAUTICAL_MILE, TONNE
from thalweg.kernels import codes
from thalweg.route.cost_parts import COST_PARTS
from thalweg.route.indicator_columns import indicator_table, indicator_value
from thalweg.route.number_texts import amount_text
from thalweg.route.route_tables import waypoint_frame, waypoint_rows
from thalweg.route.track import Track
from thalweg.ship.comfort.seaway_limit_names import SEAWAY_UNITS

if TYPE_CHECKING:
    import pandas as pd


ORDERED_TOO_FAST: Final = "ordered speed above the greatest of the ship"  #: start of a reason
#: Reason of a place where weather outside the range of a speed loss leaves too little of the speed.
SPEED_NOT_PREDICTED: Final = "weather beyond what the speed loss predicts"
#: Value [SI] and name of the unit in which a limit is stated, by the start of its reason.
_UNITS: Final = MappingProxyType(
    {
        ORDERED_TOO_FAST: (KNOT, " kn"),
        codes.REASONS[codes.DEPTH]: (1.0, " m"),
        codes.REASONS[codes.WAVE_HEIGHT]: (1.0, " m"),
        codes.REASONS[codes.WIND_SPEED]: (KNOT, " kn"),
        codes.REASONS[codes.OFFING]: (NAUTICAL_MILE, " nm"),
        SPEED_NOT_PREDICTED: (0.01, " % of the speed left"),
        **{f"{codes.REASONS[codes.SAFETY]}: {one}": unit for one, unit in SEAWAY_UNITS.items()},
    }
)
_MOST_DIGITS = 9  # after the point, of numbers that differ little


@dataclass(frozen=True)
class Violation:
    """One stretch of a route where a limit is violated or data are missing.

    Attributes
    ----------
    reason : str
        One of `thalweg.kernels.codes.REASONS`; details may follow a colon.
    time : float
        [s since 1970-01-01T00:00Z]; NaN if the route cannot be sailed so far.
    lat, lon : float
        Position [deg] of the worst point of the stretch.
    value, limit : float
        Value found there and value allowed, in SI (people sick in per cent); NaN where there is
        no number.
    """

    reason: str
    time: float
    lat: float
    lon: float
    value: float = float("nan")
    limit: float = float("nan")

    def __str__(self) -> str:
        place = format_position_minutes(self.lat, self.lon)
        when = f" on {utc_text(self.time)}" if np.isfinite(self.time) else ""
        text = f"{self.reason} at {place}{when}"
        if np.isfinite(self.value) and np.isfinite(self.limit):
            value, limit, name = self.number_texts()
            text += f" ({value}{name}, limit {limit}{name})"
        return text

    def number_texts(self) -> tuple[str, str, str]:
        """Return the value and the limit as texts.

        Returns
        -------
        tuple of str
            Value and limit, with as many decimals as make them differ, and the name of their unit
            after a space.
        """
        units = (unit for start, unit in _UNITS.items() if self.reason.startswith(start))
        unit, name = next(units, (1.0, ""))
        return *_distinct(self.value / unit, self.limit / unit), name

    def as_dict(self) -> dict[str, Any]:
        """Return the violation as plain data for JSON.

        Returns
        -------
        dict
            ``reason``, ``time`` (ISO 8601), ``lat``, ``lon``, ``value`` and ``limit``
            [SI]; None where unknown.
        """
        return {
            "reason": self.reason,
            "time": format_time(self.time) if np.isfinite(self.time) else None,
            "lat": self.lat,
            "lon": self.lon,
            "value": finite_or_none(self.value),
            "limit": finite_or_none(self.limit),
        }


@dataclass(frozen=True, eq=False)
class Route:
    """A track as evaluated by the referee; immutable.

    Attributes
    ----------
    track : Track
        The track that was sailed; settings are indices from 0, the lowest.
    legs : mapping of str to ndarray
        Per leg: ``length`` [m], ``course`` (at its start) [rad], ``depart``, ``arrive`` [s since
        1970], ``under_keel_clearance`` (least, in a wait before it too) [m], ``ordered_speed`` (in
        calm water, through it) [m/s]; NaN if unknown: ``fuel`` of sailing it and ``waiting_fuel``
        of waiting before it [kg], likewise ``energy`` and ``waiting_energy`` of brake and hotel
        load [J], and of both ``fuel_in_eca`` [kg], ``co2`` [kg] and ``cost`` [``currency``] (with
        canal dues and the price of time); ``leg_kind``, an index into
        `thalweg.route.route_tables.LEG_KINDS`.
    samples : mapping of str to ndarray
        The fine samples along the route, in order: ``time, leg, lat, lon, distance, course,
        heading, speed_through_water, speed_over_ground, depth, under_keel_clearance, power,
        fuel_rate`` and every sampled variable of the sea by its name; SI, NaN where unknown or not
        requested. Power is brake power; the fuel rate includes the hotel load.
    violations : tuple of Violation
        Violated limits; empty for a feasible route.
    tolerance_s : float
        Difference of the sailing time between the last two step sizes [s].
    assumptions : tuple of str
        Assumptions made where data are missing.
    fuel_zones : mapping of str to float
        Fuel [kg] by emission control area, and ``outside`` them; empty where no areas count.
    prices : mapping
        Currency of the cost, and the prices with their sources
        (`thalweg.ship.fuel_prices.FuelTerms.prices`).
    engine_order : str
        What the engine holds on every leg (`thalweg.ship.consumption.engine_order`).
    wait_samples : mapping of str to ndarray
        The columns of ``samples`` during the waits, at least every five minutes; ``leg`` is the one
        after the wait. Empty without waits.
    """

    track: Track
    legs: Mapping[str, FloatArray]
    samples: Mapping[str, FloatArray]
    violations: tuple[Violation, ...] = ()
    tolerance_s: float = float("nan")
    assumptions: tuple[str, ...] = field(default=())
    fuel_zones: Mapping[str, float] = field(default_factory=dict)
    prices: Mapping[str, Any] = field(default_factory=dict)
    engine_order: str = ""
    wait_samples: Mapping[str, FloatArray] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name in ("legs", "samples", "wait_samples"):
            columns = {key: np.array(values) for key, values in getattr(self, name).items()}
            for values in columns.values():
                values.setflags(write=False)
            object.__setattr__(self, name, MappingProxyType(columns))
        for name in ("fuel_zones", "prices"):
            object.__setattr__(self, name, MappingProxyType(dict(getattr(self, name))))

    @property
    def currency(self) -> str:
        """Currency of the cost; USD where the prices name none."""
        return str(self.prices.get("currency", "USD"))

    @property
    def depart(self) -> float:
        """Departure [s since 1970-01-01T00:00Z]."""
        return self.track.depart

    @property
    def arrive(self) -> float:
        """Arrival [s since 1970-01-01T00:00Z]; NaN if the route cannot be sailed to its end."""
        return float(self.legs["arrive"][-1])

    @property
    def time_h(self) -> float:
        """Time from departure to arrival, waits included [h]."""
        return (self.arrive - self.depart) / HOUR

    @property
    def distance_nm(self) -> float:
        """Length along the geodesics of its legs [nautical miles]."""
        return float(self.legs["length"].sum()) / NAUTICAL_MILE

    @property
    def fuel_t(self) -> float | None:
        """Fuel burnt [t]; None if the ship has no fuel model or the route cannot be completed."""
        sailing, waiting = self._sum("fuel"), self._sum("waiting_fuel")
        return None if sailing is None or waiting is None else (sailing + waiting) / TONNE

    @property
    def fuel_eca_t(self) -> float | None:
        """Fuel burnt inside emission control areas [t]; None where fuel is unknown."""
        total = self._sum("fuel_in_eca")
        return None if total is None or self.fuel_t is None else total / TONNE

    @property
    def fuel_by_zone_t(self) -> dict[str, float] | None:
        """Fuel [t] by emission control area, and ``outside`` them; None where fuel is unknown."""
        if self.fuel_t is None or not self.fuel_zones:
            return None
        return {name: value / TONNE for name, value in self.fuel_zones.items()}

    @property
    def co2_t(self) -> float | None:
        """Carbon dioxide emitted [t]; None where fuel or its carbon factor is unknown."""
        total = self._sum("co2")
        return None if total is None else total / TONNE

    @property
    def energy_mwh(self) -> float | None:
        """Energy of the brake and the hotel load, waits included [MWh]; None where unknown."""
        sailing, waiting = self._sum("energy"), self._sum("waiting_energy")
        return None if sailing is None or waiting is None else (sailing + waiting) / MEGAWATT_HOUR

    @property
    def cost(self) -> float | None:
        """Fuel, canal dues and time [``currency``]; None where fuel or a price is unknown."""
        return self._sum("cost")

    @property
    def cost_parts(self) -> dict[str, float | None]:
        """The parts of the cost [``currency``], by name; None where unknown."""
        return {name: self._sum(column) for name, column in COST_PARTS.items()}

    def _sum(self, name: str) -> float | None:
        return finite_or_none(float(self.legs[name].sum())) if name in self.legs else None

    @property
    def waiting_h(self) -> float:
        """Waiting time at waypoints [h]."""
        return float(self.track.wait.sum()) / HOUR

    @property
    def min_ukc_m(self) -> float | None:
        """Least under-keel clearance found [m]; None if no depth is known anywhere."""
        known = self.legs["under_keel_clearance"]
        known = known[np.isfinite(known)]
        return float(known.min()) if known.size else None

    @property
    def comfort(self) -> float | None:
        """Squared motion sickness dose at the first place of the ship file [m2/s3], or None."""
        return finite_or_none(indicator_value(self, "comfort"))

    @property
    def encounters(self) -> float | None:
        """Expected encounters with other ships; None where the traffic is unknown."""
        return finite_or_none(indicator_value(self, "encounters"))

    @property
    def inshore_nm(self) -> float | None:
        """Length within 3 nm of land [nautical miles]; None without a chart."""
        return finite_or_none(indicator_value(self, "inshore_nm"))

    @property
    def indicators(self) -> dict[str, Any]:
        """Comfort, workability, distance from land and depth; None where unknown."""
        return indicator_table(self)

    @property
    def feasible(self) -> bool:
        """Whether the route can be sailed to its end within every limit."""
        return not self.violations and bool(np.isfinite(self.arrive))

    def waypoints(self) -> list[dict[str, Any]]:
        """Return one plain dictionary per waypoint, ready for JSON (None where unknown).

        Returns
        -------
        list of dict
            In order; positions in degrees, times as ISO 8601, other keys end with their
            unit.
        """
        return waypoint_rows(self)

    def to_frame(self) -> pd.DataFrame:
        """Return a pandas table with one row per waypoint; ``time`` is datetime64 (UTC).

        Returns
        -------
        DataFrame
            The columns of `waypoints`.
        """
        return waypoint_frame(self)

    def sample_frame(self) -> pd.DataFrame:
        """Return a pandas table of the fine samples and of the waits, in SI.

        Returns
        -------
        DataFrame
            One row for each sample in the order of time, with the columns of ``samples``; speeds
            are zero during waits.
        """
        import pandas as pd

        return pd.DataFrame(self.samples_with_waits())

    def samples_with_waits(self) -> dict[str, FloatArray]:
        """Return the columns of ``samples`` with those of the waits between them.

        Returns
        -------
        dict of str to ndarray
            In the order of time; NaN where a value is not known during a wait.
        """
        waits = np.asarray(self.wait_samples.get("leg", ()), dtype=np.int64)
        leg = np.concatenate([waits, self.samples["leg"]])
        order = np.argsort(leg, kind="stable")  # a wait comes before its leg
        unknown = np.full(len(waits), np.nan)
        columns = {
            name: np.concatenate([self.wait_samples.get(name, unknown), values])[order]
            for name, values in self.samples.items()
        }
        return columns | {"leg": leg[order]}

    @property
    def cost_name(self) -> str:
        """Name of the cost in tables and JSON, such as ``cost_usd``."""
        return f"cost_{self.currency.casefold()}"

    def pricing_dict(self) -> dict[str, Any]:
        """Return the currency, the parts of the cost, and the prices with sources, for JSON.

        Returns
        -------
        dict
            ``currency``, ``cost_parts`` and ``prices``.
        """
        parts = self.cost_parts
        return {"currency": self.currency, "cost_parts": parts, "prices": dict(self.prices)}

    def as_dict(self) -> dict[str, Any]:
        """Return totals, waypoints and violations as plain data for JSON.

        Returns
        -------
        dict
            Keys end with their unit; None where a value is unknown.
        """
        return {
            "depart": format_time(self.depart),
            "arrive": format_time(self.arrive) if np.isfinite(self.arrive) else None,
            "time_h": finite_or_none(self.time_h),
            "distance_nm": self.distance_nm,
            "fuel_t": self.fuel_t,
            "fuel_eca_t": self.fuel_eca_t,
            "fuel_by_zone_t": self.fuel_by_zone_t,
            "co2_t": self.co2_t,
            "energy_mwh": self.energy_mwh,
            self.cost_name: self.cost,
            **self.pricing_dict(),
            "engine_order": self.engine_order,
            "waiting_h": self.waiting_h,
            "min_ukc_m": self.min_ukc_m,
            "indicators": self.indicators,
            "feasible": self.feasible,
            "tolerance_s": finite_or_none(self.tolerance_s),
            "assumptions": list(self.assumptions),
            "violations": [violation.as_dict() for violation in self.violations],
            "waypoints": self.waypoints(),
        }

    def __str__(self) -> str:
        fuel = "" if self.fuel_t is None else f", {amount_text(self.fuel_t, 't')} fuel"
        fuel += "" if self.cost is None else f", {amount_text(self.cost, self.currency)}"
        state = "" if self.feasible else f", {len(self.violations)} limits violated"
        return f"Route: {self.time_h:.4f} h, {self.distance_nm:.2f} nm{fuel}{state}"


def _distinct(value: float, limit: float) -> tuple[str, str]:
    """Return two numbers with two decimals, or as many more as make their texts differ."""
    texts = (f"{value:.2f}", f"{limit:.2f}")
    for digits in range(2, _MOST_DIGITS + 1):
        texts = (f"{value:.{digits}f}", f"{limit:.{digits}f}")
        if texts[0] != texts[1]:
            break
    return texts
