"""Hydrodynamic models in their own layouts: read exactly, dry places never navigable."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from tests.sea import hydrodynamic_runs as hydro
from thalweg import Sea
from thalweg.core.errors import DatasetError, InputError
from thalweg.sea.files.draught_averaging import VerticalLayers
from thalweg.sea.grids.triangle_grid import TriangleGrid

EAST, NORTH = "eastward_sea_water_velocity", "northward_sea_water_velocity"
LEVEL = "sea_surface_height_above_geopotential_datum"
DEPTH = "sea_floor_depth_below_geoid"

RUNS = {
    "Delft3D-FM": hydro.delft3d_fm,
    "ADCIRC": hydro.adcirc,
    "ADCIRC without topology": lambda: hydro.adcirc(topology=False),
    "DHI": hydro.dhi,
    "curvilinear": hydro.curvilinear,
    "regular": hydro.regular,
}


def deep_places(data) -> tuple[np.ndarray, np.ndarray]:
    """Return positions of values in the deep west (nodes, else centres of faces)."""
    if "lat" in data.coords and data["lat"].ndim == 2:
        lat, lon = data["lat"].values, data["lon"].values
        return lat[1:4, 1:4].ravel(), lon[1:4, 1:4].ravel()
    faces = "Bathymetry" in data or "mesh2d_s1" in data
    lat, lon = hydro.nodes()
    if faces:
        table = hydro.triangles() if "Bathymetry" in data else hydro.quads()
        lat, lon = lat[table].mean(axis=1), lon[table].mean(axis=1)
    west = lon < hydro.LON0 + 4.0 * hydro.STEP
    return lat[west], lon[west]


@pytest.fixture(params=sorted(RUNS))
def run(request, tmp_path):
    """Return a run's dataset and the sea opened from its file."""
    data = RUNS[request.param]()
    data.to_netcdf(tmp_path / "run.nc")
    return data, Sea.open(tmp_path / "run.nc")


def test_values_equal_those_of_the_model(run) -> None:
    data, sea = run
    lat, lon = deep_places(data)
    for hour in (0.0, 3.0, 7.5):
        got = sea.sample([EAST, NORTH, LEVEL, DEPTH], hydro.T0 + 3600.0 * hour, lat, lon)
        low = int(hour)
        part = hour - low
        surface = (1.0 - part) * hydro.level(low) + part * hydro.level(min(low + 1, 12))
        east, north = hydro.current(hour, lat, lon)
        assert got[LEVEL] == pytest.approx(surface, abs=1e-6)
        assert got[EAST] == pytest.approx(east, abs=2e-4)
        assert got[NORTH] == pytest.approx(north, abs=2e-4)
    if "n" not in data.dims:  # the bank of the turned grid turns with it
        assert got[DEPTH] == pytest.approx(-hydro.bed(lon), abs=1e-5)


def test_the_bank_is_never_navigable_while_dry(run) -> None:
    data, sea = run
    lat = np.full(9, hydro.LAT0 + 2.2 * hydro.STEP)
    lon = hydro.LON0 + hydro.STEP * np.linspace(9.0, 10.9, 9)
    if "n" in data.dims:
        lat, lon = data["lat"].values[2, 9:], data["lon"].values[2, 9:]
    low_water = hydro.T0 + 6.0 * 3600.0
    got = sea.sample([LEVEL, DEPTH], low_water, lat, lon)
    assert not (got[LEVEL] + got[DEPTH] > 0.06).any()
    high_water = sea.sample([LEVEL, DEPTH], hydro.T0, lat, lon)
    assert (high_water[LEVEL] + high_water[DEPTH] > 0.06).any()


def test_meshes_can_be_used_as_networks(run) -> None:
    data, sea = run
    if "lat" in data.coords:
        assert sea.mesh() is None
    else:
        mesh = sea.mesh()
        assert mesh.lat.size == hydro.ROWS * hydro.COLUMNS
        assert mesh.triangles.shape == (len(hydro.triangles()), 3)


@pytest.mark.parametrize("kind", ["sigma", "z"])
@pytest.mark.parametrize("draught", [1.0, 4.0, 9.0])
def test_layers_are_averaged_over_the_draught(tmp_path, kind, draught) -> None:
    """The profile falls from +0.4 to -0.4 of its mean, linear over the depth: so does its mean."""
    data = hydro.delft3d_fm(layers=kind)
    data.to_netcdf(tmp_path / "run.nc")
    sea = Sea.open(tmp_path / "run.nc", draught_m=draught)
    face = 0
    lat, lon = hydro.nodes()
    y, x = lat[hydro.quads()].mean(axis=1)[face], lon[hydro.quads()].mean(axis=1)[face]
    hour = 3.0
    depth = float(hydro.level(hour) - hydro.bed(x))
    east, north = hydro.current(hour, y, x)
    over = min(draught, depth)
    exact = 0.4 * (1.0 - over / depth)
    got = sea.sample([EAST, NORTH], hydro.T0 + 3600.0 * hour, y, x)
    # Layers are uniform inside: a draught that ends within one is off by part of its thickness.
    assert got[EAST] - east == pytest.approx(exact, abs=0.02)
    assert got[EAST] - east == pytest.approx(_by_hand(kind, draught, hour, x), abs=1e-6)
    assert got[NORTH] - north == pytest.approx(got[EAST] - east, abs=1e-6)
    how = next(r.how for r in sea.describe().recognised if r.variable == EAST)
    count = 10 if kind == "sigma" else 12
    assert f"mean over the upper {draught:g} m of {count} {kind} layers" in how


@pytest.mark.parametrize(
    ("level", "thick"),
    [(1.0, [3.0, 1.0]), (0.0, [2.0, 2.0]), (-1.0, [1.0, 2.0]), (-2.5, [0.0, 1.5])],
)
def test_the_top_layer_at_fixed_depths_reaches_the_moving_surface(level, thick) -> None:
    """Layers from 0 to 2 and 2 to 4 m below datum, a draught of 4 m."""
    layers = VerticalLayers("z", False, np.array([0.0, 2.0]), np.array([2.0, 4.0]))
    shares = layers.shares(4.0, np.full((1, 1, 1), level))
    assert shares[0, :, 0, 0] == pytest.approx(thick)


def _by_hand(kind: str, draught: float, hour: float, x: float) -> float:
    """Return the mean deviation over the draught, layer by layer."""
    surface = float(hydro.level(hour))
    depth = surface - float(hydro.bed(x))
    if kind == "sigma":
        layers = [(k * depth / 10, (k + 1) * depth / 10, (k + 0.5) / 10) for k in range(10)]
    else:
        layers = []
        for bottom in np.linspace(-10.0, 1.0, 12):
            middle = bottom + 0.5
            share = (surface - middle) / depth
            if 0.0 <= share <= 1.0:
                layers.append([surface - bottom - 1.0, surface - bottom, share])
        layers[-1][0] = max(layers[-1][0], 0.0)
    total = weight = 0.0
    for top, bottom, share in layers:
        thick = max(0.0, min(bottom, draught) - max(top, 0.0))
        total += thick * 0.4 * (1.0 - 2.0 * share)
        weight += thick
    return total / weight


def test_without_a_draught_the_surface_layer_is_used(tmp_path) -> None:
    data = hydro.delft3d_fm(layers="sigma")
    data.to_netcdf(tmp_path / "run.nc")
    sea = Sea.open(tmp_path / "run.nc")
    lat, lon = hydro.nodes()
    y, x = lat[hydro.quads()].mean(axis=1)[0], lon[hydro.quads()].mean(axis=1)[0]
    got = sea.sample([EAST], hydro.T0, y, x)[EAST]
    assert got - hydro.current(0.0, y, x)[0] == pytest.approx(0.4 * 0.9, abs=1e-6)
    assert sea.fingerprint() != Sea.open(tmp_path / "run.nc", draught_m=4.0).fingerprint()


@pytest.mark.parametrize(
    ("sigma", "positive", "at_surface"),
    [((-0.1, -0.5, -0.9), "up", 0), ((0.1, 0.5, 0.9), "down", 0), ((0.1, 0.5, 0.9), "up", 2)],
)
def test_the_surface_layer_is_the_one_next_to_the_surface(sigma, positive, at_surface) -> None:
    """Also where sigma counts from 0 at the bed to 1 at the surface."""
    shape, dims = (3, 2, 2), ("layer", "lat", "lon")
    u = np.broadcast_to(np.array([1.0, 2.0, 3.0])[:, None, None], shape)
    data = xr.Dataset(
        {
            "u": (dims, u, {"standard_name": EAST, "units": "m s-1"}),
            "v": (dims, 0.0 * u, {"standard_name": NORTH, "units": "m s-1"}),
            "h": (
                dims[1:],
                np.full((2, 2), 20.0),
                {"standard_name": "sea_floor_depth_below_geoid"},
            ),
        },
        {
            "layer": (
                "layer",
                list(sigma),
                {"standard_name": "ocean_sigma_coordinate", "positive": positive},
            ),
            "lat": [0.0, 1.0],
            "lon": [0.0, 1.0],
        },
    )
    surface = Sea.open(data).sample([EAST], 0.0, 0.5, 0.5)[EAST]
    assert surface == 1.0 + at_surface
    shallow = Sea.open(data, draught_m=0.1).sample([EAST], 0.0, 0.5, 0.5)[EAST]
    assert shallow == pytest.approx(surface)


def test_layers_given_downwards_or_from_zero_to_one_are_equal(tmp_path) -> None:
    plain = hydro.delft3d_fm(layers="sigma")
    lat, lon = hydro.nodes()
    y, x = lat[hydro.quads()].mean(axis=1)[:5], lon[hydro.quads()].mean(axis=1)[:5]
    expected = Sea.open(plain, draught_m=4.0).sample([EAST], hydro.T0, y, x)[EAST]
    upside = plain.isel(
        mesh2d_nLayers=slice(None, None, -1), mesh2d_nInterfaces=slice(None, None, -1)
    )
    assert Sea.open(upside, draught_m=4.0).sample([EAST], hydro.T0, y, x)[EAST] == pytest.approx(
        expected, abs=1e-6
    )
    shifted = plain.copy()
    for name in ("mesh2d_layer_sigma", "mesh2d_interface_sigma"):  # 0 at the bed, 1 at the surface
        shifted[name] = shifted[name] + 1.0
    shifted["mesh2d_layer_sigma"].attrs = plain["mesh2d_layer_sigma"].attrs
    assert Sea.open(shifted, draught_m=4.0).sample([EAST], hydro.T0, y, x)[EAST] == pytest.approx(
        expected, abs=1e-6
    )
    bare = plain.drop_vars("mesh2d_interface_sigma")  # edges half-way between equal layers
    assert Sea.open(bare, draught_m=4.0).sample([EAST], hydro.T0, y, x)[EAST] == pytest.approx(
        expected, abs=1e-6
    )


def test_many_times_are_averaged_in_parts(monkeypatch) -> None:
    data = hydro.delft3d_fm(layers="sigma")
    lat, lon = hydro.nodes()
    y, x = lat[hydro.quads()].mean(axis=1), lon[hydro.quads()].mean(axis=1)
    times = hydro.T0 + 3600.0 * hydro.HOURS
    whole = Sea.open(data, draught_m=4.0).series([EAST], times, y, x)[EAST]
    monkeypatch.setattr("thalweg.sea.grids.source_variables.MAX_VALUES_AT_ONCE", 1000)
    parts = Sea.open(data, draught_m=4.0).series([EAST], times, y, x)[EAST]
    assert np.array_equal(whole, parts, equal_nan=True)


def refused(word, make, kind=DatasetError):
    with pytest.raises(kind, match=word) as caught:
        make()
    assert caught.value.possible and caught.value.remedy
    return caught.value


def test_layers_that_cannot_be_averaged() -> None:
    data = hydro.delft3d_fm(layers="sigma")
    lone = data.drop_vars(["mesh2d_waterdepth", "mesh2d_flowelem_bl"])
    refused("gives their thickness", lambda: Sea.open(lone, draught_m=4.0))
    Sea.open(lone)  # the surface layer needs no depth
    nameless = data.drop_vars(["mesh2d_layer_sigma", "mesh2d_interface_sigma"])
    refused("have no coordinate", lambda: Sea.open(nameless, draught_m=4.0))
    stretched = data.copy()
    stretched["mesh2d_layer_sigma"].attrs["standard_name"] = "ocean_s_coordinate_g2"
    refused("ocean_s_coordinate_g2", lambda: Sea.open(stretched, draught_m=4.0))
    for draught in (0.0, -3.0, float("nan"), 200.0, "deep", True):
        refused("averaged over", lambda d=draught: Sea.open(data, draught_m=d), InputError)


def test_incomplete_meshes_are_refused() -> None:
    data = hydro.delft3d_fm()
    refused("face_node_connectivity", lambda: Sea.open(data.drop_vars("mesh2d_face_nodes")))
    refused("node_coordinates", lambda: Sea.open(data.drop_vars("mesh2d_node_x")))
    lone = hydro.adcirc(topology=False).drop_vars("element")
    refused("no mesh connects them", lambda: Sea.open(lone))
    torn = hydro.adcirc()
    torn["element"][3, 1] = 4000
    refused("4000 of 60", lambda: Sea.open(torn))


def test_a_gap_in_time_is_reported_and_stays_unknown() -> None:
    data = hydro.dhi().isel(time=[0, 1, 2, 3, 9, 10, 11])
    sea = Sea.open(data)
    (gap,) = sea.describe().gaps
    assert (gap.after, gap.before) == (hydro.T0 + 3 * 3600.0, hydro.T0 + 9 * 3600.0)
    lat, lon = deep_places(hydro.dhi())
    got = sea.sample([LEVEL], hydro.T0 + 5 * 3600.0, lat, lon)[LEVEL]
    assert np.isnan(got).all()
    assert sea.why_missing(LEVEL, hydro.T0 + 5 * 3600.0, lat[0], lon[0]) == "gap"


def test_a_moving_depth_needs_no_standard_name(tmp_path) -> None:
    """As written for San Diego: only depth over time and elevation."""
    hydro.adcirc().to_netcdf(tmp_path / "run.nc")
    data = xr.load_dataset(tmp_path / "run.nc")
    moving = data["zeta"] + data["depth"]
    moving.attrs = {}
    data = data.drop_vars(["zeta", "depth"])
    lat, lon = hydro.nodes()
    data["depth"] = moving
    data["elevation"] = ("node", hydro.bed(lon))
    sea = Sea.open(data)
    got = sea.sample([LEVEL, DEPTH], hydro.T0, lat[:4], lon[:4])
    assert got[DEPTH] == pytest.approx(-hydro.bed(lon[:4]), abs=1e-5)
    assert got[LEVEL] == pytest.approx(hydro.level(0.0), abs=1e-5)
    how = next(r.how for r in sea.describe().recognised if r.variable == LEVEL)
    assert "total depth minus bed depth" in how


@pytest.mark.parametrize("west", [-117.3, -117.123456789, 3.0, 359.9, 179.95])
def test_a_small_mesh_is_searched_in_small_bins(west) -> None:
    """Rounding at the western edge must not spread the bins round the world."""
    lat, lon = hydro.nodes()
    grid = TriangleGrid(lat, lon - hydro.LON0 + west, hydro.triangles(), (1, lat.size))
    bins = grid._bins
    assert bins.frame[2] * bins.shape[1] == pytest.approx(hydro.STEP * 11, rel=1e-6)
    assert np.diff(bins.start).max() < 30


def test_meshes_with_small_triangles_get_more_bins() -> None:
    lat, lon = hydro.nodes()
    dense = np.concatenate([lat, lat * 1e-3 + 60.0]), np.concatenate([lon, lon * 1e-3 + 20.0])
    triangles = np.concatenate([hydro.triangles(), hydro.triangles() + lat.size])
    grid = TriangleGrid(*dense, triangles, (1, 2 * lat.size))
    assert grid._bins.shape[0] > int(np.sqrt(len(triangles)))
    middle = dense[0][triangles].mean(axis=1), dense[1][triangles].mean(axis=1)
    found = grid.locate(*middle)
    assert np.array_equal(np.sort(found.corner, axis=1), np.sort(triangles, axis=1))
    again = grid.locate(*(a.copy() for a in middle))
    assert again is found  # the same points are not searched twice
