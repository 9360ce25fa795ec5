// Two to six routes side by side, with differences to the first; ready studies and scored files.

import { follow, get, hasEnded, post, uploadForm } from "../common/api.js";
import { errorBox, fill, h, withUnit } from "../common/elements.js";
import { EXAMPLES, keyOf, VARIATIONS } from "./examples.js";
import { drawCompared, PAINTS } from "./result_drawing.js";
import { faultWords } from "../common/faults.js";
import { difference, duration, isCalm, known, number, readable, seconds, signed, time, titleOf } from "../common/format.js";

const MOST = 6;
// Column, name in the answer, decimals (of time: minutes), text, text of a difference (null: none is shown).
// Differences are those of the rounded figures, so that they agree with what stands beside them.
const FIGURES = [
  ["Time", "time_h", null, duration, (v) => (v ? `${v < 0 ? "−" : "+"}${duration(Math.abs(v))}` : "0 min")],
  ["Distance", "distance_nm", 1, (v) => `${number(v, 1)} nm`, (v) => signed(v, 1)],
  ["Fuel", "fuel_t", 1, (v) => (known(v) ? `${number(v, 1)} t` : "unknown"), (v) => signed(v, 1)],
  ["Cost", "cost", 0, (v, row) => (known(v) ? `${number(v)} ${row.currency}` : "unknown"), (v) => signed(v, 0)],
  ["CO₂", "co2_t", 0, (v) => (known(v) ? `${number(v)} t` : "unknown"), (v) => signed(v, 0)],
  ["Waves up to", "highest_waves_m", 1, (v) => (known(v) ? `${number(v, 1)} m` : "unknown"), null],
  ["Wind up to", "strongest_wind_kn", 0, (v) => (known(v) ? `${number(v)} kn` : "unknown"), null],
];
const WEATHER = ["highest_waves_m", "strongest_wind_kn"];

export class CompareView {
  drawn = []; // what the chart shows: {name, points}
  chosen = []; // {job, number, title}, the first is the reference

  /**
   * @param {Chart} chart
   * @param {{shipName: (id: string) => string, sheet: (element: Element) => void, update: (address: string) => void, hidden: () => boolean}} handlers
   */
  constructor(chart, handlers) {
    Object.assign(this, { chart, handlers });
    this.list = h("div.pick");
    this.picked = h("ol.picked");
    this.counted = h("span.set");
    this.problem = h("div.messages");
    this.speed = h("input", { type: "text", inputmode: "decimal", id: "own-speed", autocomplete: "off" });
    this.file = h("input.hidden", { type: "file", id: "route-file", "aria-label": "Route file", accept: ".rtz,.rtzp,.gml,.gpx,.geojson,.json,.kml,.csv", tabindex: "-1", onchange: () => this.#score() });
    this.element = [h("div.scroll", {}, h("h1", {}, "Compare routes"), h("p.lead", {}, "Choose two to six. The differences are those to the reference. A plan stands here with its first route; its others are below it."), this.problem, h("div.block", {}, h("h2.with-count", {}, "Chosen", this.counted), this.picked), h("div.block", {}, h("h2", {}, "Routes to choose from"), this.list), h("div.block", {}, h("h2", {}, "Examples"), EXAMPLES.map((example) => h("button.job.example", { type: "button", onclick: () => this.#example(example) }, h("b", {}, example.name), h("span", {}, example.facts)))), h("div.block", {}, h("h2", {}, "Vary the reference"), h("p.facts", {}, "Its voyage is planned again with one change, and the results are added."), h("div.exports", {},
      VARIATIONS.map(([text, plans]) => h("button.quiet.small", { type: "button", onclick: () => this.#study(plans) }, text))),
    h("div.block", {}, h("h2", {}, "A route of your own"), h("p.facts", {}, "An RTZ, S-421, GPX, GeoJSON, KML or CSV file is sailed in the weather and by the ship of the reference, from the time in the file; its speeds and arrival are not used."), h("div.field", {}, h("label.label", { for: "own-speed" }, "Speed"), withUnit(this.speed, "kn"), h("p.facts", {}, "Empty: the highest of the ship.")), h("button.quiet.small", { type: "button", onclick: () => this.file.click() }, "Score a route file …"), this.file)))];
  }

  add(job, number_, title) {
    if (this.chosen.some((one) => one.job === job && one.number === number_)) return;
    if (this.chosen.length < MOST) this.chosen.push({ job, number: number_, title });
  }

  // What the address says: job.number, with commas between them.
  get address() {
    return this.chosen.map(({ job, number: n }) => `${job}.${n}`).join(",");
  }

  set address(text) {
    this.chosen = text.split(",").map((one) => /^([0-9a-f]{16})\.(\d+)$/.exec(one)).filter(Boolean).slice(0, MOST).map(([, job, n]) => ({ job, number: Number(n) }));
  }

  async show() {
    try {
      await this.#list();
    } catch (problem) {
      fill(this.problem, errorBox(problem));
    }
  }

  // The chosen routes on the chart, and their table below it.
  #draw(routes, table, broken = []) {
    if (this.handlers.hidden()) return;
    drawCompared(this.chart.routes, routes);
    this.chart.routes.showFaults(broken);
    if (table) this.handlers.sheet(h("div.sheet", {}, table));
    if (!routes.length) return;
    this.chart.map.updateSize();
    this.chart.fit(routes.flat());
  }

  async #list() {
    const ask = (this.listed = Symbol("ask"));
    const { jobs } = await get("/plans?size=60");
    const older = await Promise.all([...new Set(this.chosen.map((one) => one.job))].filter((id) => !jobs.some((job) => job.id === id)).map((id) => get(`/plans/${id}`).catch(() => null)));
    if (ask !== this.listed) return;
    this.jobs = [...jobs, ...older].filter((job) => job?.result && ["plan", "alternatives", "evaluation"].includes(job.kind));
    this.chosen = this.chosen.filter((one) => this.#jobOf(one));
    for (const one of this.chosen) one.title ||= this.#nameOf(this.#jobOf(one), one.number);
    fill(this.list, this.jobs.length ? this.jobs.map((job) => this.#row(job)) : h("p.empty", {}, h("b", {}, "No routes yet"), "Plan a voyage, or take one of the examples below."));
    await this.#compare();
  }

  #jobOf(one) {
    return this.jobs.find((job) => job.id === one.job);
  }

  #nameOf(job, n) {
    const name = titleOf(job);
    return n === 0 ? `${name}, weather ignored` : job.kind === "evaluation" ? `${name} (from a file)` : n > 1 ? `${name}, route ${n}` : name;
  }

  // The ends, where the name of the job does not say them, and the ship.
  #about(job) {
    const ends = titleOf({ request: job.request });
    const voyage = job.request?.voyage;
    const said = [voyage && ends !== titleOf(job) ? ends : "", this.handlers.shipName(job.request?.ship), job.summary?.objective ? `by ${job.summary.objective}` : "", voyage?.depart ? `departs ${time(seconds(voyage.depart))}` : ""];
    return said.filter(Boolean).join(" · ");
  }

  #row(job) {
    const box = (n) => h("input", { type: "checkbox", value: `${job.id}.${n}`, checked: this.chosen.some((one) => one.job === job.id && one.number === n), onchange: (event) => this.#toggle(event.target, job, n) });
    const entry = (n, facts) => h("div.jobrow", {}, h("label.check", {}, box(n), h("span", {}, this.#nameOf(job, n), n < 2 ? h("small", {}, this.#about(job)) : null, h("small", {}, facts))));
    const made = time(seconds(job.created));
    const blind = job.kind === "plan" && job.request.seas[0] !== "calm" && job.summary.objective === "time" && !job.summary.cancelled;
    const facts = (one) => `${duration(one.time_h)} · ${number(one.distance_nm, 0)} nm`;
    const more = job.summary.routes - 1, others = h("div");
    const load = async (event) => {
      if (!event.target.open || others.children.length) return;
      const { routes } = await get(`/plans/${job.id}/result`);
      fill(others, routes.slice(1).map((route, i) => entry(i + 2, `${facts(route)} · ${known(route.fuel_t) ? `${number(route.fuel_t, 1)} t` : "fuel unknown"}`)));
    };
    return [entry(1, `${facts(job.summary)} · planned ${made}`), blind ? entry(0, "planned without weather, sailed in it") : null,
      job.kind === "plan" && more > 0 ? h("details.others", { ontoggle: (event) => load(event).catch((problem) => fill(others, errorBox(problem))) }, h("summary", {}, `${more} other route${more > 1 ? "s" : ""}`), others) : null];
  }

  // The chosen routes in the order of the table; each can become the reference, or be left out.
  #showChosen() {
    const put = (list) => { this.chosen = list; this.#tick(); this.#compare(); };
    this.counted.textContent = this.chosen.length ? `${this.chosen.length} of ${MOST}` : "";
    fill(this.picked, this.chosen.map((one, i) => {
      const job = this.#jobOf(one), rest = this.chosen.filter((other) => other !== one);
      return h("li", {}, keyOfRoute(i), h("span", {}, h("b", {}, one.title), h("small", {}, job ? this.#about(job) : "")),
        i ? h("button.quiet.small", { type: "button", "aria-label": `Make ${one.title} the reference`, onclick: () => put([one, ...rest]) }, "Reference") : h("span.state", {}, "reference"),
        h("button.quiet.small", { type: "button", "aria-label": `Leave out ${one.title}`, onclick: () => put(rest) }, "✕"));
    }));
    if (!this.chosen.length) fill(this.picked, h("li.none", {}, "None yet: tick routes below, or take an example."));
  }

  #tick() {
    for (const box of this.list.querySelectorAll("input")) box.checked = this.address.split(",").includes(box.value);
  }

  #toggle(box, job, n) {
    if (box.checked && this.chosen.length >= MOST) { box.checked = false; fill(this.problem, errorBox({ asked: "Six routes are chosen.", remedy: "Remove one first." })); return; }
    if (box.checked) this.chosen.push({ job: job.id, number: n, title: this.#nameOf(job, n) });
    else this.chosen = this.chosen.filter((one) => !(one.job === job.id && one.number === n));
    fill(this.problem);
    this.#compare();
  }

  async #compare() {
    const ask = (this.asked = Symbol("ask")); // the answer to an earlier choice is not shown
    this.#showChosen();
    if (!this.handlers.hidden()) this.handlers.update(`view=compare${this.chosen.length ? `&routes=${this.address}` : ""}`);
    if (this.chosen.length < 2) {
      this.drawn = [];
      this.#draw([], h("p.empty", {}, h("b", {}, this.chosen.length ? "Choose one more route" : "Choose routes to compare"), "Their figures and differences stand here, and all of them on the chart."));
      if (!this.chosen.length) return;
      const points = await this.#points().catch(() => []);
      if (ask === this.asked) this.#draw(points, null);
      return;
    }
    try {
      const { routes } = await post("/compare", { routes: this.chosen.map(({ job, number: n }) => ({ job, number: n })) });
      const [points] = await Promise.all([this.#points(), this.#readNotes()]);
      if (ask !== this.asked) return;
      this.drawn = points.map((line, i) => ({ name: this.chosen[i].title, points: line }));
      this.#draw(points, this.#table(routes), routes.flatMap((row) => row.broken));
    } catch (problem) {
      if (ask === this.asked) fill(this.problem, errorBox(problem));
    }
  }

  // What the reader of a route file says of it, such as that speeds of its schedule are not used.
  async #readNotes() {
    this.fileNotes ||= new Map();
    await Promise.all(this.chosen.map(async ({ job: id }) => {
      const job = this.#jobOf({ job: id });
      if (job.kind === "evaluation" && !this.fileNotes.has(id)) this.fileNotes.set(id, (await get(`/routes/${job.request.route}`).catch(() => ({}))).notes || []);
    }));
  }

  async #points() {
    return Promise.all(this.chosen.map(async ({ job, number: n }) => {
      const profile = n ? await get(`/plans/${job}/profiles/${n}`) : (await get(`/plans/${job}/beside.json`)).profile;
      return profile.lon.map((lon, i) => [lon, profile.lat[i]]);
    }));
  }

  #table(rows) {
    const [first] = rows;
    const than = (row, name, decimals, text) => (known(row.difference[name]) && known(row[name]) && known(first[name]) ? text(difference(row[name], first[name], decimals)) : null);
    const calm = rows.map((row) => isCalm(this.#jobOf(row).request));
    const figures = FIGURES.filter(([, name]) => rows.some((row, i) => known(row[name]) && !(calm[i] && WEATHER.includes(name)))); // without columns that say nothing
    const apart = new Set(rows.map((row) => row.approach_nm > 0.05)).size > 1; // some have approaches of ports
    const atSea = (row, name) => (apart && name === "distance_nm" ? `at sea ${number(row.distance_nm - row.approach_nm, 1)} nm` : apart && name === "time_h" ? `at sea ${duration(row.time_h - row.approach_h)}` : null);
    const facts = (row) => [apart ? `${row.approach_nm > 0.05 ? `with ${number(row.approach_nm, 1)} nm in` : "without"} approaches of ports` : null, `${number(row.distance_nm / row.time_h, 1)} kn mean over ground`, ...row.notes, ...(this.fileNotes?.get(row.job) || [])].filter(Boolean).map((text) => h("small", {}, readable(text)));
    const cell = (row, i) => ([, name, decimals, text, change]) => h("td", {}, h("b", {}, calm[i] && WEATHER.includes(name) ? "calm assumed" : text(row[name], row)), i && change ? h("small", {}, than(row, name, decimals, change)) : null, atSea(row, name) ? h("small", {}, atSea(row, name)) : null);
    return h("div.table", { tabindex: 0 }, h("table.compare-table", {}, h("caption.hidden", {}, "Routes compared with the reference, the first"), h("thead", {}, h("tr", {}, h("th.text", { scope: "col" }, "Route"), h("th.text", { scope: "col" }, "Leaves, arrives"), figures.map(([name]) => h("th", { scope: "col" }, name)))),
      h("tbody", {}, rows.map((row, i) => h("tr", { "aria-current": i ? null : "true" }, h("td.text", {}, keyOfRoute(i), h("b", {}, this.chosen[i].title), i ? null : h("small", {}, "reference"), facts(row), row.feasible ? null : h("small.broken", {}, faultWords(row.broken))), h("td.text", {}, time(seconds(row.depart)), h("small", {}, time(seconds(row.arrive)))), figures.map(cell(row, i)))))));
  }

  // Plan the voyages of an example, or find them planned, and compare them.
  async #example({ plans, beside }) {
    const orders = plans.map((request) => ["/plans", request, { "Idempotency-Key": keyOf(request) }]);
    await this.#planAll(orders, async (jobs) => {
      if (jobs.length < orders.length) return;
      this.chosen = jobs.map((job) => ({ job: job.id, number: 1, title: job.title }));
      if (beside) this.chosen.splice(1, 0, { job: jobs[0].id, number: 0, title: `${jobs[0].title}, weather ignored` });
    });
  }

  // Plan one after the other, then compare. What is asked for later takes their place: the plan that runs goes on, the others are not begun.
  async #planAll(orders, then) {
    const ask = (this.planning = Symbol("ask")), jobs = [], problems = [];
    fill(this.problem);
    try {
      for (const [i, order] of orders.entries()) {
        const place = orders.length > 1 ? `${i + 1} of ${orders.length} · ` : "";
        await this.#run(await post(...order), place, (job) => { if (job.result) jobs.push(job); else if (job.problem) problems.push(job.problem); });
        if (ask !== this.planning) return;
      }
      await then(jobs);
      await this.show();
    } catch (problem) {
      problems.push(problem);
    }
    if (ask === this.planning) fill(this.problem, problems.map(errorBox));
  }

  #run(job, place, done) {
    return new Promise((resolve, reject) => {
      const said = h("p.note", { role: "status" }, `${place}${job.title} …`);
      fill(this.problem, said);
      follow(job.id, {
        stage: (data) => { if (said.isConnected) said.textContent = `${place}${job.title}: ${readable(data.text)} …`; },
        state: async (data) => {
          if (!hasEnded(data.state)) return;
          try { done(await get(`/plans/${job.id}`)); resolve(); } catch (problem) { reject(problem); }
        },
      });
    });
  }

  // Plan the voyage of the first chosen route again, with changes.
  async #study(plansOf) {
    fill(this.problem);
    const first = this.jobs.find((job) => job.id === this.chosen[0]?.job && job.kind === "plan");
    if (!first) { fill(this.problem, errorBox({ asked: "The reference is no planned route.", remedy: "Choose a plan first; its voyage is varied." })); return; }
    const { settings } = await get(`/ships/${encodeURIComponent(first.request.ship)}`);
    const plans = plansOf(first.request, Math.max(...settings.map((row) => row.speed_kn)));
    await this.#planAll(plans.map((request) => ["/plans", request]), (jobs) => jobs.forEach((job) => this.add(job.id, 1, job.title)));
  }

  async #score() {
    const [file] = this.file.files;
    this.file.value = "";
    const first = this.jobs.find((job) => job.id === this.chosen[0]?.job);
    if (!file) return;
    if (!first) { fill(this.problem, errorBox({ asked: "No route is chosen.", remedy: "Choose the route whose ship and weather are used." })); return; }
    const speed = Number(this.speed.value.replace(",", "."));
    if (!(speed >= 0)) { fill(this.problem, errorBox({ asked: `The speed ${this.speed.value} is not a number.`, remedy: "Give knots, or leave it empty." })); return; }
    fill(this.problem);
    try {
      const route = await uploadForm("/routes", file);
      const { ship, seas, fill: filled, limits, areas, coast, load_factor, depths, traffic, eca, charges, sampling, average_over_m } = first.request;
      const request = { title: file.name, route: route.id, ship, seas, fill: filled, limits, areas, coast, load_factor, depths, traffic, eca, charges, sampling, average_over_m };
      const clearance = (first.request.voyage || first.request).min_ukc_m;
      if (clearance != null) request.min_ukc_m = clearance;
      if (speed) request.speed_kn = speed;
      if (!route.depart) request.depart = first.summary.depart;
      await this.#planAll([["/evaluate", request]], (jobs) => jobs.forEach((job) => this.add(job.id, 1, file.name)));
    } catch (problem) {
      fill(this.problem, errorBox(problem));
    }
  }
}

// The line of a route as the chart draws it.
function keyOfRoute(i) {
  const mark = h("span.key");
  mark.style.borderTopColor = `var(--${PAINTS[i]})`;
  mark.style.borderTopStyle = i ? "dashed" : "solid";
  return mark;
}
