"""Ship canals: connections through land that a coastline does not show.

A canal is one leg between two positions in open water off its entrances, with its own length, time
and fee. Ports on its banks enter it on the way (`thalweg.chart.canal_parts`). The figures in
``data/canals.json`` are published ones, for planning, collected on 2026-11-21; each canal names its
sources. The dues of Suez, Panama and Kiel depend on the tonnage, beam and type of the ship
(`thalweg.chart.canal_tariff`); elsewhere, and for ships of unknown size, the fee is the mean that
ships paid. Rebates, towage and waiting are not counted. For a ship whose dues are known, give the
chart other canals with `dataclasses.replace`.
"""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from importlib import resources
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.chart.canal_tariff import CanalTariff, known_gross_tonnage, tariff_kind
from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.geodesy import Position, distance, line_length
from thalweg.core.units import HOUR
from thalweg.deprecated_names import renamed_attributes

if TYPE_CHECKING:
    from thalweg.ship.schema.ship_schema import HullSection

END_TOLERANCE: Final = 2.0  # a leg ends at a canal's end when it ends this near to it [m]
_END_TOLERANCE_DEGREES: Final = 2e-5  # only ends nearer than this in latitude are measured


@dataclass(frozen=True)
class Canal:
    """A ship canal.

    Parameters
    ----------
    name : Short name, by which it is forbidden: "suez".
    title : Name in full.
    path : tuple of (lat, lon)
        Centre line [deg], from open water at one end to open water at the other.
    transit_time : Time from end to end [s], without waiting for a convoy or a lock.
    fee : Mean dues of one transit [USD].
    max_draught, max_beam : Largest draught and beam allowed [m]; inf where there is no limit.
    source : Sources of the figures, with dates.
    tariff : Dues by the size of the ship; it counts as long as ``fee`` is its mean.
    fee_basis : How the fee of a ship was found.
    max_length, max_air_draught : Largest length and height above water allowed [m].
    long_ship_limit : Length [m] from which on the draught falls evenly to that of the longest
        ships, and that draught [m].

    Raises
    ------
    InputError : If the path has fewer than two points, or a value is negative or not a number.
    """

    name: str
    title: str
    path: tuple[Position, ...]
    transit_time: float
    fee: float
    max_draught: float = np.inf
    max_beam: float = np.inf
    source: str = ""
    tariff: CanalTariff | None = None
    fee_basis: str = ""
    max_length: float = np.inf
    max_air_draught: float = np.inf
    long_ship_limit: tuple[float, float] = (np.inf, np.inf)

    if not TYPE_CHECKING:
        __getattr__ = renamed_attributes(
            why_not="transit_restriction",
        )

    def __post_init__(self) -> None:
        path = np.array(self.path, float)
        sound = path.ndim == 2 and path.shape[1] == 2 and len(path) >= 2
        if not (sound and np.isfinite(path).all() and np.abs(path[:, 0]).max() <= 90.0):
            raise InputError(
                f"The path of the canal {self.name!r} is not valid.",
                "It is two or more positions (lat, lon) in degrees.",
                "Give both ends at least.",
                value=self.path,
            )
        limits = self.max_draught > 0.0 and self.max_beam > 0.0
        if not (0.0 < self.transit_time < np.inf and 0.0 <= self.fee < np.inf and limits):
            raise InputError(
                f"The canal {self.name!r} has a transit time of {self.transit_time!r} s, a fee of "
                f"{self.fee!r} and limits of {self.max_draught!r} and {self.max_beam!r} m.",
                "Times and limits are above 0, and fees are not negative.",
                "Correct these figures.",
            )

    @property
    def ends(self) -> tuple[Position, Position]:
        """The two ends (lat, lon) [deg]."""
        return self.path[0], self.path[-1]

    @cached_property
    def length(self) -> float:
        """Length of the path [m]."""
        return line_length(self.path)

    @property
    def inner_line(self) -> tuple[Position, ...]:
        """The path from gate to gate (lat, lon) [deg]: without its first and last leg at sea."""
        return self.path[1:-1] if len(self.path) > 3 else self.path

    def transit_restriction(
        self,
        *,
        draught: float | None = None,
        beam: float | None = None,
        length: float | None = None,
        air_draught: float | None = None,
    ) -> str:
        """Return why a ship of these sizes [m] may not pass, as text; empty if it may."""
        deepest = self._greatest_draught(length)
        reasons = []
        sizes = (draught, beam, length, air_draught)
        limits = (deepest, self.max_beam, self.max_length, self.max_air_draught)
        for what, over in sizes_over_limits(sizes, limits):
            reasons.append(f"the {what} of {over}")
            if what == "draught" and deepest < self.max_draught:
                reasons[-1] += f" for {length:.4g} m of length"
        return f"{self.title}: " + " and ".join(reasons) if reasons else ""

    def _greatest_draught(self, length: float | None) -> float:
        """Return the greatest draught [m]; that of long ships falls evenly with their length."""
        first, least = self.long_ship_limit
        if length is None or not length > first:
            return self.max_draught
        depths = self.max_draught, min(least, self.max_draught)
        found = float(np.interp(length, (first, max(self.max_length, first + 1.0)), depths))
        return round(found, 2)


def sizes_over_limits(
    sizes: Sequence[float | None], limits: Sequence[float]
) -> list[tuple[str, str]]:
    """Return the sizes of a ship that are over their limits: what, and both figures as text.

    Parameters
    ----------
    sizes, limits : Draught, beam, length and air draught [m]; sizes are None where unknown.
    """
    rows = zip(("draught", "beam", "length", "air draught"), sizes, limits, strict=True)
    return [
        (what, f"{size:g} m is over the {limit:g} m allowed")
        for what, size, limit in rows
        if size is not None and size > limit
    ]


def _read_canals() -> tuple[Canal, ...]:
    text = resources.files("thalweg.chart").joinpath("data/canals.json").read_text("utf-8")
    return tuple(
        Canal(
            row["name"],
            row["title"],
            tuple((lat, lon) for lat, lon in row["path"]),
            transit_time=row["transit_time_h"] * HOUR,
            fee=row["fee_usd"],
            max_draught=row["max_draught_m"],
            max_beam=np.inf if row["max_beam_m"] is None else row["max_beam_m"],
            max_length=row.get("max_length_m", np.inf),
            max_air_draught=row["max_air_draught_m"],
            long_ship_limit=tuple(row.get("long_ship_limit_m", (np.inf, np.inf))),
            source=row["source"],
            tariff=(
                CanalTariff.from_row(row["tariff"], row["fee_usd"]) if "tariff" in row else None
            ),
        )
        for row in json.loads(text)
    )


CANALS: Final = _read_canals()  #: the canals of `thalweg/chart/data/canals.json`
SUEZ, PANAMA, KIEL, CORINTH, CAPE_COD = CANALS


def canals_with_dues(canals: Sequence[Canal], hull: HullSection) -> tuple[Canal, ...]:
    """Return canals with the dues of a ship.

    Parameters
    ----------
    canals : Those whose fee is not the mean of their tariff stay as they are.
    hull : Of a ship file: tonnage, breadth and type.

    Returns
    -------
    tuple of Canal : ``fee_basis`` says how the dues were found.
    """
    return tuple(_with_dues(canal, hull) for canal in canals)


def _with_dues(canal: Canal, hull: HullSection) -> Canal:
    tariff = canal.tariff
    if tariff is None or canal.fee != tariff.mean:
        return canal
    tons = getattr(hull, tariff.tonnage)
    name, how = tariff.tonnage.replace("_", " "), "of the ship file"
    if tons is None:
        gross, how = known_gross_tonnage(hull)
        if gross is None:
            return replace(canal, fee_basis=f"the mean of all ships, since {how}")
        tons = tariff.tons_per_gross_ton * gross
        how = f"estimated: {how}" if how else "from the gross tonnage of the ship file"
    kinds = tariff_kind(hull.type or "", hull.breadth_m)
    paid = tariff.dues(tons, beam=hull.breadth_m, kind=kinds.get(tariff.tonnage, ""))
    basis = f"{name} {tons:,.0f} ({how})"
    if hull.breadth_m is None and len(tariff.fixed) > 1:
        basis += "; breadth unknown: the lowest tariff"
    return replace(canal, fee=float(round(paid)), fee_basis=basis)


def exclude_canals(canals: Sequence[Canal], names: Sequence[str]) -> tuple[Canal, ...]:
    """Return canals without the named ones ("all" excludes all).

    Raises
    ------
    InputError : If a name is unknown; the message lists similar names.
    """
    known = {canal.name for canal in canals} | {canal.name for canal in CANALS}
    plain = [normalised_canal_name(name) for name in names]
    for written, name in zip(names, plain):
        if name not in known | {"all"}:
            raise unknown_name_error("canal", str(written), sorted(known | {"all"}))
    return () if "all" in plain else tuple(c for c in canals if c.name not in plain)


def normalised_canal_name(name: str) -> str:
    """Return the name of a canal as `Canal.name` is written: "Cape Cod Canal" is "cape-cod"."""
    plain = str(name).strip().casefold().removesuffix("canal").strip(" -_")
    return plain.replace(" ", "-")


def canal_index_of_legs(
    canals: Sequence[Canal], lat1: ArrayLike, lon1: ArrayLike, lat2: ArrayLike, lon2: ArrayLike
) -> NDArray[np.int64]:
    """Return which canal each leg [deg] runs through, from one end to the other; -1 for none.

    Parameters
    ----------
    lat1, lon1, lat2, lon2 : Ends of legs [deg]; they broadcast.

    Returns
    -------
    int64 ndarray : Index into ``canals`` where both ends lie within 2 m of the two ends of a canal,
        in either direction.
    """
    ends = np.broadcast_arrays(*(np.asarray(x, float) for x in (lat1, lon1, lat2, lon2)))
    number = np.full(ends[0].shape, -1, np.int64)
    flat = number.reshape(-1)
    # few legs begin at the latitude of an end of a canal
    lat = np.sort([position[0] for canal in canals for position in canal.ends])
    below = np.searchsorted(lat - _END_TOLERANCE_DEGREES, ends[0].reshape(-1)) - 1
    known = ends[0].reshape(-1) < np.append(lat, -math.inf)[below] + _END_TOLERANCE_DEGREES
    legs = np.flatnonzero(known)
    if not legs.size:
        return number
    a, b, c, d = (x.reshape(-1)[legs] for x in ends)
    for k, canal in enumerate(canals):
        for first, last in (canal.ends, canal.ends[::-1]):
            near = np.flatnonzero(
                (np.abs(a - first[0]) < _END_TOLERANCE_DEGREES)
                & (np.abs(c - last[0]) < _END_TOLERANCE_DEGREES)
            )
            if not len(near):
                continue
            at_first = distance(a[near], b[near], *first) <= END_TOLERANCE
            there = at_first & (distance(c[near], d[near], *last) <= END_TOLERANCE)
            flat[legs[near[there]]] = k
    return number


def path_of_canal(start: ArrayLike, goal: ArrayLike) -> tuple[Position, ...]:
    """Return the line of the canal of the package from one position to the other, or ().

    Parameters
    ----------
    start, goal : Ends of a canal (lat, lon) [deg], in any order.
    """
    ends = [np.array([value]) for value in (*np.asarray(start, float), *np.asarray(goal, float))]
    number = int(canal_index_of_legs(CANALS, *ends)[0])
    if number < 0:
        return ()
    path = CANALS[number].path
    first, last = (float(distance(*one, *np.asarray(start, float))) for one in (path[0], path[-1]))
    return path if first < last else path[::-1]
