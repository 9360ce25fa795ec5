"""Controlling depth: water that is too shallow at any tide, with place, depth and time."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from tests.sea import hydrodynamic_runs as hydro
from thalweg import Chart, Sea, Ship, Voyage, plan
from thalweg.core.errors import MissingVariableError, NoRouteError
from thalweg.core.geodesy import distance
from thalweg.core.time import parse_time
from thalweg.kernels.codes import BED_DEPTH, WATER_LEVEL
from thalweg.planning.single.controlling_depth import _time_of_high_water

LOW, M2 = 1767236400.0, 44714.0  # 2026-01-01T03:00Z
AREA = (51.6, 51.9, 3.40, 3.75)
BED, LEVEL = "sea_floor_depth_below_geoid", "sea_surface_height_above_geopotential_datum"
SHIP = Ship.simple(speed_kn=10.0, draught_m=6.5)
COARSE = 1000.0  # m between nodes; the gully is four times as wide


def level(time, lat, lon):
    return -1.5 * np.cos(2 * np.pi * (time - LOW) / M2) + 0.0 * lat


def estuary(gully: float) -> Sea:
    """Return a bank of 3 m across the way, with a gully through it at 51.8 N."""

    def bed(time, lat, lon):
        bank = (lon > 3.55) & (lon < 3.60)
        return np.where(bank, np.where(np.abs(lat - 51.8) < 0.02, gully, 3.0), 15.0)

    return Sea.from_functions({BED: bed, LEVEL: level})


def asked(sea, start=(51.71, 3.45), goal=(51.77, 3.70), ukc=1.0, **more):
    voyage = Voyage(offing_nm=0.0, start=start, goal=goal, depart=LOW, min_ukc_m=ukc, **more)
    return plan(voyage, ship=SHIP, sea=sea, chart=Chart.open_water(*AREA), resolution=COARSE)


def test_a_path_too_shallow_at_any_tide_is_reported_with_place_time_and_depth() -> None:
    with pytest.raises(NoRouteError) as caught:
        asked(estuary(5.5))
    error = caught.value
    # 5.5 + 1.5 m at high water; 6.5 + 1 m are needed
    assert error.details["missing_m"] == pytest.approx(0.5, abs=0.02)
    assert "too shallow at any tide" in error.asked
    assert "at most 7.00 m" in error.possible or "at most 6.99 m" in error.possible
    assert "0.5" in error.possible
    place = error.possible.split("near ")[1]
    assert place.startswith("51.8") or place.startswith("51.79") or place.startswith("51.78")
    high = [LOW + (k + 0.5) * M2 for k in range(-1, 6)]
    told = parse_time(error.possible.split("at ")[2].split(";")[0])
    assert min(abs(told - h) for h in high) < 700.0
    assert error.remedy


def test_a_closed_bar_is_the_cause_and_not_the_end_of_the_data_beside_it() -> None:
    """The sea is known in a strip round the way only; without waits the bar is closed."""
    known = estuary(6.5)

    def bed(time, lat, lon):
        depth = known.sample([BED], time, lat, lon)[BED]
        return np.where((lat > 51.74) & (lat < 51.86), depth, np.nan)

    with pytest.raises(NoRouteError) as caught:
        asked(
            Sea.from_functions({BED: bed, LEVEL: level}),
            start=(51.80, 3.45),
            goal=(51.80, 3.70),
            wait=False,
        )
    error = caught.value
    assert error.details["reasons"]["no data"] > error.details["reasons"]["under-keel clearance"]
    assert "too shallow at that time: near 51.8" in error.possible
    assert "7.50 m are required, and the greatest depth is 8.00 m at 2026" in error.possible
    assert "--depart-window" in error.remedy and "--no-wait" in error.remedy
    assert "gaps" not in error.remedy


@pytest.mark.slow
def test_a_path_that_opens_at_high_water_is_sailed() -> None:
    best = asked(estuary(6.5)).best
    assert best.feasible and best.waiting_h > 0.0


def test_too_late_is_not_too_shallow() -> None:
    with pytest.raises(NoRouteError) as caught:
        asked(estuary(6.5), wait=False)
    assert "too shallow at any tide" not in str(caught.value)


@pytest.mark.slow
@pytest.mark.parametrize("objective", ["time", "fuel", "distance"])
def test_an_arrival_before_the_tide_allows_it_is_too_early_and_not_too_shallow(objective) -> None:
    """The gully opens at high water, 6 h after the departure: an arrival 3 h after it is not."""
    cost = {"fuel": {"reference_t_per_day": 24.0}, "engine": {"reference_speed_kn": 10.0}}
    data = {"name": "x", "hull": {"draught_m": 6.5}, "speeds_kn": [10.0]}
    ship = Ship.from_dict({**data, **cost, "models": {"calm_water": "cubic"}})
    given = {"ship": ship, "sea": estuary(6.5), "chart": Chart.open_water(*AREA)}
    # the shortest path clips the corners of the bank
    given["resolution"] = 500.0 if objective == "distance" else COARSE
    ends = {"start": (51.71, 3.45), "goal": (51.77, 3.70), "depart": LOW, "min_ukc_m": 1.0}
    ends = {**ends, "objective": objective, "method": "exact"}
    with pytest.raises(NoRouteError) as caught:
        plan(Voyage(offing_nm=0.0, **ends, arrive_by=LOW + 3 * 3600.0), **given)
    assert caught.value.asked == "No route arrives by 2026-01-01T06:00:00Z."
    assert "too shallow" not in str(caught.value)
    earliest = parse_time(caught.value.details["earliest"])
    assert LOW + 4 * 3600.0 < earliest < LOW + 7 * 3600.0
    assert "later arrival" in caught.value.remedy
    best = plan(Voyage(offing_nm=0.0, **ends, arrive_by=earliest + 1800.0), **given).best
    assert best.feasible and best.arrive <= earliest + 1800.0


def test_an_arrival_before_a_window_allows_it() -> None:
    voyage = {"start": (51.71, 3.45), "goal": (51.77, 3.70), "min_ukc_m": 1.0}
    window = (LOW, LOW + 1800.0)
    given = {"ship": SHIP, "sea": estuary(6.5), "chart": Chart.open_water(*AREA)}
    given["resolution"] = COARSE
    with pytest.raises(NoRouteError) as caught:
        plan(
            Voyage(offing_nm=0.0, **voyage, depart_window=window, arrive_by=LOW + 3 * 3600.0),
            **given,
        )
    assert caught.value.asked == "No route arrives by 2026-01-01T06:00:00Z."
    assert "shortest passage of the window" in caught.value.possible


def test_a_refusal_names_all_departures_of_a_window() -> None:
    def waves(time, lat, lon):
        return 3.0 + 0.0 * lat

    ship = Ship.simple(speed_kn=10.0, draught_m=6.5, max_wave_height_m=2.0)
    ends = {"start": (51.71, 3.45), "goal": (51.77, 3.70), "offing_nm": 0.0}
    given = {
        "ship": ship, "chart": Chart.open_water(*AREA), "resolution": COARSE,
        "sea": Sea.from_functions({"sea_surface_wave_significant_height": waves}),
    }  # fmt: skip
    with pytest.raises(NoRouteError) as caught:
        plan(Voyage(**ends, depart_window=(LOW, LOW + 7200.0)), **given)
    when = "departing at any time from 2026-01-01T03:00:00Z to 2026-01-01T05:00:00Z."
    assert caught.value.asked.endswith(f"keeps the limits, {when}")
    with pytest.raises(NoRouteError, match=r"keeps the limits, departing 2026-01-01T03:00:00Z\."):
        plan(Voyage(**ends, depart=LOW), **given)


@pytest.mark.slow
def test_the_best_departure_of_a_window_goes_straight_over_the_bar() -> None:
    # at the first moment of the tide the referee still finds the limit exceeded at the bar's edge
    def bar(time, lat, lon):
        return np.where((lon > 3.55) & (lon < 3.60), 7.0, 15.0) + 0.0 * lat

    voyage = {"start": (51.71, 3.45), "goal": (51.77, 3.70), "min_ukc_m": 1.0}
    sea = Sea.from_functions({BED: bar, LEVEL: level})
    given = {"ship": SHIP, "sea": sea, "chart": Chart.open_water(*AREA), "resolution": COARSE}
    window = (LOW - 3.0 * 3600.0, LOW + 9.0 * 3600.0)
    best = plan(Voyage(offing_nm=0.0, **voyage, depart_window=window), **given).best
    straight = distance(51.71, 3.45, 51.77, 3.70)
    assert best.feasible and best.waiting_h == 0.0
    assert best.legs["length"].sum() == pytest.approx(straight, rel=1e-4)


def test_water_that_is_never_deep_enough_is_reported_for_any_arrival() -> None:
    with pytest.raises(NoRouteError, match="too shallow at any tide") as caught:
        asked(estuary(5.5), arrive_by=LOW + 3 * 3600.0)
    # 5.5 + 1.5 m at high water, which is after the latest arrival; 6.5 + 1 m are needed
    assert caught.value.details["missing_m"] == pytest.approx(0.5, abs=0.02)


@pytest.mark.parametrize("end", ["start", "goal"])
def test_an_end_point_in_water_that_is_never_deep_enough(end) -> None:
    with pytest.raises(NoRouteError, match="at any tide of the data") as caught:
        asked(estuary(6.5), **{end: (51.65, 3.575)})
    # 3 + 1.5 m; 7.5 m are needed
    assert caught.value.details["missing_m"] == pytest.approx(3.0, abs=0.01)
    assert "51.65" in caught.value.asked and "highest tide" in caught.value.asked


def test_a_dry_goal_of_a_mesh() -> None:
    """The bank of the synthetic run is 1 m above datum in the east; the tide rises 1.5 m."""
    sea = Sea.open(hydro.delft3d_fm())
    voyage = Voyage(
        offing_nm=0.0,
        start=(51.02, 3.005),
        goal=(51.02, 3.104),
        depart="2026-01-01T01:00Z",
        min_ukc_m=0.0,
    )
    ship = Ship.simple(speed_kn=6.0, draught_m=2.0)
    with pytest.raises(NoRouteError, match="at any tide") as caught:
        plan(voyage, ship=ship, sea=sea, chart=Chart.open_water(50.9, 51.2, 2.9, 3.3))
    assert 0.5 < caught.value.details["missing_m"] < 2.5


def test_levels_without_a_bed_are_not_a_depth() -> None:
    data = hydro.delft3d_fm().drop_vars(["mesh2d_flowelem_bl", "mesh2d_waterdepth"])
    voyage = Voyage(
        offing_nm=0.0,
        start=(51.02, 3.005),
        goal=(51.02, 3.03),
        depart="2026-01-01T01:00Z",
        min_ukc_m=1.0,
    )
    with pytest.raises(MissingVariableError, match="provides depth") as caught:
        plan(voyage, ship=SHIP, sea=Sea.open(data), chart=Chart.open_water(50.9, 51.2, 2.9, 3.3))
    assert "bed level" in caught.value.possible and caught.value.remedy


@pytest.mark.slow
def test_routes_do_not_pass_a_gap_in_time() -> None:
    """No data from 3 h to 9 h: the ship stays at its berth until then, or has no route."""
    sea = Sea.open(hydro.dhi().isel(time=[0, 1, 2, 3, 9, 10, 11, 12]))
    given = {
        "ship": Ship.simple(speed_kn=6.0, draught_m=1.0),
        "sea": sea,
        "chart": Chart.open_water(50.9, 51.2, 2.9, 3.3),
    }
    ends = {"start": (51.02, 3.005), "goal": (51.02, 3.05), "depart": "2026-01-01T04:00Z"}
    best = plan(Voyage(offing_nm=0.0, **ends), **given).best
    assert best.feasible
    assert best.track.wait[0] >= 5 * 3600.0 - 1.0
    with pytest.raises(NoRouteError) as caught:
        plan(Voyage(offing_nm=0.0, **ends, wait=False), **given)
    assert any("no data" in reason for reason in caught.value.reasons)
    assert "gaps" in caught.value.remedy


def test_the_high_water_that_is_named_is_the_first_about_as_high() -> None:
    """A sample a centimetre higher named the high water of the next day."""
    times = np.arange(0.0, 30.0, 0.5) * 3600.0
    level = -1.5 * np.cos(2.0 * np.pi * times / (12.4 * 3600.0))
    level[37:] += 0.02
    fields = SimpleNamespace(
        times=times,
        values=np.stack([np.full(len(times), 10.0), level], axis=-1)[None],
        channel_index={BED_DEPTH: 0, WATER_LEVEL: 1},
    )
    assert _time_of_high_water(fields, 0) == pytest.approx(6.2 * 3600.0, abs=900.0)
    level[10:15] = np.nan  # without the first
    fields.values[0, :, 1] = level
    assert _time_of_high_water(fields, 0) > 17.0 * 3600.0
