from thalweg.network.alternatives.alternative_path import (
    AlternativePath,
    EdgeWeights,
    eca_fractions,
)
from thalweg.network.alternatives.path_search import alternative_paths, paths_without_canals
from thalweg.network.endpoints import with_endpoints
from thalweg.network.fixed_route import fixed_route
from thalweg.network.global_grid.globe_builder import globe
from thalweg.network.global_grid.globe_options import GlobeOptions
from thalweg.network.layered.layered_builder import layered_network
from thalweg.network.layered.layered_request import LayeredRequest
from thalweg.network.network import (
    Edges,
    Graph,
    Network,
    NetworkMeta,
    Samples,
    Stations,
)
from thalweg.network.network_check import check_network
from thalweg.network.regional_lattice.lattice_builder import default_spacing, lattice
from thalweg.network.shortest_paths import shortest_path
from thalweg.network.triangular_mesh.mesh_builder import mesh
from thalweg.network.triangular_mesh.thinning import spacing_fraction

__all__ = [
    "AlternativePath",
    "EdgeWeights",
    "Edges",
    "GlobeOptions",
    "Graph",
    "LayeredRequest",
    "Network",
    "NetworkMeta",
    "Samples",
    "Stations",
    "alternative_paths",
    "check_network",
    "default_spacing",
    "eca_fractions",
    "fixed_route",
    "globe",
    "lattice",
    "layered_network",
    "mesh",
    "paths_without_canals",
    "shortest_path",
    "spacing_fraction",
    "with_endpoints",
]
