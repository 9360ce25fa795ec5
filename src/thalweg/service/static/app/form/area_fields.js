// Areas to avoid: drawn on the chart or typed, with undo.

import { fill, h } from "../common/elements.js";

export class AreaFields {
  list = []; // [{kind, factor, ring: [[lon, lat], ...], properties}]
  kept = []; // features of a voyage file that cannot be changed here: several parts, or holes
  drawing = false; // whether the corners of one are being clicked
  #before = [];

  constructor(chart, changed) {
    Object.assign(this, { chart, changed });
    this.element = h("div", { "data-field": "areas" });
    this.#show();
  }

  get features() {
    const drawn = this.list.map(({ kind, factor, ring, properties }) => ({ type: "Feature", properties: { ...properties, kind, ...(factor === null ? {} : { factor }) }, geometry: { type: "Polygon", coordinates: [ring] } }));
    return { type: "FeatureCollection", features: [...drawn, ...this.kept] };
  }

  set(areas) {
    const simple = (one) => one.geometry?.type === "Polygon" && one.geometry.coordinates.length === 1 && one.properties?.kind;
    const all = areas?.features || (areas ? [areas] : []);
    this.list = all.filter(simple).map(({ properties, geometry }) => ({ kind: properties.kind, factor: properties.factor ?? null, ring: geometry.coordinates[0], properties }));
    this.kept = all.filter((one) => !simple(one));
    this.#before = [];
    this.#show();
  }

  // The areas are drawn on the chart; where they may be moved by hand, so say it.
  draw(movable) {
    if (!movable) this.chart.endDrawing(false);
    this.chart.showAreas(this.list, movable ? (i, ring) => this.#moved(i, ring) : null);
  }

  #moved(i, ring) {
    if (JSON.stringify(ring) !== JSON.stringify(this.list[i]?.ring)) this.#change(this.list.map((area, k) => (k === i ? { ...area, ring } : area)));
  }

  #change(list) {
    this.#before.push(this.list);
    this.#put(list);
  }

  #put(list) {
    this.list = list;
    this.#show();
    this.changed();
  }

  async #drawn(kind) {
    const hint = document.getElementById("hint"), begun = this.chart.draw();
    hint.textContent = "Click the corners; double click the last one. Escape stops.";
    hint.hidden = false;
    this.drawing = true;
    this.#show();
    const ring = await begun;
    hint.hidden = true;
    this.drawing = false;
    this.#show();
    if (ring) this.#change([...this.list, { kind, factor: kind === "penalty" ? 2 : null, ring }]);
  }

  #finish() {
    if (!this.chart.endDrawing(true)) fill(this.element.querySelector(":scope > .slot"), h("div.error", { role: "alert" }, h("b", {}, "An area has three corners or more."), h("span.remedy", {}, "Click them on the chart, or leave the area out.")));
  }

  #inView() {
    const [w, s, e, n] = this.chart.view;
    const at = (a, b, f) => Number((a + f * (b - a)).toFixed(2));
    const [x0, x1, y0, y1] = [at(w, e, 0.45), at(w, e, 0.55), at(s, n, 0.45), at(s, n, 0.55)];
    this.#change([...this.list, { kind: "no-go", factor: null, ring: [[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]] }]);
  }

  #typed(i, text, slot) {
    const rows = text.split("\n").filter((row) => row.trim()).map((row) => row.split(/[,;\s]+/).filter(Boolean).map(Number));
    const wrong = rows.find((row) => row.length !== 2 || !row.every(Number.isFinite) || Math.abs(row[0]) > 90 || Math.abs(row[1]) > 360);
    if (wrong || rows.length < 3) {
      fill(slot, h("div.error", { role: "alert" }, h("b", {}, wrong ? "A corner is not a position." : "An area has three corners or more."), h("span.remedy", {}, "Give latitude and longitude in degrees, one corner in each line, such as 47.5, -18.2.")));
      return;
    }
    const ring = rows.map(([lat, lon]) => [lon, lat]);
    this.#change(this.list.map((area, k) => (k === i ? { ...area, ring: [...ring, ring[0]] } : area)));
  }

  #typedFactor(i, text) {
    const factor = Number(text.replace(",", "."));
    if (factor >= 1) this.#change(this.list.map((area, k) => (k === i ? { ...area, factor } : area)));
    else this.#show();
  }

  #typedMargin(i, text) {
    const margin = Number(text.replace(",", "."));
    if (!(margin >= 0 && margin <= 100)) { this.#show(); return; }
    this.#change(this.list.map((area, k) => (k === i ? { ...area, properties: { ...area.properties, keep_clear_nm: margin || undefined } } : area)));
  }

  #row(area, i) {
    const slot = h("div.slot");
    const corners = area.ring.slice(0, -1).map(([lon, lat]) => `${lat}, ${lon}`).join("\n");
    return h("div.field", {},
      h("div.row", {}, h("b", {}, `${i + 1}. ${area.kind[0].toUpperCase()}${area.kind.slice(1)}`),
        area.kind !== "no-go" ? null : h("label.inline", {}, "clear by", h("input.short", { type: "text", inputmode: "decimal", value: String(area.properties?.keep_clear_nm ?? 0), "aria-label": `Distance kept from area ${i + 1}`, onchange: (event) => this.#typedMargin(i, event.target.value) }), "nm"),
        area.factor === null ? null : h("label.inline", {}, "each mile counts", h("input.short", { type: "text", inputmode: "decimal", value: String(area.factor), "aria-label": `Factor of area ${i + 1}`, onchange: (event) => this.#typedFactor(i, event.target.value) }), "×"),
        h("button.quiet.small", { type: "button", "aria-label": `Remove area ${i + 1}`, onclick: () => this.#change(this.list.filter((one) => one !== area)) }, "Remove")),
      h("label.hidden", { for: `area-${i}` }, `Corners of area ${i + 1}: latitude, longitude`),
      h("textarea", { id: `area-${i}`, rows: Math.min(6, area.ring.length - 1), onchange: (event) => this.#typed(i, event.target.value, slot) }, corners), slot);
  }

  #show() {
    this.element.classList.remove("wrong");
    const button = (text, act) => h("button.quiet.small", { type: "button", onclick: act }, text);
    fill(this.element,
      this.list.length || this.kept.length ? null : h("p.facts", {}, "Closed areas (no-go), and areas where each mile counts more (penalty). Drag a corner to move it. A route may touch the edge of a closed area, unless it keeps clear of it by a distance."),
      this.list.map((area, i) => this.#row(area, i)),
      this.kept.length ? h("p.facts", {}, `${this.kept.length} more of the voyage file, in several parts or with holes. `, h("button.link", { type: "button", onclick: () => { this.kept = []; this.#put(this.list); } }, "Remove them")) : null,
      this.drawing ? h("div.field", {}, h("p.facts", { role: "status" }, "An area is being drawn: click its corners."), h("div.row.tools", {}, button("Finish the area", () => this.#finish()), button("Leave it out", () => this.chart.endDrawing(false)))) : h("div.field", {}, h("div.row.tools", {}, button("Draw no-go", () => this.#drawn("no-go")), button("Draw penalty", () => this.#drawn("penalty")), this.#before.length ? button("Undo", () => this.#put(this.#before.pop())) : null),
        h("button.link", { type: "button", onclick: () => this.#inView() }, "Add an area in the middle of the chart, to type its corners")),
      h("div.slot"));
    this.chart.showAreas(this.list, (i, ring) => this.#moved(i, ring));
  }
}
