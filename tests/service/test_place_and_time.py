"""The diagram of place and time of a plan: where and when the tide closes its track."""

from __future__ import annotations

import json

import numpy as np
import pytest

from thalweg import Chart, Sea, Ship, Voyage, plan

pytest.importorskip("fastapi", reason='the extra "serve" is not installed')

LOW_WATER = 1767236400.0  # 2026-01-01T03:00Z
TIDE = 44714.0  # [s]


def tidal_plan(range_m: float):
    """A voyage over a bank of 7 m, with half a tidal range around it [m]."""

    def depth(time_s, lat, lon):
        return np.where((lon > 3.55) & (lon < 3.60), 7.0, 15.0) + 0.0 * lat

    def level(time_s, lat, lon):
        return -range_m * np.cos(2 * np.pi * (time_s - LOW_WATER) / TIDE) + 0.0 * lat

    sea = Sea.from_functions(
        {
            "sea_floor_depth_below_geoid": depth,
            "sea_surface_height_above_geopotential_datum": level,
        }
    )
    return plan(
        Voyage(start=(51.71, 3.45), goal=(51.77, 3.70), depart=LOW_WATER, min_ukc_m=1.0),
        ship=Ship.simple(speed_kn=10.0, draught_m=5.0),
        sea=sea,
        chart=Chart.open_water(51.6, 51.9, 3.40, 3.75),
        resolution=2000.0,
    )


@pytest.mark.slow
def test_the_line_of_the_ship_keeps_out_of_the_closed_periods(tmp_path):
    from thalweg.service.jobs.job_work import write_plan_result

    found = tidal_plan(1.5)
    assert "space_time" in write_plan_result(found, tmp_path, None)
    facts = json.loads((tmp_path / "space_time.json").read_text("utf-8"))
    closed = np.array([[int(code) for code in row] for row in facts["closed"]])
    assert closed.shape == (len(facts["distance_m"]), len(facts["times"]))
    assert set(np.unique(closed)) == {0, 1}
    times, along = np.array(facts["times"]), np.array(facts["distance_m"])
    for row in np.flatnonzero((closed == 1).any(axis=1)):
        last = times[closed[row] == 1].max()  # the bank is closed until the water has risen
        assert last < LOW_WATER + TIDE / 2
    (line,) = facts["lines"]
    here = np.interp(times, line["times"], line["distance_m"])
    at = np.abs(along[:, None] - here).argmin(axis=0)
    sailing = (times > line["times"][0]) & (times < line["times"][-1])
    assert sailing.any() and not (closed[at, np.arange(len(times))] == 1)[sailing].any()


def test_without_a_closed_period_there_is_no_diagram(tmp_path):
    from thalweg.service.jobs.job_work import write_plan_result

    assert "space_time" not in write_plan_result(tidal_plan(0.2), tmp_path, None)
    assert not (tmp_path / "space_time.json").exists()
