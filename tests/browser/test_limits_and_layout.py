"""What limits a route, where the form says that it begins, and parts of the page that line up."""

from __future__ import annotations

import json
import re
from datetime import UTC, datetime

import pytest

from tests.browser.conftest import playwright_api

pytestmark = pytest.mark.slow


def time_words(seconds: float) -> str:
    return f"{datetime.fromtimestamp(seconds, UTC):%-d %b %H:%M} UTC"


CENTRE_AND_ZOOM = "window.thalweg.chart.place"
MARKS = """(() => { const rect = (one) => one.getBoundingClientRect();
  const plot = rect(document.querySelector(".u-over"));
  const line = rect(document.querySelector("#time"));
  return [line.left + 8 - plot.left, line.right - 8 - plot.right]; })()"""


def lined_up(gaps) -> bool:
    return all(abs(gap) <= 1.0 for gap in gaps)


def test_the_slider_stands_over_the_profile(visit, planned):
    page = visit.open(f"#plan={planned}")
    page.wait_for_selector(".u-over")
    assert lined_up(page.evaluate(MARKS))
    page.locator(".chips").get_by_label("Fuel").check()  # with an axis of its own
    visit.until(MARKS, lined_up)
    page.set_viewport_size({"width": 900, "height": 800})
    visit.until(MARKS, lined_up)
    times = "(() => { const { drawer } = window.thalweg, { plot } = drawer;"
    times += "return [drawer.from, drawer.to, plot.scales.x.min, plot.scales.x.max]; })()"
    begin, end, first, last = page.evaluate(times)
    assert (begin, end) == (first, last)


def test_the_form_states_where_a_route_begins(visit):
    page = visit.open()
    visit.fill_short("Rotterdam", "Hull")
    said = page.locator(".field.start .understood")
    berth = "Rotterdam, NL (NLRTM) · berth 51°54.0′N 004°27.6′E, approach of 23.5 nm"
    playwright_api.expect(said).to_have_text(berth)
    page.locator(".field.goal .understood", has_text="Hull").wait_for()
    ends = page.evaluate("window.thalweg.form.ends")
    assert (ends[0]["lat"], ends[0]["lon"]) == (51.9, 4.46)
    page.get_by_role("button", name="+ Via point").click()
    page.locator(".field.via input").fill("Vlissingen")
    page.keyboard.press("Tab")
    page.locator(".field.via .understood", has_text="passed off its approach").wait_for()
    via = page.evaluate("window.thalweg.form.ends[1]")
    approach = visit.service.http.get("/api/v1/places?text=Vlissingen").json()["approach"]
    assert [via["lat"], via["lon"]] == approach["sea_end"] != approach["berth"]


def test_the_chart_goes_to_ends_that_cannot_be_told_apart(visit):
    page = visit.open()
    before = page.evaluate(CENTRE_AND_ZOOM)
    visit.fill_short("51.0N 2.0E", "51.3N 2.6E")  # both are on the chart
    page.locator("#depart").focus()
    centre, zoom = visit.until(CENTRE_AND_ZOOM, lambda place: place != before)
    assert zoom > before[1] + 3.0
    visit.fill_short("51.0N 2.0E", "51.3N 2.4E")
    page.locator(".field.goal .understood", has_text="002°24.0′E").wait_for()
    assert page.evaluate(CENTRE_AND_ZOOM) == [centre, zoom]


def test_a_comparison_fits_the_chart_again_unless_somebody_moved_it(visit, planned):
    page = visit.open(f"#view=compare&routes={planned}.1,{planned}.0")
    page.locator(".compare-table tbody tr").nth(1).wait_for()
    _, wide = page.evaluate(CENTRE_AND_ZOOM)
    page.set_viewport_size({"width": 1280, "height": 560})
    visit.until(CENTRE_AND_ZOOM, lambda place: place[1] < wide - 0.3)
    page.set_viewport_size({"width": 1280, "height": 720})
    visit.until(CENTRE_AND_ZOOM, lambda place: abs(place[1] - wide) < 0.05)
    page.locator("#chart").focus()
    page.keyboard.press("+")
    moved = visit.until(CENTRE_AND_ZOOM, lambda place: place[1] > wide + 0.9)
    page.set_viewport_size({"width": 1280, "height": 560})
    page.wait_for_timeout(500)
    assert page.evaluate(CENTRE_AND_ZOOM)[1] == pytest.approx(moved[1], abs=0.05)


def test_what_limits_a_route_is_said_and_shown(visit, planned):
    page = visit.open(f"#plan={planned}")
    rows = page.locator(".limits li")
    rows.first.wait_for()
    (met,) = visit.service.http.get(f"/api/v1/plans/{planned}/limits.json").json()["routes"]
    waves = next(one for one in met if one["name"] == "wave_height_m")
    text = re.sub(r"\s+", " ", rows.filter(has_text="Waves").inner_text())
    assert f"{waves['worst']:.1f} of 8.0 m" in text
    assert "15.2 of 15.2 kn" in rows.filter(has_text="Ordered speed").inner_text()
    page.locator("#time").press("End")
    rows.filter(has_text="Waves").get_by_role("button").click()
    moment = "window.thalweg.drawer.output.textContent"
    expected = time_words(waves["time"])
    visit.until(moment, lambda said: said == expected)
    visit.check_accessibility()


def test_parts_of_a_route_near_a_limit_are_drawn(visit, planned):
    given = [{"name": "wave_height_m", "limit": 2.0, "worst": 1.95, "near_h": 1.0}]
    job = visit.service.http.get(f"/api/v1/plans/{planned}/profiles/1").json()
    begin, end = job["time"][0], job["time"][-1]
    near = [begin + 0.25 * (end - begin), begin + 0.5 * (end - begin)]
    given[0] |= {"near": [near], "time": near[0]}
    page = visit.page
    page.route("**/limits.json", lambda route: route.fulfill(body=json.dumps({"routes": [given]})))
    visit.open(f"#plan={planned}")
    page.locator(".limits", has_text="near its limit for 1 h 00 min").wait_for()
    script = "window.thalweg.chart.routes.near.getSource().getFeatures()"
    assert page.evaluate(f"{script}.length") == 1
    length = page.evaluate(f"{script}[0].getGeometry().getLength()")
    whole = "window.thalweg.chart.routes.chosen.getSource().getFeatures()[0].getGeometry()"
    assert 0.2 < length / page.evaluate(f"{whole}.getLength()") < 0.35
    visit.picture("limits")


def test_a_long_list_can_be_read_to_its_end(visit):
    page = visit.open()
    script = """async () => {
      const { h, longList } = await import("/static/app/common/elements.js");
      const box = h("div", {}, longList([1, 2, 3, 4, 5].map((n) => h("li", {}, String(n))), 3));
      return [box.querySelector("summary").textContent, box.querySelectorAll("details li").length,
              box.querySelectorAll("li").length]; }"""
    assert page.evaluate(script) == ["2 more", 2, 5]


def test_members_of_a_forecast_that_break_a_limit_are_stated_first(visit, planned):
    spread = {"mean": 80.0, "p10": 78.5, "p90": 86.0, "cvar": 86.4, "members": 4}
    row = {"members": 6, "infeasible": [0, 3], "shown_member": 5, "time_h": spread}
    row |= {"first_reason": "waves at 44 59.1S 163 33.3E", "highest_waves_m": [8.2, None, 6.9]}

    def with_members(route):
        answer = route.fetch()
        route.fulfill(response=answer, json=answer.json() | {"ensemble": [row]})

    visit.page.route(f"**/api/v1/plans/{planned}/result", with_members)
    page = visit.open(f"#plan={planned}")
    alert = page.get_by_role("alert").filter(has_text="In 2 of 6 members of the forecast (0, 3)")
    playwright_api.expect(alert).to_contain_text("waves at 44 59.1S 163 33.3E")
    card = page.locator(".card", has_text="Members of the forecast")
    playwright_api.expect(card).to_contain_text("4 of 6 keep the limits")
    playwright_api.expect(card).to_contain_text("those of member 5")
    playwright_api.expect(card).to_contain_text("waves of up to 8.2 m")
    visit.picture("members")


@pytest.mark.parametrize("width", [320, 390, 768, 1280])
def test_the_header_fits_the_width_of_the_page(visit, planned, width):
    visit.page.set_viewport_size({"width": width, "height": 844})
    page = visit.open(f"#plan={planned}")
    page.locator(".proof").wait_for()
    ends = """[...document.querySelectorAll(".bar *")].filter((one) => one.offsetParent)
      .map((one) => one.getBoundingClientRect().right)"""
    assert max(page.evaluate(ends)) <= width
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert page.evaluate("document.body.scrollWidth") <= width
    visit.picture(f"header-{width}")
    page.get_by_role("button", name="Voyages", exact=True).click()
    page.get_by_role("heading", name="Voyages").wait_for()


def beside_of(page, planned, **changes):
    """Let the page read another route that ignores the weather."""

    def changed(route):
        answer = route.fetch()
        route.fulfill(response=answer, json=answer.json() | changes)

    page.route(f"**/api/v1/plans/{planned}/beside.json", changed)


def test_no_saving_is_shown_over_a_route_that_breaks_a_limit(visit, planned):
    broken = [{"reason": "wave height above the limit", "lat": 47.1, "lon": -19.8}]
    beside_of(visit.page, planned, feasible=False, violations=broken, fuel_t=500.0, time_h=99.0)
    page = visit.open(f"#plan={planned}")
    card = page.locator(".card", has=page.get_by_text("Weather ignored", exact=True))
    playwright_api.expect(card).to_contain_text(
        "breaks a limit: wave height above the limit. Savings over it are not stated."
    )
    assert page.locator(".cards .less, .cards .more").count() == 0
    assert "against weather ignored" not in page.locator(".cards").inner_text()
    visit.picture("weather-ignored-broken")


@pytest.mark.parametrize("later_h", [20.0, -20.0])
def test_less_fuel_on_a_longer_voyage_is_no_saving(visit, planned, later_h):
    result = visit.service.http.get(f"/api/v1/plans/{planned}/result").json()
    (route,) = result["routes"]
    blind = {"time_h": 50.0 - later_h, "fuel_t": route["fuel_t"] + 80.0}
    route["time_h"] = 50.0
    visit.page.route(f"**/api/v1/plans/{planned}/result", lambda sent: sent.fulfill(json=result))
    beside_of(visit.page, planned, feasible=True, violations=[], **blind)
    page = visit.open(f"#plan={planned}")
    card = page.locator(".card", has=page.get_by_text("Fuel", exact=True))
    playwright_api.expect(card).to_contain_text("−80.0 t against weather ignored")
    assert card.locator(".less").count() == (0 if later_h > 0.0 else 1)
    assert ("which arrives 20 h 00 min earlier" in card.inner_text()) == (later_h > 0.0)
    visit.picture(f"weather-ignored-{later_h:.0f}")


def test_a_front_states_what_it_saves_in_the_same_time(visit):
    page = visit.open()
    script = """async ([notes, feasible]) => {
      const { WeatherIgnored } = await import("/static/app/result/weather_ignored.js");
      const row = { speed_kn: 12, time_h: 60, saved: 3.24, saved_percent: 4.1, feasible: true };
      const rows = [{ ...row, time_h: 40, saved: null }, row, { ...row, time_h: 90, saved: 9 }];
      const plan = { notes, comparison: rows, front: { criterion: "fuel", unit: "t" } };
      const route = { time_h: 62, feasible }, blind = { time_h: 40, feasible: true };
      return new WeatherIgnored(plan, route, blind).card()?.textContent || ""; }"""
    text = page.evaluate(script, [[], True])
    assert "12.0 kn takes 2 d 12 h 00 min" in text and "−3.2 t of fuel (4.1 %)" in text
    none = "No weather-blind route is feasible: waves. Savings over it are not stated."
    assert "breaks a limit. Savings over it are not stated." in page.evaluate(
        script, [[none], True]
    )
    assert page.evaluate(script, [[], False]) == ""  # the chosen route itself breaks a limit


def test_one_speed_of_a_ship_is_no_range(visit):
    def single(route):
        answer = route.fetch()
        sheet = answer.json()
        for row in sheet["settings"]:
            row["speed_kn"] = 10.0
        route.fulfill(response=answer, json=sheet)

    visit.page.route("**/api/v1/ships/handysize-bulker", single)
    page = visit.open()
    page.wait_for_selector("#ship option", state="attached")
    page.locator("#ship").select_option("handysize-bulker")
    page.get_by_text("10.0 kn · draught").wait_for()
    assert "10.0 to 10.0" not in page.locator("#panel").inner_text()
