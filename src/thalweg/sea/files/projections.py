"""Map projections of files, and the angles between grid axes and true east."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from thalweg.core.errors import DatasetError
from thalweg.core.geodesy import local_axes, longitude_difference
from thalweg.core.types import FloatArray
from thalweg.sea.files.variable_aliases import naming_of


def projection_of(dataset: Any, array: Any, mapping: Mapping[str, str], source: str) -> Any:
    """Return the projection of a variable or dataset.

    Parameters
    ----------
    dataset, array : The file and one of its variables.
    mapping : Its key "crs" has priority over the file.
    source : File name for messages.

    Returns
    -------
    pyproj.CRS or None : None if the file names no projection.

    Raises
    ------
    DatasetError : If the projection is not valid.
    """
    from pyproj import CRS
    from pyproj.exceptions import CRSError

    text = mapping.get("crs")
    try:
        if text:
            return CRS.from_user_input(text)
        for name in _grid_mappings(dataset, array):
            attributes = {
                k: (v.tolist() if isinstance(v, np.ndarray) else v)
                for k, v in dataset[name].attrs.items()
            }
            for key in ("crs_wkt", "spatial_ref", "proj4_string", "proj4", "proj4_params"):
                if attributes.get(key):
                    return CRS.from_user_input(attributes[key])
            for key in ("epsg", "EPSG", "epsg_code", "EPSG_code"):
                if attributes.get(key):
                    code = str(attributes[key]).upper().removeprefix("EPSG:")
                    return CRS.from_epsg(int(code))
            if attributes.get("grid_mapping_name"):
                return CRS.from_cf(attributes)
        for key in ("crs", "projection", "epsg"):
            if dataset.attrs.get(key):
                return CRS.from_user_input(str(dataset.attrs[key]))
    except (CRSError, ValueError, KeyError) as error:
        raise DatasetError(
            f"{source}: its projection is not valid ({error}).",
            "An EPSG code, WKT, PROJ text or CF grid mapping can be read.",
            f"Name it: {naming_of('crs', 'EPSG:...')}.",
            file=source,
        ) from error
    return None


def _grid_mappings(dataset: Any, array: Any) -> list[str]:
    named = array.attrs.get("grid_mapping") or array.encoding.get("grid_mapping")
    names = [str(named)] if named else []
    names += [
        str(n)
        for n in dataset.variables
        if "grid_mapping_name" in dataset[n].attrs
        or str(n) in ("projected_coordinate_system", "wgs84")
    ]
    return [n for n in names if n in dataset.variables]


def to_degrees(crs: Any, x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return lat and lon [deg] of projected positions [m], of their shape; NaN stays NaN.

    Parameters
    ----------
    crs : Projection, or its EPSG code.
    x, y : Projected positions [m], of one shape.

    Returns
    -------
    lat, lon : Positions [deg]; NaN where unknown.
    """
    from pyproj import Transformer

    known = np.isfinite(x) & np.isfinite(y)
    lat, lon = np.full(x.shape, np.nan), np.full(x.shape, np.nan)
    transformer = Transformer.from_crs(crs, 4326, always_xy=True)
    lon[known], lat[known] = transformer.transform(x[known], y[known])
    lat[~np.isfinite(lat)] = np.nan
    return lat, lon


def meridian_angle(crs: Any, x: FloatArray, y: FloatArray) -> FloatArray:
    """Return the angle [rad] from true east, counter-clockwise, to the x axis of a projection.

    Parameters
    ----------
    x, y : Projected positions [m], of one shape.

    Returns
    -------
    float64 array : Angle [rad], the negative of the meridian convergence for north-up projections.
    """
    lat, lon = to_degrees(crs, x, y)
    lat2, lon2 = to_degrees(crs, x + 100.0, y)
    return np.arctan2(lat2 - lat, longitude_difference(lon2, lon) * np.cos(np.radians(lat)))


def grid_angle(lat: FloatArray, lon: FloatArray) -> FloatArray:
    """Return the angle from true east to the direction of increasing column number of a grid.

    It is computed from the positions of neighbouring columns as vectors in space, so it is correct
    at the antimeridian and near the poles.

    Parameters
    ----------
    lat, lon : Positions [deg], (Y, X).

    Returns
    -------
    float64 array (Y, X) : Angle [rad], counter-clockwise.
    """
    up, east, north = local_axes(lat, lon)
    along = np.empty_like(up)
    along[:, 1:-1] = up[:, 2:] - up[:, :-2]
    along[:, 0] = up[:, 1] - up[:, 0]
    along[:, -1] = up[:, -1] - up[:, -2]
    return np.asarray(np.arctan2((along * north).sum(axis=-1), (along * east).sum(axis=-1)))


def no_projection_error(source: str) -> DatasetError:
    """Return the error for projected positions without a projection."""
    return DatasetError(
        f"{source}: positions are in metres of a projection that the file does not name.",
        "Latitude and longitude are needed, or a projection.",
        f"Name it: {naming_of('crs', 'EPSG:...')}.",
        file=source,
    )
