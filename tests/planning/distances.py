"""Distances by sea that several tests look at: each is found once in a process."""

from functools import cache
from typing import Any

from thalweg.planning.sea_distance import SeaDistance
from thalweg.planning.sea_distance import sea_distance as distance_of_library


def sea_distance(start: Any, goal: Any, **options: Any) -> SeaDistance:
    """Return the distance of the library, that of the same request if it has been asked for."""
    hashable = {k: tuple(v) if isinstance(v, list) else v for k, v in options.items()}
    return _found(start, goal, tuple(sorted(hashable.items())))


@cache
def _found(start: Any, goal: Any, options: tuple[tuple[str, Any], ...]) -> SeaDistance:
    return distance_of_library(start, goal, **dict(options))
