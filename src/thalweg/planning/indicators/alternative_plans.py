"""Alternatives of a voyage: a few routes that differ, each the best in something."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from thalweg.chart.passage_crossings import names_passed
from thalweg.core.errors import InputError, NoRouteError
from thalweg.core.file_writing import make_folder, write_csv_rows, write_text
from thalweg.core.geodesy import distance
from thalweg.core.types import FloatArray
from thalweg.core.units import HOUR, NAUTICAL_MILE
from thalweg.planning.indicators.route_figures import (
    COMPARED_FIGURES,
    all_figures,
    champions,
    compared_values,
    difference_in_words,
)
from thalweg.planning.passage_alternatives import passage_alternatives
from thalweg.planning.plan import Plan
from thalweg.planning.voyage import Voyage
from thalweg.route import Route, RouteFileOptions, write_route_files
from thalweg.route.indicator_columns import indicator_value

_INSHORE, _OFFSHORE = 50.0, 15.0  # share of the length near land above and below which [%]
_OBJECTIVES: Final = ("time", "fuel", "comfort", "encounters", "inshore", "distance")
_PASSAGE_WAYS: Final = 3  # other ways round passages that are planned
_WIDER_OFFING: Final = 4.0  # nm, of the route that is sought farther off land
_SAMPLES: Final = 60
_APART: Final = 0.02  # of the length: routes this far apart somewhere differ ...
_LEAST_APART: Final = 1.0 * NAUTICAL_MILE  # ... but not below this [m]
_SLOWER: Final = 0.05  # routes on the same way differ where one takes this share longer


@dataclass(frozen=True, eq=False)
class RouteChoice:
    """One of several routes of a voyage.

    Attributes
    ----------
    name : Such as ``"inshore by the Naeroysund"``.
    best_in : What it is best in among the choices, in words.
    difference : From the fastest one, in words.
    passes : Named passages and capes that it passes, in order.
    """

    name: str
    route: Route
    best_in: tuple[str, ...]
    difference: str
    passes: tuple[str, ...]

    def to_dict(self) -> dict[str, Any]:
        """Return plain data, ready for JSON."""
        return {
            "name": self.name,
            "best_in": list(self.best_in),
            "difference": self.difference,
            "passes": list(self.passes),
            "figures": all_figures(self.route),
            "route": self.route.as_dict(),
        }


@dataclass(frozen=True, eq=False)
class AlternativePlans:
    """Routes of a voyage that differ, the fastest first.

    Attributes
    ----------
    voyage : The request.
    choices : 1 to 5 routes.
    slack_h : Time to the latest arrival of the voyage for each [h]; None without one.
    notes : Which candidates were planned, and which could not.
    """

    voyage: Voyage
    choices: tuple[RouteChoice, ...]
    slack_h: tuple[float | None, ...]
    notes: tuple[str, ...]

    def rows(self) -> list[dict[str, Any]]:
        """Return one row for each route.

        Returns
        -------
        list of dict
            Names, words and all indicators with their units; None where unknown.
        """
        return [
            {
                "name": one.name,
                "best_in": ", ".join(one.best_in),
                "difference": one.difference,
                "passes": ", ".join(one.passes),
                "slack_h": slack,
                **all_figures(one.route),
            }
            for one, slack in zip(self.choices, self.slack_h)
        ]

    def to_dict(self) -> dict[str, Any]:
        """Return plain data, ready for JSON.

        Returns
        -------
        dict
            The voyage, the routes with their figures, and the notes.
        """
        return {
            "voyage": self.voyage.to_dict(),
            "alternatives": [one.to_dict() for one in self.choices],
            "slack_h": list(self.slack_h),
            "notes": list(self.notes),
        }

    def write(self, folder: str | Path, options: RouteFileOptions | None = None) -> list[Path]:
        """Write alternatives.json, alternatives.csv and the route files of each.

        Parameters
        ----------
        folder : path
            Made where it does not exist.
        options : RouteFileOptions, optional
            Formats and waypoints of the route files.

        Returns
        -------
        list of Path
        """
        folder = make_folder(folder)
        text = json.dumps(self.to_dict(), indent=2, allow_nan=False)
        write_text(folder / "alternatives.json", text + "\n")
        rows = self.rows()
        names = list(dict.fromkeys(name for row in rows for name in row))
        table: list[list[Any]] = [names, *([row.get(name) for name in names] for row in rows)]
        write_csv_rows(folder / "alternatives.csv", table)
        files = [folder / "alternatives.json", folder / "alternatives.csv"]
        for number, one in enumerate(self.choices, start=1):
            files += write_route_files(one.route, folder, f"alternative_{number}", options)
        return files

    def __str__(self) -> str:
        lines = []
        for number, one in enumerate(self.choices, start=1):
            best = f" [{', '.join(one.best_in)}]" if one.best_in else ""
            lines.append(f"{number}. {one.name}{best}: {one.difference}")
        return "\n".join(lines)


def alternative_plans(
    voyage: Voyage, plan_one: Callable[[Voyage], Plan], *, most: int = 5
) -> AlternativePlans:
    """Plan a voyage for several objectives and by several ways, and choose routes that differ.

    Parameters
    ----------
    voyage : Voyage
        The request; its objective is not used.
    plan_one : callable
        Plans a voyage, such as ``functools.partial(plan, ship=ship, sea=sea)``.
    most : int
        Greatest number of routes, 2 to 5.

    Returns
    -------
    AlternativePlans

    Raises
    ------
    InputError
        If ``most`` is out of range.
    NoRouteError
        If the voyage has no route at all.

    Notes
    -----
    Candidates are the best routes by time, fuel, comfort, encounters, length near land and
    distance, as far as they are known for this ship and chart, those of a weighted sum of all,
    those round the passages of the fastest one, and those farther off land. Chosen are the best
    in one figure after the other (`thalweg.planning.indicators.route_figures`) that differ from
    those chosen before, in water or in time.
    """
    if not 2 <= most <= 5:
        raise InputError(
            f"{most} alternatives were requested.",
            "There are 2 to 5.",
            "Give such a number.",
            field="most",
        )
    plain = replace(voyage, objective="time", weights={})
    fastest = plan_one(plain)
    plans, notes = [fastest], []
    for words, request in _requests(plain, fastest):
        try:
            plans.append(plan_one(request))
        except NoRouteError as error:
            notes.append(f"No route {words}: {error.args[0]}")
        except InputError as error:
            if words not in _OPTIONAL:
                raise
            notes.append(f"No route {words}: {error.args[0]}")
    routes = [route for plan in plans for route in _candidates(plan) if route.feasible]
    chosen = _chosen(routes or [fastest.best], most)
    latest = voyage.arrive_by
    slack = [
        None if latest is None else (float(latest) - route.arrive) / HOUR  # type: ignore[arg-type]
        for route in chosen
    ]
    return AlternativePlans(voyage, _named(chosen, fastest), tuple(slack), tuple(notes))


_OPTIONAL: Final = frozenset(
    {*(f"of least {name}" for name in _OBJECTIVES), "of a weighted sum", "farther off land"}
)


def _requests(plain: Voyage, fastest: Plan) -> list[tuple[str, Voyage]]:
    """Return the voyages that are planned besides that of least time, with words for each."""
    best = fastest.best
    known = [
        name
        for name in _OBJECTIVES[1:]
        if np.isfinite(indicator_value(best, "inshore_nm" if name == "inshore" else name))
    ]
    found = [(f"of least {name}", replace(plain, objective=name)) for name in known]  # type: ignore[arg-type]
    mixed = [name for name in ("time", "fuel", "comfort", "encounters") if name in (*known, "time")]
    if len(mixed) > 1:
        weights: dict[str, float] = {name: 1.0 for name in mixed}
        found.append(("of a weighted sum", replace(plain, objective="weighted", weights=weights)))
    wider = max(_WIDER_OFFING, 2.0 * (plain.offing_nm or 0.0))
    if plain.offing_nm is None or plain.offing_nm < _WIDER_OFFING:
        found.append(("farther off land", replace(plain, offing_nm=wider)))
    for way in passage_alternatives(fastest)[: _PASSAGE_WAYS + 1]:
        if way.without:
            names = tuple(dict.fromkeys((*plain.avoid, *way.without)))
            found.append((f"without {', '.join(way.without)}", replace(plain, avoid=names)))
    return found


def _candidates(plan: Plan) -> list[Route]:
    """Return the routes that may be chosen: the best, and the ends and knee of a front."""
    from thalweg.planning.plan_front import knee

    if plan.front is None or len(plan.routes) < 3:
        return list(plan.routes)
    order = np.argsort([route.time_h for route in plan.routes])
    times = np.array([plan.routes[k].time_h for k in order])
    middle = int(order[knee(times, np.asarray(plan.front.values)[order])])
    picked = dict.fromkeys([0, int(order[0]), middle, int(order[-1])])
    return [plan.routes[k] for k in picked]


def _chosen(routes: Sequence[Route], most: int) -> list[Route]:
    """Return routes that differ, the best in one figure after the other, the fastest first."""
    values = [compared_values(route) for route in routes]
    best = champions(values)
    order = list(dict.fromkeys([best.get("time", 0), *best.values()]))
    lines = [_line(route) for route in routes]
    found: list[int] = []
    for same_way_too in (False, True):
        for k in order:
            if len(found) == most or k in found:
                continue
            apart = all(_differ(lines[k], lines[j]) for j in found)
            slower = all(
                _differ(lines[k], lines[j])
                or abs(routes[k].time_h / routes[j].time_h - 1.0) > _SLOWER
                for j in found
            )
            if apart or (same_way_too and slower):
                found.append(k)
    return sorted((routes[k] for k in found), key=lambda route: route.time_h)


def _line(route: Route) -> tuple[FloatArray, FloatArray]:
    """Return positions at equal shares of the length of a route [deg]."""
    at = route.samples
    share = np.linspace(at["distance"][0], at["distance"][-1], _SAMPLES)
    lon = np.degrees(np.unwrap(np.radians(at["lon"])))
    lat = np.interp(share, at["distance"], at["lat"])
    return lat, np.interp(share, at["distance"], lon)


def _differ(one: tuple[FloatArray, FloatArray], other: tuple[FloatArray, FloatArray]) -> bool:
    """Return whether two routes are far apart somewhere: each position to the nearest other."""
    lat, lon = one
    away = np.asarray(distance(lat[:, None], lon[:, None], other[0][None, :], other[1][None, :]))
    steps = np.asarray(distance(lat[:-1], lon[:-1], lat[1:], lon[1:]))
    length = float(steps.sum())
    grid = 0.5 * length / (_SAMPLES - 1)  # positions of one line are this far from the other's
    return float(away.min(axis=1).max()) - grid > max(_APART * length, _LEAST_APART)


def _named(chosen: Sequence[Route], fastest: Plan) -> tuple[RouteChoice, ...]:
    """Return the chosen routes with names, what each is best in, and differences in words."""
    values = [compared_values(route) for route in chosen]
    best = champions(values)
    passes = [_passes(route, fastest) for route in chosen]
    common = set.intersection(*(set(names) for names in passes))
    labels = [
        _label(route, [name for name in names if name not in common])
        for route, names in zip(chosen, passes)
    ]
    found = []
    for k, route in enumerate(chosen):
        words = tuple(COMPARED_FIGURES[name].words for name, j in best.items() if j == k)
        name = labels[k]
        if labels.count(name) > 1:
            name = f"{name}, {words[0] if words else f'number {k + 1}'}"
        difference = difference_in_words(values[k], values[0]) if k else "the fastest"
        found.append(RouteChoice(name, route, words, difference, passes[k]))
    return tuple(found)


def _passes(route: Route, plan: Plan) -> tuple[str, ...]:
    chart = plan.plot_context.chart if plan.plot_context is not None else None
    if chart is None or not hasattr(chart, "passages"):
        return ()
    track = route.track
    lat, lon = np.asarray(track.lat, float), np.asarray(track.lon, float)
    return names_passed(chart.coastline, chart.passages, lat, lon)


def _label(route: Route, names: Sequence[str]) -> str:
    """Return how a route goes: near land or far from it, and by which passages."""
    share = indicator_value(route, "inshore_percent")
    where = (
        "inshore" if share >= _INSHORE else "offshore" if share <= _OFFSHORE else "along the coast"
    )
    where = "direct" if not np.isfinite(share) else where
    by = " and the ".join(names[:2])
    return f"{where} by the {by}" if by else where
