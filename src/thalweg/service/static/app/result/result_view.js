// The result of a plan or an evaluation: key figures, proof, warnings, exports.

import { fileAddress, get, resultAddress } from "../common/api.js";
import { durationParts, fill, h, longList, REASONS, unit } from "../common/elements.js";
import { faultWords, remedyOf } from "../common/faults.js";
import { WeatherIgnored } from "./weather_ignored.js";
import { limitsBlock } from "./limits_met.js";
import { indicatorTable } from "../form/indicators.js";
import { duration, isCalm, known, number, position, readable, seconds, signed, time, titleOf } from "../common/format.js";
import { pricesText } from "../common/prices.js";
import { selection } from "../common/selection.js";

export const OBJECTIVES = { time: "least time", distance: "shortest distance", fuel: "least fuel", energy: "least energy", cost: "least cost", comfort: "least motion sickness", co2: "least CO₂", encounters: "fewest encounters", inshore: "least length near land", weighted: "a weighted sum", front: "all trade-offs", alternatives: "routes that differ" };
export async function loadResult(job) {
  const raw = await get(`/plans/${job.id}/result`);
  const evaluated = () => ({ routes: [raw], notes: raw.assumptions || [], rejections: {}, voyage: null, provenance: {} });
  const plan = { plan: () => raw, alternatives: () => ({ ...raw, routes: raw.alternatives.map((one) => one.route), rejections: {}, objective: "alternatives" }) }[job.kind]?.() || evaluated();
  const optional = (part) => get(`/plans/${job.id}/${part}.json`).catch(() => null);
  const parts = job.summary.parts || [];
  const [isochrones, beside, spaceTime, limits] = await Promise.all(["isochrones", "beside", "space_time", "limits"].map((part) => (parts.includes(part) ? optional(part) : null)));
  const sheet = job.request.ship ? await get(`/ships/${encodeURIComponent(job.request.ship)}`).catch(() => null) : null;
  return { job, plan, sheet, isochrones, beside, spaceTime, limits, front: plan.front || null, profiles: new Map() };
}

export async function profileOf(result, number_) {
  if (!result.profiles.has(number_)) result.profiles.set(number_, await get(`/plans/${result.job.id}/profiles/${number_ + 1}`));
  return result.profiles.get(number_);
}

export function costOf(route) {
  return route[`cost_${(route.currency || "usd").toLowerCase()}`];
}

const worst = (profile, column) => { const values = (profile?.[column] || []).filter(known); return values.length ? Math.max(...values) : null; };

export class ResultView {
  constructor(result, handlers) {
    this.result = result;
    this.handlers = handlers;
    this.body = h("div.scroll");
    this.element = [this.body, h("div.foot", {}, h("button.primary", { type: "button", onclick: handlers.change }, "Change the voyage"), h("button.quiet", { type: "button", onclick: handlers.compare, title: "Compare (c)" }, "Compare"))];
  }

  show(profile) {
    const { job, plan, beside } = this.result;
    const route = plan.routes[selection.route];
    const top = this.body.scrollTop;
    const { from, to } = plan.provenance;
    const inList = this.body.querySelector(".routes")?.contains(document.activeElement);
    fill(this.body,
      h("h1", {}, titleOf(job)),
      h("p.lead", {}, `${plan.voyage ? OBJECTIVES[plan.objective] : "given route"} · ${this.handlers.shipName(job.request.ship)}`),
      h("p.lead", {}, to ? readable(`${from} to ${to}, leaves `) : "Leaves ", h("b", {}, time(seconds(route.depart), true)), " UTC"),
      plan.cancelled ? h("p.note", {}, "Stopped: this is the best found so far.") : null,
      this.#faults(route),
      this.#faultsOfMembers(plan),
      this.#cards(route, profile, beside),
      plan.voyage && !plan.alternatives ? this.#proof(plan) : null,
      plan.alternatives ? this.#alternatives(plan) : plan.routes.length > 1 ? this.#routes(plan) : null,
      limitsBlock(this.result.limits?.routes[selection.route], route, plan.voyage, Object.entries(plan.rejections).map(([reason, count]) => `${number(count)} ${REASONS[reason] || reason}`), isCalm(job.request)),
      this.#indicators(plan),
      this.#notes(plan, route),
      this.#exports(job, route));
    this.body.scrollTop = top;
    const list = this.body.querySelector(".routes"), pressed = list?.querySelector("[aria-pressed=true]");
    if (pressed) list.scrollTop = pressed.offsetTop - list.clientHeight / 2;
    if (inList) this.body.querySelector(".routes [aria-pressed=true]").focus({ preventScroll: true });
  }

  // Without numbers of legs: those of the referee are not those of the table.
  #faults(route) {
    if (route.feasible) return null;
    const row = (one) => h("li", {}, `${one.reason.replace(/: leg \d+$/, "")} at ${position(one.lat, one.lon)}${one.time ? `, ${time(seconds(one.time))}` : ""}${known(one.value) && known(one.limit) ? `: ${number(one.value, 1)}, limit ${number(one.limit, 1)}` : ""}`);
    const { violations } = route;
    return h("div.error", { role: "alert" }, h("b", {}, `This route ${faultWords(violations)}.`), longList(violations.map(row), 6),
      h("span.remedy", {}, `The rings on the chart show where.${remedyOf(violations)}`));
  }

  // Of an ensemble the figures are those of one member: where others break a limit, that comes first.
  #faultsOfMembers(plan) {
    const row = plan.ensemble?.[selection.route];
    if (!row?.infeasible?.length) return null;
    return h("div.error", { role: "alert" }, h("b", {}, `In ${row.infeasible.length} of ${row.members} members of the forecast (${row.infeasible.join(", ")}) this route cannot be sailed within the limits.`),
      h("span.remedy", {}, ` First: ${row.first_reason}.`));
  }

  // Time over the members of an ensemble, and the highest waves of the worst one.
  #members(plan) {
    const row = plan.ensemble?.[selection.route];
    if (!row) return null;
    const kept = row.members - row.infeasible.length, spread = row.time_h;
    const highest = Math.max(...(row.highest_waves_m || []).filter(known));
    const words = [`the figures are those of member ${row.shown_member}`, spread ? `time ${duration(spread.p10)} to ${duration(spread.p90)} (10 and 90 %)` : "", Number.isFinite(highest) ? `waves of up to ${number(highest, 1)} m` : ""];
    return h("div.card.wide", {}, h("dt", {}, "Members of the forecast"), h("dd", {}, `${kept} of ${row.members} keep the limits`, h("small", {}, words.filter(Boolean).join("; "))));
  }

  #cards(route, profile, beside) {
    const card = (name, value, unitText, more) => h("div.card", {}, h("dt", {}, name), h("dd", {}, value, unitText && value !== "unknown" ? unit(unitText) : null, more ? h("small", {}, more) : null));
    const ignored = new WeatherIgnored(this.result.plan, route, beside);
    const cost = costOf(route), other = beside ? costOf(beside) : null;
    const waves = worst(profile, "wave_height_m"), wind = worst(profile, "wind_speed_kn");
    const besideWaves = worst(beside?.profile, "wave_height_m"), calm = isCalm(this.result.job.request);
    const assumed = card("Waves and wind", "calm", null, "assumed: no weather data");
    if (!known(route.min_ukc_m)) assumed.classList.add("wide");
    return h("dl.cards", {},
      card("Time", durationParts(route.time_h), null, ignored.time()),
      card("Arrival, UTC", time(seconds(route.arrive)), null, known(route.waiting_h) && route.waiting_h > 0 ? `waits ${duration(route.waiting_h)}` : null),
      card("Fuel", number(route.fuel_t, 1), "t", ignored.amount(route.fuel_t, beside?.fuel_t, (d) => `${signed(d)} t`)),
      card("Cost", number(cost), route.currency, ignored.amount(cost, other, (d) => `${signed(d, 0)}`)),
      known(cost) ? h("div.card.wide.prices", {}, h("dt", {}, `Prices, ${route.currency}`), h("dd", {}, pricesText(route.prices))) : null,
      card("Distance", number(route.distance_nm, 1), "nm", known(route.time_h) ? `mean ${number(route.distance_nm / route.time_h, 1)} kn` : null),
      card("CO₂", number(route.co2_t, 0), "t"),
      calm ? assumed : card("Highest waves", number(waves, 1), "m", known(besideWaves) && known(waves) ? `weather ignored: ${number(besideWaves, 1)} m` : known(waves) ? null : "no waves in the data"),
      known(route.min_ukc_m) ? card("Least under-keel clearance", number(route.min_ukc_m, 1), "m") : calm ? null : card("Strongest wind", number(wind), "kn", known(wind) ? null : "no wind in the data"),
      ignored.card(),
      this.#members(this.result.plan),
      this.#comfort(route, card));
  }

  // Where people are, for ships whose file names places: how many are sick at the end.
  #comfort(route, card) {
    const rows = Object.entries(route.indicators?.places || {}).filter(([, row]) => known(row.sick_percent));
    const cards = rows.map(([name, row]) => card(`Sick, ${name}`, number(row.sick_percent, 0), "% of people", known(row.worst_hour_percent) ? `worst hour ${number(row.worst_hour_percent, 0)} %` : null));
    if (cards.length % 2) cards.at(-1).classList.add("wide");
    return cards;
  }

  #proof(plan) {
    const point = plan.front?.points[selection.route];
    const found = plan.front ? point?.gap : plan.gap, gap = found < 1 ? found : null; // at 1 the bound is zero: none
    const quality = this.result.job.summary.quality || "";
    const said = plan.front ? (known(gap) ? `At most ${number(Math.ceil(1000 * gap) / 10, 1)} % less ${plan.front.criterion} is possible at its time` : "No bound is known for this route") : quality ? quality[0].toUpperCase() + quality.slice(1) : "No bound is known";
    const kind = plan.lower_bound_kind[0].toUpperCase() + plan.lower_bound_kind.slice(1);
    const bar = h("i");
    bar.style.width = `${known(gap) ? Math.max(2, 100 * (1 - gap)) : 0}%`;
    return h("div.proof", {}, h("b", {}, said), h("div.gauge", { role: "img", "aria-label": said }, bar),
      h("details", {}, h("summary", {}, "How this is known"), h("ul.list", {},
        known(plan.lower_bound) ? h("li", {}, `${plan.front ? (plan.objective === "front" ? "No route takes less than" : "No route of any time has less than") : "No route is better than"} ${number(plan.lower_bound, 1)} ${plan.objective_unit}. ${kind}.`) : h("li", {}, `${kind}.`),
        known(point?.joint_gap) && point.joint_gap < 1 ? h("li", {}, `No route is ${number(Math.ceil(1000 * point.joint_gap) / 10, 1)} % better in both time and ${plan.front.criterion}.`) : null,
        h("li", {}, "The bound does not count penalty areas, shoals and traffic lanes: where these make the way longer, even less improvement is possible."),
        h("li", {}, "Every figure comes from sailing the route again in small steps."))));
  }

  #routes(plan) {
    const { front } = plan;
    const best = plan.objective in OBJECTIVES && plan.objective !== "front" ? OBJECTIVES[plan.objective] : null; // of the first route
    const row = (route, i) => h("li", {}, h("button", {
      type: "button", "aria-pressed": String(i === selection.route), onclick: () => selection.choose(i), onpointerenter: () => selection.hover(i), onpointerleave: () => selection.hover(null),
    }, h("span.swatch"), h("span", {}, duration(route.time_h), front && front.points[i]?.way !== "open sea" ? h("small.unit", {}, ` ${front.points[i]?.way}`) : null, h("small", {}, `route ${i + 1}${best && !i ? `, ${best}` : ""}`)), h("span", {}, number(route.fuel_t, 1), unit("t")), h("span", {}, known(costOf(route)) ? [number(costOf(route)), unit(route.currency)] : "")));
    return h("div.block.no-print", {}, h("h2", {}, best ? `${plan.routes.length} routes, that of ${best} first` : `${plan.routes.length} routes, fastest first`), h("ol.routes", {}, plan.routes.map(row)));
  }

  // Routes that differ: what each is best in, and how it differs from the fastest.
  #alternatives(plan) {
    return h("div.block", {}, h("h2", {}, plan.routes.length > 1 ? `${plan.routes.length} routes that differ, fastest first` : "No other route is better in anything"), h("ol.routes.named", {}, plan.alternatives.map((one, i) => h("li", {}, h("button", {
      type: "button", "aria-pressed": String(i === selection.route), onclick: () => selection.choose(i), onpointerenter: () => selection.hover(i), onpointerleave: () => selection.hover(null),
    }, h("span.swatch"), h("span", {}, h("b", {}, `${i + 1}. ${one.name[0].toUpperCase()}${one.name.slice(1)}`), one.best_in.length ? h("small", {}, one.best_in.join(", ")) : null, i ? h("small", {}, one.difference.replace(/(^|[\s(])-(?=\d)/g, "$1−")) : null), h("span", {}, duration(one.route.time_h)))))));
  }

  // All figures of the route, beside those of up to five others.
  #indicators(plan) {
    const few = plan.routes.length <= 5, routes = few ? plan.routes : [plan.routes[selection.route]];
    const titles = routes.map((route, i) => plan.alternatives?.[i].name || `Route ${i + 1}`);
    this.open ??= Boolean(plan.alternatives);
    const details = h("details", { open: this.open }, h("summary", {}, "Key figures", h("span.set", {}, few && routes.length > 1 ? "of all routes" : "")), h("div.inside", {}, indicatorTable(routes, few ? selection.route : 0, titles)));
    details.addEventListener("toggle", () => { this.open = details.open; });
    return h("div.block", {}, details);
  }

  #notes(plan, route) {
    const notes = [...new Set([...plan.notes, ...(route.assumptions || [])])];
    if (!notes.length) return null;
    return h("div.block.plain", {}, h("h2", {}, "What was assumed, and warnings"), longList(notes.map((text) => h("li", {}, readable(text))), 3));
  }

  #exports(job, route) {
    const number_ = selection.route + 1;
    return h("div.block.take-along", {}, h("h2", {}, "Take it along"), h("div.exports", {},
      ["rtz", "rtzp", "gml", "gpx", "geojson", "kml", "csv"].map((form) => h("a.quiet.small", { href: fileAddress(job.id, number_, form), download: "" }, { gml: "S-421", geojson: "GeoJSON" }[form] || form.toUpperCase())),
      job.kind === "plan" ? h("a.quiet.small", { href: resultAddress(job.id), download: "plan.json" }, "plan.json") : job.kind === "alternatives" ? h("a.quiet.small", { href: resultAddress(job.id), download: "alternatives.json" }, "alternatives.json") : null,
      h("button.quiet.small", { type: "button", onclick: this.handlers.print }, "Print a brief"),
      h("button.quiet.small", { type: "button", onclick: this.handlers.link }, "Copy link")),
    h("p.facts", {}, `Route ${number_}. Route files have waypoints of their own: great circles as short rhumb lines, and none where the course does not change. Their numbers are not those of the table of legs. Check the route against official charts and notices before use.`));
  }
}
