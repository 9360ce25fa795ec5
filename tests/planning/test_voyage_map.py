"""Maps: lines without jumps, the best route on top, labels, bars of colours, water to check."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.collections import LineCollection
from matplotlib.quiver import Quiver

from tests.conftest import data_file
from thalweg import Chart, Sea, Ship, Track, Voyage, evaluate, plan
from thalweg.core.arrays.shown_arrows import shown_arrows
from thalweg.core.file_writing import new_figure
from thalweg.core.time import parse_time
from thalweg.planning.plan_front import ParetoFront
from thalweg.planning.plots import routes_on_map
from thalweg.planning.plots.alternatives_map import draw_alternatives_map
from thalweg.planning.plots.map_extent import (
    MapExtent,
    degree_label,
    inverse_mercator,
    mercator,
)
from thalweg.planning.plots.map_labels import (
    LabelPlacer,
    at_other_places,
    marked_times,
    time_label,
)
from thalweg.planning.plots.map_overlays import _draw_arrow, draw_zones, place_labels
from thalweg.planning.plots.route_profile import LIMIT_COLOUR, draw_profile
from thalweg.planning.plots.voyage_map import draw_map, time_when_nearest

SHIP = Ship.simple(speed_kn=12.0, draught_m=5.0)


@pytest.mark.parametrize("turns", [-360.0, 0.0, 360.0])
def test_a_line_longer_than_half_the_world_has_no_jump(turns):
    box = MapExtent(-30.0, 89.0, -260.0, 20.0)
    lon = np.linspace(4.0, -250.0, 60)
    wrapped = (lon + 180.0) % 360.0 - 180.0 + turns
    assert box.line(wrapped) == pytest.approx(lon)


@pytest.mark.slow
def test_maps_across_the_antimeridian(tmp_path):
    chart = Chart.open_water(-20.0, -10.0, 170.0, -170.0).with_depth(
        lambda lat, lon: 40.0 + 10.0 * np.sin(lat) + 0.0 * lon
    )
    voyage = Voyage(start=(-15.0, 178.5), goal=(-14.0, -178.5), depart="2026-01-01")
    found = plan(voyage, ship=SHIP, sea=Sea.calm(), chart=chart)
    figure = draw_map(found, tmp_path / "map.png")
    axes = figure.axes[0]
    lines = [line.get_xdata() for line in axes.lines if len(line.get_xdata()) > 2]
    assert lines and all(np.abs(np.diff(x)).max() < 2.0 for x in lines)
    lines_of_summary = str(found).splitlines()
    departs, arrives = (line.split(maxsplit=1)[1] for line in lines_of_summary[1:3])
    arrives, lasts = arrives.split(", after ")
    title = axes.get_title(loc="left")
    assert f"depart {departs}, arrive {arrives}" in title and f": {lasts}, " in title
    west, east = axes.get_xlim()
    assert all(west <= x.min() and x.max() <= east for x in lines)
    assert figure.axes[1].get_ylabel() == "water depth when the ship is nearest [m]"
    profile = draw_profile(found.best, tmp_path / "profile.png")
    assert [a.get_ylabel() for a in profile.axes] == ["speed [kn]", "clearance [m]"]
    assert (tmp_path / "map.png").stat().st_size > 10_000


def test_weather_is_shown_at_the_time_when_the_ship_is_nearest():
    """It was that of the earliest passage at full speed, or of the departure where no ship came."""
    track = Track([0.0, 0.0], [0.0, 2.0], parse_time("2026-01-01"), [3600.0, 0.0], [0])
    route = evaluate(track, ship=SHIP, sea=Sea.calm(), chart=Chart.open_water(-2.0, 2.0, -1.0, 3.0))
    lat, lon = np.array([[1.0, 0.0, -1.0]]), np.array([[1.0, 0.0, 362.0]])
    found = time_when_nearest(route, lat, lon) - route.depart
    assert found[0, 0] == pytest.approx(
        3600.0 + 0.5 * (route.arrive - route.depart - 3600.0), abs=300.0
    )
    assert found[0, 1] == pytest.approx(3600.0)  # when she leaves the place of the wait
    assert found[0, 2] == pytest.approx(route.arrive - route.depart)


def lines_in_a_map(figure, south, north, west, east):
    """Return how many points of contour lines lie in a box."""
    from matplotlib.contour import ContourSet

    points = [
        np.concatenate([path.vertices for path in found.get_paths()])
        for found in figure.axes[0].collections
        if isinstance(found, ContourSet) and not found.filled
    ]
    x, y = np.concatenate(points).T
    return int(((x > west) & (x < east) & (y > south) & (y < north)).sum())


@pytest.mark.slow
def test_isochrones_end_at_land_outside_a_mesh():
    """Coronado is a hole in the mesh of San Diego Bay, and there is no coastline."""
    path = data_file("tide/adh_sandiego_waterlevel_ugrid_30min.nc")
    sea = Sea.open(path, mapping={"crs": "EPSG:32611"})
    voyage = Voyage(
        start=(32.65, -117.25), goal=(32.70, -117.165), depart="2000-01-01T01:00Z", min_ukc_m=0.5
    )
    chart = Chart.open_water(32.5, 32.8, -117.4, -117.0)
    found = plan(voyage, ship=Ship.load("hopper-dredger"), sea=sea, chart=chart, network="mesh")
    figure = draw_map(found)
    assert lines_in_a_map(figure, 32.695, 32.705, -117.205, -117.190) == 0
    assert lines_in_a_map(figure, 32.640, 32.680, -117.235, -117.190) > 10


def test_mercator_is_conformal_and_undone_by_its_inverse():
    lat = np.linspace(-74.0, 74.0, 75)
    np.testing.assert_allclose(inverse_mercator(mercator(lat)), lat, atol=1e-9)
    step = (mercator(lat + 1e-4) - mercator(lat - 1e-4)) / 2e-4
    np.testing.assert_allclose(step, 1.0 / np.cos(np.radians(lat)), rtol=1e-6)
    box = MapExtent(40.0, 60.0, -10.0, 10.0)
    assert box.is_mercator and not MapExtent(40.0, 80.0, 0.0, 1.0).is_mercator
    ordinates = mercator(box.grid(3, 50)[0][:, 0])
    np.testing.assert_allclose(np.diff(ordinates), np.diff(ordinates)[0])


def test_degrees_and_minutes_on_the_axes():
    assert degree_label(51.7, "NS") == "51°42'N" and degree_label(-4.05, "EW") == "4°03'W"
    assert degree_label(181.0, "EW") == "179°W" and degree_label(0.0, "NS") == "0°"


def test_times_are_round_hours_in_utc():
    times, step = marked_times(parse_time("2026-01-01T05:10Z"), parse_time("2026-01-02T03:00Z"))
    assert step == 3 * 3600.0
    assert [time_label(t, step) for t in times[:2]] == ["1 Jan 06:00", "1 Jan 09:00"]
    times, step = marked_times(0.0, 40 * 86400.0)
    assert len(times) <= 9 and time_label(times[1], step) in ("5 Jan", "11 Jan")


@pytest.fixture(scope="module")
def lagoon():
    """A plan beside an island with a lagoon, a closed area and the storm of the package."""
    outer = [[2.3, 51.2], [2.7, 51.2], [2.7, 51.6], [2.3, 51.6], [2.3, 51.2]]
    inner = [[2.4, 51.3], [2.4, 51.5], [2.6, 51.5], [2.6, 51.3], [2.4, 51.3]]
    chart = Chart.from_geojson({"type": "Polygon", "coordinates": [outer, inner]})
    area = [[2.0, 51.0], [2.1, 51.0], [2.1, 51.1], [2.0, 51.1], [2.0, 51.0]]
    zone = {"type": "Feature", "properties": {"kind": "no-go"}}
    chart = chart.with_zones(zone | {"geometry": {"type": "Polygon", "coordinates": [area]}})
    voyage = Voyage(start=(51.4, 2.0), goal=(51.4, 3.0), depart="1998-08-30T05:10Z")
    chart = chart.within(50.5, 52.0, 1.0, 4.0)
    return plan(voyage, ship=SHIP, sea=Sea.storm(), chart=chart, resolution=5000.0)


@pytest.mark.slow
def test_labels_do_not_lie_on_each_other(lagoon):
    figure = draw_map(lagoon)
    axes = figure.axes[0]
    boxes = [text.get_window_extent() for text in axes.texts if text.get_zorder() == 10]
    assert len(boxes) >= 4
    for number, box in enumerate(boxes):
        assert not any(box.overlaps(other) for other in boxes[:number])
    words = [text.get_text() for text in axes.texts]
    assert "30 Aug 06:00" in words and any(word.endswith("nm") for word in words)
    assert "depart 1998-08-30 05:10 UTC" in axes.get_title(loc="left")


def labels_of_control_areas(box):
    """Return the axes of a map without a route, and the labels that it shows."""
    figure = new_figure(*box.figure_size())
    axes = figure.add_subplot()
    box.set_up(axes)
    labels = draw_zones(axes, Chart.gshhg("c"), box)
    figure.draw_without_rendering()
    place_labels(LabelPlacer(axes, np.zeros((0, 2))), labels)
    return axes, [text for text in axes.texts if text.get_text().startswith("ECA")]


def test_control_areas_have_a_label_where_their_outline_shows():
    """The outline of the Mediterranean area is on land in a map from the Red Sea to Bengal."""
    assert not labels_of_control_areas(MapExtent(-3.0, 31.0, 32.7, 98.5))[1]
    caribbean = labels_of_control_areas(MapExtent(15.0, 21.0, -70.0, -60.0))[1]
    assert [label.get_text() for label in caribbean] == ["ECA US Caribbean"]
    axes, labels = labels_of_control_areas(MapExtent(33.0, 39.0, -10.0, 0.0))
    assert [label.get_text() for label in labels] == ["ECA Mediterranean"]
    inside, box = axes.get_window_extent(), labels[0].get_window_extent()
    assert inside.x0 <= box.x0 and box.x1 <= inside.x1
    assert inside.y0 <= box.y0 and box.y1 <= inside.y1


def test_labels_of_areas_stay_inside_the_axes():
    axes = new_figure(4, 3).add_subplot()
    axes.set_xlim(0.0, 1.0)
    axes.set_ylim(0.0, 1.0)
    axes.figure.draw_without_rendering()
    placer, name = LabelPlacer(axes, np.zeros((0, 2))), "a name that is wider than these axes" * 3
    assert not placer.place(name, 0.5, 0.99)
    assert placer.place(name, 0.5, 0.99, needed=True)


@pytest.mark.slow
def test_enclosed_water_is_hatched_and_the_sea_is_not(lagoon):
    from matplotlib.contour import ContourSet

    axes = draw_map(lagoon).axes[0]
    hatched = [
        found
        for found in axes.collections
        if isinstance(found, ContourSet) and any(found.hatches or [])
    ]
    x, y = np.concatenate([p.vertices for found in hatched for p in found.get_paths()]).T
    assert x.min() > 2.35 and x.max() < 2.65 and y.min() > 51.25 and y.max() < 51.55


@pytest.mark.slow
def test_a_route_beside_that_of_the_plan_is_drawn(lagoon):
    axes = draw_map(lagoon, beside=lagoon.best).axes[0]
    labels = [line.get_label() for line in axes.lines]
    assert "shortest route" in labels and "route, times in UTC" in labels  # a calm sea


def test_profiles_have_times_in_utc_and_state_that_no_depth_is_known(lagoon):
    profile = draw_profile(lagoon.best)
    assert profile.axes[-1].get_xlabel() == "UTC, departure 1998-08-30 05:10"
    assert "30 Aug 06:00" in [tick.get_text() for tick in profile.axes[-1].get_xticklabels()]
    assert "not known" in profile.axes[-1].texts[0].get_text()


def test_profiles_show_limits_of_weather_that_are_half_reached():
    names = "eastward_wind", "northward_wind", "sea_surface_wave_significant_height"
    sea = Sea.from_functions(
        {name: (lambda t, lat, lon, v=v: v) for name, v in zip(names, (10.0, 0.0, 2.0))},
        time_step=3600.0,
    )
    ship = Ship.simple(speed_kn=12.0, draught_m=5.0, max_wave_height_m=4.0, max_wind_speed_kn=45.0)
    route = evaluate(
        [(0.0, 0.0), (0.0, 0.5)], ship=ship, sea=sea, depart="2026-01-01", chart=Chart.open_water()
    )
    _, wind, waves, _ = draw_profile(route, limits=ship.limits).axes
    assert waves.get_legend_handles_labels()[1] == ["significant wave height", "limit: 4 m"]
    assert waves.get_ylim()[1] == pytest.approx(4.4)
    assert wind.get_legend_handles_labels()[1] == ["wind"]  # 19 of 45 kn
    _, _, plain, _ = draw_profile(route).axes
    assert plain.get_legend_handles_labels()[1] == ["significant wave height"]


@pytest.mark.slow
def test_arrows_are_those_of_the_strong_currents():
    """Currents near zero have none, and the strongest reaches to the next arrow."""

    def eastward(time, lat, lon):
        return 1.5 * np.exp(-(((np.asarray(lat) - 31.0) / 0.1) ** 2)) + 0.0 * np.asarray(lon)

    sea = Sea.from_functions(
        {
            "eastward_sea_water_velocity": eastward,
            "northward_sea_water_velocity": lambda t, a, o: np.zeros(np.shape(a)),
        }
    )
    voyage = Voyage(start=(30.0, -40.0), goal=(32.0, -38.0), depart=0.0)
    found = plan(voyage, ship=SHIP, sea=sea, chart=Chart.open_water(), proof=0.0)
    (axes, *_) = draw_map(found).axes
    (arrows,) = [item for item in axes.collections if isinstance(item, Quiver)]
    assert 0 < len(arrows.U) < 100
    assert arrows.U.min() >= 0.1 * arrows.U.max() > 0.1
    assert arrows.U.max() / arrows.scale == pytest.approx(1.0 / 20.0)  # of the width of the map


def test_no_arrow_is_shown_where_all_currents_are_weak():
    shown, strongest = shown_arrows(np.array([0.01, np.nan, 0.04]), np.array([0.0, 0.0, 0.01]))
    assert not shown.any() and strongest == 0.0
    shown, strongest = shown_arrows(np.array([1.0, 0.09, 0.2]), np.zeros(3))
    assert shown.tolist() == [True, False, True] and strongest == 1.0


@pytest.mark.slow
def test_waits_are_drawn_above_the_mark_of_the_port(lagoon):
    track = lagoon.best.track
    waiting = replace(track, wait=(3600.0, *track.wait[1:]))
    waited = replace(lagoon, routes=(replace(lagoon.best, track=waiting),))
    (axes, *_) = draw_map(waited).axes
    (waits,) = [line for line in axes.lines if line.get_label() == "waits"]
    ports = [line for line in axes.lines if line.get_marker() == "o" and line.get_markersize() == 7]
    assert len(ports) == 2
    assert waits.get_zorder() > max(line.get_zorder() for line in ports)


@pytest.mark.slow
def test_shoal_water_that_a_plan_keeps_off_is_drawn():
    voyage = Voyage(start=(-15.0, 146.0), goal=(-13.0, 147.2), depart="2026-01-01")
    deep = Ship.simple(speed_kn=12.0, draught_m=9.0)
    figure = draw_map(plan(voyage, ship=deep, sea=Sea.calm()))
    axes = figure.axes[0]
    assert "shoal water kept off" in [text.get_text() for text in axes.get_legend().get_texts()]
    osprey_reef = (146.6, -13.9)
    drawn = [path for one in axes.collections for path in one.get_paths() if one.zorder == 1.5]
    assert any(path.contains_point(osprey_reef) for path in drawn)
    assert not any(path.contains_point((147.0, -14.5)) for path in drawn)


@pytest.fixture(scope="module")
def front_map(lagoon):
    """The map of a front of three routes; the second leads farther south."""
    best = lagoon.best
    other = replace(best, samples={**best.samples, "lat": best.samples["lat"] - 0.05})
    front = ParetoFront(
        "cost", "USD", np.array([300.0, 200.0, 100.0]), ("exact",) * 3, ("open sea",) * 3
    )
    return draw_map(replace(lagoon, routes=(best, other, best), front=front))


@pytest.mark.slow
def test_the_best_route_of_a_front_lies_on_the_others_which_show_their_cost(front_map):
    """Forty routes in one colour hid the best one."""
    lines = [one for one in front_map.axes[0].collections if isinstance(one, LineCollection)]
    others, best = sorted(lines, key=lambda one: one.get_zorder())
    assert others.get_zorder() < best.get_zorder()
    assert sorted(others.get_array()) == [100.0, 200.0]
    labels = [axes.get_xlabel() for axes in front_map.axes[0].child_axes]
    assert labels == ["cost of 2 other routes [USD]", "speed over ground of the best route [kn]"]


@pytest.mark.slow
def test_bars_of_colours_cover_neither_the_map_nor_each_other(front_map):
    axes = front_map.axes[0]
    front_map.draw_without_rendering()
    bars = [bar.get_tightbbox() for bar in axes.child_axes]
    ticks = [tick.get_window_extent() for tick in axes.get_xticklabels()]
    boxes = [axes.get_window_extent(), axes.title.get_window_extent(), *ticks]
    for bar in bars:
        assert not any(bar.overlaps(box) for box in boxes)
    assert not bars[0].overlaps(bars[1])
    saved = front_map.get_tightbbox()  # that of files [inch]
    assert saved.y0 * front_map.dpi <= min(bar.y0 for bar in bars) + 1e-6
    assert saved.y1 * front_map.dpi >= axes._left_title.get_window_extent().y1 - 1e-6


@pytest.mark.slow
def test_water_to_check_is_drawn_in_the_colour_of_limits(lagoon, monkeypatch):
    lat, lon = lagoon.best.samples["lat"], lagoon.best.samples["lon"]
    check = np.arange(len(lat)) >= len(lat) - 5
    monkeypatch.setattr(routes_on_map, "water_to_check", lambda *_: (lat, lon, check))
    axes = draw_map(lagoon).axes[0]
    (drawn,) = [line for line in axes.lines if line.get_label() == routes_on_map.TO_CHECK]
    assert drawn.get_color() == LIMIT_COLOUR
    assert drawn.get_ydata() == pytest.approx(lat[-5:])
    (route,) = [line for line in axes.lines if line.get_label() == "route, times in UTC"]
    assert drawn.get_zorder() > route.get_zorder()


@pytest.mark.slow
def test_water_with_less_than_the_required_clearance_is_drawn():
    chart = Chart.open_water(50.0, 51.0, 0.0, 2.0).with_depth(
        lambda lat, lon: np.where(np.asarray(lon) > 1.0, 8.0, 20.0) + 0.0 * lat
    )
    voyage = Voyage(start=(50.5, 0.5), goal=(50.5, 1.5), depart="2026-01-01")
    found = plan(voyage, ship=SHIP, sea=Sea.calm(), chart=chart, resolution=5000.0)
    strict = replace(found, voyage=replace(voyage, min_ukc_m=5.0))

    def drawn(plan_of_it):
        lines = draw_map(plan_of_it).axes[0].lines
        return [line for line in lines if line.get_label() == routes_on_map.TO_CHECK]

    assert drawn(found) == []
    (line,) = drawn(strict)
    assert line.get_xdata().min() == pytest.approx(1.0, abs=0.1)
    assert line.get_xdata().max() == pytest.approx(1.5, abs=0.01)


@pytest.mark.slow
def test_the_first_of_alternatives_lies_on_the_others_on_the_same_way(lagoon):
    routes, names = (lagoon.best,) * 3, ("fast", "cheap", "calm")
    chart = lagoon.plot_context.chart
    axes = draw_alternatives_map(routes, names, chart, ("A", "B")).axes[0]
    lines = [line for line in axes.lines if line.get_label()[:2] in ("1.", "2.", "3.")]
    order = [line.get_zorder() for line in lines]
    assert order == sorted(order, reverse=True) and len(set(order)) == 3
    widths = [line.get_linewidth() for line in lines]
    assert widths == sorted(widths) and len(set(widths)) == 3


@pytest.mark.slow
def test_labels_do_not_lie_on_the_marks_of_times(lagoon):
    axes = draw_map(lagoon).axes[0]
    (marks,) = [line for line in axes.lines if line.get_markersize() == 3.5]
    points = axes.transData.transform(marks.get_xydata())
    for text in axes.texts:
        if text.get_zorder() == 10:
            box = text.get_window_extent()
            assert not any(box.contains(x, y) for x, y in points), text.get_text()


def test_arrows_of_lanes_end_at_the_edge_of_the_map():
    """Arrows of schemes at the edge reached over the axes."""
    box = MapExtent(52.0, 53.2, 2.0, 4.05)
    axes = new_figure(*box.figure_size()).add_subplot()
    box.set_up(axes)
    _draw_arrow(axes, (53.0, 3.9), (53.4, 4.5), 0.0)
    (arrow,) = axes.texts
    assert arrow.arrow_patch.get_clip_box() is not None


def test_times_of_a_wait_are_marked_once():
    """Hours of a wait at the start stood round its name, one beside the other."""
    lon, lat = np.array([3.1, 3.1, 3.1, 3.3, 3.3]), np.array([51.6, 51.6, 51.6, 51.6, 51.7])
    assert at_other_places(lon, lat).tolist() == [True, False, False, True, True]
    assert at_other_places(lon[:0], lat[:0]).tolist() == []
