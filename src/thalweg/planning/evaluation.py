"""Score a route from a file, with the checks a user needs at the door."""

from __future__ import annotations

from pathlib import Path

from thalweg.chart import Chart
from thalweg.core.time import TimeLike
from thalweg.route import Route, evaluate
from thalweg.sea import Sea
from thalweg.ship import Ship


def evaluate_file(
    path: str | Path,
    *,
    ship: Ship,
    sea: Sea,
    chart: Chart | None = None,
    depart: TimeLike | None = None,
    speed_kn: float | None = None,
    min_ukc_m: float | None = None,
) -> Route:
    """Read a route from CSV, GeoJSON or GPX and let the referee score it."""
    return evaluate(
        path,
        ship=ship,
        sea=sea,
        chart=chart,
        depart=depart,
        speed_kn=speed_kn,
        min_ukc=min_ukc_m or 0.0,
    )
