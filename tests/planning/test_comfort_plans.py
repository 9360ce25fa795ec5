"""Plans for comfort: exact fronts of time against the motion sickness dose on layered networks."""

import itertools

import numpy as np
import pytest

from thalweg.chart import Chart
from thalweg.core.errors import InputError
from thalweg.core.limits import Limits
from thalweg.core.objective import LegPrices
from thalweg.network import layered_network
from thalweg.planning import Voyage, plan
from thalweg.route.refinement.track_geometry import course_changes
from thalweg.sea import Sea
from thalweg.search import FrontQuery, MultiSettingShipOnNetwork, pareto_front
from thalweg.ship import Ship
from thalweg.ship.comfort.dose_table import squared_dose_table

PERIOD = "sea_surface_wave_period_at_variance_spectral_density_maximum"
DEPART = 1.7e9
DATA = {
    "name": "small", "speeds_kn": [6.0, 8.0, 10.0], "places": {"mess": 0.0, "bridge": 8.0},
    "hull": {"length_between_perpendiculars_m": 33.9, "breadth_m": 9.6, "draught_m": 2.8,
             "block_coefficient": 0.62},
    "fuel": {"reference_t_per_day": 3.0}, "engine": {"reference_speed_kn": 10.0},
}  # fmt: skip


def _sea():
    """A storm on the direct line that grows for hours; waves come from the north."""

    def height(time, lat, lon):
        middle = np.exp(-(((np.asarray(lat) - 65.0) / 0.08) ** 2))
        return 0.5 + (1.0 + 0.2 * (time - DEPART) / 3600.0) * middle

    functions = {
        "sea_surface_wave_significant_height": height,
        PERIOD: lambda t, lat, lon: 8.0,
        "sea_surface_wave_from_direction": lambda t, lat, lon: 0.0,
        "eastward_wind": lambda t, lat, lon: 0.0,
        "northward_wind": lambda t, lat, lon: 0.0,
    }
    return Sea.from_functions(functions, time_step=1800.0)


@pytest.fixture(scope="module")
def ship():
    return Ship.from_dict(DATA)


@pytest.fixture(scope="module")
def problem(ship):
    network = layered_network(
        Chart.open_water(), [(65.0, 0.0), (65.0, 1.0)], layers=3, fan=3, offset=8000.0
    )
    lat, lon = network.stations.lat, network.stations.lon
    channels = _wave_channels()
    fields = _sea().freeze_stations(lat, lon, DEPART, DEPART + 20 * 3600.0, channels)
    return MultiSettingShipOnNetwork(
        network, fields, ship.tabulate(), squared_dose_table(ship), Limits()
    )


def _wave_channels():
    from thalweg.sea import standard_names
    from thalweg.ship.condition_variables import WAVES

    names = standard_names.CHANNEL_VARIABLES.items()
    return tuple(sorted(channel for channel, name in names if name in WAVES))


@pytest.mark.slow
def test_front_of_time_and_comfort_is_that_of_all_walks(problem):
    """Dynamic programming against every walk at every choice of speed, in weather that changes."""
    network = problem.network
    query = FrontQuery(
        network.meta.start, network.meta.goal, DEPART, DEPART + 12 * 3600.0, wait=False,
        prices=LegPrices(consumption="squared_dose"),
    )  # fmt: skip
    found = pareto_front(problem, query, bin_s=60.0)
    every = _all_walks(problem)
    for point in found.points:
        assert any(
            abs(time - point.time) < 1.0 and abs(dose - point.cost) < 1e-6 * dose + 1e-9
            for time, dose in every
        )
    best = _front(every)
    assert min(p.cost for p in found.points) == pytest.approx(best[-1][1], rel=2e-3)
    assert min(p.time for p in found.points) == pytest.approx(best[0][0], abs=1.0)
    for time, dose in best:  # no walk is below the front by more than the bins allow
        reachable = min(p.cost for p in found.points if p.time <= time + 61.0)
        assert reachable <= dose * 1.01
    least = min(p.cost for p in found.points)
    assert float(np.min(found.lower_cost)) >= 0.99 * least  # the certificate closes to 1 %


def _all_walks(problem):
    """Sail every walk at every choice of settings by the kernel that sails edges."""
    from thalweg.kernels.pareto.edge_tables import sail_path
    from thalweg.search.pareto.front_problem import make_front_problem, new_edge_workspace
    from thalweg.search.pareto.pareto_search import _request

    network = problem.network
    query = FrontQuery(
        network.meta.start, network.meta.goal, DEPART, DEPART + 12 * 3600.0, wait=False,
        prices=LegPrices(consumption="squared_dose"),
    )  # fmt: skip
    arrays = make_front_problem(problem, _request(problem, query)).arrays
    leaving = {}
    for edge, tail in enumerate(network.tails().tolist()):
        leaving.setdefault(tail, []).append((edge, int(network.graph.target[edge])))

    def walks(node):
        if node == network.meta.goal:
            yield []
        for edge, head in leaving.get(node, []):
            yield from ([edge, *rest] for rest in walks(head))

    found = []
    for edges in walks(network.meta.start):
        for choices in itertools.product(range(3), repeat=len(edges)):
            count = len(edges)
            nodes = np.array([network.tails()[e] for e in edges] + [network.meta.goal], np.int64)
            arrive, depart = np.empty(count + 1), np.empty(count + 1)
            arrive[0] = DEPART
            cost, status = sail_path(
                arrays, nodes, np.array(edges, np.int64), np.array(choices, np.int64),
                np.full(count, -np.inf), arrive, depart, new_edge_workspace(),
            )  # fmt: skip
            if status == 0:
                found.append((float(arrive[-1]) - DEPART, float(cost)))
    return found


def _front(points):
    best = []
    for time, dose in sorted(points):
        if not best or dose < best[-1][1] - 1e-12:
            best.append((time, dose))
    return best


@pytest.fixture(scope="module")
def plans(ship):
    found = {}
    for objective in ("time", "fuel", "comfort"):
        voyage = Voyage(
            start=(65.0, 0.0), goal=(65.0, 1.0), depart=DEPART, objective=objective,
            method="exact", offing_nm=0.0, layered={"layers": 5, "fan": 5, "offset_nm": 2.5},
            speed_block_h=0.0,
        )  # fmt: skip
        found[objective] = plan(voyage, ship=ship, sea=_sea(), chart=Chart.open_water())
    return found


@pytest.mark.slow
def test_every_single_optimum_is_no_worse_in_its_own_indicator(plans):
    """Chapter 13 d of the study of Prestegardshus (2020)."""
    for name, attribute in (("time", "time_h"), ("fuel", "fuel_t"), ("comfort", "comfort")):
        own = getattr(plans[name].best, attribute)
        others = [getattr(p.best, attribute) for key, p in plans.items() if key != name]
        assert own <= min(others) * (1.0 + 1e-3)
    calm, fast = plans["comfort"].best, plans["time"].best
    assert calm.comfort < 0.6 * fast.comfort
    assert np.abs(calm.track.lat - 65.0).max() > 0.05  # round the storm


@pytest.mark.slow
def test_the_front_reaches_from_the_fastest_to_the_most_comfortable(plans):
    front = plans["comfort"]
    assert front.front.criterion == "comfort" and front.front.unit == "m2/s3"
    times = [route.time_h for route in front.routes]
    assert min(times) == pytest.approx(plans["time"].best.time_h, rel=0.01)
    doses = [route.comfort for route in front.routes]
    assert min(doses) == front.best.comfort


def test_comfort_needs_places(ship):
    plain = Ship.from_dict({key: value for key, value in DATA.items() if key != "places"})
    voyage = Voyage(start=(65.0, 0.0), goal=(65.0, 1.0), depart=DEPART, objective="comfort")
    with pytest.raises(InputError, match="no named places"):
        plan(voyage, ship=plain, sea=_sea(), chart=Chart.open_water())


@pytest.mark.slow
def test_outputs_state_the_sickness_at_every_place(plans):
    plan_of_comfort = plans["comfort"]
    (row, *_) = plan_of_comfort.to_dict()["routes"]
    places = row["indicators"]["places"]
    assert set(places) == {"mess", "bridge"}
    sick = places["bridge"]["sick_percent"]
    assert sick == plan_of_comfort.best.indicators["places"]["bridge"]["sick_percent"] > 0.0
    assert f"bridge {sick:.0f} %" in str(plan_of_comfort)


@pytest.mark.slow
def test_the_route_of_least_motion_sickness_does_not_tack_in_a_strait(ship):
    """Gisund in waves from abeam: the path of the network turned 7 times in 12 miles."""
    beam = {"sea_surface_wave_significant_height": 2.0, PERIOD: 8.0}
    constants = {**beam, "sea_surface_wave_from_direction": 290.0, "eastward_wind": 6.0,
                 "northward_wind": -2.0}  # fmt: skip
    functions = {
        name: lambda t, lat, lon, v=value: v + 0.0 * lat for name, value in constants.items()
    }
    sea = Sea.from_functions(functions, time_step=1800.0)
    voyage = Voyage(start=(69.30, 18.0), goal=(69.45, 18.1), depart=DEPART, objective="comfort")
    found = plan(voyage, ship=ship, sea=sea, proof=0.0)
    track = found.best.track
    turns = np.abs(course_changes(track.lat, track.lon))
    assert np.count_nonzero(turns > np.radians(30.0)) <= 4
