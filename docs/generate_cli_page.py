"""Write docs/cli.md, the page of the command line, from its parsers (``make docs``)."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

from thalweg.cli.main import build_parser

PAGE = Path(__file__).parent / "cli.md"


def page_text() -> str:
    """Return the text of the page."""
    parser = build_parser()
    lines = ["# Command line", "", str(parser.description), ""]
    lines += [
        "Written from the program by `make docs`. `thalweg COMMAND --help` prints the same.",
        "",
    ]
    lines += [str(parser.epilog).partition("'thalweg COMMAND")[0].strip(), ""]
    for name, help_text in _summaries(parser):
        anchor = f"thalweg {name}".replace(" ", "-")
        lines.append(f"* [`thalweg {name}`](#{anchor}): {help_text}")
    for sub in _leaves(parser):
        lines += ["", *_section(sub)]
    return "\n".join(lines).replace("%%", "%") + "\n"


def _summaries(parser: argparse.ArgumentParser, before: str = "") -> Iterator[tuple[str, str]]:
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            helps = {choice.dest: choice.help or "" for choice in action._choices_actions}
            for name, sub in action.choices.items():
                nested = list(_summaries(sub, f"{before}{name} "))
                yield from nested or [(f"{before}{name}", helps.get(name, ""))]


def _leaves(parser: argparse.ArgumentParser) -> Iterator[argparse.ArgumentParser]:
    subs = [a for a in parser._actions if isinstance(a, argparse._SubParsersAction)]
    if not subs:
        yield parser
    for action in subs:
        for sub in action.choices.values():
            yield from _leaves(sub)


def _section(parser: argparse.ArgumentParser) -> list[str]:
    lines = [f"## {parser.prog}", "", str(parser.description or ""), ""]
    for group in parser._action_groups:
        actions = [a for a in group._group_actions if a.help != argparse.SUPPRESS]
        actions = [a for a in actions if not isinstance(a, argparse._HelpAction)]
        if not actions:
            continue
        title = {"positional arguments": "Arguments", "options": "Options"}
        name = title.get(str(group.title), str(group.title).capitalize())
        lines += [f"{name}" + (f" ({group.description})" if group.description else ""), ""]
        lines += ["| name | meaning |", "|---|---|"]
        lines += [f"| {_name(action)} | {_meaning(action)} |" for action in actions]
        lines.append("")
    if parser.epilog:
        command = str(parser.epilog).removeprefix("Example: ")
        lines += [f"Example: `{command}`" if command != parser.epilog else str(parser.epilog)]
    return lines


def _name(action: argparse.Action) -> str:
    value = action.metavar or (
        "|".join(map(str, action.choices)) if action.choices else action.dest.upper()
    )
    words = " ".join(value) if isinstance(value, tuple) else str(value)
    if not action.option_strings:
        return f"`{words}`".replace("|", "\\|")
    takes = "" if action.nargs == 0 else f" {words}"
    return f"`{', '.join(action.option_strings)}{takes}`".replace("|", "\\|")


def _meaning(action: argparse.Action) -> str:
    return " ".join(str(action.help or "").split()).replace("|", "\\|")


if __name__ == "__main__":
    PAGE.write_text(page_text(), encoding="utf-8")
