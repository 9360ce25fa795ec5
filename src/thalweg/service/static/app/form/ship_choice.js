// The ship of a voyage: from the list or a file, with its performance sheet.

import { get, uploadForm } from "../common/api.js";
import { announce, fill, h } from "../common/elements.js";
import { known, number } from "../common/format.js";

const KNOT = 1852 / 3600;

export class ShipChoice {
  list = [];
  reading = null; // resolves when the file that was chosen last is read: whether it is a ship
  speedRange = null; // [kn, kn] of the chosen ship

  /** @param {(problem: object|null) => void} problemAt shows a problem at the field; null removes it */
  constructor(problemAt) {
    this.problemAt = problemAt;
    this.select = h("select", { id: "ship", onchange: () => this.#showSheet() });
    this.facts = h("p.facts", { id: "ship-facts" });
    this.sheet = h("details.sheet-of-ship", { hidden: true });
    this.file = h("input.hidden", { type: "file", id: "ship-file", "aria-label": "Ship file", accept: ".yaml,.yml,.json", tabindex: "-1", onchange: () => { this.reading = this.#upload(); } });
    this.element = h("div.field", { "data-field": "ship" }, h("div.label-row", {}, h("label.label", { for: "ship" }, "Ship"), h("button.link", { type: "button", onclick: () => this.file.click() }, "Ship file …")), this.select, this.file, this.facts, this.sheet, h("div.slot"));
  }

  get value() {
    return this.select.value;
  }

  show(list, chosen = this.value || "handysize-bulker") {
    this.list = list;
    fill(this.select, list.map((ship) => h("option", { value: ship.id }, ship.name)));
    this.select.value = chosen;
    if (!this.select.value) this.select.selectedIndex = 0;
    this.#showSheet();
  }

  async #showSheet() {
    const id = this.value;
    if (id === this.shown) return;
    this.shown = id;
    this.facts.textContent = " ";
    this.sheet.hidden = true;
    this.speedRange = null;
    try {
      const sheet = await get(`/ships/${encodeURIComponent(id)}`);
      if (id === this.value) this.#fillSheet(sheet);
    } catch (problem) {
      if (id === this.value) this.facts.textContent = problem.asked || "";
    }
  }

  #fillSheet(sheet) {
    const rows = sheet.settings?.length ? sheet.settings : sheet.conditions || [];
    const speeds = rows.map((row) => row.speed_kn).filter(known);
    this.speedRange = speeds.length ? [Math.min(...speeds), Math.max(...speeds)] : null;
    const { wave_height_m: waves, wind_speed_m_s: wind } = sheet.limits || {};
    const facts = [
      this.speedRange ? `${[...new Set(this.speedRange.map((speed) => number(speed, 1)))].join(" to ")} kn` : "",
      known(sheet.draught_m) ? `draught ${number(sheet.draught_m, 1)} m` : "",
      known(waves) ? `waves up to ${number(waves, 1)} m` : "", known(wind) ? `wind up to ${number(wind / KNOT)} kn` : "",
    ].filter(Boolean);
    this.facts.textContent = facts.join(" · ") || sheet.name;
    const columns = [["Speed", "kn", (row) => row.speed_kn, 1], ["Power", "kW", (row) => row.brake_power_kw, 0], ["Fuel", "t/d", (row) => (known(row.fuel_kg_per_h) ? row.fuel_kg_per_h * 0.024 : null), 1], ["Fuel", "kg/nm", (row) => (known(row.fuel_kg_per_h) && row.speed_kn > 0 ? row.fuel_kg_per_h / row.speed_kn : null), 0]]
      .filter(([, , value]) => rows.some((row) => known(value(row))));
    const table = h("div.table.narrow", { tabindex: 0, role: "region", "aria-label": "Speed and consumption in calm water" }, h("table", {}, h("caption.hidden", {}, `${sheet.name}: speed and consumption in calm water`),
      h("thead", {}, h("tr", {}, columns.map(([name, unit]) => h("th", { scope: "col" }, name, h("span.unit", {}, ` ${unit}`))))),
      h("tbody", {}, rows.map((row) => h("tr", {}, columns.map(([, , value, decimals]) => h("td", {}, number(value(row), decimals))))))));
    const more = [...(sheet.warnings || []), ...(sheet.assumed || []), ...(sheet.missing || []).map((text) => `Not known: ${text}`), ...(sheet.sources || [])];
    fill(this.sheet, h("summary", {}, "Performance sheet"), h("div.inside", {}, h("p", {}, h("b", {}, sheet.name)), sheet.description ? h("p.facts", {}, sheet.description) : null,
      rows.length ? [h("p.facts", {}, "In calm water:"), table] : null, more.length ? h("ul.list", {}, more.map((text) => h("li", {}, typeof text === "string" ? text : JSON.stringify(text)))) : null));
    this.sheet.hidden = false;
  }

  async #upload() {
    const [file] = this.file.files;
    this.file.value = "";
    if (!file) return true;
    this.problemAt(null);
    const before = this.value;
    try {
      const ship = await uploadForm("/ships", file);
      const list = await get("/ships");
      const chosen = this.value === before; // another choice that was made meanwhile stays
      this.show(list, chosen ? ship.id : this.value);
      announce(chosen ? `Ship ${ship.name} is chosen.` : `Ship ${ship.name} is in the list.`);
      return true;
    } catch (problem) {
      this.problemAt(problem);
      return false;
    }
  }
}
