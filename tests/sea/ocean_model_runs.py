"""The small tidal run of `hydrodynamic_runs` as SCHISM, FVCOM and ROMS write it."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tests.sea import hydrodynamic_runs as hydro


def schism() -> xr.Dataset:
    """Return out2d: values on nodes, the level named elevation, no standard names."""
    lat, lon = hydro.nodes()
    hour = hydro.HOURS[:, None]
    east, north = hydro.current(hour, lat, lon)
    on = {"mesh": "SCHISM_hgrid", "location": "node"}
    node, moving = "nSCHISM_hgrid_node", ("time", "nSCHISM_hgrid_node")
    surface = np.maximum(hydro.level(hour) + 0.0 * lon, hydro.bed(lon))
    topology = {
        "cf_role": "mesh_topology",
        "topology_dimension": 2,
        "node_coordinates": "SCHISM_hgrid_node_x SCHISM_hgrid_node_y",
        "face_node_connectivity": "SCHISM_hgrid_face_nodes",
    }
    x = {"standard_name": "longitude", "units": "degrees_east"}
    y = {"standard_name": "latitude", "units": "degrees_north"}
    return xr.Dataset(
        {
            "SCHISM_hgrid": ((), 0, topology),
            "SCHISM_hgrid_face_nodes": (
                ("nSCHISM_hgrid_face", "nMaxSCHISM_hgrid_face_nodes"),
                (hydro.triangles() + 1).astype(np.int32),
                {"start_index": 1},
            ),
            "SCHISM_hgrid_node_x": (node, lon, x),
            "SCHISM_hgrid_node_y": (node, lat, y),
            "depth": (node, -hydro.bed(lon), {"units": "m", "positive": "down", **on}),
            "dryFlagNode": (moving, (surface <= hydro.bed(lon)).astype(float), on),
            "elevation": (moving, surface, {"units": "m", **on}),
            "depthAverageVelX": (moving, east + 0.0 * surface, {"units": "m/s", **on}),
            "depthAverageVelY": (moving, north + 0.0 * surface, {"units": "m/s", **on}),
        },
        coords={"time": hydro.clock()},
    )


def fvcom() -> xr.Dataset:
    """Return an FVCOM run: currents on elements, level and depth on nodes, three sigma layers."""
    lat, lon = hydro.nodes()
    table = hydro.triangles()
    y, x = lat[table].mean(axis=1), lon[table].mean(axis=1)
    hour = hydro.HOURS[:, None]
    east, north = (part + 0.0 * x for part in hydro.current(hour, y, x))
    speed = {"units": "meters s-1", "grid": "fvcom_grid", "type": "data"}
    wet = hydro.level(hour) + 0.0 * lon
    return xr.Dataset(
        {
            "nv": (("three", "nele"), (table + 1).T.astype(np.int32)),
            "lon": ("node", lon, {"standard_name": "longitude", "units": "degrees_east"}),
            "lat": ("node", lat, {"standard_name": "latitude", "units": "degrees_north"}),
            "lonc": ("nele", x, {"standard_name": "longitude", "units": "degrees_east"}),
            "latc": ("nele", y, {"standard_name": "latitude", "units": "degrees_north"}),
            "h": ("node", -hydro.bed(lon), {"long_name": "Bathymetry", "units": "m"}),
            "zeta": (
                ("time", "node"),
                np.maximum(wet, hydro.bed(lon)),
                {"long_name": "Water Surface Elevation", "units": "meters"},
            ),
            "ua": (
                ("time", "nele"),
                east,
                {"long_name": "Vertically Averaged x-velocity", **speed},
            ),
            "va": (
                ("time", "nele"),
                north,
                {"long_name": "Vertically Averaged y-velocity", **speed},
            ),
        },
        coords={"time": hydro.clock()},
    )


def roms(turn_deg: float = 0.0) -> xr.Dataset:
    """Return a ROMS run: u and v on the inner sides of the cells, along the turned grid."""
    rows, columns = hydro.places()
    turn, shrink = np.radians(turn_deg), np.cos(np.radians(hydro.LAT0))
    hour = hydro.HOURS[:, None, None]

    def turned(y: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        dy, dx = y - hydro.LAT0, (x - hydro.LON0) * shrink
        lat = hydro.LAT0 + np.sin(turn) * dx + np.cos(turn) * dy
        return lat, hydro.LON0 + (np.cos(turn) * dx - np.sin(turn) * dy) / shrink

    def along(lat: np.ndarray, lon: np.ndarray, angle: float) -> np.ndarray:
        east, north = hydro.current(hour, lat, lon)
        return np.cos(angle) * east + np.sin(angle) * north

    sides = {
        "rho": (rows, columns),
        "u": (rows[:, :-1], 0.5 * (columns[:, 1:] + columns[:, :-1])),
        "v": (0.5 * (rows[1:] + rows[:-1]), columns[:-1]),
    }
    data = xr.Dataset(coords={"ocean_time": hydro.clock().rename(time="ocean_time")})
    for name, (y, x) in sides.items():
        lat, lon = turned(y, x)
        on = (f"eta_{name}", f"xi_{name}")
        data = data.assign_coords(
            {
                f"lat_{name}": (on, lat, {"units": "degree_north", "standard_name": "latitude"}),
                f"lon_{name}": (on, lon, {"units": "degree_east", "standard_name": "longitude"}),
            }
        )
        if name != "rho":
            angle = turn + (np.pi / 2.0 if name == "v" else 0.0)
            attributes = {"long_name": f"{name}-momentum component", "units": "meter second-1"}
            values = along(lat, lon, angle)[:, None]
            data[name] = (("ocean_time", "s_rho", *on), values, attributes)
    data["h"] = (("eta_rho", "xi_rho"), -hydro.bed(columns), {"units": "meter"})
    wet = np.maximum(hydro.level(hour) + 0.0 * columns, hydro.bed(columns))
    data["zeta"] = (("ocean_time", "eta_rho", "xi_rho"), wet, {"units": "meter"})
    return data
