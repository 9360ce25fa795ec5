"""Exact searches on networks through time-dependent water."""

from thalweg.search.departure_window import best_departure
from thalweg.search.earliest_arrival import earliest_arrival
from thalweg.search.fifo import FifoReport, earliest_arrivals_with_waiting, fifo_report
from thalweg.search.lower_bounds import Bound, direction_factor, lower_bound
from thalweg.search.pareto.front_result import Front, FrontPoint, FrontWork, cheapest
from thalweg.search.pareto.pareto_search import front
from thalweg.search.prepared_network import Waters
from thalweg.search.profile_search import Passage, Passages, Profile
from thalweg.search.search_result import SearchResult, SearchWork
from thalweg.ship.tables.table_bounds import extreme

__all__ = [
    "Bound",
    "FifoReport",
    "Front",
    "FrontPoint",
    "FrontWork",
    "Passage",
    "Passages",
    "Profile",
    "SearchResult",
    "SearchWork",
    "Waters",
    "best_departure",
    "cheapest",
    "direction_factor",
    "earliest_arrival",
    "earliest_arrivals_with_waiting",
    "extreme",
    "fifo_report",
    "front",
    "lower_bound",
]
