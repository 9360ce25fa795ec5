"""Networks of ways over the sea, as plain arrays, and the builders that make them."""

from thalweg.network.endpoints import with_endpoints
from thalweg.network.globe import globe
from thalweg.network.lattice import default_spacing, lattice
from thalweg.network.line import line
from thalweg.network.mesh import mesh
from thalweg.network.network import Network, NetworkMeta, check_network, shortest
from thalweg.network.pruning import spacing_fraction
from thalweg.network.way import Way, Weighing, eca_shares
from thalweg.network.ways import alternatives, ways_round

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
