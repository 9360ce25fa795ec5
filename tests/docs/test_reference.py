"""The API reference is up to date and complete, and the examples in docstrings run."""

from __future__ import annotations

import doctest
import importlib.util
import inspect
import re
from importlib import import_module
from pathlib import Path

import pytest

import thalweg
from tests.conftest import ROOT

SOURCE = Path(thalweg.__file__).parent
EXAMPLES = sorted(path for path in SOURCE.rglob("*.py") if ">>> " in path.read_text("utf-8"))
SPEC = importlib.util.spec_from_file_location(
    "generate_reference", ROOT / "docs" / "generate_reference.py"
)
reference = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(reference)
PAGES = reference.pages()


@pytest.mark.parametrize("page", PAGES)
def test_page_is_up_to_date(page):
    path = ROOT / "docs" / "reference" / page
    assert path.exists() and path.read_text("utf-8") == PAGES[page], "run `make docs`"


def test_no_page_is_left_over():
    assert {path.name for path in (ROOT / "docs" / "reference").iterdir()} == set(PAGES)


def test_every_decision_is_in_the_index():
    folder = ROOT / "docs" / "decisions"
    index = (folder / "README.md").read_text("utf-8")
    assert index == reference.decisions_text(), "run `make docs`"
    records = [path.name for path in folder.glob("*.md") if path.name != "README.md"]
    assert records and all(f"]({name})" in index for name in records)
    for name in records:
        title = (folder / name).read_text("utf-8").partition("\n")[0]
        assert title.startswith(f"# {int(name[:4])}. "), name


@pytest.mark.parametrize("package", ["", *reference.PAGES])
def test_every_public_name_is_on_a_page(package):
    module = import_module(f"thalweg.{package}".rstrip("."))
    text = PAGES[f"{package}.md" if package else "README.md"]
    for name in getattr(module, "__all__", ()):
        assert f"`{module.__name__}.{name}`" in text, name


def test_every_package_has_a_page():
    packages = {path.parent.name for path in SOURCE.glob("*/__init__.py")}
    assert packages - set(reference.PAGES) == {"cli", "kernels", "service"}, "add it to PAGES"


def test_names_that_pages_import_are_in_the_reference():
    pages = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]
    code = "\n".join(re.sub(r"\(\n([^)]*)\)", r"\1", page.read_text("utf-8")) for page in pages)
    text = "\n".join(PAGES.values())
    for module, names in re.findall(r"^from (thalweg[\w.]*) import ((?:.|,\n)+)$", code, re.M):
        for name in re.findall(r"\w+", names):
            described = f"## {name}\n" in text or name.isupper() or name == "codes"
            assert described, f"add {module}.{name} to MORE_NAMES"


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: str(path.relative_to(SOURCE)))
def test_examples_in_docstrings_run(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    parts = path.relative_to(SOURCE).with_suffix("").parts
    found = doctest.testmod(import_module(".".join(("thalweg", *parts))))
    assert found.attempted and not found.failed


def callables(name, value):
    """Yield a public function or class and the public methods of the class, by name."""
    yield name, value
    if inspect.isclass(value):
        for member, method in reference.members(value):
            own = member in vars(value) and member not in vars(value).get("__annotations__", ())
            if own and not isinstance(method, property) and not hasattr(method, "func"):
                yield f"{name}.{member}", getattr(method, "__func__", method)


def missing_sections(value):
    """Return which of the sections Parameters (or Attributes) and Returns a docstring lacks."""
    text = value.__doc__ or ""
    if inspect.isclass(value):
        inherits = "__init__" not in vars(value)
        if getattr(value, "_is_protocol", False) or (inherits and issubclass(value, Exception)):
            return set()
        if not vars(value).get("__annotations__"):  # its attributes are those of a base class
            text = "\n".join(base.__doc__ or "" for base in value.__mro__[:-1])
    found = inspect.signature(value)
    missing = set()
    takes_arguments = set(found.parameters) - {"self", "cls"}
    if takes_arguments and not re.search(r"^ *(Parameters|Attributes)$", text, re.M):
        missing.add("Parameters")
    if inspect.isclass(value):
        return missing
    if found.return_annotation not in ("None", None) and not re.search("^ *Returns$", text, re.M):
        missing.add("Returns")
    return missing


def undescribed():
    """Return the names of the reference whose docstring lacks a section."""
    return {
        full
        for page in reference.PAGES
        for name, value in reference.public_objects(page).items()
        if callable(value)
        for full, function in callables(name, value)
        if missing_sections(function)
    }


def test_parameters_and_results_are_described():
    assert sorted(undescribed()) == []
