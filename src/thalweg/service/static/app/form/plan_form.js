// The form of a voyage. Errors stand at their field; what is missing is said, not greyed out.

import { get, start } from "../common/api.js";
import { errorBox, fill, h, withUnit } from "../common/elements.js";
import { inputTime, position, seconds, time } from "../common/format.js";
import { typedTime } from "../common/typed_time.js";
import { AreaFields } from "./area_fields.js";
import { DataFields } from "./data_fields.js";
import { IndicatorLimits, IndicatorWeights } from "./indicators.js";
import { NetworkFields } from "./network_fields.js";
import { PlaceField } from "./places.js";
import { remedyButtons } from "./remedies.js";
import { RequestFields, showChoice } from "./request_fields.js";
import { SeaChoice } from "./sea_choice.js";
import { ShipChoice } from "./ship_choice.js";
import { VoyageFiles } from "./voyage_files.js";

const OBJECTIVES = [
  ["front", "All trade-offs of time and fuel or cost"], ["time", "Least time"], ["fuel", "Least fuel"], ["cost", "Least cost"],
  ["co2", "Least CO₂"], ["energy", "Least energy"], ["comfort", "Least motion sickness"], ["encounters", "Fewest encounters with ships"], ["inshore", "Least length near land"], ["distance", "Shortest distance"],
  ["weighted", "A weighted sum …"], ["alternatives", "Routes that differ, to choose from"],
];
const CANALS = [["suez", "Suez"], ["panama", "Panama"], ["kiel", "Kiel"], ["corinth", "Corinth"], ["cape-cod", "Cape Cod"]];
export const DEMO = { title: "Halifax to Bishop Rock", ship: "handysize-bulker", seas: ["storm"], voyage: { start: "Halifax", goal: "49.7N 6.5W", depart: "1998-08-31T12:00Z", objective: "time" } };

export class PlanForm extends EventTarget {
  vias = [];
  most = 5; // routes that differ
  moves = []; // what the points were before they were dragged: [field, text, place]

  constructor(chart) {
    super();
    this.chart = chart;
    this.start = new PlaceField("start", "From", (typed) => this.#placesChanged(typed));
    this.goal = new PlaceField("goal", "To", (typed) => this.#placesChanged(typed));
    this.element = h("form", { novalidate: true, class: "form", onsubmit: (event) => { event.preventDefault(); this.submit(); } });
    this.#build();
  }

  async load() {
    const [ships, seas] = await Promise.all([get("/ships"), get("/seas"), this.network.load(), this.data.depths.load()]);
    this.ship.show(ships, this.wanted?.ship);
    this.sea.show(seas, this.wanted?.seas);
  }

  #build() {
    this.element.style.display = "contents";
    this.viaBox = h("div");
    const problemAt = (name) => (problem) => (problem ? this.#fail(name, problem) : this.#clearField(name));
    this.ship = new ShipChoice(problemAt("ship"));
    this.sea = new SeaChoice({ ends: () => this.ends, departs: () => typedTime(this.depart), changed: (byHand) => this.#seaChanged(byHand), problemAt: problemAt("seas") });
    this.areas = new AreaFields(this.chart, () => this.#summaries());
    this.depart = h("input", { type: "text", id: "depart", autocomplete: "off", placeholder: "2026-01-31 12:00" });
    this.latest = h("input", { type: "text", id: "latest", autocomplete: "off", placeholder: "2026-01-31 12:00" });
    this.departFacts = h("p.facts");
    this.weights = new IndicatorWeights();
    this.indicators = new IndicatorLimits(() => this.#summaries());
    this.network = new NetworkFields();
    this.objective = h("select", { id: "objective", onchange: () => this.#objectiveChosen() }, OBJECTIVES.map(([value, text]) => h("option", { value }, text)));
    this.objective.value = "time";
    this.title = h("input", { type: "text", id: "title", maxlength: 200, placeholder: "Name of this plan" });
    this.fields = new RequestFields();
    this.data = new DataFields((list) => this.sea.show(list));
    this.problem = h("div");
    this.forbid = CANALS.map(([value, text]) => [value, h("input", { type: "checkbox", id: `forbid-${value}` }), text]);
    this.fills = ["waves", "wind", "currents"].map((name) => [name, h("select", { id: `fill-${name}` },
      h("option", { value: "" }, "closed water"), h("option", { value: "0" }, "none (0)"), h("option", { value: "nearest:25" }, "nearest value within 25 nm"),
      name === "wind" ? h("option", { value: "waves" }, "that which raises the waves") : [],
      name === "waves" ? [h("option", { value: "wind" }, "those that the wind raises"), h("option", { value: "head_seas" }, "head seas, where only heights are known")] : [])]);
    this.button = h("button.primary", { type: "submit" }, "Plan the voyage");
    this.files = new VoyageFiles(this);
    this.undoMove = h("button.quiet.small", { type: "button", hidden: true, onclick: () => this.#undoMove() }, "Undo move");
    const swap = h("button.quiet.small", { type: "button", onclick: () => this.#swap() }, "⇅ Swap");
    const addVia = h("button.quiet.small", { type: "button", onclick: () => this.addVia() }, "+ Via point");
    const { fields } = this;
    const body = h("div.scroll", {},
      h("h1", {}, "Plan a voyage"),
      h("p.lead", {}, "Type the ends or click them on the chart, or ", h("button.link", { type: "button", onclick: () => this.set(DEMO) }, "fill in an example"), "."),
      h("div.block", {}, h("div.itinerary", {}, this.start.element, this.viaBox, this.goal.element), h("div.row.ends", {}, h("span"), this.undoMove, swap, addVia)),
      h("div.block", {},
        this.ship.element),
      this.sea.element,
      h("div.block", {},
        h("div.field", { "data-field": "depart" }, h("label.label", { for: "depart" }, "Departure"), withUnit(this.depart, "UTC"), this.departFacts, h("div.slot")),
        h("div.field", { "data-field": "objective" }, h("label.label", { for: "objective" }, "Objective"), this.objective, h("div.slot")), this.weights.element),
      h("div.block", {},
        this.#details("time", "Time and speed", [
          fields.pair("arrive_by", "speed_kn", ".time"),
          h("div.field", { "data-field": "depart_window" }, h("label.label", { for: "latest" }, "Latest departure"), withUnit(this.latest, "UTC"), h("div.slot")),
          fields.field("wait"), fields.pair("arrive", "speed_block_h", ".time"), fields.field("speed_step_kn"), fields.field("hold"),
          h("p.facts", {}, "Latest departure: the best time between is found. Arrive at: one speed is found that arrives in the minute before it. Hold for: a chosen speed is kept for at least so long. Also speeds between: a plan that chooses speeds takes others than the settings of the ship, too."),
        ]),
        this.#details("limits", "Limits", [
          fields.pair("wave_height_m", "wind_speed_kn"), fields.pair("min_ukc_m", "offing_nm"), fields.field("motion_sickness_percent"),
          h("p.facts", {}, "Empty: as the ship file states; the distance from land by the size of the ship."),
        ]),
        this.#details("indicators", "Limits of key figures", [this.indicators.element]),
        this.#details("areas", "Areas to avoid", [this.areas.element]),
        this.#details("canals", "Canals and passages", [
          h("fieldset", { "data-field": "forbid" }, h("legend", {}, "Do not use"), this.forbid.map(([, input, text]) => h("label.check", {}, input, h("span", {}, text))), h("div.slot")),
          fields.field("avoid"), fields.field("open"),
        ]),
        this.#details("prices", "Prices and charges", [
          fields.pair("fuel_price_usd", "eca_price_factor"), fields.field("time_price_usd_per_h"), fields.field("eca"),
          h("p.facts", {}, "Empty: the prices of the ship file. Canal dues are those of the package."),
          h("fieldset.part", {}, h("legend", {}, "Charges of the European Union"), fields.pair("ets_price", "eur_rate"), fields.pair("share_percent", "year"),
            h("p.facts", {}, "An allowance for each tonne of CO₂; the price of a euro adds the FuelEU penalty. Both empty: no charges.")),
        ]),
        this.#details("chart", "Ship's load, chart and depth", [
          fields.pair("load_factor", "coast"), this.data.depthElement, fields.field("ignore_shoals"), fields.field("ignore_lanes"),
        ]),
        this.#details("traffic", "Other ships", [this.network.trafficElement]),
        this.#details("network", "Network and search", [this.network.element, fields.field("method"), fields.pair("ensemble", "seed")]),
        this.#details("fill", "Data of the sea", [
          h("p.facts", {}, "Water without data is closed; it never becomes calm. A filling is noted in the result."),
          this.fills.map(([name, select]) => h("div.field", { "data-field": "fill" }, h("label.label", { for: select.id }, `Unknown ${name}`), select, h("div.slot"))),
          fields.pair("sampling", "average_over_m"), this.data.nameElement,
        ]),
        this.#details("files", "Route files", [
          fields.pair("legs", "rtz_version"), fields.pair("cross_track_nm", "waypoint_spacing_nm"), fields.field("max_waypoints"),
          h("p.facts", {}, "Empty: the lines of a file stay within 0.1 nm of the route. With fewer waypoints this limit grows, and the result says how far."),
        ]),
        h("div.field", {}, h("label.label", { for: "title" }, "Name"), this.title),
        this.files.element),
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

  #summaries() {
    const set = (...names) => this.fields.words(names);
    const said = {
      time: [...set("speed_kn", "arrive_by"), this.latest.value ? "window" : "", ...set("wait", "arrive", "speed_step_kn", "speed_block_h", "hold")],
      limits: set("wave_height_m", "wind_speed_kn", "motion_sickness_percent", "min_ukc_m", "offing_nm"),
      areas: [this.areas.list.length + this.areas.kept.length ? `${this.areas.list.length + this.areas.kept.length} drawn` : ""],
      canals: [...this.forbid.filter(([, input]) => input.checked).map(([, , name]) => `no ${name}`), ...set("avoid", "open")],
      indicators: [this.indicators.words],
      traffic: [this.network.traffic.chosen.length ? `${this.network.traffic.chosen.length} chosen` : ""],
      network: [...this.network.words, ...set("method", "ensemble", "seed")],
      prices: set("fuel_price_usd", "eca_price_factor", "time_price_usd_per_h", "eca", "ets_price", "eur_rate", "share_percent"),
      chart: [...set("load_factor", "coast"), this.data.depths.chosen.length ? "depth from files" : "", ...set("ignore_shoals", "ignore_lanes")],
      fill: [...this.fills.filter(([, select]) => select.value).map(([name, select]) => `${name}: ${select.selectedOptions[0].text}`), ...set("sampling", "average_over_m")],
      files: set("legs", "rtz_version", "cross_track_nm", "waypoint_spacing_nm", "max_waypoints"),
    };
    for (const [name, parts] of Object.entries(said)) this.parts[name].said.textContent = parts.filter(Boolean).join(", ");
  }

  // Places

  addVia(text = "", position = null) {
    const field = new PlaceField("via", `Via ${this.vias.length + 1}`, (typed) => this.#placesChanged(typed));
    field.tools.append(h("button.quiet", { type: "button", "aria-label": "Remove this via point", onclick: () => { this.vias = this.vias.filter((one) => one !== field); this.#showVias(); } }, "✕"));
    this.vias.push(field);
    this.#showVias();
    if (position) field.setPosition(...position);
    else if (text) field.set(text);
    else field.input.focus();
  }

  removeVias() {
    this.vias = [];
    this.moves = [];
    this.undoMove.hidden = true;
    this.#showVias();
  }

  #showVias() {
    this.vias.forEach((field, i) => { field.element.querySelector("label").textContent = `Via ${i + 1}`; field.element.dataset.field = `via.${i}`; });
    fill(this.viaBox, this.vias.map((field) => field.element));
    this.#placesChanged();
  }

  // The menu at a clicked position or port.
  offer({ lat, lon, port, coordinate }) {
    const name = port ? port.locode || port.label : "";
    const set = (field) => () => (port ? field.set(name) : field.setPosition(lat, lon));
    this.chart.choose(coordinate, port ? port.label : position(lat, lon), [["From here", set(this.start)], ["To here", set(this.goal)], ["Via here", () => this.addVia(name, port ? null : [lat, lon])], ["Close", () => {}]]);
  }

  #swap() {
    const [a, pa, b, pb] = [this.start.value, this.start.place, this.goal.value, this.goal.place];
    this.start.set(b, pb);
    this.goal.set(a, pa);
  }

  // Whether each place that is given was understood.
  get placesKnown() {
    return this.ends.length > 0 && [this.start, ...this.vias, this.goal].every((field) => !field.value || (field.place && field.asked === field.value));
  }

  get ends() {
    return [this.start, ...this.vias, this.goal].filter((field) => field.place).map((field) => ({ role: field.role, ...field.spot, label: field.place.kind === "port" ? field.place.display_name : "" }));
  }

  #placesChanged(typed = false) {
    if (!this.goal) return;
    this.fresh ||= typed; // the chart goes to it
    this.dispatchEvent(new Event("places"));
  }

  #seaChanged(byHand = false) {
    const { period } = this.sea, calm = this.sea.chosen[0] === "calm";
    this.departFacts.textContent = period ? `Data from ${time(period[0])} to ${time(period[1], true)}` : "";
    const proposal = period ? period[0] : calm && byHand ? Math.ceil(Date.now() / 3.6e6) * 3600 : null;
    if (proposal !== null && [this.proposed, ""].includes(this.depart.value)) this.depart.value = this.proposed = inputTime(proposal); // until another is typed
    this.dispatchEvent(new Event("seas"));
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
    const slot = field?.querySelector(":scope > .slot"), label = field?.querySelector("label, legend")?.firstChild?.textContent?.trim();
    if (slot && label && problem.field?.includes(".")) for (const part of ["asked", "possible", "remedy"]) problem[part] = problem[part]?.replaceAll(problem.field, label); // not the words of programs
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
    const field = problem.field?.replace(/^(voyage|limits|charges|route_files)\./, "").replace(/^(seas|traffic|layered|depths|fill|forbid)\..*/, "$1");
    const name = { speed: "speed_kn", file: "seas", at_most: "indicators", at_least: "indicators" }[field] || field;
    this.#fail(name, problem);
  }

  // Request

  request() {
    if (!this.start.value) return this.#missing("start", "The voyage has no start.", "Type a port or a position, or click it on the chart.");
    if (!this.goal.value) return this.#missing("goal", "The voyage has no destination.", "Type a port or a position, or click it on the chart.");
    if (!this.sea.chosen.length) return this.#missing("seas", "No sea is chosen; calm weather is never assumed.", "Choose a file, a forecast, a calm sea, or the storm of 1998 as an example.");
    if (!this.depart.value && !this.fields.inputs.arrive.value) return this.#missing("depart", "The voyage has no departure.", "Give a date and a time in UTC.");
    if (this.areas.drawing) return this.#missing("areas", "An area is still being drawn.", "Finish it, or leave it out.");
    for (const [name, input] of [["depart", this.depart], ["depart_window", this.latest]]) {
      if (input.value.trim() && typedTime(input) === null) return this.#missing(name, `${input.value} is not a time.`, "Give year, month, day, hour and minute in UTC, such as 2026-01-31 12:00.");
    }
    const utc = (input) => { const t = typedTime(input); return t === null ? null : `${inputTime(t).replace(" ", "T")}Z`; };
    const voyage = {
      start: this.start.value, goal: this.goal.value, objective: this.objective.value === "alternatives" ? "time" : this.objective.value,
      via: this.vias.map((field) => field.value).filter(Boolean),
      forbid: this.forbid.filter(([, input]) => input.checked).map(([name]) => name),
    };
    if (this.latest.value) voyage.depart_window = [utc(this.depart), utc(this.latest)];
    else if (this.depart.value) voyage.depart = utc(this.depart);
    for (const name of ["via", "forbid"]) if (!voyage[name].length) delete voyage[name];
    const request = { title: this.title.value.trim() || this.defaultTitle(), voyage, ship: this.ship.value, seas: this.sea.chosen };
    const fault = this.#fillParts(request);
    if (fault) return this.#missing(fault.field, fault.asked, fault.remedy);
    if (request.charges && Object.keys(request.charges).join() === "year") delete request.charges;
    if (voyage.objective === "weighted") { voyage.weights = this.weights.value(); if (!voyage.weights) return this.#missing("weights", this.weights.fault.asked, this.weights.fault.remedy); }
    const limited = this.indicators.value();
    if (!limited) return this.#missing("indicators", this.indicators.fault.asked, this.indicators.fault.remedy);
    for (const [side, values] of Object.entries(limited)) if (Object.keys(values).length) voyage[side] = values;
    if (this.objective.value === "alternatives") request.most = this.most;
    const filled = this.fills.filter(([, select]) => select.value).map(([name, select]) => [name, fillOf(select.value)]);
    if (filled.length) request.fill = Object.fromEntries(filled);
    return request;
  }

  #fillParts(request) {
    if (this.areas.list.length || this.areas.kept.length) request.areas = this.areas.features;
    return this.fields.fill(request) || this.data.fill(request) || this.network.fill(request);
  }

  // What is set beside the voyage itself, whether it is right or not.
  settings() {
    const found = { voyage: {} };
    this.#fillParts(found);
    return found;
  }

  defaultTitle() {
    const name = (field) => (field.place?.kind === "port" ? field.place.display_name : field.value);
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
    this.proposed = null;
    this.fresh = true; // the chart has not shown its ends
    fill(this.problem);
    this.element.querySelectorAll(".wrong[data-field]").forEach((field) => this.#clearField(field.dataset.field));
    const text = (place) => (Array.isArray(place) ? `${place[0]}, ${place[1]}` : place || "");
    this.start.set(text(voyage.start));
    this.goal.set(text(voyage.goal));
    this.removeVias();
    (voyage.via || []).forEach((place) => this.addVia(text(place)));
    this.objective.value = request.most ? "alternatives" : voyage.objective || "time";
    this.#objectiveChosen();
    this.weights.set(voyage.weights);
    this.indicators.set(voyage);
    this.network.set(request);
    const input = (value) => (value ? inputTime(seconds(value)) : "");
    this.depart.value = input(voyage.depart_window ? voyage.depart_window[0] : voyage.depart);
    this.latest.value = input(voyage.depart_window?.[1]);
    this.fields.set(request);
    this.data.set(request);
    this.most = request.most ?? 5;
    this.forbid.forEach(([name, box]) => { box.checked = [voyage.forbid || []].flat().some((one) => one === name || one === "all"); });
    this.fills.forEach(([name, select]) => showChoice(select, [request.fill?.[name] ?? ""].flat().join(", then ")));
    this.title.value = request.title && request.title !== this.defaultTitle() ? request.title : "";
    this.areas.set(request.areas);
    this.wanted = request; // by the lists that have not arrived
    if (this.ship.list.length) this.ship.show(this.ship.list, request.ship);
    if (this.sea.list) this.sea.show(this.sea.list, request.seas);
    this.#summaries();
  }
}

// The filling of an entry of a list: a number or a name, or several in turn.
function fillOf(text) {
  const values = text.split(", then ").map((one) => (Number.isFinite(Number(one)) ? Number(one) : one));
  return values.length > 1 ? values : values[0];
}
