"""The page in a browser: objectives, key figures, networks, and answers that come late."""

from __future__ import annotations

import json
from pathlib import Path
from time import monotonic
from typing import Any

import pytest

import thalweg.ship
from tests.browser.conftest import LONG_MS, SHORT_REQUEST, playwright_api
from tests.service.conftest import TOKEN, ended

pytestmark = pytest.mark.slow
TRAFFIC = {
    "type": "FeatureCollection",
    "elsewhere": {"encounters_per_h": 0.25},
    "features": [],
}
SHIP = Path(thalweg.ship.__file__).parent / "library" / "gunnerus.yaml"
#: What a script of the page does between an answer and the end of drawing it.
DRAWN = "() => new Promise((done) => requestAnimationFrame(() => setTimeout(done, 0)))"
#: The second element is clicked as soon as the first is in the panel.
AT_ONCE = """([shown, clicked]) => new MutationObserver((_, watch) => {
  if (!document.querySelector(shown)) return;
  watch.disconnect();
  document.querySelector(clicked).click();
}).observe(document.getElementById("panel"), { childList: true, subtree: true })"""


@pytest.fixture(scope="module")
def differing(service) -> str:
    """The id of routes that differ, with traffic."""
    file = {"file": ("ships.geojson", json.dumps(TRAFFIC).encode())}
    traffic = service.http.post("/api/v1/traffic", files=file).raise_for_status().json()["id"]
    request = {**SHORT_REQUEST, "title": "Ways", "most": 2, "traffic": [traffic], "coast": "c"}
    job = service.http.post("/api/v1/alternatives", json=request).raise_for_status().json()
    assert ended(service.http.get, job["id"])["state"] == "done"
    return str(job["id"])


class Held:
    """Requests of the page that are held until the test lets them go."""

    def __init__(self, page: Any, pattern: str) -> None:
        self.page, self.pattern = page, pattern
        self.routes: list[Any] = []
        self.held = True
        page.route(pattern, self._hold)

    def _hold(self, route: Any) -> None:
        if self.held:
            self.routes.append(route)
        else:
            route.continue_()

    def wait(self) -> None:
        until = monotonic() + LONG_MS / 1000.0
        while not self.routes:
            assert monotonic() < until, f"no request of {self.pattern}"
            self.page.wait_for_timeout(20)

    def release(self) -> None:
        """Let the requests through, and wait until the page has drawn what it makes of them."""
        self.held = False
        for route in self.routes:
            with self.page.expect_response(route.request.url):
                route.continue_()
        for _ in range(3):
            self.page.evaluate(DRAWN)


def test_weights_limits_and_networks_are_sent_and_restored(visit, tmp_path):
    page = visit.open()
    visit.fill_short()
    page.locator("#objective").select_option("weighted")
    page.locator("#w-fuel").fill("1")
    page.locator("#w-comfort").fill("0,5")
    for part in ("indicators", "traffic", "network"):
        page.locator(f"details[data-part={part}] > summary").click()
    page.get_by_role("button", name="+ Limit").click()
    page.get_by_label("Figure to limit").select_option("land_distance_nm")
    assert page.get_by_label("At most or at least").input_value() == "least"
    page.get_by_label("Value of the limit").fill("0.5")
    page.locator("#network").select_option("layered")
    page.locator("#net-near_coast_nm").fill("3")
    page.locator("#net-contain").fill("64.862, 11.253")
    page.locator("#net-resolution_nm").fill("2.5")
    (tmp_path / "ships.geojson").write_text(json.dumps(TRAFFIC))
    page.get_by_label("Traffic file").set_input_files(str(tmp_path / "ships.geojson"))
    page.get_by_label("ships.geojson").wait_for()
    assert page.get_by_label("ships.geojson").is_checked()
    request = page.evaluate("window.thalweg.form.request()")
    assert request["voyage"]["weights"] == {"fuel": 1, "comfort": 0.5}
    assert request["voyage"]["at_least"] == {"land_distance_nm": 0.5}
    assert request["voyage"]["layered"] == {"near_coast_nm": 3, "contain": [[64.862, 11.253]]}
    assert request["resolution_nm"] == 2.5 and len(request["traffic"]) == 1
    visit.picture("form_network")
    restored = "(r) => { window.thalweg.form.set(r); return window.thalweg.form.request(); }"
    assert page.evaluate(restored, request) == request
    page.locator("#w-fuel").fill("much")
    page.get_by_role("button", name="Plan the voyage").click()
    assert "weight of fuel" in page.locator(".weights .error").inner_text()


def test_a_limit_that_cannot_be_kept_is_an_error_in_words(visit):
    page = visit.open()
    visit.fill_short()
    page.locator("details[data-part=indicators] > summary").click()
    page.get_by_role("button", name="+ Limit").click()
    page.get_by_label("Value of the limit").fill("few")
    page.get_by_role("button", name="Plan the voyage").click()
    assert "not a number" in page.locator("[data-field=indicators] .error").inner_text()


def test_routes_that_differ_have_names_and_a_table_of_key_figures(visit, differing):
    page = visit.open(f"#plan={differing}")
    page.locator(".routes.named button").first.wait_for()
    assert "fastest" in page.locator(".routes.named button").first.inner_text()
    rows = page.locator("table.indicators tbody tr")
    names = rows.locator("th").all_inner_texts()
    assert any(name.startswith("Encounters") for name in names)
    assert any(name.startswith("Least distance from land") for name in names)
    assert "unknown" not in page.locator("table.indicators").inner_text()
    visit.picture("alternatives")
    page.get_by_role("button", name="Change the voyage").click()
    assert page.locator("#objective").input_value() == "alternatives"
    visit.check_accessibility()


def test_a_job_that_answers_late_is_not_shown_over_another_view(visit, planned):
    page = visit.open("#view=voyages")
    held = Held(page, f"**/api/v1/plans/{planned}")
    page.locator(".jobrow button.job", has_text="A short voyage").first.click()
    held.wait()
    page.locator('.tab[data-view="studies"]').click()
    page.get_by_role("heading", name="Study", exact=True).wait_for()
    held.release()
    assert page.locator("#panel h1").inner_text() == "Study"
    assert page.locator(".tab[aria-current]").get_attribute("data-view") == "studies"


def test_back_and_forward_go_through_the_views(visit, planned):
    page = visit.open()
    visit.fill_short()
    page.locator('.tab[data-view="voyages"]').click()
    page.evaluate(AT_ONCE, [".proof", '.tab[data-view="compare"]'])
    page.locator(".jobrow button.job", has_text="A short voyage").first.click()
    title = page.locator("#panel h1")
    playwright_api.expect(title).to_have_text("Compare routes")
    page.evaluate("history.back()")
    page.wait_for_selector(".proof")
    playwright_api.expect(page.locator('.tab[data-view="plan"]')).to_have_attribute(
        "aria-current", "page"
    )
    page.evaluate("history.back()")
    playwright_api.expect(title).to_have_text("Voyages")
    page.evaluate("history.back()")
    playwright_api.expect(title).to_have_text("Plan a voyage")
    assert page.locator(".field.start input").input_value() == "47.0N 20.0W"
    page.evaluate("history.forward()")
    playwright_api.expect(title).to_have_text("Voyages")


def test_a_list_that_arrives_during_back_does_not_take_its_place(visit, planned):
    page = visit.open(f"#plan={planned}")
    page.locator("#tab-profile").wait_for()
    page.evaluate("""() => {
      const ask = window.fetch;
      const late = new Promise((done) => addEventListener("popstate", done, { once: true }));
      window.fetch = (url, ...rest) => String(url).includes("/plans?size=60")
        ? late.then(() => ({ ok: true, json: async () => ({ jobs: [] }) })) : ask(url, ...rest);
    }""")
    page.locator('.tab[data-view="compare"]').click()
    page.evaluate("history.back()")
    page.wait_for_selector(".proof")
    assert f"plan={planned}" in page.url


def test_what_is_typed_before_the_lists_arrive_stays(visit):
    page = visit.page
    held = Held(page, "**/api/v1/ships")
    page.goto(f"{visit.service.address}/?token={TOKEN}#demo")
    page.wait_for_selector("#panel h1")
    page.locator(".field.start input").fill("51.0N 2.0E")
    held.wait()
    held.release()
    page.wait_for_selector("#ship option", state="attached")
    assert page.locator(".field.start input").input_value() == "51.0N 2.0E"


def test_a_plan_waits_for_the_ship_file_that_is_read(visit, tmp_path):
    page = visit.open()
    visit.fill_short()
    page.locator("#ship-facts", has_text="kn").wait_for()
    (tmp_path / "own.yaml").write_bytes(SHIP.read_bytes())
    page.route("**/api/v1/plans", lambda route: route.abort())
    held = Held(page, "**/api/v1/ships")
    page.locator("#ship-file").set_input_files(str(tmp_path / "own.yaml"))
    held.wait()
    with page.expect_request("**/api/v1/plans") as sent:
        page.locator("button.primary[type=submit]").click()
        held.release()
    assert sent.value.post_data_json["ship"] not in ("", "handysize-bulker")


def test_a_second_click_sends_no_second_voyage(visit):
    page = visit.open()
    visit.fill_short()
    held = Held(page, "**/api/v1/plans")
    button = page.locator("button.primary[type=submit]")
    button.click()
    held.wait()
    button.click()
    page.evaluate(DRAWN)
    assert len(held.routes) == 1
    held.routes[0].abort()
    playwright_api.expect(page.locator("#panel .error")).to_contain_text("does not answer")
    assert button.inner_text() == "Plan the voyage"
