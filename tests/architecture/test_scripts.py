"""The scripts beside the package: what they import exists, although no other test runs them."""

import ast
import importlib.util
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SCRIPTS = sorted([*ROOT.glob("benchmarks/*.py"), *ROOT.glob("tools/*.py")])


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.name)
def test_the_package_has_what_a_script_imports(script):
    missing = []
    for node in ast.walk(ast.parse(script.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("thalweg"):
            module = importlib.import_module(node.module)
            missing += [
                f"{node.module}.{item.name}"
                for item in node.names
                if not (hasattr(module, item.name) or is_module(f"{node.module}.{item.name}"))
            ]
    assert missing == []


def is_module(name):
    return importlib.util.find_spec(name) is not None
