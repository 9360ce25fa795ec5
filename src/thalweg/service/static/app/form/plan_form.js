// The form of a voyage. Errors stand at their field; what is missing is said, not greyed out.

import { get, post, start } from "../common/api.js";
import { announce, errorBox, fill, h } from "../common/elements.js";
import { inputTime, plainPosition, seconds, time } from "../common/format.js";
import { typedTime } from "../common/typed_time.js";
import { AreaFields } from "./area_fields.js";
import { IndicatorLimits, IndicatorWeights } from "./indicators.js";
import { NetworkFields } from "./network_fields.js";
import { PlaceField } from "./places.js";
import { remedyButtons } from "./remedies.js";
import { SeaChoice } from "./sea_choice.js";
import { ShipChoice } from "./ship_choice.js";

const OBJECTIVES = [
  ["front", "All trade-offs of time and fuel"], ["time", "Least time"], ["fuel", "Least fuel"], ["cost", "Least cost"],
  ["co2", "Least CO₂"], ["energy", "Least energy"], ["comfort", "Least motion sickness"], ["encounters", "Fewest encounters with ships"], ["inshore", "Least length near land"], ["distance", "Shortest distance"],
  ["weighted", "A weighted sum …"], ["alternatives", "Routes that differ, to choose from"],
];
const CANALS = [["suez", "Suez"], ["panama", "Panama"], ["kiel", "Kiel"], ["corinth", "Corinth"]];
export const DEMO = { title: "Halifax to Bishop Rock", ship: "handysize-bulker", seas: ["storm"], voyage: { start: "Halifax", goal: "49.7N 6.5W", depart: "1998-08-31T12:00Z", objective: "time" } };

export class PlanForm extends EventTarget {
  vias = [];
  moves = []; // what the points were before they were dragged: [field, text, place]

  constructor(chart) {
    super();
    this.chart = chart;
    this.start = new PlaceField("start", "From", () => this.#placesChanged());
    this.goal = new PlaceField("goal", "To", () => this.#placesChanged());
    this.element = h("form", { novalidate: true, class: "form", onsubmit: (event) => { event.preventDefault(); this.submit(); } });
    this.#build();
  }

  async load() {
    const [ships, seas] = await Promise.all([get("/ships"), get("/seas"), this.network.load()]);
    this.ship.show(ships, this.wanted?.ship);
    this.sea.show(seas, this.wanted?.seas);
  }

  #build() {
    this.element.style.display = "contents";
    this.viaBox = h("div");
    const problemAt = (name) => (problem) => (problem ? this.#fail(name, problem) : this.#clearField(name));
    this.ship = new ShipChoice(problemAt("ship"));
    this.sea = new SeaChoice({ ends: () => this.ends, departs: () => typedTime(this.depart), changed: () => this.#seaChanged(), problemAt: problemAt("seas") });
    this.areas = new AreaFields(this.chart, () => this.#summaries());
    this.depart = h("input", { type: "text", id: "depart", autocomplete: "off", placeholder: "2026-01-31 12:00" });
    this.latest = h("input", { type: "text", id: "latest", autocomplete: "off", placeholder: "2026-01-31 12:00" });
    this.arriveBy = h("input", { type: "text", id: "arrive-by", autocomplete: "off", placeholder: "2026-01-31 12:00" });
    this.departFacts = h("p.facts");
    this.weights = new IndicatorWeights();
    this.indicators = new IndicatorLimits(() => this.#summaries());
    this.network = new NetworkFields();
    this.objective = h("select", { id: "objective", onchange: () => this.#objectiveChosen() }, OBJECTIVES.map(([value, text]) => h("option", { value }, text)));
    this.objective.value = "time";
    this.title = h("input", { type: "text", id: "title", maxlength: 200, placeholder: "Name of this plan" });
    this.numbers = {};
    this.problem = h("div");
    this.wait = h("input", { type: "checkbox", id: "wait", checked: true });
    this.forbid = CANALS.map(([value, text]) => [value, h("input", { type: "checkbox", id: `forbid-${value}` }), text]);
    this.avoid = h("input", { type: "text", id: "avoid", placeholder: "Pentland Firth, ..." });
    this.fills = ["waves", "wind", "currents"].map((name) => [name, h("select", { id: `fill-${name}` },
      h("option", { value: "" }, "closed water"), h("option", { value: "0" }, "none (0)"), h("option", { value: "nearest:25" }, "nearest value within 25 nm"),
      name === "waves" ? [h("option", { value: "wind" }, "those that the wind raises"), h("option", { value: "head_seas" }, "head seas, where only heights are known")] : [])]);
    this.button = h("button.primary", { type: "submit" }, "Plan the voyage");
    this.voyageFile = h("input.hidden", { type: "file", id: "voyage-file", "aria-label": "Voyage file", accept: ".json,.yaml,.yml", tabindex: "-1", onchange: () => this.#openFile() });
    this.undoMove = h("button.quiet.small", { type: "button", hidden: true, onclick: () => this.#undoMove() }, "Undo move");
    const swap = h("button.quiet.small", { type: "button", onclick: () => this.#swap() }, "⇅ Swap");
    const addVia = h("button.quiet.small", { type: "button", onclick: () => this.addVia() }, "+ Via point");
    const body = h("div.scroll", {},
      h("h1", {}, "Plan a voyage"),
      h("p.lead", {}, "Type the ends or click them on the chart."),
      h("div.block", {}, h("div.itinerary", {}, this.start.element, this.viaBox, this.goal.element), h("div.row", {}, h("span"), this.undoMove, swap, addVia)),
      h("div.block", {},
        this.ship.element),
      this.sea.element,
      h("div.block", {},
        h("div.field", { "data-field": "depart" }, h("label.label", { for: "depart" }, "Departure ", h("span.unit", {}, "UTC")), this.depart, this.departFacts, h("div.slot")),
        h("div.field", { "data-field": "objective" }, h("label.label", { for: "objective" }, "Objective"), this.objective, h("div.slot")), this.weights.element),
      h("div.block", {},
        this.#details("time", "Time and speed", [
          h("div.pair", {}, this.#number("speed_kn", "Ordered speed", "kn"), this.#timeField("arrive_by", "Arrive by", this.arriveBy)),
          this.#timeField("depart_window", "Latest departure (finds the best between)", this.latest),
          h("label.check", {}, this.wait, h("span", {}, "The ship may stop and wait")),
        ]),
        this.#details("limits", "Limits", [
          h("div.pair", {}, this.#number("wave_height_m", "Waves at most", "m"), this.#number("wind_speed_kn", "Wind at most", "kn")),
          h("div.pair", {}, this.#number("min_ukc_m", "Under-keel clearance", "m"), this.#number("offing_nm", "Distance from land", "nm")),
          this.#number("motion_sickness_percent", "Sick after two hours at most", "% of people"),
          h("p.facts", {}, "Empty: as the ship file states; the distance from land by the size of the ship."),
        ]),
        this.#details("indicators", "Limits of key figures", [this.indicators.element]),
        this.#details("areas", "Areas to avoid", [this.areas.element]),
        this.#details("canals", "Canals and passages", [
          h("fieldset", {}, h("legend", {}, "Do not use"), this.forbid.map(([, input, text]) => h("label.check", {}, input, h("span", {}, text)))),
          h("div.field", { "data-field": "avoid" }, h("label.label", { for: "avoid" }, "Passages to avoid"), this.avoid, h("div.slot")),
        ]),
        this.#details("prices", "Prices", [
          h("div.pair", {}, this.#number("fuel_price_usd", "Fuel", "USD/t"), this.#number("eca_price_factor", "Factor in control areas", "×")),
          this.#number("time_price_usd_per_h", "Time without fuel", "USD/h"),
          h("p.facts", {}, "Empty: the prices of the ship file."),
        ]),
        this.#details("traffic", "Other ships", [this.network.trafficElement]),
        this.#details("network", "Network", [this.network.element]),
        this.#details("fill", "Where data are missing", [
          h("p.facts", {}, "Water without data is closed; it never becomes calm. A filling is noted in the result."),
          this.fills.map(([name, select]) => h("div.field", { "data-field": "fill" }, h("label.label", { for: select.id }, `Unknown ${name}`), select)),
        ]),
        h("div.field", {}, h("label.label", { for: "title" }, "Name"), this.title),
        h("div.exports.block", {}, h("button.quiet.small", { type: "button", onclick: () => this.#saveFile() }, "Save voyage file"), h("button.quiet.small", { type: "button", onclick: () => this.voyageFile.click() }, "Open …"), h("button.quiet.small", { type: "button", onclick: () => { const request = this.request(); if (request) this.dispatchEvent(new CustomEvent("link", { detail: request })); } }, "Copy link"), this.voyageFile)),
      this.problem);
    fill(this.element, body, h("div.foot", {}, this.button));
    this.element.addEventListener("input", () => { this.touched = true; this.#summaries(); });
    this.element.addEventListener("change", () => { this.#summaries(); this.dispatchEvent(new Event("change")); });
  }

  #objectiveChosen() {
    this.weights.element.hidden = this.objective.value !== "weighted";
  }

  #details(name, text, inside) {
    const set = h("span.set");
    const details = h("details", { "data-part": name }, h("summary", {}, text, set), h("div.inside", {}, inside));
    details.said = set;
    return (this.parts = { ...this.parts, [name]: details })[name];
  }

  #number(name, label, unitText) {
    const input = h("input", { type: "text", inputmode: "decimal", id: `n-${name}`, autocomplete: "off" });
    this.numbers[name] = input;
    return h("div.field", { "data-field": name }, h("label.label", { for: input.id }, label), h("div.with-unit", {}, input, h("span.unit", {}, unitText)), h("div.slot"));
  }

  #timeField(name, label, input) {
    return h("div.field", { "data-field": name }, h("label.label", { for: input.id }, label), input, h("div.slot"));
  }

  #summaries() {
    const text = (name, unitText) => { const value = this.numbers[name].value.trim(); return value ? `${value} ${unitText}` : ""; };
    const said = {
      time: [text("speed_kn", "kn"), this.arriveBy.value ? "arrival set" : "", this.latest.value ? "window" : ""],
      limits: [text("wave_height_m", "m waves"), text("wind_speed_kn", "kn wind"), text("motion_sickness_percent", "% sick"), text("min_ukc_m", "m UKC"), text("offing_nm", "nm off")],
      areas: [this.areas.list.length ? `${this.areas.list.length} drawn` : ""],
      canals: [...this.forbid.filter(([, input]) => input.checked).map(([, , name]) => `no ${name}`), this.avoid.value.trim() ? "passages" : ""],
      indicators: [this.indicators.words],
      traffic: [this.network.traffic.chosen.length ? `${this.network.traffic.chosen.length} chosen` : ""],
      network: this.network.words,
      prices: [text("fuel_price_usd", "USD/t"), text("time_price_usd_per_h", "USD/h")],
      fill: this.fills.filter(([, select]) => select.value).map(([name, select]) => `${name}: ${select.value}`),
    };
    for (const [name, parts] of Object.entries(said)) this.parts[name].said.textContent = parts.filter(Boolean).join(", ");
  }

  // Places

  addVia(text = "", position = null) {
    const field = new PlaceField("via", `Via ${this.vias.length + 1}`, () => this.#placesChanged());
    field.tools.append(h("button.quiet", { type: "button", "aria-label": "Remove this via point", onclick: () => { this.vias = this.vias.filter((one) => one !== field); this.#showVias(); } }, "✕"));
    this.vias.push(field);
    this.#showVias();
    if (position) field.setPosition(...position);
    else if (text) field.set(text);
    else field.input.focus();
  }

  #showVias() {
    this.vias.forEach((field, i) => { field.element.querySelector("label").textContent = `Via ${i + 1}`; field.element.dataset.field = `via.${i}`; });
    fill(this.viaBox, this.vias.map((field) => field.element));
    this.#placesChanged();
  }

  // The menu at a clicked position or port.
  offer({ lat, lon, port, coordinate }) {
    const name = port ? port.locode || port.label : "";
    const set = (field) => () => (port ? field.set(name, { kind: "port", ...port }) : field.setPosition(lat, lon));
    this.chart.choose(coordinate, port ? port.label : plainPosition(lat, lon), [["From here", set(this.start)], ["To here", set(this.goal)], ["Via here", () => this.addVia(name, port ? null : [lat, lon])], ["Close", () => {}]]);
  }

  #swap() {
    const [a, pa, b, pb] = [this.start.value, this.start.place, this.goal.value, this.goal.place];
    this.start.set(b, pb);
    this.goal.set(a, pa);
  }

  get ends() {
    return [this.start, ...this.vias, this.goal].filter((field) => field.place).map((field) => ({ role: field.role, lat: field.place.lat, lon: field.place.lon, label: field.place.kind === "port" ? field.place.name : "" }));
  }

  #placesChanged() {
    if (!this.goal) return;
    this.dispatchEvent(new Event("places"));
  }

  #seaChanged() {
    const { period } = this.sea;
    this.departFacts.textContent = period ? `Data from ${time(period[0])} to ${time(period[1], true)}` : "";
    if (!this.depart.value && period) this.depart.value = inputTime(period[0]);
    this.dispatchEvent(new Event("seas"));
  }

  // Voyage files: the request as it is sent

  #saveFile() {
    const request = this.request();
    if (!request) return;
    const address = URL.createObjectURL(new Blob([JSON.stringify(request, null, 2)], { type: "application/json" }));
    h("a", { href: address, download: `${request.title.replace(/[^\w. -]+/g, "_")}.voyage.json` }).click();
    setTimeout(() => URL.revokeObjectURL(address), 10_000);
  }

  async #openFile() {
    const [file] = this.voyageFile.files;
    this.voyageFile.value = "";
    if (!file) return;
    fill(this.problem);
    try {
      this.set(await post("/voyages/read", { text: await file.text() }));
      announce(`${file.name} is filled in.`);
      this.element.querySelector(".scroll").scrollTop = 0;
    } catch (problem) {
      fill(this.problem, errorBox(problem));
      this.problem.scrollIntoView({ block: "center" });
    }
  }

  // A point that was dragged on the chart: its number counts the shown ends.
  moved(number_, lat, lon) {
    const field = [this.start, ...this.vias, this.goal].filter((one) => one.place)[number_];
    if (!field) return;
    this.moves.push([field, field.value, field.place]);
    field.setPosition(lat, lon);
    this.undoMove.hidden = false;
  }

  #undoMove() {
    const [field, text, place] = this.moves.pop();
    field.set(text, place);
    this.undoMove.hidden = !this.moves.length;
  }

  // Errors

  #clearField(name) {
    const field = this.element.querySelector(`[data-field="${name}"]`);
    field?.classList.remove("wrong");
    const slot = field?.querySelector(":scope > .slot");
    if (slot) fill(slot);
  }

  #fail(name, problem) {
    const place = { start: this.start, goal: this.goal }[name] || (name?.startsWith("via.") ? this.vias[Number(name.slice(4))] : null);
    if (place) { place.fail(problem); place.element.scrollIntoView({ block: "center" }); place.input.focus(); return; }
    const field = this.element.querySelector(`[data-field="${name}"]`);
    const slot = field?.querySelector(":scope > .slot");
    const parts = [errorBox(problem), remedyButtons(problem, this, (shown) => this.#remedied(shown))];
    if (!slot) { fill(this.problem, ...parts.filter(Boolean)); this.problem.scrollIntoView({ block: "center" }); return; }
    field.closest("details")?.setAttribute("open", "");
    field.classList.add("wrong");
    fill(slot, ...parts.filter(Boolean));
    field.scrollIntoView({ block: "center" });
    field.querySelector("input, select, textarea")?.focus();
  }

  // A remedy was taken: the refusal goes, the changed field is shown.
  #remedied(name) {
    fill(this.problem);
    this.element.querySelectorAll(".wrong[data-field]").forEach((one) => this.#clearField(one.dataset.field));
    const field = this.element.querySelector(`[data-field="${name}"]`);
    field?.closest("details")?.setAttribute("open", "");
    field?.scrollIntoView({ block: "center" });
    field?.querySelector("input, select")?.focus();
    this.element.dispatchEvent(new Event("change"));
  }

  showProblem(problem) {
    const field = problem.field?.replace(/^(voyage|limits)\./, "").replace(/^(seas|traffic|layered)\..*/, "$1");
    const name = { speed: "speed_kn", file: "seas", at_most: "indicators", at_least: "indicators" }[field] || field;
    this.#fail(name, problem);
  }

  // Request

  request() {
    const value = (name) => { const text = this.numbers[name].value.trim().replace(",", "."); return text === "" ? null : Number(text); };
    for (const [name, input] of Object.entries(this.numbers)) {
      if (input.value.trim() && !Number.isFinite(value(name))) return this.#missing(name, `${input.value} is not a number.`, "Give a number, such as 12.5.");
    }
    if (!this.start.value) return this.#missing("start", "The voyage has no start.", "Type a port or a position, or click it on the chart.");
    if (!this.goal.value) return this.#missing("goal", "The voyage has no destination.", "Type a port or a position, or click it on the chart.");
    if (!this.sea.chosen.length) return this.#missing("seas", "No sea is chosen; calm weather is never assumed.", "Choose the storm of 1998, a calm sea, or a file.");
    if (!this.depart.value) return this.#missing("depart", "The voyage has no departure.", "Give a date and a time in UTC.");
    for (const [name, input] of [["depart", this.depart], ["depart_window", this.latest], ["arrive_by", this.arriveBy]]) {
      if (input.value.trim() && typedTime(input) === null) return this.#missing(name, `${input.value} is not a time.`, "Give year, month, day, hour and minute in UTC, such as 2026-01-31 12:00.");
    }
    const utc = (input) => { const t = typedTime(input); return t === null ? null : `${inputTime(t).replace(" ", "T")}Z`; };
    const voyage = {
      start: this.start.value, goal: this.goal.value, objective: this.objective.value === "alternatives" ? "time" : this.objective.value,
      via: this.vias.map((field) => field.value).filter(Boolean), arrive_by: utc(this.arriveBy),
      forbid: this.forbid.filter(([, input]) => input.checked).map(([name]) => name),
      avoid: this.avoid.value.split(",").map((name) => name.trim()).filter(Boolean),
    };
    if (this.latest.value) voyage.depart_window = [utc(this.depart), utc(this.latest)];
    else voyage.depart = utc(this.depart);
    if (!this.wait.checked) voyage.wait = false;
    for (const name of ["speed_kn", "min_ukc_m", "offing_nm", "fuel_price_usd", "eca_price_factor", "time_price_usd_per_h"]) voyage[name] = value(name);
    for (const name of Object.keys(voyage)) if (voyage[name] === null || (Array.isArray(voyage[name]) && !voyage[name].length)) delete voyage[name];
    const request = { title: this.title.value.trim() || this.defaultTitle(), voyage, ship: this.ship.value, seas: this.sea.chosen, limits: { wave_height_m: value("wave_height_m"), wind_speed_kn: value("wind_speed_kn"), motion_sickness_percent: value("motion_sickness_percent") } };
    if (voyage.objective === "weighted") { voyage.weights = this.weights.value(); if (!voyage.weights) return this.#missing("weights", this.weights.fault.asked, this.weights.fault.remedy); }
    const limited = this.indicators.value();
    if (!limited) return this.#missing("indicators", this.indicators.fault.asked, this.indicators.fault.remedy);
    for (const [side, values] of Object.entries(limited)) if (Object.keys(values).length) voyage[side] = values;
    const fault = this.network.fill(request);
    if (fault) return this.#missing(fault.field, fault.asked, fault.remedy);
    if (this.objective.value === "alternatives") request.most = 5;
    const filled = this.fills.filter(([, select]) => select.value).map(([name, select]) => [name, select.value === "0" ? 0 : select.value]);
    if (filled.length) request.fill = Object.fromEntries(filled);
    if (this.areas.list.length) request.areas = this.areas.features;
    return request;
  }

  defaultTitle() {
    const name = (field) => (field.place?.kind === "port" ? field.place.name : field.value);
    return `${name(this.start)} to ${name(this.goal)}`;
  }

  #missing(field, asked, remedy) {
    this.#fail(field, { asked, remedy });
    return null;
  }

  async submit() {
    fill(this.problem);
    this.element.querySelectorAll(".wrong[data-field]").forEach((field) => this.#clearField(field.dataset.field));
    for (const field of [this.start, this.goal, ...this.vias]) if (field.place) field.clear();
    if (this.sending) return;
    this.sending = true;
    try {
      this.button.textContent = "Reading the files …"; // a plan waits for the ship and the seas that are on their way
      const read = [await this.ship.reading, await this.sea.reading];
      const request = read.includes(false) ? null : this.request();
      this.ship.reading = this.sea.reading = null;
      if (!request) return;
      this.button.textContent = "Sending …";
      const job = await start(this.objective.value === "alternatives" ? "/alternatives" : "/plans", request);
      this.dispatchEvent(new CustomEvent("started", { detail: job }));
    } catch (problem) {
      this.showProblem(problem);
    } finally {
      this.sending = false;
      this.button.textContent = "Plan the voyage";
    }
  }

  // Fill the form with a request.
  set(request) {
    const { voyage } = request;
    this.fresh = true; // the chart has not shown its ends
    fill(this.problem);
    this.element.querySelectorAll(".wrong[data-field]").forEach((field) => this.#clearField(field.dataset.field));
    const text = (place) => (Array.isArray(place) ? `${place[0]}, ${place[1]}` : place || "");
    this.start.set(text(voyage.start));
    this.goal.set(text(voyage.goal));
    this.vias = [];
    (voyage.via || []).forEach((place) => this.addVia(text(place)));
    this.#showVias();
    this.objective.value = request.most ? "alternatives" : voyage.objective || "time";
    this.#objectiveChosen();
    this.weights.set(voyage.weights);
    this.indicators.set(voyage);
    this.network.set(request);
    const input = (value) => (value ? inputTime(seconds(value)) : "");
    this.depart.value = input(voyage.depart_window ? voyage.depart_window[0] : voyage.depart);
    this.latest.value = input(voyage.depart_window?.[1]);
    this.arriveBy.value = input(voyage.arrive_by);
    this.wait.checked = voyage.wait !== false;
    for (const [name, element] of Object.entries(this.numbers)) element.value = voyage[name] ?? request.limits?.[name] ?? "";
    this.forbid.forEach(([name, box]) => { box.checked = (voyage.forbid || []).includes(name); });
    this.avoid.value = (voyage.avoid || []).join(", ");
    this.fills.forEach(([name, select]) => { select.value = String(request.fill?.[name] ?? ""); });
    this.title.value = request.title && request.title !== this.defaultTitle() ? request.title : "";
    this.areas.set(request.areas);
    this.moves = [];
    this.undoMove.hidden = true;
    this.wanted = request; // by the lists that have not arrived
    if (this.ship.list.length) this.ship.show(this.ship.list, request.ship);
    if (this.sea.list) this.sea.show(this.sea.list, request.seas);
    this.#summaries();
  }
}
