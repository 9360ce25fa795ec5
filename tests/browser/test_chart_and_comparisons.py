"""The chart with its tables, comparisons with a reference, the age of a forecast, a tablet."""

from __future__ import annotations

import json
import re
from typing import Any

import numpy as np
import pytest

from tests.browser.conftest import SHORT_REQUEST, Visit, playwright_api
from tests.service.conftest import ended

pytestmark = pytest.mark.slow
LEVELS = """window.thalweg.chart.coast.levels.map(({ name, land }) =>
  [name, land.getVisible(), land.getSource().getFeatures().length > 0])"""
WIND = (
    "(() => { const { shown } = window.thalweg.chart.depths; return shown ? shown.kind : ''; })()"
)


def test_what_the_chart_shows_is_also_in_tables(visit, planned):
    page = visit.open(f"#plan={planned}")
    page.wait_for_selector(".proof")
    page.locator("#layers-button").click()
    page.get_by_label("Depth (global layer").check()
    page.get_by_label("Significant wave height").check()
    visit.until(WIND, lambda kind: kind == "depth")
    page.get_by_role("button", name="Show as tables").click()
    rows = page.locator("#batch-sheet tbody tr")
    for tab, words in (
        ("Weather", r"\d\.\d \d\d\d°"),
        ("Depth", r"\d\d\d"),
        ("Routes", r"Route 1\s+47°00\.0"),
        ("Control areas", r"Baltic"),
        ("Canals", r"Suez Canal\s+14\.0"),
    ):
        page.get_by_role("tab", name=tab, exact=True).click()
        playwright_api.expect(rows.first).to_be_visible()
        assert re.search(words, page.locator("#batch-sheet").inner_text()), tab
    visit.picture("tables")
    visit.check_accessibility()
    page.get_by_role("button", name="Close", exact=True).click()
    page.locator("#tab-profile").wait_for()


def test_the_crude_coast_is_drawn_until_the_finer_one_is_there(visit):
    page = visit.page
    page.route("**/api/v1/coast/l/*", lambda route: route.abort())
    visit.open()
    found = visit.until(LEVELS, lambda levels: all(levels[0][1:]))  # drawn when it is complete
    assert found[0] == ["c", True, True]
    assert found[1][1:] == [True, False]
    assert page.locator("#chart").is_visible()


def test_a_comparison_has_a_reference_and_its_address_restores_it(visit, planned):
    page = visit.open(f"#view=compare&routes={planned}.1,{planned}.0")
    rows = page.locator(".compare-table tbody tr")
    rows.nth(1).wait_for()
    assert rows.nth(0).inner_text().startswith("A short voyage\nreference")
    assert "weather ignored" in rows.nth(1).inner_text()
    entry = page.locator(".pick .jobrow", has_text="A short voyage").first
    assert "47.0N 20.0W to 47.2N 19.5W · Handysize bulker" in entry.inner_text()
    miles = [rows.nth(i).locator("td").nth(3).inner_text().split("\n") for i in (0, 1)]
    (plain,), (other, change) = miles
    expected = float(other.removesuffix(" nm")) - float(plain.removesuffix(" nm"))
    assert float(change.replace("−", "-")) == pytest.approx(expected, abs=1e-6)
    page.get_by_role("button", name="Make A short voyage, weather ignored the reference").click()
    page.wait_for_url(re.compile(f"routes={planned}.0,{planned}.1$"))
    page.locator(".compare-table tbody tr", has_text="reference").get_by_text("ignored").wait_for()
    visit.picture("compare_reference")
    page.reload()
    rows.nth(1).wait_for()
    assert rows.nth(0).inner_text().startswith("A short voyage, weather ignored\nreference")
    page.get_by_role("button", name="Leave out A short voyage", exact=True).click()
    page.get_by_text("Choose one more route").wait_for()
    visit.check_accessibility()


def test_any_route_of_a_front_is_compared(visit):
    voyage = {**SHORT_REQUEST["voyage"], "objective": "front", "method": "exact"}
    request = {**SHORT_REQUEST, "title": "A front", "voyage": voyage, "resolution_nm": 4.0}
    http = visit.service.http
    job = http.post("/api/v1/plans", json=request).raise_for_status().json()
    done = ended(http.get, job["id"])
    assert done["state"] == "done" and done["summary"]["routes"] > 2
    page = visit.open("#view=compare")
    others = page.locator(".pick details.others").first
    others.locator("summary").click()
    boxes = others.locator("input[type=checkbox]")
    boxes.first.wait_for()
    assert boxes.count() == done["summary"]["routes"] - 1
    boxes.nth(0).check()
    boxes.nth(1).check()
    page.wait_for_url(re.compile(f"routes={job['id']}.2,{job['id']}.3$"))
    rows = page.locator(".compare-table tbody tr")
    rows.nth(1).wait_for()
    names = [rows.nth(i).locator("td b").first.inner_text() for i in (0, 1)]
    assert names == ["A front, route 2", "A front, route 3"]
    visit.picture("compare_front")


def test_an_example_that_is_asked_for_later_takes_the_place_of_the_one_before(visit, planned):
    page = visit.page
    job = visit.service.http.get(f"/api/v1/plans/{planned}").json()
    titles: list[str] = []
    held: list[Any] = []

    def answer(route: Any) -> None:
        if route.request.method != "POST":
            return route.continue_()
        titles.append(json.loads(route.request.post_data)["title"])
        if len(titles) == 1:
            held.append(route)
            return None
        return route.fulfill(json=job)

    page.route("**/api/v1/plans", answer)
    visit.open("#view=compare")
    page.get_by_role("button", name="Suez, or round the Cape").click()
    page.get_by_role("button", name="One voyage, four speeds").click()
    page.wait_for_url(re.compile("routes="))
    with page.expect_response(re.compile(f"/plans/{planned}$")):
        held[0].fulfill(json=job)
    page.wait_for_timeout(300)
    assert titles == ["By Suez", "10 kn", "11 kn", "12 kn", "13 kn"]
    assert page.locator(".picked li").count() == 4


def test_the_age_of_a_forecast_is_stated(visit, tmp_path):
    xarray = pytest.importorskip("xarray")
    axes = ("time", "latitude", "longitude")
    field = np.full((2, 5, 5), 5.0, "f4")
    data = xarray.Dataset(
        {"u10": (axes, field), "v10": (axes, field)},
        {
            "time": np.array(["2026-01-01T06", "2026-01-02T06"], "datetime64[ns]"),
            "latitude": np.linspace(45.0, 49.0, 5),
            "longitude": np.linspace(-21.0, -17.0, 5),
        },
        {"forecast_reference_time": "2026-01-01T00:00:00Z"},
    )
    data.to_netcdf(tmp_path / "forecast.nc")
    page = visit.open()
    page.wait_for_selector("#ship option", state="attached")
    page.locator("#sea-file").set_input_files(str(tmp_path / "forecast.nc"))
    page.get_by_role("checkbox", name="forecast.nc").wait_for()
    playwright_api.expect(page.locator("#depart")).to_have_value("2026-01-01 06:00")
    page.locator("#layers-button").click()
    page.get_by_label("Wind at 10 m").check()
    said = page.locator("#legend .run")
    said.wait_for()
    assert re.fullmatch(r"forecast of 1 Jan 00:00, [\d,]+ h old", said.inner_text())
    page.set_viewport_size({"width": 768, "height": 1024})
    assert said.is_visible()


def test_a_voyage_is_begun_by_touch(browser, service):
    visit = Visit(browser, service, has_touch=True)
    try:
        page = visit.open()
        page.wait_for_selector("#chart[data-idle]")
        page.wait_for_selector("#ship option", state="attached")
        box = page.locator("#chart").bounding_box()
        page.touchscreen.tap(box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"])
        page.get_by_role("menuitem", name="From here").tap()
        assert "W" in page.locator(".field.start input").input_value()
    finally:
        visit.context.close()
    assert visit.outside == [] and visit.errors == []
