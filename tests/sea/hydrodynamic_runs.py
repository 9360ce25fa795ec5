"""Small model runs as hydrodynamic models write them: one tide over a sloping bank that dries.

The sea surface is level and rises and falls by an M2 tide; the bank rises from 10 m of depth in the
west to 1 m above datum in the east. Currents are affine in place, so that any right reading of them
is exact: u = 0.5 + 10 (lon - LON0), v = -0.2 + 20 (lat - LAT0), times the hour plus one.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

T0 = 1_767_225_600.0  # 2026-01-01T00:00Z
LAT0, LON0, STEP = 51.0, 3.0, 0.01
ROWS, COLUMNS = 5, 12
HOURS = np.arange(0.0, 13.0)
SINCE = {"units": "seconds since 2026-01-01 00:00:00", "standard_name": "time"}


def level(hour: Any) -> np.ndarray:
    """Return the level of the sea [m], 1.5 m at hour 0."""
    return 1.5 * np.cos(2.0 * np.pi * np.asarray(hour, float) / 12.4206012)


def bed(lon: Any) -> np.ndarray:
    """Return the height of the bed [m]: -10 in the west, +1 in the east."""
    return -10.0 + 11.0 * (np.asarray(lon, float) - LON0) / (STEP * (COLUMNS - 1))


def current(hour: Any, lat: Any, lon: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return the current to the east and to the north [m/s]."""
    grow = 1.0 + np.asarray(hour, float)
    east = (0.5 + 10.0 * (np.asarray(lon) - LON0)) * grow / 10.0
    north = (-0.2 + 20.0 * (np.asarray(lat) - LAT0)) * grow / 10.0
    return east, north


def places() -> tuple[np.ndarray, np.ndarray]:
    """Return rows and columns of positions, (ROWS, COLUMNS)."""
    lat, lon = LAT0 + STEP * np.arange(ROWS), LON0 + STEP * np.arange(COLUMNS)
    return np.repeat(lat[:, None], COLUMNS, axis=1), np.repeat(lon[None, :], ROWS, axis=0)


def nodes() -> tuple[np.ndarray, np.ndarray]:
    """Return the positions as a flat list."""
    lat, lon = places()
    return lat.ravel(), lon.ravel()


def triangles() -> np.ndarray:
    """Return the nodes of triangles, from 0."""
    place = np.arange(ROWS * COLUMNS).reshape(ROWS, COLUMNS)
    a, b, c, d = place[:-1, :-1], place[:-1, 1:], place[1:, 1:], place[1:, :-1]
    return np.concatenate(
        [np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)]
    )


def quads() -> np.ndarray:
    """Return the nodes of quadrangles, from 0."""
    place = np.arange(ROWS * COLUMNS).reshape(ROWS, COLUMNS)
    return np.stack([place[:-1, :-1], place[:-1, 1:], place[1:, 1:], place[1:, :-1]], -1).reshape(
        -1, 4
    )


def clock(hours: Any = HOURS) -> xr.DataArray:
    """Return the time axis."""
    return xr.DataArray(3600.0 * np.asarray(hours), dims="time", attrs=SINCE)


def delft3d_fm(*, layers: str = "") -> xr.Dataset:
    """Return a map file as D-Flow FM writes it: values on faces, bed and level, cells that dry.

    A dry cell has the level of its bed, no water and no current. With layers "sigma" (bottom up,
    as D-Flow FM counts) or "z" the current is that of the column mean plus or minus 0.4 m/s from
    the surface to the bed, in ten layers.
    """
    lat, lon = nodes()
    faces = quads()
    y, x = lat[faces].mean(axis=1), lon[faces].mean(axis=1)
    hour = HOURS[:, None]
    ground = bed(x)[None] + 0.0 * hour
    surface = np.maximum(level(hour) + 0.0 * x, ground)
    depth = surface - ground
    east, north = (np.where(depth > 0.0, part, 0.0) for part in current(hour, y, x))
    over = {"mesh": "mesh2d", "location": "face"}
    data = xr.Dataset(
        {
            "mesh2d": (
                (),
                0,
                {
                    "cf_role": "mesh_topology",
                    "topology_dimension": 2,
                    "node_coordinates": "mesh2d_node_x mesh2d_node_y",
                    "node_dimension": "mesh2d_nNodes",
                    "max_face_nodes_dimension": "mesh2d_nMax_face_nodes",
                    "edge_node_connectivity": "mesh2d_edge_nodes",
                    "face_node_connectivity": "mesh2d_face_nodes",
                    "face_dimension": "mesh2d_nFaces",
                },
            ),
            "mesh2d_face_nodes": (
                ("mesh2d_nFaces", "mesh2d_nMax_face_nodes"),
                (faces + 1).astype(np.int32),
                {"cf_role": "face_node_connectivity", "start_index": 1, "_FillValue": -999},
            ),
            "mesh2d_node_x": (
                "mesh2d_nNodes",
                lon,
                {"standard_name": "longitude", "units": "degrees_east", "mesh": "mesh2d"},
            ),
            "mesh2d_node_y": (
                "mesh2d_nNodes",
                lat,
                {"standard_name": "latitude", "units": "degrees_north", "mesh": "mesh2d"},
            ),
            "mesh2d_flowelem_bl": (
                "mesh2d_nFaces",
                bed(x),
                {"standard_name": "altitude", "units": "m", **over},
            ),
            "mesh2d_s1": (
                ("time", "mesh2d_nFaces"),
                surface,
                {"standard_name": "sea_surface_height", "units": "m", **over},
            ),
            "mesh2d_waterdepth": (
                ("time", "mesh2d_nFaces"),
                depth,
                {"standard_name": "sea_floor_depth_below_sea_surface", "units": "m", **over},
            ),
        },
        coords={"time": clock()},
    )
    speed = {"units": "m s-1", **over}
    names = ("mesh2d_ucx", "sea_water_x_velocity"), ("mesh2d_ucy", "sea_water_y_velocity")
    dims: tuple[str, ...] = ("time", "mesh2d_nFaces")
    values = [east, north]
    if layers:
        dims = (*dims, "mesh2d_nLayers")
        share, data = _layered(data, layers, depth, surface)
        values = [part[..., None] + 0.4 * (1.0 - 2.0 * share) for part in values]
        if layers == "z":  # layers below the bed do not exist
            values = [np.where(share <= 1.0 + 1e-9, part, np.nan) for part in values]
    for (name, standard), part in zip(names, values):
        data[name] = (dims, part, {"standard_name": standard, **speed})
    return data


def _layered(
    data: xr.Dataset, kind: str, depth: np.ndarray, surface: np.ndarray
) -> tuple[np.ndarray, xr.Dataset]:
    """Return the fraction of the depth at the centre of each layer, and its coordinate."""
    if kind == "sigma":
        rims = np.linspace(-1.0, 0.0, 11)
        middle = 0.5 * (rims[1:] + rims[:-1])
        data["mesh2d_layer_sigma"] = (
            "mesh2d_nLayers",
            middle,
            {"standard_name": "ocean_sigma_coordinate", "positive": "up", "units": "1"},
        )
        data["mesh2d_interface_sigma"] = ("mesh2d_nInterfaces", rims, {"units": "1"})
        return np.broadcast_to(-middle, (*depth.shape, 10)), data
    rims = np.linspace(-10.0, 2.0, 13)  # above the highest water
    middle = 0.5 * (rims[1:] + rims[:-1])
    data["mesh2d_layer_z"] = (
        "mesh2d_nLayers",
        middle,
        {"standard_name": "altitude", "positive": "up", "units": "m"},
    )
    data["mesh2d_interface_z"] = ("mesh2d_nInterfaces", rims, {"units": "m"})
    with np.errstate(divide="ignore", invalid="ignore"):
        share = (surface[..., None] - middle) / depth[..., None]
    return np.where(share < 0.0, np.nan, share), data


def adcirc(*, topology: bool = True) -> xr.Dataset:
    """Return fort.63 and fort.64 in one: values on nodes, dry ones with the fill value."""
    lat, lon = nodes()
    hour = HOURS[:, None]
    wet = level(hour) + 0.0 * lon > bed(lon)
    east, north = current(hour, lat, lon)
    fill = {"_FillValue": -99999.0, "location": "node", "mesh": "adcirc_mesh"}
    data = xr.Dataset(
        {
            "element": (
                ("nele", "nvertex"),
                (triangles() + 1).astype(np.int32),
                {"cf_role": "face_node_connectivity", "start_index": 1, "units": "nondimensional"},
            ),
            "depth": (
                "node",
                -bed(lon),
                {"long_name": "distance below geoid", "standard_name": "depth below geoid",
                 "units": "m", "location": "node", "mesh": "adcirc_mesh"},
            ),
            "zeta": (
                ("time", "node"),
                np.where(wet, level(hour) + 0.0 * lon, -99999.0),
                {"standard_name": "sea_surface_height_above_geoid", "units": "m", **fill},
            ),
            "u-vel": (
                ("time", "node"),
                np.where(wet, east, -99999.0),
                {"standard_name": "eastward_water_velocity", "units": "m s-1", **fill},
            ),
            "v-vel": (
                ("time", "node"),
                np.where(wet, north, -99999.0),
                {"standard_name": "northward_water_velocity", "units": "m s-1", **fill},
            ),
        },
        coords={
            "time": clock(),
            "x": ("node", lon, {"standard_name": "longitude", "units": "degrees_east"}),
            "y": ("node", lat, {"standard_name": "latitude", "units": "degrees_north"}),
        },
    )  # fmt: skip
    if topology:
        topology = {
            "cf_role": "mesh_topology",
            "topology_dimension": 2,
            "node_coordinates": "x y",
            "face_node_connectivity": "element",
        }
        data["adcirc_mesh"] = ((), 0, topology)
    else:
        del data["element"].attrs["cf_role"]
    return data


def dhi() -> xr.Dataset:
    """Return a MIKE 21 FM run as converted to UGRID: values on faces, unknown where dry."""
    lat, lon = nodes()
    faces = triangles()
    y, x = lat[faces].mean(axis=1), lon[faces].mean(axis=1)
    hour = HOURS[:, None]
    wet = level(hour) + 0.0 * x > bed(x)
    east, north = current(hour, y, x)
    topology = {
        "cf_role": "mesh_topology",
        "topology_dimension": 2,
        "node_coordinates": "node_lon node_lat",
        "face_node_connectivity": "face_nodes",
        "face_dimension": "nFaces",
    }
    on = ("time", "nFaces")
    return xr.Dataset(
        {
            "mesh2d": ((), 0, topology),
            "face_nodes": (
                ("nFaces", "three"), faces.astype(np.int32),
                {"cf_role": "face_node_connectivity", "start_index": 0},
            ),
            "node_lon": ("nNodes", lon, {"standard_name": "longitude"}),
            "node_lat": ("nNodes", lat, {"standard_name": "latitude"}),
            "Bathymetry": ("nFaces", bed(x), {"standard_name": "altitude", "units": "meter"}),
            "Surface elevation": (on, np.where(wet, level(hour) + 0 * x, np.nan),
                                  {"units": "meter"}),
            "U velocity": (on, np.where(wet, east, np.nan), {"units": "meter per sec"}),
            "V velocity": (on, np.where(wet, north, np.nan), {"units": "meter per sec"}),
        },
        coords={"time": clock()},
    )  # fmt: skip


def curvilinear(turn_deg: float = 30.0) -> xr.Dataset:
    """Return a DCSM-ZUNO-like run: two-dimensional positions, components along the turned grid."""
    y, x = places()
    turn = np.radians(turn_deg)
    dy, dx = y - LAT0, (x - LON0) * np.cos(np.radians(LAT0))
    lat = LAT0 + np.sin(turn) * dx + np.cos(turn) * dy
    lon = LON0 + (np.cos(turn) * dx - np.sin(turn) * dy) / np.cos(np.radians(LAT0))
    hour = HOURS[:, None, None]
    wet = level(hour) + 0.0 * x > bed(x)
    east, north = current(hour, lat, lon)
    along, across = np.cos(turn) * east + np.sin(turn) * north, None
    across = -np.sin(turn) * east + np.cos(turn) * north
    on = ("time", "n", "m")
    where = {"coordinates": "lat lon"}
    return xr.Dataset(
        {
            "velx": (on, np.where(wet, along, np.nan),
                     {"standard_name": "sea_water_x_velocity", "units": "m/s", **where}),
            "vely": (on, np.where(wet, across, np.nan),
                     {"standard_name": "sea_water_y_velocity", "units": "m/s", **where}),
            "SEP": (on, np.where(wet, level(hour) + 0 * x, np.nan),
                    {"standard_name": "sea_surface_height_above_mean_sea_level", "units": "m"}),
            "bed": (("n", "m"), -bed(x),
                    {"standard_name": "sea_floor_depth_below_mean_sea_level", "units": "m"}),
        },
        coords={
            "time": clock(),
            "lat": (("n", "m"), lat, {"units": "degrees_north"}),
            "lon": (("n", "m"), lon, {"units": "degrees_east"}),
        },
    )  # fmt: skip


def regular() -> xr.Dataset:
    """Return the run on a regular grid, dry places unknown."""
    lat, lon = LAT0 + STEP * np.arange(ROWS), LON0 + STEP * np.arange(COLUMNS)
    hour, x = HOURS[:, None, None], lon[None, None, :]
    wet = level(hour) + 0.0 * x + 0.0 * lat[None, :, None] > bed(x)
    east, north = current(hour, lat[None, :, None], x)
    on = ("time", "lat", "lon")
    return xr.Dataset(
        {
            "VELU": (on, np.where(wet, east + 0 * wet, np.nan), {"units": "m/s"}),
            "VELV": (on, np.where(wet, north + 0 * wet, np.nan), {"units": "m/s"}),
            "SEP": (on, np.where(wet, level(hour) + 0 * wet, np.nan), {"units": "m"}),
            "bed_level": (("lat", "lon"), np.broadcast_to(bed(lon), (ROWS, COLUMNS)).copy(),
                          {"standard_name": "altitude", "units": "m", "positive": "up"}),
        },
        coords={
            "time": clock(),
            "lat": ("lat", lat, {"units": "degrees_north"}),
            "lon": ("lon", lon, {"units": "degrees_east"}),
        },
    )  # fmt: skip
