"""The greatest speed in bounds, also of ship models that know none."""

import math
from types import SimpleNamespace

import pytest

from thalweg import Ship
from thalweg.planning.planning_context import greatest_speed_of

TABLE = Ship.simple(speed_kn=10.0).tabulate()


@pytest.mark.parametrize(
    ("known", "field", "greatest"),
    [
        (7.0, None, 7.0),
        (None, None, TABLE.largest(0)),  # was 0 in bounds of cost, which made them too high
        (None, lambda *at: 0.0, math.inf),
    ],
)
def test_an_unknown_top_speed_is_that_of_the_table_and_never_lower(known, field, greatest):
    ship = SimpleNamespace(top_speed=lambda setting: known, speed_field=field)
    assert greatest_speed_of(ship, TABLE, 0) == greatest
    assert greatest >= 10.0 * 1852.0 / 3600.0
