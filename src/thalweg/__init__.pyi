from thalweg.chart.chart import Chart
from thalweg.core.errors import (
    CoverageError,
    DatasetError,
    InputError,
    ModelRangeError,
    NoRouteError,
    ThalwegError,
)
from thalweg.network.network import Network
from thalweg.network.regional_lattice.lattice_builder import lattice
from thalweg.network.triangular_mesh.mesh_builder import mesh
from thalweg.planning.plan import Plan
from thalweg.planning.planner import plan
from thalweg.planning.sea_distance import sea_distance as distance
from thalweg.planning.voyage import Voyage
from thalweg.route.referee.evaluation import evaluate
from thalweg.route.route import Route
from thalweg.route.track import Track
from thalweg.sea.sea import Sea
from thalweg.ship.ship import Ship

__version__: str

__all__ = [
    "Chart",
    "CoverageError",
    "DatasetError",
    "InputError",
    "ModelRangeError",
    "Network",
    "NoRouteError",
    "Plan",
    "Route",
    "Sea",
    "Ship",
    "ThalwegError",
    "Track",
    "Voyage",
    "distance",
    "evaluate",
    "lattice",
    "mesh",
    "plan",
]
