// All plans, projects, studies and forecasts of this computer.

import { get, hasEnded, remove } from "../common/api.js";
import { errorBox, fill, h } from "../common/elements.js";
import { duration, number, readable, seconds, time, titleOf } from "../common/format.js";

const KIND_FACTS = {
  project: ({ duration_days: days, cycles }) => `Project · ${number(days, 1)} days · ${number(cycles)} cycles`,
  study: ({ voyages }) => `Study · ${number(voyages)} voyages`,
  forecast: ({ bytes }) => `Forecast · ${number(bytes / 1e6, 1)} MB`,
};

export class VoyageList {
  /** @param {{open: (id: string) => void, demo: () => void}} handlers */
  constructor(handlers) {
    this.handlers = handlers;
    this.problem = h("div");
    this.rows = h("div.block", {}, h("p.facts", {}, "Reading …"));
    this.element = h("div.scroll", {}, h("h1", {}, "Voyages"), h("p.lead", {}, "All plans, projects and studies of this computer, the newest first."), this.problem, this.rows);
  }

  async show() {
    try {
      const { jobs } = await get("/plans?size=100");
      fill(this.rows, jobs.length ? jobs.map((job) => this.#row(job)) : h("p.empty", {}, h("b", {}, "No voyages yet"), "Plan one, or open the example.", h("p", {}, h("button.quiet", { type: "button", onclick: this.handlers.demo }, "Fill in the storm of 1998"))));
    } catch (problem) {
      fill(this.problem, errorBox(problem));
    }
  }

  async #change(request) {
    try {
      await request;
      fill(this.problem);
    } catch (problem) {
      fill(this.problem, errorBox(problem));
    }
    await this.show();
  }

  #row(job) {
    const title = titleOf(job);
    const button = (text, path) => h("button.quiet.small", { type: "button", "aria-label": `${text} ${title}`, onclick: () => this.#change(remove(path)) }, text);
    return h("div.jobrow", {},
      h("button.job", { type: "button", onclick: () => this.handlers.open(job.id) }, h("b", {}, title), " ", job.state === "done" ? null : h(`span.state.${job.state}`, {}, job.state), h("span", {}, this.#facts(job))),
      hasEnded(job.state) ? button("Remove", `/plans/${job.id}?forget=true`) : button("Stop", `/plans/${job.id}`));
  }

  #facts(job) {
    const made = time(seconds(job.created));
    if (!job.summary) return job.problem ? readable(job.problem.asked) : made;
    const facts = KIND_FACTS[job.kind]?.(job.summary) || `${duration(job.summary.time_h)} · ${number(job.summary.distance_nm, 0)} nm`;
    return `${facts} · ${made}`;
  }
}
