// Two to six routes side by side, with differences to the first; ready studies and scored files.

import { follow, get, hasEnded, post, uploadForm } from "../common/api.js";
import { errorBox, fill, h } from "../common/elements.js";
import { EXAMPLES, keyOf, VARIATIONS } from "./examples.js";
import { PAINTS } from "./result_drawing.js";
import { duration, known, number, readable, seconds, signed, signedDuration, time, titleOf } from "../common/format.js";

const MOST = 6;
const FIGURES = [["Time", "time_h", duration, signedDuration], ["Distance", "distance_nm", (v) => `${number(v, 1)} nm`, (v) => signed(v, 1)], ["Fuel", "fuel_t", (v) => (known(v) ? `${number(v, 1)} t` : "unknown"), (v) => signed(v, 1)], ["Cost", "cost", (v, row) => (known(v) ? `${number(v)} ${row.currency}` : "unknown"), (v) => signed(v, 0)], ["CO₂", "co2_t", (v) => (known(v) ? `${number(v)} t` : "unknown"), (v) => signed(v, 0)], ["Waves up to", "highest_waves_m", (v) => (known(v) ? `${number(v, 1)} m` : "unknown"), null], ["Wind up to", "strongest_wind_kn", (v) => (known(v) ? `${number(v)} kn` : "unknown"), null]];

export class CompareView {
  chosen = []; // {job, number, title}

  constructor(handlers) {
    this.handlers = handlers;
    this.list = h("div");
    this.table = h("div");
    this.problem = h("div");
    this.file = h("input.hidden", { type: "file", id: "route-file", "aria-label": "Route file", accept: ".rtz,.rtzp,.gml,.gpx,.geojson,.json,.csv", tabindex: "-1", onchange: () => this.#score() });
    this.element = [h("div.scroll", {}, h("h1", {}, "Compare routes"), h("p.lead", {}, "Choose two to six. The first is the one that the others are compared with."), this.problem, h("div.block", {}, this.list), h("div.block", {}, h("h2", {}, "Examples"), EXAMPLES.map((example) => h("button.job.example", { type: "button", onclick: () => this.#example(example) }, h("b", {}, example.name), h("span", {}, example.facts)))), h("div.block", {}, h("h2", {}, "Vary the first route"), h("p.facts", {}, "Its voyage is planned again with one change, and the results are added."), h("div.exports", {},
      VARIATIONS.map(([text, plans]) => h("button.quiet.small", { type: "button", onclick: () => this.#study(plans) }, text))),
    h("div.block", {}, h("h2", {}, "A route of your own"), h("p.facts", {}, "An RTZ, S-421, GPX, GeoJSON or CSV file is sailed in the weather and by the ship of the first chosen route."), h("button.quiet.small", { type: "button", onclick: () => this.file.click() }, "Score a route file …"), this.file)))];
  }

  add(job, number_, title) {
    if (this.chosen.some((one) => one.job === job && one.number === number_)) return;
    if (this.chosen.length < MOST) this.chosen.push({ job, number: number_, title });
  }

  async show() {
    const ask = (this.listed = Symbol("ask"));
    const { jobs } = await get("/plans?size=60");
    if (ask !== this.listed) return;
    this.jobs = jobs.filter((job) => job.result);
    this.chosen = this.chosen.filter((one) => this.jobs.some((job) => job.id === one.job));
    fill(this.list, this.jobs.length ? this.jobs.map((job) => this.#row(job)) : h("p.empty", {}, h("b", {}, "No routes yet"), "Plan a voyage first; its routes can then be compared here."));
    await this.#compare();
  }

  #row(job) {
    const entry = (number_, text) => h("div.jobrow", {}, h("label.check", {}, h("input", { type: "checkbox", checked: this.chosen.some((one) => one.job === job.id && one.number === number_), onchange: (event) => this.#toggle(event.target, job, number_, text) }), h("span", {}, text, h("small", {}, `${number_ === 0 ? "planned without weather, sailed in it" : `${duration(job.summary.time_h)} · ${number(job.summary.distance_nm, 0)} nm`} · ${time(seconds(job.created))}`))));
    const name = titleOf(job);
    return [entry(1, job.kind === "evaluation" ? `${name} (from a file)` : name), job.kind === "plan" && job.request.seas[0] !== "calm" && job.summary.objective === "time" && !job.summary.cancelled ? entry(0, `${name}, weather ignored`) : null];
  }

  #toggle(box, job, number_, title) {
    if (box.checked && this.chosen.length >= MOST) { box.checked = false; fill(this.problem, errorBox({ asked: "Six routes are chosen.", remedy: "Remove one first." })); return; }
    if (box.checked) this.chosen.push({ job: job.id, number: number_, title });
    else this.chosen = this.chosen.filter((one) => !(one.job === job.id && one.number === number_));
    fill(this.problem);
    this.#compare();
  }

  async #compare() {
    const ask = (this.asked = Symbol("ask")); // the answer to an earlier choice is not shown
    if (this.chosen.length < 2) {
      this.handlers.show([], h("p.empty", {}, h("b", {}, this.chosen.length ? "Choose one more route" : "Choose routes to compare"), "Their figures and differences stand here, and all of them on the chart."));
      if (!this.chosen.length) return;
      const points = await this.#points().catch(() => []);
      if (ask === this.asked) this.handlers.show(points, null);
      return;
    }
    try {
      const { routes } = await post("/compare", { routes: this.chosen.map(({ job, number: n }) => ({ job, number: n })) });
      const points = await this.#points();
      if (ask === this.asked) this.handlers.show(points, this.#table(routes));
    } catch (problem) {
      if (ask === this.asked) fill(this.problem, errorBox(problem));
    }
  }

  async #points() {
    return Promise.all(this.chosen.map(async ({ job, number: n }) => {
      const profile = n ? await get(`/plans/${job}/profiles/${n}`) : (await get(`/plans/${job}/beside.json`)).profile;
      return profile.lon.map((lon, i) => [lon, profile.lat[i]]);
    }));
  }

  #table(rows) {
    const key = (i) => { const mark = h("span.key"); mark.style.borderTopColor = `var(--${PAINTS[i]})`; mark.style.borderTopStyle = i ? "dashed" : "solid"; return mark; };
    return h("div.table", { tabindex: 0 }, h("table.compare-table", {}, h("caption.hidden", {}, "Routes compared with the first"), h("thead", {}, h("tr", {}, h("th.text", { scope: "col" }, "Route"), h("th.text", { scope: "col" }, "Leaves, arrives"), FIGURES.map(([name]) => h("th", { scope: "col" }, name)))), h("tbody", {}, rows.map((row, i) => h("tr", {}, h("td.text", {}, key(i), h("b", {}, this.chosen[i].title), row.feasible ? null : h("small", {}, `breaks ${row.violations} limits`)), h("td.text", {}, time(seconds(row.depart)), h("small", {}, time(seconds(row.arrive)))), FIGURES.map(([, name, text, change]) => h("td", {}, h("b", {}, text(row[name], row)), i && change && known(row.difference[name]) ? h("small", {}, change(row.difference[name])) : null)))))));
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

  // Plan one after the other, then compare; a second click waits for the first to end.
  async #planAll(orders, then) {
    if (this.busy) return;
    this.busy = true;
    const jobs = [], problems = [];
    fill(this.problem);
    try {
      for (const [i, order] of orders.entries()) {
        const place = orders.length > 1 ? `${i + 1} of ${orders.length} · ` : "";
        await this.#run(await post(...order), place, (job) => { if (job.result) jobs.push(job); else if (job.problem) problems.push(job.problem); });
      }
      await then(jobs);
      await this.show();
    } catch (problem) {
      problems.push(problem);
    } finally {
      this.busy = false;
    }
    fill(this.problem, problems.map(errorBox));
  }

  #run(job, place, done) {
    return new Promise((resolve, reject) => {
      const said = h("p.note", { role: "status" }, `${place}${job.title} …`);
      fill(this.problem, said);
      follow(job.id, {
        stage: (data) => { said.textContent = `${place}${job.title}: ${readable(data.text)} …`; },
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
    if (!first) { fill(this.problem, errorBox({ asked: "No planned route is chosen.", remedy: "Choose a plan first; the study starts from its voyage." })); return; }
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
    fill(this.problem);
    try {
      const route = await uploadForm("/routes", file);
      const { ship, seas, fill: filled, limits, areas, coast, load_factor, depths, traffic, eca, charges, sampling, average_over_m } = first.request;
      const request = { title: file.name, route: route.id, ship, seas, fill: filled, limits, areas, coast, load_factor, depths, traffic, eca, charges, sampling, average_over_m };
      if (!route.depart) request.depart = first.summary.depart;
      await this.#planAll([["/evaluate", request]], (jobs) => jobs.forEach((job) => this.add(job.id, 1, file.name)));
    } catch (problem) {
      fill(this.problem, errorBox(problem));
    }
  }
}
