// The application: views, selection, palette, keys and the link to a state.

import { follow, get, hasEnded, remove } from "./api.js";
import { Chart } from "./chart_map.js";
import { CompareView, DASHES, PAINTS } from "./compare_view.js";
import { Drawer, indexAt, placeAt } from "./diagrams.js";
import { announce, colour, errorBox, fill, h } from "./elements.js";
import { duration, known, number, plainPosition, seconds, time } from "./format.js";
import { lessMotion } from "./particle_layer.js";
import { DEMO, PlanForm } from "./plan_form.js";
import { ProgressView } from "./progress_view.js";
import { ProjectView } from "./project_view.js";
import { loadResult, profileOf, ResultView } from "./result_view.js";
import { Feature, line, speedColours, stroke } from "./route_layers.js";
import { selection } from "./selection.js";
import { StudyView } from "./study_view.js";
import { typedTime } from "./typed_time.js";
import { KINDS } from "./weather_layer.js";

const panel = document.getElementById("panel");
const APART = ["projects", "studies", "compare"]; // views without the weather of the voyage of the form
const PALETTES = ["day", "dusk", "night"];

class Application {
  view = "plan";
  result = null;
  progress = null;
  bySpeed = false;

  constructor() {
    this.chart = new Chart(document.getElementById("chart"));
    this.chart.particles.wanted = localStorage.getItem("particles") === "true";
    this.drawer = new Drawer(document.getElementById("drawer"));
    this.form = new PlanForm(this.chart);
    this.compare = new CompareView({ show: (routes, table) => this.#showCompared(routes, table), run: (job, done) => this.#runBeside(job, done) });
    const batch = (view) => ({
      sheet: (element, tall) => { if (this.view === view) this.#sheet(element, tall); },
      panel: (parts) => { if (this.view === view) fill(panel, parts); },
      link: (id) => { if (this.view === view) this.#link(id ? `plan=${id}` : `view=${view}`); },
      fit: (points) => { if (this.view === view) this.chart.fit(points); },
      hidden: () => this.view !== view,
      leave: () => this.#switch("voyages"),
      plan: () => { this.result = null; this.#switch("plan"); },
      demo: () => this.form.set(DEMO),
      ends: (voyage) => this.#fitVoyage(voyage),
      voyage: (request) => { this.form.set(request); this.result = null; this.#switch("plan"); this.#hint("The voyage is filled in."); },
    });
    this.projects = new ProjectView(this.chart, this.form, batch("projects"));
    this.studies = new StudyView(this.form, batch("studies"));
    this.#listen();
    this.#layers();
    this.#keys();
    this.#begin();
  }

  async #begin() {
    this.#showForm();
    try {
      await this.form.load();
    } catch (problem) {
      fill(panel, h("div.scroll", {}, errorBox(problem)));
      return;
    }
    await this.#route(true);
    addEventListener("hashchange", () => this.#route());
  }

  // The address: #demo, #plan=ID&route=2, #voyage=REQUEST, #view=compare

  // What was typed before the lists arrived is not replaced.
  async #route(first = false) {
    const given = new URLSearchParams(location.hash.slice(1));
    if (location.hash === this.written) return;
    if (first && this.form.touched && (given.has("voyage") || given.has("demo"))) return;
    if (given.get("voyage")) {
      try { this.form.set(JSON.parse(given.get("voyage"))); } catch { this.#hint("The link holds no voyage."); }
      this.#switch("plan");
      return;
    }
    if (given.has("demo")) { this.form.set(DEMO); this.#switch("plan"); return; }
    if (given.get("plan")) { await this.openJob(given.get("plan"), Number(given.get("route") || 1) - 1, given.has("t") ? Number(given.get("t")) : null); return; }
    if (given.get("view")) this.#switch(given.get("view"));
    else if (!this.form.start.value) this.#showForm();
  }

  #link(text) {
    this.written = text ? `#${text}` : "";
    history.replaceState(null, "", text ? `#${text}` : location.pathname);
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
    this.view = view;
    this.#tabs();
    this.drawer.stop();
    this.projects.close?.();
    this.studies.close?.();
    this.#sheet(null);
    if (view === "plan") {
      if (this.progress) this.#showProgress();
      else if (this.result) this.showResult(this.result);
      else this.#showForm();
      return;
    }
    this.chart.routes.clear();
    this.chart.routes.showEnds([]);
    this.chart.showAreas(this.form.areas, null);
    this.chart.closeMenu();
    this.#link(job ? `plan=${job}` : `view=${view}`);
    if (view === "compare") this.#showCompare();
    else if (view === "projects" || view === "studies") this.#showBatch(job);
    else this.#showVoyages();
  }

  // The ends of the voyage of a study, whose places may be text.
  async #fitVoyage({ start, goal }) {
    const place = async (given, role) => (Array.isArray(given) ? { role, lat: given[0], lon: given[1], label: "" } : { ...(await get(`/places?text=${encodeURIComponent(given)}`)), role });
    try {
      const ends = (await Promise.all([place(start, "start"), place(goal, "goal")])).map((end) => ({ ...end, label: end.kind === "port" ? end.name : "" }));
      if (this.view !== "studies") return;
      this.chart.routes.showEnds(ends);
      this.chart.map.updateSize();
      this.chart.fit(ends.map((end) => [end.lon, end.lat]));
    } catch { /* the study states what is wrong with its places */ }
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
    drawer.classList.toggle("tall", Boolean(element && tall));
    drawer.hidden = !element;
    fill(drawer, element || this.drawerParts);
  }

  async #showBatch(id) {
    const { view } = this, shown = this[view];
    try {
      if (id) { await shown.openJob(id); return; }
      const element = await shown.show();
      if (this.view !== view || shown.job) return;
      fill(panel, element);
      if (view === "studies") this.chart.routes.showEnds(this.form.ends);
    } catch (problem) {
      if (this.view === view) fill(panel, h("div.scroll", {}, errorBox(problem)));
    }
  }

  // Form

  #showForm() {
    this.result = null;
    fill(panel, this.form.element);
    this.chart.routes.clear();
    this.#placesOnChart();
    this.chart.showAreas(this.form.areas, this.chart.onAreaChange);
    this.drawer.hide();
    this.#fieldTime();
    this.#valid();
  }

  #placesOnChart() {
    if (this.view === "plan" && !this.result) this.chart.routes.showEnds(this.form.ends, true);
  }

  // The time of the weather while the form is shown: the departure.
  #fieldTime() {
    const t = typedTime(this.form.depart);
    const seas = this.form.chosenSeas;
    const kind = this.chart.weather.kind;
    this.chart.weather.set({ seas, time: t });
    if (t !== null) selection.at(t);
    this.#layers();
    if (kind && !this.form.frameKinds.includes(kind)) this.chart.weather.set({ kind: "" });
  }

  // Jobs

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
    if (job.kind === "forecast") { this.#showForm(); await this.form.openForecast?.(job); return; }
    this.#sheet(null);
    this.#leaveProgress(); // the one that was followed goes on
    if (["plan", "alternatives"].includes(job.kind)) this.form.set(job.request);
    if (!hasEnded(job.state)) { this.#follow(job); return; }
    await this.#ended(job, route, t);
  }

  #follow(job) {
    this.progress?.close();
    this.result = null;
    if (this.view === "plan") { this.#begins(); this.chart.routes.clear(); this.drawer.hide(); }
    const shown = new ProgressView(job, {
      ended: async () => {
        const done = await get(`/plans/${job.id}`);
        if (this.progress !== shown) return;
        this.#leaveProgress();
        await this.#ended(done);
      },
      route: (points) => { if (this.view === "plan" && this.progress === shown) { this.chart.routes.showChosen(points, null, null, 0); if (!this.#inView(points)) this.chart.fit(points); } },
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
    this.#link(`plan=${this.progress.id}`);
    fill(panel, this.progress.element);
    this.chart.routes.showEnds(this.form.ends);
    if (this.form.ends.length > 1) { const points = this.form.ends.map((end) => [end.lon, end.lat]); if (!this.#inView(points)) this.chart.fit(points); }
  }

  #inView(points) {
    const [w, s, e, n] = this.chart.view;
    return points.every(([lon, lat]) => lat > s && lat < n && lon > w && lon < e);
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
        this.bySpeed = Boolean(result.front);
        await this.showResult(result, true);
        announce("The route is shown.");
      } catch (problem) {
        if (this.view === "plan") this.#showForm();
        fill(this.form.problem, errorBox(problem));
      }
      return;
    }
    if (this.view === "plan") { this.#showForm(); this.#link(""); }
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
      change: () => { this.result = null; this.#link(""); this.#showForm(); },
      compare: () => { this.compare.add(result.job.id, selection.route + 1, `${result.job.title || "Plan"}${result.plan.routes.length > 1 ? `, route ${selection.route + 1}` : ""}`); this.#switch("compare"); },
      link: () => this.#copyLink(),
      print: () => { this.drawer.open("legs"); print(); },
    });
    fill(panel, result.view.element);
    this.chart.closeMenu();
    this.chart.showAreas(this.form.areas, null);
    const profile = await profileOf(result, number_);
    if (this.result !== result || selection.route !== number_ || this.view !== "plan") return;
    const route = result.plan.routes[number_];
    this.drawer.range(profile.time[0], profile.time.at(-1));
    if (selection.time === null || selection.time < profile.time[0] || selection.time > profile.time.at(-1)) selection.time = profile.time[0];
    this.#drawRoutes(profile);
    this.chart.weather.set({ seas: result.job.request.seas, time: selection.time });
    if (fit) this.chart.fit(profile.lon.map((lon, i) => [lon, profile.lat[i]]));
    result.view.show(profile);
    result.profile = profile;
    this.drawer.show({ plan: result.plan, front: result.front, spaceTime: selection.route === 0 ? result.spaceTime : null, profile, waypoints: route.waypoints });
    this.#time();
    this.#layers();
    this.#permalink();
  }

  #drawRoutes(profile) {
    const { result } = this;
    const { routes } = this.chart;
    const lines = result.plan.routes.map((route) => route.waypoints.map((w) => [w.lon, w.lat]));
    const points = profile.lon.map((lon, i) => [lon, profile.lat[i]]);
    routes.showIsochrones(this.showIsochrones === false ? null : result.isochrones);
    const beside = this.showBeside === false ? null : result.beside?.profile;
    routes.showBeside(beside && beside.lon.map((lon, i) => [lon, beside.lat[i]]));
    routes.showOthers(lines, selection.route, selection.hovered);
    routes.showChosen(points, this.bySpeed ? profile.speed_over_ground_kn : null, this.#speedRange(profile), selection.route);
    const route = result.plan.routes[selection.route];
    routes.showMarks(route.waypoints, profile);
    routes.showFaults(route.violations);
    routes.showEnds([{ role: "start", lon: points[0][0], lat: points[0][1], label: (result.plan.provenance.from || "").split(",")[0].replace(/^[\d.].*/, "") }, { role: "goal", lon: points.at(-1)[0], lat: points.at(-1)[1], label: (result.plan.provenance.to || "").split(",")[0].replace(/^[\d.].*/, "") }]);
  }

  #speedRange(profile) {
    const speeds = profile.speed_over_ground_kn.filter(known);
    const ship = this.form.speedRange;
    return ship && ship[1] > ship[0] ? [Math.min(ship[0], ...speeds), Math.max(ship[1], ...speeds)] : [Math.min(...speeds), Math.max(...speeds)];
  }

  #time() {
    const t = selection.time;
    if (!known(t)) return;
    if (this.view === "plan" && this.result?.profile) {
      const place = placeAt(this.result.profile, t);
      this.chart.routes.showShip(place.lon, place.lat, place.course);
      this.chart.weather.set({ time: t });
    }
    this.#valid();
  }

  #valid() {
    if (APART.includes(this.view)) return;
    const t = selection.time, { weather } = this.chart;
    const shown = weather.kind && known(t) ? [h("b", {}, time(t, true)), " UTC"] : [];
    const { period, run } = this.form;
    const age = run === null ? "" : ` · forecast of ${time(run)}, ${number(Math.max(0, Date.now() / 1000 - run) / 3600)} h old`;
    const outside = weather.kind && known(t) && period && (t < period[0] || t > period[1]);
    fill(document.getElementById("valid"), shown, outside ? " · outside the data" : period ? ` · data until ${time(period[1])}${age}` : "");
  }

  #permalink() {
    clearTimeout(this.linkTimer);
    this.linkTimer = setTimeout(() => { if (this.view === "plan" && this.result) this.#link(`plan=${this.result.job.id}&route=${selection.route + 1}&t=${Math.round(selection.time)}`); }, 250);
  }

  async #copyLink() {
    this.#link(`plan=${this.result.job.id}&route=${selection.route + 1}&t=${Math.round(selection.time)}`);
    try { await navigator.clipboard.writeText(location.href); this.#hint("The link is copied."); } catch { this.#hint("The link is in the address line."); }
  }

  #hint(text) {
    const hint = document.getElementById("hint");
    hint.textContent = text;
    hint.hidden = false;
    announce(text);
    setTimeout(() => { hint.hidden = true; }, 2500);
  }

  // Compare and voyages

  #showCompare() {
    fill(panel, this.compare.element);
    this.compare.show().catch((problem) => fill(this.compare.problem, errorBox(problem)));
  }

  #showCompared(routes, table) {
    if (this.view !== "compare") return;
    const source = this.chart.routes.others.getSource();
    this.chart.routes.clear();
    const features = routes.map((points, i) => { const feature = new Feature(line(points)); feature.setStyle(() => [...(i ? [] : [stroke(colour("casing"), 6.5)]), stroke(colour(PAINTS[i]), i ? 2.4 : 4, DASHES[i] || undefined)]); return feature; });
    source.addFeatures(features);
    if (routes.length) this.chart.fit(routes.flat());
    if (table) this.#sheet(h("div.sheet", {}, table));
  }

  #runBeside(job, done) {
    return new Promise((resolve) => {
      const said = h("p.note", { role: "status" }, `Planning: ${job.title} …`);
      fill(this.compare.problem, said);
      follow(job.id, {
        stage: (data) => { said.textContent = `${job.title}: ${data.text} …`; },
        state: async (data) => {
          if (!hasEnded(data.state)) return;
          const ended = await get(`/plans/${job.id}`);
          done(ended);
          fill(this.compare.problem, ended.problem ? errorBox(ended.problem) : null);
          resolve();
        },
      });
    });
  }

  async #showVoyages() {
    const box = h("div.scroll", {}, h("h1", {}, "Voyages"), h("p.lead", {}, "All plans, projects and studies of this computer, the newest first."));
    fill(panel, box);
    const again = async (asked) => {
      try { await asked; } catch (problem) { box.prepend(errorBox(problem)); return; }
      if (this.view === "voyages" && box.isConnected) await this.#showVoyages();
    };
    try {
      const { jobs } = await get("/plans?size=100");
      box.append(h("div.block", {}, jobs.length ? jobs.map((job) => h("div.jobrow", {}, h("button.job", { type: "button", onclick: () => this.openJob(job.id) }, h("b", {}, job.title || "Plan"), " ", job.state === "done" ? null : h(`span.state.${job.state}`, {}, job.state), h("span", {}, this.#facts(job))), hasEnded(job.state) ? h("button.quiet.small", { type: "button", "aria-label": `Remove ${job.title || "plan"}`, onclick: () => again(remove(`/plans/${job.id}?forget=true`)) }, "Remove") : h("button.quiet.small", { type: "button", "aria-label": `Stop ${job.title || "plan"}`, onclick: () => again(remove(`/plans/${job.id}`)) }, "Stop"))) : h("p.empty", {}, h("b", {}, "No voyages yet"), "Plan one, or open the example.", h("p", {}, h("button.quiet", { type: "button", onclick: () => { this.form.set(DEMO); this.#switch("plan"); } }, "Fill in the storm of 1998")))));
    } catch (problem) {
      box.append(errorBox(problem));
    }
  }

  #facts(job) {
    if (job.summary && ["project", "study", "forecast"].includes(job.kind)) {
      const what = { project: () => `Project · ${number(job.summary.duration_days, 1)} days · ${number(job.summary.cycles)} cycles`, study: () => `Study · ${number(job.summary.voyages)} voyages`, forecast: () => `Forecast · ${number(job.summary.bytes / 1e6, 1)} MB` }[job.kind]();
      return `${what} · ${time(seconds(job.created))}`;
    }
    if (job.summary) return `${duration(job.summary.time_h)} · ${number(job.summary.distance_nm, 0)} nm · ${time(seconds(job.created))}`;
    return job.problem ? job.problem.asked : time(seconds(job.created));
  }

  // Layers

  #layers() {
    const { weather } = this.chart;
    const kinds = this.view === "plan" && !this.result ? this.form.frameKinds : (this.form.seas || []).filter((sea) => weather.seas.includes(sea.id)).flatMap((sea) => sea.frames || []);
    const there = [...new Set(kinds)];
    const box = document.getElementById("layers");
    const radio = (value, text) => h("label.check", {}, h("input", { type: "radio", name: "weather", value, checked: weather.kind === value, onchange: () => { weather.set({ kind: value }); this.chart.showLegend(); this.#valid(); } }), h("span", {}, text));
    const toggle = (text, checked, act) => h("label.check", {}, h("input", { type: "checkbox", checked, onchange: (event) => act(event.target.checked) }), h("span", {}, text));
    const redraw = () => { if (this.result?.profile) this.#drawRoutes(this.result.profile); };
    fill(box,
      h("fieldset", {}, h("legend", {}, "Weather"), radio("", "None"), there.filter((kind) => KINDS[kind]).map((kind) => radio(kind, KINDS[kind].title)),
        ["wind", "current"].some((kind) => there.includes(kind)) ? this.#particles() : null),
      h("fieldset", {}, h("legend", {}, "Route"), toggle("Colour by speed over ground", this.bySpeed, (on) => { this.bySpeed = on; redraw(); }), toggle("Isochrones", this.showIsochrones !== false, (on) => { this.showIsochrones = on; redraw(); }), toggle("Route that ignores the weather", this.showBeside !== false, (on) => { this.showBeside = on; redraw(); })),
      h("fieldset", {}, h("legend", {}, "Chart"), toggle("Emission control areas", this.chart.eca.getVisible(), (on) => this.chart.eca.setVisible(on)), toggle("Ports", this.chart.ports.getVisible(), (on) => this.chart.ports.setVisible(on)), toggle("Canals", this.chart.canals.getVisible(), (on) => this.chart.canals.setVisible(on))));
  }

  #particles() {
    const { particles, weather } = this.chart;
    const change = (event) => { particles.wanted = event.target.checked; localStorage.setItem("particles", String(particles.wanted)); weather.repaint(); };
    const why = lessMotion.matches ? " (this computer asks for less motion)" : "";
    return h("label.check", {}, h("input", { type: "checkbox", id: "particles", checked: particles.wanted, disabled: lessMotion.matches, onchange: change }), h("span", {}, `Wind and current as moving particles${why}`));
  }

  // Events

  #listen() {
    const { chart, form } = this;
    addEventListener("beforeprint", () => this.#forPaper(true));
    addEventListener("afterprint", () => this.#forPaper(false));
    chart.weather.onState = (state) => chart.showLegend(state);
    document.querySelectorAll(".tab").forEach((tab) => tab.addEventListener("click", () => this.#switch(tab.dataset.view)));
    const button = document.getElementById("layers-button"), layers = document.getElementById("layers");
    button.addEventListener("click", () => { layers.hidden = !layers.hidden; button.setAttribute("aria-expanded", String(!layers.hidden)); });
    document.getElementById("palette").addEventListener("click", () => this.#palette());
    document.getElementById("help").addEventListener("click", () => this.#help());
    form.addEventListener("places", () => this.#placesOnChart());
    form.addEventListener("seas", () => { if (!this.chart.weather.kind && form.frameKinds.includes("waves") && form.chosenSeas[0] !== "calm") this.chart.weather.set({ kind: "waves" }); this.#fieldTime(); });
    form.addEventListener("link", async (event) => {
      this.#link(`voyage=${encodeURIComponent(JSON.stringify(event.detail))}`);
      try { await navigator.clipboard.writeText(location.href); this.#hint("The link is copied."); } catch { this.#hint("The link is in the address line."); }
    });
    chart.addEventListener("dragged", ({ detail: { number: n, lat, lon } }) => { if (this.view === "projects") this.projects.moved(n, lat, lon); else form.moved(n, lat, lon); });
    form.addEventListener("change", () => this.#fieldTime());
    form.addEventListener("started", ({ detail }) => this.#follow(detail));
    chart.addEventListener("hoverroute", (event) => { if (this.result?.plan.routes.length > 1) selection.hover(event.detail); });
    chart.addEventListener("click", (event) => this.#clicked(event.detail));
    selection.addEventListener("route", () => { if (this.result) this.showResult(this.result); });
    selection.addEventListener("hover", () => { if (this.result) this.chart.routes.showOthers(this.result.plan.routes.map((route) => route.waypoints.map((w) => [w.lon, w.lat])), selection.route, selection.hovered); });
    selection.addEventListener("time", () => { this.#time(); this.#permalink(); });
  }

  // On paper the chart has another size: it shows the whole route, then what it showed before.
  #forPaper(begins) {
    const view = this.chart.map.getView();
    if (begins) this.seen = [view.getCenter(), view.getZoom()];
    this.chart.map.updateSize();
    const { profile } = this.result || {};
    if (begins && profile) this.chart.fit(profile.lon.map((lon, i) => [lon, profile.lat[i]]));
    if (!begins && this.seen) { view.setCenter(this.seen[0]); view.setZoom(this.seen[1]); }
    this.chart.map.renderSync();
  }

  #clicked({ lat, lon, number: number_, port, coordinate }) {
    if (this.view === "projects") { this.projects.clicked(lat, lon, coordinate); return; }
    if (this.view !== "plan" || this.progress) return;
    if (this.result) {
      if (number_ !== null && number_ !== undefined) {
        if (number_ !== selection.route) selection.choose(number_);
        else this.#nearestTime(lat, lon);
      }
      return;
    }
    const set = (field) => () => (port ? field.set(port.locode || port.label, { kind: "port", ...port }) : field.setPosition(lat, lon));
    this.chart.choose(coordinate, port ? port.label : plainPosition(lat, lon), [["From here", set(this.form.start)], ["To here", set(this.form.goal)], ["Via here", () => this.form.addVia(port ? port.locode || port.label : "", port ? null : [lat, lon])], ["Close", () => {}]]);
  }

  #nearestTime(lat, lon) {
    const { profile } = this.result;
    let best = 0, least = Infinity;
    profile.lat.forEach((value, i) => { const d = (value - lat) ** 2 + (Math.cos((lat * Math.PI) / 180) * (((profile.lon[i] - lon + 540) % 360) - 180)) ** 2; if (d < least) { least = d; best = i; } });
    selection.at(profile.time[best]);
  }

  #palette() {
    const root = document.documentElement;
    const next = PALETTES[(PALETTES.indexOf(root.dataset.palette) + 1) % PALETTES.length];
    root.dataset.palette = next;
    localStorage.setItem("palette", next);
    document.getElementById("palette").setAttribute("aria-label", `Palette: ${next}. Change to ${PALETTES[(PALETTES.indexOf(next) + 1) % 3]}`);
    this.chart.paint();
    if (this.result?.profile) this.drawer.show(this.drawer.result);
    dispatchEvent(new Event("palette"));
    announce(`Palette: ${next}`);
  }

  #keys() {
    document.addEventListener("keydown", (event) => {
      const typing = event.target.closest("input:not([type=range]):not([type=checkbox]):not([type=radio]), select, textarea, dialog");
      if (event.key === "Escape") { this.chart.closeMenu(); document.getElementById("layers").hidden = true; document.getElementById("layers-button").setAttribute("aria-expanded", "false"); }
      if (typing || event.ctrlKey || event.metaKey || event.altKey) return;
      const act = {
        " ": () => { if (event.target.closest("button, summary, a, input")) return false; this.drawer.toggle(); },
        ",": () => this.drawer.step(-3), ".": () => this.drawer.step(3),
        "[": () => this.#stepRoute(-1), "]": () => this.#stepRoute(1),
        c: () => this.result?.view.handlers.compare(), n: () => this.#palette(), "?": () => this.#help(),
        p: () => document.querySelector('.tab[data-view="plan"]').click(), d: () => this.#switch("projects"), s: () => this.#switch("studies"), v: () => document.querySelector('.tab[data-view="voyages"]').click(), l: () => document.getElementById("layers-button").click(),
      }[event.key];
      if (act && act() !== false) event.preventDefault();
    });
  }

  #stepRoute(step) {
    if (this.result) selection.choose(Math.max(0, Math.min(this.result.plan.routes.length - 1, selection.route + step)));
  }

  #help() {
    const dialog = document.getElementById("keys");
    const rows = [["Space", "play and pause"], [", .", "three hours back and on"], ["[ ]", "the route before, the next route"], ["Arrow keys", "on the front: along it; on the chart: move it"], ["+ −", "on the chart: closer and farther"], ["c", "compare this route"], ["l", "layers"], ["n", "day, dusk, night"], ["p, v", "plan, voyages"], ["d, s", "dredging projects, studies"], ["?", "this list"]];
    fill(dialog, h("h2", { id: "keys-title" }, "Keys"), h("dl", {}, rows.map(([key, text]) => [h("dt", {}, h("kbd", {}, key)), h("dd", {}, text)])), h("p.lead", {}, "Programs can use the same interface: see /openapi.json. Thalweg is not a navigation system; check every route against official charts and notices."), h("p", {}, h("button.quiet", { type: "button", onclick: () => dialog.close(), autofocus: true }, "Close")));
    dialog.showModal();
  }
}

window.thalweg = new Application();
export { indexAt, speedColours };
