"""Ship, sea and chart that a project file names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib import resources
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from thalweg.core.errors import InputError
from thalweg.operations.dredging.project import Project

if TYPE_CHECKING:
    from thalweg.chart import Chart
    from thalweg.sea import Sea
    from thalweg.ship import Ship

ESTUARY = "synthetic-estuary"  #: a synthetic sea and chart, named instead of files
EXAMPLE = "example"  #: the name of the example project
COASTLINE_RESOLUTIONS = ("c", "l", "i", "h", "f", "none")


def example_file() -> Path:
    """Return the example project file of the package: a nourishment behind a drying bank.

    Returns
    -------
    Path
        A YAML file, read-only.
    """
    return Path(str(resources.files("thalweg.operations").joinpath("estuary_project.yaml")))


def open_project(path: str | Path) -> Project:
    """Return the project of a file.

    Parameters
    ----------
    path : path-like
        The file; ``example`` is the project of the package.

    Returns
    -------
    Project
        The project.

    Raises
    ------
    InputError
        If the file is missing or has invalid entries.
    """
    return Project.load(example_file() if str(path) == EXAMPLE else path)


def open_project_inputs(project: Project) -> tuple[Ship, Sea, Chart]:
    """Return the ship, sea and chart that a project file names.

    Parameters
    ----------
    project : Project
        Its ``ship`` and ``data_sources`` name them.

    Returns
    -------
    ship : Ship
        The ship.
    sea : Sea
        Currents, water level and depth.
    chart : Chart
        Land, zones and depth.

    Raises
    ------
    InputError
        If no sea is named, or an entry is not understood.
    """
    from thalweg.ship import Ship

    ship = (
        Ship.from_dict(project.ship, source="ship of the project")
        if isinstance(project.ship, Mapping)
        else Ship.load(project.ship)
    )
    if project.data_sources.get("sea") != ESTUARY:
        return ship, _sea(project.data_sources), _chart(project.data_sources, None)
    from thalweg.operations.examples.estuary import synthetic_estuary

    why = "The estuary has its own tides and coast, and no files."
    _check_unused(project.data_sources, ("map", "fill", "tides", "coast"), ESTUARY, why)
    estuary = synthetic_estuary()
    return ship, estuary.sea, _chart(project.data_sources, estuary.chart)


def _sea(sources: Mapping[str, Any]) -> Sea:
    from thalweg.sea import Sea

    files, mapping, tides = _as_list(sources.get("sea")), sources.get("map"), sources.get("tides")
    if not files or not all(files):
        raise InputError(
            "The project names no sea.",
            f"sea: is a file, a list of files, calm, or {ESTUARY}.",
            "Add it: Thalweg never assumes weather and tides.",
            field="sea",
        )
    _check_names("sea", files, f"It is a file, a list of files, calm, or {ESTUARY}.")
    if files == ["calm"]:
        _check_unused(
            sources, ("map", "fill", "tides"), "calm sea", "It has no tides and no files."
        )
        return Sea.calm()
    if not (mapping is None or isinstance(mapping, Mapping)):
        raise InputError(
            f"map is {mapping!r}.",
            "It names the variable of each quantity, such as map: {crs: 'EPSG:32611'}.",
            "Give the value in this form.",
            field="map",
        )
    named = [] if isinstance(tides, bool) else _as_list(tides)
    _check_names("tides", named, "It is true, or a list of constituents such as [M2, S2].")
    fill = sources.get("fill") or {}
    if not isinstance(fill, Mapping):
        raise InputError(
            f"fill is {fill!r}.",
            "It gives a value for unknown ones of each quantity.",
            "Write it as fill: {currents: 'nearest:25'}.",
            field="fill",
        )
    sea = Sea.open(*files, mapping=mapping)
    if tides:
        sea = Sea.from_tides(sea, constituents=None if tides is True else named)
    return sea.filled(**{str(name): value for name, value in fill.items()}) if fill else sea


def _check_names(what: str, given: list[Any], possible: str) -> None:
    if not all(isinstance(name, (str, PathLike)) for name in given):
        raise InputError(
            f"{what} is {given!r}.", possible, "Give the value in this form.", field=what
        )


def _check_unused(sources: Mapping[str, Any], entries: Sequence[str], sea: str, why: str) -> None:
    """Raise `InputError` for entries that have no effect on a sea."""
    for what in entries:
        if sources.get(what) not in (None, False, "none"):
            raise InputError(
                f"{what} is given for the {sea}.",
                why,
                f"Omit {what}, or name your own sea.",
                field=what,
            )


def _chart(sources: Mapping[str, Any], chart: Chart | None) -> Chart:
    from thalweg.chart import Chart

    coast = sources.get("coast", "i")
    coast = "none" if coast is None or coast is False else str(coast)
    if coast not in COASTLINE_RESOLUTIONS:
        raise InputError(
            f"coast is {coast!r}.",
            f"It is one of {', '.join(COASTLINE_RESOLUTIONS)}.",
            "Choose one.",
            field="coast",
        )
    if chart is None:
        whole = (-90.0, 90.0, -180.0, 180.0)
        chart = Chart.open_water(*whole) if coast == "none" else Chart.gshhg(coast)
    for path in _as_list(sources.get("depth")):
        chart = chart.with_depth(path)
    for path in _as_list(sources.get("zones")):
        chart = chart.with_zones(path)
    return chart


def _as_list(value: Any) -> list[Any]:
    if value is None:
        return []
    return list(value) if isinstance(value, (list, tuple)) else [value]
