"""The Python in README and docs runs, page by page, and every command and option is documented."""

import re
from pathlib import Path

import pytest

from tests.conftest import ROOT

PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
#: Pages whose Python runs; the examples of the reference run in `test_reference`.
TRIED = [page for page in PAGES if page.parent.name != "reference"]
BLOCK = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\((?!https?:|#|mailto:)([^)#]+)(?:#[^)]*)?\)")


def name(page: Path) -> str:
    return str(page.relative_to(ROOT))


@pytest.mark.parametrize("page", [p for p in TRIED if BLOCK.search(p.read_text())], ids=name)
def test_python_in_pages_runs(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    world: dict[str, object] = {}
    for number, code in enumerate(BLOCK.findall(page.read_text()), start=1):
        exec(compile(code, f"{name(page)} block {number}", "exec"), world)


@pytest.mark.parametrize("page", PAGES, ids=name)
def test_links_lead_somewhere(page):
    missing = [link for link in LINK.findall(page.read_text()) if not (page.parent / link).exists()]
    assert not missing


def test_every_command_is_in_the_readme():
    from thalweg.cli.main import build_parser

    text = (ROOT / "README.md").read_text()
    commands = next(a for a in build_parser()._actions if a.choices and "plan" in a.choices)
    for command in commands.choices:
        assert f"thalweg {command}" in text or f"make {command}" in text


def test_every_public_name_has_a_docstring():
    import thalweg

    for public in thalweg.__all__:
        assert (getattr(thalweg, public).__doc__ or "").strip(), public
