"""The OpenCLSim mix-in, against the real package."""

import datetime
from types import SimpleNamespace

import pytest

pytest.importorskip("openclsim")

import openclsim.core as core
import openclsim.model as model
import simpy
from shapely.geometry import Point

from thalweg.chart import Chart
from thalweg.core.errors import InputError, NoRouteError, OutsidePeriodError
from thalweg.core.time import parse_time
from thalweg.operations.dredging.project_inputs import open_project, open_project_inputs
from thalweg.operations.dredging.project_parts import SiteNetworkOptions
from thalweg.operations.examples.estuary import synthetic_estuary
from thalweg.operations.openclsim.leg_planner import LegPlanner
from thalweg.operations.openclsim.plugin import PlannedRouteMovable
from thalweg.sea import Sea

START = parse_time("2026-05-01T00:00Z")
PARTS = (
    core.Identifiable, PlannedRouteMovable, core.Processor, core.LoadingFunction,
    core.UnloadingFunction, core.HasContainer, core.HasResource, core.Log,
)  # fmt: skip
Vessel = type("Vessel", PARTS, {})
SITE = (core.Identifiable, core.Log, core.Locatable, core.HasContainer, core.HasResource)
Site = type("Site", SITE, {})


@pytest.fixture(scope="module")
def estuary():
    return synthetic_estuary(900.0)


@pytest.fixture(scope="module")
def leg_planner(estuary):
    ship = open_project_inputs(open_project("example"))[0]
    return LegPlanner.open(
        ship=ship, sea=estuary.sea, chart=estuary.chart, start=START, days=4.0,
        min_ukc=1.0, network=SiteNetworkOptions(margin=0.02, rings=2),
    )  # fmt: skip


def point(place):
    return Point(place[1], place[0])


@pytest.fixture
def yard(estuary, leg_planner):
    """A simulation with a vessel at the loading site and a site at either end."""
    env = simpy.Environment(initial_time=START)
    registry = {}
    pit = Site(name="pit", id="pit", geometry=point(estuary.load), capacity=20_000.0,
               level=20_000.0, env=env)  # fmt: skip
    beach = Site(name="beach", id="beach", geometry=point(estuary.unload), capacity=20_000.0,
                 level=0.0, env=env)  # fmt: skip
    vessel = Vessel(
        env=env, name="hopper", id="hopper", geometry=point(estuary.load), capacity=4000.0,
        leg_planner=leg_planner, loading_rate=1.5, unloading_rate=1.5,
    )  # fmt: skip
    return SimpleNamespace(env=env, registry=registry, pit=pit, beach=beach, vessel=vessel)


def project(yard, cycles, amount):
    """Load, sail full, unload, sail empty, some times over."""
    common = {"env": yard.env, "registry": yard.registry}

    def move(name, to):
        return model.MoveActivity(name=name, mover=yard.vessel, destination=to, **common)

    def shift(name, origin, destination, phase):
        return model.ShiftAmountActivity(
            name=name, processor=yard.vessel, origin=origin, destination=destination,
            amount=amount, phase=phase, **common,
        )  # fmt: skip

    steps = [
        shift("load", yard.pit, yard.vessel, "loading"),
        move("sail full", yard.beach),
        shift("unload", yard.vessel, yard.beach, "unloading"),
        move("sail empty", yard.pit),
    ]
    cycle = model.SequentialActivity(name="cycle", sub_processes=steps, **common)
    repeat = model.RepeatActivity(
        name="project", sub_processes=[cycle], repetitions=cycles, **common
    )
    model.register_processes([repeat])
    yard.env.run()


@pytest.mark.slow
def test_a_project_in_openclsim_sails_planned_legs(yard, leg_planner, estuary):
    project(yard, cycles=2, amount=2800.0)
    vessel = yard.vessel
    assert yard.beach.container.get_level() == pytest.approx(5600.0)
    assert len(vessel.legs) == 4
    for number, leg in enumerate(vessel.legs):
        loaded = number % 2 == 0
        places = (estuary.load, estuary.unload) if loaded else (estuary.unload, estuary.load)
        again = leg_planner.sail(*places, depart=leg.depart, load_factor=0.7 if loaded else 0.0)
        assert leg.arrive == again.arrive
        assert leg.distance == again.distance
        assert leg.clearance >= 1.0
    # the clock has advanced by loading, sailing and unloading
    pumping = 2 * 2 * 2800.0 / 1.5
    sailing = sum(leg.duration for leg in vessel.legs)
    assert yard.env.now - START == pytest.approx(pumping + sailing, abs=1.0)


@pytest.mark.slow
def test_the_log_contains_distance_energy_and_waits(yard):
    project(yard, cycles=2, amount=4000.0)  # a full ship waits for the tide on one of them
    vessel = yard.vessel
    stops = [row["ObjectState"] for row in vessel.logbook if "energy_j" in row["ObjectState"]]
    assert len(stops) == len(vessel.legs)
    for state, leg in zip(stops, vessel.legs):
        assert state["distance_m"] == leg.distance
        assert state["waiting_s"] == leg.waiting
        assert state["energy_j"] == pytest.approx(leg.energy) and leg.energy > 1e9
        assert state["fuel_kg"] == pytest.approx(leg.fuel)
        assert state["least_clearance_m"] >= 1.0
    waited = 0.0
    begin = None
    for row in vessel.logbook:
        if row["ActivityState"] == "WAIT_START":
            begin = row["Timestamp"]
        elif row["ActivityState"] == "WAIT_STOP":
            waited += (row["Timestamp"] - begin).total_seconds()
    assert waited == pytest.approx(sum(leg.waiting for leg in vessel.legs), abs=0.01)
    last = vessel.logbook[-1]["Timestamp"]
    ended = datetime.datetime.fromtimestamp(vessel.legs[-1].arrive, datetime.UTC)
    assert abs((last - ended.replace(tzinfo=None)).total_seconds()) < 0.01


@pytest.mark.slow
def test_speed_and_route_depend_on_the_load(yard, estuary):
    vessel = yard.vessel
    assert vessel.load_factor == 0.0
    assert vessel.v == pytest.approx(12.0 * 1852.0 / 3600.0)
    empty = vessel.compute_duration(vessel.geometry, point(estuary.unload))
    distance = vessel.compute_distance(vessel.geometry, point(estuary.unload))
    vessel.container.put(4000.0)
    yard.env.run()
    assert vessel.load_factor == 1.0
    assert vessel.v == pytest.approx(10.0 * 1852.0 / 3600.0)
    assert vessel.compute_duration(vessel.geometry, point(estuary.unload)) > empty
    assert vessel.compute_distance(vessel.geometry, point(estuary.unload)) >= distance
    assert vessel.compute_duration(vessel.geometry, vessel.geometry) == 0.0
    assert vessel.compute_distance(vessel.geometry, vessel.geometry) == 0.0


def test_a_given_duration_is_used(yard):
    def go():
        yield from yard.vessel.move(yard.beach, duration=600.0)

    yard.env.process(go())
    yard.env.run()
    assert yard.env.now == START + 600.0
    assert yard.vessel.legs == []


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"network": {"margin": -5.0}}, "margin_m is -5"),
        ({"network": {"spacing": 0}}, "spacing_m is 0"),
        ({"network": {"rings": 7}}, "rings is 7"),
        ({"network": {"detour": 0.1}}, "detour is 0.1"),
        ({"days": 1e6}, "period is 1000000.0 days"),
        ({"load_steps": True}, "load_steps is True"),
    ],
)
def test_invalid_fairways_are_refused(estuary, leg_planner, changes, words):
    asked = {"start": START, "days": 4.0, "min_ukc": 1.0, **changes}
    with pytest.raises(InputError, match=words):
        if "network" in asked:
            asked["network"] = SiteNetworkOptions(**asked["network"])
        LegPlanner.open(ship=leg_planner.ship, sea=estuary.sea, chart=estuary.chart, **asked)


def test_impossible_legs_are_reported(yard, leg_planner, estuary):
    with pytest.raises(InputError, match="engine order"):
        next(yard.vessel.move(yard.beach, engine_order=0.5))
    with pytest.raises(OutsidePeriodError, match="outside the period"):
        leg_planner.sail(estuary.load, estuary.unload, depart=START - 60.0, load_factor=0.0)
    with pytest.raises(NoRouteError, match="no route from"):
        leg_planner.sail(
            estuary.load, estuary.unload, depart=leg_planner.end - 600.0, load_factor=1.0
        )
    with pytest.raises(InputError, match="load factor is"):
        leg_planner.sail(estuary.load, estuary.unload, depart=START, load_factor=1.2)
    with pytest.raises(InputError, match="ends at the same place"):
        leg_planner.sail(estuary.load, estuary.load, depart=START, load_factor=0.0)
    with pytest.raises(InputError, match="on land or in a no-go zone"):
        leg_planner.sail(estuary.load, (52.9, 3.5), depart=START, load_factor=0.0)
    assert leg_planner._rounded(0.61) == 0.7  # never less than the actual draught
    assert leg_planner._rounded(0.6) == 0.6


def test_a_place_outside_the_data_is_named_and_not_the_load(estuary, leg_planner):
    deep = Sea.from_functions({"sea_floor_depth_below_geoid": lambda time, lat, lon: 30.0})
    wide = LegPlanner.open(
        ship=leg_planner.ship, sea=Sea.layered(estuary.sea, deep), start=START, days=1.0,
        chart=Chart.open_water(51.5, 52.0, 3.0, 4.0), min_ukc=1.0,
        network=SiteNetworkOptions(spacing=2000.0, rings=2),
    )  # fmt: skip
    outside = (51.85, 3.58)
    with pytest.raises(NoRouteError, match=r"The destination .* is outside the data") as refused:
        wide.sail(estuary.load, outside, depart=START, load_factor=0.0)
    assert "Load less" not in str(refused.value)
    with pytest.raises(
        NoRouteError, match=r"The origin .* is outside the data: there is no current"
    ):
        wide.sail(outside, estuary.load, depart=START, load_factor=0.0)
