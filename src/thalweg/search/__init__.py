"""Exact searches on networks through time-dependent water."""

from thalweg.search.bounds import Bound, direction_factor, lower_bound
from thalweg.search.departure import best_departure
from thalweg.search.earliest_arrival import earliest_arrival
from thalweg.search.fifo import FifoReport, earliest_arrivals_with_waiting, fifo_report
from thalweg.search.front import front
from thalweg.search.front_points import Front, FrontPoint, FrontWork, cheapest
from thalweg.search.profile import Passage, Passages, Profile
from thalweg.search.result import SearchResult, SearchWork
from thalweg.search.table_extremes import extreme
from thalweg.search.waters import Waters

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
