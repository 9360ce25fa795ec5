"""Named passages: straits and narrows that ships use nearer to land than their offing.

The table is ``data/passages.csv``, one row a passage. Its lines follow the water that is farthest
from land on both sides in the intermediate and the high resolution of GSHHG; they are not tracks to
sail by. Limits and notes whose source says "unchecked" are from general knowledge and were not
compared with a publication. The lines across passages are those that
`thalweg.chart.offing.closing_line` finds at the intermediate resolution; that of the Sound is by
hand, as islands divide it. A passage with the use "never" is closed in the chart to all ships (see
`thalweg.chart.coast.gshhg.CLOSED_NARROWS`).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from thalweg.chart.canals import CANALS, normalised_canal_name, sizes_over_limits
from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.file_reading import table_rows
from thalweg.core.geodesy import Position, line_length
from thalweg.core.types import FloatArray
from thalweg.core.units import KNOT, NAUTICAL_MILE

#: Ships at least this long [m] do not use passages for small or local ships.
SMALL_SHIP_LENGTH: Final = 120.0
EVERY_SMALL: Final = "all"  #: stands for the names of all passages for small or local ships
USES: Final = ("trade", "small_or_local", "never")


@dataclass(frozen=True)
class Passage:
    """A named passage.

    Parameters
    ----------
    name : str
        Name, by which it is opened or avoided: "Bosporus".
    use : {"trade", "small_or_local", "never"}
        Ships in trade; ships below 120 m only; none.
    line : tuple of (lat, lon)
        Centre line [deg], from open water at one end to open water at the other.
    half_width : float
        Least distance of the line from charted land [m].
    controlling_depth : float
        Least depth of the fairway [m]; NaN where unknown.
    max_draught, max_beam, max_length, max_air_draught : float
        Largest ship allowed [m]; inf where there is no limit or none is known.
    pilotage : str
        "compulsory", "recommended" or empty where unknown.
    note : str
        Bridges, services, restrictions.
    source : str
        Sources of the line and of the limits.
    lanes : tuple of lines (lat, lon), optional
        Middles of traffic lanes [deg] that are nearer to land than the centre line; along them the
        offing is as small as along that.
    closing_line : tuple of (lat, lon), optional
        Line across from land to land [deg], where islands divide the passage; by default it is
        found at the narrowest place (`thalweg.chart.offing.closing_line`).
    max_speed : float or None
        Largest speed over ground that is allowed [m/s]; None where there is no limit or none is
        known.

    Raises
    ------
    InputError
        If the use is unknown or the line has fewer than two points.
    """

    name: str
    use: str
    line: tuple[Position, ...]
    half_width: float = math.nan
    controlling_depth: float = math.nan
    max_draught: float = math.inf
    max_beam: float = math.inf
    max_length: float = math.inf
    max_air_draught: float = math.inf
    pilotage: str = ""
    note: str = ""
    source: str = ""
    closing_line: tuple[Position, ...] = ()
    lanes: tuple[tuple[Position, ...], ...] = ()
    max_speed: float | None = None

    def __post_init__(self) -> None:
        if self.use not in USES or len(self.line) < 2:
            raise InputError(
                f"The passage {self.name!r} has the use {self.use!r} and {len(self.line)} points.",
                f"Uses are {', '.join(USES)}; a line has two points or more.",
                "Correct it.",
            )

    @property
    def positions(self) -> tuple[FloatArray, FloatArray]:
        """Latitudes and longitudes of the line [deg]."""
        lat, lon = np.array(self.line, float).T
        return lat, lon

    @property
    def ends(self) -> tuple[Position, Position]:
        """The two ends of the line (lat, lon) [deg]."""
        return self.line[0], self.line[-1]

    @cached_property
    def length(self) -> float:
        """Length of the line [m]."""
        return line_length(self.line)

    @property
    def limits(self) -> str:
        """The limits as text for a plan: "draught 7.7 m, air draught 57 m"; empty for none."""
        named = (
            ("draught", self.max_draught),
            ("beam", self.max_beam),
            ("length", self.max_length),
            ("air draught", self.max_air_draught),
        )
        return ", ".join(f"{what} {limit:g} m" for what, limit in named if limit < math.inf)

    def ship_restriction(
        self,
        *,
        draught: float | None = None,
        beam: float | None = None,
        length: float | None = None,
        air_draught: float | None = None,
    ) -> str:
        """Return why a ship of these dimensions may not pass, as text.

        Dimensions that are not known are not checked.

        Parameters
        ----------
        draught, beam, length, air_draught : float, optional
            Dimensions of the ship [m]; None where unknown.

        Returns
        -------
        str
            Empty if it may pass.
        """
        if self.use == "never":
            return f"{self.name} is closed to ships"
        reasons = []
        if self.use == "small_or_local" and (length is None or length >= SMALL_SHIP_LENGTH):
            reasons.append(f"it is for ships below {SMALL_SHIP_LENGTH:g} m")
        sizes = (draught, beam, length, air_draught)
        limits = (self.max_draught, self.max_beam, self.max_length, self.max_air_draught)
        reasons += [f"the {what} of {over}" for what, over in sizes_over_limits(sizes, limits)]
        return f"{self.name}: {' and '.join(reasons)}" if reasons else ""


def find_passages(names: Iterable[str]) -> list[Passage]:
    """Return the passages of these names; case, spaces and what is in brackets do not count.

    Parameters
    ----------
    names : iterable of str
        Names, or their beginnings where these are unique: "great belt". "all" stands for all that
        are for small or local ships.

    Returns
    -------
    list of Passage
        In the order of the names.

    Raises
    ------
    InputError
        If a name is unknown; the message lists similar names.
    """
    found = []
    for name in map(str, names):
        every = name.strip().casefold() == EVERY_SMALL
        found += _small_or_local() if every else [_find_passage(name)]
    return list(dict.fromkeys(found))


def _small_or_local() -> list[Passage]:
    return [passage for passage in PASSAGES if passage.use == "small_or_local"]


def split_avoided(names: Sequence[str]) -> tuple[list[str], list[Passage]]:
    """Return the canals and the passages among names to avoid.

    Raises
    ------
    InputError : If a name is neither; the message lists similar names.
    """
    canals, passages = [], []
    known = {canal.name for canal in CANALS}
    for name in names:
        plain = normalised_canal_name(name)
        if plain in known:
            canals.append(plain)
            continue
        try:
            passages += find_passages([name])
        except InputError:
            every = [*sorted(known), *(passage.name for passage in PASSAGES)]
            raise unknown_name_error("passage or canal", name, every) from None
    return canals, passages


def _find_passage(name: str) -> Passage:
    whole = [p for p in PASSAGES if p.name.casefold() == name.strip().casefold()]
    if len(whole) == 1:
        return whole[0]
    wanted = _plain_name(name)
    plain = [p for p in PASSAGES if _plain_name(p.name) == wanted]
    begins = [p for p in PASSAGES if wanted and _plain_name(p.name).startswith(wanted)]
    found = plain or begins
    if len(found) != 1:
        raise unknown_name_error("passage", name, [p.name for p in found or PASSAGES])
    return found[0]


def _plain_name(name: str) -> str:
    plain = name.partition("(")[0].casefold().replace("-", " ").replace(":", " ")
    words = [word for word in plain.split() if word not in ("strait", "straits", "the", "of")]
    return " ".join(words)


def _read_passages() -> tuple[Passage, ...]:
    return tuple(_passage_of_row(row) for row in table_rows("thalweg.chart", "passages.csv"))


def _passage_of_row(row: dict[str, str]) -> Passage:
    def number(column: str, absent: float) -> float:
        return float(row[column]) if row[column] else absent

    line, *lanes = (read_line(part) for part in row["line"].split("|"))
    return Passage(
        row["name"],
        row["use"],
        line,
        half_width=number("half_width_nm", math.nan) * NAUTICAL_MILE,
        controlling_depth=number("controlling_depth_m", math.nan),
        max_draught=number("max_draught_m", math.inf),
        max_beam=number("max_beam_m", math.inf),
        max_length=number("max_length_m", math.inf),
        max_air_draught=number("max_air_draught_m", math.inf),
        pilotage=row["pilotage"],
        note=row["note"],
        source=row["source"],
        closing_line=read_line(row["closing_line"] or ""),
        lanes=tuple(lanes),
        max_speed=float(row["max_speed_kn"]) * KNOT if row["max_speed_kn"] else None,
    )


def read_line(text: str) -> tuple[Position, ...]:
    """Return positions [deg] of a text such as ``51.2,-57.2 51.6,-56.6``."""
    points = [point.split(",") for point in text.split()]
    return tuple((float(lat), float(lon)) for lat, lon in points)


PASSAGES: Final = _read_passages()  #: the passages of `thalweg/chart/data/passages.csv`
