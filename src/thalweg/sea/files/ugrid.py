"""UGRID: unstructured meshes of triangles, or of polygons divided into triangles.

Values at nodes are linear in each triangle. Values of faces are stored at the centre of the face
and averaged to its nodes (over the faces that are known at that time, weighted by the inverse of
the distance to their centres). Each face is divided into triangles between its centre and its
edges, and values are linear in those. So a field is continuous, has the file's value at every face
centre, and is unknown throughout a face that is unknown (dry).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from thalweg.core.arrays.cumulative_sums import cumulative_sums
from thalweg.core.errors import DatasetError
from thalweg.core.geodesy import longitude_difference
from thalweg.core.types import FloatArray, IntArray
from thalweg.kernels.geometry import field_sampling
from thalweg.sea.files import coordinates as co
from thalweg.sea.files import projections
from thalweg.sea.grids.triangle_grid import TriangleGrid
from thalweg.sea.triangle_mesh import Mesh


@dataclass(frozen=True, eq=False)
class FaceAveraging:
    """Averaging of face values to nodes: the faces around each node and their weights.

    Attributes
    ----------
    start, face : Faces of node n are ``face[start[n]:start[n + 1]]``.
    weight : One per entry of ``face``.
    """

    start: IntArray
    face: IntArray
    weight: FloatArray

    def append_nodes(self, values: FloatArray) -> FloatArray:
        """Return face values (T, 1, F) followed by node values: (T, 1, F + N)."""
        faces = np.ascontiguousarray(values[:, 0, :], np.float64)
        nodes = np.empty((faces.shape[0], self.start.size - 1))
        field_sampling.average_at_nodes(faces, self.start, self.face, self.weight, nodes)
        return np.concatenate([faces, nodes], axis=1)[:, None, :]


@dataclass(frozen=True, eq=False)
class MeshLayout:
    """The values along one dimension of a mesh: nodes or faces.

    Attributes
    ----------
    key : Name of the mesh and of the dimension.
    dim : Dimension of nodes or of faces.
    grid : Grid points and triangles.
    angle : Angle [rad] of the projection's x axis from east at each value, (1, values).
    """

    key: tuple[str, ...]
    dim: str
    grid: TriangleGrid
    angle: FloatArray | None = None
    averaging: FaceAveraging | None = None


@dataclass(frozen=True, eq=False)
class MeshTopology:
    """A mesh of a file: node positions and the nodes of each face (-1 after the last one)."""

    name: str
    lat: FloatArray
    lon: FloatArray
    faces: IntArray
    node_dim: str
    face_dim: str


#: names of the connectivity in files without mesh topology (ADCIRC, FVCOM)
_CONNECTIVITY_NAMES = ("element", "elements", "nv", "tri")


def topologies(dataset: Any) -> dict[str, Mapping[str, Any]]:
    """Return the two-dimensional meshes of a dataset: name and attributes of each.

    In a file without mesh topology, a connectivity table between nodes with positions gives one.
    """
    stated = {
        str(n): dataset[n].attrs
        for n in dataset.variables
        if dataset[n].attrs.get("cf_role") == "mesh_topology"
    }
    if stated:
        return {
            name: attributes
            for name, attributes in stated.items()
            if int(attributes.get("topology_dimension", attributes.get("dimension", 2))) == 2
        }
    return _inferred_topology(dataset)


def _inferred_topology(dataset: Any) -> dict[str, Mapping[str, Any]]:
    for name in dataset.variables:
        table = dataset[name]
        role = table.attrs.get("cf_role") == "face_node_connectivity"
        if table.ndim != 2 or not (role or str(name).lower() in _CONNECTIVITY_NAMES):
            continue
        places = _inferred_node_coordinates(dataset, frozenset(map(str, table.dims)))
        if places and min(table.shape) in (3, 4):
            face_dim = str(table.dims[int(np.argmax(table.shape))])
            return {
                str(name): {
                    "face_node_connectivity": str(name),
                    "node_coordinates": " ".join(places),
                    "face_dimension": face_dim,
                }
            }
    return {}


def _inferred_node_coordinates(dataset: Any, not_along: frozenset[str]) -> list[str]:
    """Return longitude and latitude of nodes: on one dimension that is not that of the faces."""
    along = [
        (str(n), dataset[n])
        for n in dataset.variables
        if dataset[n].ndim == 1 and dataset[n].dims[0] not in not_along
    ]
    x = next(((n, a) for n, a in along if co.is_longitude(a, n)), None)
    y = next(((n, a) for n, a in along if co.is_latitude(a, n)), None)
    return [x[0], y[0]] if x and y and x[1].dims == y[1].dims else []


def mesh_layouts(dataset: Any, mapping: Mapping[str, str], source: str) -> list[MeshLayout]:
    """Return the layouts for node and face data of every two-dimensional mesh of a dataset.

    Parameters
    ----------
    dataset : The file.
    mapping : Given by the user; its key "crs" names the projection.
    source : File name for messages.

    Raises
    ------
    DatasetError : If the topology is incomplete or positions are impossible.
    """
    return [
        layout
        for name, attributes in topologies(dataset).items()
        for layout in _mesh_layouts_of_topology(dataset, name, attributes, mapping, source)
    ]


def mesh_description_variables(dataset: Any) -> frozenset[str]:
    """Return the variables that describe meshes and hold no field."""
    names: set[str] = set()
    for mesh, attributes in topologies(dataset).items():
        names.add(mesh)
        for key, value in attributes.items():
            if key.endswith(("_coordinates", "_connectivity")):
                names.update(str(value).split())
    return frozenset(names)


def mesh_dimensions(dataset: Any) -> frozenset[str]:
    """Return the dimensions of nodes and of faces of every mesh, as far as the file has them."""
    dims: set[str] = set()
    for attributes in topologies(dataset).values():
        for key in ("node_coordinates", "face_coordinates", "face_node_connectivity"):
            for name in str(attributes.get(key, "")).split()[:1]:
                dims.update(map(str, dataset[name].dims if name in dataset.variables else ()))
    return frozenset(dims)


def _mesh_layouts_of_topology(
    dataset: Any,
    name: str,
    attributes: Mapping[str, Any],
    mapping: Mapping[str, str],
    source: str,
) -> list[MeshLayout]:
    connectivity = _required_names(dataset, attributes, "face_node_connectivity", source)[0]
    axes = _required_names(dataset, attributes, "node_coordinates", source)
    x, y, crs = _node_positions(dataset, axes, mapping, source)
    lat, lon = (y, x) if crs is None else projections.to_degrees(crs, x, y)
    _check_positions(lat, lon, source)
    table = dataset[connectivity]
    face_dim = str(attributes.get("face_dimension", table.dims[0]))
    face_dim = face_dim if face_dim in table.dims else str(table.dims[0])
    faces = read_faces(table.transpose(face_dim, ...), lat.size, source)
    node_dim = str(dataset[axes[0]].dims[0])
    topology = MeshTopology(name, lat, lon, faces, node_dim, face_dim)
    angle = None if crs is None else projections.meridian_angle(crs, x, y)
    return [_node_layout(topology, angle), _face_layout(topology, angle)]


def _required_names(
    dataset: Any, attributes: Mapping[str, Any], key: str, source: str
) -> list[str]:
    names = str(attributes.get(key, "")).split()
    if names and all(n in dataset.variables for n in names):
        return names
    raise DatasetError(
        f"{source}: the mesh has no {key}.",
        "UGRID meshes with node_coordinates and face_node_connectivity can be read.",
        "Write the file with a complete UGRID topology.",
        file=source,
    )


def _node_positions(
    dataset: Any, axes: list[str], mapping: Mapping[str, str], source: str
) -> tuple[FloatArray, FloatArray, Any]:
    """Return x, y and the projection; without one x is longitude and y latitude."""
    first, second = dataset[axes[0]], dataset[axes[1]]
    if co.is_latitude(first, axes[0]) or "y" in str(first.attrs.get("standard_name", ""))[:12]:
        first, second = second, first
    x, y = co.in_degrees(first), co.in_degrees(second)
    if co.is_longitude(first, str(first.name)) and co.is_latitude(second, str(second.name)):
        return x, y, None
    crs = projections.projection_of(dataset, first, mapping, source)
    if crs is not None and crs.is_geographic:
        return x, y, None
    if crs is None:
        raise projections.no_projection_error(source)
    return x, y, crs


def _check_positions(lat: FloatArray, lon: FloatArray, source: str) -> None:
    if not (np.isfinite(lat).all() and np.isfinite(lon).all() and (np.abs(lat) <= 90.0).all()):
        raise DatasetError(
            f"{source}: nodes of the mesh have impossible positions.",
            "Every node needs a latitude and a longitude.",
            "Check the projection of the file.",
            file=source,
        )


def read_faces(table: Any, nodes: int, source: str) -> IntArray:
    """Return the nodes of each face, counted from 0.

    Parameters
    ----------
    table : Connectivity (M, largest number of nodes); it may hold floats with NaN or an undecoded
        fill value, and count from 0 or 1.
    nodes : Number of nodes of the mesh.
    source : File name for messages.

    Returns
    -------
    int64 array (M, largest number of nodes) : -1 after the last node of a face.

    Raises
    ------
    DatasetError : If a face refers to a node that does not exist.
    """
    raw = np.asarray(table.values, np.float64)
    fill = table.attrs.get("_FillValue", table.encoding.get("_FillValue"))
    if fill is not None:
        raw = np.where(raw == float(np.asarray(fill).ravel()[0]), np.nan, raw)
    raw = np.where(raw < 0.0, np.nan, raw)
    given = table.attrs.get("start_index")
    low, high = np.nanmin(raw), np.nanmax(raw)
    start = int(given) if given is not None else int(low >= 1.0 and high == nodes)
    if low < start or high > nodes - 1 + start:
        if not (low >= 1.0 and high <= nodes):
            raise DatasetError(
                f"{source}: faces of the mesh use nodes {low:g} to {high:g} of {nodes}.",
                "Each face must refer to nodes of the mesh.",
                "Correct face_node_connectivity and its start_index.",
                file=source,
            )
        start = 1
    return np.where(np.isnan(raw), -1, raw - start).astype(np.int64)


def triangulate_faces(faces: IntArray) -> IntArray:
    """Return triangles (K, 3) of faces (M, N), each face divided from its first node."""
    pieces = []
    for k in range(1, faces.shape[1] - 1):
        whole = faces[:, k + 1] >= 0
        pieces.append(np.stack([faces[whole, 0], faces[whole, k], faces[whole, k + 1]], axis=1))
    return np.ascontiguousarray(np.concatenate(pieces))


def _node_layout(mesh: MeshTopology, angle: FloatArray | None) -> MeshLayout:
    triangles = triangulate_faces(mesh.faces)
    network = Mesh(mesh.lat, mesh.lon, triangles)
    grid = TriangleGrid(mesh.lat, mesh.lon, triangles, (1, mesh.lat.size), network)
    rotated = None if angle is None else angle[None, :]
    return MeshLayout((mesh.name, mesh.node_dim), mesh.node_dim, grid, rotated)


def _face_layout(mesh: MeshTopology, angle: FloatArray | None) -> MeshLayout:
    lat, lon = _face_centres(mesh)
    count = lat.size
    used = mesh.faces >= 0
    following = np.roll(mesh.faces, -1, axis=1)
    last = used.sum(axis=1) - 1
    following[np.arange(count), last] = mesh.faces[:, 0]
    row, column = np.nonzero(used)
    triangles = np.stack(
        [row, count + mesh.faces[row, column], count + following[row, column]], axis=1
    )
    network = Mesh(mesh.lat, mesh.lon, triangulate_faces(mesh.faces))
    grid = TriangleGrid(
        np.concatenate([lat, mesh.lat]),
        np.concatenate([lon, mesh.lon]),
        np.ascontiguousarray(triangles, np.int64),
        (1, count + mesh.lat.size),
        network,
    )
    rotated = None
    if angle is not None:
        rotated = np.where(used, angle[np.maximum(mesh.faces, 0)], 0.0).sum(axis=1) / (last + 1)
        rotated = rotated[None, :]
    averaging = _face_averaging(mesh, lat, lon)
    return MeshLayout((mesh.name, mesh.face_dim), mesh.face_dim, grid, rotated, averaging)


def _face_centres(mesh: MeshTopology) -> tuple[FloatArray, FloatArray]:
    """Return the mean position of the nodes of each face, across the antimeridian too."""
    used = mesh.faces >= 0
    number = used.sum(axis=1)
    corner = np.maximum(mesh.faces, 0)
    first = mesh.lon[corner[:, :1]]
    offset = longitude_difference(mesh.lon[corner], first)
    lat = np.where(used, mesh.lat[corner], 0.0).sum(axis=1) / number
    lon = first[:, 0] + np.where(used, offset, 0.0).sum(axis=1) / number
    return lat, lon


def _face_averaging(mesh: MeshTopology, lat: FloatArray, lon: FloatArray) -> FaceAveraging:
    row, column = np.nonzero(mesh.faces >= 0)
    node = mesh.faces[row, column]
    order = np.argsort(node, kind="stable")
    face, node = row[order].astype(np.int64), node[order]
    east = longitude_difference(lon[face], mesh.lon[node])
    distance = np.hypot(east * np.cos(np.radians(mesh.lat[node])), lat[face] - mesh.lat[node])
    start = cumulative_sums(np.bincount(node, minlength=mesh.lat.size))
    return FaceAveraging(start.astype(np.int64), face, 1.0 / np.maximum(distance, 1e-12))
