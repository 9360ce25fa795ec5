"""Code names and paths that the nomenclature, CONTRIBUTING and the architecture name exist."""

from __future__ import annotations

import dataclasses
import re
from importlib import import_module

import pytest

from tests.conftest import ROOT

EXPLANATION = ROOT / "docs" / "explanation"
ROWS = [
    [cell.strip() for cell in line.strip("| ").split(" | ")]
    for line in (EXPLANATION / "nomenclature.md").read_text("utf-8").splitlines()
    if line.startswith("| ") and not line.startswith("| term")
]
NAMES = sorted({name for row in ROWS for name in re.findall(r"`([\w.]+)`", row[-1])})
PATH = re.compile(r"`((?:src|tests|docs|benchmarks)/[\w./*-]+|[\w/]+\.(?:py|md|toml|yaml))`")
PAGES = [
    ROOT / "CONTRIBUTING.md",
    EXPLANATION / "architecture.md",
    ROOT / "benchmarks" / "README.md",
]


def find(name: str) -> object:
    """Return the object of a dotted name below ``thalweg``."""
    parts = name.split(".")
    for length in range(len(parts), 0, -1):
        try:
            found = import_module(".".join(["thalweg", *parts[:length]]))
        except ModuleNotFoundError:
            continue
        for part in parts[length:]:
            fields = {f.name: f for f in dataclasses.fields(found)} if is_record(found) else {}
            found = getattr(found, part) if hasattr(found, part) else fields[part]
        return found
    raise LookupError(name)


def is_record(value: object) -> bool:
    return isinstance(value, type) and dataclasses.is_dataclass(value)


@pytest.mark.parametrize("name", NAMES)
def test_name_of_the_nomenclature_exists(name):
    find(name)


def test_every_term_has_a_place_in_the_code():
    assert len(ROWS) > 100
    assert not [row for row in ROWS if len(row) < 4 or "`" not in row[-1]]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_paths_in_pages_exist(page):
    folders = (ROOT, ROOT / "src" / "thalweg", page.parent)
    for path in PATH.findall(page.read_text("utf-8")):
        assert any(list(folder.glob(path)) for folder in folders), path


def test_modules_in_the_architecture_exist():
    text = (EXPLANATION / "architecture.md").read_text("utf-8")
    for name in re.findall(r"`thalweg\.([\w.]+)`", text):
        find(name)
