"""`Voyage`: the request for a plan, in plain data that a YAML or JSON file can hold."""

from __future__ import annotations

import functools
import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, TypeVar

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.file_reading import read_text_file
from thalweg.core.file_writing import write_text
from thalweg.core.given_numbers import shortened_repr
from thalweg.core.time import format_time
from thalweg.planning.voyage_parts import (
    IndicatorRequest,
    Itinerary,
    Schedule,
    SearchRequest,
    VoyagePrices,
)

_Request = TypeVar("_Request")

#: The entries of a voyage in the order of its files.
_ENTRIES: Final = (
    "start", "goal", "depart", "depart_window", "objective", "via", "arrive_by", "arrive", "wait",
    "speed_kn", "hold", "min_ukc_m", "seed", "fuel_price_usd", "eca_price_factor",
    "time_price_usd_per_h", "forbid", "open", "avoid", "offing_nm", "ignore_shoals", "ignore_lanes",
    "method", "ensemble", "speed_step_kn", "speed_block_h", "layered", "weights", "at_most",
    "at_least",
)  # fmt: skip
#: Entries that are left out of plain data where they are empty.
_MAY_BE_EMPTY: Final = ("via", "forbid", "open", "avoid", "weights", "at_most", "at_least")
#: Entries that are left out of plain data at these values.
_LEFT_OUT: Final = (("method", "default"), ("ignore_shoals", False), ("ignore_lanes", False))


def _check_entries(names: Iterable[object]) -> None:
    """Refuse a name that is no entry of a voyage, with near matches."""
    for name in names:
        if name not in _ENTRIES:
            raise unknown_name_error("voyage entry", str(name), _ENTRIES, field=str(name))


def _with_near_names(cls: type[_Request]) -> type[_Request]:
    """Return a class of requests whose constructor names what an unknown entry may have meant."""
    init = cls.__init__

    @functools.wraps(init)
    def checked(self: _Request, *args: Any, **entries: Any) -> None:
        _check_entries(entries)
        init(self, *args, **entries)

    cls.__init__ = checked  # type: ignore[assignment, method-assign]
    return cls


@_with_near_names
@dataclass(frozen=True, kw_only=True)
class Voyage(IndicatorRequest, SearchRequest, VoyagePrices, Schedule, Itinerary):
    """A voyage to plan: an itinerary, a schedule, prices and a search request.

    Parameters
    ----------
    start, goal : (lat, lon) or str
        Departure and destination: degrees, or text (``"52.0N 4.1E"``, ``"52.0,4.1"``, the name of
        a port, ``"Rotterdam"`` or ``"Newcastle, AU"``, or its UN/LOCODE).
    depart : str, datetime or float, optional
        Time of departure, ISO 8601 in UTC (or seconds since 1970). Not needed with a window.
    depart_window : pair of times, optional
        Earliest and latest departure; the departure with the shortest passage is chosen (with via
        points the shortest passage to the first of them).
    objective : {"time", "distance", "fuel", "energy", "cost", "co2", "comfort", "encounters", \
"inshore", "weighted", "front"}
        The key figure to minimise. Energy is that of propulsion and hotel load, waiting included.
        Cost is that of fuel, time and canal dues; where fuel has no price, that of time and cubed
        speed (``costs`` in the ship file). Comfort is the squared motion sickness dose at the
        first of the ``places`` in the ship file; the ship does not wait for it. Encounters are
        those with other ships that the traffic of the chart makes likely, inshore is the length
        within 3 nm of land; both are searched on the network only, and so are weighted sums with
        them or with distance. ``"weighted"`` is the sum of `weights`. ``"front"`` returns the
        Pareto front of time against fuel, or against cost where a price is given. For all but time
        and distance the speed is chosen leg by leg.
    via : sequence of places
        Places to pass, in this order.
    arrive_by : time, optional
        Latest arrival.
    arrive : time, optional
        Arrival. With a departure the ship holds one speed or power (`hold`) that arrives in the
        minute before this time; without one the latest departure is found, at `speed_kn` or the
        highest speed. With an objective that chooses speeds it is the latest arrival.
    wait : bool
        Whether the ship may stop and wait (for a tide, for weather).
    speed_kn : float, optional
        Ordered speed through water in calm water [kn]; by default the highest of the ship.
    hold : {"speed", "power", "ground"}, optional
        What is held at `speed_kn` or at the speed found for `arrive`: the speed through water as
        long as the power allows, the power, or (with `arrive` and `depart`) the speed over ground.
        By default as the ship file orders.
    min_ukc_m : float, optional
        Least under-keel clearance [m]; by default the limit of the ship file, else zero. Where the
        chart or the sea provides depth, water of unknown depth is forbidden. Where neither does, a
        clearance cannot be required, and the plan notes that none was checked.
    seed : int
        Seed of all random numbers.
    fuel_price_usd : float, optional
        Price of fuel [USD/t]; by default that of the ship file.
    eca_price_factor : float, optional
        Price of fuel inside emission control areas over the price outside.
    time_price_usd_per_h : float, optional
        Cost of an hour of the voyage without fuel [USD/h]; by default the hire of the ship file.
    forbid : sequence of str
        Canals that may not be used (``"suez"``, ``"panama"``, ``"kiel"``, ``"corinth"``, or
        ``"all"``).
    open : sequence of str
        Named passages (`thalweg.chart.passages`) that the ship may use though they are closed to
        ships of her size. ``"all"``: all those for small or local ships in which her draught, beam
        and air draught allow it.
    avoid : sequence of str
        Named passages and canals that may not be used.
    offing_nm : float, optional
        Least distance from charted land [nm], outside named passages and harbour approaches; by
        default by the size of the ship (0.5, 1 or 2), and 0 for none.
    layered : mapping, optional
        Search a layered network: ``{layers: S, fan: H, offset_nm: d}``, each one number, or a list
        with one number for every section between via points (`thalweg.network.layered_network`).
    ignore_shoals : bool
        Whether miles in shoal water count like others, and none is closed but for named areas that
        dry (reefs, drying sands, wind farms, oil fields). By default a plan on
        the world's coasts without depth of its own keeps out of water shallower than one and a half
        draughts where it can, by the global depth layer (`thalweg.chart.depth.shoals`), and crosses
        no water that has much less than is required (`thalweg.chart.depth.closed_shoals`).
    ignore_lanes : bool
        Whether the approximate traffic separation schemes of the package
        (`thalweg.chart.zones.traffic_schemes`) do not count. By default a mile against their
        traffic counts ten, on the world's coasts without lanes among the zones.
    method : {"default", "exact", "nsga2", "spea2", "mpaes"}
        How a trade-off is searched: the exact front of a network, refined by evolution (default);
        the exact front alone; or an evolutionary method from a few routes, for comparison.
    ensemble : {"mean", "cvar"}, optional
        With a forecast of several members: choose the route with the least mean, or the least mean
        of the worst tenth (conditional value at risk).
    speed_step_kn : float, optional
        Where speeds are chosen leg by leg: speeds between the settings of the ship count too, so
        that none is farther from the next than this [kn], 0.1 or more. By default the settings of
        the ship file alone.
    speed_block_h : float, optional
        Where speeds are chosen leg by leg: least time that a speed is held [h], or a quarter of the
        passage where that is less; 0 lets the speed change at will. By default 6, and 0 with the
        method ``"exact"``.

    Raises
    ------
    InputError
        For unknown entries (with near matches), and for places, times, speeds or names that are not
        possible.
    """

    def __post_init__(self) -> None:
        self._check_itinerary()
        self._check_schedule()
        self._check_prices()
        self._check_search()
        self._check_indicators(self.objective)
        self._check_order()
        if self.chooses_speeds and self.depart_window is not None:
            raise InputError(
                f"A departure window is given with the objective {self.objective!r}.",
                "Windows are for the objectives 'time' and 'distance'; all other plans may wait at "
                "the start.",
                "Give a departure, and the latest arrival with arrive_by.",
                field="depart_window",
            )

    def _check_order(self) -> None:
        """Check what is held, and the speed beside a time of arrival."""
        if self.arrive is not None and self.depart is not None and self.speed_kn is not None:
            raise InputError(
                "A departure, a time of arrival and a speed are given.",
                "Two of them give the third.",
                "Leave one of them out, or give the latest arrival with arrive_by.",
                field="speed_kn",
            )
        if self.arrive is not None and self.depart is None and self.chooses_speeds:
            raise InputError(
                f"The latest departure was requested with the objective {self.objective!r}.",
                "It is found at one speed, for the objectives 'time' and 'distance'.",
                "Add the departure, or change the objective.",
                field="arrive",
            )
        if self.hold is None:
            return
        if self.speed_kn is None and (self.arrive is None or self.chooses_speeds):
            raise InputError(
                f"hold {self.hold} is given without a speed.",
                "It says what the engine holds at speed_kn (--speed), or at the speed found for "
                "arrive (--arrive).",
                "Add one of these, or leave out hold.",
                field="hold",
            )
        if self.hold == "ground" and (self.arrive is None or self.depart is None):
            raise InputError(
                "A speed over ground is to be held without both times.",
                "It follows from the departure and the arrival.",
                "Give depart and arrive, or hold the speed through water or the power.",
                field="hold",
            )

    def to_dict(self) -> dict[str, Any]:
        """Return plain data: times as ISO 8601 text, places as text or [lat, lon].

        Returns
        -------
        dict
            Without the entries that are not given.
        """
        data: dict[str, Any] = {}
        for name in _ENTRIES:
            value = getattr(self, name)
            if value is None or (name in _MAY_BE_EMPTY and not value):
                continue
            if (name, value) in _LEFT_OUT:
                continue
            data[name] = _plain_value(name, value)
        return data

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Voyage:
        """Build a voyage from plain data.

        Parameters
        ----------
        data : mapping
            As `to_dict` returns it.

        Returns
        -------
        Voyage
            The voyage.

        Raises
        ------
        InputError
            For unknown entries (with near matches), and for values that are not possible.
        """
        if not isinstance(data, Mapping):
            raise InputError(
                f"The voyage is {shortened_repr(data)}.",
                "It holds entries with values, at least start, goal and a departure.",
                "Write {start: Rotterdam, goal: Lisbon, depart: 2026-01-01T06:00Z}, for example.",
                field="voyage",
            )
        _check_entries(data)
        missing = [key for key in ("start", "goal") if key not in data]
        if missing:
            raise InputError(
                f"The voyage has no {' and no '.join(missing)}.",
                "A voyage has at least start, goal and a departure.",
                "Add what is missing.",
                field=missing[0],
            )
        return cls(**dict(data))

    @classmethod
    def load(cls, path: str | Path) -> Voyage:
        """Read a voyage from a YAML or JSON file.

        Parameters
        ----------
        path : path-like
            The file.

        Returns
        -------
        Voyage
            The voyage.

        Raises
        ------
        InputError
            If the file is missing, too large, neither YAML nor JSON, or holds impossible values.
        """
        from thalweg.core.strict_yaml import parse_yaml

        data = parse_yaml(read_text_file(path, "voyage"), "voyage", Path(path).name)
        if not isinstance(data, dict):
            raise InputError(
                f"{path} does not hold a voyage.",
                "A voyage file is a mapping with start and goal.",
                "Correct the file.",
            )
        return cls.from_dict(data)

    def save(self, path: str | Path) -> None:
        """Write the voyage to a file.

        Parameters
        ----------
        path : path
            JSON where its name ends in ``.json``, else YAML.
        """
        from thalweg.core.strict_yaml import dump_yaml

        path = Path(path)
        data = self.to_dict()
        as_json = path.suffix == ".json"
        text = json.dumps(data, indent=2, allow_nan=False) if as_json else dump_yaml(data)
        write_text(path, text)


def _plain_value(name: str, value: Any) -> Any:
    if name in ("depart", "arrive_by", "arrive"):
        return format_time(value)
    if name == "depart_window":
        return [format_time(t) for t in value]
    if name == "layered":
        return value.as_dict()
    if name == "via":
        return [_plain_value("place", place) for place in value]
    if isinstance(value, Mapping):
        return dict(value)
    return list(value) if isinstance(value, tuple) else value
