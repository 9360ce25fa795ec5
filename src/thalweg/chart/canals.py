"""Ship canals: the ways through land that a coastline does not show.

A canal is one leg between two positions in open water off its entrances, with its own length, time
and fee. Figures are public ones, for planning; they were gathered on 2026-11-21 and are named with
each canal. A fee is a mean of what ships paid, not a tariff: dues depend on tonnage, cargo and
towage. Give your own canals to a chart with `dataclasses.replace` for a ship whose dues are known.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.geodesy import Position, distance

END_TOLERANCE: Final = 2.0  # a leg ends at a canal's end when it ends this near to it [m]
_END_TOLERANCE_DEGREES: Final = 2e-5  # nearer than this in latitude is worth measuring
_HOUR: Final = 3600.0


@dataclass(frozen=True)
class Canal:
    """A ship canal.

    Parameters
    ----------
    name : str
        Short name, by which it is forbidden: "suez".
    title : str
        Name in full.
    path : tuple of (lat, lon)
        The line of the canal [deg], from open water at one end to open water at the other.
    transit_time : float
        Time from end to end [s], without waiting for a turn.
    fee : float
        Mean dues of one transit [USD].
    max_draught, max_beam : float
        Largest draught and beam allowed [m]; inf if there is none.
    source : str
        Where the figures come from, with dates.

    Raises
    ------
    InputError
        If the path is no path, or a figure is negative or no number.
    """

    name: str
    title: str
    path: tuple[Position, ...]
    transit_time: float
    fee: float
    max_draught: float = np.inf
    max_beam: float = np.inf
    source: str = ""

    def __post_init__(self) -> None:
        path = np.array(self.path, float)
        sound = path.ndim == 2 and path.shape[1] == 2 and len(path) >= 2
        if not (sound and np.isfinite(path).all() and np.abs(path[:, 0]).max() <= 90.0):
            raise InputError(
                f"The path of the canal {self.name!r} is none.",
                "It is two or more positions (lat, lon) in degrees.",
                "Give both ends at least.",
                value=self.path,
            )
        limits = self.max_draught > 0.0 and self.max_beam > 0.0
        if not (0.0 < self.transit_time < np.inf and 0.0 <= self.fee < np.inf and limits):
            raise InputError(
                f"The canal {self.name!r} has a transit time of {self.transit_time!r} s, a fee of "
                f"{self.fee!r} and limits of {self.max_draught!r} and {self.max_beam!r} m.",
                "Times and limits are above 0, fees not below it.",
                "Correct these figures.",
            )

    @property
    def ends(self) -> tuple[Position, Position]:
        """The two ends (lat, lon) [deg]."""
        return self.path[0], self.path[-1]

    @cached_property
    def length(self) -> float:
        """Length of the path [m]."""
        lat, lon = np.array(self.path, float).T
        return float(np.sum(distance(lat[:-1], lon[:-1], lat[1:], lon[1:])))

    def transit_restriction(
        self, *, draught: float | None = None, beam: float | None = None
    ) -> str:
        """Return in words why a ship of a draught and beam [m] may not pass; empty if it may."""
        reasons = []
        for what, value, limit in (
            ("draught", draught, self.max_draught),
            ("beam", beam, self.max_beam),
        ):
            if value is not None and value > limit:
                reasons.append(f"its {what} of {value:g} m is over the {limit:g} m allowed")
        return f"{self.title}: " + " and ".join(reasons) if reasons else ""


SUEZ: Final = Canal(
    "suez",
    "Suez Canal",
    (
        (31.38, 32.38), (31.23, 32.35), (30.85, 32.315), (30.56, 32.30), (30.42, 32.35),
        (30.32, 32.39), (30.22, 32.555), (29.93, 32.57), (29.80, 32.54),
    ),
    transit_time=14.0 * _HOUR,
    fee=363_000.0,
    max_draught=20.12,
    max_beam=77.5,
    source="Suez Canal Authority: 66 ft of draught (up to 50 m of beam), 77.5 m of beam; 193.3 km "
    "with its approaches, 11 to 16 h, about 14 h on average (Encyclopaedia Britannica). Fee: "
    "revenue of 9.4 thousand million USD over 25,887 transits in 2022/23 (Reuters, 21 June 2023).",
)  # fmt: skip
PANAMA: Final = Canal(
    "panama",
    "Panama Canal",
    (
        (9.45, -79.92), (9.37, -79.92), (9.27, -79.92), (9.20, -79.90), (9.12, -79.80),
        (9.10, -79.69), (9.00, -79.60), (8.93, -79.555), (8.80, -79.48),
    ),
    transit_time=10.0 * _HOUR,
    fee=261_000.0,
    max_draught=15.24,
    max_beam=51.25,
    source="Panama Canal Authority: Neopanamax locks 51.25 m of beam and 50 ft of draught in "
    "tropical fresh water, less when Gatun Lake is low (ships up to 32.31 m and 12.04 m take the "
    "old locks); 8 to 10 h. Fee: 3.3 thousand million USD of tolls over 12,638 transits in fiscal "
    "year 2023 (Panama Canal Authority, AFP of 18 December 2023).",
)  # fmt: skip
KIEL: Final = Canal(
    "kiel",
    "Kiel Canal",
    (
        (53.885, 9.10), (53.90, 9.15), (54.02, 9.29), (54.13, 9.32), (54.21, 9.50),
        (54.31, 9.68), (54.34, 9.88), (54.365, 10.14), (54.42, 10.20),
    ),
    transit_time=9.0 * _HOUR,
    fee=8_000.0,
    max_draught=9.5,
    max_beam=32.5,
    source="Federal Waterways and Shipping Administration: 98.26 km at no more than 12 km/h (since "
    "1 July 2023, Hansa of April 2023) and two locks; 32.5 m of beam, 9.5 m of draught up to 160 m "
    "of length, 7 m up to 235.5 m. Fee: no mean is published; an estimate for 10,000 GT, of which "
    "1,792 EUR go to the canal steerers (KanalStTO) and the rest to pilots and dues.",
)  # fmt: skip
CORINTH: Final = Canal(
    "corinth",
    "Corinth Canal",
    ((37.97, 22.93), (37.954, 22.955), (37.916, 23.008), (37.89, 23.04)),
    transit_time=1.25 * _HOUR,
    fee=2_900.0,
    max_draught=7.2,
    max_beam=18.3,
    source="Corinth Canal regulations, articles 2 and 3: 6.343 km at no more than 6 kn, 18.3 m of "
    "beam, 7.2 m of draught below 14 m of beam (6.2 m at 16.5 m). Fee: 2,575 EUR for 3,000 net "
    "tons (tariff of September 2025).",
)
CANALS: Final = (SUEZ, PANAMA, KIEL, CORINTH)


def exclude_canals(canals: Sequence[Canal], names: Sequence[str]) -> tuple[Canal, ...]:
    """Return canals without the named ones ("all" takes all away).

    Raises
    ------
    InputError
        If there is no canal of a name; near matches are named.
    """
    known = {canal.name for canal in canals} | {canal.name for canal in CANALS}
    plain = [_normalised_canal_name(name) for name in names]
    for written, name in zip(names, plain):
        if name not in known | {"all"}:
            raise unknown_name_error("canal", str(written), sorted(known | {"all"}))
    return () if "all" in plain else tuple(c for c in canals if c.name not in plain)


def _normalised_canal_name(name: str) -> str:
    return str(name).strip().casefold().removesuffix("canal").strip(" -_")


def canal_index_of_legs(
    canals: Sequence[Canal], lat1: ArrayLike, lon1: ArrayLike, lat2: ArrayLike, lon2: ArrayLike
) -> NDArray[np.int64]:
    """Return which canal each leg [deg] runs through, from one end to the other; -1 for none.

    Parameters
    ----------
    canals : sequence of Canal
    lat1, lon1, lat2, lon2 : array_like
        Ends of legs [deg]; they broadcast.

    Returns
    -------
    int64 ndarray
        Index into ``canals`` where both ends lie within 2 m of the two ends of a canal, in either
        direction.
    """
    ends = np.broadcast_arrays(*(np.asarray(x, float) for x in (lat1, lon1, lat2, lon2)))
    number = np.full(ends[0].shape, -1, np.int64)
    flat = number.reshape(-1)
    a, b, c, d = (x.reshape(-1) for x in ends)
    for k, canal in enumerate(canals):
        for first, last in (canal.ends, canal.ends[::-1]):
            near = np.flatnonzero(
                (np.abs(a - first[0]) < _END_TOLERANCE_DEGREES)
                & (np.abs(c - last[0]) < _END_TOLERANCE_DEGREES)
            )
            at_first = distance(a[near], b[near], *first) <= END_TOLERANCE
            flat[near[at_first & (distance(c[near], d[near], *last) <= END_TOLERANCE)]] = k
    return number
