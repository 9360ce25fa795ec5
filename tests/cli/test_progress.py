"""Messages about what a command is doing."""

import json

import pytest

from thalweg.cli import progress
from thalweg.cli.main import build_parser, main
from thalweg.cli.progress import ProgressMessages


def leaves(parser):
    """Return all commands and actions of a parser."""
    found = [a.choices for a in parser._actions if isinstance(a.choices, dict)]
    return [leaf for choices in found for sub in choices.values() for leaf in leaves(sub)] or [
        parser
    ]


def test_every_command_can_be_quiet():
    for parser in leaves(build_parser()):
        assert "--quiet" in parser.format_help(), parser.prog


@pytest.fixture
def clock(monkeypatch):
    """A clock that tests set; the thread that watches it does not start."""
    now = [0.0]
    monkeypatch.setattr(ProgressMessages, "_seconds", lambda self: now[0])
    monkeypatch.setattr(ProgressMessages, "_watch", lambda self: None)
    return now


def test_stages_after_the_first_second_are_printed_once(capsys, clock):
    with ProgressMessages() as messages:
        messages("reading")
        assert capsys.readouterr().err == ""
        clock[0] = 1.5
        messages("searching")
        messages("searching")
    messages("late")
    captured = capsys.readouterr()
    assert captured.err == "searching ...\n" and captured.out == ""


def test_a_long_stage_is_printed_and_repeated(capsys, monkeypatch):
    messages = ProgressMessages()
    monkeypatch.setattr(progress, "_SILENT", 0.0)
    messages("searching")
    capsys.readouterr()
    waits = iter([False, False, True])
    monkeypatch.setattr(messages._ended, "wait", lambda seconds: next(waits))
    monkeypatch.setattr(messages, "_seconds", lambda: 31.0)
    messages._printed = False
    messages._watch()
    assert capsys.readouterr().err == "searching ...\nsearching, after 31 s ...\n"


def test_quiet_prints_nothing(capsys, clock):
    clock[0] = 9.0
    with ProgressMessages(quiet=True) as messages:
        messages("searching")
    assert capsys.readouterr().err == ""


def test_json_on_stdout_is_not_mixed_with_messages(capsys, clock):
    clock[0] = 9.0
    assert main(["ship", "handysize-bulker", "--json"]) == 0
    captured = capsys.readouterr()
    assert json.loads(captured.out)
    assert "computing the performance" in captured.err
    assert main(["ship", "handysize-bulker", "--json", "--quiet"]) == 0
    assert capsys.readouterr().err == ""
