"""Dotted names in docstrings, comments and pages exist."""

from __future__ import annotations

import re
from importlib import import_module
from pathlib import Path

import thalweg

ROOT = Path(__file__).resolve().parents[2]
DOTTED = re.compile(r"(?<![\w./])thalweg(?:\.[A-Za-z_]\w*)+")
NOT_PYTHON = ("thalweg.ships",)  # the group of entry points


def exists(name: str) -> bool:
    """Tell whether a dotted name is a module, or an attribute of one."""
    parts = name.split(".")
    for size in range(len(parts), 0, -1):
        try:
            found = import_module(".".join(parts[:size]))
        except ModuleNotFoundError:
            continue
        for part in parts[size:]:
            if not hasattr(found, part) and part not in getattr(found, "__annotations__", ()):
                return False
            found = getattr(found, part, None)
        return True
    return False


def test_every_dotted_name_exists():
    pages = [*Path(thalweg.__file__).parent.rglob("*.py"), ROOT / "README.md"]
    pages += [page for page in (ROOT / "docs").rglob("*.md") if page.parent.name != "decisions"]
    wrong = set()
    for page in pages:
        if page.name == "deprecated_names.py":
            continue
        for name in DOTTED.findall(page.read_text("utf-8")):
            if not name.startswith(NOT_PYTHON) and not exists(name):
                wrong.add((page.relative_to(ROOT).as_posix(), name))
    assert sorted(wrong) == []
