"""Packages import their modules when a name is first used, and small commands load little."""

from __future__ import annotations

import ast
import json
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from types import ModuleType

import pytest

import thalweg

ROOT = Path(thalweg.__file__).parent
PACKAGES = sorted(
    ".".join(("thalweg", *stub.parent.relative_to(ROOT).parts)) for stub in ROOT.rglob("*.pyi")
)


@pytest.mark.parametrize("package", PACKAGES)
def test_every_exported_name_is_found_and_is_no_module(package):
    module = import_module(package)
    for name in module.__all__:
        assert not isinstance(getattr(module, name), ModuleType), name


@pytest.mark.parametrize("package", PACKAGES)
def test_a_stub_lists_what_it_imports(package):
    path = Path(import_module(package).__file__).with_suffix(".pyi")
    (listed,) = (
        ast.literal_eval(node.value)
        for node in ast.parse(path.read_text("utf-8")).body
        if isinstance(node, ast.Assign)
    )
    assert listed == import_module(package).__all__


def test_the_function_stays_when_a_module_of_its_name_is_imported_later():
    import thalweg.search.earliest_arrival as found

    assert callable(import_module("thalweg.search").earliest_arrival)
    assert callable(found)


def test_distances_and_refusals_load_no_heavy_libraries():
    heavy = ("matplotlib", "pandas", "pydantic", "scipy.ndimage", "scipy.spatial", "xarray")
    code = (
        "import json, sys, thalweg.cli.main, thalweg.planning.sea_distance;"
        f"print(json.dumps([name for name in {heavy!r} if name in sys.modules]))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True, text=True)
    assert json.loads(done.stdout) == []
