// Fields of a request that hold one value each: where they stand in it, and how they are written.

import { h, withUnit } from "../common/elements.js";
import { inputTime, seconds } from "../common/format.js";
import { typedTime } from "../common/typed_time.js";

// name: part of the request ("" is the request itself), label, kind, and more by the kind:
// number: unit, and how many of it are one of the request; choice: pairs of value and text, the first is left out;
// tick: the value that is sent where it is not ticked; words: a list with commas; time: in UTC.
const FIELDS = {
  speed_kn: ["voyage", "Ordered speed", "number", "kn"],
  arrive_by: ["voyage", "Arrive by", "time"],
  arrive: ["voyage", "Arrive at", "time"],
  hold: ["voyage", "Hold at this speed", "choice", [["", "as the ship file orders"], ["speed", "speed through water"], ["power", "power"], ["ground", "speed over ground"]]],
  wait: ["voyage", "The ship may stop and wait", "tick", false],
  speed_step_kn: ["voyage", "Also speeds between, every", "number", "kn"],
  speed_block_h: ["voyage", "Hold for", "number", "h"],
  wave_height_m: ["limits", "Waves at most", "number", "m"],
  wind_speed_kn: ["limits", "Wind at most", "number", "kn"],
  motion_sickness_percent: ["limits", "Sick after two hours at most", "number", "% of people"],
  min_ukc_m: ["voyage", "Under-keel clearance", "number", "m"],
  offing_nm: ["voyage", "Distance from land", "number", "nm"],
  avoid: ["voyage", "Passages to avoid", "words", "Pentland Firth, ..."],
  open: ["voyage", "Passages to open, though closed to ships of her size", "words", "Raz de Sein, ..."],
  fuel_price_usd: ["voyage", "Fuel", "number", "USD/t"],
  eca_price_factor: ["voyage", "Factor in control areas", "number", "×"],
  time_price_usd_per_h: ["voyage", "Cost of an hour, without fuel", "number", "USD/h"],
  eca: ["", "Emission control areas count in the cost", "tick", false],
  ets_price: ["charges", "Allowance", "number", "USD/t CO₂"],
  eur_rate: ["charges", "Euro", "number", "USD"],
  share_percent: ["charges", "Share of the voyage", "choice", [["", "by its two ports"], [100, "100 %"], [50, "50 %"], [0, "none"]]],
  year: ["charges", "Year", "number", ""],
  load_factor: ["", "Load", "number", "%", 100],
  coast: ["", "Coastline", "choice", [["i", "intermediate"], ["c", "crude"], ["l", "low"], ["h", "high"], ["f", "full"], ["none", "none: open water"]]],
  ignore_shoals: ["voyage", "Keep out of shoal water by the global depth layer", "tick", true],
  ignore_lanes: ["voyage", "Keep to the direction of traffic separation schemes", "tick", true],
  average_over_m: ["", "Average currents in layers over", "number", "m"],
  sampling: ["", "Weather between its times", "choice", [["linear", "interpolated"], ["nearest:3", "nearest within 3 h"], ["nearest:6", "nearest within 6 h"], ["nearest:12", "nearest within 12 h"]]],
  method: ["voyage", "Search of trade-offs", "choice", [["default", "exact, then refined"], ["exact", "exact only"], ["nsga2", "NSGA-II"], ["spea2", "SPEA2"], ["mpaes", "M-PAES"]]],
  ensemble: ["voyage", "Forecasts with members", "choice", [["", "not used to choose"], ["mean", "least mean"], ["cvar", "least mean of the worst tenth"]]],
  seed: ["voyage", "Seed of random numbers", "number", ""],
  legs: ["route_files", "Lines between waypoints", "choice", [["rhumb", "rhumb lines"], ["great-circle", "great circles"]]],
  rtz_version: ["route_files", "RTZ version", "choice", [["1.2", "1.2"], ["1.1", "1.1"], ["1.0", "1.0"]]],
  cross_track_nm: ["route_files", "Cross-track limit (XTD)", "number", "nm"],
  waypoint_spacing_nm: ["route_files", "Longest leg", "number", "nm"],
  max_waypoints: ["route_files", "Waypoints at most", "number", ""],
};
const TIME_EXAMPLE = "2026-01-31 12:00";

export class RequestFields {
  inputs = {};

  constructor() {
    for (const [name, [, , kind, more]] of Object.entries(FIELDS)) {
      this.inputs[name] = {
        number: () => h("input", { type: "text", inputmode: "decimal", id: `n-${name}`, autocomplete: "off" }),
        time: () => h("input", { type: "text", id: name.replace("_", "-"), autocomplete: "off", placeholder: TIME_EXAMPLE }),
        words: () => h("input", { type: "text", id: name, autocomplete: "off", placeholder: more }),
        tick: () => h("input", { type: "checkbox", id: name, checked: true }),
        choice: () => h("select", { id: name }, more.map(([value, text]) => h("option", { value: String(value) }, text))),
      }[kind]();
    }
  }

  /** The field of a name, with its label and the place of its errors. */
  field(name) {
    const [, label, kind, unit] = FIELDS[name], input = this.inputs[name];
    if (kind === "tick") return h("div", { "data-field": name }, h("label.check", {}, input, h("span", {}, label)), h("div.slot"));
    return h("div.field", { "data-field": name }, h("label.label", { for: input.id }, label), kind === "time" ? withUnit(input, "UTC") : kind === "number" && unit ? withUnit(input, unit) : input, h("div.slot"));
  }

  pair(a, b, shape = "") {
    return h(`div.pair${shape}`, {}, this.field(a), this.field(b));
  }

  /**
   * Write what is set into a request.
   * @returns {{field: string, asked: string, remedy: string}|null} the first fault
   */
  fill(request) {
    for (const [name, [part, label, kind, unit, scale]] of Object.entries(FIELDS)) {
      const input = this.inputs[name], text = input.value.trim();
      let value = null;
      if (kind === "tick") value = input.checked ? null : unit;
      else if (text === "" || input.selectedIndex === 0) continue;
      else if (kind === "number") value = Number((Number(text.replace(",", ".")) / (scale || 1)).toPrecision(12));
      else if (kind === "choice") value = (unit.find(([one]) => String(one) === text) || [text])[0];
      else if (kind === "words") value = text.split(",").map((one) => one.trim()).filter(Boolean);
      else {
        const t = typedTime(input);
        if (t === null) return { field: name, asked: `${label}: ${text} is not a time.`, remedy: `Give year, month, day, hour and minute in UTC, such as ${TIME_EXAMPLE}.` };
        value = `${inputTime(t).replace(" ", "T")}Z`;
      }
      if (Number.isNaN(value)) return { field: name, asked: `${label}: ${text} is not a number.`, remedy: "Give a number, such as 12.5." };
      if (value !== null) (part ? (request[part] ||= {}) : request)[name] = value;
    }
    return null;
  }

  set(request) {
    for (const [name, [part, , kind, unit, scale]] of Object.entries(FIELDS)) {
      const given = (part ? request[part] : request)?.[name] ?? null, input = this.inputs[name];
      if (kind === "tick") input.checked = given !== unit;
      else if (given === null) { if (kind === "choice") input.selectedIndex = 0; else input.value = ""; }
      else if (kind === "number") input.value = String(Number((given * (scale || 1)).toPrecision(12)));
      else if (kind === "words") input.value = [given].flat().join(", ");
      else if (kind === "time") input.value = inputTime(seconds(given));
      else showChoice(input, given);
    }
  }

  /** What is set of some fields, in a few words. */
  words(names) {
    return names.map((name) => {
      const [, label, kind, unit] = FIELDS[name], input = this.inputs[name], text = input.value.trim();
      if (kind === "tick") return input.checked ? "" : `not: ${label.toLowerCase()}`;
      if (!text || input.selectedIndex === 0) return "";
      return kind === "number" && unit ? `${text} ${unit}` : kind === "choice" ? input.selectedOptions[0].text : label.toLowerCase();
    });
  }
}

/** Choose a value of a list; one that the list does not hold is added to it. */
export function showChoice(select, value) {
  const text = String(value);
  if (![...select.options].some((option) => option.value === text)) select.append(h("option", { value: text }, text));
  select.value = text;
}
