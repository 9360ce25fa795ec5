"""Maps: lines without jumps at any longitude."""

import numpy as np
import pytest

from tests.conftest import data_file
from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.core.file_writing import new_figure
from thalweg.core.time import parse_time
from thalweg.planning.plots.map_extent import (
    MapExtent,
    degree_label,
    inverse_mercator,
    mercator,
)
from thalweg.planning.plots.map_labels import LabelPlacer, marked_times, time_label
from thalweg.planning.plots.map_overlays import draw_zones, place_labels
from thalweg.planning.plots.route_profile import draw_profile
from thalweg.planning.plots.voyage_map import draw_map

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
    assert figure.axes[1].get_ylabel() == "water depth at passage [m]"
    profile = draw_profile(found.best, tmp_path / "profile.png")
    assert [a.get_ylabel() for a in profile.axes] == ["speed [kn]", "clearance [m]"]
    assert (tmp_path / "map.png").stat().st_size > 10_000


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
