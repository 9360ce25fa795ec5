// Keys of the application, the list of them, and the palettes.

import { announce, fill, h } from "./common/elements.js";

const PALETTES = ["day", "dusk", "night"];
const KEYS = [
  ["Space", "play and pause"], [", .", "three hours back and on"], ["[ ]", "the route before, the next route"],
  ["Arrow keys", "on the front: along it; on the chart: move it"], ["+ −", "on the chart: closer and farther"],
  ["c", "compare this route"], ["l", "layers"], ["n", "day, dusk, night"], ["p, v", "plan, voyages"], ["d, s", "dredging projects, studies"], ["?", "this list"],
];
const TYPED = "input:not([type=range]):not([type=checkbox]):not([type=radio]), select, textarea, dialog";

export function nextPalette() {
  const root = document.documentElement;
  const next = PALETTES[(PALETTES.indexOf(root.dataset.palette) + 1) % PALETTES.length];
  root.dataset.palette = next;
  localStorage.setItem("palette", next);
  document.getElementById("palette").setAttribute("aria-label", `Palette: ${next}. Change to ${PALETTES[(PALETTES.indexOf(next) + 1) % PALETTES.length]}`);
  dispatchEvent(new Event("palette"));
  announce(`Palette: ${next}`);
}

export function showKeys() {
  const dialog = document.getElementById("keys");
  fill(dialog, h("h2", { id: "keys-title" }, "Keys"), h("dl", {}, KEYS.map(([key, text]) => [h("dt", {}, h("kbd", {}, key)), h("dd", {}, text)])),
    h("p.lead", {}, "Programs can use the same interface: see /openapi.json. Thalweg is not a navigation system; check every route against official charts and notices."),
    h("p", {}, h("button.quiet", { type: "button", onclick: () => dialog.close(), autofocus: true }, "Close")));
  dialog.showModal();
}

/**
 * Listen to the keys.
 * @param {{[key: string]: (event: KeyboardEvent) => void|boolean}} acts what a key does; false where it does nothing here
 */
export function listenToKeys(acts) {
  document.addEventListener("keydown", (event) => {
    if (event.key === "Escape") acts.Escape(event);
    if (event.target.closest(TYPED) || event.ctrlKey || event.metaKey || event.altKey) return;
    const act = event.key === "Escape" ? null : acts[event.key];
    if (act && act(event) !== false) event.preventDefault();
  });
}
