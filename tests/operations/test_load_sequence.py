"""The loads of a whole project, against all sequences of loads on a gully with a sill."""

import itertools

import numpy as np
import pytest

from tests.sill_seas import narrow_sill, write_sea
from thalweg import Ship
from thalweg.operations.dredging import load_sequence
from thalweg.operations.dredging.cycle_simulation import Simulator
from thalweg.operations.dredging.load_sequence import loads_of_least_time
from thalweg.operations.dredging.project import Project
from thalweg.operations.dredging.project_environment import (
    ProjectEnvironment,
    freeze_site_network,
    project_network,
)
from thalweg.operations.dredging.project_inputs import open_project_inputs
from thalweg.operations.dredging.run_project import run_project

pytestmark = pytest.mark.slow
LOADS = (0.3, 0.7, 1.0)


def gully(path):
    """Write a sea 20 m deep with a sill of 6 m between the sites, and a tide of M2, 2 m high."""
    lat = np.array([51.62, 51.675, 51.68, 51.69, 51.695, 51.75])
    depth = np.array([20.0, 20.0, 6.0, 6.0, 20.0, 20.0])
    hours = np.arange(0.0, 24.0 * 6.0, 0.25)
    level = 2.0 * np.cos(2.0 * np.pi * hours / 12.42)
    write_sea(path, lat, depth, np.array([3.58, 3.60, 3.62]), level, hours)


def project(path, **changes):
    ship = dict(Ship.load("hopper-dredger").data)
    ship["loading"] = {
        "draught_full_m": 6.5, "draught_empty_m": 3.5, "speeds_full_kn": [10.0],
        "speeds_empty_kn": [12.0], "weight_full_t": 10000, "weight_empty_t": 4000,
        "capacity_m3": 4000,
    }  # fmt: skip
    asked = {
        "name": "gully", "ship": ship, "sea": str(path), "coast": "none", "load": [51.75, 3.6],
        "unload": [51.62, 3.6], "volume_m3": 8_000, "hopper_m3": 4_000,
        "loading": {"rate_m3_h": 5400}, "unloading": {"rate_m3_h": 5400},
        "load_factors": list(LOADS), "start": "2026-05-01T00:00Z", "days": 5, "min_ukc_m": 1.0,
        "spacing_m": 1500.0,
    }  # fmt: skip
    return Project.from_dict(asked | changes)


def simulator(asked):
    ship, sea, chart = open_project_inputs(asked)
    environment = ProjectEnvironment.open(
        asked.sites, (asked.start, asked.end), ship=ship, sea=sea, chart=chart
    )
    network = freeze_site_network(environment, project_network(environment), lambda text: None)
    return Simulator(asked, environment, network)


def test_over_a_narrow_sill_loads_are_those_that_the_referee_lets_pass(tmp_path):
    """The search passes the sill minutes later than a ship can: a load of 0.7 waited 6 hours."""
    narrow_sill(tmp_path / "narrow.nc")
    asked = project(
        tmp_path / "narrow.nc", load=[51.75, 3.6], unload=[51.65, 3.6], spacing_m=None,
        load_factors=[0.6, 0.7, 1.0], unloading={"rate_m3_h": 7200},
    )  # fmt: skip
    cycles = simulator(asked)
    found = cycles.run()
    assert [cycle.load_factor for cycle in found] == [1.0, 0.6, 0.6]
    assert (found[1].end - asked.start) / 3600.0 == pytest.approx(4.23, abs=0.05)
    assert cycles.run((1.0, 0.7))[1].end > found[1].end + 5.0 * 3600.0


def test_no_sequence_of_loads_ends_before_that_of_the_whole_project(tmp_path):
    gully(tmp_path / "sill.nc")
    cycles = simulator(project(tmp_path / "sill.nc"))
    loads = loads_of_least_time(cycles, latest=np.inf)
    found = cycles.run(loads)[-1].end
    ends = {}
    for count in range(2, 6):
        for tried in itertools.product(LOADS, repeat=count):
            if sum(tried) >= 2.0 - 1e-9 > sum(tried[:-1]):
                ends[tried] = cycles.run(tried)[-1].end
    assert found <= min(ends.values()) + 60.0
    assert max(ends.values()) > found + 3600.0
    assert loads_of_least_time(cycles, latest=found - 60.0) is None


def test_large_projects_have_fewer_loads_to_choose_from_or_none(tmp_path, monkeypatch):
    gully(tmp_path / "sill.nc")
    cycles = simulator(project(tmp_path / "sill.nc", load_factors=[0.25, 0.5, 0.75, 1.0]))
    monkeypatch.setattr(load_sequence, "MOST_SEARCHES", 8)
    stated = []
    loads = loads_of_least_time(cycles, latest=np.inf, report=stated.append)
    assert stated == ["2 loads for the whole project"]  # of 2 hoppers with 0.5 and 1 each
    assert set(loads) <= {0.5, 1.0}
    monkeypatch.setattr(load_sequence, "MOST_SEARCHES", 3)
    assert loads_of_least_time(cycles, latest=np.inf) is None


def test_a_project_that_waits_for_the_tide_has_the_loads_of_the_whole_and_a_note(tmp_path):
    gully(tmp_path / "sill.nc")
    asked = project(tmp_path / "sill.nc", volume_m3=12_000)
    ship, sea, chart = open_project_inputs(asked)
    result = run_project(asked, ship=ship, sea=sea, chart=chart)
    greedy = simulator(asked).run()
    saved = (greedy[-1].end - result.optimised.cycles[-1].end) / 3600.0
    assert saved > 0.5
    (note,) = [note for note in result.optimised.notes if note.startswith("The loads (")]
    assert f"{saved:.1f} h earlier" in note
    assert sum(cycle.volume for cycle in result.optimised.cycles) == pytest.approx(12_000)
    assert result.optimised.feasible
