// The application: views, selection, palette, keys and the link to a state.

import { get, hasEnded } from "./common/api.js";
import { announce, errorBox, fill, h, hint } from "./common/elements.js";
import { isCalm, known, seconds, titleOf } from "./common/format.js";
import { selection } from "./common/selection.js";
import { typedTime } from "./common/typed_time.js";
import { Address } from "./address.js";
import { BatchViews } from "./batch/batch_views.js";
import { Chart } from "./chart/chart_map.js";
import { chartTables } from "./chart/chart_tables.js";
import { LayerMenu } from "./chart/layer_menu.js";
import { DEMO, PlanForm } from "./form/plan_form.js";
import { listenToKeys, nextPalette, showKeys } from "./keyboard.js";
import { CompareView } from "./result/compare_view.js";
import { Drawer, placeAt, timeNear } from "./result/diagrams.js";
import { masterBrief } from "./result/master_brief.js";
import { ProgressView } from "./result/progress_view.js";
import { drawResult } from "./result/result_drawing.js";
import { loadResult, profileOf, ResultView } from "./result/result_view.js";
import { VoyageList } from "./result/voyage_list.js";

const panel = document.getElementById("panel");
const APART = ["projects", "studies", "compare", "voyages"]; // views without the weather of the voyage of the form

class Application {
  view = "plan";
  result = null;
  progress = null;
  address = new Address();

  constructor() {
    this.chart = new Chart(document.getElementById("chart"));
    this.chart.particles.wanted = localStorage.getItem("particles") === "true";
    this.drawer = new Drawer(document.getElementById("drawer"), () => this.chart.weather.loading);
    this.form = new PlanForm(this.chart);
    const sheet = (element, tall) => this.#sheet(element, tall), write = (address) => this.address.write(address);
    const shipName = (id) => this.form.ship.list.find((ship) => ship.id === id)?.name || id;
    this.compare = new CompareView(this.chart, { shipName, sheet, update: (address) => this.address.update(address), hidden: () => this.view !== "compare" });
    this.batch = new BatchViews(this.chart, this.form, {
      view: () => this.view, open: (view) => this.#switch(view), sheet, write,
      plan: () => { this.result = null; this.#switch("plan"); }, fillIn: (request) => this.#fillIn(request),
    });
    this.layers = new LayerMenu(this.chart, { weather: () => this.#valid(), routes: () => this.#draw(), tables: () => this.#showTables() });
    this.#listen();
    this.#keys();
    this.#begin();
  }

  // A plan that the address names is not preceded by an empty form.
  async #begin() {
    if (this.address.namesPlan) fill(panel, h("div.scroll", {}, h("h1", {}, "Opening the plan …"), h("p.lead", { role: "status" }, "Its ship and its sea are read first.")));
    else this.#showForm();
    try {
      await this.form.load();
    } catch (problem) {
      fill(panel, h("div.scroll", {}, errorBox(problem)));
      return;
    }
    addEventListener("hashchange", () => this.#route());
    await this.#route(true);
    this.address.keep();
  }

  // What was typed before the lists arrived is not replaced.
  async #route(first = false) {
    const given = this.address.read();
    if (!given) return;
    if (!first && this.address.returnsToForm) { this.result = null; this.#leaveProgress(); this.#switch("plan"); return; }
    if (first && this.form.touched && (given.has("voyage") || given.has("demo"))) return;
    if (given.get("voyage")) {
      try { this.#fillIn(JSON.parse(given.get("voyage"))); } catch { hint("The link holds no voyage."); this.#switch("plan"); }
      return;
    }
    if (given.has("demo")) { this.#fillIn(DEMO); return; }
    if (given.get("plan")) { await this.openJob(given.get("plan"), Number(given.get("route") || 1) - 1, given.has("t") ? Number(given.get("t")) : null); return; }
    if (given.get("routes")) this.compare.address = given.get("routes");
    if (given.get("view")) this.#switch(given.get("view"));
    else if (!this.form.start.value) this.#showForm();
  }

  // A voyage takes the place of what the plan view shows.
  #fillIn(request) {
    this.form.set(request);
    this.result = null;
    this.#leaveProgress();
    this.#switch("plan");
  }

  #tabs() {
    for (const tab of document.querySelectorAll(".tab")) {
      if (tab.dataset.view === this.view) tab.setAttribute("aria-current", "page");
      else tab.removeAttribute("aria-current");
    }
  }

  // Answers to what was wanted before are not shown over what is wanted now.
  #begins() {
    const visit = (this.visit = Symbol("visit"));
    return () => visit === this.visit;
  }

  // A project or study that is opened takes the place of the form of its view.
  #switch(view, job = null) {
    this.#begins();
    this.#weatherOf(view);
    if ((this.view === "projects") !== (view === "projects")) { // a project has its own part of the chart
      const seen = this.seen;
      this.seen = this.chart.place;
      if (seen) this.chart.place = seen;
    }
    this.view = view;
    this.#tabs();
    this.drawer.stop();
    this.batch.close();
    this.#sheet(null);
    if (view === "plan") {
      if (this.progress) this.#showProgress();
      else if (this.result) this.showResult(this.result).catch((problem) => hint(problem.asked));
      else { this.#showForm(); this.address.leave(); }
      return;
    }
    this.chart.clearRoutes();
    this.chart.routes.showEnds([]);
    this.form.areas.draw(false);
    this.chart.closeMenu();
    this.address.write(job ? `plan=${job}` : `view=${view}`);
    if (view === "compare") { fill(panel, this.compare.element); this.compare.show(); }
    else if (view === "projects" || view === "studies") this.batch.show(view, job);
    else this.#showVoyages();
  }

  // The weather of one voyage at one time is not that of a project, a study or a comparison.
  #weatherOf(view) {
    const { weather } = this.chart, apart = APART.includes(view);
    if (apart && weather.kind) { this.kindBefore = weather.kind; weather.set({ kind: "" }); } else if (!apart && this.kindBefore) { weather.set({ kind: this.kindBefore }); this.kindBefore = ""; }
    if (apart) fill(document.getElementById("valid"));
    this.chart.showLegend();
  }

  // The drawer holds the player with its diagrams, or one other element.
  #sheet(element, tall = false) {
    const drawer = document.getElementById("drawer");
    this.drawerParts ||= [...drawer.children];
    drawer.classList.remove("slim");
    drawer.classList.toggle("tall", Boolean(element && tall));
    drawer.hidden = !element;
    fill(drawer, element || this.drawerParts);
  }

  // Form

  #showForm() {
    this.result = null;
    fill(panel, this.form.element);
    this.chart.clearRoutes();
    this.#placesOnChart();
    this.form.areas.draw(true);
    this.departure = null;
    this.#fieldTime();
  }

  #placesOnChart() {
    if (this.view === "plan" && !this.result) this.chart.routes.showEnds(this.form.ends, true);
    if (this.form.fresh && this.form.placesKnown) { // what was filled in or typed is shown, once
      this.form.fresh = false;
      if (this.view === "plan" && !this.progress && !this.result) this.chart.fitOutside(this.form.ends);
    }
  }

  // While the form is shown the player moves the weather; it begins at the departure.
  #fieldTime() {
    const { sea, depart } = this.form, { weather } = this.chart;
    if (weather.kind && !sea.frameKinds.includes(weather.kind)) weather.set({ kind: "" });
    this.layers.show(sea.frameKinds);
    const departs = typedTime(depart);
    this.#sheet(null);
    this.drawer.showTimes(sea.period);
    const t = departs !== this.departure || selection.time === null ? departs : selection.time;
    this.departure = departs;
    weather.set({ seas: sea.chosen, time: t });
    if (t !== null) selection.at(t);
    this.drawer.moved();
    this.#valid();
  }

  async openJob(id, route = 0, t = null) {
    let job;
    const wanted = this.#begins();
    try {
      job = await get(`/plans/${id}`);
      if (!wanted()) return;
    } catch (problem) {
      if (!wanted()) return;
      this.view = "plan";
      this.#showForm();
      fill(this.form.problem, errorBox(problem));
      return;
    }
    const batch = { project: "projects", study: "studies" }[job.kind];
    if (batch) { this.#switch(batch, id); return; }
    this.#weatherOf("plan");
    this.view = "plan";
    this.#tabs();
    if (job.kind === "forecast") { this.#showForm(); this.form.sea.openForecast(job); return; }
    this.#sheet(null);
    this.#leaveProgress(); // the one that was followed goes on
    if (["plan", "alternatives"].includes(job.kind)) this.form.set(job.request);
    if (!hasEnded(job.state)) { this.#follow(job); return; }
    await this.#ended(job, route, t);
  }

  #follow(job) {
    this.progress?.close();
    this.result = null;
    if (this.view === "plan") { this.#begins(); this.chart.clearRoutes(); this.drawer.showTimes(this.form.sea.period); }
    const shown = new ProgressView(job, {
      ended: async () => {
        const done = await get(`/plans/${job.id}`).catch(() => null);
        if (this.progress !== shown) return;
        if (!done) { this.#leaveProgress(); await this.openJob(job.id); return; }
        this.#leaveProgress();
        await this.#ended(done);
      },
      route: (points) => {
        if (this.view !== "plan" || this.progress !== shown) return;
        this.chart.routes.showChosen(points, null, null, 0);
        if (points) this.chart.fitOutside(points.map(([lon, lat]) => ({ lon, lat })));
      },
      leave: () => { this.#leaveProgress(); this.#switch("voyages"); },
    });
    this.progress = shown;
    this.progress.id = job.id;
    this.chart.particles.rest(true);
    if (this.view === "plan") this.#showProgress();
  }

  #leaveProgress() {
    this.progress?.close();
    this.progress = null;
    this.chart.particles.rest(false);
  }

  #showProgress() {
    this.address.write(`plan=${this.progress.id}`);
    fill(panel, this.progress.element);
    this.#sheet(null);
    this.drawer.showTimes(this.form.sea.period);
    this.form.areas.draw(false);
    this.chart.routes.showEnds(this.form.ends);
    this.chart.fitOutside(this.form.ends);
  }

  // In another view the result waits for the return to this one.
  async #ended(job, route = 0, t = null) {
    if (job.result) {
      try {
        const wanted = this.view === "plan" ? this.#begins() : () => false;
        const result = await loadResult(job);
        if (!wanted()) {
          if (this.view !== "plan" && !this.progress) { this.result = result; selection.route = 0; selection.time = null; }
          return;
        }
        selection.route = Math.min(Math.max(0, route), result.plan.routes.length - 1);
        selection.hovered = null;
        selection.time = t;
        this.layers.bySpeed = Boolean(result.front);
        await this.showResult(result, true);
        announce("The route is shown.");
      } catch (problem) {
        if (this.view === "plan") this.#showForm();
        fill(this.form.problem, errorBox(problem));
      }
      return;
    }
    if (this.view === "plan") { this.#showForm(); this.address.write(""); }
    if (job.problem) {
      this.form.showProblem(job.problem);
      const near = job.problem.nearest;
      if (near && this.view === "plan") this.chart.routes.showFaults([{ lat: near[0], lon: near[1], reason: "nearest point reached" }]);
    } else fill(this.form.problem, h("p.note", {}, "The job was stopped before a route was found."));
  }

  // Result

  async showResult(result, fit = false) {
    this.result = result;
    const number_ = selection.route;
    result.view ||= new ResultView(result, {
      change: () => { this.result = null; this.address.write(""); this.#showForm(); },
      compare: () => { this.compare.add(result.job.id, selection.route + 1, `${titleOf(result.job)}${result.plan.routes.length > 1 ? `, route ${selection.route + 1}` : ""}`); this.#switch("compare"); },
      link: () => this.address.copy(this.#place),
      shipName: this.compare.handlers.shipName,
      print: () => print(),
    });
    if (!panel.contains(result.view.body)) fill(panel, result.view.element); // else the focus would be lost
    this.chart.closeMenu();
    this.form.areas.draw(false);
    const profile = await profileOf(result, number_);
    if (this.result !== result || selection.route !== number_ || this.view !== "plan") return;
    const route = result.plan.routes[number_];
    this.drawer.range(profile.time[0], profile.time.at(-1));
    if (selection.time === null || selection.time < profile.time[0] || selection.time > profile.time.at(-1)) selection.time = profile.time[0];
    result.profile = profile;
    this.#draw();
    const { seas } = result.job.request, { weather } = this.chart;
    const kinds = (this.form.sea.list || []).filter((sea) => seas.includes(sea.id) && sea.id !== "calm").flatMap((sea) => sea.frames || []);
    weather.set({ seas, time: selection.time, kind: kinds.includes(weather.kind) ? weather.kind : "" });
    this.chart.showLegend();
    result.view.show(profile);
    this.drawer.show({ plan: result.plan, calm: isCalm(result.job.request), front: result.front, spaceTime: selection.route === 0 ? result.spaceTime : null, limits: result.limits?.routes[selection.route], profile, waypoints: route.waypoints });
    if (fit) { this.chart.map.updateSize(); this.chart.fit(profile.lon.map((lon, i) => [lon, profile.lat[i]])); }
    this.#time();
    this.layers.show(kinds);
    this.address.show(this.#place);
  }

  // On paper a result is the brief for the master, with the chart in it.
  #brief(profile) {
    document.querySelectorAll(".brief-page").forEach((part) => part.remove());
    document.documentElement.classList.toggle("brief", Boolean(profile));
    if (!profile) return;
    const { request } = this.result.job, { sea } = this.form, rows = (sea.list || []).filter((one) => request.seas.includes(one.id));
    const runs = rows.map((one) => one.run).filter(Boolean).map(seconds);
    const [head, rest] = masterBrief(this.result, selection.route, profile, { shipName: this.compare.handlers.shipName(request.ship), seas: rows.map((one) => one.name.split(":")[0]), run: runs.length ? Math.min(...runs) : null });
    document.querySelector("main").before(head);
    document.querySelector("main").after(rest);
  }

  #draw() {
    if (this.result?.profile && this.view === "plan") this.chart.showSpeeds(drawResult(this.chart.routes, this.result, this.result.profile, this.layers, this.form.ship.speedRange));
  }

  // The tables take the place of the diagrams until they are closed.
  #showTables() {
    const { result } = this, shown = this.view === "plan" && result;
    const routes = shown ? result.plan.routes.map((route, i) => ({ name: `Route ${i + 1}`, points: route.waypoints.map((w) => [w.lon, w.lat]) })) : this.view === "compare" ? this.compare.drawn : [];
    this.drawer.stop();
    this.#sheet(chartTables(this.chart, { isochrones: shown && this.layers.isochrones ? result.isochrones : null, routes }, () => this.#switch(this.view, this.batch.job(this.view))).element, true);
  }

  #time() {
    const t = selection.time;
    if (!known(t)) return;
    if (this.view === "plan") {
      if (this.result?.profile) {
        const place = placeAt(this.result.profile, t);
        this.chart.routes.showShip(place.lon, place.lat, place.course);
      }
      this.chart.weather.set({ time: t });
    }
    this.#valid();
  }

  #valid() {
    if (!APART.includes(this.view)) this.chart.showValidity(selection.time, this.form.sea.period, this.form.sea.run);
  }

  get #place() {
    const time = selection.time === null ? "" : `&t=${Math.round(selection.time)}`; // not known before the first profile
    return `plan=${this.result.job.id}&route=${selection.route + 1}${time}`;
  }

  // Compare and voyages

  #showVoyages() {
    const list = new VoyageList({ open: (id) => this.openJob(id), demo: () => this.#fillIn(DEMO) });
    fill(panel, list.element);
    list.show();
  }

  #listen() {
    const { chart, form } = this;
    addEventListener("beforeprint", () => { const profile = this.view === "plan" && this.result?.profile; this.#brief(profile || null); chart.forPaper(true, profile && profile.lon.map((lon, i) => [lon, profile.lat[i]])); });
    addEventListener("afterprint", () => { this.#brief(null); chart.forPaper(false); });
    chart.weather.onState = (state) => chart.showLegend(state);
    document.querySelectorAll(".tab").forEach((tab) => tab.addEventListener("click", () => this.#switch(tab.dataset.view)));
    document.getElementById("palette").addEventListener("click", nextPalette);
    document.getElementById("help").addEventListener("click", showKeys);
    addEventListener("palette", () => { chart.paint(); if (this.result?.profile && this.view === "plan") this.drawer.show(this.drawer.result); });
    form.addEventListener("places", () => this.#placesOnChart());
    form.addEventListener("seas", () => { if (this.view !== "plan" || this.result || this.progress) return; if (!chart.weather.kind && !chart.weather.byHand && form.sea.frameKinds.includes("waves") && form.sea.chosen[0] !== "calm") this.chart.weather.set({ kind: "waves" }); this.#fieldTime(); });
    form.addEventListener("link", ({ detail }) => this.address.copy(`voyage=${encodeURIComponent(JSON.stringify(detail))}`));
    chart.addEventListener("dragged", ({ detail: { number: n, lat, lon } }) => { if (this.view === "projects") this.batch.projects.moved(n, lat, lon); else form.moved(n, lat, lon); });
    form.addEventListener("change", () => { if (this.view === "plan" && !this.result && !this.progress) this.#fieldTime(); });
    form.addEventListener("started", ({ detail }) => this.#follow(detail));
    chart.addEventListener("hoverroute", (event) => { if (this.result?.plan.routes.length > 1) selection.hover(event.detail); });
    chart.addEventListener("click", (event) => this.#clicked(event.detail));
    selection.addEventListener("route", () => { if (this.result) this.showResult(this.result).catch((problem) => hint(problem.asked)); });
    selection.addEventListener("hover", () => { if (this.result) this.chart.routes.showOthers(this.result.plan.routes.map((route) => route.waypoints.map((w) => [w.lon, w.lat])), selection.route, selection.hovered); });
    selection.addEventListener("time", () => { this.#time(); this.address.updateSoon(() => (this.view === "plan" && this.result ? this.#place : null)); });
  }

  #clicked(place) {
    const { lat, lon, number: number_, coordinate } = place;
    if (this.view === "projects") { this.batch.projects.clicked(lat, lon, coordinate); return; }
    if (this.view !== "plan" || this.progress) return;
    if (!this.result) this.form.offer(place);
    else if (known(number_) && number_ !== selection.route) selection.choose(number_);
    else if (known(number_)) selection.at(timeNear(this.result.profile, lat, lon));
  }

  #keys() {
    const step = (by) => { if (this.result) { selection.choose(Math.max(0, Math.min(this.result.plan.routes.length - 1, selection.route + by))); } };
    const view = (name) => () => document.querySelector(`.tab[data-view="${name}"]`).click();
    listenToKeys({
      Escape: () => { this.chart.closeMenu(); this.layers.open(false); },
      " ": (event) => { if (event.target.closest("button, summary, a, input")) return false; this.drawer.toggle(); return true; },
      ",": () => this.drawer.step(-3), ".": () => this.drawer.step(3),
      "[": () => step(-1), "]": () => step(1),
      c: () => this.result?.view.handlers.compare(), n: nextPalette, "?": showKeys, l: () => this.layers.open(this.layers.box.hidden),
      p: view("plan"), d: view("projects"), s: view("studies"), v: view("voyages"),
    });
  }
}

window.thalweg = new Application();
