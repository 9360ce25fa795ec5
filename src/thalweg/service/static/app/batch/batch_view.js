// What projects and studies have in common: a form, the jobs of before, a job that is followed, its end.

import { follow, get, hasEnded, start } from "../common/api.js";
import { errorBox, fill, h } from "../common/elements.js";

/** Subclasses have `element`, and `show()`, `shown(job)`, `watch(job)` and `drawn(job, result)`. */
export class BatchView {
  job = null;
  problem = h("div");
  earlier = h("div");

  /**
   * @param {string} kind of its jobs
   * @param {{path: string, stopped: string}} words where jobs are started, and what is said of one that was stopped
   * @param {object} handlers sheet(element, tall), panel(elements), link(id), hidden(), leave(), ...
   */
  constructor(kind, words, handlers) {
    Object.assign(this, { kind, words, handlers });
  }

  // The form takes the place of a job.
  begin() {
    this.asked = Symbol("ask");
    this.job = null;
    this.close?.();
    this.handlers.link("");
    this.handlers.sheet(null);
  }

  // Jobs of before, each with its figures in words.
  async listEarlier(facts) {
    const { jobs } = await get(`/plans?kind=${this.kind}&size=20`);
    const row = (job) => h("button.job", { type: "button", onclick: () => this.openJob(job.id) }, h("b", {}, job.title), " ", job.state === "done" ? null : h(`span.state.${job.state}`, {}, job.state), h("span", {}, facts(job)));
    fill(this.earlier, jobs.length ? h("details", {}, h("summary", {}, this.words.earlier, h("span.set", {}, String(jobs.length))), h("div.inside", {}, jobs.map(row))) : null);
  }

  fail(problem) {
    const slot = this.element.querySelector(`[data-field="${problem.field}"] .slot`);
    slot?.closest("details")?.setAttribute("open", "");
    fill(slot || this.problem, errorBox(problem));
    (slot || this.problem).scrollIntoView({ block: "center" });
  }

  clearFaults() {
    this.element.querySelectorAll(".slot").forEach((slot) => fill(slot));
    fill(this.problem);
  }

  async order(request) {
    if (this.sending) return;
    this.sending = true;
    try {
      const job = await start(this.words.path, request);
      if (!this.handlers.hidden()) await this.openJob(job.id);
    } catch (problem) {
      this.fail(problem);
    } finally {
      this.sending = false;
    }
  }

  // The content of a chosen file; null where none was chosen.
  async fileText(input) {
    const [file] = input.files;
    input.value = "";
    return file ? file.text() : null;
  }

  async openJob(id) {
    const ask = (this.asked = Symbol("ask")); // a form or job that is wanted later stays
    const job = await get(`/plans/${id}`);
    if (ask !== this.asked || this.handlers.hidden()) return;
    this.job = job;
    this.handlers.link(id);
    this.shown(job);
    if (hasEnded(job.state)) await this.#ended(job);
    else this.watch(job);
  }

  /**
   * Follow a job to its end.
   * @param {Element} state where its state is written
   * @param {{again: () => void, kept: string}} more what to do, and what is said, when it is started again
   * @param {object} handlers of the other events
   */
  followJob(job, state, { again = () => {}, kept = "" }, handlers) {
    this.close?.();
    this.close = follow(job.id, {
      ...handlers,
      state: async (data) => {
        if (data.state === "queued" && data.why) { again(); state.textContent = `Started again: ${data.why}.${kept}`; return; }
        if (!hasEnded(data.state)) return;
        const done = await get(`/plans/${job.id}`);
        if (this.job?.id === job.id) await this.#ended(done);
      },
      waiting: () => { state.textContent = "The service does not answer; the job goes on when it runs again."; },
    });
  }

  async #ended(job) {
    this.job = job;
    if (!job.result) {
      this.handlers.panel([await this.show()]);
      if (job.problem) this.fail(job.problem);
      else fill(this.problem, h("p.note", {}, this.words.stopped));
      return;
    }
    const result = await get(`/plans/${job.id}/result`);
    if (this.job === job && !this.handlers.hidden()) await this.drawn(job, result);
  }
}
