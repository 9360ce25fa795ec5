"""A browser on a service of its own; any request to outside the loopback fails the test."""

from __future__ import annotations

import gzip
import json
import os
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.service.conftest import TOKEN, ServerProcess, ended

playwright_api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
#: Screenshots of the tests are kept here where it is set.
PICTURES = os.environ.get("THALWEG_SCREENSHOTS")
#: The script axe.min.js of axe-core 4.14.1.
AXE = Path(__file__).parent / "axe" / "axe.min.js.gz"
#: Time in which something appears on a loaded machine [ms]; ``expect`` of playwright has 5 s.
LONG_MS = 240_000
playwright_api.expect.set_options(timeout=LONG_MS)
PALETTES = ("day", "dusk", "night")


def chromium_path() -> str | None:
    given = os.environ.get("THALWEG_CHROMIUM")
    return given or shutil.which("chromium") or shutil.which("chromium-browser")


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    path = chromium_path()
    if path is None:
        pytest.skip("there is no chromium (apt-get install chromium, or set THALWEG_CHROMIUM)")
    with playwright_api.sync_playwright() as playwright:
        found = playwright.chromium.launch(
            executable_path=path, args=["--no-sandbox", "--disable-gpu"]
        )
        yield found
        found.close()


@pytest.fixture(scope="session")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ServerProcess]:
    found = ServerProcess(tmp_path_factory.mktemp("browser")).start()
    yield found
    found.stop()


#: A voyage through the storm of the package, as the form sends it.
SHORT_REQUEST = {
    "title": "A short voyage",
    "voyage": {"start": "47.0N 20.0W", "goal": "47.2N 19.5W", "depart": "1998-08-31T12:00Z"},
    "ship": "handysize-bulker",
    "seas": ["storm"],
    "resolution_nm": 2.0,
    "proof_s": 0.0,
}


@pytest.fixture(scope="session")
def planned(service: ServerProcess) -> str:
    """The id of a plan that is done, for tests that only look at a result."""
    job = service.http.post("/api/v1/plans", json=SHORT_REQUEST).raise_for_status().json()
    assert ended(service.http.get, job["id"])["state"] == "done"
    return str(job["id"])


class Visit:
    """A page of the application, with what it asked for and what went wrong in it."""

    def __init__(self, browser: Any, service: ServerProcess, **options: Any) -> None:
        self.service = service
        self.context = browser.new_context(
            viewport={"width": 1280, "height": 720}, accept_downloads=True, **options
        )
        self.page = self.context.new_page()
        self.page.set_default_timeout(LONG_MS)
        self.outside: list[str] = []
        self.errors: list[str] = []
        self.page.on("request", self._note)
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))

    def _note(self, request: Any) -> None:
        if not request.url.startswith((self.service.address, "data:", "blob:")):
            self.outside.append(request.url)

    def open(self, fragment: str = "") -> Any:
        """Open the page and wait for its form or result."""
        self.page.goto(f"{self.service.address}/?token={TOKEN}{fragment}")
        self.page.wait_for_selector("#panel h1")
        return self.page

    def fill_short(self, start: str = "47.0N 20.0W", goal: str = "47.2N 19.5W") -> None:
        """Fill in a short voyage through the storm of the package."""
        page = self.page
        page.wait_for_selector("#ship option", state="attached")
        page.locator(".field.start input").fill(start)
        page.locator(".field.goal input").fill(goal)
        page.get_by_label("Storm of 1998").check()
        page.locator("#depart").fill("1998-08-31T12:00")

    def plan_coarsely(self, spacing_nm: float) -> None:
        """Let the form plan on networks of a spacing [nm] alone, with a brief proof."""

        def coarser(route: Any) -> None:
            if route.request.method != "POST":
                return route.continue_()
            request = json.loads(route.request.post_data)
            request |= {"resolution_nm": spacing_nm, "proof_s": 0.2}
            request["voyage"]["method"] = "exact"
            return route.continue_(post_data=json.dumps(request))

        self.page.route("**/api/v1/plans", coarser)

    def plan(self) -> None:
        """Press the button and wait for the result."""
        self.page.get_by_role("button", name="Plan the voyage").click()
        self.page.wait_for_selector(".proof")

    def until(self, script: str, accepted: Any) -> Any:
        """Return the value of a script as soon as a function accepts it.

        ``wait_for_function`` cannot be used: the page allows no evaluation of texts.
        """
        for _ in range(LONG_MS // 100):
            value = self.page.evaluate(script)
            if accepted(value):
                return value
            self.page.wait_for_timeout(100)
        raise AssertionError(f"{script} is still {value}")

    def figure(self, name: str) -> str:
        """Return a figure of the cards."""
        card = self.page.locator(".card", has=self.page.get_by_text(name, exact=True))
        return str(card.locator("dd").inner_text()).split("\n")[0]

    def check_accessibility(self) -> None:
        """Assert that axe-core finds nothing in any palette."""
        self.page.evaluate(gzip.decompress(AXE.read_bytes()).decode())
        found = {}
        for palette in PALETTES:
            self.page.evaluate("p => { document.documentElement.dataset.palette = p }", palette)
            answer = self.page.evaluate("axe.run(document, {resultTypes: ['violations']})")
            found[palette] = {
                one["id"]: [node["html"] for node in one["nodes"]] for one in answer["violations"]
            }
        self.page.evaluate("p => { document.documentElement.dataset.palette = p }", PALETTES[0])
        assert found == {palette: {} for palette in PALETTES}, "violations that axe-core finds"

    def picture(self, name: str) -> None:
        """Keep a screenshot where the environment asks for it."""
        if PICTURES:
            Path(PICTURES).mkdir(parents=True, exist_ok=True)
            self.page.screenshot(path=str(Path(PICTURES) / f"{name}.png"))


@pytest.fixture
def visit(browser: Any, service: ServerProcess) -> Iterator[Visit]:
    found = Visit(browser, service)
    yield found
    found.context.close()
    assert found.outside == [], "requests to outside the loopback"
    assert found.errors == [], "errors of scripts"
