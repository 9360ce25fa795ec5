"""The page of the command line is up to date, and unknown words get a suggestion."""

import importlib.metadata
import importlib.util

import pytest

import thalweg
from tests.conftest import ROOT
from thalweg.cli.main import main

SPEC = importlib.util.spec_from_file_location(
    "generate_cli_page", ROOT / "docs" / "generate_cli_page.py"
)
generator = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(generator)


def test_the_page_is_up_to_date():
    assert generator.PAGE.read_text("utf-8") == generator.page_text(), "run `make docs`"


def test_the_page_has_every_command_and_option():
    text = generator.page_text()
    for words in ("## thalweg plan", "## thalweg tides predict", "`--max-waypoints N`", "`FROM`"):
        assert words in text
    assert "==SUPPRESS==" not in text and "%(" not in text


@pytest.mark.parametrize(
    ("words", "near"),
    [
        (["paln", "a", "b"], "Did you mean plan"),
        (["plan", "a", "b", "--ship", "x", "--obejctive=fuel"], "Did you mean --objective"),
        (["plan", "a", "b", "--ship", "x", "--calm", "--coast", "hi"], "See thalweg plan --help"),
        (["tides", "anlyse", "x"], "Did you mean analyse"),
        (["evaluate", "r.csv", "--ship", "x", "--dpart", "now"], "Did you mean --depart"),
    ],
)
def test_unknown_words_get_a_suggestion(capsys, words, near):
    assert main(words) == 2
    assert near in capsys.readouterr().err


def test_version():
    assert thalweg.__version__ == importlib.metadata.version("thalweg")
