"""Van Halem's three cases on the pruned mesh of a model, against certified optima."""

from __future__ import annotations

import math

import numpy as np
import pytest
import xarray as xr
from scipy.spatial import Delaunay

from tests.worlds.plane import METRES_PER_LAT, METRES_PER_LON, T0, assert_optimal, simple_ship
from tests.worlds.test_current_worlds import HALEM, rotating
from tests.worlds.test_waiting_worlds import bar_sea
from thalweg import Sea, Voyage, plan
from thalweg.network import with_endpoints
from thalweg.planning.network_selection import model_mesh
from thalweg.planning.network_selection.model_mesh import flow_statistics, pruned_mesh

WATER = HALEM.water(-0.5, 0.5, -0.5, 0.5)
PERIOD = (T0, T0 + 36_000.0)


def triangular(spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """Return nodes (x, y) of nearly equilateral triangles over the unit square, and triangles."""
    count = round(1.0 / spacing) + 1
    rows = np.linspace(-0.5, 0.5, round(2.0 / (spacing * math.sqrt(3.0))) + 1)
    even = np.linspace(-0.5, 0.5, count)
    odd = np.concatenate([[-0.5], even[:-1] + 0.5 * spacing, [0.5]])
    points = [(x, y) for k, y in enumerate(rows) for x in (odd if k % 2 else even)]
    xy = np.array(points)
    return xy, Delaunay(xy).simplices


def model(flow, spacing: float, step: float = 600.0) -> Sea:
    """Return a model run of a flow on its mesh, as a file would hold it."""
    xy, triangles = triangular(spacing)
    times = np.arange(0.0, PERIOD[1] - PERIOD[0] + 1.0, step)
    u, v = (
        np.array([np.broadcast_to(flow(t, xy[:, 0], xy[:, 1])[k], len(xy)) for t in times])
        for k in (0, 1)
    )
    told = {
        "cf_role": "mesh_topology",
        "topology_dimension": 2,
        "node_coordinates": "lon lat",
        "face_node_connectivity": "faces",
    }
    on = ("time", "node")
    return Sea.open(
        xr.Dataset(
            {
                "mesh": ((), 0, told),
                "faces": (("face", "three"), triangles, {"cf_role": "face_node_connectivity"}),
                "u": (on, u, {"standard_name": "eastward_sea_water_velocity", "units": "m/s"}),
                "v": (on, v, {"standard_name": "northward_sea_water_velocity", "units": "m/s"}),
            },
            coords={
                "time": ("time", T0 + times, {"units": "seconds since 1970-01-01"}),
                "lat": ("node", xy[:, 1] * HALEM.unit / METRES_PER_LAT, {"units": "degrees_north"}),
                "lon": ("node", xy[:, 0] * HALEM.unit / METRES_PER_LON, {"units": "degrees_east"}),
            },
        )
    )


def on_pruned_mesh(run: Sea, largest: float, sizes: list[int]):
    """Return a builder of networks on the pruned nodes of a run."""

    def build(chart, start, goal, spacing=None):
        network = pruned_mesh(chart, run, *PERIOD, largest_spacing=largest * HALEM.unit)
        sizes.append(network.n_nodes)
        return with_endpoints(network, chart, start, goal)

    return build


def sailed(sea: Sea, build, start, goal, speed: float):
    voyage = Voyage(
        offing_nm=0.0, start=HALEM.position(*start), goal=HALEM.position(*goal), depart=T0
    )
    return plan(voyage, ship=simple_ship(speed), sea=sea, chart=WATER, network=build)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("tidal", "ship_speed", "seconds"),
    [(False, 4.0, 26240.4617), (False, 3.70041, 27787.35), (True, 4.0, 31512.4115)],
)
def test_rotating_flows(tidal, ship_speed, seconds):
    """Cases 1 and 2: a tenth of the nodes; the search within 2 %, the route within 0.01 %."""
    run = model(rotating(2.0, tidal), 0.025)
    sizes: list[int] = []
    found = sailed(
        HALEM.sea(rotating(2.0, tidal)), on_pruned_mesh(run, 0.1, sizes), (-0.4, -0.4), (0.4, 0.4),
        ship_speed,
    )  # fmt: skip
    assert sizes[0] < 0.15 * run.mesh().lat.size
    assert_optimal(found, seconds, within=1e-4, solver_within=0.0)
    assert found.solver_total * 3600.0 == pytest.approx(seconds, rel=0.02)


@pytest.mark.slow
def test_the_run_itself_as_the_sea():
    """Case 1 with nothing but the model's own values: linear between nodes 0.025 degrees apart."""
    run = model(rotating(2.0, False), 0.025)
    found = sailed(run, on_pruned_mesh(run, 0.06, []), (-0.4, -0.4), (0.4, 0.4), 4.0)
    assert found.best.feasible
    assert found.best.time_h * 3600.0 == pytest.approx(26240.4617, rel=1e-3)


@pytest.mark.slow
def test_waiting_for_the_bank():
    """Case 3: still water and a bank that opens at 18,000 s."""
    still = model(lambda t, x, y: (0.0 * x, 0.0 * x), 0.025, step=18_000.0)
    inside = lambda x, y: (np.abs(x) < 0.4) & (np.abs(y) < 0.1)  # noqa: E731
    sea = bar_sea(HALEM, inside, 18_000.0)
    found = sailed(sea, on_pruned_mesh(still, 0.06, []), (0.0, -0.4), (0.0, 0.4), 4.0)
    assert_optimal(found, 31903.29, within=1e-3, solver_within=0.03)
    assert found.best.waiting_h > 0.0


def test_what_the_nodes_are_thinned_by():
    """Case 1: |u| is 2 sqrt(cos2 + cos2) m/s, the curl 2 pi (sin + sin) m/s per degree."""
    run = model(rotating(2.0, False), 0.025)
    length = 0.1 * HALEM.unit
    speed, curl = flow_statistics(run, *PERIOD, length=length)
    xy, _ = triangular(0.025)
    x, y = xy[:, 0] + 0.5, xy[:, 1] + 0.5
    exact = 2.0 * np.hypot(np.cos(np.pi * x), np.cos(np.pi * y))
    assert speed == pytest.approx(exact, abs=1e-6)
    turning = 2.0 * np.pi / HALEM.unit * (np.sin(np.pi * x) + np.sin(np.pi * y))
    inner = (np.abs(xy) < 0.45).all(axis=1)
    assert curl[inner] == pytest.approx(
        (turning * length / exact.max())[inner], rel=0.1, abs=0.02
    )  # the largest of the triangles around a node


def on_mesh(run: Sea, **options):
    voyage = Voyage(
        offing_nm=0.0, start=HALEM.position(-0.4, -0.4), goal=HALEM.position(0.4, 0.4), depart=T0
    )
    return plan(voyage, ship=simple_ship(4.0), sea=run, chart=WATER, network="mesh", **options)


@pytest.mark.slow
def test_a_requested_mesh_is_thinned_by_the_flow_to_the_resolution():
    """Case 1: 2 m/s and much curl leave more nodes than a weak even flow."""
    run = model(rotating(2.0, False), 0.025)
    whole = on_mesh(run).provenance["networks"][0]["nodes"]
    thinned = on_mesh(run, resolution=0.1 * HALEM.unit).provenance["networks"][0]["nodes"]
    even = on_mesh(
        model(lambda t, x, y: (0.1 + 0.0 * x, 0.0 * x), 0.025), resolution=0.1 * HALEM.unit
    ).provenance["networks"][0]["nodes"]
    assert whole == pytest.approx(run.mesh().lat.size + 2, abs=2)
    assert even < 0.7 * thinned
    assert thinned < 0.15 * whole


@pytest.mark.slow
def test_large_models_are_thinned_to_what_can_be_searched(monkeypatch):
    monkeypatch.setattr(model_mesh, "MAX_MESH_NODES", 400)
    found = on_mesh(model(rotating(2.0, False), 0.025))
    assert 100 < found.provenance["networks"][0]["nodes"] <= 402
    assert found.best.time_h * 3600.0 == pytest.approx(26240.4617, rel=2e-3)


def test_without_currents_only_the_spacing_counts():
    run = model(lambda t, x, y: (0.0 * x, 0.0 * x), 0.05, step=18_000.0)
    network = pruned_mesh(WATER, run, *PERIOD, largest_spacing=0.2 * HALEM.unit)
    lat, lon = network.stations.lat[: network.n_nodes], network.stations.lon[: network.n_nodes]
    x, y = lon * METRES_PER_LON / HALEM.unit, lat * METRES_PER_LAT / HALEM.unit
    away = np.hypot(x[:, None] - x, y[:, None] - y) + 9.0 * np.eye(len(x))
    assert away.min() > 0.2 - 1e-3
