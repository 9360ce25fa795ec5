// The views of projects and studies, and what they may do with the page.

import { errorBox, fill, h, hint } from "../common/elements.js";
import { DEMO } from "../form/plan_form.js";
import { endsOf } from "../form/places.js";
import { ProjectView } from "./project_view.js";
import { StudyView } from "./study_view.js";

const TITLES = { projects: "Dredging project", studies: "Study" };

export class BatchViews {
  /**
   * @param {Chart} chart
   * @param {PlanForm} form
   * @param {{view: () => string, open: (view: string) => void, sheet: (element: Element, tall: boolean) => void, write: (address: string) => void, plan: () => void, fillIn: (request: object) => void}} page
   */
  constructor(chart, form, page) {
    Object.assign(this, { chart, form, page });
    const shown = (view, act) => (...given) => { if (page.view() === view) act(...given); };
    const handlers = (view) => ({
      sheet: shown(view, page.sheet),
      panel: shown(view, (parts) => fill(document.getElementById("panel"), parts)),
      link: shown(view, (id) => page.write(id ? `plan=${id}` : `view=${view}`)),
      fit: shown(view, (points) => chart.fit(points)),
      hidden: () => page.view() !== view,
      leave: () => page.open("voyages"),
      plan: page.plan,
      demo: () => form.set(DEMO),
      ends: shown(view, (voyage) => this.#fitVoyage(voyage)),
      voyage: (request) => { page.fillIn(request); hint("The voyage is filled in."); },
    });
    this.projects = new ProjectView(chart, form, handlers("projects"));
    this.studies = new StudyView(form, handlers("studies"));
  }

  // The id of the job that a view shows.
  job(view) {
    return this[view]?.job?.id || null;
  }

  close() {
    this.projects.close?.();
    this.studies.close?.();
  }

  // Show the form of a view, or a job in its place.
  async show(view, id) {
    const panel = document.getElementById("panel"), one = this[view];
    fill(panel, h("div.scroll", {}, h("h1", {}, TITLES[view]), h("p.lead", {}, "Reading …")));
    try {
      if (id) { await one.openJob(id); return; }
      const element = await one.show();
      if (this.page.view() !== view || one.job) return;
      fill(panel, element);
      if (view === "studies") { this.chart.routes.showEnds(this.form.ends); this.chart.fitOutside(this.form.ends); }
    } catch (problem) {
      if (this.page.view() === view) fill(panel, h("div.scroll", {}, errorBox(problem)));
    }
  }

  // The ends of the voyage of a study, whose places may be text.
  async #fitVoyage(voyage) {
    try {
      const ends = await endsOf(voyage);
      if (this.page.view() !== "studies") return;
      this.chart.routes.showEnds(ends);
      this.chart.map.updateSize();
      this.chart.fit(ends.map((end) => [end.lon, end.lat]));
    } catch { /* the study states what is wrong with its places */ }
  }
}
