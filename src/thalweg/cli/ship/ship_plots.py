"""Pictures of a ship: resistance by component, power and fuel, speed loss over the heading."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from thalweg.core.file_writing import new_figure, save_figure
from thalweg.core.units import KNOT
from thalweg.ship import Conditions, Ship
from thalweg.ship.performance_sheet_weather import assumed_peak_period

#: component: label and colour, from the hull outwards
_RESISTANCE_COMPONENTS = {
    "friction": ("friction", "#1b4f72"),
    "form_factor": ("form", "#2e86c1"),
    "appendage": ("appendages", "#85c1e9"),
    "wave_making": ("wave making", "#148f77"),
    "bulb": ("bulb", "#73c6b6"),
    "transom": ("transom", "#a2d9ce"),
    "correlation": ("correlation", "#b2babb"),
    "shallow": ("shallow water", "#b7950b"),
    "waves": ("waves", "#ca6f1e"),
    "wind": ("wind", "#f0b27a"),
    "rudder": ("rudder", "#76448a"),
}


_RATING_COLOURS = ("#2e7d32", "#9ccc65", "#fff176", "#ffb74d", "#e57373")
_BAND_LABEL_STYLE = {"ha": "right", "va": "center", "fontweight": "bold"}


def draw_ship(
    ship: Ship, sheet: Mapping[str, Any], weather: Mapping[str, float], folder: Path
) -> list[Path]:
    """Draw what is known of a ship and return the files written.

    Parameters
    ----------
    sheet : From `thalweg.ship.performance_sheet.performance_sheet`.
    weather : Conditions by name, SI.
    folder : Exists.
    """
    rows = sorted(sheet["conditions"], key=lambda row: row["speed_kn"] or 0.0)
    sheet = {**sheet, "conditions": rows}
    drawings: list[tuple[str, Callable[[Any], bool]]] = [
        ("resistance.png", lambda axes: _resistance(axes, sheet)),
        ("power.png", lambda axes: _power(axes, sheet)),
        ("fuel.png", lambda axes: _fuel(axes, sheet)),
        ("cii.png", lambda axes: _cii(axes, sheet)),
    ]
    written = [folder / name for name, draw in drawings if _save(folder / name, draw)]
    polar = folder / "speed_loss.png"
    name = _title(sheet)
    if _save(polar, lambda axes: _polar(axes, ship, weather, name), projection="polar"):
        written.append(polar)
    return written


def _save(path: Path, draw: Callable[[Any], bool], **subplot: Any) -> bool:
    figure = new_figure(7.2, 4.8, dpi=None)
    axes = figure.add_subplot(**subplot)
    if not draw(axes):
        return False
    save_figure(figure, path, dpi=130)
    return True


def _column(sheet: Mapping[str, Any], name: str) -> np.ndarray:
    return np.array([np.nan if r[name] is None else r[name] for r in sheet["conditions"]], float)


def _resistance(axes: Any, sheet: Mapping[str, Any]) -> bool:
    rows = [row for row in sheet["conditions"] if row["resistance_n"]["total"] is not None]
    if not rows:
        return False
    speed = np.array([row["speed_kn"] for row in rows])
    parts = {
        name: np.array([row["resistance_n"][name] for row in rows], float) / 1000.0
        for name in _RESISTANCE_COMPONENTS
    }
    most = max(abs(row["resistance_n"]["total"]) for row in rows) / 1000.0
    shown = [name for name in _RESISTANCE_COMPONENTS if np.abs(parts[name]).max() > 1e-9 * most]
    if len(rows) == 1:
        return _bars(axes, _title(sheet), {n: float(parts[n][0]) for n in shown}, float(speed[0]))
    up = [np.maximum(parts[name], 0.0) for name in shown]
    down = [np.minimum(parts[name], 0.0) for name in shown]
    colours = [_RESISTANCE_COMPONENTS[name][1] for name in shown]
    axes.stackplot(speed, up, labels=[_RESISTANCE_COMPONENTS[n][0] for n in shown], colors=colours)
    if any((d < 0).any() for d in down):
        axes.stackplot(speed, down, colors=colours)
    total = sum(parts[name] for name in shown)
    axes.plot(speed, total, color="black", linewidth=1.5, label="total")
    handles, labels = axes.get_legend_handles_labels()
    axes.legend(handles[::-1], labels[::-1], loc="upper left", frameon=False, fontsize=8)
    axes.set(xlabel="speed through water [kn]", ylabel="resistance [kN]", title=_title(sheet))
    axes.margins(x=0)
    return True


def _title(sheet: Mapping[str, Any]) -> str:
    """The ship's name; a dollar in it begins no formula."""
    return str(sheet["name"]).replace("$", r"\$")


def _bars(axes: Any, name: str, parts: Mapping[str, float], speed: float) -> bool:
    """The components at a single speed, the largest on top."""
    names = sorted(parts, key=lambda name: parts[name])
    values = [parts[name] for name in names]
    places = axes.barh(
        [_RESISTANCE_COMPONENTS[n][0] for n in names],
        values,
        color=[_RESISTANCE_COMPONENTS[n][1] for n in names],
    )
    axes.bar_label(places, fmt="%.4g", padding=3, fontsize=8)
    title = f"{name}: {sum(values):.4g} kN at {speed:g} kn"
    axes.set(xlabel="resistance [kN]", title=title)
    axes.margins(x=0.12)
    return True


def _power(axes: Any, sheet: Mapping[str, Any]) -> bool:
    speed, power = _column(sheet, "speed_kn"), _column(sheet, "brake_power_kw")
    effective = _column(sheet, "effective_power_kw")
    if len(speed) < 2 or np.isnan(power).all():
        return False
    axes.plot(speed, power, color="#1b5e8c", label="brake power")
    if not np.isnan(effective).all():
        axes.plot(speed, effective, color="#7fb2d6", label="effective power")
    axes.legend(frameon=False)
    axes.set(xlabel="speed through water [kn]", ylabel="power [kW]", title=_title(sheet))
    axes.set_ylim(bottom=0.0)
    axes.grid(alpha=0.3)
    return True


def _fuel(axes: Any, sheet: Mapping[str, Any]) -> bool:
    speed, fuel = _column(sheet, "speed_kn"), _column(sheet, "fuel_kg_per_nm")
    if len(speed) < 2 or np.isnan(fuel).all():
        return False
    axes.plot(speed, fuel, color="#b5482a", marker="o", markersize=3)
    axes.set(xlabel="speed through water [kn]", ylabel="fuel [kg/nm]", title=_title(sheet))
    axes.set_ylim(bottom=0.0)
    axes.grid(alpha=0.3)
    return True


def _cii(axes: Any, sheet: Mapping[str, Any]) -> bool:
    """Carbon intensity over speed, before the bands of its rating."""
    known = [row for row in sheet["conditions"] if row["cii"] is not None]
    if len(known) < 2:
        return False
    speed = [row["speed_kn"] for row in known]
    attained = [row["cii"]["attained_g_per_t_nm"] for row in known]
    limits = known[0]["cii"]["boundaries_2026"]
    top = 1.1 * max([*attained, *(limits or [])])
    for low, high, letter, colour in zip(
        [0.0, *(limits or [])], [*(limits or []), top], "ABCDE", _RATING_COLOURS
    ):
        axes.axhspan(low, high, color=colour, alpha=0.35, linewidth=0)
        axes.text(
            0.99,
            0.5 * (low + high),
            letter,
            transform=axes.get_yaxis_transform(),
            **_BAND_LABEL_STYLE,
        )
    axes.plot(speed, attained, color="#222222", marker="o", markersize=3)
    axes.set(
        xlabel="speed through water [kn]",
        ylabel="CII if always sailed so [g CO2/(t nm)]",
        title=f"{_title(sheet)}: ratings of 2026" if limits else _title(sheet),
    )
    axes.set_ylim(0.0, top)
    return True


def _polar(axes: Any, ship: Ship, weather: Mapping[str, float], name: str) -> bool:
    """Speed attained over the direction of wind and waves, in three strengths."""
    if ship.speed_field is not None or not ship.reads & {"wind_angle", "wave_angle"}:
        return False
    angle = np.linspace(0.0, np.pi, 181)
    both, top = np.concatenate([angle, -angle[::-1]]), np.nan
    for label, wind, waves, colour in _strengths(weather):
        at = {"depth": np.inf, "wave_period": assumed_peak_period(waves), **weather}
        at |= {"wind_speed": wind, "wave_height": waves}
        conditions = Conditions({**at, "wind_angle": angle, "wave_angle": angle})
        speed = ship.speed_through_water(conditions, len(ship.speeds) - 1) / KNOT
        axes.plot(both, np.concatenate([speed, speed[::-1]]), color=colour, label=label)
        top = np.fmax(top, np.fmax.reduce(speed))
    if np.isnan(top):
        return False
    axes.set_theta_zero_location("N")
    axes.set_theta_direction(-1)
    axes.set_ylim(0.0, 1.05 * top if top > 0.0 else 1.0)
    axes.set_title(f"{name}\nspeed [kn] by where wind and waves come from (0 = ahead)", size=9)
    axes.legend(loc="lower left", bbox_to_anchor=(-0.35, -0.05), frameon=False, fontsize=8)
    return True


def _strengths(weather: Mapping[str, float]) -> list[tuple[str, float, float, str]]:
    wind, waves = weather.get("wind_speed", 0.0), weather.get("wave_height", 0.0)
    if wind or waves:
        return [
            ("calm", 0.0, 0.0, "#9aa5ad"),
            (f"wind {wind:g} m/s, waves {waves:g} m", wind, waves, "#1b5e8c"),
        ]
    return [
        ("calm", 0.0, 0.0, "#9aa5ad"),
        ("wind 8 m/s, waves 1.5 m", 8.0, 1.5, "#7fb2d6"),
        ("wind 12 m/s, waves 3 m", 12.0, 3.0, "#1b5e8c"),
        ("wind 16 m/s, waves 5 m", 16.0, 5.0, "#0b2c46"),
    ]
