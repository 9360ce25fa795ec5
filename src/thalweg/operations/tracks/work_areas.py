"""Work areas: polygons in which a ship loads, unloads or waits."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thalweg.chart.geojson_polygons import parse_polygons, read_features
from thalweg.core.errors import InputError, unknown_name_error
from thalweg.core.geodesy import wrap_longitude

LOADING, UNLOADING, WAITING = "loading", "unloading", "waiting"
AREA_KINDS: Final = (LOADING, UNLOADING, WAITING)
#: words in the property ``activity``, ``kind``, ``type`` or ``name`` that state the activity
AREA_KIND_BY_WORD: Final[dict[str, str]] = {
    **dict.fromkeys(("loading", "load", "dredging", "dredge", "borrow", "trailing"), LOADING),
    **dict.fromkeys(
        ("unloading", "unload", "discharging", "dumping", "dump", "pumping", "reclamation"),
        UNLOADING,
    ),
    **dict.fromkeys(("reclaim", "nourishment", "rainbowing", "disposal"), UNLOADING),
    **dict.fromkeys(
        ("waiting", "wait", "anchorage", "anchor", "berth", "port", "harbour"), WAITING
    ),
}
_PROPERTY_NAMES: Final = ("activity", "kind", "type", "name")
_MIN_OVERLAP: Final = 1e-9  # share of the smaller area from which two areas overlap


@dataclass(frozen=True, eq=False)
class WorkAreas:
    """Polygons by activity.

    Attributes
    ----------
    shapes : dict of str to shapely geometry
        One for each of "loading", "unloading" and "waiting" that exists, longitude first [deg].
    """

    shapes: dict[str, Any]

    @classmethod
    def read(cls, source: str | PathLike[str] | Mapping[str, Any]) -> WorkAreas:
        """Read areas from GeoJSON.

        Parameters
        ----------
        source : path or mapping
            Polygons with a property ``activity`` (or ``kind``, ``type``, ``name``) that holds a
            word such as loading, dredging, unloading, pumping, waiting or anchorage.

        Returns
        -------
        WorkAreas
            The areas of each activity, united.

        Raises
        ------
        InputError
            If the file cannot be read, an area has no activity, areas of different activities
            overlap, or there is no area for loading or none for unloading.
        """
        import shapely

        shapes: dict[str, list[Any]] = {}
        names: list[tuple[str, str, Any]] = []
        for number, (geometry, properties) in enumerate(read_features(source, "areas"), start=1):
            kind = _kind(properties, number)
            label = str(properties.get("name") or f"area {number} ({kind})")
            shape = shapely.union_all(parse_polygons(geometry, "areas"))
            shapes.setdefault(kind, []).append(shape)
            names.append((label, kind, shape))
        missing = [kind for kind in (LOADING, UNLOADING) if kind not in shapes]
        if missing:
            raise InputError(
                f"There is no area for {' and none for '.join(missing)}.",
                f"Activities of the areas: {', '.join(sorted(shapes)) or 'none'}.",
                "Add polygons with the properties activity: loading and activity: unloading.",
            )
        _check_disjoint(names)
        return cls({kind: shapely.union_all(parts) for kind, parts in shapes.items()})

    def at(self, lat: ArrayLike, lon: ArrayLike) -> NDArray[np.int8]:
        """Return the area in which each position lies.

        Parameters
        ----------
        lat, lon : array_like (N,)
            Positions [deg].

        Returns
        -------
        int8 array (N,)
            Index into ``AREA_KINDS``, -1 outside all areas.
        """
        import shapely

        y, x = np.asarray(lat, dtype=np.float64), wrap_longitude(lon)
        where = np.full(y.shape, -1, dtype=np.int8)
        for kind, shape in self.shapes.items():
            shapely.prepare(shape)
            for turn in (-360.0, 0.0, 360.0):  # outlines may cross the antimeridian
                inside = shapely.intersects_xy(shape, x + turn, y)
                where[inside] = AREA_KINDS.index(kind)
        return where


def _kind(properties: Mapping[str, Any], number: int) -> str:
    for key in _PROPERTY_NAMES:
        text = str(properties.get(key) or "").lower()
        words = [w for w in re.split(r"[^a-z]+", text) if w in AREA_KIND_BY_WORD]
        if words:
            return AREA_KIND_BY_WORD[words[0]]
        if text and key == "activity":
            raise unknown_name_error("activity of an area", text, AREA_KIND_BY_WORD)
    raise InputError(
        f"Area {number} has no activity.",
        f"The property {', '.join(_PROPERTY_NAMES[:-1])} or {_PROPERTY_NAMES[-1]} holds "
        f"one of {', '.join(AREA_KINDS)}.",
        'Add "activity": "loading" (or "unloading", "waiting") to its properties.',
        area=number,
    )


def _check_disjoint(names: list[tuple[str, str, Any]]) -> None:
    for i, (first, kind, shape) in enumerate(names):
        for second, other, its in names[i + 1 :]:
            if kind == other:
                continue
            common = shape.intersection(its).area
            if common > _MIN_OVERLAP * min(shape.area, its.area):
                share = 100.0 * common / min(shape.area, its.area)
                raise InputError(
                    f"The areas {first!r} ({kind}) and {second!r} ({other}) overlap "
                    f"({share:.0f} % of the smaller).",
                    "A position must belong to one activity.",
                    "Draw areas that do not overlap.",
                    areas=[first, second],
                )
