"""Networks of ways over the sea, as plain arrays, and the builders that make them."""

from thalweg.network.endpoints import with_endpoints
from thalweg.network.lattice import default_spacing, lattice
from thalweg.network.network import Network, NetworkMeta, check_network, shortest

__all__ = [
    "Network",
    "NetworkMeta",
    "check_network",
    "default_spacing",
    "lattice",
    "shortest",
    "with_endpoints",
]
