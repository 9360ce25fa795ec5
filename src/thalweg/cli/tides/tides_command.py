"""``thalweg tides``: tidal analysis and prediction."""

from __future__ import annotations

from typing import Any

from thalweg.cli import options
from thalweg.cli.tides import tide_analysis_command, tide_prediction_command


def add_command(commands: Any) -> None:
    """Add the command with its actions to the parser."""
    parser = commands.add_parser(
        "tides",
        help="analyse tides and predict them for any date",
        description="Find tidal constituents in a record or a model run, and predict the tide from "
        "them.",
    )
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    tide_analysis_command.add_command(actions)
    tide_prediction_command.add_command(actions)
    for action in actions.choices.values():
        options.accept_negative_positions(action)
