// The form of a voyage. Errors stand at their field; what is missing is said, not greyed out.

import { get, post, start, uploadForm, uploadSea } from "./api.js";
import { announce, errorBox, fill, h } from "./elements.js";
import { inputTime, known, number, seconds, time } from "./format.js";
import { ForecastFetch } from "./forecast_fetch.js";
import { IndicatorLimits, IndicatorWeights } from "./indicators.js";
import { NetworkFields } from "./network_fields.js";
import { PlaceField } from "./places.js";
import { typedTime } from "./typed_time.js";

const OBJECTIVES = [
  ["front", "All trade-offs of time and fuel"], ["time", "Least time"], ["fuel", "Least fuel"], ["cost", "Least cost"],
  ["co2", "Least CO₂"], ["energy", "Least energy"], ["comfort", "Least motion sickness"], ["encounters", "Fewest encounters with ships"], ["inshore", "Least length near land"], ["distance", "Shortest distance"],
  ["weighted", "A weighted sum …"], ["alternatives", "Routes that differ, to choose from"],
];
const CANALS = [["suez", "Suez"], ["panama", "Panama"], ["kiel", "Kiel"], ["corinth", "Corinth"]];
export const DEMO = { title: "Halifax to Bishop Rock", ship: "handysize-bulker", seas: ["storm"], voyage: { start: "Halifax", goal: "49.7N 6.5W", depart: "1998-08-31T12:00Z", objective: "time" } };

export class PlanForm extends EventTarget {
  areas = [];
  vias = [];

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
    this.ships = ships;
    this.seas = seas;
    this.#showShips();
    this.#showSeas();
  }

  #build() {
    this.element.style.display = "contents";
    this.viaBox = h("div");
    this.ship = h("select", { id: "ship", onchange: () => this.#showSheet() });
    this.sheet = h("p.facts", { id: "ship-facts" });
    this.shipFile = h("input.hidden", { type: "file", id: "ship-file", "aria-label": "Ship file", accept: ".yaml,.yml,.json", tabindex: "-1", onchange: () => this.#uploadShip() });
    this.seaBox = h("div");
    this.seaFile = h("input.hidden", { type: "file", id: "sea-file", "aria-label": "Sea files", accept: ".nc,.nc4,.grb,.grb2,.grib,.grib2", multiple: true, tabindex: "-1", onchange: () => this.#uploadSeas([...this.seaFile.files]) });
    this.drop = h("div.drop", {
      ondragover: (event) => { event.preventDefault(); this.drop.classList.add("over"); },
      ondragleave: () => this.drop.classList.remove("over"),
      ondrop: (event) => { event.preventDefault(); this.drop.classList.remove("over"); this.#uploadSeas([...event.dataTransfer.files]); },
    }, "Drop a GRIB or NetCDF file here, or ", h("button.link", { type: "button", onclick: () => this.seaFile.click() }, "choose a file"), ".");
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
    this.areaBox = h("div");
    this.wait = h("input", { type: "checkbox", id: "wait", checked: true });
    this.forbid = CANALS.map(([value, text]) => [value, h("input", { type: "checkbox", id: `forbid-${value}` }), text]);
    this.avoid = h("input", { type: "text", id: "avoid", placeholder: "Pentland Firth, ..." });
    this.fills = ["waves", "wind", "currents"].map((name) => [name, h("select", { id: `fill-${name}` },
      h("option", { value: "" }, "closed water"), h("option", { value: "0" }, "none (0)"), h("option", { value: "nearest:25" }, "nearest value within 25 nm"),
      name === "waves" ? [h("option", { value: "wind" }, "those that the wind raises"), h("option", { value: "head_seas" }, "head seas, where only heights are known")] : [])]);
    this.button = h("button.primary", { type: "submit" }, "Plan the voyage");
    this.fetch = new ForecastFetch(() => this.ends, () => typedTime(this.depart), () => this.chosenSeas, (seas, before) => this.#fetched(seas, before));
    this.voyageFile = h("input.hidden", { type: "file", id: "voyage-file", "aria-label": "Voyage file", accept: ".json,.yaml,.yml", tabindex: "-1", onchange: () => this.#openFile() });
    const swap = h("button.quiet.small", { type: "button", onclick: () => this.#swap() }, "⇅ Swap");
    const addVia = h("button.quiet.small", { type: "button", onclick: () => this.addVia() }, "+ Via point");
    const body = h("div.scroll", {},
      h("h1", {}, "Plan a voyage"),
      h("p.lead", {}, "Type the ends or click them on the chart."),
      h("div.block", {}, h("div.itinerary", {}, this.start.element, this.viaBox, this.goal.element), h("div.row", { style: null }, h("span"), swap, addVia)),
      h("div.block", {},
        h("div.field", { "data-field": "ship" }, h("label.label", { for: "ship" }, "Ship"), h("div.row", {}, this.ship, h("button.quiet", { type: "button", onclick: () => this.shipFile.click() }, "Ship file …")), this.shipFile, this.sheet, h("div.slot"))),
      h("fieldset.block", { "data-field": "seas" }, h("legend", {}, "Sea"), this.seaBox, this.drop, this.seaFile, this.fetch.element, h("div.slot")),
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
        this.#details("areas", "Areas to avoid", [this.areaBox]),
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
    this.#showAreas();
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
      areas: [this.areas.length ? `${this.areas.length} drawn` : ""],
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

  // Ship

  #showShips(chosen = this.ship.value || "handysize-bulker") {
    fill(this.ship, this.ships.map((ship) => h("option", { value: ship.id }, ship.name)));
    this.ship.value = chosen;
    if (!this.ship.value) this.ship.selectedIndex = 0;
    this.#showSheet();
  }

  async #showSheet() {
    const id = this.ship.value;
    this.sheet.textContent = " ";
    try {
      const sheet = await get(`/ships/${encodeURIComponent(id)}`);
      if (id !== this.ship.value) return;
      const speeds = (sheet.settings?.length ? sheet.settings : sheet.conditions || []).map((row) => row.speed_kn).filter(known);
      this.speedRange = speeds.length ? [Math.min(...speeds), Math.max(...speeds)] : null;
      const parts = [];
      if (this.speedRange) parts.push(`${number(this.speedRange[0], 1)} to ${number(this.speedRange[1], 1)} kn`);
      if (known(sheet.draught_m)) parts.push(`draught ${number(sheet.draught_m, 1)} m`);
      if (known(sheet.limits?.wave_height_m)) parts.push(`waves up to ${number(sheet.limits.wave_height_m, 1)} m`);
      this.sheet.textContent = parts.join(" · ") || sheet.name;
    } catch (problem) {
      this.sheet.textContent = problem.asked || "";
    }
  }

  async #uploadShip() {
    const [file] = this.shipFile.files;
    this.shipFile.value = "";
    if (!file) return;
    this.#clearField("ship");
    const before = this.ship.value;
    try {
      const ship = await uploadForm("/ships", file);
      this.ships = await get("/ships");
      const chosen = this.ship.value === before; // another choice that was made meanwhile stays
      this.#showShips(chosen ? ship.id : this.ship.value);
      announce(chosen ? `Ship ${ship.name} is chosen.` : `Ship ${ship.name} is in the list.`);
    } catch (problem) {
      this.#fail("ship", problem);
    }
  }

  // Sea

  get chosenSeas() {
    return [...this.seaBox.querySelectorAll("input:checked")].map((input) => input.value);
  }

  #showSeas(chosen = null) {
    const before = chosen || (this.seaBox.childElementCount ? this.chosenSeas : ["storm"]);
    fill(this.seaBox, this.seas.slice().sort((a, b) => Boolean(a.embedded) - Boolean(b.embedded) || (a.id === "calm") - (b.id === "calm")).map((sea) => h("label.check", {},
      h("input", { type: "checkbox", value: sea.id, checked: before.includes(sea.id), onchange: (event) => this.#seaChosen(event.target) }),
      h("span", {}, sea.embedded ? sea.name.split(":")[0] : sea.name, h("small", {}, this.#seaFacts(sea))))));
    this.#seaChosen(null);
  }

  #seaFacts(sea) {
    if (sea.id === "calm") return "no wind, waves and currents anywhere";
    const period = sea.start ? `${time(seconds(sea.start))} to ${time(seconds(sea.end), true)}` : "at all times";
    return `${(sea.frames || []).join(", ") || "no field to draw"} · ${period}${sea.members ? ` · ${sea.members} members` : ""}`;
  }

  #seaChosen(input) {
    if (input?.checked) {
      for (const other of this.seaBox.querySelectorAll("input")) if (other !== input && (input.value === "calm" || other.value === "calm")) other.checked = false;
    }
    const period = this.period;
    this.departFacts.textContent = period ? `Data from ${time(period[0])} to ${time(period[1], true)}` : "";
    if (!this.depart.value && period) this.depart.value = inputTime(period[0]);
    this.#clearField("seas");
    this.dispatchEvent(new Event("seas"));
  }

  get period() {
    const rows = this.chosenSeas.map((id) => this.seas.find((sea) => sea.id === id)).filter((sea) => sea?.start);
    return rows.length ? [Math.max(...rows.map((sea) => seconds(sea.start))), Math.min(...rows.map((sea) => seconds(sea.end)))] : null;
  }

  // The start of the oldest forecast among the chosen seas; null where none is known.
  get run() {
    const runs = this.chosenSeas.map((id) => this.seas.find((sea) => sea.id === id)?.run).filter(Boolean);
    return runs.length ? Math.min(...runs.map(seconds)) : null;
  }

  get frameKinds() {
    return [...new Set(this.chosenSeas.flatMap((id) => this.seas.find((sea) => sea.id === id)?.frames || []))];
  }

  async #uploadSeas(files) {
    this.seaFile.value = "";
    for (const file of files) {
      this.#clearField("seas");
      const bar = h("progress", { max: 1, value: 0, "aria-label": `Upload of ${file.name}` });
      this.drop.append(bar);
      try {
        const sea = await uploadSea(file, (share) => { bar.value = share; });
        this.seas = await get("/seas");
        this.#showSeas([...this.chosenSeas.filter((id) => id !== "calm" && id !== "storm"), sea.id]);
        announce(`${file.name} is read.`);
      } catch (problem) {
        this.#fail("seas", problem);
      }
      bar.remove();
    }
  }

  // A forecast takes the place of the seas that were chosen when its download began.
  async #fetched(seas, before) {
    this.seas = await get("/seas");
    const same = String(this.chosenSeas) === String(before);
    this.#showSeas(same ? seas : this.chosenSeas);
    if (!same) announce("The forecast is in the list of seas.");
  }

  openForecast(job) {
    this.fetch.watch(job);
    this.fetch.element.scrollIntoView({ block: "center" });
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
    const fields = [this.start, ...this.vias, this.goal].filter((field) => field.place);
    fields[number_]?.setPosition(lat, lon);
  }

  // Areas

  async #drawArea(kind) {
    const hint = document.getElementById("hint");
    hint.textContent = "Click the corners; double click the last one. Escape stops.";
    hint.hidden = false;
    const ring = await this.chart.draw();
    hint.hidden = true;
    if (ring) this.#changeAreas([...this.areas, { kind, factor: kind === "penalty" ? 2 : null, ring }]);
  }

  #changeAreas(areas) {
    (this.undo ||= []).push(this.areas);
    this.areas = areas;
    this.#showAreas();
    this.#summaries();
  }

  #showAreas() {
    const asText = (ring) => ring.slice(0, -1).map(([lon, lat]) => `${lat}, ${lon}`).join("\n");
    fill(this.areaBox,
      this.areas.length ? null : h("p.facts", {}, "Closed areas (no-go), and areas where each mile counts more (penalty). Drag a corner to move it."),
      this.areas.map((area, i) => h("div.field", {}, h("div.row", {}, h("b", {}, `${i + 1}. ${area.kind === "no-go" ? "No-go" : `Penalty × ${area.factor}`}`),
        h("button.quiet.small", { type: "button", onclick: () => this.#changeAreas(this.areas.filter((one) => one !== area)) }, "Remove")),
        h("label.hidden", { for: `area-${i}` }, `Corners of area ${i + 1}: latitude, longitude`),
        h("textarea", { id: `area-${i}`, rows: Math.min(6, area.ring.length - 1), onchange: (event) => this.#typedArea(i, event.target.value) }, asText(area.ring)))),
      h("div.field", {}, h("div.row", {}, h("button.quiet.small", { type: "button", onclick: () => this.#drawArea("no-go") }, "Draw no-go"), h("button.quiet.small", { type: "button", onclick: () => this.#drawArea("penalty") }, "Draw penalty"),
        this.undo?.length ? h("button.quiet.small", { type: "button", onclick: () => { this.areas = this.undo.pop(); this.#showAreas(); this.#summaries(); } }, "Undo") : null),
      h("button.link", { type: "button", onclick: () => this.#areaInView() }, "Add an area in the middle of the chart, to type its corners")));
    this.chart.showAreas(this.areas, (i, ring) => {
      if (JSON.stringify(ring) !== JSON.stringify(this.areas[i]?.ring)) this.#changeAreas(this.areas.map((area, k) => (k === i ? { ...area, ring } : area)));
    });
  }

  #areaInView() {
    const [w, s, e, n] = this.chart.view;
    const at = (a, b, f) => Number((a + f * (b - a)).toFixed(2));
    const [x0, x1, y0, y1] = [at(w, e, 0.45), at(w, e, 0.55), at(s, n, 0.45), at(s, n, 0.55)];
    this.#changeAreas([...this.areas, { kind: "no-go", factor: null, ring: [[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]] }]);
  }

  #typedArea(i, text) {
    const ring = text.split("\n").map((row) => row.split(/[,;\s]+/).filter(Boolean).map(Number)).filter((row) => row.length === 2 && row.every(Number.isFinite)).map(([lat, lon]) => [lon, lat]);
    if (ring.length >= 3) this.#changeAreas(this.areas.map((area, k) => (k === i ? { ...area, ring: [...ring, ring[0]] } : area)));
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
    if (!slot) { fill(this.problem, errorBox(problem)); this.problem.scrollIntoView({ block: "center" }); return; }
    field.closest("details")?.setAttribute("open", "");
    field.classList.add("wrong");
    fill(slot, errorBox(problem));
    field.scrollIntoView({ block: "center" });
    field.querySelector("input, select, textarea")?.focus();
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
    if (!this.chosenSeas.length) return this.#missing("seas", "No sea is chosen; calm weather is never assumed.", "Choose the storm of 1998, a calm sea, or a file.");
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
    const request = { title: this.title.value.trim() || this.defaultTitle(), voyage, ship: this.ship.value, seas: this.chosenSeas, limits: { wave_height_m: value("wave_height_m"), wind_speed_kn: value("wind_speed_kn"), motion_sickness_percent: value("motion_sickness_percent") } };
    if (voyage.objective === "weighted") { voyage.weights = this.weights.value(); if (!voyage.weights) return this.#missing("weights", this.weights.fault.asked, this.weights.fault.remedy); }
    const limited = this.indicators.value();
    if (!limited) return this.#missing("indicators", this.indicators.fault.asked, this.indicators.fault.remedy);
    for (const [side, values] of Object.entries(limited)) if (Object.keys(values).length) voyage[side] = values;
    const fault = this.network.fill(request);
    if (fault) return this.#missing(fault.field, fault.asked, fault.remedy);
    if (this.objective.value === "alternatives") request.most = 5;
    const filled = this.fills.filter(([, select]) => select.value).map(([name, select]) => [name, select.value === "0" ? 0 : select.value]);
    if (filled.length) request.fill = Object.fromEntries(filled);
    if (this.areas.length) request.areas = { type: "FeatureCollection", features: this.areas.map((area) => ({ type: "Feature", properties: area.kind === "no-go" ? { kind: "no-go" } : { kind: area.kind, factor: area.factor }, geometry: { type: "Polygon", coordinates: [area.ring] } })) };
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
    if (this.sending) return;
    const request = this.request();
    if (!request) return;
    this.sending = true;
    this.button.textContent = "Sending …";
    try {
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
    this.areas = (request.areas?.features || []).filter((f) => f.geometry?.type === "Polygon").map((f) => ({ kind: f.properties.kind, factor: f.properties.factor ?? null, ring: f.geometry.coordinates[0] }));
    this.#showAreas();
    if (this.ships) this.#showShips(request.ship || this.ship.value);
    if (this.seas) this.#showSeas(request.seas || this.chosenSeas);
    this.#summaries();
  }
}
