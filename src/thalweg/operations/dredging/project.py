"""`Project`: the definition of a dredging project, read from and written to YAML."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from thalweg.core.errors import InputError, refuse_other_file, unknown_name_error
from thalweg.core.file_reading import read_text_file
from thalweg.core.file_writing import write_text
from thalweg.core.geodesy import Position, distance
from thalweg.core.given_numbers import is_number
from thalweg.core.time import format_time
from thalweg.core.units import DAY
from thalweg.operations.dredging.loading_curves import LoadingCurve
from thalweg.operations.dredging.project_parts import BaseCase, SiteNetworkOptions, Sites, WorkScope
from thalweg.operations.dredging.project_validation import (
    parse_days,
    parse_load_factors,
    parse_place,
    parse_start,
    positive_number,
)

LARGEST_FILE = 1_000_000  #: bytes
BEST_LOAD_FACTOR = "best"
_SITE_TOLERANCE = 250.0  # largest distance of the ends of the base case's route to the sites [m]


@dataclass(frozen=True)
class Project:
    """A dredging project: load, sail full, unload, sail empty, until a volume is moved.

    Attributes
    ----------
    name : str
    sites : Sites
    work : WorkScope
    start, days : float
        Start [s since 1970-01-01T00:00Z] and longest duration [days].
    ship : str or mapping
        A ship of the library, a ship file, or the content of a ship file.
    data_sources : mapping
        Sources of the sea and the chart: ``sea`` (files, or "synthetic-estuary"), ``tides``
        (predict from the tides in the files), ``map``, ``fill`` (see `thalweg.sea.Sea.filled`),
        ``depth``, ``zones``, ``coast``.
    base : BaseCase or None
        The case to compare with.
    """

    name: str
    sites: Sites
    work: WorkScope
    start: float
    days: float
    ship: str | Mapping[str, Any] = "hopper-dredger"
    data_sources: Mapping[str, Any] = field(default_factory=dict)
    base: BaseCase | None = None

    @property
    def end(self) -> float:
        """End of the period [s since 1970-01-01T00:00Z]."""
        return self.start + self.days * DAY

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Project:
        """Return a project from plain data, as a project file holds it.

        Parameters
        ----------
        data : mapping
            Entries of a project file, with units in their names.

        Returns
        -------
        Project
            The project.

        Raises
        ------
        InputError
            For unknown or missing entries, volumes and rates that are not positive, and invalid
            places, times and load factors.
        """
        _check_keys(data)
        volume, hopper = positive_number(data, "volume_m3"), positive_number(data, "hopper_m3")
        work = WorkScope(
            volume=volume,
            hopper=hopper,
            loading=LoadingCurve.from_data(data["loading"], hopper, "loading"),
            unloading=LoadingCurve.from_data(data["unloading"], hopper, "unloading"),
            load_factors=parse_load_factors(data.get("load_factors", 11)),
        )
        sites = _sites(data)
        return cls(
            name=str(data.get("name", "dredging project")),
            sites=sites,
            work=work,
            start=parse_start(data["start"]),
            days=parse_days(data),
            ship=data.get("ship", "hopper-dredger"),
            data_sources={key: _plain_value(data[key]) for key in _SOURCE_KEYS if key in data},
            base=_base_case(data.get("base_case"), sites),
        )

    def to_dict(self) -> dict[str, Any]:
        """Return the project as plain data that `from_dict` reads.

        Returns
        -------
        dict
            Entries of a project file.
        """
        sites, work = self.sites, self.work
        data: dict[str, Any] = {
            "name": self.name,
            "ship": dict(self.ship) if isinstance(self.ship, Mapping) else self.ship,
            **self.data_sources,
            "load": list(sites.load),
            "unload": list(sites.unload),
            "min_ukc_m": sites.min_ukc,
            "margin_m": sites.network.margin,
            "rings": sites.network.rings,
            "detour": sites.network.detour,
            "volume_m3": work.volume,
            "hopper_m3": work.hopper,
            "loading": work.loading.to_data(),
            "unloading": work.unloading.to_data(),
            "load_factors": list(work.load_factors),
            "start": format_time(self.start),
            "days": self.days,
        }
        if sites.network.spacing is not None:
            data["spacing_m"] = sites.network.spacing
        if self.base is not None:
            route = [list(place) for place in self.base.route]
            data["base_case"] = {"route": route, "load_factor": self.base.load_factor}
        return data

    @classmethod
    def load(cls, path: str | Path) -> Project:
        """Read a project from a YAML or JSON file; paths in it may be relative to its folder.

        Parameters
        ----------
        path : path-like
            The file.

        Returns
        -------
        Project
            With the paths in it relative to the working directory.

        Raises
        ------
        InputError
            If the file is missing, too large, not YAML/JSON, or has invalid entries.
        """
        from thalweg.core.strict_yaml import parse_yaml

        text = read_text_file(path, "project", LARGEST_FILE)
        path = Path(path)
        data = parse_yaml(text, "project", path.name)
        if not isinstance(data, dict):
            raise InputError(
                f"{path} does not contain a project.",
                f"Entries: {', '.join(_ALLOWED_KEYS)}.",
                "Add them.",
            )
        return cls.from_dict(_with_files_beside(data, path.parent))

    def save(self, path: str | Path) -> None:
        """Write the project to a YAML file.

        Parameters
        ----------
        path : path-like
            File to write; a file of that name is replaced.
        """
        from thalweg.core.strict_yaml import dump_yaml

        text = dump_yaml(self.to_dict(), sort_keys=False)
        write_text(path, text)


_SOURCE_KEYS = ("sea", "tides", "map", "fill", "depth", "zones", "coast")
_REQUIRED_KEYS = ("load", "unload", "volume_m3", "hopper_m3", "loading", "unloading", "start")
_ALLOWED_KEYS = (
    *("name", "ship"),
    *_REQUIRED_KEYS,
    *("days", "min_ukc_m", "margin_m", "load_factors", "spacing_m", "rings", "detour"),
    *_SOURCE_KEYS,
    "base_case",
)


def _check_keys(data: Mapping[str, Any]) -> None:
    refuse_other_file(data, "a dredging project")
    for key in data:
        if key not in _ALLOWED_KEYS:
            raise unknown_name_error("project entry", str(key), _ALLOWED_KEYS)
    missing = [key for key in _REQUIRED_KEYS if key not in data]
    if missing:
        raise InputError(
            f"The project lacks {', '.join(missing)}.",
            f"Needed: {', '.join(_REQUIRED_KEYS)}.",
            "Add it." if len(missing) == 1 else "Add them.",
            missing=missing,
            field=missing[0],
        )


def _sites(data: Mapping[str, Any]) -> Sites:
    load, unload = parse_place(data["load"], "load"), parse_place(data["unload"], "unload")
    if load == unload:
        raise InputError(
            "The loading site and the unloading site are the same place.",
            "A project sails between two places.",
            "Give two places.",
        )
    return Sites(
        load=load,
        unload=unload,
        min_ukc=data.get("min_ukc_m"),
        network=SiteNetworkOptions(
            margin=data.get("margin_m", 0.01),
            spacing=data.get("spacing_m"),
            rings=data.get("rings", 3),
            detour=data.get("detour", 3.0),
        ),
    )


def _base_case(data: Any, sites: Sites) -> BaseCase | None:
    if data is None:
        return None
    if not isinstance(data, Mapping) or not isinstance(data.get("route"), Sequence):
        raise InputError(
            "The base case has no route.",
            "base_case: holds route, a list of [lat, lon].",
            "Add it.",
        )
    for key in data:
        if key not in ("route", "load_factor"):
            raise unknown_name_error("entry of the base case", str(key), ("route", "load_factor"))
    route = tuple(
        parse_place(place, f"base_case.route[{k}]") for k, place in enumerate(data["route"])
    )
    if len(route) < 2:
        raise InputError(
            "The route of the base case has one place.", "It has two or more.", "Add the others."
        )
    factor = data.get("load_factor", 1.0)
    if factor != BEST_LOAD_FACTOR:
        if not is_number(factor) or not 0.0 < factor <= 1.0:
            raise InputError(
                f"base_case.load_factor is {factor!r}.",
                "It is a number above 0 and up to 1, or 'best' for the highest production.",
                "Correct it.",
                field="base_case.load_factor",
            )
        factor = float(factor)
    _check_ends(route, sites)
    return BaseCase(route, factor)


def _check_ends(route: tuple[Position, ...], sites: Sites) -> None:
    for end, site, which in ((route[0], sites.load, "starts"), (route[-1], sites.unload, "ends")):
        separation = float(distance(*end, *site))
        if separation > _SITE_TOLERANCE:
            reversed_site = bool(abs(end[1]) <= 90.0) and (
                float(distance(end[1], end[0], *site)) <= _SITE_TOLERANCE
            )
            advice = f"Make it {which.removesuffix('s')} at {site[0]:g}, {site[1]:g}."
            if reversed_site:
                advice = "Are latitude and longitude swapped? Positions are latitude, longitude."
            raise InputError(
                f"The route of the base case {which} {separation:,.0f} m from the site.",
                "It runs from the loading site to the unloading site.",
                advice,
                field="base_case.route",
            )


def _plain_value(value: Any) -> Any:
    """Return a value with paths as text, as a project file holds it."""
    if isinstance(value, (list, tuple)):
        return [_plain_value(one) for one in value]
    return os.fspath(value) if isinstance(value, os.PathLike) else value


def _with_files_beside(data: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Return the data with file names relative to the project file resolved, if they exist."""

    def found(name: Any) -> Any:
        if isinstance(name, (list, tuple)):
            return [found(one) for one in name]
        from thalweg.sea.tides.station_area import split_area

        near = folder / name if isinstance(name, str) else None
        file = None if near is None else split_area(str(near))[0]
        return str(near) if file is not None and Path(file).exists() else name

    return {k: found(v) if k in ("sea", "depth", "zones", "ship") else v for k, v in data.items()}
