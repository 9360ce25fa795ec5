"""Table of the performance sheet of a ship on the terminal."""

from __future__ import annotations

import math
from typing import Any, Final

from thalweg.route.number_texts import decimals

#: Columns whose values are small for small craft, with their least number of decimals.
_MORE_DIGITS_OF_SMALL_CRAFT: Final = {
    "brake_power_kw": 0, "fuel_kg_per_h": 0, "fuel_kg_per_nm": 1, "co2_kg_per_h": 0,
}  # fmt: skip


def print_sheet(sheet: dict[str, Any]) -> None:
    """Print resistance, power, fuel and emissions at each speed, with warnings and sources."""
    from rich import box
    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table

    console = Console()
    console.print(f"[bold]{escape(sheet['name'])}[/bold], draught {sheet['draught_m']:.2f} m")
    table = Table(box=box.SIMPLE, pad_edge=False, padding=(0, 1, 0, 0))
    composed = any(row["resistance_n"]["total"] is not None for row in sheet["conditions"])
    heads = ["speed\nkn"]
    if composed:
        heads += ["resistance\nkN", "waves\nkN", "wind\nkN"]
    heads += ["power\nkW", "fuel\nkg/h", "fuel\nkg/nm", "CO2\nkg/h", "CII\ng/(t nm)"]
    for head in heads:
        table.add_column(head, justify="right", no_wrap=True)
    digits = {name: _digits(sheet["conditions"], name) for name in _MORE_DIGITS_OF_SMALL_CRAFT}
    for row in sheet["conditions"]:
        forces = row["resistance_n"]
        ordered = row.get("ordered_speed_kn")
        unknown = row["speed_kn"] is None and ordered is not None
        cells = [f"ordered {ordered:.1f}: -" if unknown else _text(row["speed_kn"], 2)]
        if composed:
            cells += [_text(_in_thousands(forces[name]), 1) for name in ("total", "waves", "wind")]
        cii = row["cii"]
        cells += [
            *(_text(row[name], digits[name]) for name in _MORE_DIGITS_OF_SMALL_CRAFT),
            f"{cii['attained_g_per_t_nm']:.2f} {cii['rating_2026'] or ''}" if cii else "-",
        ]
        table.add_row(*cells)
    console.print(table)
    _print_notes(console, sheet)


def _digits(rows: list[dict[str, Any]], name: str) -> int:
    """Return the number of decimals of a column."""
    values = [math.nan if row[name] is None else row[name] for row in rows]
    return decimals(values, least=_MORE_DIGITS_OF_SMALL_CRAFT[name])


def _print_notes(console: Any, sheet: dict[str, Any]) -> None:
    from rich.markup import escape

    def show(head: str, text: str) -> None:
        console.print(head + escape(text), highlight=False)

    for note in sheet["warnings"]:
        show("[yellow]warning:[/yellow] ", note)
    for note in sheet["assumed"]:
        show("Assumed: ", note)
    for where, note in merged_notes(sheet["conditions"]):
        show(f"[yellow]warning[/yellow] at {where} kn: ", note)
    for note in sheet["missing"]:
        show("Not known: ", note)
    if sheet["estimated"]:
        console.print("Estimated, not given:")
        for one in sheet["estimated"]:
            value = one["value"] if isinstance(one["value"], str) else f"{one['value']:.5g}"
            show("  ", f"{one['key']} = {value}  ({one['method']})")
    for source in sheet["sources"]:
        show("Source: ", source)


def merged_notes(rows: list[dict[str, Any]]) -> list[tuple[str, str]]:
    """Return the warnings of all rows as (speeds, text); equal but for a value, they are merged."""
    found: dict[str, list[tuple[float, str]]] = {}
    for row in rows:
        for note in row["warnings"]:
            head, _, value = note.partition(" is ")
            value, _, bounds = value.partition(", ")
            found.setdefault(f"{head} is {{}}, {bounds}" if bounds else note, []).append(
                (row["speed_kn"] or row.get("ordered_speed_kn") or 0.0, value)
            )
    merged = []
    for note, where in found.items():
        speeds = _ends([f"{speed:.4g}" for speed, _ in sorted(where)])
        merged.append((speeds, note.replace("{}", _ends([value for _, value in where]))))
    return merged


def _ends(words: list[str]) -> str:
    return " to ".join(dict.fromkeys((words[0], words[-1])))


def _in_thousands(value: float | None) -> float | None:
    return None if value is None else value / 1000.0


def _text(value: float | None, digits: int) -> str:
    return "-" if value is None else f"{value:,.{digits}f}"
