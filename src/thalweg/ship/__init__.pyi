from thalweg.ship.conditions import Conditions
from thalweg.ship.file.ship_file import library_names
from thalweg.ship.hull.estimate import Estimate
from thalweg.ship.loading_state import Loading
from thalweg.ship.model_check import check_ship_model
from thalweg.ship.model_protocol import ShipModel
from thalweg.ship.plugins import plugin_names
from thalweg.ship.ship import Ship
from thalweg.ship.ship_limits import ShipLimits
from thalweg.ship.tables.performance_table import PerformanceTable
from thalweg.ship.tables.table_parts import TableError, TablePart

__all__ = [
    "Conditions",
    "Estimate",
    "Loading",
    "PerformanceTable",
    "Ship",
    "ShipLimits",
    "ShipModel",
    "TableError",
    "TablePart",
    "check_ship_model",
    "library_names",
    "plugin_names",
]
