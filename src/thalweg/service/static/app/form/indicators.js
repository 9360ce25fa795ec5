// Key performance indicators: names, units, values of a route, and the table of routes.

import { fill, h } from "../common/elements.js";
import { duration, known, number } from "../common/format.js";

// name of the API: label, unit, decimals, whether a limit is usually the greatest value
const INDICATORS = {
  time: ["Time", "h", 1, true], distance: ["Distance", "nm", 1, true], fuel: ["Fuel", "t", 2, true], energy: ["Energy", "MWh", 1, true],
  co2: ["CO₂", "t", 1, true], cost: ["Cost", "", 0, true],
  sick_percent: ["People sick at the end", "%", 0, true], worst_hour_percent: ["People sick, worst hour", "%", 0, true],
  uncomfortable_percent: ["Time above 0.05 g", "%", 0, true], max_acceleration: ["Greatest acceleration", "m/s²", 2, true],
  workable_percent: ["Time in which people can work", "%", 0, false],
  inshore_nm: ["Length within 3 nm of land", "nm", 1, true], inshore_percent: ["Share within 3 nm of land", "%", 0, true], inshore_h: ["Time within 3 nm of land", "h", 1, true],
  land_distance_nm: ["Least distance from land", "nm", 1, false], contour_distance_nm: ["Least distance from shoals", "nm", 1, false],
  near_ground_h: ["Time within 1 nm of the ground", "h", 1, true], shallow_h: ["Time in shallow water", "h", 1, true], min_ukc: ["Least under-keel clearance", "m", 1, false],
  encounters: ["Encounters with other ships", "", 1, true], dense_traffic_h: ["Time in dense traffic", "h", 1, true],
};
const OF_PLACES = ["sick_percent", "worst_hour_percent", "uncomfortable_percent"];

function cost(route) {
  return route[`cost_${(route.currency || "usd").toLowerCase()}`];
}

// Rows of label, unit, decimals and the value of each route; those that no route knows are left out.
function rowsOf(routes) {
  const rows = [];
  const add = ([label, unit, decimals], values, words = "") => {
    if (values.some(known)) rows.push([words ? `${label}, ${words}` : label, unit, decimals, values]);
  };
  const totals = { time: (r) => r.time_h, distance: (r) => r.distance_nm, fuel: (r) => r.fuel_t, energy: (r) => r.energy_mwh, co2: (r) => r.co2_t, cost, min_ukc: (r) => r.min_ukc_m };
  const names = (kind) => [...new Set(routes.flatMap((route) => Object.keys(route.indicators?.[kind] || {})))];
  for (const [name, about] of Object.entries(INDICATORS)) {
    const shown = name === "cost" ? [about[0], routes[0].currency || "", about[2]] : about;
    if (totals[name]) add(shown, routes.map(totals[name]));
    else if (OF_PLACES.includes(name)) for (const place of names("places")) add(shown, routes.map((route) => route.indicators?.places?.[place]?.[name]), place);
    else if (name === "max_acceleration") for (const place of names("places")) add(shown, routes.map((route) => route.indicators?.places?.[place]?.max_acceleration_rms_m_s2), place);
    else if (name === "workable_percent") for (const task of names("tasks")) add(shown, routes.map((route) => route.indicators?.tasks?.[task]?.[name]), task);
    else add(shown, routes.map((route) => route.indicators?.[name]));
  }
  return rows;
}

// The table of several routes, or of one.
export function indicatorTable(routes, chosen, titles) {
  const rows = rowsOf(routes);
  const cell = (value, decimals, unit) => (!known(value) ? "–" : unit === "h" ? duration(value) : number(value, decimals));
  const head = routes.length > 1 ? h("thead", {}, h("tr", {}, h("th.text", { scope: "col" }, "Figure"), titles.map((title, i) => h("th", { scope: "col", "aria-current": i === chosen ? "true" : null, title }, String(i + 1))))) : null;
  const unitOf = (unit) => (unit && unit !== "h" ? h("small.unit", {}, ` ${unit}`) : null);
  return h("div.table.narrow", { tabindex: 0, role: "region", "aria-label": "Key performance indicators" }, h("table.indicators", {}, h("caption.hidden", {}, "Key performance indicators"), head,
    h("tbody", {}, rows.map(([label, unit, decimals, values]) => h("tr", {}, h("th.text", { scope: "row" }, label, unitOf(unit)), values.map((value, i) => h("td", { class: routes.length > 1 && i === chosen ? "chosen" : null }, cell(value, decimals, unit))))))));
}

// Rows of limits: an indicator, at most or at least, and a number.
export class IndicatorLimits {
  constructor(changed) {
    this.changed = changed;
    this.rows = [];
    this.list = h("div");
    this.element = h("div", { "data-field": "indicators" }, this.list, h("button.quiet.small", { type: "button", onclick: () => { this.#add(); this.#show(); this.rows.at(-1).name.focus(); } }, "+ Limit"), h("div.slot"),
      h("p.facts", {}, "For the whole route. A figure that is not known breaks its limit."));
  }

  #add(name = "fuel", most = INDICATORS[name]?.[3] ?? true, value = "", place = "") {
    const pick = h("select", { "aria-label": "Figure to limit" }, Object.entries(INDICATORS).map(([key, [label]]) => h("option", { value: key }, label)));
    pick.value = name;
    const side = h("select", { "aria-label": "At most or at least" }, h("option", { value: "most" }, "at most"), h("option", { value: "least" }, "at least"));
    side.value = most ? "most" : "least";
    const input = h("input", { type: "text", inputmode: "decimal", autocomplete: "off", "aria-label": "Value of the limit", value: String(value) });
    const unit = h("span.unit", {}, INDICATORS[name]?.[1] || "");
    const row = { name: pick, side, input, place, unit };
    pick.addEventListener("change", () => { const [, text, , greatest] = INDICATORS[pick.value]; unit.textContent = text; side.value = greatest ? "most" : "least"; row.place = ""; });
    this.rows.push(row);
  }

  #show() {
    fill(this.list, this.rows.map((row) => h("div.limit", {}, row.name, h("div.row", {}, row.side, h("div.with-unit", {}, row.input, row.unit), h("button.quiet", { type: "button", "aria-label": `Remove this limit (${INDICATORS[row.name.value][0]})`, onclick: () => { this.rows = this.rows.filter((one) => one !== row); this.#show(); this.changed(); } }, "✕")))));
  }

  // {at_most, at_least}, or null with the fault that is shown.
  value() {
    const found = { at_most: {}, at_least: {} };
    for (const { name, side, input, place } of this.rows) {
      const text = input.value.trim().replace(",", ".");
      if (text === "") continue;
      if (!Number.isFinite(Number(text))) { this.fault = { asked: `${input.value} is not a number.`, remedy: "Give a number, such as 12.5, or remove the limit." }; input.focus(); return null; }
      found[side.value === "most" ? "at_most" : "at_least"][place ? `${name.value}:${place}` : name.value] = Number(text);
    }
    return found;
  }

  set(voyage) {
    this.rows = [];
    for (const [side, most] of [["at_most", true], ["at_least", false]]) {
      for (const [key, value] of Object.entries(voyage[side] || {})) {
        const [name, place] = key.split(":");
        if (INDICATORS[name]) this.#add(name, most, value, place);
      }
    }
    this.#show();
  }

  get words() {
    const set = this.rows.filter((row) => row.input.value.trim());
    return set.length ? set.map((row) => `${INDICATORS[row.name.value][0].toLowerCase()} ${row.side.value === "most" ? "≤" : "≥"} ${row.input.value.trim()}`).join(", ") : "";
  }
}

const WEIGHED = { time: "Time", distance: "Distance", fuel: "Fuel", energy: "Energy", cost: "Cost", co2: "CO₂", comfort: "Sickness", encounters: "Encounters", inshore: "Near land" };

// Weights of the objective "weighted".
export class IndicatorWeights {
  constructor() {
    this.inputs = Object.fromEntries(Object.keys(WEIGHED).map((name) => [name, h("input", { type: "text", inputmode: "decimal", id: `w-${name}`, autocomplete: "off", placeholder: "0" })]));
    this.element = h("div.weights", { "data-field": "weights", hidden: true }, h("div.weight-grid", {}, Object.entries(WEIGHED).map(([name, label]) => h("div.field", {}, h("label.label", { for: `w-${name}` }, label), this.inputs[name]))), h("p.facts", {}, "Each figure counts from the best (0) to the worst (1) of the routes that are best in one of them."), h("div.slot"));
  }

  value() {
    const found = {};
    for (const [name, input] of Object.entries(this.inputs)) {
      const text = input.value.trim().replace(",", ".");
      if (text === "") continue;
      if (!(Number(text) >= 0)) { this.fault = { asked: `The weight of ${WEIGHED[name].toLowerCase()} is ${input.value}.`, remedy: "Give a number of zero or more." }; return null; }
      if (Number(text) > 0) found[name] = Number(text);
    }
    if (!Object.keys(found).length) { this.fault = { asked: "A weighted sum has no weights.", remedy: "Give one or more, such as 1 for fuel and 1 for motion sickness." }; return null; }
    return found;
  }

  set(weights) {
    for (const [name, input] of Object.entries(this.inputs)) input.value = weights?.[name] ?? "";
  }
}
