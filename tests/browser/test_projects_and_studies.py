"""Dredging projects and studies in a real browser: run, watched, read."""

from __future__ import annotations

import re

import pytest

from tests.browser.conftest import playwright_api

pytestmark = pytest.mark.slow


def test_a_project_is_simulated_and_read(visit):
    page = visit.open("#view=projects")
    page.get_by_role("button", name="Fill in the example").click()
    playwright_api.expect(page.locator("#p-volume_m3")).to_have_value("425500")
    visit.picture("project_form")
    page.locator("#p-volume_m3").fill("9000")
    page.get_by_text("Depth and network").click()
    page.locator("#p-spacing_m").fill("900")
    page.locator("#p-load_factors").fill("3")
    page.get_by_role("button", name="Simulate the project").click()
    page.wait_for_url(re.compile("plan="))
    page.locator(".steps li").first.wait_for()
    page.get_by_text("All figures").wait_for()
    table = page.locator(".table.narrow tbody tr")
    assert table.first.inner_text().startswith("Production")
    page.get_by_role("tab", name="Place and time").click()
    assert page.locator(".drawing path.curve").count() >= 1
    visit.picture("project_space_time")
    visit.check_accessibility()
    page.get_by_role("tab", name="Cycles").click()
    page.locator("#batch-sheet tbody tr").nth(1).click()
    assert page.locator("#batch-sheet tr[aria-current=true]").count() == 1
    lists: list[str] = []
    page.on(
        "request",
        lambda request: lists.append(request.url) if "/plans?kind=" in request.url else None,
    )
    page.reload()
    page.get_by_text("All figures").wait_for()
    page.wait_for_load_state("networkidle")
    assert lists == [], "the form, with its list of projects, must not replace the result"
    assert page.get_by_text("All figures").is_visible()
    assert "plan=" in page.url


def test_a_project_that_is_wrong_says_so_at_its_field(visit):
    asked: list[str] = []
    visit.page.on("request", lambda request: asked.append(request.url))
    page = visit.open("#view=projects")
    page.get_by_role("button", name="Fill in the example").click()
    playwright_api.expect(page.locator("#p-volume_m3")).to_have_value("425500")
    assert sum("/projects/example" in url for url in asked) == 1, (
        "a second answer would replace what the user writes meanwhile"
    )
    page.locator("#p-volume_m3").fill("-5")
    page.get_by_role("button", name="Simulate the project").click()
    assert "volume_m3" in page.locator("form [role=alert]").inner_text()


def test_ready_studies_start_with_one_click(visit):
    page = visit.open("#view=studies")
    page.get_by_text("Ready studies").click()
    study = page.get_by_role("button", name=re.compile("What a finer network is worth"))
    study.click()
    page.wait_for_url(re.compile("plan="))
    page.get_by_text("Leave it running").wait_for()
    page.get_by_role("button", name="Stop, keep these").click()
    playwright_api.expect(page.get_by_text("Leave it running")).to_have_count(0)


def test_a_study_fills_a_heat_map(visit):
    page = visit.open()
    visit.fill_short()
    page.locator(".field.goal input").press("Tab")
    page.locator(".field.goal .understood", has_text="Position").wait_for()
    page.get_by_role("button", name="Studies").click()
    page.locator("#s-from").fill("1998-08-29 00:00")
    page.locator("#s-to").fill("1998-08-30 00:00")
    page.locator("#s-step").fill("24")
    page.locator("#s-speeds").fill("10, 12")
    page.get_by_text(re.compile("^4 voyages: about ")).wait_for()
    visit.picture("study_form")
    page.get_by_role("button", name="Plan the study").click()
    page.locator(".heat td button").first.wait_for()
    page.get_by_role("link", name="Voyages as CSV").wait_for()
    cells = page.locator(".heat td button")
    assert cells.count() == 4
    first, second = (page.locator(".heat tbody tr").nth(i).locator("button") for i in (0, 1))
    hours = [float(row.first.inner_text()) for row in (first, second)]
    assert hours[0] == pytest.approx(1.2 * hours[1], rel=0.05)
    cells.first.click()
    visit.check_accessibility()
    page.get_by_title("Fill in this voyage to plan it").click()
    assert page.locator("#depart").input_value() == "1998-08-29 00:00"
    assert page.locator("#n-speed_kn").input_value() == "10"
    visit.picture("study_result")


def test_a_rate_per_hour_is_shown_per_second(visit):
    def answer(route):
        found = route.fetch().json()
        project = found.get("project", found)
        project["unloading"] = {"rate_m3_h": 7650, "power_kw": 2000}
        route.fulfill(json=found)

    visit.page.route("**/projects/example", answer)
    page = visit.open("#view=projects")
    page.get_by_role("button", name="Fill in the example").click()
    playwright_api.expect(page.locator("#p-unloading")).to_have_value("2.125")
