// The drawer: time and player, profile along time, front, legs. All follow the one selection.

import uPlot from "../../vendor/uplot.mjs";
import { colour, fill, h } from "../common/elements.js";
import { bearing, duration, known, number, position, seconds, time } from "../common/format.js";
import { FrontDiagram } from "./front_diagram.js";
import { drawClosures } from "../batch/project_diagrams.js";
import { limitOf, nearLimits } from "./limits_met.js";
import { selection } from "../common/selection.js";

const SERIES = [
  ["speed_over_ground_kn", "Speed over ground", "kn", "speed", "--imported", 1],
  ["speed_through_water_kn", "Speed through water", "kn", "speed", "--good", 1],
  ["wave_height_m", "Waves", "m", "waves", "--accent", 1],
  ["wind_speed_kn", "Wind", "kn", "speed", "--ink-3", 0],
  ["power_kw", "Power", "kW", "power", "--amber", 0],
  ["fuel_t_per_day", "Fuel", "t/d", "fuel", "--amber", 1],
  ["under_keel_clearance_m", "Under-keel clearance", "m", "depth", "--coast", 1],
  ["depth_m", "Depth", "m", "depth", "--other", 0],
  ["current_speed_kn", "Current", "kn", "speed", "--isochrone", 1],
  ["ice_fraction", "Ice cover", "", "ice", "--hatch", 2],
  ["weighted_acceleration_m_s2", "Motion felt on board", "m/s²", "motion", "--danger", 2],
];
const figure = (value, decimals) => (known(value) ? number(value, decimals) : "–");
const WEATHER = ["wave_height_m", "wind_speed_kn", "current_speed_kn"];
const FIRST = ["speed_over_ground_kn", "wave_height_m"];

export class Drawer {
  /** @param {() => boolean} waits whether the weather of the time is still on its way */
  constructor(element, waits) {
    this.element = element;
    this.waits = waits;
    this.shown = new Set(FIRST);
    this.tab = "profile";
    this.play = h("button.play", { type: "button", "aria-label": "Play (space)", onclick: () => this.toggle() });
    this.slider = h("input", { type: "range", min: 0, max: 1000, step: 1, value: 0, id: "time", "aria-label": "Time", oninput: () => selection.at(this.from + (Number(this.slider.value) / 1000) * (this.to - this.from)) });
    this.output = h("output", { for: "time" });
    this.tabs = h("div.tabs", { role: "tablist", "aria-label": "Diagrams" });
    this.sheet = h("div.sheet", { role: "tabpanel", id: "sheet" });
    fill(element, h("div.player.timed", {}, this.play, this.slider, this.output, this.tabs), this.sheet);
    this.#icon();
    selection.addEventListener("time", () => this.moved());
    for (const kind of ["route", "hover"]) selection.addEventListener(kind, () => this.front?.mark());
    new ResizeObserver(() => this.#resize()).observe(this.sheet);
  }

  range(from, to) {
    this.from = from;
    this.to = to;
  }

  // The player alone, over the time of the data [s, s]; without data it cannot be moved.
  showTimes(period) {
    if (!period) this.stop();
    this.#clear();
    this.result = null;
    this.element.hidden = false;
    this.element.classList.add("slim");
    fill(this.tabs);
    fill(this.sheet);
    this.range(...(period || [null, null]));
    this.slider.disabled = this.play.disabled = !period;
    if (!period) this.output.textContent = "no weather to play";
    this.moved();
  }

  #clear() {
    this.plot?.destroy();
    this.plot = this.front = this.chips = this.rows = null;
  }

  // result: {plan, kind, profile, speedRange}; redraws the open tab.
  show(result) {
    this.element.hidden = false;
    this.element.classList.remove("slim");
    this.slider.disabled = this.play.disabled = false;
    this.result = result;
    if ((this.tab === "front" && !result.front) || (this.tab === "tide" && !result.spaceTime)) this.tab = "profile";
    const names = [["profile", "Profile"], ...(result.front ? [["front", "Front"]] : []), ...(result.spaceTime ? [["tide", "Place and time"]] : []), ["legs", "Legs"]];
    fill(this.tabs, names.map(([name, text]) => h("button", { type: "button", role: "tab", id: `tab-${name}`, "aria-controls": "sheet", "aria-selected": String(name === this.tab), tabindex: name === this.tab ? 0 : -1, onclick: () => this.open(name), onkeydown: (event) => this.#tabKey(event, names) }, text)));
    this.sheet.setAttribute("aria-labelledby", `tab-${this.tab}`);
    if (this.tab === "front" && this.front?.plan === result.plan && this.sheet.contains(this.front.element)) { // it is held by mouse or keyboard
      this.moved();
      return;
    }
    this.#clear();
    if (this.tab === "front") this.#showFront();
    else if (this.tab === "legs") this.#showLegs();
    else if (this.tab === "tide") this.#showTide();
    else this.#showProfile();
    this.moved();
  }

  open(tab) {
    this.tab = tab;
    if (this.result) this.show(this.result);
    this.tabs.querySelector(`#tab-${tab}`)?.focus();
  }

  #tabKey(event, names) {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    event.stopPropagation();
    const at = names.findIndex(([name]) => name === this.tab);
    this.open(names[(at + step + names.length) % names.length][0]);
  }

  // Player

  toggle() { this.timer ? this.stop() : this.start(); }

  start() {
    if (!known(this.to)) return;
    const hours = (this.to - this.from) / 3600;
    const whole = Math.max(16, hours / 12) * 1000; // all of it in milliseconds: no more than half a day in a second
    let last = performance.now(), waited = 0;
    if (!(selection.time >= this.from && selection.time < this.to - 60)) selection.at(this.from);
    const tick = (now) => {
      const step = now - last;
      last = now;
      waited = this.waits() ? waited + step : 0;
      if (waited > 0 && waited < 3000) { this.timer = requestAnimationFrame(tick); return; } // ship and weather move together
      const next = selection.time + (Math.min(step, 100) / whole) * (this.to - this.from);
      if (next >= this.to) { selection.at(this.to); this.stop(); return; }
      selection.at(next);
      this.timer = requestAnimationFrame(tick);
    };
    this.timer = requestAnimationFrame(tick);
    this.#icon();
  }

  stop() {
    cancelAnimationFrame(this.timer);
    this.timer = null;
    this.#icon();
  }

  step(hours) { if (known(this.to)) selection.at(Math.max(this.from, Math.min(this.to, (selection.time ?? this.from) + hours * 3600))); }

  #icon() {
    this.play.innerHTML = this.timer ? '<svg viewBox="0 0 12 12"><path d="M2 1h3v10H2zM7 1h3v10H7z"/></svg>' : '<svg viewBox="0 0 12 12"><path d="M2 0.5l9 5.5-9 5.5z"/></svg>';
    this.play.setAttribute("aria-label", this.timer ? "Pause (space)" : "Play (space)");
  }

  moved() {
    const t = selection.time;
    if (!known(t) || !known(this.from)) return;
    fill(this.output, time(t), h("span.unit", {}, " UTC"));
    if (document.activeElement !== this.slider || this.timer) this.slider.value = String(Math.round(((t - this.from) / Math.max(1, this.to - this.from)) * 1000));
    this.slider.style.setProperty("--share", `${(100 * (t - this.from)) / Math.max(1, this.to - this.from)}%`);
    this.slider.setAttribute("aria-valuetext", `${time(t)} UTC`);
    this.output.classList.toggle("outside", t < this.from || t > this.to);
    const profile = this.result?.profile;
    if (this.plot?.status === 1 && profile && !this.inPlot) this.plot.setCursor({ left: this.plot.valToPos(t, "x"), top: 10 }, false);
    if (profile) this.#values(indexAt(profile.time, t));
    if (this.tab === "legs") this.#currentLeg(t);
  }

  // Profile

  // Of a calm sea that was assumed there is no weather to draw.
  get #series() {
    return SERIES.filter(([name]) => this.result.profile[name] && !(this.result.calm && WEATHER.includes(name)));
  }

  #showProfile() {
    const { profile } = this.result;
    if (!profile) { fill(this.sheet, h("p.empty", {}, "The profile is loading …")); return; }
    const there = this.#series;
    if (!there.some(([name]) => this.shown.has(name))) this.shown.add(there[0]?.[0]);
    this.holder = h("div.plot", { role: "img", "aria-label": "Profile of the route along time; the values at the chosen time stand beside it, and all legs in the table." });
    this.chips = there.map(([name, text, unitText, , paint]) => {
      const value = h("span.value"), unitOf = h("span", {}, ` ${unitText}`);
      const mark = h("i");
      mark.style.background = `var(${paint})`;
      const box = h("label.check", {}, h("input", { type: "checkbox", checked: this.shown.has(name), onchange: (event) => { event.target.checked ? this.shown.add(name) : this.shown.delete(name); this.#plot(); } }), mark, h("span", {}, text, h("small", {}, value, unitOf)));
      box.value = value;
      box.unitOf = unitOf;
      box.name = name;
      return box;
    });
    fill(this.sheet, this.holder, h("fieldset.chips", {}, h("legend.hidden", {}, "Curves"), this.chips));
    this.#plot();
  }

  #plot() {
    const { profile } = this.result;
    this.plot?.destroy();
    fill(this.holder);
    const there = this.#series.filter(([name]) => this.shown.has(name));
    const scales = [...new Set(there.map((row) => row[3]))];
    const axis = { stroke: colour("ink-2"), grid: { stroke: colour("ground-3"), width: 1 }, ticks: { stroke: colour("line"), width: 1, size: 4 }, font: '11px system-ui, "DejaVu Sans", sans-serif' };
    const units = { speed: "kn", waves: "m", power: "kW", fuel: "t/d", depth: "m", motion: "m/s²" };
    this.plot = new uPlot({
      width: Math.max(200, this.holder.clientWidth - 8), height: Math.max(80, this.holder.clientHeight - 6), padding: [10, 8, 0, 0],
      tzDate: (t) => uPlot.tzDate(new Date(t * 1000), "UTC"),
      cursor: { y: false, points: { size: 6 }, drag: { x: false, y: false }, lock: false },
      scales: { x: { time: true }, ...Object.fromEntries(scales.map((name) => [name, { range: (_, low, high) => (low === high ? [Math.min(0, low ?? 0), Math.max(1, 1.12 * (high ?? 0))] : uPlot.rangeNum(name === "depth" ? low : Math.min(0, low ?? 0), high ?? 1, { min: { pad: 0 }, max: { pad: 0.12, soft: 1 } })) }])) },
      axes: [
        { ...axis, size: 32, values: (u, ticks) => ticks.map((t, i) => { const d = new Date(t * 1000); const hour = d.getUTCHours(); return (hour || d.getUTCMinutes()) && i ? `${String(hour).padStart(2, "0")}:${String(d.getUTCMinutes()).padStart(2, "0")}` : time(t).split(" ").slice(0, 2).join(" "); }) },
        ...scales.slice(0, 3).map((name, i) => ({ ...axis, scale: name, side: i ? 1 : 3, size: 46, label: units[name], labelSize: 16, labelFont: axis.font, labelGap: 0, grid: { ...axis.grid, show: i === 0 } })),
      ],
      series: [{}, ...there.map(([name, text, , scale, paint]) => ({ label: text, scale, stroke: getComputedStyle(document.documentElement).getPropertyValue(paint), width: 1.8, spanGaps: false }))],
      legend: { show: false },
      hooks: { ready: [(u) => { this.#align(u); this.moved(); }], setSize: [(u) => this.#align(u)], draw: [(u) => this.#drawLimits(u, there)], setCursor: [(u) => { if (this.inPlot && u.cursor.idx !== null && u.cursor.left >= 0) selection.at(profile.time[u.cursor.idx]); }] },
    }, [profile.time, ...there.map(([name]) => profile[name])], this.holder);
    this.plot.over.addEventListener("pointerenter", () => { this.inPlot = true; });
    this.plot.over.addEventListener("pointerleave", () => { this.inPlot = false; this.moved(); });
    this.moved();
  }

  // The slider stands over the plot: the times of both line up.
  #align(u) {
    const { left, width } = u.over.getBoundingClientRect(), outer = this.element.getBoundingClientRect();
    this.element.style.setProperty("--plot-left", `${left - outer.left}px`);
    this.element.style.setProperty("--plot-right", `${outer.right - left - width}px`);
  }

  // Limits of the curves as dashed lines, and when the route is near one.
  #drawLimits(u, there) {
    const { ctx: pen } = u, { left, top, width, height } = u.bbox, met = this.result.limits, ratio = devicePixelRatio;
    pen.save();
    pen.fillStyle = colour("near");
    for (const [from, to] of nearLimits(met)) {
      const a = u.valToPos(from, "x", true), b = u.valToPos(to, "x", true);
      pen.fillRect(a, top, Math.max(2 * ratio, b - a), 5 * ratio);
    }
    pen.setLineDash([6 * ratio, 4 * ratio]);
    pen.lineWidth = 1.2 * ratio;
    for (const [name, , , scale, paint] of there) {
      const limit = limitOf(met, name), y = known(limit) ? u.valToPos(limit, scale, true) : -1;
      if (y < top || y > top + height) continue;
      pen.strokeStyle = colour(paint.slice(2));
      pen.beginPath();
      pen.moveTo(left, y);
      pen.lineTo(left + width, y);
      pen.stroke();
    }
    pen.restore();
  }

  #values(i) {
    for (const chip of this.chips || []) {
      const row = SERIES.find(([name]) => name === chip.name);
      const value = this.result.profile[chip.name]?.[i];
      chip.value.textContent = known(value) ? number(value, row[5]) : "not known here";
      chip.unitOf.hidden = !known(value);
    }
  }

  #resize() {
    if (this.plot && this.holder) this.plot.setSize({ width: Math.max(200, this.holder.clientWidth - 8), height: Math.max(80, this.holder.clientHeight - 6) });
    if (this.front) this.front.draw();
    if (this.tab === "tide" && this.result?.spaceTime) this.#showTide();
  }

  #showTide() {
    drawClosures(this.sheet, this.result.spaceTime, "Where and when the track of the route is closed by the tide, and the line of the ship");
  }

  // Front

  #showFront() {
    this.front = new FrontDiagram(this.result.plan);
    const facts = h("div.aside");
    this.front.facts = facts;
    fill(this.sheet, this.front.element, facts);
    this.front.draw();
  }

  // Legs

  #showLegs() {
    const rows = this.result.waypoints;
    const cells = [["Time", "UTC", (w) => time(seconds(w.time)), true], ["Position", "", (w) => position(w.lat, w.lon), true], ["Course", "", (w) => bearing(w.course_deg)], ["Order", "kn", (w) => figure(w.ordered_speed_kn, 1)], ["Over ground", "kn", (w) => figure(w.speed_over_ground_kn, 1)], ["Distance", "nm", (w) => number(w.distance_nm, 1)], ["Wait", "", (w) => (w.waiting_h > 0 ? duration(w.waiting_h) : "")], ["Waves", "m", (w) => (this.result.calm ? "calm" : figure(w.wave_height_m, 1))], ["Wind", "kn from", (w) => (known(w.wind_speed_kn) ? `${number(w.wind_speed_kn)}${known(w.wind_from_deg) ? ` ${bearing(w.wind_from_deg)}` : ""}` : "–")], ["UKC", "m", (w) => figure(w.ukc_m, 1)], ["Fuel", "t", (w) => number(w.fuel_t, 1)]]
      .filter(([name]) => name !== "Wait" || rows.some((w) => w.waiting_h > 0)).filter(([name]) => name !== "UKC" || rows.some((w) => known(w.ukc_m)));
    this.rows = rows.map((w, i) => h("tr", { onclick: () => selection.at(seconds(w.time)), "data-time": seconds(w.time) }, h("td", {}, String(i + 1)), cells.map(([, , text, left]) => h(left ? "td.text" : "td", {}, text(w)))));
    fill(this.sheet, h("div.table", { tabindex: 0 }, h("table", {}, h("caption.hidden", {}, "Waypoints of the chosen route, times in UTC"), h("thead", {}, h("tr", {}, h("th", {}, "#"), cells.map(([name, unitText, , left]) => h(left ? "th.text" : "th", { scope: "col" }, name, unitText ? h("span.unit", {}, ` ${unitText}`) : null)))), h("tbody", {}, this.rows))));
  }

  #currentLeg(t) {
    let last = null;
    for (const row of this.rows || []) { row.removeAttribute("aria-current"); if (Number(row.dataset.time) <= t + 1) last = row; }
    last?.setAttribute("aria-current", "true");
  }
}

function indexAt(times, t) {
  let low = 0, high = times.length - 1;
  while (high - low > 1) { const middle = (low + high) >> 1; times[middle] <= t ? (low = middle) : (high = middle); }
  return t - times[low] < times[high] - t ? low : high;
}

// The time at which a route passes nearest to a position [s].
export function timeNear({ time: times, lat: lats, lon: lons }, lat, lon) {
  const shrink = Math.cos((lat * Math.PI) / 180);
  const apart = lats.map((value, i) => (value - lat) ** 2 + (shrink * (((lons[i] - lon + 540) % 360) - 180)) ** 2);
  return times[apart.indexOf(Math.min(...apart))];
}

export function placeAt(profile, t) {
  const { time: times, lat, lon, course_deg: course } = profile;
  let low = 0, high = times.length - 1;
  if (t <= times[0]) high = 1;
  else if (t >= times[high]) low = high - 1;
  else while (high - low > 1) { const middle = (low + high) >> 1; times[middle] <= t ? (low = middle) : (high = middle); }
  const f = Math.max(0, Math.min(1, (t - times[low]) / Math.max(1e-9, times[high] - times[low])));
  const turn = ((lon[high] - lon[low] + 540) % 360) - 180;
  return { lat: lat[low] + f * (lat[high] - lat[low]), lon: lon[low] + f * turn, course: course?.[low] ?? 0, index: low };
}
