// The progress of a job: what is done now, the best route so far, and stopping it.

import { follow, remove } from "../common/api.js";
import { announce, durationParts, errorBox, fill, h, unit } from "../common/elements.js";
import { LiveFront } from "./live_front.js";
import { known, number, readable, titleOf } from "../common/format.js";

// The buttons under a job that runs.
export function jobFoot(job, words, { state, problem, leave }) {
  const stop = async () => { state.textContent = "Stopping …"; await remove(`/plans/${job.id}`).catch((error) => fill(problem, errorBox(error))); };
  return h("div.foot", {}, h("button.quiet", { type: "button", onclick: stop }, words), h("button.quiet", { type: "button", onclick: leave }, "Leave it running"));
}

const STOP = "Stop", STOP_AND_KEEP = "Stop, keep the best"; // the second where there is a route to keep

export class ProgressView {
  constructor(job, handlers) {
    this.job = job;
    this.handlers = handlers;
    this.steps = h("ol.steps");
    this.best = h("div");
    this.state = h("p.lead", { role: "status" }, "Waiting for its turn.");
    this.problem = h("div");
    this.front = new LiveFront();
    this.cancel = h("button.quiet", { type: "button", onclick: () => this.stop() }, STOP);
    this.element = [h("div.scroll", {}, h("h1", {}, titleOf(job)), this.state, this.steps, this.best, this.front.element, this.problem), h("div.foot", {}, this.cancel, h("button.quiet", { type: "button", onclick: handlers.leave }, "Leave it running"))];
    this.close = follow(job.id, { state: (data) => this.#state(data), stage: (data) => this.#stage(data), route: (data) => this.#route(data), front: (data) => this.front.show(data), waiting: () => { this.state.textContent = "The service does not answer; the job goes on when it runs again."; }, open: () => this.#say() });
  }

  #say() {
    this.state.textContent = { queued: "Waiting for its turn.", running: "Planning." }[this.now] || this.state.textContent;
  }

  #state(data) {
    this.now = data.state;
    if (data.state === "queued" && data.why) {
      this.#forget();
      this.state.textContent = `Started again: ${data.why}.`;
      return;
    }
    if (data.state === "queued" || data.state === "running") { this.#say(); return; }
    this.steps.querySelector(".now")?.classList.remove("now");
    this.close();
    announce({ done: "The result is ready.", failed: "The job ended with an error.", cancelled: "The job was stopped." }[data.state] || `State of the job: ${data.state}.`);
    this.handlers.ended(data);
  }

  // A job that starts again has no route yet: what its first run found is gone.
  #forget() {
    fill(this.steps);
    fill(this.best);
    this.front.clear();
    this.cancel.textContent = STOP;
    this.handlers.route(null);
  }

  #stage(data) {
    const before = this.steps.querySelector(".now");
    if (before) {
      before.classList.remove("now");
      before.lastChild.textContent = `${number(Math.max(0, data.after_s - before.began), 1)} s`;
    }
    const words = readable(data.text);
    const row = h("li.now", {}, h("span", {}, words[0].toUpperCase() + words.slice(1)), h("span.unit", {}));
    row.began = data.after_s;
    this.steps.append(row);
    this.steps.scrollTop = this.steps.scrollHeight; // what is found stays in sight below
    announce(data.text);
  }

  #route({ route, final }) {
    if (this.cancel.textContent === STOP) this.cancel.textContent = STOP_AND_KEEP;
    fill(this.best, h("h2.block", {}, final ? "Route found" : ["time", "distance"].includes(this.job.request.voyage?.objective || "time") ? "Best route so far" : "First route: the fastest"), h("dl.cards", {},
      h("div.card", {}, h("dt", {}, "Time"), h("dd", {}, durationParts(route.time_h))),
      h("div.card", {}, h("dt", {}, "Distance"), h("dd", {}, number(route.distance_nm, 1), unit("nm"))),
      h("div.card", {}, h("dt", {}, "Fuel"), h("dd", {}, known(route.fuel_t) ? [number(route.fuel_t, 1), unit("t")] : "unknown")),
      h("div.card", {}, h("dt", {}, "Cost"), h("dd", {}, known(route.cost) ? [number(route.cost), unit(route.currency)] : "unknown"))));
    this.handlers.route(route.points);
  }

  async stop() {
    this.cancel.textContent = "Stopping …";
    try {
      await remove(`/plans/${this.job.id}`);
    } catch (problem) {
      fill(this.problem, errorBox(problem));
    }
  }
}
