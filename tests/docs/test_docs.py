"""The Python in README and docs runs, page by page, and every command and option is documented."""

import re
import shlex
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
@pytest.mark.slow
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
        assert f"`thalweg {command}`" in text


def test_every_public_name_has_a_docstring():
    import thalweg

    for public in thalweg.__all__:
        assert (getattr(thalweg, public).__doc__ or "").strip(), public


@pytest.mark.slow
def test_the_commands_of_the_readme_run_as_they_stand(tmp_path, monkeypatch, capsys):
    from thalweg.cli.main import main

    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"^```bash\n(.*?)^```", (ROOT / "README.md").read_text(), re.M | re.S)
    lines = [line for block in blocks for line in block.splitlines()]
    assert lines[0].startswith("pip install .")
    commands = [shlex.split(line, comments=True) for line in lines[1:]]
    assert len(commands) == 2
    for program, *words in commands:
        assert program == "thalweg" and main(words) == 0
    printed = capsys.readouterr().out
    assert "kept: land, zones" in printed and "nan" not in printed.split()
    assert (tmp_path / "out" / "map.png").exists()


def test_commands_in_pages_have_options_that_exist():
    from thalweg.cli.main import build_parser
    from thalweg.core.errors import InputError

    bad = []
    for page in TRIED:
        for block in re.findall(r"^```bash\n(.*?)^```", page.read_text(), re.M | re.S):
            for line in block.replace("\\\n", " ").splitlines():
                words = shlex.split(line, comments=True)
                if words[:1] != ["thalweg"]:
                    continue
                try:
                    build_parser().parse_args(["OTHER" if w == "..." else w for w in words[1:]])
                except InputError as error:
                    bad.append(f"{name(page)}: {line}: {error.asked}")
    assert not bad, "\n".join(bad)
