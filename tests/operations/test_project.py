"""Dredging projects: from a file to cycles, totals and files."""

import csv
import itertools
import json
import math
import sys
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr
import yaml

from tests.conftest import data_file
from thalweg import Chart, Sea, Ship
from thalweg.cli.main import main
from thalweg.core.errors import CoverageError, InputError, NoRouteError, OutsidePeriodError
from thalweg.core.file_writing import new_figure
from thalweg.core.geodesy import direct, distance, inverse
from thalweg.core.time import parse_time
from thalweg.operations.dredging.cycle_records import SailedLeg, cycle_record
from thalweg.operations.dredging.loading_curves import LoadingCurve
from thalweg.operations.dredging.project import Project
from thalweg.operations.dredging.project_environment import (
    ProjectEnvironment,
    freeze_site_network,
    project_network,
)
from thalweg.operations.dredging.project_inputs import (
    example_file,
    open_project,
    open_project_inputs,
)
from thalweg.operations.dredging.project_result import TABLE_ROWS, summarise_run
from thalweg.operations.dredging.run_project import run_project
from thalweg.operations.dredging.verified_legs import (
    SiteLegPlanner,
    _essential_nodes,
    track_of_path,
)
from thalweg.operations.dredging.work_windows import WorkWindows
from thalweg.operations.examples.estuary import bed_depth
from thalweg.operations.plots import draw_routes
from thalweg.operations.plots.project_plots import _draw_load_factors, time_shares
from thalweg.operations.result_files import write_project_files
from thalweg.planning.report.squat_report import least_water_with_squat
from thalweg.route import evaluate
from thalweg.ship.methods.shallow_water.barrass_squat import barrass_squat

WEEK = 604800.0


def example(**changes):
    data = yaml.safe_load(example_file().read_text())
    data |= {"volume_m3": 14_000, "days": 3, "spacing_m": 900.0, "rings": 2, "margin_m": 0.02}
    data |= changes
    return {key: value for key, value in data.items() if value is not None}


@pytest.fixture(scope="module")
def result():
    project = Project.from_dict(example())
    ship, sea, chart = open_project_inputs(project)
    return run_project(project, ship=ship, sea=sea, chart=chart)


@pytest.mark.slow
def test_the_volume_is_moved_cycle_after_cycle(result):
    work = result.project.work
    for run in result.runs:
        assert sum(c.volume for c in run.cycles) == pytest.approx(14_000.0)
        assert run.cycles[0].start == result.project.start
        for before, after in zip(run.cycles, run.cycles[1:]):
            assert after.start == before.end
        for cycle in run.cycles:
            share = cycle.volume / work.hopper
            assert cycle.volume <= cycle.load_factor * work.hopper + 1e-9
            assert cycle.loading == pytest.approx(cycle.volume / 1.5)
            assert cycle.out.depart == pytest.approx(cycle.start + work.loading.time(share))
            assert cycle.back.depart == pytest.approx(cycle.out.arrive + work.unloading.time(share))


def test_every_leg_keeps_the_clearance_in_the_referees_fine_steps(result):
    for run in result.runs:
        assert run.feasible
        for cycle in run.cycles:
            for leg in cycle.legs:
                assert leg.route.feasible
                assert leg.clearance >= 1.0 - 1e-9
                assert leg.route.samples["under_keel_clearance"].min() >= 1.0 - 1e-9


def test_hours_of_a_duration_never_round_to_a_day():
    written = {key: how for key, _, how in TABLE_ROWS}["duration_days"]
    assert [written(v) for v in (3.999, 0.5, 1.0, 24.98 / 24.0)] == [
        "4 d 0 h", "12 h 0 min", "1 d 0 h 0 min", "1 d 0 h 59 min",
    ]  # fmt: skip


def test_the_least_clearance_is_unknown_where_that_of_a_leg_is(result):
    cycles = list(result.optimised.cycles)
    known = cycles[1].back.route
    blind = replace(
        known,
        legs={**known.legs, "under_keel_clearance": np.full(len(known.legs["length"]), np.nan)},
    )
    cycles[1] = replace(cycles[1], back=SailedLeg(blind, 0.0))
    run = summarise_run("x", cycles, project=result.project, ship=result.environment.ship)
    assert run.totals["least_clearance_m"] is None


def test_squat_of_a_ship_whose_limits_do_not_count_it_is_stated(result):
    """A hopper dredger had 0.8 m under the keel at rest, and -0.3 m at her speed in the gully."""
    cycles = [
        replace(cycle, out=replace(cycle.out, clearance_with_squat=left))
        for cycle, left in zip(result.optimised.cycles, (1.4, -0.26, 0.5))
    ]
    given = {"project": result.project, "ship": result.environment.ship}
    run = summarise_run("optimised", cycles, **given, required=0.8)
    assert run.totals["least_clearance_with_squat_m"] == pytest.approx(-0.26)
    (note,) = run.notes
    legs = 2 * len(cycles)
    assert note.startswith(
        f"The clearance is that at rest: with squat, the ship is 0.3 m too deep on 2 of {legs} "
        "legs (optimised), less than the 0.8 m required."
    )
    assert summarise_run("optimised", cycles[:1], **given, required=0.8).notes == ()


def test_the_clearance_with_squat_is_below_that_at_rest_by_barrass(result):
    hull = {"length_between_perpendiculars_m": 80.0, "breadth_m": 16.0, "block_coefficient": 0.8}
    known = Ship.from_dict(
        {"name": "hopper", "hull": {**hull, "draught_m": 5.0}, "speeds_kn": [10.0]}
    )
    leg = result.optimised.cycles[0].out.route
    least = least_water_with_squat(leg, known)
    speed, depth = (leg.samples[name][least.sample] for name in ("speed_through_water", "depth"))
    sunk = barrass_squat(speed, depth, block_coefficient=0.8, breadth=16.0, draught=5.0)
    assert least.squat == pytest.approx(float(sunk), rel=0.05)
    assert least.clearance == pytest.approx(depth - 5.0 - least.squat)


@pytest.mark.slow
def test_the_mean_load_factor_is_that_of_the_volumes():
    """Cycles times mean load is the volume; the last cycle carries what is left."""
    project = Project.from_dict(example(base_case=None, volume_m3=15_000, load_factors=[0.5, 1.0]))
    ship, sea, chart = open_project_inputs(project)
    run = run_project(project, ship=ship, sea=sea, chart=chart).optimised
    last = run.cycles[-1]
    assert last.volume < last.load_factor * 4000.0
    moved = run.totals["cycles"] * run.totals["mean_load_factor"] * 4000.0
    assert moved == pytest.approx(15_000.0)


def test_legs_run_between_the_sites_with_the_right_load(result):
    sites = result.project.sites
    for run in result.runs:
        for cycle in run.cycles:
            assert cycle.out.route.track.positions[0] == pytest.approx(sites.load, abs=1e-5)
            assert cycle.out.route.track.positions[-1] == pytest.approx(sites.unload, abs=1e-5)
            assert cycle.back.route.track.positions[0] == pytest.approx(sites.unload, abs=1e-5)
            draught = 3.5 + 3.0 * cycle.load_factor
            for leg, deep in ((cycle.out, draught), (cycle.back, 3.5)):
                samples = leg.route.samples
                gap = samples["depth"] - samples["under_keel_clearance"]
                assert gap == pytest.approx(deep, abs=1e-9)


def test_planned_is_faster_than_the_charted_route(result):
    base, optimised = (run.totals for run in result.runs)
    assert result.runs[0].name == "base case"
    assert optimised["production_m3_week"] > 1.15 * base["production_m3_week"]
    assert optimised["distance_m"] < base["distance_m"]
    gains = result.gains()
    assert gains["production_gain"] > 0.15
    assert gains["time_saved"] == pytest.approx(
        1.0 - optimised["duration_days"] / base["duration_days"]
    )


def test_the_result_states_the_prices_of_its_cost(result):
    prices = result.as_dict()["prices"]
    assert prices["currency"] == "EUR" == result.optimised.totals["currency"]
    assert prices["time_per_day"] == {"value": pytest.approx(100_000.0), "source": "ship file"}
    assert prices["per_second_per_cubed_speed"] == {"value": 0.008, "source": "ship file"}


def test_a_route_whose_sites_are_given_as_longitude_and_latitude_gets_a_hint():
    data = example()
    swapped = {name: data[name][::-1] for name in ("load", "unload")}
    with pytest.raises(InputError, match="Are latitude and longitude swapped"):
        Project.from_dict({**data, **swapped})


def test_rows_of_the_cycles_add_up_to_the_table(result):
    """They had neither pumps nor the hotel load at the sites."""
    for run in result.runs:
        rows = [cycle_record(cycle) for cycle in run.cycles]
        for name in ("fuel_t", "energy_gj"):
            total = sum(row[name] for row in rows)
            assert total == pytest.approx(run.totals[name], abs=6e-4 * len(rows))


def test_totals_add_up(result):
    for run in result.runs:
        totals, cycles = run.totals, run.cycles
        duration = cycles[-1].end - cycles[0].start
        shares = ("loading_share", "unloading_share", "sailing_full_share", "sailing_empty_share")
        assert sum(totals[key] for key in shares) == pytest.approx(1.0)
        assert totals["production_m3_week"] == pytest.approx(14_000.0 / duration * WEEK)
        assert totals["cycles"] == len(cycles)
        assert totals["hotel_gj"] == pytest.approx(150e3 * duration / 1e9)
        sailing = sum(leg.duration - leg.waiting for c in cycles for leg in c.legs)
        pumping = sum(1500e3 * c.loading + 2000e3 * c.unloading for c in cycles) / 1e9
        # the engine of the example gives 2400 kW whenever it sails
        assert totals["energy_gj"] == pytest.approx(
            2.4e6 * sailing / 1e9 + pumping + totals["hotel_gj"], rel=2e-3
        )
        assert totals["co2_t"] == pytest.approx(3.206 * totals["fuel_t"])
        assert totals["co2_kg_m3"] == pytest.approx(1000.0 * totals["co2_t"] / 14_000.0)


@pytest.mark.slow
def test_fuel_burnt_in_a_wait_is_counted_once():
    """Sailing by the referee; hotel load lying still, at work or waiting; pumps at the engine's."""
    route = example()["base_case"]["route"]
    asked = example(volume_m3=12_000, base_case={"route": route, "load_factor": 1.0})
    project = Project.from_dict(asked)
    ship, sea, chart = open_project_inputs(project)
    result = run_project(project, ship=ship, sea=sea, chart=chart)
    assert sum(leg.waiting for c in result.base.cycles for leg in c.legs) > 3600.0
    for run in result.runs:
        legs = [leg for cycle in run.cycles for leg in cycle.legs]
        sailing = sum(float(leg.route.legs["fuel"].sum()) for leg in legs)
        work = sum(cycle.loading + cycle.unloading for cycle in run.cycles)
        still = work + sum(leg.waiting for leg in legs)
        pumped = sum(1500e3 * c.loading + 2000e3 * c.unloading for c in run.cycles)
        hotel = result.environment.ship.waiting_fuel_rate * still
        expected = sailing + hotel + pumped * 200.0 / 3.6e9  # 200 g/kWh
        assert run.totals["fuel_t"] == pytest.approx(expected / 1000.0, rel=1e-9)


def test_cost_is_that_of_van_halem(result):
    """lambda_t t + lambda_f t V^3 (equation 3.5), the second term only under way."""
    run = result.optimised
    total = 700_000.0 / WEEK * (run.cycles[-1].end - run.cycles[0].start)
    for cycle in run.cycles:
        full = (12.0 - 2.0 * cycle.load_factor) * 1852.0 / 3600.0
        for leg, speed in ((cycle.out, full), (cycle.back, 12.0 * 1852.0 / 3600.0)):
            total += 0.008 * (leg.duration - leg.waiting) * speed**3
    assert run.totals["cost"] == pytest.approx(total, rel=1e-9)


@pytest.mark.slow
def test_a_leg_that_breaks_a_limit_between_the_nodes_is_planned_with_more_water():
    project = Project.from_dict(example(margin_m=0.0, spacing_m=1200.0, rings=3))
    ship, sea, chart = open_project_inputs(project)
    period = project.start, project.end
    world = ProjectEnvironment.open(project.sites, period, ship=ship, sea=sea, chart=chart)
    ways = freeze_site_network(world, project_network(world), lambda text: None)
    sailor = SiteLegPlanner(world, ways)
    depart = project.start + 11 * 1800.0
    found = sailor.profile_search(0.8, outward=True).sail(depart)
    track = track_of_path(ways, found, sailor.loaded(0.8).setting)
    by_nodes = evaluate(
        track, ship=sailor.loaded(0.8).ship, sea=sea, chart=chart, min_ukc=1.0, strict=False
    )
    assert {v.reason for v in by_nodes.violations} == {"under-keel clearance"}
    for given in (None, found):
        leg = sailor.sail(0.8, depart, outward=True, path=given)
        assert leg.route.feasible and leg.clearance >= 1.0
        assert found.arrive < leg.arrive < found.arrive + 600.0


def test_corners_keep_a_route_along_a_parallel_near_its_nodes():
    """A geodesic of 60 km between places on a parallel runs 90 m off it; over the date line too."""
    for west in (3.0, 179.6):
        lon = (west + np.linspace(0.0, 0.9, 200) + 180.0) % 360.0 - 180.0
        lat = np.full(200, 52.0)
        keep = np.flatnonzero(_essential_nodes(lat, lon))
        assert 8 <= len(keep) <= 25
        for a, b in itertools.pairwise(keep.tolist()):
            along, _, _ = inverse(lat[a], lon[a], lat[a:b], lon[a:b])
            course = float(inverse(lat[a], lon[a], lat[b], lon[b])[1])
            there = direct(lat[a], lon[a], course, along)
            assert np.max(distance(*there, lat[a:b], lon[a:b])) < 0.51
        straight = _essential_nodes(*direct(52.0, west, 1.0, np.linspace(0.0, 60e3, 100)))
        assert np.flatnonzero(straight).tolist() == [0, 99]


def test_the_load_chosen_produces_most(result):
    """No other load, sailed from the same moment, moves more per time of its cycle."""
    from thalweg.operations.dredging.cycle_simulation import Simulator

    world, work = result.environment, result.project.work
    ways = freeze_site_network(world, project_network(world), lambda text: None)
    simulator = Simulator(result.project, world, ways)
    first = result.optimised.cycles[0]
    produced = {}
    for both in simulator.both:
        volume = both.load_factor * work.hopper
        depart = first.start + work.loading.time(both.load_factor)
        full = both.full.sail(depart)
        if full.found:
            empty = both.empty.sail(full.arrive + work.unloading.time(both.load_factor))
            produced[both.load_factor] = volume / (empty.arrive - first.start)
    assert max(produced, key=produced.get) == first.load_factor
    assert first.production == pytest.approx(produced[first.load_factor], rel=0.01)


def test_load_factors_are_drawn_as_bars_centred_on_them():
    """0.4 was drawn from 0.40 to 0.48 in one run, 1.0 from 0.92 to 1.00 in the other."""
    runs = [
        SimpleNamespace(name=name, cycles=[SimpleNamespace(load_factor=one) for one in loads])
        for name, loads in (("optimised", [0.4, 1.0, 1.0]), ("base case", [1.0]))
    ]
    work = SimpleNamespace(load_factors=(0.4, 0.8, 1.0))
    drawn: Any = SimpleNamespace(project=SimpleNamespace(work=work), runs=runs)
    axes = new_figure(4.0, 3.0, dpi=50).subplots()
    _draw_load_factors(drawn, axes)
    spans = [(bar.get_x(), bar.get_width(), bar.get_height()) for bar in axes.patches]
    centres = [(left + 0.5 * width, height) for left, width, height in spans]
    assert np.allclose(centres, [(0.4, 1), (1.0, 2), (1.0, 1)])
    assert spans[2][1] < spans[1][1]  # the bar behind is seen


@pytest.mark.slow
def test_files_and_pictures(result, tmp_path):
    files = write_project_files(result, tmp_path)
    assert [file.name for file in files] == [
        "project.json", "cycles.csv", "project.png", "routes.png",
    ]  # fmt: skip
    data = json.loads((tmp_path / "project.json").read_text())
    assert set(data["runs"]) == {"optimised", "base case"}
    assert Project.from_dict(data["project"]).work == result.project.work
    with (tmp_path / "cycles.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == sum(len(run.cycles) for run in result.runs)
    moved = sum(float(row["volume_m3"]) for row in rows if row["run"] == "optimised")
    assert moved == pytest.approx(14_000.0)
    assert min(float(row["full_least_clearance_m"]) for row in rows) >= 1.0
    for run in result.runs:
        shares = time_shares(run)
        assert sum(shares.values()) == pytest.approx(1.0, abs=1e-6)
        assert shares["waiting"] == run.totals["waiting_share"]
        assert shares["sailing full"] <= run.totals["sailing_full_share"]
    figure = draw_routes(result, colour="load")
    assert len(figure.axes) == 4  # two maps, two colour bars
    for name in ("project.png", "routes.png"):
        assert (tmp_path / name).stat().st_size > 20_000


def test_a_project_survives_its_file(tmp_path):
    project = Project.from_dict(example(load_factors=[0.4, 0.8, 1.0]))
    project.save(tmp_path / "p.yaml")
    again = Project.load(tmp_path / "p.yaml")
    assert again == project
    with_paths = Project.from_dict(example(sea=[tmp_path / "a.nc"], zones=tmp_path / "z.geojson"))
    assert json.loads(json.dumps(with_paths.to_dict()))["sea"] == [str(tmp_path / "a.nc")]
    assert again.work.load_factors == (0.4, 0.8, 1.0)
    assert again.start == parse_time("2026-05-01T00:00Z")


def test_the_example_is_van_halems_project():
    project = open_project("example")
    assert project.work.volume == 425_500.0
    assert project.work.hopper == 4000.0
    assert project.work.load_factors == tuple(k / 10 for k in range(11))
    ship = open_project_inputs(project)[0]
    assert ship.with_load_factor(1.0).draught == 6.5
    assert ship.with_load_factor(0.0).draught == 3.5


def test_a_curve_with_overflow_takes_longer_for_the_last_tenth():
    curve = LoadingCurve.from_data(
        {"minutes": [0, 30, 60], "share": [0, 0.8, 1]}, 4000.0, "loading"
    )
    assert curve.time(0.4) == pytest.approx(15 * 60.0)
    assert curve.time(1.0) - curve.time(0.9) == pytest.approx(15 * 60.0)
    assert curve.time(0.0) == 0.0
    constant = LoadingCurve.from_data(1.5, 4000.0, "loading")
    assert constant.time(0.5) == pytest.approx(2000.0 / 1.5)
    coupled = LoadingCurve.from_data({"rate_m3_s": 1.5, "fixed_minutes": 10}, 4000.0, "unloading")
    hourly = LoadingCurve.from_data({"rate_m3_h": 7650}, 4000.0, "unloading")
    assert hourly.time(1.0) == pytest.approx(3600.0 * 4000.0 / 7650.0)
    assert coupled.time(0.5) == pytest.approx(2000.0 / 1.5 + 600.0)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"volume_m3": 0}, "volume_m3 is 0"),
        ({"volume_m3": float("nan")}, "volume_m3 is nan"),
        ({"hopper_m3": -4000}, "hopper_m3 is -4000"),
        ({"loading": 0.0}, "loading.rate_m3_s is 0"),
        ({"unloading": {"rate_m3_s": -1}}, "unloading.rate_m3_s is -1"),
        ({"loading": {"minutes": [0, 10, 5], "share": [0, 0.5, 1]}}, "curve of loading"),
        ({"loading": {"rate": 3}}, "no entry of loading named 'rate'"),
        ({"unloading": 7650}, "takes 0.523 s .*m3/s.*rate_m3_h"),
        ({"unloading": {"rate_m3_h": 1.5}}, "2.67e\\+03 h"),
        ({"loading": {"minutes": [0, 0.5], "share": [0, 1]}}, "loading.minutes .* takes 30 s"),
        ({"loading": {"rate_m3_h": 1, "rate_m3_s": 1}}, "more than one rate"),
        ({"loading": {"rate_m3_s": 1.5, "fixed_minutes": 12000}}, "8.3 days"),
        ({"loading": {"rate_m3_s": 1.5, "power_kw": 1500e3}}, "power_kw is 1.5e"),
        ({"load_factors": [0.0]}, "one of them above 0"),
        ({"load_factors": [0.5, 1.2]}, "load_factors is"),
        ({"days": -1}, "days is -1"),
        ({"load": [95.0, 3.0]}, "load"),
        ({"unload": "there"}, "unload is 'there'"),
        ({"rings": 7}, "rings is 7"),
        ({"rings": True}, "rings is True"),
        ({"detour": 1.0}, "detour is 1"),
        ({"spacing_m": 0}, "spacing_m is 0"),
        ({"margin_m": -1}, "margin_m is -1"),
        ({"min_ukc_m": 200}, "min_ukc_m is 200"),
        ({"days": 1e7}, r"days is 1e\+07"),
        ({"start": 20260501}, "start is the number 20260501"),
        ({"volumes": 1}, "no project entry named 'volumes'"),
        ({"start": None}, "lacks start"),
        ({"base_case": {"route": [[51.7, 3.5]]}}, "has one place"),
        ({"base_case": {"route": [[51.7, 3.5], [51.6596, 3.6514]]}}, "starts 7,"),
        ({"base_case": {"route": [[51.7449, 3.579], [51.7, 3.5]]}}, "ends 11,"),
        ({"base_case": {"route": [[51.7, 3.5], [51.8, 3.5]], "load_factor": 0}}, "load_factor is"),
    ],
)
def test_invalid_projects_are_refused_before_the_simulation(changes, words):
    with pytest.raises(InputError, match=words):
        Project.from_dict(example(**changes))


def sail(**changes):
    project = Project.from_dict(example(**{"base_case": None, **changes}))
    ship, sea, chart = open_project_inputs(project)
    return run_project(project, ship=ship, sea=sea, chart=chart)


def test_a_dry_site_is_reported_with_its_highest_water():
    with pytest.raises(InputError, match="too shallow at every tide") as caught:
        sail(unload=[51.6865, 3.52])  # on the bank
    assert "m less than the empty ship needs (4.52 m)" in caught.value.possible
    assert 0.5 < caught.value.details["missing_m"] < 4.5


@pytest.mark.slow
def test_an_impossible_clearance_is_reported_with_highest_water_and_missing_depth():
    with pytest.raises(NoRouteError, match="no route at any tide") as caught:
        sail(min_ukc_m=6.0, load_factors=[0.5, 1.0])
    details = caught.value.details
    # 5.0 m of draught and 6.02 m of clearance and margin against bar and tide: 7.86 m + 1.81 m
    assert details["missing_m"] == pytest.approx(5.0 + 6.02 - (7.86 + 1.81), abs=0.35)
    assert details["highest"].startswith("2026-05-0")
    assert "m too shallow: at" in caught.value.possible


@pytest.mark.slow
def test_too_few_days_are_reported_with_the_volume_moved():
    with pytest.raises(OutsidePeriodError, match=r"can be moved \(optimised\)") as caught:
        sail(volume_m3=60_000, days=1.0)
    assert 8_000 <= caught.value.details["moved_m3"] <= 24_000


@pytest.mark.slow
def test_gaps_and_the_end_of_the_data_are_reported_when_a_project_stops(tmp_path):
    hours = np.array([0.0, 0.5, 1.0, 1.5, 10.0, 10.5, 11.0])
    axes, ones = ("time", "lat", "lon"), np.ones((7, 5, 5))
    path = tmp_path / "gap.nc"
    xr.Dataset(
        {"zeta": (axes, ones, {"standard_name": "sea_surface_height", "units": "m"}),
         "h": (axes[1:], 15.0 * ones[0], {"standard_name": "sea_floor_depth_below_geoid",
                                         "units": "m"})},
        {"time": np.datetime64("2026-01-01", "ns") + (3600.0 * hours).astype("timedelta64[s]"),
         "lat": np.linspace(51.6, 52.0, 5), "lon": np.linspace(3.4, 3.8, 5)},
    ).to_netcdf(path)  # fmt: skip
    changes = {"sea": str(path), "coast": "none", "start": "2026-01-01", "days": 2}
    changes["spacing_m"] = 3000.0
    project = Project.from_dict(
        example(base_case=None, load=[51.71, 3.45], unload=[51.77, 3.7], **changes)
    )
    ship, sea, chart = open_project_inputs(project)
    with pytest.raises(OutsidePeriodError) as caught:
        run_project(project, ship=ship, sea=sea, chart=chart)
    assert "The data end 2026-01-01T11:00:00Z." in caught.value.possible
    assert "no data from 2026-01-01T01:30:00Z to 2026-01-01T10:00:00Z" in caught.value.possible


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"sea": 5}, r"sea is \[5\]"),
        ({"sea": [1, "a.nc"]}, "sea is"),
        ({"sea": "a.nc", "map": "crs"}, "map is 'crs'"),
        ({"sea": "a.nc", "tides": 3}, r"tides is \[3\]"),
        ({"tides": True}, "tides is given for the synthetic-estuary"),
        ({"coast": "i"}, "coast is given for the synthetic-estuary"),
        ({"coast": "x", "sea": "a.nc"}, "There is no file 'a.nc'"),
    ],
)
def test_an_invalid_sea_is_refused(changes, words):
    with pytest.raises(InputError, match=words):
        open_project_inputs(Project.from_dict(example(**changes)))


def test_a_hopper_larger_than_the_ship_is_refused():
    with pytest.raises(InputError, match="hopper_m3 is 4001") as caught:
        sail(hopper_m3=4001)
    assert "holds 4000 m3" in caught.value.possible


@pytest.mark.slow
def test_a_base_case_that_runs_out_of_days_does_not_lose_the_optimised_run():
    route = example()["base_case"]["route"]
    asked = example(volume_m3=24_000, base_case={"route": route, "load_factor": 0.3})
    ship, sea, chart = open_project_inputs(Project.from_dict(asked))
    whole = run_project(Project.from_dict(asked), ship=ship, sea=sea, chart=chart)
    durations = [run.totals["duration_days"] for run in whole.runs]
    assert durations[0] > 1.2 * durations[1]
    short = Project.from_dict(asked | {"days": sum(durations) / 2.0})
    result = run_project(short, ship=ship, sea=sea, chart=chart)
    assert result.runs == (result.optimised,) and result.gains() == {}
    assert result.optimised.totals["duration_days"] == pytest.approx(durations[1], rel=1e-4)
    (note,) = result.optimised.notes
    assert note.startswith("Without the base case: By ") and "can be moved (base case)" in note


def test_unknown_values_of_a_project_are_filled(tmp_path):
    grid = xr.Dataset(
        {name: (("lat", "lon"), np.full((2, 2), 0.5)) for name in ("uo", "vo")},
        coords={"lat": [51.0, 52.0], "lon": [3.0, 4.0]},
    )
    grid.uo.attrs["units"] = grid.vo.attrs["units"] = "m/s"
    grid.to_netcdf(tmp_path / "flow.nc")
    asked = example(base_case=None, sea=str(tmp_path / "flow.nc"), coast="none")
    _, sea, _ = open_project_inputs(Project.from_dict(asked | {"fill": {"currents": 0.0}}))
    east = sea.sample(["eastward_sea_water_velocity"], 0.0, [51.5, 55.0], [3.5, 3.5])
    assert east["eastward_sea_water_velocity"].tolist() == [0.5, 0.0]
    with pytest.raises(InputError, match="fill is 3"):
        open_project_inputs(Project.from_dict(asked | {"fill": 3}))


@pytest.mark.slow
def test_a_base_case_outside_the_data_is_refused_with_the_position():
    north = [51.7449, 3.579], [51.72, 3.70], [51.72, 3.74], [51.6596, 3.6514]
    project = Project.from_dict(example(base_case={"route": [list(place) for place in north]}))
    ship, sea, _ = open_project_inputs(project)
    chart = Chart.open_water(51.0, 52.0, 3.0, 4.0)  # wider than the sea, which ends at 3.724 E
    with pytest.raises(NoRouteError, match="base case") as caught:
        run_project(project, ship=ship, sea=Sea.layered(sea, bed()), chart=chart)
    assert "on its route at 51.72" in caught.value.possible and "not known" in caught.value.possible
    assert caught.value.details["nearest"][1] == pytest.approx(3.724, abs=0.005)


def bed():
    """Return the bed of the estuary as a sea of its own, known as far as 3.724 E."""
    return Sea.from_functions(
        {
            "sea_floor_depth_below_geoid": lambda time, lat, lon: np.where(
                lon < 3.724, bed_depth(lat, lon), np.nan
            )
        }
    )


def test_the_plot_of_routes_shows_the_land_of_the_chart(result):
    west, south, east, north = 3.62, 51.72, 3.66, 51.74
    ring = [[west, south], [east, south], [east, north], [west, north], [west, south]]
    land = Chart.from_geojson({"type": "Polygon", "coordinates": [ring]}).with_depth(
        bed_depth, spacing_deg=0.001
    )
    figure = draw_routes(replace(result, environment=replace(result.environment, chart=land)))
    figure.canvas.draw()
    pixels = np.asarray(figure.canvas.buffer_rgba())

    def colour(lat, lon):
        x, y = figure.axes[0].transData.transform((lon, lat))
        return pixels[len(pixels) - 1 - int(y), int(x), :3].tolist()

    assert colour(51.73, 3.64) == [0xD9, 0xD4, 0xC8]
    assert colour(51.73, 3.47) != [0xD9, 0xD4, 0xC8]


def deep_sea(path, bed=False, wall=False):
    """Write a sea with a current and perhaps a bed of 15 m, which a wall without data may part."""
    lat, lon, axes = np.linspace(51.6, 52.0, 5), np.linspace(3.4, 3.8, 9), ("time", "lat", "lon")
    flow = np.full((49, 5, 9), 0.3)
    if wall:
        flow[:, :, 4] = np.nan
    data = {
        "u": (axes, flow, {"standard_name": "eastward_sea_water_velocity", "units": "m s-1"}),
        "v": (axes, flow, {"standard_name": "northward_sea_water_velocity", "units": "m s-1"}),
    }
    if bed:
        told = {"standard_name": "sea_floor_depth_below_geoid", "units": "m"}
        data["h"] = (axes[1:], np.full((5, 9), 15.0), told)
    hours = np.datetime64("2026-01-01", "ns") + np.arange(49) * np.timedelta64(1, "h")
    xr.Dataset(data, {"time": hours, "lat": lat, "lon": lon}).to_netcdf(path)  # fmt: skip
    return {"sea": str(path), "coast": "none", "start": "2026-01-01", "days": 1.5,
            "load": [51.71, 3.45], "unload": [51.77, 3.7], "spacing_m": 2500.0,
            "ship": "hopper-dredger",
            "volume_m3": 4000}  # fmt: skip


def test_without_a_clearance_a_project_needs_no_depth(tmp_path):
    asked = deep_sea(tmp_path / "flow.nc")
    with pytest.raises(CoverageError, match="provides depth"):
        sail(**asked, min_ukc_m=0.0)
    result = sail(**asked, min_ukc_m=None)
    assert any("No depth in the data" in note for note in result.provenance["assumptions"])
    assert result.optimised.totals["least_clearance_m"] is None
    assert result.optimised.feasible
    known = sail(**deep_sea(tmp_path / "bed.nc", bed=True), min_ukc_m=None)
    assert known.optimised.totals["least_clearance_m"] == pytest.approx(8.5)  # 15 m less 6.5 m


def test_the_clearance_of_the_ship_file_is_respected(tmp_path):
    data = dict(Ship.load("hopper-dredger").data) | {"limits": {"min_under_keel_clearance_m": 9.0}}
    asked = deep_sea(tmp_path / "bed.nc", bed=True) | {"ship": data, "load_factors": [0.5, 1.0]}
    result = sail(**asked, min_ukc_m=None)
    assert {cycle.load_factor for cycle in result.optimised.cycles} == {0.5}  # 15 m less 5 m
    assert "Load factors above 0.5 have no route at any tide." in result.optimised.notes
    assert {c.load_factor for c in sail(**asked, min_ukc_m=1.0).optimised.cycles} == {1.0}


def test_loading_and_unloading_keep_the_wave_limit(tmp_path):
    """Waves of 2.5 m from 1 h to 4 h: a limit of 2.0 m once held for sailing alone."""
    asked = deep_sea(tmp_path / "bed.nc", bed=True)
    with xr.open_dataset(tmp_path / "bed.nc") as given:
        flow = given.load()
    hours = np.arange(49)
    height = np.where((hours >= 1) & (hours <= 4), 2.5, 1.0)[:, None, None] + 0.0 * flow["u"]
    named = {"standard_name": "sea_surface_wave_significant_height", "units": "m"}
    flow.assign(hs=height.assign_attrs(named)).to_netcdf(tmp_path / "waves.nc")
    limits = {"limits": {"max_significant_wave_height_m": 2.0}}
    ship = dict(Ship.load("hopper-dredger").data) | limits
    given = {"load_factors": [1.0], "min_ukc_m": None, "ship": ship, "volume_m3": 4000}
    cycle = sail(**asked | given | {"sea": str(tmp_path / "waves.nc")}).optimised.cycles[0]
    free = sail(**asked | given | {"ship": "hopper-dredger"}).optimised.cycles[0]
    assert free.pauses < 1e-3
    assert cycle.loading == free.loading
    # work stops at 1 h less the wave height's rise to 2 m, and goes on after its fall
    stop, go = (1.0 - 1.0 / 3.0) * 3600.0, (4.0 + 1.0 / 3.0) * 3600.0
    assert cycle.loading > stop
    assert cycle.loading_pause == pytest.approx(go - stop, abs=600.0)
    assert cycle.out.depart == pytest.approx(cycle.start + cycle.loading + cycle.loading_pause)


def test_waits_at_sea_above_the_limits_are_stated(tmp_path):
    """A loaded ship once lay at sea for hours in waves above her limit without a note."""
    asked = deep_sea(tmp_path / "bed.nc", bed=True)
    with xr.open_dataset(tmp_path / "bed.nc") as given:
        flow = given.load()
    hours, east = np.arange(49), np.arange(9)
    rough = ((hours >= 2) & (hours <= 12))[:, None, None] & (east >= 4)[None, None, :]
    height = np.where(rough, 3.0, 0.5) + 0.0 * flow["u"]
    named = {"standard_name": "sea_surface_wave_significant_height", "units": "m"}
    flow.assign(hs=height.assign_attrs(named)).to_netcdf(tmp_path / "waves.nc")
    ship = dict(Ship.load("hopper-dredger").data)
    ship["limits"] = {"max_significant_wave_height_m": 2.0}
    given = {"load_factors": [1.0], "min_ukc_m": None, "ship": ship, "volume_m3": 4000}
    run = sail(**asked | given | {"sea": str(tmp_path / "waves.nc")}).optimised
    assert run.totals["waiting_share"] == pytest.approx(
        run.cycles[0].waiting / (run.cycles[-1].end - run.cycles[0].start)
    )
    notes = [note for note in run.notes if note.startswith("Waits at sea on ")]
    lying = max(leg.waiting for leg in run.cycles[0].legs) / 3600.0
    assert lying > 1.0 and len(notes) == 1
    assert "above the limit of 2.0 m" in notes[0] and "cycle 1" in notes[0]


def test_work_windows_end_after_the_last_pause():
    times, worked = np.array([0.0, 100.0, 200.0, 300.0]), np.array([0.0, 100.0, 100.0, 200.0])
    site = WorkWindows(times, worked)
    assert site.end(0.0, 50.0) == 50.0
    assert site.end(50.0, 100.0) == pytest.approx(250.0)
    assert site.end(150.0, 100.0) == pytest.approx(300.0)
    assert math.isinf(site.end(150.0, 101.0))
    assert site.end(0.0, 100.0) == pytest.approx(100.0)
    assert WorkWindows(np.empty(0), np.empty(0)).end(5.0, 7.0) == 12.0


def test_sites_separated_by_unknown_water_are_reported(tmp_path):
    for bed_too in (False, True):
        asked = deep_sea(tmp_path / f"wall{bed_too}.nc", bed=bed_too, wall=True)
        with pytest.raises(NoRouteError, match="no route at any tide") as caught:
            sail(**asked, min_ukc_m=None)
        assert "not connected by water of known depth" in caught.value.possible


def test_no_sea_is_never_assumed():
    with pytest.raises(InputError, match="names no sea"):
        open_project_inputs(Project.from_dict(example(sea=None)))


def test_a_calm_sea_has_to_be_asked_for_and_has_no_tides():
    _ship, sea, _chart = open_project_inputs(Project.from_dict(example(sea="calm", coast="none")))
    assert not sea.sample(["eastward_sea_water_velocity"], 0.0, 51.0, 3.0)[
        "eastward_sea_water_velocity"
    ].any()
    with pytest.raises(InputError, match="tides is given for the calm sea"):
        open_project_inputs(Project.from_dict(example(sea="calm", tides=True)))


@pytest.mark.slow
def test_command_line(tmp_path, capsys):
    path = tmp_path / "small.yaml"
    path.write_text(yaml.safe_dump(example(volume_m3=4000, days=2, name="Area [/2] at $5_$")))
    assert main(["project", str(path), "--out", str(tmp_path / "out")]) == 0
    told = capsys.readouterr().out
    assert "production [1000 m3/week]" in told and "least clearance [m]" in told
    assert "Area [/2] at $5_$" in told
    assert (tmp_path / "out" / "cycles.csv").exists()
    assert main(["project", str(path), "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["runs"]["optimised"]["totals"]["cycles"] >= 1
    path.write_text(yaml.safe_dump(example(volume_m3=-1)))
    assert main(["project", str(path)]) == 2
    assert "volume_m3 is -1" in capsys.readouterr().err
    assert main(["project", str(tmp_path / "none.yaml"), "--json"]) == 2
    assert json.loads(capsys.readouterr().out)["error"] == "InputError"


@pytest.mark.slow
def test_the_example_for_some_days_on_the_full_network():
    data = yaml.safe_load(example_file().read_text()) | {"volume_m3": 24_000, "days": 4}
    project = Project.from_dict(data)
    ship, sea, chart = open_project_inputs(project)
    result = run_project(project, ship=ship, sea=sea, chart=chart)
    assert result.provenance["network"]["nodes"] > 5000
    assert result.gains()["production_gain"] >= 0.15
    legs = [leg for run in result.runs for c in run.cycles for leg in c.legs]
    assert min(leg.clearance for leg in legs) >= 1.0
    assert all(leg.route.feasible for leg in legs)
    assert np.isfinite([leg.energy for leg in legs]).all()


def san_diego(**changes):
    path = data_file("tide/adh_sandiego_waterlevel_ugrid_30min.nc")
    return Project.from_dict(
        {
            "ship": "hopper-dredger",
            "sea": str(path),
            "map": {"crs": "EPSG:32611"},
            "coast": "none",
            "load": [32.65, -117.25],
            "unload": [32.70, -117.165],
            "volume_m3": 6000,
            "hopper_m3": 4000,
            "loading": 1.5,
            "unloading": 2.0,
            "load_factors": 5,
            "start": "2000-01-01T01:00Z",
            "days": 0.9,
            "min_ukc_m": 0.5,
            **changes,
        }
    )


@pytest.mark.slow
def test_a_project_on_the_mesh_of_a_real_model():
    """Routes along the rim of the mesh include the nodes that bound them."""
    project = san_diego()
    ship, sea, chart = open_project_inputs(project)
    result = run_project(project, ship=ship, sea=sea, chart=chart)
    run = result.optimised
    assert run.feasible
    assert sum(cycle.volume for cycle in run.cycles) >= 6000.0
    assert min(leg.clearance for cycle in run.cycles for leg in cycle.legs) >= 0.5
    figure = draw_routes(result)
    figure.canvas.draw()
    pixels = np.asarray(figure.canvas.buffer_rgba())
    x, y = figure.axes[0].transData.transform((-117.19, 32.70))  # Coronado is land: not deep blue
    assert pixels[len(pixels) - 1 - int(y), int(x), :3].tolist() == [0xD9, 0xD4, 0xC8]


def test_a_project_outside_the_period_of_its_data():
    project = san_diego(start="2030-01-01T00:00Z")
    ship, sea, chart = open_project_inputs(project)
    with pytest.raises(OutsidePeriodError, match="outside the data"):
        run_project(project, ship=ship, sea=sea, chart=chart)


@pytest.mark.slow
def test_a_project_on_the_tide_of_a_real_model_for_another_year():
    pytest.importorskip("utide")
    project = san_diego(start="2030-01-01T00:00Z", days=2, tides=["M2"])
    ship, sea, chart = open_project_inputs(project)
    assert run_project(project, ship=ship, sea=sea, chart=chart).optimised.feasible


def test_the_last_cycle_of_a_fixed_load_has_the_draught_of_what_is_left(tmp_path):
    """3,000 of 4,500 m3 at full draught wait for a higher tide than their own."""
    asked = deep_sea(tmp_path / "bed.nc", bed=True) | {"ship": "hopper-dredger"}
    asked |= {"volume_m3": 7_000, "hopper_m3": 4_000, "load_factors": [0.5, 0.75, 1.0]}
    ends = [asked["load"], asked["unload"]]
    for load, last in ((1.0, 0.75), (0.75, 0.5), (0.9, 0.9)):
        found = sail(**asked | {"base_case": {"route": ends, "load_factor": load}}).base.cycles
        assert [c.load_factor for c in found[:-1]] == [load] * (len(found) - 1)
        assert found[-1].load_factor == last
        assert found[-1].volume == pytest.approx(7_000 - 4_000 * load * (len(found) - 1))


def test_the_loads_of_a_few_cycles_are_chosen_together(tmp_path):
    """The best of each cycle is 3,600 m3, and needs a fourth cycle; the whole volume fits in 3."""
    asked = deep_sea(tmp_path / "bed.nc", bed=True) | {"ship": "hopper-dredger"}
    asked |= {"volume_m3": 12_000, "hopper_m3": 4_000, "load_factors": [0.9, 1.0]}
    asked |= {"loading": {"minutes": [0, 30, 60], "share": [0, 0.9, 1.0]}}
    run = sail(**asked).optimised
    assert [cycle.volume for cycle in run.cycles] == pytest.approx([4_000] * 3)
    assert any("those of the whole project that end it first" in note for note in run.notes)


def test_the_answer_never_takes_longer_than_the_base_case(tmp_path, monkeypatch):
    """The best of each cycle overflows no hopper and needs a fourth cycle, for 1,200 m3."""
    monkeypatch.setattr(sys.modules[run_project.__module__], "_FEW_CYCLES", 0)
    asked = deep_sea(tmp_path / "bed.nc", bed=True) | {"ship": "hopper-dredger"}
    asked |= {"volume_m3": 12_000, "hopper_m3": 4_000, "load_factors": [0.9, 1.0]}
    asked |= {"loading": {"minutes": [0, 30, 60], "share": [0, 0.9, 1.0]}}
    greedy = sail(**asked).optimised
    assert [c.volume for c in greedy.cycles] == pytest.approx([3_600, 3_600, 3_600, 1_200])
    ends = [asked["load"], asked["unload"]]
    result = sail(**asked | {"base_case": {"route": ends, "load_factor": 1.0}})
    assert len(result.base.cycles) == 3 and not result.base.notes
    assert result.base.totals["duration_days"] < greedy.totals["duration_days"]
    assert result.optimised.name == "optimised"
    assert [c.volume for c in result.optimised.cycles] == pytest.approx([4_000] * 3)
    assert result.gains()["production_gain"] >= 0.0
    (note,) = result.optimised.notes
    assert "base case" in note and "takes 4 cycles" in note and "the base case 3 cycles" in note
