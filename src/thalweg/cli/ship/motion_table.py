"""Motions and sickness by place and heading: table and polar plot."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from thalweg.core.file_writing import save_figure

_SAME_SPEED_KN = 0.05
_SHOWN_DEG = (0, 30, 60, 90, 120, 150, 180)


def print_motions(sheet: Mapping[str, Any]) -> None:
    """Print the motions at every place, one line for each heading.

    Parameters
    ----------
    sheet : From `thalweg.ship.comfort.motion_sheet.motion_sheet`.
    """
    from rich.console import Console
    from rich.markup import escape

    console = Console()
    console.print(
        f"Motions in waves of {sheet['wave_height_m']:g} m and {sheet['wave_period_s']:.1f} s, "
        f"{_speed_text(sheet)}: root mean squares; "
        f"waves by their angle off the bow; sick: share of people after {sheet['exposure_h']:g} h "
        "(ISO 2631-1)",
        highlight=False,
    )
    for table in _motion_tables(sheet, console.width):
        console.print(table)
    for task, good in sheet["tasks"].items():
        possible = [h for h, g in zip(sheet["headings_deg"], good) if g]
        text = ", ".join(f"{h}" for h in possible) or "no heading"
        console.print(f"{escape(task)} is possible with waves from: {text}", highlight=False)
    for note in sheet["warnings"]:
        console.print("[yellow]warning:[/yellow] " + escape(note), highlight=False)


def _motion_tables(sheet: Mapping[str, Any], width: int) -> list[Any]:
    """Return the table of motions, in parts where it is wider than the terminal [characters]."""
    from rich import box
    from rich.markup import escape
    from rich.table import Table

    general = {
        "waves\ndeg": [f"{heading}" for heading in sheet["headings_deg"]],
        "speed\nkn": [_text(x, 1) for x in sheet["attained_speed_kn"]],
        "heave\nm": [_text(x, 2) for x in sheet["heave_rms_m"]],
        "pitch\ndeg": [_text(x, 2) for x in sheet["pitch_rms_deg"]],
        "roll\ndeg": [_text(x, 1) for x in sheet["roll_rms_deg"]],
    }
    parts, used = [list(general.items())], 7 * len(general)
    for name, at in sheet["places"].items():
        more = max(len(name), 4) + 8
        if used + more > width:
            parts.append([next(iter(general.items()))])
            used = 7
        used += more
        parts[-1] += [
            (f"{escape(name)}\nm/s2", [_text(x, 2) for x in at["acceleration_rms_m_s2"]]),
            ("sick\n%", [_text(x, 0) for x in at["sick_percent"]]),
        ]
    tables = []
    for columns in parts:
        table = Table(box=box.SIMPLE, pad_edge=False, padding=(0, 1, 0, 0))
        for head, _ in columns:
            table.add_column(head, justify="right", no_wrap=True)
        for k, heading in enumerate(sheet["headings_deg"]):
            if heading in _SHOWN_DEG:
                table.add_row(*(cells[k] for _, cells in columns))
        tables.append(table)
    return tables


def draw_motions(sheet: Mapping[str, Any], path: Path) -> Path:
    """Draw the share of people sick by place over the direction of the waves, and return the file.

    Parameters
    ----------
    sheet : From `thalweg.ship.comfort.motion_sheet.motion_sheet`.
    path : Picture to write.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.5, 6.0), layout="constrained")
    axes: Any = figure.add_subplot(projection="polar")
    axes.set_theta_zero_location("N")
    axes.set_theta_direction(-1)
    half = np.radians(sheet["headings_deg"])
    angle = np.concatenate([half, 2.0 * np.pi - half[::-1]])
    for name, at in sheet["places"].items():
        share = np.array(at["sick_percent"], float)
        axes.plot(angle, np.concatenate([share, share[::-1]]), label=name)
    axes.set_title(
        f"Per cent of people sick after {sheet['exposure_h']:g} h, by where the waves come from\n"
        f"(0: ahead); {sheet['wave_height_m']:g} m, {sheet['wave_period_s']:.1f} s, "
        + _speed_text(sheet)
    )
    axes.legend(loc="lower left", bbox_to_anchor=(-0.1, -0.1))
    save_figure(figure, path)
    return path


def _speed_text(sheet: Mapping[str, Any]) -> str:
    """Return the speed of the sheet in words: that which is held, or that of the same power."""
    ordered = sheet["ordered_speed_kn"]
    attained = [speed for speed in sheet["attained_speed_kn"] if speed is not None]
    if attained and max(abs(speed - ordered) for speed in attained) < _SAME_SPEED_KN:
        return f"at {ordered:.1f} kn on all headings"
    if sheet["held"] == "constant speed":
        return f"at {ordered:.1f} kn, or less where the engines do not give it"
    return f"with the power for {ordered:.1f} kn in calm water"


def _text(value: float | None, digits: int) -> str:
    return "-" if value is None else f"{value:.{digits}f}"
