"""Figures of the page: paint, idle, frames while panning, first event, first route, stop.

Run with ``python -m tests.campaigns.page_figures``; chromium renders in software. All times are
wall times: take them on a quiet machine.
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from playwright.sync_api import sync_playwright

from tests.browser.conftest import LONG_MS, chromium_path
from tests.service.conftest import ENDED, TOKEN, ServerProcess

WARM_S = 20.0  # for the child that waits to load its libraries
PAINT = "performance.getEntriesByName('first-contentful-paint')[0].startTime"
FRAMES = """async (milliseconds) => {
  const { map } = window.thalweg.chart, view = map.getView();
  const centre = view.getCenter(), resolution = view.getResolution(), start = performance.now();
  let frames = 0, passed = 0;
  map.on("postrender", () => { frames += 1; });
  view.beginInteraction();
  while (passed < milliseconds) {
    const [x, y] = [300 * Math.sin(passed / 500), 120 * Math.cos(passed / 700)];
    view.setCenter([centre[0] + x * resolution, centre[1] + y * resolution]);
    await new Promise((done) => requestAnimationFrame(done));
    passed = performance.now() - start;
  }
  view.endInteraction(0);
  return (1000 * frames) / passed;
}"""
REQUEST = {
    "title": "North Atlantic",
    "voyage": {"start": "Halifax", "goal": "49.7N 6.5W", "depart": "1998-08-31T12:00Z"},
    "ship": "handysize-bulker",
    "seas": ["storm"],
}


def figures_of_the_page(server: ServerProcess, page: Any) -> dict[str, float]:
    """Return the figures of drawing, with the wind of the storm shown."""
    began = time.monotonic()
    page.goto(f"{server.address}/?token={TOKEN}#demo")
    page.wait_for_selector("#chart[data-idle]")
    idle = time.monotonic() - began
    paint = page.evaluate(PAINT) / 1000.0
    page.locator("#layers-button").click()
    page.get_by_label("Wind at 10 m").check()
    page.wait_for_timeout(2000)
    barbs = page.evaluate(FRAMES, 3000)
    page.get_by_label("moving particles").check()
    page.wait_for_timeout(2000)
    return {
        "first paint [s]": paint,
        "map idle [s]": idle,
        "pan [frames/s]": barbs,
        "pan with particles [frames/s]": page.evaluate(FRAMES, 3000),
    }


def figures_of_a_job(server: ServerProcess, page: Any) -> dict[str, float]:
    """Return the times of an ocean voyage, from pressing the button."""
    time.sleep(WARM_S)
    began = time.monotonic()
    page.get_by_role("button", name="Plan the voyage").click()
    page.locator(".steps li").first.wait_for()
    stage = time.monotonic() - began
    page.get_by_text("Best route so far").wait_for()
    route = time.monotonic() - began
    job = server.http.get("/api/v1/plans").json()["jobs"][0]["id"]
    time.sleep(3.0)
    asked = time.monotonic()
    server.http.delete(f"/api/v1/plans/{job}")
    while server.http.get(f"/api/v1/plans/{job}").json()["state"] not in ENDED:
        time.sleep(0.05)
    stopped = time.monotonic() - asked
    time.sleep(WARM_S)
    return {
        "first stage on the screen [s]": stage,
        "first route of the crossing on the screen [s]": route,
        "stopped with the best so far [s]": stopped,
        "POST to first event [s]": first_event(server),
    }


def first_event(server: ServerProcess) -> float:
    """Return the time from a request to the first event of its job [s]."""
    began = time.monotonic()
    job = server.http.post("/api/v1/plans", json=REQUEST).json()["id"]
    with server.http.stream("GET", f"/api/v1/plans/{job}/events") as answer:
        next(answer.iter_lines())
    passed = time.monotonic() - began
    server.http.delete(f"/api/v1/plans/{job}")
    return passed


def main() -> int:
    """Measure and print; return 1 for a request to outside."""
    outside: list[str] = []
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        server = ServerProcess(Path(folder) / "data").start()
        try:
            browser = playwright.chromium.launch(
                executable_path=chromium_path(), args=["--no-sandbox"]
            )
            page = browser.new_page(viewport={"width": 1280, "height": 720})
            page.set_default_timeout(LONG_MS)
            page.on(
                "request",
                lambda one: None if one.url.startswith(server.address) else outside.append(one.url),
            )
            found = figures_of_the_page(server, page) | figures_of_a_job(server, page)
            browser.close()
        finally:
            server.stop()
    for name, value in found.items():
        print(f"{name}: {value:.2f}")
    print(f"requests to outside: {outside}")
    return int(bool(outside))


if __name__ == "__main__":
    sys.exit(main())
