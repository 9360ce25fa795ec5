"""The form of the page: every entry of a request is kept, and what is wrong stands at its field."""

from __future__ import annotations

import dataclasses
from typing import Any

import pytest

from thalweg.planning.voyage import Voyage
from thalweg.service.jobs.plan_request import (
    PlanRequest,
    RequestedCharges,
    RequestedLimits,
    RequestedRouteFiles,
)

pytestmark = pytest.mark.slow

RING = [[0, 50], [1, 50], [1, 51], [0, 50]]
AREAS = {
    "type": "FeatureCollection",
    "features": [
        {
            "type": "Feature",
            "properties": {"kind": kind, **more},
            "geometry": {"type": shape, "coordinates": coordinates},
        }
        for kind, more, shape, coordinates in (
            ("no-go", {}, "Polygon", [RING]),
            ("price", {"factor": 1.2, "name": "dear"}, "Polygon", [RING]),
            ("penalty", {"factor": 3}, "MultiPolygon", [[RING]]),
        )
    ],
}
VOYAGE = {
    "start": "Halifax",
    "goal": "49.7N 6.5W",
    "depart": "1998-08-31T12:00:30Z",
    "objective": "weighted",
    "via": ["45.0N 40.0W"],
    "arrive_by": "1998-09-20T00:00Z",
    "arrive": "1998-09-10T06:00Z",
    "wait": False,
    "speed_kn": 12,
    "hold": "power",
    "min_ukc_m": 2.5,
    "seed": 4,
    "fuel_price_usd": 500,
    "eca_price_factor": 1.5,
    "time_price_usd_per_h": 400,
    "forbid": ["kiel"],
    "open": ["Raz de Sein"],
    "avoid": ["Pentland Firth", "Raz Blanchard"],
    "offing_nm": 1.5,
    "ignore_shoals": True,
    "ignore_lanes": True,
    "method": "exact",
    "ensemble": "cvar",
    "speed_step_kn": 0.5,
    "speed_block_h": 0,
    "layered": {"layers": [8, 9], "near_coast_nm": 3, "contain": [[47.5, -6.0]]},
    "weights": {"fuel": 1, "comfort": 0.5},
    "at_most": {"fuel": 300},
    "at_least": {"land_distance_nm": 0.5},
}
REQUEST: dict[str, Any] = {
    "title": "Every entry",
    "voyage": VOYAGE,
    "ship": "handysize-bulker",
    "seas": ["storm"],
    "fill": {"waves": ["nearest:25", 0], "currents": 0.5, "wind": "nearest:40"},
    "variables": {"eastward_wind": "u10", "northward_wind": "v10"},
    "areas": AREAS,
    "eca": False,
    "charges": {"share_percent": 0, "ets_price": 80, "eur_rate": 1.1, "year": 2027},
    "sampling": "nearest:2.5",
    "average_over_m": 9.5,
    "limits": {"wave_height_m": 6, "wind_speed_kn": 40, "motion_sickness_percent": 20},
    "coast": "l",
    "load_factor": 0.345,
    "route_files": {
        "legs": "great-circle",
        "cross_track_nm": 0.2,
        "waypoint_spacing_nm": 60,
        "max_waypoints": 100,
        "rtz_version": "1.0",
    },
    "network": "layered",
    "resolution_nm": 5,
    "proof_s": 0,
}
#: What a second request holds in place of some entries.
UPLOADED = ("depths", "traffic", "history")
OTHERWISE = {"corridor_gain_percent": 3}
HISTORY = "0123456789abcdef"
BACK = "(r) => { window.thalweg.form.set(r); return window.thalweg.form.request(); }"


def test_the_requests_of_this_test_hold_every_entry():
    named = {*REQUEST, *UPLOADED, *OTHERWISE}
    assert named == set(PlanRequest.model_fields)
    assert {*VOYAGE, "depart_window"} == {field.name for field in dataclasses.fields(Voyage)}
    for name, model in (
        ("charges", RequestedCharges),
        ("limits", RequestedLimits),
        ("route_files", RequestedRouteFiles),
    ):
        assert set(REQUEST[name]) == set(model.model_fields)


def test_a_request_with_every_entry_passes_the_form_unchanged(visit):
    page = visit.open()
    page.wait_for_selector("#ship option", state="attached")
    assert page.evaluate(BACK, REQUEST) == REQUEST
    window = {"depart_window": ["1998-08-29T00:00Z", "1998-08-31T00:00Z"], "objective": "time"}
    voyage = {"start": "Halifax", "goal": "49.7N 6.5W", **window}
    plain = {"title": "Plain", "voyage": voyage, "ship": "handysize-bulker", "seas": ["storm"]}
    assert page.evaluate(BACK, plain) == plain
    assert page.evaluate(BACK, {**plain, "most": 3}) == {**plain, "most": 3}
    of_history = {**plain, "history": HISTORY, "corridor_gain_percent": 3}
    uploaded = {**of_history, "depths": [HISTORY], "traffic": [HISTORY]}
    assert page.evaluate(BACK, uploaded) == uploaded
    page.locator("details[data-part=chart] > summary").click()
    page.get_by_label("a file that is not there any more").first.uncheck()
    assert "depths" not in page.evaluate("window.thalweg.form.request()")
    visit.picture("form_filled")


def test_a_wrong_number_in_a_group_is_an_error_at_its_field(visit):
    page = visit.open()
    visit.fill_short()
    page.locator("details[data-part=files] > summary").click()
    page.locator("#n-cross_track_nm").fill("wide")
    page.get_by_role("button", name="Plan the voyage").click()
    error = page.locator("[data-field=cross_track_nm] .error")
    assert "wide is not a number" in error.inner_text()
    page.locator("#n-cross_track_nm").fill("50")
    page.get_by_role("button", name="Plan the voyage").click()
    error.get_by_text("9.99").wait_for()


def test_the_ends_of_a_route_file_are_filled_in(visit, planned, tmp_path):
    page = visit.open()
    page.wait_for_selector("#ship option", state="attached")
    route = tmp_path / "master.rtz"
    route.write_bytes(visit.service.http.get(f"/api/v1/plans/{planned}/routes/1.rtz").content)
    page.evaluate("window.thalweg.form.addVia('45.0N 40.0W')")
    page.locator("#voyage-file").set_input_files(str(route))
    page.locator(".field.goal .understood", has_text="Position").wait_for()
    page.get_by_label("Storm of 1998").check()
    request = page.evaluate("window.thalweg.form.request()")
    voyage = request["voyage"]
    assert (voyage["start"], voyage["goal"]) == ("47.0000N 20.0000W", "47.2000N 19.5000W")
    assert voyage["depart"] == "1998-08-31T12:00Z"
    assert "via" not in voyage  # of the voyage before


def test_the_chart_goes_to_places_that_are_typed(visit):
    page = visit.open()
    page.wait_for_selector("#ship option", state="attached")
    seen = """([lon, lat]) => { const [w, s, e, n] = window.thalweg.chart.view;
      const turns = [-360, 0, 360].some((turn) => lon + turn > w && lon + turn < e);
      return turns && lat > s && lat < n; }"""
    inside = f"(places) => places.every({seen})"
    page.evaluate("window.thalweg.chart.fit([[0, 40], [10, 50]])")
    start, goal = page.locator(".field.start input"), page.locator(".field.goal input")
    start.fill("35.0N 140.5E")
    start.press("Enter")
    page.wait_for_function(inside, arg=[[140.5, 35.0]])
    goal.fill("37.5N 123.0W")
    goal.press("Enter")
    page.wait_for_function(inside, arg=[[140.5, 35.0], [-123.0, 37.5]])
    west, _, east, _ = page.evaluate("window.thalweg.chart.view")
    assert east - west < 220  # over the Pacific, not round the globe
