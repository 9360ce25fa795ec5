"""Maps: lines without jumps at any longitude."""

import numpy as np
import pytest

from tests.conftest import data_file
from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.planning.plots.route_profile import draw_profile
from thalweg.planning.plots.voyage_map import MapExtent, draw_map

SHIP = Ship.simple(speed_kn=12.0, draught_m=5.0)


@pytest.mark.parametrize("turns", [-360.0, 0.0, 360.0])
def test_a_line_longer_than_half_the_world_has_no_jump(turns):
    box = MapExtent(-30.0, 89.0, -260.0, 20.0)
    lon = np.linspace(4.0, -250.0, 60)
    wrapped = (lon + 180.0) % 360.0 - 180.0 + turns
    assert box.line(wrapped) == pytest.approx(lon)


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
