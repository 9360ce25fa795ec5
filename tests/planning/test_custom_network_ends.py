"""Networks of a user's builder begin and end where the voyage does."""

import pytest

from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.core.errors import InputError
from thalweg.network import lattice


@pytest.mark.parametrize("end", ["start", "goal"])
def test_a_network_between_other_places_is_refused(end):
    """A voyage of 60 nm was answered with the 31 nm of the network."""

    def builder(chart, start, goal, spacing=None):
        places = {"start": start, "goal": goal, end: (0.2, 0.5)}
        return lattice(chart, places["start"], places["goal"], spacing=20_000.0)

    voyage = Voyage(start=(0.0, 0.0), goal=(0.0, 1.0), depart="2026-01-01T00:00Z")
    ship, chart = Ship.simple(speed_kn=10.0, draught_m=5.0), Chart.open_water(-1, 1, -1, 2)
    with pytest.raises(InputError, match=f"has another {end} than the voyage"):
        plan(voyage, ship=ship, sea=Sea.calm(), chart=chart, network=builder, proof=0.0)
