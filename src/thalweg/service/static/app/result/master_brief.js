// The brief for the master, on paper: ship, times, figures, weather, waypoints and warnings of the chosen route.

import { h } from "../common/elements.js";
import { faultWords } from "../common/faults.js";
import { bearing, duration, isCalm, known, number, position, readable, seconds, time } from "../common/format.js";
import { pricesText } from "../common/prices.js";
import { limitTexts } from "./limits_met.js";
import { costOf, OBJECTIVES } from "./result_view.js";

const utc = (t) => `${time(t, true)} UTC`;
const measure = (value, decimals, unit) => (known(value) ? `${number(value, decimals)} ${unit}` : "unknown");

// The largest (or least) value of a column of a profile, with when and where it is.
function extreme(profile, column, least = false) {
  const values = profile[column] || [];
  let at = -1;
  values.forEach((value, i) => { if (known(value) && (at < 0 || (least ? value < values[at] : value > values[at]))) at = i; });
  return at < 0 ? null : { value: values[at], place: `${utc(profile.time[at])}, ${position(profile.lat[at], profile.lon[at])}` };
}

// Those that apply to the route with its worst values; where these are not known, those of the request and the ship file.
function limitsOf({ limits, voyage }, sheet, met) {
  if (met?.length) return limitTexts(met).join("; ");
  const { wave_height_m: waves, wind_speed_m_s: wind } = sheet?.limits || {};
  const rows = [["waves", limits?.wave_height_m ?? waves, "m"], ["wind", limits?.wind_speed_kn ?? (known(wind) ? (wind * 3600) / 1852 : null), "kn"], ["under-keel clearance at least", voyage?.min_ukc_m, "m"], ["distance from land at least", voyage?.offing_nm, "nm"]];
  return rows.filter(([, value]) => known(value)).map(([name, value, unit]) => `${name} ${number(value, 1)} ${unit}`).join("; ") || "none are stated";
}

function weatherRows(result, profile, seas, run) {
  if (isCalm(result.job.request)) return [["Weather", "calm sea assumed: no weather data were used"]];
  const worst = (name, column, decimals, unit) => { const found = extreme(profile, column); return [name, found ? [h("b", {}, `${number(found.value, decimals)} ${unit}`), ` ${found.place}`] : "not in the data"]; };
  return [worst("Highest waves", "wave_height_m", 1, "m"), worst("Strongest wind", "wind_speed_kn", 0, "kn"),
    ["Weather data", `${seas.join(", ")}${known(run) ? `; forecast of ${utc(run)}, ${duration(Math.max(0, Date.now() / 1000 - run) / 3600)} old when printed` : ""}`]];
}

function clearance(route, profile) {
  if (!known(route.min_ukc_m)) return "not checked: no depth in the data";
  const found = extreme(profile, "under_keel_clearance_m", true);
  return [h("b", {}, `${number(route.min_ukc_m, 1)} m`), found ? ` ${found.place}` : ""];
}

const list = (rows) => h("dl", {}, rows.map(([name, value]) => h("div", {}, h("dt", {}, name), h("dd", {}, value))));

/**
 * @param {object} result of the page, with its sheet of the ship
 * @param {number} chosen number of the route, from 0
 * @param {object} profile of this route
 * @param {{shipName: string, seas: string[], run: number|null}} facts
 * @returns {[Element, Element]} what stands before and after the chart
 */
export function masterBrief(result, chosen, profile, { shipName, seas, run }) {
  const { plan, job, sheet } = result, route = plan.routes[chosen], { from, to } = plan.provenance, { request } = job;
  const ends = to ? readable(`${from} to ${to}`) : job.title;
  const orders = route.waypoints.map((w) => w.ordered_speed_kn).filter(known);
  const range = orders.length ? [...new Set([Math.min(...orders), Math.max(...orders)].map((v) => number(v, 1)))].join(" to ") : "";
  const eca = known(route.fuel_eca_t) && route.fuel_eca_t > 0 ? `, of it ${number(route.fuel_eca_t, 1)} t in emission control areas` : "";
  const objective = plan.voyage ? OBJECTIVES[plan.objective] : "given route";
  const head = h("section.brief-page", { "aria-label": "Brief for the master" },
    h("header", {}, h("div", {}, h("h1", {}, ends), h("p", {}, `Voyage plan · ${objective}${plan.routes.length > 1 ? ` · route ${chosen + 1} of ${plan.routes.length}` : ""}`)), h("p.brief-caution", {}, "Not for navigation")),
    route.feasible ? null : h("p.brief-broken", {}, `This route ${faultWords(route.violations)}.`),
    plan.ensemble?.[chosen]?.infeasible?.length ? h("p.brief-broken", {}, `In ${plan.ensemble[chosen].infeasible.length} of ${plan.ensemble[chosen].members} members of the forecast this route cannot be sailed within the limits.`) : null,
    h("div.brief-columns", {},
      list([["Ship", h("b", {}, shipName)], ["Draught", `${measure(sheet?.draught_m, 1, "m")}${known(request.load_factor) ? `, load ${number(100 * request.load_factor)} %` : ""}`], ["Departure", h("b", {}, utc(seconds(route.depart)))], ["Arrival", h("b", {}, utc(seconds(route.arrive)))], ["Time", `${duration(route.time_h)}${route.waiting_h > 0 ? `, of it ${duration(route.waiting_h)} waiting` : ""}`]]),
      list([["Distance", h("b", {}, measure(route.distance_nm, 1, "nm"))], ["Speed", `${known(route.time_h) ? `${number(route.distance_nm / route.time_h, 1)} kn mean over ground` : "unknown"}${range ? `; ${range} kn ordered` : ""}`], ["Fuel", `${measure(route.fuel_t, 1, "t")}${eca}`], ["Cost", measure(costOf(route), 0, route.currency)], ["CO₂", measure(route.co2_t, 0, "t")]])),
    list([...weatherRows(result, profile, seas, run), ["Least under-keel clearance", clearance(route, profile)], ["Limits", limitsOf(request, sheet, result.limits?.routes[chosen])], ...(known(costOf(route)) ? [[`Prices, ${route.currency}`, pricesText(route.prices)]] : [])]));
  return [head, h("section.brief-page", { "aria-label": "Waypoints and warnings" }, waypointTable(route, isCalm(request)), notesOf(plan, route, job),
    h("p.brief-sign", {}, h("span", {}, "Checked by"), h("span", {}, "Master"), h("span", {}, "Date")),
    h("p.brief-foot", {}, `Printed ${utc(Date.now() / 1000)} by Thalweg, plan ${job.number}. All times are UTC. Check the route against official charts, notices to mariners and the rules of the company before use: it is not for navigation.`))];
}

function waypointTable(route, calm) {
  const { waypoints } = route, there = (name) => waypoints.some((w) => known(w[name]));
  const leg = (i) => (waypoints[i + 1] ? number(waypoints[i + 1].distance_nm - waypoints[i].distance_nm, 1) : "");
  const value = (v, decimals) => (known(v) ? number(v, decimals) : "–");
  const last = waypoints.length - 1;
  const remark = (w) => [{ approach: "approach", canal: "canal" }[w.leg_kind], w.waiting_h > 0 ? `waits ${duration(w.waiting_h)}` : ""].filter(Boolean).join(", ");
  const columns = [["No.", (w, i) => String(i + 1)], ["Position", (w) => position(w.lat, w.lon), true], ["ETA, UTC", (w) => time(seconds(w.time)), true], ["Course", (w, i) => (i === last ? "" : bearing(w.course_deg))], ["Leg nm", (w, i) => leg(i)], ["Sum nm", (w) => number(w.distance_nm, 1)], ["Order kn", (w, i) => (i === last ? "" : value(w.ordered_speed_kn, 1))], ["Ground kn", (w, i) => (i === last ? "" : value(w.speed_over_ground_kn, 1))],
    ...(calm ? [] : [["Waves m", (w) => value(w.wave_height_m, 1)], ["Wind kn, from", (w) => (known(w.wind_speed_kn) ? `${number(w.wind_speed_kn)}${known(w.wind_from_deg) ? `, ${bearing(w.wind_from_deg)}` : ""}` : "–")]]),
    ...(there("ukc_m") ? [["UKC m", (w, i) => (i === last ? "" : value(w.ukc_m, 1))]] : []), ...(waypoints.some((w) => remark(w)) ? [["Remarks", (w, i) => (i === last ? "" : remark(w)), true]] : [])];
  return h("div", {}, h("h2", {}, "Waypoints"), h("p", {}, "Course, leg, speeds, clearance and remarks are those of the leg that begins at the waypoint. The order is the speed that the engine gives in calm water; along approaches of ports the speed over ground is fixed."),
    h("table", {}, h("thead", {}, h("tr", {}, columns.map(([name, , left]) => h(left ? "th.text" : "th", { scope: "col" }, name)))), h("tbody", {}, waypoints.map((w, i) => h("tr", {}, columns.map(([, text, left]) => h(left ? "td.text" : "td", {}, text(w, i))))))));
}

function notesOf(plan, route, job) {
  const notes = [...new Set([...plan.notes, ...(route.assumptions || [])])], quality = plan.voyage && !plan.front ? job.summary.quality : "";
  return h("div", {}, h("h2", {}, "Warnings, and what was assumed"), h("ul", {}, [...notes, quality ? `Quality of the route: ${quality}.` : ""].filter(Boolean).map((text) => h("li", {}, readable(text)))));
}
