"""One name for one thing, no import circles, small packages: held for the whole source tree."""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path

import networkx as nx

import thalweg

ROOT = Path(thalweg.__file__).parent
MAX_MODULES = 20  # in one folder, without __init__
#: Functions that every module of a kind has under one name.
SHARED_FUNCTIONS = {
    "add_command",  # each command of the command line
    "run",
    "main",  # entry points
    "frequency",  # the two sets of tidal arguments, foreman and schureman
    "equilibrium_arguments",
    "nodal_corrections",
}
MAX_LINES = 400  # of a module
MAX_ARGUMENTS = 8  # of a function, without self and cls
#: Functions with more arguments, by module below thalweg, and why they keep them.
MANY_ARGUMENTS = {
    "network.regional_lattice.lattice_builder.lattice": "public entry point with keyword options",
    "network.triangular_mesh.mesh_builder.mesh": "public entry point with keyword options",
    "planning.sea_distance.sea_distance": "public entry point with keyword options",
    "route.referee.evaluation.evaluate": "public entry point with keyword options",
    "ship.methods.added_resistance.stawave.stawave2": "parameters of a published formula",
    "ship.methods.added_resistance.stawave.stawave2_transfer": "parameters of a published formula",
    "ship.methods.propulsion.propulsion_factors.propulsion": "parameters of a published formula",
    "ship.methods.resistance.holtrop_mennen.holtrop": "parameters of a published formula",
    "ship.methods.seakeeping.ship_motions.ship_response": "parameters of a published formula",
    "ship.methods.speed_loss.kwon_speed_loss": "parameters of a published formula",
    "ship.ship.Ship.simple": "public entry point with keyword options",
}


def modules() -> dict[str, Path]:
    """Return the file of every module by its dotted name, packages without their __init__."""
    found = {}
    for path in sorted(ROOT.rglob("*.py")):
        if path.name != "__init__.py":
            parts = path.relative_to(ROOT).with_suffix("").parts
            found[".".join(("thalweg", *parts))] = path
    return found


MODULES = modules()


@cache
def trees() -> dict[str, ast.Module]:
    """Return the parsed text of every module."""
    return {name: ast.parse(path.read_text("utf-8")) for name, path in MODULES.items()}


def repeated(places: Mapping[str, Iterable[str]]) -> dict[str, list[str]]:
    """Return the names that occur in more than one place."""
    return {name: sorted(found) for name, found in places.items() if len(set(found)) > 1}


def top_level(kind: type[ast.stmt]) -> dict[str, list[str]]:
    """Return the modules of each public class or function defined at the top of a module."""
    places = defaultdict(list)
    for module, tree in trees().items():
        for node in tree.body:
            if isinstance(node, kind) and not node.name.startswith("_"):
                places[node.name].append(module)
    return places


def test_every_module_has_a_name_of_its_own():
    places = defaultdict(list)
    for module in MODULES:
        places[module.rpartition(".")[2]].append(module)
    places.pop("__main__", None)
    assert repeated(places) == {}


def test_every_class_has_a_name_of_its_own():
    assert repeated(top_level(ast.ClassDef)) == {}


def test_every_public_function_has_a_name_of_its_own():
    found = repeated(top_level(ast.FunctionDef))
    assert {name: found[name] for name in found if name not in SHARED_FUNCTIONS} == {}


def test_no_folder_has_too_many_modules():
    counts = defaultdict(int)
    for path in MODULES.values():
        counts[path.parent.relative_to(ROOT).as_posix()] += 1
    assert {folder: n for folder, n in counts.items() if n > MAX_MODULES} == {}


def test_no_module_is_too_long():
    counts = {name: path.read_text("utf-8").count("\n") for name, path in MODULES.items()}
    assert {name: n for name, n in counts.items() if n > MAX_LINES} == {}


def functions(tree: ast.AST, prefix: str) -> Iterable[tuple[str, ast.FunctionDef]]:
    """Return every function with its dotted name: in classes and in functions too."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            name = f"{prefix}.{node.name}"
            if isinstance(node, ast.FunctionDef):
                yield name, node
            yield from functions(node, name)
        else:
            yield from functions(node, prefix)


def argument_count(function: ast.FunctionDef) -> int:
    names = [arg.arg for arg in (*function.args.posonlyargs, *function.args.args)]
    bound = names[:1] in (["self"], ["cls"])
    return len(names) + len(function.args.kwonlyargs) - bound


def test_functions_have_few_arguments():
    """A function that needs more takes them as a dataclass or, in kernels, as a named tuple."""
    many = sorted(
        name.removeprefix("thalweg.")
        for module, tree in trees().items()
        for name, function in functions(tree, module)
        if argument_count(function) > MAX_ARGUMENTS
    )
    assert many == list(MANY_ARGUMENTS)


def imported(tree: ast.AST) -> set[str]:
    """Return the modules that a module imports anywhere: in functions and for types too."""
    found = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module:
            for alias in node.names:
                full = f"{node.module}.{alias.name}"
                found.add(full if full in MODULES else node.module)
        elif isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
    return found & set(MODULES)


def test_no_modules_import_each_other_in_a_circle():
    graph = nx.DiGraph((m, other) for m, tree in trees().items() for other in imported(tree) - {m})
    circles = [sorted(part) for part in nx.strongly_connected_components(graph) if len(part) > 1]
    assert circles == []


def test_numba_is_imported_in_kernels_alone():
    users = set()
    for module, tree in trees().items():
        for node in ast.walk(tree):
            names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom):
                names = [node.module or ""]
            if any(name.split(".")[0] == "numba" for name in names):
                users.add(module)
    assert {module for module in users if not module.startswith("thalweg.kernels.")} == set()
