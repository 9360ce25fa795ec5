"""Waiting studies: the departures and waits that give the shortest trips or the least energy."""

from thalweg.deprecated_names import renamed
from thalweg.operations.waiting.departures import Departures
from thalweg.operations.waiting.trip_durations import trip_table
from thalweg.operations.waiting.trip_table import TripTable
from thalweg.operations.waiting.waiting_optimisation import (
    DEPARTURE_RULES,
    WaitingPlan,
    optimum_energy,
    plan_waiting,
)
from thalweg.operations.waiting.waiting_study import WaitingStudy, break_even_power, waiting_study

__all__ = [
    "DEPARTURE_RULES",
    "Departures",
    "TripTable",
    "WaitingPlan",
    "WaitingStudy",
    "break_even_power",
    "optimum_energy",
    "plan_waiting",
    "trip_table",
    "waiting_study",
]

__getattr__ = renamed("thalweg.operations.waiting")
