// Dredging projects: the form, the simulation while it runs, and the result.

import { get, resultAddress, tableAddress } from "../common/api.js";
import { announce, errorBox, fill, h, unit, withUnit } from "../common/elements.js";
import { days, duration, inputTime, known, number, position, seconds, time } from "../common/format.js";
import { pricesText } from "../common/prices.js";
import { BatchView } from "./batch_view.js";
import { PlaceField } from "../form/places.js";
import { drawActivities, drawLoads, drawPlaceAndTime, drawVolume, runColour, showCycles } from "./project_diagrams.js";
import { jobFoot } from "../result/progress_view.js";
import { SheetTabs } from "./sheet_tabs.js";

const NUMBERS = [["volume_m3", "Volume to move", "m³"], ["hopper_m3", "Full load", "m³"], ["loading", "Loads at", "m³/s"], ["unloading", "Unloads at", "m³/s"], ["days", "At most", "days"], ["min_ukc_m", "Under-keel clearance", "m"], ["load_factors", "Loads to choose from", "count"], ["spacing_m", "Spacing of the network", "m"]];
// Of loading or unloading, in m3/s; undefined for a curve.
const ratePerSecond = (work) => work.rate_m3_s ?? (work.rate_m3_h === undefined ? undefined : work.rate_m3_h / 3600);
const asRow = ([lat, lon]) => `${lat}, ${lon}`;

const WORDS = { path: "/projects", earlier: "Earlier projects", stopped: "The simulation was stopped." };

export class ProjectView extends BatchView {
  // handlers also: fit(points)
  constructor(chart, form, handlers) {
    super("project", WORDS, handlers);
    this.chart = chart;
    this.plans = form; // its lists of ships and seas
    this.load = new PlaceField("start", "Loads at", () => this.places());
    this.unload = new PlaceField("goal", "Unloads at", () => this.places());
    this.rest = {};
    this.#build();
  }

  #build() {
    this.numbers = Object.fromEntries(NUMBERS.map(([name]) => [name, h("input", { type: "text", inputmode: "decimal", id: `p-${name}`, autocomplete: "off" })]));
    const field = (name) => { const [, label, unitText] = NUMBERS.find((row) => row[0] === name); return h("div.field", { "data-field": name }, h("label.label", { for: `p-${name}` }, label), withUnit(this.numbers[name], unitText), h("div.slot")); };
    this.title = h("input", { type: "text", id: "p-title", maxlength: 200 });
    this.ship = h("select", { id: "p-ship" });
    this.sea = h("div");
    this.start = h("input", { type: "text", id: "p-start", autocomplete: "off", placeholder: "2026-05-01 00:00" });
    this.tides = h("input", { type: "checkbox", id: "p-tides" });
    this.base = h("textarea", { id: "p-base", rows: 4, placeholder: "51.7449, 3.5790\n51.6964, 3.4370\n51.6596, 3.6514" });
    this.baseLoad = h("select", { id: "p-base-load" }, h("option", { value: "best" }, "in each cycle the one that moves most"), h("option", { value: "1" }, "always full"));
    this.file = h("input.hidden", { type: "file", id: "project-file", "aria-label": "Project file", accept: ".yaml,.yml,.json", tabindex: "-1", onchange: () => this.#open() });
    this.button = h("button.primary", { type: "submit" }, "Simulate the project");
    this.element = h("form", { novalidate: true, class: "form", style: "display: contents", oninput: () => { this.touched = true; }, onsubmit: (event) => { event.preventDefault(); this.submit(); } },
      h("div.scroll", {}, h("h1", {}, "Dredging project"), h("p.lead", {}, "Load, sail full, unload, sail empty, until a volume is moved. Each cycle takes the load and the routes that move most."),
        h("div.exports.block", {}, h("button.quiet.small", { type: "button", onclick: () => this.example() }, "Fill in the example"), h("button.quiet.small", { type: "button", onclick: () => this.file.click() }, "Project file …"), this.file),
        this.earlier,
        h("div.block", {}, h("div.itinerary", {}, this.load.element, this.unload.element)),
        h("div.block", {}, h("div.field", { "data-field": "ship" }, h("label.label", { for: "p-ship" }, "Ship"), this.ship, h("div.slot"))),
        h("fieldset.block", { "data-field": "seas" }, h("legend", {}, "Sea"), this.sea, h("label.check", {}, this.tides, h("span", {}, "Predict from the tides in the files", h("small", {}, "for dates that the files do not cover"))), h("div.slot")),
        h("div.block", {}, h("div.pair", {}, field("volume_m3"), field("hopper_m3")), h("div.pair", {}, field("loading"), field("unloading")), h("div.pair.time", {}, h("div.field", { "data-field": "start" }, h("label.label", { for: "p-start" }, "Starts"), withUnit(this.start, "UTC"), h("div.slot")), field("days"))),
        h("div.block", {}, h("details", {}, h("summary", {}, "Depth and network"), h("div.inside", {}, h("div.pair", {}, field("min_ukc_m"), field("spacing_m")), field("load_factors"), h("p.facts", {}, "Empty: the clearance of the ship file, 11 loads, and the mesh of the sea data."))),
          h("details", {}, h("summary", {}, "Base case to compare with"), h("div.inside", {}, h("div.field", { "data-field": "base_case" }, h("label.label", { for: "p-base" }, "Charted route: latitude, longitude"), this.base, h("div.slot")), h("div.field", {}, h("label.label", { for: "p-base-load" }, "Load"), this.baseLoad)))),
        h("div.field.block", {}, h("label.label", { for: "p-title" }, "Name"), this.title), this.problem),
      h("div.foot", {}, this.button));
  }

  // The form

  async show() {
    this.begin();
    this.chart.routes.clear();
    this.lists();
    this.places();
    if (!this.touched) await this.example(true).catch((problem) => fill(this.problem, errorBox(problem)));
    await this.listEarlier(({ summary, created }) => (summary ? `${number(summary.duration_days, 1)} days · ${number(summary.cycles)} cycles · ${time(seconds(created))}` : time(seconds(created))));
    return this.element;
  }

  lists() {
    const own = typeof this.rest.ship === "object" ? [h("option", { value: "own" }, this.rest.ship.name || "Ship of the project file")] : [];
    const chosen = this.ship.value;
    fill(this.ship, own, (this.plans.ship.list || []).map((ship) => h("option", { value: ship.id }, ship.name)));
    this.ship.value = chosen || (own.length ? "own" : "hopper-dredger");
    if (!this.ship.value) this.ship.selectedIndex = 0;
    const before = new Set([...this.sea.querySelectorAll("input:checked")].map((box) => box.value));
    if (!this.sea.childElementCount) before.add("synthetic-estuary");
    const rows = [{ id: "synthetic-estuary", name: "Made-up estuary with tides", facts: "a bank that dries, and a gully behind it" }, ...(this.plans.sea.list || []).filter((sea) => !sea.embedded).map((sea) => ({ ...sea, facts: (sea.frames || []).join(", ") }))];
    fill(this.sea, rows.map((sea) => h("label.check", {}, h("input", { type: "checkbox", value: sea.id, checked: before.has(sea.id), onchange: (event) => { if (event.target.checked) for (const box of this.sea.querySelectorAll("input")) if (box !== event.target && (box.value === "synthetic-estuary" || event.target.value === "synthetic-estuary")) box.checked = false; } }), h("span", {}, sea.name, h("small", {}, sea.facts)))));
  }

  // The example is read once, so that it never arrives after what the user writes.
  async example(first = false) {
    this.fetched ||= get("/projects/example").catch((problem) => { this.fetched = null; throw problem; });
    const { project } = await this.fetched;
    if (first && this.touched) return;
    this.set(project);
    this.fit();
  }

  fit() {
    const points = [this.load, this.unload].filter((field) => field.place).map(({ spot }) => [spot.lon, spot.lat]);
    if (points.length) this.handlers.fit(points);
  }

  async #open() {
    const project = await this.fileText(this.file);
    fill(this.problem);
    if (project !== null) await this.order({ project });
  }

  set(project) {
    this.touched = true;
    this.rest = structuredClone(project);
    this.title.value = project.name || "";
    const place = (field, value) => { if (Array.isArray(value)) field.setPosition(...value); else field.set(value || ""); };
    place(this.load, project.load);
    place(this.unload, project.unload);
    for (const [name] of NUMBERS) { const value = project[name]; this.numbers[name].value = typeof value === "object" && value !== null ? ratePerSecond(value) ?? (Array.isArray(value) ? value.length : "") : value ?? ""; }
    this.start.value = project.start ? inputTime(seconds(project.start)) : "";
    this.tides.checked = Boolean(project.tides);
    this.base.value = (project.base_case?.route || []).map(asRow).join("\n");
    this.baseLoad.value = String(project.base_case?.load_factor ?? "best") === "best" ? "best" : "1";
    this.ship.value = "";
    this.lists();
    this.ship.value = typeof project.ship === "object" ? "own" : project.ship || "hopper-dredger";
    const seas = [project.sea].flat();
    for (const box of this.sea.querySelectorAll("input")) box.checked = seas.includes(box.value);
    this.places();
  }

  places() {
    if (!this.unload || this.handlers.hidden()) return;
    const ends = [[this.load, "start", "Loads"], [this.unload, "goal", "Unloads"]].filter(([field]) => field.place);
    this.chart.routes.showEnds(ends.map(([field, role, label]) => ({ role, label, ...field.spot })), !this.job);
  }

  moved(number_, lat, lon) {
    [this.load, this.unload].filter((field) => field.place)[number_]?.setPosition(lat, lon);
  }

  #place(field, lat, lon) {
    this.touched = true;
    field.setPosition(lat, lon);
  }

  clicked(lat, lon, coordinate) {
    if (this.job) return;
    this.chart.choose(coordinate, position(lat, lon), [["Load here", () => this.#place(this.load, lat, lon)], ["Unload here", () => this.#place(this.unload, lat, lon)], ["Close", () => {}]]);
  }

  request() {
    const { load, unload } = this;
    for (const [field, what] of [[load, "loading"], [unload, "unloading"]]) if (!field.place) { field.fail({ asked: `The project has no ${what} site.`, remedy: "Type a position, or click it on the chart." }); field.input.focus(); return null; }
    const project = { ...this.rest, name: this.title.value.trim() || "Dredging project", load: [load.spot.lat, load.spot.lon], unload: [unload.spot.lat, unload.spot.lon] };
    for (const [name, label] of NUMBERS) {
      const text = this.numbers[name].value.trim().replace(",", "."), before = this.rest[name];
      if (text === "") { if (typeof before !== "object") delete project[name]; continue; }
      const value = Number(text);
      if (!Number.isFinite(value)) { this.fail({ field: name, asked: `${label}: ${text} is not a number.`, remedy: "Give a number." }); return null; }
      if (before && typeof before === "object") { if (!Array.isArray(before) && ratePerSecond(before) !== undefined) { const { rate_m3_h: _, ...others } = before; if (ratePerSecond(before) !== value) project[name] = { ...others, rate_m3_s: value }; } else if (Array.isArray(before) && before.length !== value) project[name] = value; } else project[name] = value;
    }
    if (this.ship.value !== "own") project.ship = this.ship.value;
    project.sea = [...this.sea.querySelectorAll("input:checked")].map((box) => box.value);
    if (project.sea.length === 1) [project.sea] = project.sea;
    if (this.tides.checked) project.tides ||= true; else delete project.tides;
    project.start = `${this.start.value.trim().replace(" ", "T")}Z`;
    const route = this.base.value.split("\n").map((row) => row.split(/[,;\s]+/).filter(Boolean).map(Number)).filter((row) => row.length === 2 && row.every(Number.isFinite));
    if (route.length > 1) project.base_case = { ...this.rest.base_case, route, load_factor: this.baseLoad.value === "best" ? "best" : 1 };
    else delete project.base_case;
    return { title: project.name, project };
  }

  // A fault of a site stands at its place.
  fail(problem) {
    const place = { load: this.load, unload: this.unload }[problem.field];
    if (!place) { super.fail(problem); return; }
    place.fail(problem);
    place.input.focus();
  }

  async submit() {
    this.clearFaults();
    const request = this.request();
    if (request) await this.order(request);
  }

  // A job

  shown(job) {
    this.set(job.request.project);
  }

  watch(job) {
    const runs = { optimised: [], "base case": [] };
    if (!job.request.project.base_case) delete runs["base case"];
    const state = h("p.lead", { role: "status" }, "Waiting for its turn."), steps = h("ol.steps"), cards = h("dl.cards"), problem = h("div");
    const tabs = new SheetTabs("The project so far", [["volume", "Volume so far", (sheet) => (runs.optimised.length ? drawVolume(sheet, runs, job.request.project.volume_m3, seconds(job.request.project.start)) : (fill(sheet, h("p.empty", {}, h("b", {}, "No cycle yet"), "The volume that is moved appears here, cycle by cycle.")), ""))]]);
    this.handlers.panel([h("div.scroll", {}, h("h1", {}, job.title), state, steps, cards, problem), jobFoot(job, "Stop", { state, problem, leave: () => this.handlers.leave() })]);
    this.handlers.sheet(tabs.element);
    let pending = false;
    const redraw = () => { if (pending) return; pending = true; requestAnimationFrame(() => { pending = false; tabs.redraw(); this.#cards(cards, runs); }); };
    const again = () => { fill(steps); for (const name of Object.keys(runs)) runs[name] = []; };
    this.followJob(job, state, { again }, {
      stage: (data) => {
        if (/^\d+ cycles/.test(data.text)) return;
        state.textContent = "Simulating.";
        steps.querySelector(".now")?.classList.remove("now");
        steps.append(h("li.now", {}, h("span", {}, data.text[0].toUpperCase() + data.text.slice(1)), h("span.unit", {}, `${number(data.after_s, 0)} s`)));
        announce(data.text);
      },
      progress: ({ run, cycle }) => {
        if (cycle.number === 1) runs[run] = [];
        (runs[run] ||= []).push(cycle);
        this.chart.routes.showChosen(cycle.out, null, null, 0);
        redraw();
      },
    });
  }

  #cards(cards, runs) {
    const name = runs["base case"]?.length ? "base case" : "optimised", cycles = runs[name];
    if (!cycles.length) return;
    const card = (title, value, unitText) => h("div.card", {}, h("dt", {}, title), h("dd", {}, value, unitText ? unit(unitText) : null));
    fill(cards, card(name === "optimised" ? "Optimised: cycles" : "Base case: cycles", number(cycles.length)), card("Moved", number(cycles.reduce((sum, c) => sum + c.volume_m3, 0)), "m³"), card("Mean load", number(100 * cycles.reduce((sum, c) => sum + c.load_factor, 0) / cycles.length), "%"), card("Waited", duration(cycles.reduce((sum, c) => sum + c.waiting_h, 0))));
  }

  async drawn(job, result) {
    const diagrams = await get(`/plans/${job.id}/diagrams.json`);
    if (this.job !== job || this.handlers.hidden()) return;
    this.result = result;
    this.diagrams = diagrams;
    this.handlers.panel(this.#panel(job, result, diagrams));
    const cycles = Object.fromEntries(Object.entries(result.runs).map(([name, run]) => [name, run.cycles.map((c) => ({ ...c, end: seconds(c.end) }))]));
    const start = seconds(result.project.start);
    const names = Object.keys(result.runs).sort((a, b) => (a === "base case") - (b === "base case"));
    const ordered = Object.fromEntries(names.map((name) => [name, cycles[name]]));
    let spaceRun = names.at(-1);
    const tabs = new SheetTabs("Diagrams of the project", [
      ["volume", "Volume", (sheet) => drawVolume(sheet, ordered, result.project.volume_m3, start, lastedOf(result))],
      ["days", "First days", (sheet) => drawActivities(sheet, { ...diagrams, runs: Object.fromEntries(names.map((name) => [name, diagrams.runs[name]])) }, start)],
      ["space", "Place and time", (sheet) => drawPlaceAndTime(sheet, diagrams, spaceRun, (name) => { spaceRun = name; tabs.redraw(); })],
      ["loads", "Loads", (sheet) => drawLoads(sheet, ordered)],
      ["cycles", "Cycles", (sheet) => showCycles(sheet, Object.fromEntries(names.map((name) => [name, result.runs[name]])), this.chosen, (name, i) => { this.chosen = { name, i }; this.draw(); tabs.redraw(); })],
    ]);
    this.chosen = null;
    this.handlers.sheet(tabs.element);
    this.draw();
    const all = Object.values(diagrams.runs).flatMap((run) => run.tracks.slice(0, 40).flatMap((track) => track.out));
    this.handlers.fit(all);
    announce("The project is simulated.");
  }

  // All routes on the chart; a chosen cycle alone in full colour.
  draw() {
    const { routes } = this.chart;
    const groups = Object.entries(this.diagrams.runs).map(([name, run]) => ({ paint: runColour(name).slice(2), dash: name === "base case" ? [8, 6] : undefined, lines: distinct(run.tracks.flatMap((track) => [track.out, track.back])) }));
    routes.showBundles(groups, Boolean(this.chosen));
    if (this.chosen) { const track = this.diagrams.runs[this.chosen.name].tracks[this.chosen.i]; routes.showChosen([...track.out, ...track.back], null, null, 0); } else routes.showChosen(null);
    this.places();
  }

  #panel(job, result, diagrams) {
    const best = result.runs.optimised, { totals } = best, gains = result.gains;
    const card = (name, value, unitText, more) => h("div.card", {}, h("dt", {}, name), h("dd", {}, value, unitText ? unit(unitText) : null, more ? h("small", {}, more) : null));
    const gain = (share, good) => (known(share) ? [h(`span.${(share > 0) === good ? "less" : "more"}`, {}, `${share > 0 ? "+" : "−"}${number(Math.abs(100 * share), 0)} %`), " against the base case"] : null);
    const notes = Object.entries(result.runs).flatMap(([name, run]) => run.notes.map((text) => `${name}: ${text}`));
    const [head, ...rows] = diagrams.table.map((row) => (row[0] === "duration" ? [row[0], ...diagrams.table[0].slice(1).map((name) => days(lastedOf(result)[name]))] : row));
    return [h("div.scroll", {},
      h("h1", {}, result.project.name), h("p.lead", {}, `${number(result.project.volume_m3)} m³ from ${time(seconds(result.project.start), true)} UTC`),
      best.feasible ? null : h("div.error", { role: "alert" }, h("b", {}, "Some legs break a limit."), "The notes state how many."),
      h("dl.cards", {}, card("Production a week", number(totals.production_m3_week), "m³", gain(gains.production_gain, true)), card("Duration", days(lastedOf(result).optimised), null, known(gains.time_saved) ? gain(-gains.time_saved, false) : null), card("Cycles", number(totals.cycles), null, `mean load ${number(100 * totals.mean_load_factor)} %`), card("Waiting", `${number(100 * totals.waiting_share, 1)}`, "% of the time"), card("Fuel", known(totals.fuel_t) ? number(totals.fuel_t, 1) : "unknown", known(totals.fuel_t) ? "t" : null), card("CO₂ per volume", known(totals.co2_kg_m3) ? number(totals.co2_kg_m3, 2) : "unknown", known(totals.co2_kg_m3) ? "kg/m³" : null)),
      h("div.block", {}, h("h2", {}, "All figures"), h("div.table.narrow", { tabindex: 0 }, h("table", {}, h("caption.hidden", {}, "Figures of the runs, as in Table 5.1 of van Halem (2019)"), h("thead", {}, h("tr", {}, head.map((text, i) => h(i ? "th" : "th.text", { scope: "col" }, text || h("span.hidden", {}, "Figure"))))), h("tbody", {}, rows.map((row) => h("tr", {}, row.map((text, i) => (i ? h("td", {}, text) : h("th.text", { scope: "row" }, (text[0].toUpperCase() + text.slice(1)).replace(/m3/g, "m³").replace("CO2", "CO₂"))))))))),
        known(totals.cost) && result.prices ? h("p.facts", {}, `Prices, ${totals.currency}: ${pricesText(result.prices)}.`) : null),
      notes.length ? h("div.block", {}, h("h2", {}, "Notes"), h("ul.list", {}, notes.map((text) => h("li", {}, text)))) : null,
      h("div.block", {}, h("h2", {}, "Files"), h("div.exports", {}, h("a.quiet.small", { href: tableAddress(job.id, "cycles"), download: "" }, "Cycles as CSV"), h("a.quiet.small", { href: resultAddress(job.id), download: "project.json" }, "project.json")))),
    h("div.foot", {}, h("button.primary", { type: "button", onclick: async () => this.handlers.panel([await this.show()]) }, "Change the project"))];
  }
}

// The duration of each run [h].
const lastedOf = ({ runs }) => Object.fromEntries(Object.entries(runs).map(([name, { totals }]) => [name, 24 * totals.duration_days]));

function distinct(lines) {
  const found = new Map(lines.map((points) => [points.map((p) => p.map((v) => v.toFixed(3))).join(), points]));
  return [...found.values()];
}
