// Diagrams of a dredging project: volume, activities with the tide, place and time, loads, cycles.

import { fill, h } from "../common/elements.js";
import { days, duration, known, number, seconds, time } from "../common/format.js";
import { svg, ticks } from "../common/svg_parts.js";

const ACTIVITIES = [["loading", "Loading", "--act-1"], ["sailing full", "Sailing full", "--act-2"], ["unloading", "Unloading", "--act-3"], ["sailing empty", "Sailing empty", "--act-4"], ["waiting", "Waiting", "--accent"]];
export const runColour = (name) => (name === "base case" ? "--act-base" : "--accent");
const FIRST_HOURS = 72;

function frame(sheet, label, key) {
  const width = sheet.clientWidth - (key ? 180 : 0), height = sheet.clientHeight;
  const drawing = svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height, role: "img", "aria-label": label });
  fill(sheet, h("div.drawing", {}, drawing), key ? h("div.key-list", {}, key) : null);
  return [drawing, width, height];
}

const mark = (paint, text, style = "") => h("p.mark", {}, h(`i${style}`, { style: `--paint: var(${paint})` }), h("span", {}, text));

function axis(drawing, values, at, place) {
  for (const [value, text] of values) {
    const x = at(value);
    drawing.append(place.across
      ? svg("line", { class: "axis", x1: place.from, x2: place.to, y1: x, y2: x })
      : svg("line", { class: "axis", x1: x, x2: x, y1: place.from, y2: place.to }));
    drawing.append(place.across
      ? svg("text", { x: place.text, y: x + 4, "text-anchor": place.end ? "start" : "end" }, text)
      : svg("text", { x, y: place.text, "text-anchor": "middle" }, text));
  }
}

// runs: {name: [{end, volume_m3}]}; whole [m3]; start [s]; lasted: {name: [h]}, so far where a run goes on.
export function drawVolume(sheet, runs, whole, start, lasted = {}) {
  const names = Object.keys(runs).filter((name) => runs[name].length);
  const last = Math.max(1, ...names.map((name) => (runs[name].at(-1).end - start) / 86400));
  const [drawing, width, height] = frame(sheet, "Volume moved over time", [names.map((name) => mark(runColour(name), [name[0].toUpperCase() + name.slice(1), h("small", {}, `${number(runs[name].reduce((sum, c) => sum + c.volume_m3, 0))} m³ in ${days(lasted[name] ?? (runs[name].at(-1).end - start) / 3600)}`)])), mark("--ink-3", "Whole volume", ".dashed")]);
  const left = 62, right = 16, top = 12, bottom = 30, reach = last * 1.02;
  const px = (day) => left + (day / reach) * (width - left - right), py = (v) => height - bottom - (v / (whole * 1.06)) * (height - top - bottom);
  axis(drawing, ticks(0, reach, Math.max(3, width / 110)).map((v) => [v, `${Number(v.toFixed(2))} d`]), px, { from: top, to: height - bottom, text: height - bottom + 17 });
  axis(drawing, ticks(0, whole * 1.06, Math.max(2, height / 50)).map((v) => [v, number(v / 1000, whole < 10000 ? 1 : 0)]), py, { across: true, from: left, to: width - right, text: left - 8 });
  drawing.append(svg("line", { x1: left, x2: width - right, y1: py(whole), y2: py(whole), class: "whole" }));
  for (const name of names) {
    let moved = 0, path = `M${px(0)} ${py(0)}`;
    for (const cycle of runs[name]) { path += `H${px((cycle.end - start) / 86400)}`; moved += cycle.volume_m3; path += `V${py(moved)}`; }
    drawing.append(svg("path", { d: path, class: "curve", style: `stroke: var(${runColour(name)})` }));
  }
  return "Volume moved [1000 m³]";
}

export function drawActivities(sheet, diagrams, start) {
  const names = Object.keys(diagrams.runs);
  const end = Math.min(start + FIRST_HOURS * 3600, Math.max(...names.map((name) => Math.max(...diagrams.runs[name].activities["sailing empty"].map(([, b]) => b)))));
  const [drawing, width, height] = frame(sheet, "Activities of the first days, with the water level", [ACTIVITIES.map(([, text, paint]) => mark(paint, text, ".filled")), diagrams.level ? mark("--ink", "Water level at the unloading site") : null]);
  const left = 92, right = diagrams.level ? 46 : 16, top = 8, bottom = 30;
  const px = (t) => left + ((t - start) / (end - start)) * (width - left - right);
  const row = (height - top - bottom) / names.length;
  const hours = (end - start) / 3600, step = [1, 2, 3, 6, 12, 24].find((n) => hours / n <= width / 64) || 24;
  axis(drawing, Array.from({ length: Math.floor(hours / step) + 1 }, (_, k) => start + k * step * 3600).map((t) => [t, (t % 86400) ? time(t).split(" ")[2] : time(t).split(" ").slice(0, 2).join(" ")]), px, { from: top, to: height - bottom, text: height - bottom + 17 });
  names.forEach((name, k) => {
    const y = top + k * row + row * 0.2;
    drawing.append(svg("text", { x: left - 8, y: y + row * 0.3 + 4, "text-anchor": "end", class: "strong" }, name));
    for (const [kind, text, paint] of ACTIVITIES) {
      for (const [a, b] of diagrams.runs[name].activities[kind]) {
        if (a >= end || b <= a) continue;
        const bar = svg("rect", { x: px(a), y, width: Math.max(0.6, px(Math.min(b, end)) - px(a)), height: row * 0.6, style: `fill: var(${paint})` });
        bar.append(svg("title", {}, `${name}: ${text.toLowerCase()}, ${time(a)} to ${time(b)} UTC`));
        drawing.append(bar);
      }
    }
  });
  if (diagrams.level) {
    const { level_m: values, start: from, step_s: gap } = diagrams.level;
    const shown = values.map((v, i) => [from + i * gap, v]).filter(([t, v]) => t >= start && t <= end && known(v));
    const low = Math.min(...shown.map(([, v]) => v)), high = Math.max(...shown.map(([, v]) => v));
    const py = (v) => height - bottom - ((v - low + 0.15) / (high - low + 0.3)) * (height - top - bottom);
    drawing.append(svg("path", { d: shown.map(([t, v], i) => `${i ? "L" : "M"}${px(t).toFixed(1)} ${py(v).toFixed(1)}`).join(""), class: "curve thin", style: "stroke: var(--ink)" }));
    for (const v of ticks(low, high, 4)) drawing.append(svg("text", { x: width - right + 8, y: py(v) + 4 }, `${number(v, 1)} m`));
  }
  return `The first ${Math.round(hours)} hours from ${time(start)} UTC`;
}

export function drawPlaceAndTime(sheet, diagrams, chosen, choose) {
  const names = Object.keys(diagrams.runs), name = names.includes(chosen) ? chosen : names[0];
  const picker = h("fieldset", {}, h("legend", {}, "Way out of"), names.map((one) => h("label.check", {}, h("input", { type: "radio", name: "space-time", checked: one === name, onchange: () => choose(one) }), h("span", {}, `${one}, cycle ${diagrams.runs[one].space_time.cycle}`))));
  return drawClosures(sheet, diagrams.runs[name].space_time, `Where and when the way out of the ${name} is closed, and the lines of the ship`, picker);
}

// Distance along a track against time: where it is closed, and the lines of ships on it.
export function drawClosures(sheet, found, label, picker = null) {
  const [drawing, width, height] = frame(sheet, label, [picker, mark("--accent", "Ship"), mark("--shallow", "Too little water", ".filled"), mark("--amber", "Current too strong", ".filled"), mark("--hatch", "No data", ".filled")]);
  const { distance_m: along, times, closed, lines } = found;
  const left = 56, right = 16, top = 10, bottom = 30, t0 = times[0], t1 = times.at(-1), far = along.at(-1) || 1;
  const px = (t) => left + ((t - t0) / (t1 - t0)) * (width - left - right), py = (d) => height - bottom - (d / far) * (height - top - bottom);
  const paints = { 1: "var(--shallow)", 2: "var(--amber)", 3: "var(--hatch)" };
  closed.forEach((row, i) => {
    const low = i ? (along[i - 1] + along[i]) / 2 : 0, high = i + 1 < along.length ? (along[i] + along[i + 1]) / 2 : far;
    for (const run of row.matchAll(/1+|2+|3+/g)) {
      const a = times[run.index], b = times[Math.min(times.length - 1, run.index + run[0].length)];
      drawing.append(svg("rect", { x: px(a), y: py(high), width: px(b) - px(a) + 0.4, height: py(low) - py(high) + 0.4, style: `fill: ${paints[run[0][0]]}` }));
    }
  });
  const hours = (t1 - t0) / 3600, step = [0.5, 1, 2, 3, 6, 12].find((n) => hours / n <= width / 70) || 12;
  axis(drawing, Array.from({ length: Math.ceil(hours / step) + 1 }, (_, k) => (Math.ceil(t0 / (step * 3600)) + k) * step * 3600).filter((t) => t <= t1).map((t) => [t, time(t).split(" ")[2]]), px, { from: top, to: height - bottom, text: height - bottom + 17 });
  axis(drawing, ticks(0, far / 1000, Math.max(2, height / 46)).map((v) => [v * 1000, `${Number(v.toFixed(2))} km`]), py, { across: true, from: left, to: width - right, text: left - 6 });
  for (const line of lines) drawing.append(svg("path", { d: line.times.map((t, i) => `${i ? "L" : "M"}${px(t).toFixed(1)} ${py(line.distance_m[i]).toFixed(1)}`).join(""), class: "curve", style: "stroke: var(--accent)" }));
  return `Distance along the route against time, from ${time(t0)} UTC`;
}

export function drawLoads(sheet, runs) {
  const names = Object.keys(runs);
  const loads = [...new Set(names.flatMap((name) => runs[name].map((c) => c.load_factor)))].sort((a, b) => a - b);
  const count = (name, load) => runs[name].filter((c) => c.load_factor === load).length;
  const most = Math.max(1, ...names.flatMap((name) => loads.map((load) => count(name, load))));
  const [drawing, width, height] = frame(sheet, "Number of cycles by load", names.map((name) => mark(runColour(name), name[0].toUpperCase() + name.slice(1), ".filled")));
  const left = 46, right = 16, top = 12, bottom = 34, slot = (width - left - right) / Math.max(1, loads.length);
  const py = (v) => height - bottom - (v / (most * 1.08)) * (height - top - bottom);
  axis(drawing, ticks(0, most * 1.08, Math.max(2, height / 50)).filter(Number.isInteger).map((v) => [v, number(v)]), py, { across: true, from: left, to: width - right, text: left - 8 });
  loads.forEach((load, i) => {
    drawing.append(svg("text", { x: left + (i + 0.5) * slot, y: height - bottom + 17, "text-anchor": "middle" }, `${Math.round(100 * load)} %`));
    names.forEach((name, k) => {
      const bar = Math.min(34, (slot * 0.7) / names.length), value = count(name, load);
      const rect = svg("rect", { x: left + (i + 0.5) * slot + (k - names.length / 2) * bar, y: py(value), width: bar - 1, height: height - bottom - py(value), style: `fill: var(${runColour(name)})` });
      rect.append(svg("title", {}, `${name}: ${value} cycles with ${Math.round(100 * load)} % of a full load`));
      drawing.append(rect);
    });
  });
  return "Cycles by share of a full load";
}

const COLUMNS = [["Cycle", (c) => String(c.cycle)], ["Loading from", (c) => time(seconds(c.start)), true], ["Load", (c) => `${Math.round(100 * c.load_factor)} %`], ["Volume, m³", (c) => number(c.volume_m3)], ["Out, h", (c) => number(c.full_h, 2)], ["Waits, h", (c) => (c.full_waiting_h + c.empty_waiting_h >= 0.005 ? number(c.full_waiting_h + c.empty_waiting_h, 2) : "")], ["Least clearance, m", (c) => number(c.full_least_clearance_m, 2)], ["Back, h", (c) => number(c.empty_h, 2)], ["m³/h", (c) => number(c.production_m3_h)], ["Speed, kn", (c) => number(c.mean_speed_kn, 1)], ["Fuel, t", (c) => number(c.fuel_t, 2)]];

export function showCycles(sheet, runs, chosen, choose) {
  const rows = Object.entries(runs).flatMap(([name, run]) => run.cycles.map((cycle, i) => h("tr", { onclick: () => choose(name, i), "aria-current": chosen?.name === name && chosen?.i === i ? "true" : null }, h("td", {}, h("button.link", { type: "button" }, name)), COLUMNS.map(([, text, left]) => h(left ? "td.text" : "td", {}, text(cycle))))));
  fill(sheet, h("div.table", { tabindex: 0 }, h("table", {}, h("caption.hidden", {}, "Cycles of the project, times in UTC"), h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Run"), COLUMNS.map(([name, , left]) => h(left ? "th.text" : "th", { scope: "col" }, name)))), h("tbody", {}, rows))));
  return "Choose a cycle to see its routes on the chart";
}

