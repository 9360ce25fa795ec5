// What the chart shows, as tables: weather, depth, ports, control areas, canals, isochrones.

import { SheetTabs } from "../batch/sheet_tabs.js";
import { fill, h } from "../common/elements.js";
import { bearing, known, number, position, time } from "../common/format.js";
import { KINDS } from "./weather_layer.js";

const ROWS = 7, COLUMNS = 8, KNOT = 1852 / 3600;
const FROM = { waves: "from", wind: "from", current: "to" }; // how a direction of the field is named

function table(caption, heads, rows, none) {
  if (!rows.length) return h("p.empty", {}, h("b", {}, none), "Move the chart, or choose other layers.");
  return h("div.table", { tabindex: 0, role: "region", "aria-label": caption }, h("table", {}, h("caption.hidden", {}, caption),
    h("thead", {}, h("tr", {}, heads.map((text, i) => h(i ? "th" : "th.text", { scope: "col" }, text)))),
    h("tbody", {}, rows.map((row) => h("tr", {}, row.map((text, i) => h(i ? "td" : "th.text", i ? {} : { scope: "row" }, text)))))));
}

const span = (a, b, count) => Array.from({ length: count }, (_, i) => a + ((i + 0.5) / count) * (b - a));
const turned = (lon) => ((((lon + 180) % 360) + 360) % 360) - 180;
const inside = ([w, s, e, n], lon, lat) => lat > s && lat < n && ((((lon - w) % 360) + 360) % 360) < e - w;

/**
 * The tables of the part of the chart that is seen.
 * @param {Chart} chart
 * @param {{isochrones: object|null, routes: {name: string, points: number[][]}[]}} shown
 * @param {() => void} close
 */
export function chartTables(chart, { isochrones, routes }, close) {
  const { view } = chart;
  const field = (layer) => (sheet) => {
    const { title, unit } = KINDS[layer.kind];
    const lats = span(view[3], view[1], ROWS), lons = span(view[0], view[2], COLUMNS);
    const cell = (lat, lon) => { const found = fieldValue(layer.kind, layer.fieldsAt(lon, lat)); return !found ? "–" : known(found.value) ? `${number(found.value, layer.kind === "depth" ? 0 : 1)}${known(found.direction) ? ` ${bearing(found.direction)}` : ""}` : "no data"; };
    fill(sheet, table(`${title} on the chart`, ["Latitude", ...lons.map((lon) => position(0, lon).split(" ")[1])], lats.map((lat) => [position(lat, 0).split(" ")[0], ...lons.map((lon) => cell(lat, lon))]), "Nothing is drawn"));
    const way = FROM[layer.kind] ? `, direction ${FROM[layer.kind]}` : "";
    return `${title}${unit ? `, ${unit}` : ""}${way}${layer.still ? "" : ` · ${time(layer.time, true)} UTC`}`;
  };
  const list = (caption, heads, rows, none) => (sheet) => { fill(sheet, table(caption, heads, rows, none)); return `${number(rows.length)} in view`; };
  const ports = chart.ports.getSource().getFeatures().map((feature) => feature.get("port")).filter((port) => inside(view, port.lon, port.lat)).sort((a, b) => b.importance - a.importance);
  const { control_areas: areas, canals } = chart.content;
  const box = (points) => { const lons = points.map((p) => p[0]), lats = points.map((p) => p[1]); return `${position(Math.min(...lats), Math.min(...lons))} to ${position(Math.max(...lats), Math.max(...lons))}`; };
  const parts = [
    ...(chart.weather.kind ? [["weather", "Weather", field(chart.weather)]] : []),
    ...(chart.depths.kind ? [["depth", "Depth", field(chart.depths)]] : []),
    ...(routes.length ? [["routes", "Routes", list("Points of the routes", ["Route", "Position"], routes.flatMap(({ name, points }) => points.map(([lon, lat]) => [name, position(lat, turned(lon))])), "No routes")]] : []),
    ...(isochrones ? [["isochrones", "Isochrones", list("Isochrones: reached after", ["Hours", "Between"], isochrones.lines.map(({ hours, points }) => [number(hours), box(points)]), "No isochrones")]] : []),
    ["ports", "Ports", list("Ports in view", ["Port", "UN/LOCODE", "Position"], ports.map((port) => [port.label, port.locode || "", position(port.lat, port.lon)]), "No port in view")],
    ["areas", "Control areas", list("Emission control areas", ["Area", "Between"], areas.map((area) => [area.title, box(area.rings.flat())]), "No areas")],
    ["canals", "Canals", list("Canals", ["Canal", "Passage, h", "Dues, USD", "From", "To"], canals.map((canal) => [canal.title, number(canal.hours, 1), known(canal.fee_usd) ? number(canal.fee_usd) : "not known", ...[canal.path[0], canal.path.at(-1)].map(([lon, lat]) => position(lat, lon))]), "No canals")],
  ];
  const tabs = new SheetTabs("What the chart shows", parts);
  tabs.list.after(h("button.quiet.small", { type: "button", onclick: close }, "Close"));
  return tabs;
}

/**
 * Value and direction [deg] of a field at a place; null outside of what is loaded.
 * @param {string} kind of the field
 * @param {number[]} parts its fields as a frame holds them
 */
function fieldValue(kind, parts) {
  if (!parts) return null;
  const vector = kind === "wind" || kind === "current", [east, north] = vector ? parts : parts.slice(1);
  const value = vector ? Math.hypot(east, north) / KNOT : parts[0];
  const known_ = KINDS[kind].marks && Number.isFinite(east) && Math.hypot(east, north) > 1e-6;
  const to = known_ ? (Math.atan2(east, north) * 180) / Math.PI : NaN;
  return { value, direction: known_ ? (to + (FROM[kind] === "from" ? 540 : 360)) % 360 : null };
}
