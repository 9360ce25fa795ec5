"""Small datasets for the tests of files: an affine field with another slope on every axis."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

T0 = 1_700_000_000.0 - 1_700_000_000.0 % 3600.0
HS = "sea_surface_wave_significant_height"
EAST, NORTH = "eastward_sea_water_velocity", "northward_sea_water_velocity"


def affine(time: Any, lat: Any, lon: Any) -> Any:
    """1 + hours / 10 + lat / 5 + lon / 50: no two slopes alike."""
    return 1.0 + (np.asarray(time) - T0) / 36000.0 + np.asarray(lat) * 0.2 + np.asarray(lon) * 0.02


def clock(hours: Any) -> xr.DataArray:
    """Return a CF time axis, hours since T0."""
    attrs = {"units": "seconds since 1970-01-01T00:00:00", "standard_name": "time"}
    return xr.DataArray(T0 + 3600.0 * np.asarray(hours, float), dims="time", attrs=attrs)


def axis(values: Any, name: str) -> xr.DataArray:
    """Return a latitude or longitude axis."""
    attrs = {"units": "degrees_north" if name == "lat" else "degrees_east"}
    return xr.DataArray(np.asarray(values, float), dims=name, attrs=attrs)


def regular(
    lat: Any = (10.0, 11.0, 12.0, 13.0),
    lon: Any = (20.0, 21.0, 22.0),
    hours: Any = (0.0, 1.0, 3.0),
    fields: dict[str, dict[str, str]] | None = None,
    field: Any = affine,
) -> xr.Dataset:
    """Return a regular dataset with one field under each name, float64."""
    fields = fields or {"swh": {"standard_name": HS, "units": "m"}}
    time = clock(hours)
    values = field(
        time.values[:, None, None], np.asarray(lat)[None, :, None], np.asarray(lon)[None, None, :]
    )
    return xr.Dataset(
        {name: (("time", "lat", "lon"), values.copy(), attrs) for name, attrs in fields.items()},
        coords={"time": time, "lat": axis(lat, "lat"), "lon": axis(lon, "lon")},
    )


def mesh(*, start_index: int = 0, as_float: bool = False, location: str = "node") -> xr.Dataset:
    """Return a UGRID mesh of one quadrangle and two triangles with the affine field.

    Nodes::

        3---4---5
        | q | / |      q = 0 1 4 3, triangles 1 2 5 and 1 5 4
        0---1---2
    """
    lat = np.array([50.0, 50.0, 50.0, 51.0, 51.0, 51.2])
    lon = np.array([2.0, 3.0, 4.5, 2.0, 3.0, 4.0])
    faces = np.array([[0, 1, 4, 3], [1, 2, 5, -1], [1, 5, 4, -1]])
    table = np.where(faces < 0, -999, faces + start_index)
    encoding = {"_FillValue": -999}
    connectivity = xr.DataArray(
        np.where(faces < 0, np.nan, faces + start_index) if as_float else table.astype(np.int32),
        dims=("face", "corner"),
        attrs={"cf_role": "face_node_connectivity", "start_index": start_index}
        | ({} if as_float else encoding),
    )
    topology = {
        "cf_role": "mesh_topology",
        "topology_dimension": 2,
        "node_coordinates": "node_lon node_lat",
        "face_node_connectivity": "faces",
    }
    time = clock([0.0, 1.0])
    if location == "node":
        where = (lat, lon)
    else:
        used = faces >= 0
        where = tuple(
            np.where(used, a[np.maximum(faces, 0)], 0).sum(axis=1) / used.sum(axis=1)
            for a in (lat, lon)
        )
    values = affine(time.values[:, None], where[0][None], where[1][None])
    return xr.Dataset(
        {
            "topology": ((), 0, topology),
            "faces": connectivity,
            "swh": (("time", location), values, {"standard_name": HS, "units": "m"}),
            "node_lat": ("node", lat, {"standard_name": "latitude", "units": "degrees_north"}),
            "node_lon": ("node", lon, {"standard_name": "longitude", "units": "degrees_east"}),
        },
        coords={"time": time},
    )


def value(sea: Any, name: str, time: Any, lat: Any, lon: Any) -> np.ndarray:
    """Sample one variable."""
    return np.asarray(sea.sample([name], time, lat, lon)[name])
