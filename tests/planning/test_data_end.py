"""A route that arrives after the data end is refused with that reason first."""

import pytest

from tests.sea.small_datasets import EAST, NORTH, T0, regular
from thalweg import Chart, NoRouteError, Sea, Ship, Voyage, plan

CHART = Chart.open_water(-0.6, 0.6, -0.2, 2.2)


def test_the_end_of_the_data_is_the_first_reason():
    fields = {name: {"standard_name": name, "units": "m s-1"} for name in (EAST, NORTH)}
    still = regular(
        (-1.0, 1.0), (-1.0, 3.0), fields=fields, field=lambda t, lat, lon: 0.0 * (t + lat + lon)
    )
    ship = Ship.simple(speed_kn=12.0, draught_m=5.0)  # 120 nm in 10 h; the data have 3 h
    with pytest.raises(NoRouteError) as caught:
        plan(
            Voyage(start=(0.0, 0.0), goal=(0.0, 2.0), depart=T0),
            ship=ship, sea=Sea.open(still), chart=CHART, resolution=10_000.0,
        )  # fmt: skip
    assert "arrives before the data end at 2023-11-15T01:00:00Z" in caught.value.asked
    assert caught.value.remedy.startswith("Add a longer forecast, or depart earlier.")
    assert caught.value.details["data_end"] == "2023-11-15T01:00:00Z"
