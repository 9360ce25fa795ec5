"""The request for a layered network: its shape in every section, or the choice of one."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from thalweg.core import geodesy
from thalweg.core.errors import InputError, NoPathError, unknown_name_error
from thalweg.core.geodesy import Position, format_position
from thalweg.core.given_numbers import is_number
from thalweg.core.types import FloatArray
from thalweg.core.units import NAUTICAL_MILE
from thalweg.network.layered.layered_builder import layered_network
from thalweg.network.layered.section_shape import PerSection, SectionShape, section_shapes
from thalweg.network.network import Network
from thalweg.network.shortest_paths import shortest_path

if TYPE_CHECKING:
    from thalweg.chart import Chart

#: Layers that are tried where no shape is given: each time twice as close as before.
_LADDER = (5, 11, 23, 47, 95)
_LADDER_FAN = 7
#: Half widths of the rhombus that are tried, as shares of the length of the section: courses then
#: differ by up to 39 and 17 degrees from that of the section.
_HALF_WIDTHS = (0.4, 0.15)
_ALONG_THE_WAY = 1.05  # times the distance between the ends by a passage that lies between them
_STRAIT_DISTANCE = 0.5 * NAUTICAL_MILE  #: of a node from a place that paths must pass
_SHAPE = ("layers", "fan", "offset_nm")
_KEYS = (*_SHAPE, "near_coast_nm", "contain", "within_percent")
_LARGEST_PERCENT, _LARGEST_COAST_NM = 100.0, 100.0


@dataclass(frozen=True)
class LayeredRequest:
    """The shape of a layered network, as a user states it.

    Parameters
    ----------
    layers : int or sequence of int, optional
        S, layers between two waypoints; one value for all sections, or one for each.
    fan : int or sequence of int, optional
        H, segments that leave a node; odd numbers have one straight ahead.
    offset_nm : float or sequence of float, optional
        d, by how much a layer is wider than the one before, to either side [nm]. Without these
        three the shape is chosen (`suggested_shape`).
    near_coast_nm : float, optional
        Within this distance of land layers and nodes are twice as close [nm].
    contain : sequence of (lat, lon)
        Places [deg], such as straits, that paths must be able to pass, where the shape is chosen.
    within_percent : float
        By how much the shortest path may be longer than on the finest network tried, where the
        shape is chosen.
    """

    layers: PerSection | None = None
    fan: PerSection | None = None
    offset_nm: PerSection | None = None
    near_coast_nm: float | None = None
    contain: tuple[Position, ...] = ()
    within_percent: float = 1.0

    def __post_init__(self) -> None:
        for name in _SHAPE:
            value = getattr(self, name)
            if isinstance(value, np.ndarray):
                value = value.tolist()
            object.__setattr__(self, name, tuple(value) if isinstance(value, list) else value)
        object.__setattr__(self, "contain", _places(self.contain))
        _check_range("near_coast_nm", self.near_coast_nm, _LARGEST_COAST_NM)
        _check_range("within_percent", self.within_percent, _LARGEST_PERCENT)
        self.shapes(self._given_sections())

    @classmethod
    def from_dict(cls, data: Any) -> LayeredRequest:
        """Read the request from plain data with the entries layers, fan and offset_nm.

        Parameters
        ----------
        data : mapping
            Every entry is a number, or a list with one number for each section.

        Returns
        -------
        LayeredRequest

        Raises
        ------
        InputError
            For unknown or missing entries, and values that are not possible.
        """
        if isinstance(data, LayeredRequest):
            return data
        if not isinstance(data, Mapping):
            raise InputError(
                f"The layered network is {data!r}.",
                f"It is a mapping with {', '.join(_KEYS)}.",
                "Give these three, for example {layers: 25, fan: 5, offset_nm: 2.4}.",
                field="layered",
            )
        for key in data:
            if key not in _KEYS:
                raise unknown_name_error(
                    "entry of a layered network", str(key), _KEYS, field="layered"
                )
        given = [key for key in _SHAPE if data.get(key) is not None]
        missing = [key for key in _SHAPE if key not in given]
        if given and (missing or data.get("contain")):
            missing = missing or ["free shape, which contain needs"]
            raise InputError(
                f"The layered network has no {' and no '.join(missing)}.",
                "It has layers, fan and offset_nm, each a number or one number for each section.",
                "Add what is missing, or leave out all three to have them chosen.",
                field="layered",
            )
        return cls(**{key: data[key] for key in _KEYS if data.get(key) is not None})

    def as_dict(self) -> dict[str, Any]:
        """Return the request as plain data for files.

        Returns
        -------
        dict
            As `from_dict` reads it.
        """
        values = {key: getattr(self, key) for key in _SHAPE if getattr(self, key) is not None}
        found = {key: list(v) if isinstance(v, tuple) else v for key, v in values.items()}
        if self.near_coast_nm is not None:
            found["near_coast_nm"] = self.near_coast_nm
        if self.layers is None:
            found["contain"] = [list(place) for place in self.contain]
            found["within_percent"] = self.within_percent
        return found

    def shapes(self, sections: int) -> tuple[SectionShape | None, ...]:
        """Return the shape of every section; None where it is to be chosen.

        Parameters
        ----------
        sections : int
            How many there are.

        Returns
        -------
        tuple of SectionShape or None

        Raises
        ------
        InputError
            If a list has another length.
        """
        if self.layers is None or self.fan is None or self.offset_nm is None:
            return (None,) * sections
        offset = self.offset_nm
        metres = (
            [_metres(d) for d in offset] if isinstance(offset, (list, tuple)) else _metres(offset)
        )
        return section_shapes(sections, self.layers, self.fan, metres)

    def of_section(self, places: Sequence[Position], number: int) -> LayeredRequest:
        """Return the request for one section: with the straits that are nearest to it.

        Parameters
        ----------
        places : sequence of (lat, lon)
            Start, waypoints and goal [deg].
        number : int
            Number of the section, from 0.

        Returns
        -------
        LayeredRequest
        """
        if not self.contain or len(places) < 3:
            return self
        straits = np.array(self.contain)
        away = [distances_from_line(straits, *pair) for pair in itertools.pairwise(places)]
        own = np.argmin(away, axis=0) == number
        return replace(self, contain=tuple(itertools.compress(self.contain, own)))

    def _given_sections(self) -> int:
        lengths = [len(v) for key in _SHAPE if isinstance(v := getattr(self, key), tuple)]
        return max(lengths, default=1)


def distances_from_line(places: FloatArray, a: Position, b: Position) -> FloatArray:
    """Return the distances of places from a geodesic [m], to a hundredth of its length.

    Parameters
    ----------
    places : Positions [deg], (N, 2).
    a, b : Ends of the geodesic [deg].
    """
    lat, lon = geodesy.positions_along(*a, *b, np.linspace(0.0, 1.0, 101))
    away = geodesy.distance(places[:, :1], places[:, 1:], lat, lon)
    return np.asarray(away.min(axis=1))


def _metres(offset_nm: Any) -> Any:
    """Return an offset in metres; what is no number is left for `section_shapes` to refuse."""
    return offset_nm * NAUTICAL_MILE if is_number(offset_nm) else offset_nm


def _places(given: Any) -> tuple[Position, ...]:
    try:
        return tuple((float(lat), float(lon)) for lat, lon in given)
    except (TypeError, ValueError):
        raise InputError(
            f"contain of a layered network is {given!r}.",
            "It is a list of places, each latitude and longitude in degrees.",
            "Correct it, for example [[64.862, 11.253]].",
            field="layered",
        ) from None


def _check_range(name: str, value: Any, largest: float) -> None:
    if value is not None and not (is_number(value) and 0.0 < value <= largest):
        raise InputError(
            f"{name} of a layered network is {value!r}.",
            f"It is a number above 0, up to {largest:g}.",
            "Correct it.",
            field="layered",
        )


def suggested_shape(
    chart: Chart,
    start: Position,
    goal: Position,
    *,
    tolerance: float = 0.01,
    contain: Sequence[Position] = (),
    numbering: tuple[int, int] = (0, 1),
) -> SectionShape:
    """Return the shape with the fewest segments that is nearly as good as the finest.

    Layers are made twice as close until 96 intervals, at two widths of the network.

    Parameters
    ----------
    chart : Chart
        Land, zones and depth.
    start, goal : (lat, lon)
        Positions [deg].
    tolerance : float, optional
        By what share the shortest path may be longer than that on the finest network.
    contain : sequence of (lat, lon), optional
        Places [deg], such as straits, that paths of the network must pass within half a nautical
        mile.
    numbering : tuple of int, optional
        Number of the section in the voyage, from 0, and how many it has.

    Returns
    -------
    SectionShape

    Raises
    ------
    NoPathError
        If none of them has a path, or none passes all these places.
    """
    length = float(geodesy.distance(*start, *goal))
    fitting: list[tuple[SectionShape, float]] = []
    refusal: NoPathError | None = None
    for layers, half_width in itertools.product(_LADDER, _HALF_WIDTHS):
        offset = max(2.0 * half_width * length / (layers + 1), 1.0)
        try:
            network = layered_network(
                chart, (start, goal), layers=layers, fan=_LADDER_FAN, offset=offset,
                numbering=numbering,
            )  # fmt: skip
        except NoPathError as error:
            refusal = refusal or error
            continue
        left_out = [place for place in contain if not _passes(network, place)]
        if left_out:
            refusal = _strait_error(chart, left_out[0], layers)
            continue
        distance, _ = shortest_path(network, network.meta.start, network.meta.goal)
        shape = SectionShape(layers, _LADDER_FAN, offset)
        fitting.append((shape, float(distance[network.meta.goal])))
    if not fitting:
        assert refusal is not None  # one of the two happened
        raise refusal
    best = (1.0 + tolerance) * min(value for _, value in fitting)
    return next(shape for shape, value in fitting if value <= best)


def _passes(network: Network, place: Position) -> bool:
    """Return whether paths of a network pass a place: all of its nodes are on paths."""
    away = geodesy.distance(network.lat, network.lon, *place)
    return bool(np.min(away) <= _STRAIT_DISTANCE)


def missed_straits_note(
    chart: Chart, network: Network, ends: tuple[Position, Position]
) -> tuple[str, ...]:
    """Return a note on named passages along the way that no path of a network passes, or none.

    Parameters
    ----------
    chart : With the passages that are open.
    network : The layered network.
    ends : Start and goal [deg].
    """
    start, goal = ends
    most = _ALONG_THE_WAY * float(geodesy.distance(*start, *goal))
    missed = []
    for passage in chart.passages:
        middle = passage.line[len(passage.line) // 2]
        by = float(geodesy.distance(*start, *middle) + geodesy.distance(*middle, *goal))
        if by <= most and not _passes(network, middle):
            missed.append(passage.name)
    if not missed:
        return ()
    return (
        f"No path of the layered network passes {', '.join(missed)}: name places in them that it "
        "must contain, or compare the plan with one on the network that is used by default.",
    )


def narrow_strait_note(chart: Chart, place: Position) -> str:
    """Return a sentence on a strait that is narrower than what the coastline shows; else empty.

    Parameters
    ----------
    chart : With its coastline.
    place : Position in the strait [deg].
    """
    detail = chart.coastline.detail
    width = 2.0 * float(chart.coastline.shore_distance(*place, cap=2.0 * detail))
    if width >= 2.0 * detail:  # each shore may be off by as much
        return ""
    where = "there is land" if width == 0.0 else f"the water is about {width:.0f} m wide"
    return (
        f"At {format_position(*place)} {where} on this coastline, which leaves out what is smaller "
        f"than about {detail:.0f} m: check the strait on a chart, or use a finer coastline (h, f)."
    )


def _strait_error(chart: Chart, place: Position, layers: int) -> NoPathError:
    narrow = narrow_strait_note(chart, place)
    return NoPathError(
        f"No layered network of up to {layers} layers has a path through "
        f"{format_position(*place)}.",
        narrow or "Straits are contained where a node on a path is within half a nautical mile.",
        "Put waypoints in open water before and behind it, or use a finer coastline (h, f).",
        nearest=place,
    )
