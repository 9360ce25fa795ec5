"""Write the API reference, docs/reference/*.md, from the docstrings, and the index of decisions.

Run ``make docs`` after a change of a public name, signature or docstring. One page is written for
each package, with every name of its ``__all__`` and of those of its sub-packages. `MORE_NAMES` adds
names that the how-to pages import from modules of a package.
"""

from __future__ import annotations

import functools
import inspect
import re
import sys
from collections.abc import Iterable, Iterator
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

FOLDER = Path(__file__).parent / "reference"
DECISIONS = Path(__file__).parent / "decisions"
#: Names described in addition to those that a package exports.
MORE_NAMES: dict[str, tuple[str, ...]] = {
    "sea": (
        "tides.constituents.Constituents",
        "tides.constituent_files.read_constituents",
        "tides.constituent_files.write_constituents",
        "periodic_repeat.repeat_in_time",
        "models.stratified_coast.stratified_coast_current",
    ),
    "chart": (
        "zones.emission_control_areas.emission_control_areas",
        "passages.Passage",
        "passages.find_passages",
        "offing.Offing",
    ),
    "ship": (
        "model_protocol.AdjustableModel",
        "model_protocol.CrabAngleModel",
        "model_protocol.DraughtModel",
        "model_protocol.EstimatingModel",
        "model_protocol.FuelTableModel",
        "model_protocol.JointPowerAndFuelModel",
        "model_protocol.PowerTableModel",
        "model_protocol.SpeedHoldingModel",
        "methods.shallow_water.squat.shallow_water_speed_limit",
        "methods.engine.european_charges.EuropeanCharges",
        "tables.tabulate.tabulate_dense",
    ),
    "network": (
        "layered.sections_round_land.layered_section",
        "layered.layered_request.suggested_shape",
        "history.history_builder.build_history",
        "history.history_builder.HistoryRules",
        "history.history_network.HistoryNetwork",
        "history.history_route.HistoryRoute",
        "history.history_corridor.HistoryCorridor",
        "history.history_file.read_history",
        "history.history_file.write_history",
        "history.junctions.CorridorLine",
    ),
    "planning": (
        "sea_distance.SeaDistance",
        "sea_distance.sea_distance",
        "distance_table.DistanceTable",
        "distance_table.distance_table",
        "distance_table.usual_distance_table",
        "history_plans.UsualAgainstOptimal",
        "history_plans.usual_against_optimal",
        "plots.channel_closures.find_closures",
        "plots.space_time_diagram.draw_space_time_diagram",
    ),
    "operations": (
        "dredging.project_environment.ProjectEnvironment",
        "dredging.project_environment.project_network",
        "dredging.project_environment.freeze_site_network",
        "examples.estuary.synthetic_estuary",
        "openclsim.plugin.PlannedRouteMovable",
        "examples.synthetic_tracks.SyntheticCycle",
        "examples.synthetic_tracks.synthetic_track",
        "fleet.history_from_tracks.read_history_ports",
        "fleet.history_from_tracks.read_corridors",
        "examples.synthetic_fleet.SyntheticFleet",
        "examples.synthetic_fleet.SyntheticRoute",
        "examples.synthetic_fleet.synthetic_fleet",
    ),
    "core": (
        "errors.ThalwegError",
        "errors.InputError",
        "errors.CoverageError",
        "errors.OutsideAreaError",
        "errors.OutsidePeriodError",
        "errors.MissingVariableError",
        "errors.DatasetError",
        "errors.ModelRangeError",
        "errors.NoRouteError",
        "errors.ThalwegWarning",
        "objective.Objective",
        "objective.LegPrices",
        "objective.KeyFigure",
        "limits.Limits",
        "limits.Tightening",
        "geodesy.direct",
    ),
}
PACKAGES = ("sea", "ship", "chart", "network", "route", "search", "evolution", "planning")
PAGES = (*PACKAGES, "operations", "studies", "forecasts", "core")
NOTE = "<!-- Written by docs/generate_reference.py (make docs). Change the docstrings instead. -->"
WIDTH = 92


def public_objects(page: str) -> dict[str, Any]:
    """Return the objects of a page by dotted name below ``thalweg``."""
    package = import_module(f"thalweg.{page}")
    found = exports(page)
    for part in sorted(path.parent.name for path in package_folder(package).glob("*/__init__.py")):
        found |= new_ones(exports(f"{page}.{part}"), found)
    for path in MORE_NAMES.get(page, ()):
        module, _, name = f"thalweg.{page}.{path}".rpartition(".")
        found |= new_ones({f"{page}.{path}": getattr(import_module(module), name)}, found)
    return found


def exports(package: str) -> dict[str, Any]:
    """Return the objects of the ``__all__`` of a package by dotted name below ``thalweg``."""
    module = import_module(f"thalweg.{package}")
    return {f"{package}.{name}": getattr(module, name) for name in getattr(module, "__all__", ())}


def new_ones(objects: dict[str, Any], known: dict[str, Any]) -> dict[str, Any]:
    """Return the objects that are not yet known by another name."""
    ids = {id(value) for value in known.values()}
    return {name: value for name, value in objects.items() if id(value) not in ids}


def package_folder(package: ModuleType) -> Path:
    """Return the folder of a package."""
    return Path(str(package.__file__)).parent


def members(cls: type) -> Iterator[tuple[str, Any]]:
    """Yield the public methods and properties that a class has from this project."""
    seen = set(getattr(cls, "_fields", ()))
    for owner in cls.__mro__:
        if owner.__module__.startswith("thalweg"):
            for name, value in vars(owner).items():
                if not name.startswith("_") and name not in seen and is_described(value):
                    seen.add(name)
                    yield name, value


def is_described(value: Any) -> bool:
    """Whether a value in a class is a method or property."""
    kinds = (property, classmethod, staticmethod, functools.cached_property)
    return inspect.isfunction(value) or isinstance(value, kinds)


def signature(name: str, value: Any) -> str:
    """Return the call of a function or class with its arguments, types and defaults."""
    if isinstance(value, (property, functools.cached_property)):
        function = value.fget if isinstance(value, property) else value.func
        return f"{name}: {annotation(inspect.signature(function).return_annotation)}".rstrip(": ")
    if isinstance(value, (classmethod, staticmethod)):
        function = value.__func__
    else:
        function = value
    try:
        found = inspect.signature(function)
    except (TypeError, ValueError):
        return name
    parameters = list(found.parameters.values())
    if parameters and parameters[0].name in ("self", "cls"):
        parameters = parameters[1:]
    texts = []
    for index, parameter in enumerate(parameters):
        earlier = {p.kind for p in parameters[:index]}
        if parameter.kind is parameter.KEYWORD_ONLY and not earlier & {
            parameter.KEYWORD_ONLY,
            parameter.VAR_POSITIONAL,
        }:
            texts.append("*")
        texts.append(argument(parameter))
    returned = annotation(found.return_annotation)
    arrow = f" -> {returned}" if returned and not inspect.isclass(value) else ""
    line = f"{name}({', '.join(texts)}){arrow}"
    if len(line) <= WIDTH:
        return line
    return f"{name}(\n" + "".join(f"    {text},\n" for text in texts) + f"){arrow}"


def argument(parameter: inspect.Parameter) -> str:
    """Return one argument of a signature."""
    stars = {parameter.VAR_POSITIONAL: "*", parameter.VAR_KEYWORD: "**"}.get(parameter.kind, "")
    text = stars + parameter.name
    kind = annotation(parameter.annotation)
    if kind:
        text += f": {kind}"
    if parameter.default is not parameter.empty:
        equals = " = " if kind else "="
        text += equals + re.sub(r" at 0x[0-9a-f]+", "", default(parameter.default))
    return text


def default(value: Any) -> str:
    """Return the text of a default value, the same on every machine and Python version."""
    if callable(value) and hasattr(value, "__name__"):
        return str(value.__name__)
    if "DEFAULT_FACTORY" in type(value).__name__:
        return "..."
    text = repr(value)
    return f"{type(value).__name__}(...)" if len(text) > 40 or "<" in text else text


def annotation(value: Any) -> str:
    """Return the text of a type annotation."""
    if value is inspect.Parameter.empty:
        return ""
    if isinstance(value, str):
        return value.strip("'\"")
    return value.__name__ if isinstance(value, type) else str(value).replace("typing.", "")


def markdown(docstring: str) -> str:
    """Turn a numpydoc docstring into Markdown."""
    lines = inspect.cleandoc(docstring).splitlines()
    out: list[str] = []
    entries = False  # in a section of named entries
    index = 0
    while index < len(lines):
        line = lines[index]
        following = lines[index + 1] if index + 1 < len(lines) else ""
        if re.fullmatch(r"-{3,}", following) and line.strip():
            out += ["", f"**{line}**", ""]
            entries = line in ("Parameters", "Returns", "Raises", "Attributes", "Yields", "Warns")
            index += 2
        elif line.lstrip().startswith((">>> ", "... ")):
            index = copy_example(lines, index, out)
        elif line.startswith(".. math::"):
            index = copy_equation(lines, index, out)
        elif entries and line and not line.startswith(" "):
            index = copy_entry(lines, index, out)
        else:
            out.append(inline(line))
            index += 1
    return re.sub(r"\n{3,}", "\n\n", "\n".join(out)).strip()


def copy_example(lines: list[str], index: int, out: list[str]) -> int:
    """Copy a doctest up to the next empty line into a block of code."""
    out += ["", "```pycon"]
    while index < len(lines) and lines[index].strip():
        out.append(lines[index].strip())
        index += 1
    out += ["```", ""]
    return index


def copy_equation(lines: list[str], index: int, out: list[str]) -> int:
    """Copy a displayed equation into a block of mathematics."""
    body = [lines[index].removeprefix(".. math::").strip()]
    index += 1
    while index < len(lines) and (not lines[index] or lines[index].startswith(" ")):
        body.append(lines[index].strip())
        index += 1
    out += ["", "```math", *filter(None, body), "```", ""]
    return index


def copy_entry(lines: list[str], index: int, out: list[str]) -> int:
    """Copy one entry of Parameters, Returns, Raises or Attributes into a list."""
    name, colon, kind = lines[index].partition(" : ")
    index += 1
    text = []
    while index < len(lines) and lines[index].startswith(" "):
        text.append(lines[index].strip())
        index += 1
    head = f"`{name}`" + (f" ({inline(kind)})" if colon else "")
    body = inline(" ".join(text))
    out.append(f"* {head}: {body}" if body else f"* {head}")
    return index


def inline(text: str) -> str:
    """Turn inline mathematics, roles and literals of a line into Markdown."""
    text = re.sub(r":math:`([^`]*)`", r"$\1$", text)
    text = re.sub(r":[a-z]+:`([^`]*)`", r"`\1`", text)
    return re.sub(r"``([^`]*)``", r"`\1`", text)


def first_line(value: Any) -> str:
    """Return the first paragraph of a docstring, for tables."""
    if not callable(value) and not inspect.ismodule(value):
        return f"`{value!r}`"
    paragraph = (inspect.getdoc(value) or "").partition("\n\n")[0].replace("\n", " ")
    return inline(paragraph).replace("|", "\\|")


def section(name: str, value: Any) -> str:
    """Return the text on one class or function."""
    short = name.rpartition(".")[2]
    parts = [f"## {short}", f"`thalweg.{name}`"]
    if not callable(value):
        return "\n\n".join([*parts, f"Value: `{value!r}`"])
    parts.append(f"```python\n{signature(short, value)}\n```")
    parts.append(markdown(value.__doc__ or ""))
    if inspect.isclass(value) and not issubclass(value, Exception):
        for member, described in members(value):
            text = f"### {short}.{member}\n\n```python\n{signature(member, described)}\n```\n\n"
            parts.append(text + markdown(described.__doc__ or ""))
    return "\n\n".join(part.strip() for part in parts if part.strip())


def anchors(names: Iterable[str]) -> dict[str, str]:
    """Return the anchor of each name's heading; equal ones but for case are numbered."""
    found: dict[str, str] = {}
    for name in names:
        anchor = name.rpartition(".")[2].lower()
        repeats = sum(
            other.rpartition("-")[0] == anchor or other == anchor for other in found.values()
        )
        found[name] = f"{anchor}-{repeats}" if repeats else anchor
    return found


def page_text(page: str) -> str:
    """Return the page of a package."""
    found = public_objects(page)
    package = import_module(f"thalweg.{page}")
    links = [
        f"| [{name.rpartition('.')[2]}](#{anchor}) | {first_line(found[name])} |"
        for name, anchor in anchors(found).items()
    ]
    head = f"{NOTE}\n\n# thalweg.{page}\n\n{markdown(package.__doc__ or '')}"
    table = "\n".join(["| name | what it is |", "|---|---|", *links])
    return "\n\n".join([head, table, *(section(*item) for item in found.items())]) + "\n"


def index_text() -> str:
    """Return the index: the names of ``thalweg`` and the pages of the packages."""
    import thalweg

    places = {}
    for page in PAGES:
        found = public_objects(page)
        for name, anchor in anchors(found).items():
            places[id(found[name])] = f"{page}.md#{anchor}"
    rows = [
        f"| [`thalweg.{name}`]({places[id(value)]}) | {first_line(value)} |"
        for name, value in ((name, getattr(thalweg, name)) for name in thalweg.__all__)
    ]
    pages = [
        f"| [`thalweg.{page}`]({page}.md) | {first_line(import_module(f'thalweg.{page}'))} |"
        for page in PAGES
    ]
    head = (
        f"{NOTE}\n\n# API reference\n\nEvery public name with its signature, parameters, units and "
        "results, written\nfrom the docstrings by `make docs`."
    )
    names = ["## Names of `thalweg`", "", "| name | what it is |", "|---|---|", *rows]
    packages = ["## Packages", "", "| package | what it holds |", "|---|---|", *pages]
    return "\n".join([head, "", *names, "", *packages, ""])


def pages() -> dict[str, str]:
    """Return the text of every page by file name."""
    return {"README.md": index_text()} | {f"{page}.md": page_text(page) for page in PAGES}


def decisions_text() -> str:
    """Return the index of the decision records: one line for each, by number."""
    records = sorted(path for path in DECISIONS.glob("[0-9]*.md"))
    titles = [path.read_text("utf-8").partition("\n")[0].removeprefix("# ") for path in records]
    rows = [
        f"| {int(path.name[:4])} | [{title.partition('. ')[2]}]({path.name}) |"
        for path, title in zip(records, titles, strict=True)
    ]
    head = (
        f"{NOTE.replace('Change the docstrings', 'Add a record')}\n\n# Decisions\n\n"
        "Each record states the context, the decision and its consequences. Records are not "
        "renumbered;\na decision that replaces another one says so.\n\n"
        "| number | decision |\n|---|---|\n"
    )
    return head + "\n".join(rows) + "\n"


def main() -> int:
    """Write all pages."""
    FOLDER.mkdir(exist_ok=True)
    for name, text in pages().items():
        (FOLDER / name).write_text(text, encoding="utf-8")
    (DECISIONS / "README.md").write_text(decisions_text(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
