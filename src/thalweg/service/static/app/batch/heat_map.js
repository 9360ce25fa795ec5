// A heat map of many voyages as a table: median of a figure in each cell, with its voyages.

import { colour, fill, h } from "../common/elements.js";
import { duration, known, number, seconds, time } from "../common/format.js";

const MONTHS = ["Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"];
const two = (n) => String(n).padStart(2, "0");
const RAMP = ["#eef4f7", "#cfe1ee", "#a8c8e4", "#7ea9d6", "#5f86c4", "#5563aa", "#513f8b", "#43206a"];

export const FIGURES = [
  ["time_h", "Time", (v) => duration(v)], ["fuel_t", "Fuel", (v) => `${number(v, 1)} t`], ["cost", "Cost", (v) => number(v)], ["co2_t", "CO₂", (v) => `${number(v)} t`],
  ["waiting_h", "Waiting", (v) => duration(v)], ["max_significant_wave_height_m", "Highest waves", (v) => `${number(v, 1)} m`], ["max_wind_speed_ms", "Strongest wind", (v) => `${number(v * 3600 / 1852)} kn`],
  ["saved_time_h", "Time saved", (v) => duration(v)], ["saved_fuel_t", "Fuel saved", (v) => `${number(v, 1)} t`], ["lost", "Without a route", (v) => `${number(100 * v)} %`],
];

// Ways to group the departures, besides the axes of the study.
const TIMES = [
  ["depart:month", "Month", (t) => t.getUTCMonth(), (k) => MONTHS[k]], ["depart:year", "Year", (t) => t.getUTCFullYear(), String],
  ["depart:day", "Day", (t) => Date.UTC(t.getUTCFullYear(), t.getUTCMonth(), t.getUTCDate()), (k) => { const d = new Date(k); return `${d.getUTCDate()} ${MONTHS[d.getUTCMonth()]}`; }],
  ["depart:hour", "Hour of the day", (t) => t.getUTCHours() * 60 + t.getUTCMinutes(), (k) => `${two(Math.floor(k / 60))}:${two(k % 60)}`], ["depart:each", "Departure", (t) => t.getTime(), (k) => time(k / 1000)],
];
const NAMES = { depart: "Departure", load_factor: "Load" };
const UNITS = { kn: "kn", nm: "nm", m: "m", h: "h", usd_per_h: "USD/h", usd_per_t: "USD/t", percent: "%" };

// Name and unit of an axis, such as ["Speed", "kn"] of speed_kn.
function axisOf(name) {
  const ending = Object.keys(UNITS).find((one) => name.endsWith(`_${one}`)), base = NAMES[name] || (ending ? name.slice(0, -ending.length - 1) : name).replaceAll("_", " ");
  return [base[0].toUpperCase() + base.slice(1), ending ? UNITS[ending] : ""];
}

export const quantile = (sorted, q) => { const at = q * (sorted.length - 1), i = Math.floor(at); return sorted[i] + (at - i) * ((sorted[i + 1] ?? sorted[i]) - sorted[i]); };

export class HeatMap {
  // drawn: names of the axes whose values are drawn at random; they are grouped in classes
  constructor(axes, drawn, onCell) {
    this.rows = [];
    this.axes = axes;
    this.drawn = new Set(drawn);
    this.onCell = onCell;
    this.figure = "time_h";
    this.controls = h("div.map-controls");
    this.holder = h("div.table.heat", { tabindex: 0 });
    this.element = h("div.tabbed", {}, this.controls, this.holder);
    addEventListener("palette", () => { if (this.element.isConnected) this.draw(); });
  }

  add(rows) {
    this.rows.push(...rows.map((row) => ({ ...row, at: row.depart ? new Date(seconds(row.depart) * 1000) : null })));
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.draw(), 30);
  }

  #keys() {
    const fixed = this.axes.filter((name) => name !== "depart" && new Set(this.rows.map((row) => row[name])).size > 1).map((name) => { const [text, unit] = axisOf(name); return [name, unit ? `${text} [${unit}]` : text]; });
    const times = this.rows.some((row) => row.at) ? this.#times.filter(([, , key], i) => { const n = new Set(this.rows.map((row) => row.at && key(row.at))).size; return n > 1 && n <= (i === 4 ? 60 : 370) && !(this.drawn.has("depart") && i === 4); }).map(([name, text]) => [name, text]) : [];
    return [...times, ...fixed];
  }

  // Departures that are drawn have no hours in common: they are grouped by quarters of the day.
  get #times() {
    return this.drawn.has("depart") ? TIMES.map((row) => (row[0] === "depart:hour" ? [row[0], row[1], (t) => Math.floor(t.getUTCHours() / 6) * 6, (k) => `${two(k)} to ${two(k + 6)} h`] : row)) : TIMES;
  }

  // The width of the classes of an axis of numbers that are drawn; 0 where its values stand for themselves.
  #classOf(name) {
    if (!this.drawn.has(name)) return 0;
    const values = this.rows.map((row) => row[name]).filter(known), range = Math.max(...values) - Math.min(...values);
    if (new Set(values).size <= 12 || !(range > 0)) return 0;
    const rough = range / 6, ten = 10 ** Math.floor(Math.log10(rough));
    return ten * [1, 2, 5, 10].find((one) => one * ten >= rough);
  }

  #choose() {
    const keys = this.#keys().map(([name]) => name), other = keys.filter((name) => !name.startsWith("depart:"));
    if (!keys.includes(this.across) || (!this.byHand && this.auto !== keys.join())) {
      const count = (name) => { const [, , key] = this.#times.find((row) => row[0] === name); return new Set(this.rows.map((row) => key(row.at))).size; };
      this.across = keys.includes("depart:month") && count("depart:month") > 2 ? "depart:month" : keys.find((name) => name === "depart:day") || keys[0] || null;
      this.down = other.find((name) => name !== this.across) || ["depart:year", "depart:hour", "depart:day"].find((name) => keys.includes(name) && name !== this.across) || null;
      this.auto = keys.join();
    }
    if (this.down !== null && (!keys.includes(this.down) || this.down === this.across)) this.down = null;
  }

  #keyOf(name) {
    if (!name) return [() => "", () => "all voyages"];
    const found = this.#times.find((row) => row[0] === name), step = this.#classOf(name), unit = found || !axisOf(name)[1] ? "" : ` ${axisOf(name)[1]}`;
    if (step) return [(row) => Math.floor(row[name] / step + 1e-9) * step, (k) => `${number(k, decimalsOf(step))} to ${number(k + step, decimalsOf(step))}${unit}`];
    return found ? [(row) => found[2](row.at), found[3]] : [(row) => row[name], (k) => (typeof k === "number" ? `${Number(k.toFixed(2))}${unit}` : String(k))];
  }

  draw() {
    if (!this.rows.length) { fill(this.controls); fill(this.holder, h("p.empty", {}, h("b", {}, "No voyage yet"), "Each voyage appears here as soon as it is planned.")); return; }
    this.#choose();
    const keys = this.#keys(), there = FIGURES.filter(([name]) => name === "lost" || this.rows.some((row) => known(row[name])));
    const varies = ([name]) => { const values = this.rows.map((row) => row[name]).filter(known); return Math.max(...values) - Math.min(...values) > 1e-3 * Math.abs(values[0]); };
    if (!this.byHand || !there.some(([name]) => name === this.figure)) [this.figure] = there.find(varies) || there[0];
    const select = (id, label, options, value, act) => h("label.inline", {}, label, h("select", { id, onchange: (event) => { act(event.target.value || null); this.byHand = true; this.draw(); document.getElementById(id).focus(); } }, options.map(([name, text]) => h("option", { value: name ?? "", selected: name === value }, text))));
    const [acrossKey, acrossText] = this.#keyOf(this.across), [downKey, downText] = this.#keyOf(this.down);
    const order = (values) => [...new Set(values)].sort((a, b) => (typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b), "en", { numeric: true })));
    const columns = order(this.rows.map(acrossKey)), lines = order(this.rows.map(downKey));
    const cells = new Map();
    for (const row of this.rows) { const key = JSON.stringify([downKey(row), acrossKey(row)]); if (!cells.has(key)) cells.set(key, []); cells.get(key).push(row); }
    const facts = (rows) => {
      const lost = rows.filter((row) => row.refusal || row.feasible === false).length;
      const values = rows.filter((row) => !row.refusal && row.feasible !== false).map((row) => row[this.figure]).filter(known).sort((a, b) => a - b);
      return { rows, lost, values, shown: this.figure === "lost" ? lost / rows.length : values.length ? quantile(values, 0.5) : null };
    };
    const found = new Map([...cells].map(([key, rows]) => [key, facts(rows)]));
    const all = [...found.values()].map((one) => one.shown).filter(known);
    const low = Math.min(...all), high = Math.max(...all), [, title, text] = FIGURES.find(([name]) => name === this.figure);
    const dim = Number(colour("heat-dim"));
    const compact = (v) => (this.figure.endsWith("_h") ? number(v, Math.abs(v) < 100 ? 1 : 0) : this.figure === "lost" ? number(100 * v) : this.figure === "max_wind_speed_ms" ? number(v * 3600 / 1852) : number(v, Math.abs(v) < 100 ? 1 : 0));
    fill(this.controls, select("heat-figure", "Median of", there.map(([name, label]) => [name, label]), this.figure, (v) => { this.figure = v; }), select("heat-across", "across", keys, this.across, (v) => { this.across = v; }), select("heat-down", "down", [[null, "all together"], ...keys.filter(([name]) => name !== this.across)], this.down, (v) => { this.down = v; }), h("span.ramp", {}, all.length ? text(low) : "", h("i", { style: `background: linear-gradient(90deg, ${RAMP.map((c) => shade(c, dim).css).join(",")})` }), all.length ? text(high) : ""));
    const unitOf = { time_h: "hours", waiting_h: "hours", saved_time_h: "hours", fuel_t: "t", saved_fuel_t: "t", co2_t: "t", lost: "%", max_significant_wave_height_m: "m", max_wind_speed_ms: "kn", cost: "" }[this.figure];
    const cell = (line, column) => {
      const key = JSON.stringify([line, column]), one = found.get(key);
      if (!one) return h("td.none", {}, "");
      if (!known(one.shown)) return h("td.none", {}, h("button", { type: "button", title: `${one.lost} of ${one.rows.length} voyages have no route`, "aria-label": `${downText(line)}, ${acrossText(column)}: no route`, onclick: () => this.onCell(`${downText(line)} · ${acrossText(column)}`, one) }, "none"));
      const paint = shade(RAMP[Math.min(RAMP.length - 1, Math.floor(((one.shown - low) / Math.max(1e-9, high - low)) * RAMP.length))], dim);
      const spread = one.values.length > 2 ? `, 80 % within ${text(quantile(one.values, 0.1))} to ${text(quantile(one.values, 0.9))}` : "";
      return h("td", { style: `background: ${paint.css}; color: ${paint.ink}` }, h("button", { type: "button", title: `${title}: ${text(one.shown)}${spread}; ${one.rows.length} voyage${one.rows.length === 1 ? "" : "s"}${one.lost ? `, ${one.lost} without a route` : ""}`, onclick: () => this.onCell(`${downText(line)} · ${acrossText(column)}`, one) }, compact(one.shown)));
    };
    const label = (name) => keys.find(([one]) => one === name)?.[1] || "";
    fill(this.holder, h("table", {}, h("caption.hidden", {}, `Median of ${title.toLowerCase()}${unitOf ? ` in ${unitOf}` : ""}, ${label(this.across)} across, ${label(this.down)} down`), h("thead", {}, h("tr", {}, h("th.text", { scope: "col" }, `${title}${unitOf ? ` [${unitOf}]` : ""}`), columns.map((column) => h("th", { scope: "col" }, acrossText(column))))), h("tbody", {}, lines.map((line) => h("tr", {}, h("th.text", { scope: "row" }, downText(line)), columns.map((column) => cell(line, column)))))));
  }
}

const decimalsOf = (step) => Math.max(0, -Math.floor(Math.log10(step) + 1e-9));

function shade(hex, dim) {
  const rgb = [1, 3, 5].map((i) => Math.round(parseInt(hex.slice(i, i + 2), 16) * dim));
  const linear = rgb.map((v) => { const c = v / 255; return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4; });
  const light = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
  return { css: `rgb(${rgb.join(",")})`, ink: light > 0.18 ? "#101820" : dim < 0.5 ? "#c9bdb4" : "#ffffff" };
}
