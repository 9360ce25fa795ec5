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
    from rich import box
    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table

    console = Console()
    console.print(
        f"Motions in waves of {sheet['wave_height_m']:g} m and {sheet['wave_period_s']:.1f} s, "
        f"{_speed_text(sheet)}: root mean squares; "
        f"waves by their angle off the bow; sick: share of people after {sheet['exposure_h']:g} h "
        "(ISO 2631-1)",
        highlight=False,
    )
    table = Table(box=box.SIMPLE, pad_edge=False, padding=(0, 1, 0, 0))
    for head in ("waves\ndeg", "speed\nkn", "heave\nm", "pitch\ndeg", "roll\ndeg"):
        table.add_column(head, justify="right", no_wrap=True)
    for name in sheet["places"]:
        table.add_column(f"{escape(name)}\nm/s2", justify="right", no_wrap=True)
        table.add_column("sick\n%", justify="right", no_wrap=True)
    for k, heading in enumerate(sheet["headings_deg"]):
        if heading not in _SHOWN_DEG:
            continue
        cells = [
            f"{heading}",
            _text(sheet["attained_speed_kn"][k], 1),
            _text(sheet["heave_rms_m"][k], 2),
            _text(sheet["pitch_rms_deg"][k], 2),
            _text(sheet["roll_rms_deg"][k], 1),
        ]
        for at in sheet["places"].values():
            cells += [_text(at["acceleration_rms_m_s2"][k], 2), _text(at["sick_percent"][k], 0)]
        table.add_row(*cells)
    console.print(table)
    for task, good in sheet["tasks"].items():
        possible = [h for h, g in zip(sheet["headings_deg"], good) if g]
        text = ", ".join(f"{h}" for h in possible) or "no heading"
        console.print(f"{escape(task)} is possible with waves from: {text}", highlight=False)
    for note in sheet["warnings"]:
        console.print("[yellow]warning:[/yellow] " + escape(note), highlight=False)


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
    return f"with the power for {ordered:.1f} kn in calm water"


def _text(value: float | None, digits: int) -> str:
    return "-" if value is None else f"{value:.{digits}f}"
