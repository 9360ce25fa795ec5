"""Lattices of several resolutions between two places: the way round land is found once."""

import numpy as np
import pytest

from thalweg import Chart
from thalweg.core.errors import NoRouteError
from thalweg.network import NetworkMeta
from thalweg.planning.network_selection import network_builder, route_alternatives
from thalweg.planning.network_selection.network_builder import LatticeBetween

NEAR, FAR = ((50.0, 0.0), (50.0, 2.0)), ((0.0, 0.0), (0.0, 60.0))


class Built:
    """A network with the arguments it was built with."""

    def __init__(self, nodes=0, **options):
        self.n_nodes, self.options = nodes, options
        self.meta = NetworkMeta("lattice", 1.0, 32, 0.1)


@pytest.fixture
def calls(monkeypatch):
    """Record the lattices, and the lengths of paths over the globe network in degrees."""
    found = {"lattices": [], "globes": 0, "degrees": 200.0, "refuse_detours": False}

    def lattice(chart, start, goal, **options):
        found["lattices"].append(options)
        if "detour" in options and found["refuse_detours"]:
            raise NoRouteError("too long", "", "")
        return Built(**options)

    def path(chart, start, goal):
        found["globes"] += 1
        return [start, (20.0, 30.0), goal], found["degrees"] * 111_195.0

    monkeypatch.setattr(network_builder, "lattice", lattice)
    monkeypatch.setattr(LatticeBetween, "_globe_path", lambda self: path(None, *self.places))
    return found


def blocked(chart, is_blocked, monkeypatch):
    monkeypatch.setattr(type(chart), "legs_blocked", lambda *_: np.array([is_blocked]))
    return chart


@pytest.mark.parametrize(
    ("degrees", "refused", "globes", "alongs"),
    [
        (200.0, True, 1, [True, True]),  # surely too far round for a whole lattice
        (63.0, False, 1, [False, False]),  # hardly longer than the straight line
        (63.0, True, 2, [False, True, True]),  # longer on the lattice than on the globe network
    ],
)
def test_the_way_round_land_is_found_once(calls, monkeypatch, degrees, refused, globes, alongs):
    calls |= {"degrees": degrees, "refuse_detours": refused}
    lattices = LatticeBetween(blocked(Chart.open_water(), True, monkeypatch), *FAR)
    for levels in (0, 1):
        lattices.network(coast_levels=levels)
    assert calls["globes"] == globes
    assert ["detour" not in options for options in calls["lattices"]] == alongs
    assert calls["lattices"][-1]["coast_levels"] == 1


def test_open_water_and_short_voyages_need_no_globe_network(calls, monkeypatch):
    LatticeBetween(blocked(Chart.open_water(), False, monkeypatch), *FAR).network()
    LatticeBetween(blocked(Chart.open_water(), True, monkeypatch), *NEAR).network()
    assert calls["globes"] == 0
    assert calls["lattices"][1]["along"] is None


def test_the_lattice_of_default_resolution_is_built_once(calls):
    """77 nm apart the spacing is 1.4 km: coasts are no finer than that or halved twice at most."""
    lattices = LatticeBetween(Chart.open_water(), *NEAR)
    found = [lattices.network(coast_levels=levels) for levels in range(4)]
    assert lattices.network() in found
    assert lattices.network(coast_levels=found.index(lattices.network())) is lattices.network()
    assert len(calls["lattices"]) == 4
    lattices.network(spacing=5000.0)
    assert len(calls["lattices"]) == 5


@pytest.mark.parametrize(
    ("nodes", "levels", "corridor"),
    [
        ([10, 20, 30], 2, False),
        ([10, 4000], 0, False),
        ([4000], 0, True),
        ([None, 20, 30], 2, False),
    ],
)
def test_the_finest_lattice_that_is_small_enough_is_taken(monkeypatch, nodes, levels, corridor):
    built = iter(nodes)

    def network(self, **options):
        count = next(built)
        if count is None:
            raise NoRouteError("too coarse", "", "")
        return Built(count, **options)

    monkeypatch.setattr(LatticeBetween, "network", network)
    monkeypatch.setattr(
        route_alternatives, "_corridor_lattice", lambda _, wide, places: Built(0, along=wide)
    )
    found = route_alternatives._finest_small_lattice(LatticeBetween(Chart.open_water(), *NEAR))
    assert ("along" in found.options) == corridor
    if not corridor:
        assert found.options["coast_levels"] == levels
