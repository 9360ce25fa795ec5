// What limits a route: each limit with its worst value, and where the route is near it.

import { h } from "../common/elements.js";
import { duration, known, number, seconds, time } from "../common/format.js";
import { selection } from "../common/selection.js";

// name: words, unit, decimals, and the curve of the profile that it limits
const LIMITS = {
  wave_height_m: ["Waves", "m", 1, "wave_height_m"],
  wind_speed_kn: ["Wind", "kn", 0, "wind_speed_kn"],
  under_keel_clearance_m: ["Under-keel clearance", "m", 1, "under_keel_clearance_m"],
  land_distance_nm: ["Distance from land", "nm", 1, null],
  ordered_speed_kn: ["Ordered speed", "kn", 1, null],
};
const WEATHER = ["wave_height_m", "wind_speed_kn"];
const ALWAYS = "ordered_speed_kn"; // the engine limits most voyages: it is no caution

// The limit of a curve of the profile; null where none is known.
export const limitOf = (met, curve) => met?.find(({ name }) => LIMITS[name]?.[3] === curve)?.limit ?? null;

// Stretches of time [s, s] in which a route is near a limit of sea or chart.
export const nearLimits = (met) => (met || []).filter(({ name }) => name !== ALWAYS).flatMap(({ near }) => near);

// The parts of a route [[lon, lat], ...] in these stretches.
export function nearParts(met, profile) {
  const { time: times, lat, lon } = profile;
  return nearLimits(met).map(([from, to]) => {
    const first = Math.max(0, times.findIndex((t) => t >= from) - 1), end = times.findIndex((t) => t > to);
    const last = Math.max(first + 1, end < 0 ? times.length - 1 : end);
    return lon.slice(first, last + 1).map((x, k) => [x, lat[first + k]]);
  }).filter((points) => points.length > 1);
}

// Each limit in a few words, such as "Waves 4.9 of 8.0 m".
export const limitTexts = (met) => met.filter(({ name }) => LIMITS[name] && name !== ALWAYS).map((one) => {
  const [label, unit, decimals] = LIMITS[one.name];
  return `${label} ${number(one.worst, decimals)} of ${number(one.limit, decimals)} ${unit} on ${time(one.time)}`;
});

function words(one) {
  if (one.name === ALWAYS) return one.near_h > 0 ? `the highest of the ship for ${duration(one.near_h)}` : "at most the highest of the ship";
  if (!one.near.length) return `${one.worst < one.limit ? "highest" : "least"} on ${time(one.time)}`;
  const [[from]] = one.near, often = one.near.length > 1 ? `, ${one.near.length} times` : "";
  return `near its limit for ${duration(Math.max(one.near_h, 1 / 60))}${often}, first on ${time(from)}`;
}

/**
 * The block of a result.
 * @param {object[]|null} met limits of the chosen route
 * @param {object} route
 * @param {object|null} voyage
 * @param {string[]} refused what was refused, in words
 * @param {boolean} calm whether the sea was assumed to be calm: its limits say nothing
 */
export function limitsBlock(met, route, voyage, refused, calm) {
  const rows = (met || []).filter(({ name }) => LIMITS[name] && !(calm && WEATHER.includes(name))).map((one) => {
    const [label, unit, decimals] = LIMITS[one.name], near = one.near.length > 0 && one.name !== ALWAYS;
    return h("li", {}, h("button", { type: "button", title: "Show the place", onclick: () => selection.at(one.time) }, h("span", {}, near ? h("span.near", {}, "◆ ") : null, label, h("small", {}, words(one))), h("span", {}, number(one.worst, decimals), h("span.unit", {}, ` of ${number(one.limit, decimals)} ${unit}`))));
  });
  const latest = seconds(voyage?.arrive_by ?? null), arrive = seconds(route.arrive ?? null);
  if (known(latest) && known(arrive)) rows.push(h("li.still", {}, h("span", {}, "Arrival", h("small", {}, `by ${time(latest)}`)), h("span", {}, latest >= arrive ? `${duration((latest - arrive) / 3600)} to spare` : `${duration((arrive - latest) / 3600)} late`)));
  if (!rows.length && !refused.length) return null;
  const marked = nearLimits(met).length ? h("p.facts", {}, h("span.near", {}, "◆ "), "within 5 % of the limit, or 0.1 m of the clearance: amber on the chart and the profile. Port approaches and canals are not looked at.") : null;
  return h("div.block", {}, h("h2", {}, "What limits this route"), rows.length ? h("ul.limits", {}, rows) : null, marked,
    refused.length ? h("details.refused", {}, h("summary", {}, "What was refused"), h("ul.list", {}, refused.map((text) => h("li", {}, text)))) : null);
}
