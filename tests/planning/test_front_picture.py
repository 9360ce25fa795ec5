"""The picture of a front: its axes show the routes, and state a bound that is far below them."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from thalweg.planning.plan_front import ParetoFront
from thalweg.planning.plots.pareto_front_plot import draw_pareto_front
from thalweg.planning.report.plan_summary import _choice

TIMES = np.linspace(192.0, 198.0, 13)
VALUES = 100_000.0 + 400.0 * (198.0 - TIMES) ** 2


def picture(certain, values=VALUES, figure=("cost", "USD"), times=TIMES, blind=None):
    """Return the axes of the picture of a front with a bound, and perhaps a weather-blind route."""
    n = len(times)
    front = ParetoFront(
        *figure, values, ("exact",) * n, ("open sea",) * n, certain=np.array(certain)
    )
    if blind is not None:
        route = SimpleNamespace(time_h=blind[0], feasible=True, arrive=0.0)
        front = replace(front, comparison=SimpleNamespace(routes=[route], values=[blind[1]]))
    routes = tuple(SimpleNamespace(time_h=t, feasible=True, arrive=0.0) for t in times)
    voyage = SimpleNamespace(objective="front", arrive_by=None)
    plan = SimpleNamespace(
        front=front, routes=routes, voyage=voyage, provenance={"from": "Here", "to": "There"}
    )
    return draw_pareto_front(plan).axes[0]


def test_a_weak_bound_does_not_squeeze_the_routes():
    """A bound of half the cost took two thirds of the axis."""
    axes = picture([[185.0, 200.0], [60_000.0, 50_000.0]])
    (low, high), (west, east) = axes.get_ylim(), axes.get_xlim()
    assert np.ptp(VALUES) > 0.65 * (high - low) and np.ptp(TIMES) > 0.8 * (east - west)
    words = [text.get_text() for text in axes.texts]
    least = np.interp(198.0, [185.0, 200.0], [60_000.0, 50_000.0])
    first = f"no route of 198.0 h can be below {least:,.0f} USD:"
    assert f"{first}\nat most 48.7 % less than the one found" in words
    assert (
        "no route can be faster than 185.0 h:\nat most 3.6 % less than the fastest found" in words
    )


def test_a_bound_close_to_the_routes_is_shown_whole():
    axes = picture([TIMES, VALUES - 500.0])
    (bound,) = [
        line
        for line in axes.lines
        if line.get_label().startswith("no route at these speeds can be")
    ]
    assert bound.get_ydata().min() > axes.get_ylim()[0]
    assert not any("at most" in text.get_text() for text in axes.texts)


@pytest.mark.parametrize("least", [50_000.0, 99_000.0])
def test_labels_cover_neither_each_other_nor_the_legend(least):
    axes = picture([[185.0, 200.0], [least, least]])
    boxes = [text.get_window_extent() for text in axes.texts]
    boxes.append(axes.get_legend().get_window_extent())
    assert len(boxes) >= 4
    for number, box in enumerate(boxes):
        assert not any(box.overlaps(other) for other in boxes[:number])
    points = axes.transData.transform(np.column_stack([TIMES, VALUES]))
    for box in boxes:
        assert not any(box.contains(x, y) for x, y in points)


@pytest.mark.filterwarnings("error")
def test_a_front_of_any_key_figure_has_a_picture():
    """`plan --objective inshore --out` ended with an error."""
    axes = picture(np.empty((2, 0)), np.zeros(len(TIMES)), ("inshore", "nm"))
    assert axes.get_ylabel() == "inshore [nm]"
    assert axes.get_ylim()[0] < 0.0 < axes.get_ylim()[1]
    assert picture(np.empty((2, 0)), figure=("encounters", "")).get_ylabel() == "encounters"


def test_the_legend_covers_no_mark_of_a_front_of_one_route():
    """The weather-blind route lay under it, with later and dearer ones alone in their corner."""
    blind = (196.0, 1_310_000.0)
    bound = [[185.0, 200.0], [1_200_000.0, 1_190_000.0]]
    axes = picture(bound, np.array([1_250_000.0]), times=np.array([195.0]), blind=blind)
    legend = axes.get_legend().get_window_extent()
    for place in (blind, (195.0, 1_250_000.0)):
        x, y = axes.transData.transform(place)
        assert not legend.padded(8.0).contains(x, y)
        assert axes.get_window_extent().contains(x, y)
    assert "only route: 195.0 h, 1,250,000 USD" in [text.get_text() for text in axes.texts]


def test_axes_have_whole_numbers_without_a_factor():
    """A bare 1e6 stood above the axis."""
    axes = picture(np.empty((2, 0)), 12.0 * VALUES)
    axes.figure.draw_without_rendering()
    for axis in (axes.xaxis, axes.yaxis):
        assert axis.get_offset_text().get_text() == ""
    assert "1,250,000" in [text.get_text() for text in axes.get_yticklabels()]


def test_picture_and_summary_call_a_route_by_one_word():
    """The summary had "between" where the picture had "knee"."""
    axes = picture(np.empty((2, 0)))
    words = {text.get_text().partition(":")[0] for text in axes.texts}
    assert {"fastest", "knee", "least cost"} <= words
    n = len(TIMES)
    front = ParetoFront("cost", "USD", VALUES, ("exact",) * n, ("open sea",) * n)
    plan = SimpleNamespace(front=front, routes=[SimpleNamespace(time_h=t) for t in TIMES])
    named = [part.split()[0] for part in _choice(plan).split("; ")]
    assert named == ["fastest", "knee", "least"]
