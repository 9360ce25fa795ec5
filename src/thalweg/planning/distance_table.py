"""Tables of distances by sea between ports."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from os import PathLike
from typing import TYPE_CHECKING, Final

import numpy as np

from thalweg.chart import Chart
from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.file_reading import cause_of
from thalweg.core.geodesy import check_position
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.history.history_network import HistoryNetwork
from thalweg.network.history.season_masks import month_notes
from thalweg.planning.sea_distance import DEFAULT_OFFING_NM, SMALL_CANALS, sea_distance
from thalweg.planning.voyage_parts import Place

if TYPE_CHECKING:
    from collections.abc import Mapping

MOST_PORTS: Final = 4_000  #: in one table
_MORE: Final = "(more)"  # fields beyond the columns
_NAMES: Final = ("port", "name", "locode", "unlocode")


@dataclass(frozen=True, eq=False)
class DistanceTable:
    """Distances from every port to every other.

    Attributes
    ----------
    names : tuple of str
        As they were given.
    length : float64 array (P, P)
        From the port of the row to that of the column [m]; 0 for a port itself, NaN where there is
        no way.
    notes : tuple of str
        Pairs without a way.
    """

    names: tuple[str, ...]
    length: FloatArray
    notes: tuple[str, ...] = ()

    @property
    def nm(self) -> FloatArray:
        """The distances [nautical miles]."""
        return self.length / NAUTICAL_MILE

    def to_csv(self) -> str:
        """Return the table as CSV: a row and a column for each port, in nautical miles.

        Returns
        -------
        str
            One decimal; empty where there is no way.
        """
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(["nm", *self.names])
        for name, row in zip(self.names, self.nm.tolist()):
            writer.writerow([name, *("" if math.isnan(x) else f"{x:.1f}" for x in row)])
        return text.getvalue()


def distance_table(
    ports: Sequence[tuple[str, Place]],
    *,
    avoid: Sequence[str] = SMALL_CANALS,
    offing_nm: float = DEFAULT_OFFING_NM,
    draught_m: float | None = None,
    chart: Chart | None = None,
    progress: Callable[[str], None] | None = None,
) -> DistanceTable:
    """Return the shortest distances by sea between ports.

    Parameters
    ----------
    ports : sequence of (name, place)
        Places as those of `thalweg.distance`; by `read_places` from a file.
    avoid : sequence of str
        Canals and passages that are not used.
    offing_nm : float
        Distance from land [nm] that ways keep outside passages.
    draught_m : float, optional
        Ways keep out of water shallower than one and a half draughts [m] where they can.
    chart : Chart, optional
        By default the GSHHG coastline at resolution "i".
    progress : callable, optional
        Called with a short text for every port.

    Returns
    -------
    DistanceTable
        The same in both directions. Every pair takes about half a second.

    Raises
    ------
    InputError
        For unknown ports, and for more than `MOST_PORTS`.
    """
    names = _checked_names([name for name, _ in ports])
    length = np.zeros((len(ports), len(ports)))
    notes = []
    for i, (name, start) in enumerate(ports):
        if progress is not None:
            progress(f"finding the ways from {name} ({i + 1} of {len(ports)})")
        for j in range(i + 1, len(ports)):
            try:
                found = sea_distance(
                    start, ports[j][1], avoid=avoid, offing_nm=offing_nm, draught_m=draught_m,
                    chart=chart,
                ).length  # fmt: skip
            except NoRouteError:
                found = math.nan
                notes.append(f"No way from {name} to {ports[j][0]}.")
            length[i, j] = length[j, i] = found
    return DistanceTable(names, length, tuple(notes))


def usual_distance_table(
    ports: Sequence[str],
    network: HistoryNetwork,
    *,
    month: int | None = None,
    draught: float | None = None,
) -> DistanceTable:
    """Return the usual distances between ports of a history network.

    Parameters
    ----------
    ports : sequence of str
        Ports of the network.
    network : HistoryNetwork
    month : int, optional
        1 to 12: without arcs that are closed in this month.
    draught : float, optional
        [m]; without arcs on which only smaller ships were seen.

    Returns
    -------
    DistanceTable
        The two directions may differ.

    Raises
    ------
    InputError
        For ports that are not in the network.
    """
    names = _checked_names(ports)
    nodes = [network.port_node(name) for name in ports]
    weight = network.weights(month=month, draught=draught)
    length = np.zeros((len(ports), len(ports)))
    notes: list[str] = []
    doubtful: list[str] = []
    joined: list[str] = []
    for i, start in enumerate(nodes):
        for j, goal in enumerate(nodes):
            if start == goal:
                continue
            arcs = network.usual_way(start, goal, weight, month=month)
            if not arcs:
                notes.append(f"No way from {names[i]} to {names[j]}.")
                length[i, j] = math.nan
                continue
            route = network.route_along((start, goal), arcs, month=month)
            length[i, j] = route.length
            if route.whole <= 0:
                joined.append(f"{names[i]} to {names[j]}")
            elif route.confidence in ("low", "none"):
                doubtful.append(f"{names[i]} to {names[j]}")
    if doubtful:
        notes.append(
            "Few voyages on the way, so that the distance is doubtful: " + ", ".join(doubtful) + "."
        )
    if joined:
        notes.append(
            "No voyage sailed the whole way; the distance is that of parts of other voyages: "
            + ", ".join(joined)
            + "."
        )
    return DistanceTable(names, length, (*month_notes(network.months_seen, month), *notes))


def read_places(path: str | PathLike[str]) -> list[tuple[str, Place]]:
    """Read ports or positions from a CSV file.

    Parameters
    ----------
    path : A column ``port``, ``name`` or ``locode``, and maybe ``lat`` and ``lon`` [deg]; rows with
        both are positions.

    Returns
    -------
    list of (name, place)

    Raises
    ------
    InputError : If the file cannot be read or has no such column.
    """
    try:
        with open(path, encoding="utf-8-sig", newline="") as file:
            rows = [
                {str(k).strip().lower(): v for k, v in row.items()}
                for row in csv.DictReader(file, restkey=_MORE)
            ]
    except (OSError, ValueError, csv.Error) as error:
        raise InputError(
            f"The file of ports {str(path)!r} cannot be read: {cause_of(error)}.",
            "It is a CSV file with a column port, name or locode.",
            "Check the path and the file.",
        ) from error
    if not rows or not set(_NAMES) & set(rows[0]):
        raise InputError(
            f"The file {str(path)!r} holds no ports.",
            f"It is a CSV file with one of the columns {', '.join(_NAMES)}, and maybe lat and lon.",
            "Add a first line with these names.",
        )
    found = []
    for number, row in enumerate(rows, start=2):
        more = row.pop(_MORE, None)
        if more:
            raise InputError(
                f"Line {number} of the ports has more fields than the first line: {more[0]!r}.",
                "Put a name that contains a comma in quotation marks.",
                f'Write "{next(iter(row.values()))},{more[0]}", if that is one name.',
            )
        found.append(_place_of_row({k: str(v or "").strip() for k, v in row.items()}, number))
    return found


def _place_of_row(row: Mapping[str, str], number: int) -> tuple[str, Place]:
    name = next((row[key] for key in _NAMES if row.get(key)), "")
    if not name:
        raise InputError(
            f"Line {number} of the ports names no port.",
            "Every line has a name or UN/LOCODE.",
            "Add it, or remove the line.",
        )
    if not (row.get("lat") and row.get("lon")):
        return name, name
    try:
        return name, check_position(float(row["lat"]), float(row["lon"]), name)
    except ValueError as error:
        if isinstance(error, InputError):
            raise
        raise InputError(
            f"The position of {name} is {row['lat']!r}, {row['lon']!r}.",
            "Latitude and longitude are numbers [deg].",
            "Correct the file.",
        ) from error


def _checked_names(names: Sequence[str]) -> tuple[str, ...]:
    twice = sorted({name for name in names if list(names).count(name) > 1})
    if twice or not 2 <= len(names) <= MOST_PORTS:
        given = f"{', '.join(twice)} twice" if twice else f"{len(names)} ports"
        raise InputError(
            f"The table of distances is of {given}.",
            f"It has from 2 to {MOST_PORTS:,} different ports.",
            "Correct the list of ports.",
        )
    return tuple(names)
