"""Networks of ways over the sea, as plain arrays, and the builders that make them."""

from thalweg.network.alternatives.alternative_path import Way, Weighing, eca_shares
from thalweg.network.alternatives.path_search import alternatives, ways_round
from thalweg.network.endpoints import with_endpoints
from thalweg.network.fixed_route import line
from thalweg.network.global_grid.globe_builder import globe
from thalweg.network.network import Network, NetworkMeta, check_network, shortest
from thalweg.network.regional_lattice.lattice_builder import default_spacing, lattice
from thalweg.network.triangular_mesh.mesh_builder import mesh
from thalweg.network.triangular_mesh.thinning import spacing_fraction

__all__ = [
    "Network",
    "NetworkMeta",
    "Way",
    "Weighing",
    "alternatives",
    "check_network",
    "default_spacing",
    "eca_shares",
    "globe",
    "lattice",
    "line",
    "mesh",
    "shortest",
    "spacing_fraction",
    "ways_round",
    "with_endpoints",
]
