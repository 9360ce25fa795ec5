from thalweg.search.departure_window import DepartureWindow, best_departure
from thalweg.search.earliest_arrival import earliest_arrival
from thalweg.search.fifo import FifoReport, earliest_arrivals_with_waiting, fifo_report
from thalweg.search.lower_bounds import LowerBound, direction_factor, lower_bound
from thalweg.search.pareto.front_problem import FrontQuery, MultiSettingShipOnNetwork
from thalweg.search.pareto.front_result import FrontPoint, FrontWork, NetworkFront, cheapest
from thalweg.search.pareto.pareto_search import pareto_front, path_costs
from thalweg.search.prepared_network import PreparedNetwork
from thalweg.search.profile_search import ProfileSearch, prepare_profile_search
from thalweg.search.search_problem import ShipOnNetwork
from thalweg.search.search_result import SearchResult, SearchWork
from thalweg.search.timed_path import Profile, TimedPath
from thalweg.ship.tables.table_bounds import table_bounds

__all__ = [
    "DepartureWindow",
    "FifoReport",
    "FrontPoint",
    "FrontQuery",
    "FrontWork",
    "LowerBound",
    "MultiSettingShipOnNetwork",
    "NetworkFront",
    "PreparedNetwork",
    "Profile",
    "ProfileSearch",
    "SearchResult",
    "SearchWork",
    "ShipOnNetwork",
    "TimedPath",
    "best_departure",
    "cheapest",
    "direction_factor",
    "earliest_arrival",
    "earliest_arrivals_with_waiting",
    "fifo_report",
    "lower_bound",
    "pareto_front",
    "path_costs",
    "prepare_profile_search",
    "table_bounds",
]
