// Studies: the voyage of the plan form over departures, speeds and ships, as a heat map.

import { get, resultAddress, tableAddress } from "../common/api.js";
import { announce, errorBox, fill, h, longList, withUnit } from "../common/elements.js";
import { days, duration, inputTime, known, number, readable, seconds, time } from "../common/format.js";
import { jobFoot } from "../result/progress_view.js";
import { BatchView } from "./batch_view.js";
import { HeatMap, quantile } from "./heat_map.js";
import { typedTime } from "../common/typed_time.js";

const SECONDS_EACH = 10; // of an ocean voyage on a usual computer, about
const TAKEN = ["fill", "load_factor", "sampling", "coast", "network", "resolution_nm"]; // of the request, beside its voyage
const NOT_TAKEN = { limits: "limits of weather", areas: "areas", depths: "depth files", charges: "charges", eca: "control areas left out", traffic: "traffic", history: "the history network", average_over_m: "the depth of currents", route_files: "route files", proof_s: "the time for the proof" };
const WORDS = { path: "/studies", earlier: "Earlier studies", stopped: "The study was stopped before a voyage was planned." };

export class StudyView extends BatchView {
  // handlers also: plan(), ends(voyage), voyage(request)
  constructor(form, handlers) {
    super("study", WORDS, handlers);
    this.plans = form;
    this.from = h("input", { type: "text", id: "s-from", autocomplete: "off", placeholder: "2026-01-01 00:00", oninput: () => this.#count() });
    this.to = h("input", { type: "text", id: "s-to", autocomplete: "off", placeholder: "2026-12-31 00:00", oninput: () => this.#count() });
    this.step = h("input", { type: "text", inputmode: "decimal", id: "s-step", value: "12", oninput: () => this.#count() });
    this.speeds = h("input", { type: "text", id: "s-speeds", autocomplete: "off", placeholder: "12, 13, 14", oninput: () => this.#count() });
    this.ships = h("div");
    this.blind = h("input", { type: "checkbox", id: "s-blind" });
    this.title = h("input", { type: "text", id: "s-title", maxlength: 200 });
    this.counted = h("p.facts", { role: "status" });
    this.voyage = h("div");
    this.ready = h("div");
    this.file = h("input.hidden", { type: "file", id: "study-file", "aria-label": "Study file", accept: ".yaml,.yml,.json", tabindex: "-1", onchange: () => this.#open() });
    const field = (name, label, input, more = null) => h("div.field", { "data-field": name }, h("label.label", { for: input.id || input.firstChild.id }, label), input, more, h("div.slot"));
    this.element = h("form", { novalidate: true, class: "form", style: "display: contents", onsubmit: (event) => { event.preventDefault(); this.submit(); } },
      h("div.scroll", {}, h("h1", {}, "Study"), h("p.lead", {}, "One voyage for many departures, speeds and ships: when is it fast, cheap, or not possible at all?"),
        h("div.exports.block", {}, h("button.quiet.small", { type: "button", onclick: () => this.file.click() }, "Study file …"), this.file), this.ready, this.earlier,
        h("div.block", {}, h("h2", {}, "Voyage"), this.voyage),
        h("fieldset.block", {}, h("legend", {}, "Departures"), field("from", "From", withUnit(this.from, "UTC")), field("to", "To", withUnit(this.to, "UTC")), h("div.field", { "data-field": "step" }, h("label.label", { for: "s-step" }, "Every"), withUnit(this.step, "h"), h("div.slot"))),
        h("div.block", {}, field("speed_kn", "Speeds", withUnit(this.speeds, "kn"), h("p.facts", {}, "With commas between them. Empty: as the voyage states."))),
        h("fieldset.block", { "data-field": "ship" }, h("legend", {}, "Ships"), this.ships, h("div.slot")),
        h("div.block", {}, h("label.check", {}, this.blind, h("span", {}, "Compare with routes that ignore the weather", h("small", {}, "states what routing saves"))), field("title", "Name", this.title), this.counted), this.problem),
      h("div.foot", {}, h("button.primary", { type: "submit" }, "Plan the study")));
    this.ships.addEventListener("change", () => this.#count());
  }

  async show() {
    this.begin();
    this.#listReady();
    const { plans } = this, { period } = plans.sea, ends = plans.start.value && plans.goal.value;
    if (!this.from.value && period) {
      const begin = Math.ceil((typedTime(plans.depart) ?? period[0]) / 43200) * 43200;
      this.from.value = inputTime(begin);
      this.to.value = inputTime(Math.min(begin + 3 * 86400, period[1]));
    }
    const set = plans.settings(), left = Object.keys(NOT_TAKEN).filter((name) => set[name] !== undefined).map((name) => NOT_TAKEN[name]);
    const seas = plans.sea.chosen.map((id) => plans.sea.list.find((sea) => sea.id === id)?.name.split(":")[0] || id);
    fill(this.voyage, ends
      ? h("p", {}, h("b", {}, plans.defaultTitle()), h("small.lead", {}, ` ${plans.objective.selectedOptions[0].text.toLowerCase()} · ${seas.join(", ") || "no sea chosen"}`))
      : h("p.note", {}, "The voyage has no ends yet. "), h("div.exports", { style: "margin-top: 8px" }, h("button.quiet.small", { type: "button", onclick: () => this.handlers.plan() }, ends ? "Change the voyage" : "Fill in the voyage"), ends ? null : h("button.quiet.small", { type: "button", onclick: async () => { this.handlers.demo(); this.handlers.panel([await this.show()]); } }, "Use the storm of 1998")),
      left.length ? h("p.note", {}, `Not used in studies: ${left.join(", ")} of the form.`) : null);
    const before = [...this.ships.querySelectorAll("input:checked")].map((box) => box.value);
    const chosen = before.length ? before : [plans.ship.value];
    fill(this.ships, (plans.ship.list || []).map((ship) => h("label.check", {}, h("input", { type: "checkbox", value: ship.id, checked: chosen.includes(ship.id) }), h("span", {}, ship.name))));
    await this.#measure();
    this.#count();
    await this.listEarlier(({ summary, created }) => (summary ? `${number(summary.voyages)} voyages · ${time(seconds(created))}` : time(seconds(created))));
    return this.element;
  }

  async #listReady() {
    if (this.ready.childElementCount) return;
    fill(this.ready, h("p.facts", {}, "Examples are on their way …"));
    const studies = await get("/studies/ready").catch(() => []);
    fill(this.ready, studies.length ? h("details", {}, h("summary", {}, "Ready studies", h("span.set", {}, String(studies.length))), h("div.inside", {}, studies.map(({ about, voyages, request }) => h("button.job", { type: "button", onclick: () => this.order(request) }, h("b", {}, request.title), h("span", {}, about), h("span", {}, `${number(voyages)} voyages, about ${this.#takes(voyages)}`))))) : null);
  }

  get #axes() {
    const ships = [...this.ships.querySelectorAll("input:checked")].map((box) => box.value);
    const speeds = this.speeds.value.split(/[,;\s]+/).filter(Boolean).map(Number);
    return { ships, speeds, from: typedTime(this.from), to: typedTime(this.to), step: Number(this.step.value.replace(",", ".")) };
  }

  #takes(voyages) {
    return duration((voyages * (this.measured || SECONDS_EACH)) / 3600);
  }

  // Seconds for each voyage of the studies of before; null where there are none.
  async #measure() {
    const { jobs } = await get("/plans?kind=study&size=20").catch(() => ({ jobs: [] }));
    const each = jobs.filter((job) => job.summary?.voyages > 0 && job.summary.seconds > 0).map(({ summary }) => summary.seconds / summary.voyages).sort((a, b) => a - b);
    this.measured = each.length ? quantile(each, 0.5) : null;
  }

  #count() {
    const { ships, speeds, from, to, step } = this.#axes;
    const departures = from !== null && to !== null && step > 0 && to >= from ? Math.floor((to - from) / (step * 3600) + 1e-9) + 1 : 0;
    this.size = departures * Math.max(1, speeds.length) * Math.max(1, ships.length);
    const ends = this.plans.start.value && this.plans.goal.value;
    this.counted.textContent = !this.size ? "" : `${number(this.size)} voyage${this.size === 1 ? "" : "s"}${ends ? `: about ${this.#takes(this.size)}${this.measured ? ", as studies on this computer took before" : "; a short voyage takes less"}` : "; the voyage has no ends yet"}.`;
  }

  async submit() {
    this.clearFaults();
    const { ships, speeds, from, to, step } = this.#axes;
    if (from === null) return this.fail({ field: "from", asked: "The first departure is not a time.", remedy: "Give year, month, day, hour and minute, such as 2026-01-31 12:00." });
    if (to === null || to < from) return this.fail({ field: "to", asked: "The last departure is not a time after the first.", remedy: "Correct it." });
    if (!(step > 0)) return this.fail({ field: "step", asked: "The step is not a number of hours.", remedy: "Give 12, for example." });
    if (speeds.some((v) => !(v > 0))) return this.fail({ field: "speed_kn", asked: "A speed is not a number.", remedy: "Separate them by commas: 12, 13, 14." });
    if (!ships.length) return this.fail({ field: "ship", asked: "No ship is chosen.", remedy: "Choose one or more." });
    const base = this.plans.request();
    if (!base) { this.handlers.plan(); return null; }
    const { depart, depart_window: window, arrive_by: latest, ...voyage } = base.voyage;
    const study = { name: this.title.value.trim() || base.title, ship: ships[0], sea: base.seas.length === 1 ? base.seas[0] : base.seas, voyage, axes: { depart: { from: `${inputTime(from).replace(" ", "T")}Z`, to: `${inputTime(to).replace(" ", "T")}Z`, step_h: step } } };
    for (const name of TAKEN) if (base[name] !== undefined) study[name] = base[name];
    if (base.variables) study.map = base.variables;
    if (ships.length > 1) study.axes.ship = ships;
    if (speeds.length > 1) study.axes.speed_kn = speeds;
    else if (speeds.length) [study.voyage.speed_kn] = speeds;
    if (this.blind.checked) study.compare = "weather_blind";
    return this.order({ title: study.name, study });
  }

  async #open() {
    const study = await this.fileText(this.file);
    if (study !== null) await this.order({ study });
  }

  shown(job) {
    const drawn = Object.keys(job.request.study.sample || {}).filter((name) => !["count", "seed"].includes(name));
    this.map = new HeatMap([...Object.keys(job.request.study.axes || {}), ...drawn], drawn, (name, cell) => this.#cell(name, cell));
    this.handlers.sheet(this.map.element, true);
    this.cellBox = h("div.block", {}, h("p.facts", {}, "Choose a cell to see its voyages."));
    this.handlers.ends(job.request.study.voyage);
  }

  watch(job) {
    this.map.draw();
    const state = h("p.lead", { role: "status" }, "Waiting for its turn."), meter = h("progress.meter", { max: 1, value: 0, "aria-label": "Voyages planned" }), facts = h("p.facts"), problem = h("div");
    this.handlers.panel([h("div.scroll", {}, h("h1", {}, job.title), state, meter, facts, this.cellBox, problem), jobFoot(job, "Stop, keep these", { state, problem, leave: () => this.handlers.leave() })]);
    this.followJob(job, state, { kept: " Voyages that were planned are kept." }, {
      progress: (data) => {
        state.textContent = `${number(data.done)} of ${number(data.total)} voyages`;
        meter.value = data.done / data.total;
        const refused = this.map.rows.concat(data.rows).filter((row) => row.refusal).length;
        facts.textContent = [known(data.left_s) && data.done < data.total ? `about ${duration(data.left_s / 3600)} left` : "", refused ? `${refused} without a route` : ""].filter(Boolean).join(" · ");
        this.map.add(data.rows);
      },
    });
  }

  async drawn(job, result) {
    this.map.axes = result.axes;
    this.map.rows = [];
    this.map.add(result.rows.map((row) => Object.fromEntries(result.columns.map((name, i) => [name, row[i]]))));
    const { summary } = job;
    const usable = this.map.rows.filter((row) => !row.refusal && row.feasible !== false && known(row.time_h));
    const times = usable.map((row) => row.time_h).sort((a, b) => a - b), at = (q) => quantile(times, q);
    const best = bestMonth(usable);
    const fastest = usable.reduce((a, b) => (a && a.time_h <= b.time_h ? a : b), null);
    const card = (name, value, more) => h("div.card", {}, h("dt", {}, name), h("dd", {}, value, more ? h("small", {}, more) : null));
    const months = ["January", "February", "March", "April", "May", "June", "July", "August", "September", "October", "November", "December"];
    const wide = (cards) => { const there = cards.filter(Boolean); if (there.length % 2) there.at(-1).classList.add("wide"); return there; };
    this.handlers.panel([h("div.scroll", {}, h("h1", {}, job.title), h("p.lead", {}, this.#facts(summary)),
      summary.cancelled ? h("p.note", {}, `Stopped: ${number(summary.voyages)} of ${number(summary.total)} voyages were planned.`) : null,
      h("dl.cards", {}, wide([card("Median time", times.length ? days(at(0.5)) : "unknown", times.length > 2 ? `80 % within ${days(at(0.1))} to ${days(at(0.9))}` : null), card("Without a route", number(this.map.rows.length - usable.length), this.map.rows.length ? `${number((100 * (this.map.rows.length - usable.length)) / this.map.rows.length)} % of the voyages` : null), fastest?.depart ? card("Fastest", days(fastest.time_h), `leaves ${time(seconds(fastest.depart))}`) : null, best ? card("Best month", months[best.month], `median ${days(best.median)} of ${best.of} months`) : null])),
      this.cellBox,
      result.refusals.length ? h("div.block", {}, h("h2", {}, "Why there is no route"), longList(result.refusals.map((row) => h("li", {}, `${number(row.voyages)} voyage${row.voyages === 1 ? "" : "s"}: ${readable(row.reason)}`)), 6)) : null,
      h("div.block", {}, h("h2", {}, "Files"), h("div.exports", {}, h("a.quiet.small", { href: tableAddress(job.id, "voyages"), download: "" }, "Voyages as CSV"), h("a.quiet.small", { href: tableAddress(job.id, "summary"), download: "" }, "Summary as CSV"), h("a.quiet.small", { href: resultAddress(job.id), download: "study.json" }, "study.json")))),
    h("div.foot", {}, h("button.primary", { type: "button", onclick: async () => this.handlers.panel([await this.show()]) }, "Another study"))]);
    announce("The study is planned.");
  }

  #facts(summary) {
    const departs = this.map.rows.map((row) => row.at?.getTime()).filter(known);
    const named = (id) => this.plans.ship.list?.find((ship) => ship.id === id)?.name || id;
    const ships = [...new Set(this.map.rows.map((row) => row.ship).filter(Boolean))].map(named);
    return [`${number(summary.voyages)} voyages`, ships.length ? ships.join(", ") : [this.job.request.study.ship].flat()[0]?.name || named(this.job.request.study.ship), departs.length ? `${time(Math.min(...departs) / 1000)} to ${time(Math.max(...departs) / 1000, true)}` : null].filter((part) => typeof part === "string").join(" · ");
  }

  #cell(name, cell) {
    const row = (one) => h("button.job", { type: "button", title: "Fill in this voyage to plan it", onclick: () => this.#plan(one) }, h("b", {}, one.depart ? time(seconds(one.depart)) : "Voyage"), h("span", {}, one.refusal ? readable(one.reason || "") : `${duration(one.time_h)} · ${known(one.fuel_t) ? `${number(one.fuel_t, 1)} t` : "fuel unknown"}${known(one.max_significant_wave_height_m) ? ` · waves ${number(one.max_significant_wave_height_m, 1)} m` : ""}`));
    const rest = cell.rows.slice(12), box = h("div");
    const more = rest.length ? h("details.plain", { ontoggle: () => { if (!box.childElementCount) fill(box, rest.map(row)); } }, h("summary", {}, `${number(rest.length)} more`), box) : null;
    fill(this.cellBox, h("h2", {}, name), h("p.facts", {}, `${number(cell.rows.length)} voyage${cell.rows.length === 1 ? "" : "s"}${cell.lost ? `, ${cell.lost} without a route` : ""}`), cell.rows.slice(0, 12).map(row), more);
  }

  // Fill the plan form with one voyage of the study.
  #plan(row) {
    const { study, title } = this.job.request;
    const voyage = { ...study.voyage };
    for (const name of this.map.axes) if (name in row && !["ship", "sea", "load_factor", "member"].includes(name) && typeof row[name] !== "object") voyage[name] = row[name];
    this.handlers.voyage({ title: title || "", ship: row.ship || study.ship, seas: [study.sea].flat(), fill: study.fill, voyage });
  }
}

// The month (from 0) with the least median time of all voyages; null of fewer than three months, and where none differs by a minute.
function bestMonth(rows) {
  const months = new Map();
  for (const row of rows) if (row.at) months.set(row.at.getUTCMonth(), [...(months.get(row.at.getUTCMonth()) || []), row.time_h]);
  const medians = [...months].map(([month, times]) => ({ month, median: quantile(times.sort((a, b) => a - b), 0.5), of: months.size })).sort((a, b) => a.median - b.median);
  return medians.length > 2 && medians.at(-1).median - medians[0].median > 1 / 60 ? medians[0] : null;
}
