"""A bar that is dry until it opens: arrive, wait, go on (truth: max(s1/V, To) + (L - s1)/V)."""

import numpy as np
import pytest

from tests.search.small import line, limits, make_fields, steady
from thalweg.search import earliest_arrival

HOUR = 3600.0


def bar(opens: float, step: float = 600.0):
    """A way of 80 km in pieces of 2 km; the water at 30 km is too low until ``opens``."""
    network = line(41, 2000.0, depth=10.0)
    times = np.arange(0.0, 12 * HOUR + 1, step)
    level = np.zeros((41, len(times)))
    level[16] = np.where(times < opens, -8.0, 0.0)  # the node beyond the bar's edge at 30 km
    return network, make_fields(network, times, water_level=level)


def sail(network, fields, **options):
    given = {
        "start": 0, "goal": 40, "depart": 0.0, "setting": 0,
        "limits": limits(depth=5.0), "top_speed": 4.0,
    }  # fmt: skip
    return earliest_arrival(network, fields, steady(4.0), **(given | options))


@pytest.mark.parametrize(("opens_h", "expected"), [(5.0, 30500.0), (1.0, 20000.0)])
@pytest.mark.parametrize("method", ["astar", "dijkstra"])
def test_a_ship_waits_at_a_bar_only_until_it_opens(opens_h, expected, method):
    opens = opens_h * HOUR
    network, fields = bar(opens, step=1.0 if opens_h > 1 else 600.0)
    result = sail(network, fields, method=method)
    # The edge onto the bar takes 500 s and is open once the water stands at its end on arrival.
    early = 500.0 if opens_h > 1 else 0.0
    assert result.arrive == pytest.approx(expected - early, abs=1.5)
    assert result.path.tolist() == list(range(41))
    assert result.waiting == pytest.approx(max(0.0, expected - early - 20000.0), abs=1.5)
