"""Space-time diagram: closed periods against the analytic tide, and what is drawn."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, Voyage, evaluate, plan
from thalweg.core.errors import InputError
from thalweg.planning.plots.channel_closures import find_closures
from thalweg.planning.plots.space_time_diagram import (
    _window_limits,
    draw_space_time_diagram,
    write_space_time_diagram,
)

M2 = 12.4206012 * 3600.0
LOW = 1767236400.0  # 2026-01-01T03:00Z
BED, LEVEL = "sea_floor_depth_below_geoid", "sea_surface_height_above_geopotential_datum"
EAST, NORTH = "eastward_sea_water_velocity", "northward_sea_water_velocity"
AREA = (51.6, 51.9, 3.40, 3.75)
WEST_RIM, EAST_RIM = 3.55, 3.60


def tide(time):
    """Return the level [m]: low water at LOW."""
    return -1.5 * np.cos(2.0 * np.pi * (np.asarray(time) - LOW) / M2)


def bar(**more) -> Sea:
    """Return 15 m of water with a bar of 7 m, and the tide."""
    return Sea.from_functions(
        {
            BED: lambda t, y, x: np.where((x > WEST_RIM) & (x < EAST_RIM), 7.0, 15.0) + 0.0 * y,
            LEVEL: lambda t, y, x: tide(t) + 0.0 * y,
            **more,
        }
    )


SHIP = Ship.simple(speed_kn=10.0, draught_m=6.5)
TRACK = [(51.75, 3.45), (51.75, 3.70)]


def test_closed_periods_are_those_of_the_tide() -> None:
    route = evaluate(TRACK, ship=SHIP, sea=bar(), depart=LOW + 5 * 3600.0, min_ukc=1.0)
    times = LOW + np.linspace(-0.5, 1.5, 401) * M2
    found = find_closures(route, ship=SHIP, sea=bar(), min_ukc=1.0, times=times, places=100)
    lon = np.interp(found.distance, route.samples["distance"], route.samples["lon"])
    on_bar = (lon > WEST_RIM) & (lon < EAST_RIM)
    assert 15 < on_bar.sum() < 25  # a fifth of the track
    depth = np.where(on_bar, 7.0, 15.0)[:, None] + tide(times)[None, :]
    assert np.array_equal(found.shallow, depth < 6.5 + 1.0)
    assert found.clearance == pytest.approx(depth - 6.5, abs=1e-9)
    assert not found.strong.any() and not found.unknown.any()
    # 7 + level >= 7.5: the bar is open while cos(phase) < -1/3
    share = 1.0 - np.arccos(-1.0 / 3.0) / np.pi
    open_share = 1.0 - found.closed[on_bar].mean()
    assert open_share == pytest.approx(share, abs=0.005)
    assert np.isclose(share, 0.3918, atol=1e-4)


def test_a_current_too_strong_closes_the_track_only_while_it_runs() -> None:
    """10 kn are 5.144 m/s; a stream of 6 m/s runs to and fro along the track."""
    stream = bar(
        **{
            EAST: lambda t, y, x: 6.0 * np.sin(2.0 * np.pi * (t - LOW) / M2) + 0.0 * x,
            NORTH: lambda t, y, x: 0.0 * x,
        }
    )
    route = evaluate(
        [(51.75, 3.45), (51.75, 3.53)], ship=SHIP, sea=stream, depart=LOW, min_ukc=1.0, strict=False
    )
    times = LOW + np.linspace(0.0, 1.0, 200, endpoint=False) * M2
    found = find_closures(route, ship=SHIP, sea=stream, min_ukc=1.0, times=times, places=5)
    against = 6.0 * np.sin(2.0 * np.pi * (times - LOW) / M2) <= -10.0 * 1852.0 / 3600.0
    assert np.array_equal(found.strong, np.broadcast_to(against, found.strong.shape))
    assert against.sum() == pytest.approx(200 * np.arccos(10 * 1852 / 3600 / 6.0) / np.pi, abs=1.5)
    assert not found.shallow.any()


def test_unknown_water_is_neither_open_nor_shallow() -> None:
    half = Sea.from_functions(
        {
            BED: lambda t, y, x: np.where(x < 3.603, 20.0, np.nan) + 0.0 * y,
            LEVEL: lambda t, y, x: 0 * x,
        }
    )
    route = evaluate(TRACK, ship=SHIP, sea=half, depart=LOW, min_ukc=1.0, strict=False)
    found = find_closures(route, ship=SHIP, sea=half, min_ukc=1.0, places=50)
    lon = 3.45 + 0.25 * found.distance / found.distance[-1]
    assert np.array_equal(
        found.unknown, np.broadcast_to((lon > 3.603)[:, None], found.unknown.shape)
    )
    assert np.array_equal(found.closed, found.unknown)


def test_the_chart_counts_as_well_as_the_sea() -> None:
    chart = Chart.open_water(*AREA).with_depth(lambda y, x: np.where(x < 3.5, 5.0, 30.0) + 0.0 * y)
    route = evaluate(TRACK, ship=SHIP, sea=bar(), chart=chart, depart=LOW)
    found = find_closures(route, ship=SHIP, sea=bar(), chart=chart, places=50)
    start = found.distance < 0.15 * found.distance[-1]
    expected = np.broadcast_to(5.0 + tide(found.times) < 6.5, found.shallow[start].shape)
    assert np.array_equal(found.shallow[start], expected)
    assert expected.any()


@pytest.fixture(scope="module")
def waiting():
    voyage = Voyage(offing_nm=0.0,
        start=(51.71, 3.45), goal=(51.77, 3.70), depart=LOW, min_ukc_m=1.0,
        arrive_by="2026-01-01T10:30Z",
    )  # fmt: skip
    return plan(voyage, ship=SHIP, sea=bar(), chart=Chart.open_water(*AREA), resolution=1000.0)


@pytest.mark.slow
def test_the_route_avoids_closed_periods(waiting) -> None:
    """Every fine sample of the route lies in an open period of its own diagram."""
    best = waiting.best
    samples = best.samples
    found = find_closures(
        best, ship=SHIP, sea=bar(), min_ukc=1.0, times=np.unique(samples["time"]), places=3000
    )
    column = np.searchsorted(found.times, samples["time"])
    row = np.abs(found.distance[:, None] - samples["distance"][None, :]).argmin(axis=0)
    near = np.abs(found.distance[row] - samples["distance"]) < 1.0
    assert near.sum() > 20
    assert not found.closed[row[near], column[near]].any()
    assert found.closed.any()


def test_diagrams_of_plans_and_routes(waiting, tmp_path) -> None:
    figure = draw_space_time_diagram(waiting, tmp_path / "plan.png")
    told = [text.get_text() for text in figure.legends[0].get_texts()]
    assert told == ["too little water", "ship", f"waits {waiting.best.waiting_h:.2f} h in total",
                    "arrive by"]  # fmt: skip
    left, right = figure.axes[0].get_xlim()
    assert left < 0.0 and right > 7.5  # the latest arrival is in the picture
    assert (tmp_path / "plan.png").stat().st_size > 10_000
    draw_space_time_diagram(waiting.best, tmp_path / "route.png", ship=SHIP, sea=bar(), min_ukc=1.0)
    assert (tmp_path / "route.png").exists()
    with pytest.raises(InputError, match="not given"):
        draw_space_time_diagram(waiting.best)


@pytest.mark.slow
def test_it_is_written_only_where_the_tide_matters(waiting, tmp_path) -> None:
    assert write_space_time_diagram(waiting, tmp_path) == [tmp_path / "st.png"]
    deep = Sea.from_functions(
        {BED: lambda t, y, x: 30.0 + 0.0 * y, LEVEL: lambda t, y, x: tide(t) + 0.0 * y}
    )
    voyage = Voyage(
        offing_nm=0.0, start=(51.71, 3.45), goal=(51.77, 3.70), depart=LOW, min_ukc_m=1.0
    )
    chart = Chart.open_water(*AREA)
    assert write_space_time_diagram(plan(voyage, ship=SHIP, sea=deep, chart=chart), tmp_path) == []
    calm = Voyage(offing_nm=0.0, start=(51.71, 3.45), goal=(51.77, 3.70), depart=LOW)
    assert (
        write_space_time_diagram(plan(calm, ship=SHIP, sea=Sea.calm(), chart=chart), tmp_path) == []
    )


@pytest.mark.slow
def test_a_window_of_departure_is_drawn() -> None:
    voyage = Voyage(offing_nm=0.0,
        start=(51.71, 3.45), goal=(51.77, 3.70), min_ukc_m=1.0,
        depart_window=("2026-01-01T03:00Z", "2026-01-01T09:00Z"),
    )  # fmt: skip
    found = plan(voyage, ship=SHIP, sea=bar(), chart=Chart.open_water(*AREA), resolution=1000.0)
    figure = draw_space_time_diagram(found)
    assert "departure window" in [text.get_text() for text in figure.legends[0].get_texts()]


def test_a_voyage_of_a_given_arrival_has_no_window_of_departure() -> None:
    """Its files were not written: "None is not a time"."""
    arriving = Voyage(start=(0.0, 0.0), goal=(0.0, 1.0), arrive="2026-03-02T06:00Z")
    assert _window_limits(arriving) == []
    departing = Voyage(start=(0.0, 0.0), goal=(0.0, 1.0), depart=3600.0, arrive_by=9e4)
    assert _window_limits(departing) == [3600.0, 3600.0, 9e4]


def test_the_diagram_of_a_latest_departure_has_no_window(waiting) -> None:
    """The plan stopped with "None is not a time" after it had been found."""
    given = Voyage(start=TRACK[0], goal=TRACK[1], arrive=LOW + 86400.0)
    figure = draw_space_time_diagram(replace(waiting, voyage=given))
    labels = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    assert "ship" in labels and "departure window" not in labels


def test_a_latest_arrival_beyond_the_diagram_is_not_in_its_legend(waiting) -> None:
    far = Voyage(start=TRACK[0], goal=TRACK[1], depart=LOW, arrive_by=LOW + 30 * 86400.0)
    figure = draw_space_time_diagram(replace(waiting, voyage=far))
    labels = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    assert "arrive by" not in labels
