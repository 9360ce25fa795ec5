"""The web application in a real browser: plan, watch, choose, export, errors, areas, kills."""

from __future__ import annotations

import math
import re
from datetime import UTC, datetime
from pathlib import Path

import pytest

from tests.browser.conftest import SHORT_REQUEST, Visit, playwright_api
from tests.service.conftest import ended

pytestmark = pytest.mark.slow


def job_of(page) -> str:
    """Return the job of the address of a page."""
    page.wait_for_url(re.compile("plan="))
    return re.search(r"plan=([0-9a-f]{16})", page.url)[1]


def test_a_voyage_is_planned_by_clicking_on_the_chart(visit):
    page = visit.open()
    visit.plan_coarsely(10.0)
    page.wait_for_selector("#chart[data-idle]")
    page.wait_for_selector("#ship option", state="attached")
    visit.picture("form")
    assert not page.get_by_label("Storm of 1998").is_checked()
    page.get_by_label("Storm of 1998").check()
    time = page.locator("#time")
    time.focus()
    page.keyboard.press("End")
    assert page.locator("#valid b").inner_text() == "8 Sep 1998 06:00"
    chart = page.locator("#chart")
    box = chart.bounding_box()
    for share, choice in ((0.50, "From here"), (0.53, "To here")):
        chart.click(position={"x": share * box["width"], "y": 0.55 * box["height"]})
        page.get_by_role("menuitem", name=choice).click()
        page.wait_for_timeout(400)  # two clicks at once are a double click
    assert "W" in page.locator(".field.start input").input_value()
    page.locator("#depart").fill("1998-08-31T12:00")
    visit.plan()
    visit.picture("result")
    assert "h" in visit.figure("Time")
    assert "unknown" not in visit.figure("Distance")
    assert "is possible" in page.locator(".proof").inner_text()
    with page.expect_download() as download:
        page.get_by_role("link", name="RTZ", exact=True).click()
    text = Path(download.value.path()).read_text("utf-8")
    assert "<waypoint" in text and 'version="1.2"' in text


def test_the_address_restores_the_result_after_a_reload(visit, planned):
    page = visit.open(f"#plan={planned}")
    page.wait_for_selector(".proof")
    page.wait_for_url(re.compile("route=1&t=[1-9]"))
    before = visit.figure("Time"), page.url
    page.reload()
    page.wait_for_selector(".proof")
    page.wait_for_url(before[1])
    assert visit.figure("Time") == before[0]


def test_a_place_that_is_not_understood_is_an_error_at_its_field(visit):
    page = visit.open()
    visit.fill_short(start="Rotterdamm")
    page.locator(".field.goal input").press("Tab")
    error = page.locator(".field.start .error")
    error.wait_for()
    assert "Rotterdam" in error.inner_text()
    page.get_by_role("button", name="Plan the voyage").click()
    assert page.locator(".field.start input").get_attribute("aria-invalid") == "true"
    visit.picture("error")


def test_what_is_missing_is_said_at_its_field(visit):
    page = visit.open()
    page.wait_for_selector("#ship option", state="attached")
    page.get_by_role("button", name="Plan the voyage").click()
    assert "no start" in page.locator(".field.start .error").inner_text()
    visit.fill_short()
    page.get_by_label("Storm of 1998").uncheck()
    page.get_by_role("button", name="Plan the voyage").click()
    assert "never assumed" in page.locator("[data-field=seas] .error").inner_text()


def test_a_refusal_stands_at_its_field_and_offers_a_remedy(visit):
    page = visit.open()
    visit.fill_short()
    page.locator("#depart").fill("2024-08-31 12:00")
    page.get_by_role("button", name="Plan the voyage").click()
    field = page.locator("[data-field=depart]")
    field.locator(".error").wait_for()
    assert "24 Aug 1998 06:00 UTC" in field.locator(".error").inner_text()
    field.get_by_role("button", name="Depart 24 Aug 1998 06:00").click()
    assert page.locator("#depart").input_value() == "1998-08-24 06:00"
    assert field.locator(".error").count() == 0


def test_a_voyage_beyond_the_end_of_the_data_offers_an_earlier_departure(visit):
    page = visit.open()
    visit.fill_short("47.0N 20.0W", "47.0N 12.0W")
    page.locator("#depart").fill("1998-09-07 20:00")
    page.locator("#objective").select_option("time")
    page.get_by_role("button", name="Plan the voyage").click()
    remedies = page.locator(".remedies")
    remedies.get_by_role("button", name="Depart 6 Sep 1998 20:00").wait_for()
    assert remedies.get_by_role("button").count() == 1  # limits and land are not the reason
    remedies.get_by_role("button").click()
    assert page.locator("#depart").input_value() == "1998-09-06 20:00"


def test_a_refused_job_fills_the_form_and_stands_at_its_field(visit):
    voyage = {**SHORT_REQUEST["voyage"], "arrive_by": "1998-08-31T12:30Z"}
    post, get = visit.service.http.post, visit.service.http.get
    request = {**SHORT_REQUEST, "title": "A refused voyage", "voyage": voyage}
    job = post("/api/v1/plans", json=request).raise_for_status().json()
    assert ended(get, job["id"])["problem"]["field"] == "arrive_by"
    page = visit.open(f"#plan={job['id']}")
    field = page.locator("[data-field=arrive_by]")
    field.locator(".error").wait_for()
    field.get_by_role("button", name=re.compile("Arrive by 31 Aug 13:")).click()
    assert page.locator("#arrive-by").input_value().startswith("1998-08-31 13:")
    assert field.locator(".error").count() == 0


def test_points_are_dragged_and_a_voyage_file_and_a_link_restore_them(visit, tmp_path):
    page = visit.open()
    visit.fill_short("47.0N 20.0W", "47.0N 30.0W")
    page.locator(".field.goal input").press("Tab")
    page.locator(".field.goal .understood", has_text="Position").wait_for()
    place = "([lon, lat]) => window.thalweg.chart.map.getPixelFromCoordinate([lon * 111319.49, "
    place += "Math.log(Math.tan(Math.PI / 4 + lat * Math.PI / 360)) * 6378137])"
    box = page.locator("#chart").bounding_box()
    x, y = page.evaluate(place, [-30.0, 47.0])
    page.mouse.move(box["x"] + x, box["y"] + y)
    page.mouse.down()
    page.mouse.move(box["x"] + x + 20, box["y"] + y + 60, steps=4)
    page.mouse.up()
    goal = page.locator(".field.goal input")
    playwright_api.expect(goal).not_to_have_value("47.0N 30.0W")
    moved = goal.input_value()
    page.get_by_role("button", name="Undo move").click()
    playwright_api.expect(goal).to_have_value("47.0N 30.0W")
    goal.fill(moved)
    assert re.match(r"4[0-6]\.\d+N 2[6-9]\.\d+W", moved)
    with page.expect_download() as download:
        page.get_by_role("button", name="Save voyage file").click()
    file = tmp_path / "mine.voyage.json"
    file.write_bytes(Path(download.value.path()).read_bytes())
    goal.fill("Brest")
    page.locator("#voyage-file").set_input_files(str(file))
    playwright_api.expect(goal).to_have_value(moved)
    page.get_by_role("button", name="Copy link").click()
    page.wait_for_url(re.compile("voyage="))
    page.reload()
    playwright_api.expect(page.locator(".field.goal input")).to_have_value(moved)


def test_a_forecast_without_network_is_an_error_in_words(visit):
    page = visit.open()
    visit.fill_short()
    page.locator(".field.goal input").press("Tab")
    page.locator(".field.goal .understood", has_text="Position").wait_for()
    page.get_by_text("Fetch a forecast").click()
    playwright_api.expect(page.locator("#f-from")).not_to_have_value("")  # set as the part opens
    page.locator("#f-from").fill(f"{datetime.now(UTC):%Y-%m-%d %H:00}")
    page.locator("#f-days").fill("x")
    page.get_by_role("button", name="Estimate the download").click()
    assert "number of days" in page.locator(".fetch .error").inner_text()
    page.locator("#f-days").fill("2")
    page.get_by_role("button", name="Estimate the download").click()
    page.locator(".fetch .error", has_text="cannot be reached").wait_for()
    assert "copy a forecast file" in page.locator(".fetch .error").inner_text()


def test_a_broken_upload_is_an_error_at_the_sea(visit, tmp_path):
    page = visit.open()
    page.wait_for_selector("#ship option", state="attached")
    broken = tmp_path / "waves.nc"
    broken.write_bytes(b"CDF\x01 but no more")
    page.locator("#sea-file").set_input_files(str(broken))
    error = page.locator("[data-field=seas] .error")
    error.wait_for()
    assert "waves.nc" in error.inner_text()


def tab_to(page, selector: str, most: int = 120) -> None:
    """Press Tab until an element has the focus."""
    for _ in range(most):
        page.keyboard.press("Tab")
        if page.evaluate("s => document.activeElement.matches(s)", selector):
            return
    raise AssertionError(f"{selector} is not reached by {most} Tabs")


def test_keyboard_only(visit):
    page = visit.open()
    visit.plan_coarsely(5.0)
    page.wait_for_selector("#ship option", state="attached")
    tab_to(page, ".field.start input")
    page.keyboard.type("halif")
    page.wait_for_selector(".field.start .options li")
    page.keyboard.press("ArrowDown")
    page.keyboard.press("Enter")
    assert page.locator(".field.start input").input_value() == "CAHAL"
    assert "Halifax, CA" in page.locator(".field.start .understood").inner_text()
    page.keyboard.press("ControlOrMeta+a")
    page.keyboard.type("47.0N 20.0W")
    tab_to(page, ".field.goal input")
    page.keyboard.type("47.6N 18.0W")
    tab_to(page, "[data-field=seas] input[value=storm]")
    page.keyboard.press("Space")
    tab_to(page, "#depart")
    page.keyboard.press("ControlOrMeta+a")
    page.keyboard.type("1998-08-31 12:00")
    page.keyboard.press("Enter")
    page.wait_for_selector(".proof")
    before = page.locator(".player output").inner_text()
    tab_to(page, "#time")
    page.keyboard.press(".")
    assert page.locator(".player output").inner_text() != before
    tab_to(page, "#tab-profile")
    page.keyboard.press("ArrowRight")
    assert page.locator("#tab-legs").get_attribute("aria-selected") == "true"
    page.keyboard.press("?")
    assert page.locator("dialog").is_visible()
    page.keyboard.press("Escape")
    page.keyboard.press("n")
    page.keyboard.press("n")
    assert page.locator("html").get_attribute("data-palette") == "night"
    visit.picture("night")
    page.keyboard.press("v")
    page.locator("#panel h1", has_text="Voyages").wait_for()
    page.locator("button.job").first.wait_for()
    tab_to(page, "button.job")
    page.keyboard.press("Enter")
    page.wait_for_selector(".proof")


def test_an_area_is_drawn_and_the_route_avoids_it(visit):
    page = visit.open()
    visit.plan_coarsely(5.0)
    visit.fill_short("47.0N 19.5W", "47.0N 17.5W")
    page.get_by_text("Areas to avoid").click()
    page.get_by_role("button", name="Draw no-go").click()
    place = "([lon, lat]) => { const m = window.thalweg.chart.map; return m.getPixelFromCoordinate"
    place += "([lon * 111319.49, Math.log(Math.tan(Math.PI/4 + lat*Math.PI/360)) * 6378137]); }"
    page.evaluate("window.thalweg.chart.fit([[-21, 45], [-16, 49]])")
    page.wait_for_timeout(300)
    chart = page.locator("#chart")
    corners = [(-18.8, 46.6), (-18.2, 46.6), (-18.2, 47.6), (-18.8, 47.6)]
    for corner in corners:
        x, y = page.evaluate(place, list(corner))
        chart.click(position={"x": x, "y": y}, delay=30)
        page.wait_for_timeout(350)
    x, y = page.evaluate(place, list(corners[0]))
    chart.click(position={"x": x, "y": y})
    page.wait_for_selector("#area-0")
    page.get_by_role("button", name="Draw penalty").click()
    page.get_by_role("button", name="Plan the voyage").click()
    page.locator("[data-field=areas] .error", has_text="still being drawn").wait_for()
    page.get_by_role("button", name="Leave it out").click()
    assert not page.locator("#hint").is_visible()
    page.get_by_label("Distance kept from area 1").fill("10")
    page.get_by_label("Distance kept from area 1").press("Tab")
    width = """async () => { const band = await import("/static/app/chart/area_margin.js");
      const [area] = window.thalweg.form.areas.list; return band.marginPixels(area, 1000); }"""
    expected = 18.52 / math.cos(math.radians(47.1))  # 1 km at the equator in a pixel
    assert page.evaluate(width) == pytest.approx(expected, rel=1e-3)
    visit.picture("area")
    visit.plan()
    base = f"/api/v1/plans/{job_of(page)}"
    profile = visit.service.http.get(f"{base}/profiles/1").json()
    inside = [
        lat
        for lat, lon in zip(profile["lat"], profile["lon"])
        if -18.75 < lon < -18.25 and 46.65 < lat < 47.55
    ]
    assert inside == []
    assert min(profile["lat"]) < 46.65 or max(profile["lat"]) > 47.55


def test_progress_cancel_and_a_point_of_the_front(visit):
    page = visit.open()
    visit.fill_short("47.0N 20.0W", "47.0N 12.0W")
    page.locator("#objective").select_option("front")
    page.get_by_role("button", name="Plan the voyage").click()
    page.get_by_text("Planning the fastest route first", exact=True).wait_for()
    page.get_by_text("First route: the fastest").wait_for()
    visit.until("document.querySelectorAll('.steps li').length", lambda count: count > 7)
    assert page.locator(".steps").bounding_box()["height"] <= 190  # what is found stays in sight
    visit.picture("progress")
    page.get_by_role("button", name="Stop, keep the best").click()
    page.wait_for_selector(".proof")
    assert "Stopped" in page.locator(".note").first.inner_text()


def test_choosing_a_route_of_a_front_changes_cards_and_profile(visit):
    page = visit.open()
    visit.plan_coarsely(5.0)
    visit.fill_short("47.0N 20.0W", "47.0N 19.0W")
    page.locator("#objective").select_option("front")
    visit.plan()
    assert page.locator(".routes button").count() >= 2
    assert re.search(r"No route is [\d.]+ % better in both time and", page.content())
    page.locator("#tab-front").click()
    shown = (
        "({ chart, drawer }) => [chart.routes.chosen.getSource().getFeatures()[0].get('number'),"
    )
    shown = f"({shown} drawer.result.profile.time.at(-1)])(window.thalweg)"
    number, arrival = page.evaluate(shown)
    first = visit.figure("Fuel"), page.locator(".player output").inner_text()
    page.locator(".front circle[aria-pressed=true]").focus()
    page.keyboard.press("ArrowRight")
    page.wait_for_url(re.compile("route=2"))
    visit.picture("front")
    assert visit.figure("Fuel") != first[0]
    later = page.evaluate(shown)
    assert later[0] == number + 1, "the route on the chart"
    assert later[1] > arrival, "the profile"
    points = page.locator(".front circle:not(.base)")
    chosen = page.locator(".front circle[aria-pressed=true]")
    number = page.locator(".front + .aside b")
    routes = points.count()
    for key, route in (("End", routes), ("ArrowLeft", max(1, routes - 1)), ("Home", 1)):
        page.keyboard.press(key)  # the focus stays in the diagram
        playwright_api.expect(chosen).to_be_focused()
        playwright_api.expect(number).to_have_text(f"Route {route} of {routes}")
    box, end = points.first.bounding_box(), points.last.bounding_box()
    page.mouse.move(box["x"] + 4, box["y"] + 4)
    page.mouse.down()
    page.mouse.move(end["x"] + 4, end["y"] + 4, steps=12)
    page.mouse.up()
    page.wait_for_url(re.compile(f"route={routes}"))
    playwright_api.expect(number).to_have_text(f"Route {routes} of {routes}")
    page.keyboard.press("Home")
    page.wait_for_url(re.compile("route=1(&|$)"))
    page.keyboard.press("ArrowRight")
    page.wait_for_url(re.compile("route=2"))
    page.locator(".routes button").first.focus()
    page.keyboard.press("Enter")
    page.wait_for_url(re.compile("route=1(&|$)"))
    playwright_api.expect(page.locator(".routes button").first).to_be_focused()
    assert (
        page.locator(".routes button[aria-pressed=true]")
        .inner_text()
        .startswith(visit.figure("Time"))
    )
    page.locator("#tab-profile").click()
    page.get_by_role("button", name="Play (space)").click()
    playwright_api.expect(page.locator(".player output")).not_to_have_text(first[1])
    page.get_by_role("button", name="Pause (space)").click()


def test_an_exported_route_is_scored_beside_its_plan(visit, planned, tmp_path):
    page = visit.open(f"#plan={planned}")
    page.wait_for_selector(".proof")
    with page.expect_download() as download:
        page.get_by_role("link", name="RTZ", exact=True).click()
    (tmp_path / "mine.rtz").write_bytes(Path(download.value.path()).read_bytes())
    page.get_by_role("button", name="Compare").last.click()
    page.wait_for_selector("#route-file", state="attached")
    page.locator(".jobrow input:checked").first.wait_for()
    page.locator("#route-file").set_input_files(str(tmp_path / "mine.rtz"))
    page.locator(".compare-table tbody tr").nth(1).wait_for()
    rows = page.locator(".compare-table tbody tr")
    assert rows.nth(1).inner_text().startswith("mine.rtz")
    visit.picture("compare")


def test_a_route_is_scored_with_the_clearance_of_the_one_beside_it(visit, tmp_path):
    line = tmp_path / "mine.csv"
    line.write_text("lat,lon,time\n47.0,-5.0,2026-01-01T00:00Z\n47.1,-5.2,\n")
    service = visit.service.http
    sent = service.post("/api/v1/routes", files={"file": ("a.csv", line.read_bytes())}).json()
    order = {"route": sent["id"], "ship": "handysize-bulker", "seas": ["calm"], "coast": "c"}
    first = service.post("/api/v1/evaluate", json={**order, "min_ukc_m": 1.5}).json()["id"]
    ended(service.get, first)
    page = visit.open("#view=compare")
    page.locator(f".jobrow input[value='{first}.1']").check()
    page.locator("#route-file").set_input_files(str(line))
    page.locator(".compare-table tbody tr").nth(1).wait_for()
    jobs = service.get("/api/v1/plans").json()["jobs"]
    assert jobs[0]["title"] == "mine.csv" and jobs[0]["request"]["min_ukc_m"] == 1.5


def test_a_reload_in_the_middle_of_a_job_and_a_killed_service(visit):
    page = visit.open()
    visit.fill_short("47.0N 22.0W", "47.0N 12.0W")
    page.locator("#objective").select_option("front")
    page.get_by_role("button", name="Plan the voyage").click()
    page.locator(".steps li.now").wait_for()
    job = job_of(page)
    page.reload()
    page.get_by_text("First route: the fastest").wait_for()
    visit.service.kill()
    page.get_by_text("The service does not answer").wait_for()
    visit.service.start()
    # the route of the first run is lost with it: there is nothing to keep until the next is found
    page.get_by_text("First route: the fastest").wait_for(state="hidden")
    page.get_by_role("button", name="Stop", exact=True).wait_for()
    page.get_by_text("First route: the fastest").wait_for()
    page.get_by_role("button", name="Stop, keep the best").click()
    page.wait_for_selector(".proof")
    assert ended(visit.service.http.get, job)["state"] == "cancelled"
    events = visit.service.http.get(f"/api/v1/plans/{job}/events").text
    assert "the service was stopped" in events


INK = """() => {
  const { canvas } = window.thalweg.chart.particles;
  return canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data
    .reduce((sum, value, i) => sum + (i % 4 === 3 ? value : 0), 0);
}"""


def test_wind_moves_as_particles_but_not_where_less_motion_is_wanted(visit, browser, service):
    page = visit.open("#demo")
    page.locator("#layers-button").click()
    page.get_by_label("Significant wave height").check()
    assert page.evaluate(INK) == 0
    page.get_by_label("moving particles").check()
    assert page.get_by_label("Wind at 10 m").is_checked()  # waves do not move as particles
    before = visit.until(INK, lambda ink: ink > 0)
    visit.until(INK, lambda ink: ink not in (0, before))
    visit.picture("particles")
    page.get_by_label("Significant wave height").check()
    visit.until(INK, lambda ink: ink == 0)
    page.reload()
    page.locator("#layers-button").click()
    assert page.get_by_label("moving particles").is_checked()
    still = Visit(browser, service, reduced_motion="reduce")
    try:
        page = still.open("#demo")
        page.locator("#layers-button").click()
        page.get_by_label("Wind at 10 m").check()
        assert page.get_by_label("less motion").is_disabled()
    finally:
        still.context.close()


def test_a_tablet_shows_form_and_result_without_sideways_scrolling(visit, planned):
    page = visit.open()
    for width, height in ((1024, 768), (768, 1024)):
        page.set_viewport_size({"width": width, "height": height})
        page.goto(f"{visit.service.address}/?width={width}#plan={planned}")
        page.wait_for_selector(".proof")
        assert page.get_by_text("Not for navigation", exact=True).is_visible()
        wide = "document.documentElement.scrollWidth - document.documentElement.clientWidth"
        assert page.evaluate(wide) == 0
        assert page.locator("#chart").bounding_box()["width"] >= 380
        visit.picture(f"tablet_{width}")


def test_the_brief_for_the_master_has_what_a_master_keeps(visit, planned):
    page = visit.open(f"#plan={planned}")
    page.wait_for_selector(".proof")
    page.locator("#tab-profile").wait_for()
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    page.emulate_media(media="print")
    visit.picture("brief")
    text = " ".join(part.inner_text() for part in page.locator(".brief-page").all())
    text = re.sub(r"\s+", " ", text)
    for words in (
        "Handysize bulker",
        "Draught 9.5 m",
        "Departure 31 Aug 1998 12:00 UTC",
        "Highest waves ",
        "Storm of 1998",
        "1 47°00.0′N 020°00.0′W 31 Aug 12:00",
        "Not for navigation",
    ):
        assert words in text, words
    assert not page.locator("#panel").is_visible() and page.locator("#chart").is_visible()
    page.emulate_media(media="screen")
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    assert page.locator(".brief-page").count() == 0 and page.locator("#panel").is_visible()


def test_calm_water_departs_today_and_the_storm_in_its_own_year(visit):
    page = visit.open()
    page.wait_for_selector("#ship option", state="attached")
    depart = page.locator("#depart")
    assert depart.input_value() == ""
    page.get_by_label("Storm of 1998").check()
    playwright_api.expect(depart).to_have_value("1998-08-24 06:00")
    page.get_by_label("Calm sea").check()
    assert abs(datetime.now(UTC).year - int(depart.input_value()[:4])) <= 1


@pytest.mark.parametrize("view", ["plan", "compare", "projects", "studies", "voyages"])
def test_nothing_that_axe_finds(visit, view):
    page = visit.open()
    visit.fill_short()
    page.locator(f'.tab[data-view="{view}"]').click()
    page.locator("#panel h1").wait_for()
    page.wait_for_load_state("networkidle")
    visit.check_accessibility()
